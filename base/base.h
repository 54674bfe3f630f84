/* base.h - what the files of the library share and a reader of the paper does not need. */
#ifndef BBM_BASE_H
#define BBM_BASE_H

#include "../bbm.h"

/* ------------------------------------------------------------------ the matrix and the solver
 * K has n block rows of six. Block rows are numbered in two ways: by the caller, and by their place
 * in the order of base/order.c. The functions of the first two groups take the caller's numbers,
 * those of the third the places; so do their vectors, of 6 n entries. */

/* What is not symmetric in K: K += u v^T. */
typedef struct {
    int    row[2];              /* places of two block rows, all others of u and v are 0        */
    double u[2][6], v[2][6];
} bbm_term;

struct bbm_matrix {
    int n;                      /* block rows                                                   */
    int *place, *caller;        /* [n]       place[caller's row], and back                      */
    int *first;                 /* [n+1]     row i of L: the blocks first[i] .. first[i+1]-1    */
    int *back;                  /* [blocks]  its row less its column                            */
    int components, *start;     /* [n+1]     the rows of component c: start[c] .. start[c+1]-1  */
    int *component;             /* [n]       of a caller's row                                  */
    double (*D)[6][6], (*L)[6][6];              /* [n], [blocks], one piece of memory           */
    int lacks;                  /* what was added to a block that the pattern does not have     */
    /* --- scratch of bbm_solve --- */
    int from, to;               /* the rows of the component in hand: from .. to-1              */
    double (*inverse)[6][6];    /* [n]       (D_i/omega)^-1                                     */
    double *x, *r, *u, *p, *q;  /* [6 n]     solution, residual, M^-1 r, direction, K p         */
    double *y;                  /* [6 n]     result of the sweep forward                        */
    const bbm_method *method;
    double omega;
    int ready;                  /* `inverse` and what the method made belong to D, L and these  */
    void *extra;                /* what a method keeps with K                                   */
    void (*free_extra)(void *extra);
    /* --- what a hook adds to D, L and L^T; it solves components with terms --- */
    int terms;
    bbm_term *term;             /* [terms]   NULL, or by malloc and released with K             */
    int (*add_terms)(const bbm_matrix *K, const double *x, double *y);  /* y += u v^T x of the  */
                                /*           rows in hand; returns the number of terms          */
    bbm_status (*solve_terms)(bbm_matrix *K, const bbm_pcg *pcg, bbm_pcg_info *info);
};

/* A method other than the paper's. */
struct bbm_method {
    void (*choose)(const bbm_matrix *K, bbm_pcg *pcg);  /* changes method or omega              */
    void (*make_ready)(bbm_matrix *K);                  /* for a new K                          */
    void (*correct)(const bbm_matrix *K, const double *y, double *f);   /* f, (D/w) y between   */
};

/* order.c: a new K. `pair` lists the i, j whose submatrix K_ij is not zero, in any order, either
 * way round, repeats allowed. */
bbm_status bbm_matrix_new(int n, int pairs, int (*pair)[2], bbm_matrix **K);
void       bbm_matrix_free(bbm_matrix *K);                              /* takes NULL           */
int        bbm_component_of(const bbm_matrix *K, int i);                /* 0 .. components-1    */

/* solver.c: K D = F, section 4. Rows that no pairs connect, however indirectly, are solved apart:
 * neither changes a bit of the other's D. */
void       bbm_matrix_clear(bbm_matrix *K);
bbm_status bbm_matrix_add(bbm_matrix *K, int i, int j, double B[6][6]); /* K_ij += B, K_ji = B^T;
                                   what the pattern does not have fails here and in bbm_solve   */
void       bbm_matrix_get(const bbm_matrix *K, int i, int j, double B[6][6]);   /* B = K_ij     */
bbm_status bbm_solve(bbm_matrix *K, const double *F, double *D, const bbm_pcg *pcg,
                     bbm_pcg_info *info);

/* Inside the solver, for the rows in hand. */
void       bbm_add_lower(const bbm_matrix *K, const double *x, double *y);      /* y += L x     */
void       bbm_add_upper(const bbm_matrix *K, const double *x, double *y);      /* y += L^T x   */
void       bbm_multiply(const bbm_matrix *K, const double *p, double *q);       /* q = K p      */
void       bbm_precondition(const bbm_matrix *K, const double *r, double *u);   /* u = M^-1 r   */
double     bbm_dot_rows(const bbm_matrix *K, const double *x, const double *y); /* x.y          */
void       bbm_combine(const bbm_matrix *K, const double *x, double c, const double *y, double *z);
bbm_status bbm_count_iteration(double pKp, const bbm_pcg *pcg, bbm_pcg_info *info);

#endif
