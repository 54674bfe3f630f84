/* shapes.c - polygons and random numbers for the tests. */
#include "shapes.h"

double random_number(unsigned *seed)
{
    *seed = (1664525u * *seed + 1013904223u) & 0xffffffffu;
    return (double)(*seed >> 8) / 8388608.0 - 1;
}

const shape SHAPES[] = {
    { 3, 1, { { 0.25, 0.5 }, { 2, 0.75 }, { 1, 2.25 } }, { { 0, 1, 2 } } },
    { 4, 2, { { -1, -0.5 }, { 1.5, -1 }, { 2, 1.25 }, { -0.5, 1 } }, { { 0, 1, 2 }, { 0, 2, 3 } } },
    { 6, 4, { { 3, 1 }, { 1, 1.5 }, { 1.5, 3 }, { 0, 2.5 }, { 0, 0 }, { 3, 0 } },
      { { 1, 2, 3 }, { 1, 3, 4 }, { 1, 4, 5 }, { 1, 5, 0 } } },
};
