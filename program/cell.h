/* cell.h - how a cell of a grid is cut into elements. */
#ifndef CELL_H
#define CELL_H

enum { CELL_QUADS, CELL_ALTERNATING, CELL_CROSSED };    /* not, in 2, in 4 triangles */

/* The elements of a cell, of so many corners each; returns their number. node[4] is the one in the
 * middle, where it is crossed; odd: i + j of its place. */
int cell_cut(int cut, int odd, const int node[5], int element[4][4], int *corners);

#endif
