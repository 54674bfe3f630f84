/* shapes.h - polygons and random numbers for the tests. */
#ifndef BBM_TESTS_SHAPES_H
#define BBM_TESTS_SHAPES_H

/* A few operations on numbers near 1 (eps = 2e-16). */
#define ROUNDING 1e-12

/* A number in [-1, 1], in the same order in every run (Numerical Recipes' linear congruence). */
double random_number(unsigned *seed);

enum { CORNERS = 6 };

typedef struct {                /* a polygon, and triangles made by hand that fill it */
    int n, triangles;
    double x[CORNERS][2];
    int triangle[CORNERS][3];
} shape;

/* The last is not convex, and its corner 0 does not see all of it. */
extern const shape SHAPES[3];

#endif
