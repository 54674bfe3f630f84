/* pieces.c - a block that nothing bonds together.
 *
 * Bonds join elements that share a side, both its nodes. A mesh that is meant to be one block can
 * fall into pieces without a sign of it: two parts with nodes of their own at the same places, a
 * node in the middle of a neighbour's side (a hanging node), two elements that share a corner
 * alone. Since elements of one block do not touch each other either, the pieces then move through
 * each other. It may be meant - several stones under one name - so it is no error; but whoever
 * runs a model should hear of it.
 */
#include "beyond.h"

/* The root of e in the forest up[], with the path halved on the way. */
int bbm_root_of(int up[], int e)
{
    while (up[e] != e)
        e = up[e] = up[up[e]];
    return e;
}

/* For each element the first one of its piece, the elements that bonds join to it; piece[elements]
 * of the caller. Returns the number of pieces: as many as blocks, if each holds together. */
int bbm_find_pieces(const bbm_model *m, int piece[])
{
    int pieces = m->elements;

    for (int e = 0; e < m->elements; e++)
        piece[e] = e;
    for (int b = 0; b < m->bonds; b++) {
        const int i = bbm_root_of(piece, m->bond[b].i), j = bbm_root_of(piece, m->bond[b].j);
        pieces -= i != j;
        piece[i > j ? i : j] = i > j ? j : i;           /* the root is the first element */
    }
    for (int e = 0; e < m->elements; e++)
        piece[e] = piece[piece[e]];                     /* of an element before e, done already */
    return pieces;
}
