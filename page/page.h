/* page.h - the calls of the page: load a model, step, look. What computes is the library, what
 * reads and runs is program/.
 *
 *     page *g = page_load("arch.model");
 *     while (page_state(g) == 0)
 *         page_step(g);
 *     n = page_numbers(g, 'v'), x = page_data(g);
 *     page_free(g);
 *
 * JavaScript calls these in WebAssembly and reads numbers and texts where they lie in memory; they
 * stay until the next call. A model that fails to load leaves every other one as it is.
 */
#ifndef PAGE_H
#define PAGE_H

typedef struct page page;

page *page_load(const char *path);                      /* NULL: no memory, as page_text says */
void  page_free(page *g);
/* 0: there are steps left; 1: the run is over; 2: it is wrong or has failed, page_text says why. */
int   page_state(const page *g);
int   page_step(page *g);       /* one step, if there is one left; the state */

/* A hand takes the point (x, y) [m] of an element, -1: lets go; and pulls it to a place, by a
 * damped spring that takes part in each step. A run that is over goes on. Where a step fails by the
 * pull, the hand lets go. */
void  page_hold(page *g, int element, double x, double y);
void  page_pull(page *g, double x, double y);

/* m: why it failed; t: the title; b, e, o: name of a block, element, monitor; q: what may be
 * expected of a monitor, u|v|moves|stays or normal|shear|fx|fy; n: name of the node of a vertex; x:
 * expectation k beside what came out. What is not there is "". */
const char *page_text(page *g, int what, int k);

/* Gathers numbers; how many, or -1: no memory. JavaScript has the same list, page/model.js.
 *     v  of each vertex: x y u v held block
 *     e  of each element: D[6] V[6] sxx syy sxy szz mises, the way of its centre, E nu
 *        density thickness block, first vertex, how many, its place in K
 *     d  of each boundary edge: its vertices a b, its block
 *     c  of each contact: corner edge state fx fy N T d_n strength slip
 *     l  of each load: vertices a b (-1: at a point), fx fy in N or N/m
 *     k  of each submatrix below the diagonal of K: row column
 *     f  facts of the step; then of each monitor u v 0 0, or of a joint normal shear fx fy
 *     x  of each expectation: monitor kind value within met
 *     b  of both ends of each bolt that holds: its three vertices, their shares
 *     h  of the hand, if it holds: element, x y of the point, x y of the place, fx fy in N
 *     p  of each look at the contacts in the last step: t h what count; and of each that is closed
 *        before or after: corner edge from to N T d_n, whether in tension */
int     page_numbers(page *g, int what);
double *page_data(page *g);

/* What has preceded a look: the contacts were listed anew; the states were judged; friction has got
 * the N of the solution, states were not judged; F alone is new; the step is done. */
enum { PAGE_LISTED, PAGE_JUDGED, PAGE_FRICTION, PAGE_SAME_K, PAGE_DONE };

#endif
