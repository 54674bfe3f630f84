/* theory.h - the textbook solutions of Experiments I and II, plane stress. */
#ifndef THEORY_H
#define THEORY_H

typedef struct { double P, L, H, E, nu; } theory_beam;  /* N, m, m, Pa, -; thickness 1 m          */
typedef struct { double S, E, nu; } theory_plate;       /* Pa, Pa, -: S far away; hole of 1 m    */

/* A cantilever from x = 0 to L, -H/2 <= y <= H/2, under parabolic shear that sums to P downwards
 * at x = L, Eq. (70). */
void theory_beam_displacement(const theory_beam *b, double x, double y, double u[2]);
/* An infinite plate with a hole, Eq. (72): sx, sy, sxy, and the displacements. */
void theory_plate_stress(const theory_plate *p, double x, double y, double s[3]);
void theory_plate_displacement(const theory_plate *p, double x, double y, double u[2]);

#endif
