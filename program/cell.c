/* cell.c - the elements of a cell of a grid. */
#include <string.h>

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
    const int *n = node;
    const int halves[2][6] = { { n[0], n[1], n[2], n[2], n[3], n[0] },
                               { n[0], n[1], n[3], n[2], n[3], n[1] } };

    *corners = cut == CELL_QUADS ? 4 : 3;
    if (cut == CELL_QUADS)
        memcpy(element[0], n, 4 * sizeof *n);
    for (int k = 0; k < 2 && cut == CELL_ALTERNATING; k++)
        memcpy(element[k], &halves[odd][3 * k], 3 * sizeof *n);
    for (int k = 0; k < 4 && cut == CELL_CROSSED; k++)
        memcpy(element[k], (int[]){ n[k], n[(k + 1) % 4], n[4] }, 3 * sizeof *n);
    return cut == CELL_QUADS ? 1 : cut == CELL_CROSSED ? 4 : 2;
}
