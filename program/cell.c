/* cell.c - the elements of a cell of a grid. */
#include "cell.h"

/* The cell (i, j) with corners a b c d counter-clockwise:
 *
 *     d---c    d---c    d---c    d---c
 *     |   |    | / |    | \ |    |\ /|
 *     |   |    |/  |    |  \|    | o |     quads; alternating, by i + j even or odd; crossed
 *     a---b    a---b    a---b    |/ \|
 *                                a---b */
int cell_cut(int cut, int odd, const int node[5], int element[4][4], int *corners)
{
    enum { ODD = CELL_CROSSED + 1 };
    static const struct { int elements, corners, of[4][4]; } cuts[] = {
        [CELL_QUADS] = { 1, 4, { { 0, 1, 2, 3 } } },
        [CELL_ALTERNATING] = { 2, 3, { { 0, 1, 2 }, { 2, 3, 0 } } },
        [ODD] = { 2, 3, { { 0, 1, 3 }, { 2, 3, 1 } } },
        [CELL_CROSSED] = { 4, 3, { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } } },
    };
    const int row = cut == CELL_ALTERNATING && odd ? ODD : cut;

    *corners = cuts[row].corners;
    for (int k = 0; k < 16; k++)
        element[k / 4][k % 4] = node[cuts[row].of[k / 4][k % 4]];
    return cuts[row].elements;
}
