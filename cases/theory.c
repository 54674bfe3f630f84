/* theory.c - the textbook solutions of Experiments I and II: formulas alone, so that tests can
 * differentiate them. */
#include <math.h>

#include "theory.h"

/* Timoshenko and Goodier's cantilever, Eq. (70), I = H^3/12. */
void theory_beam_displacement(const theory_beam *b, double x, double y, double u[2])
{
    const double L = b->L, H = b->H, nu = b->nu, c = b->P / (6 * b->E * (H * H * H / 12));

    u[0] = c * y * ((6 * L - 3 * x) * x + (2 + nu) * (y * y - H * H / 4));
    u[1] = -c * (3 * nu * y * y * (L - x) + (4 + 5 * nu) * H * H * x / 4 + (3 * L - x) * x * x);
}

/* Kirsch's stresses around a hole of radius 1, Eq. (72). */
void theory_plate_stress(const theory_plate *p, double x, double y, double s[3])
{
    const double q = 1 / (x * x + y * y), th = atan2(y, x), c2 = cos(2 * th), c4 = cos(4 * th);
    const double s2 = sin(2 * th), s4 = sin(4 * th);

    s[0] = p->S * (1 - q * (1.5 * c2 + c4) + 1.5 * q * q * c4);
    s[1] = p->S * (-q * (0.5 * c2 - c4) - 1.5 * q * q * c4);
    s[2] = p->S * (-q * (0.5 * s2 + s4) + 1.5 * q * q * s4);
}

/* Kirsch's displacements, Eq. (72). */
void theory_plate_displacement(const theory_plate *p, double x, double y, double u[2])
{
    const double r = hypot(x, y), th = atan2(y, x), r3 = r * r * r;
    const double c = p->S / (8 * p->E / (2 * (1 + p->nu))), k = (3 - p->nu) / (1 + p->nu);
    const double c1 = cos(th), c3 = cos(3 * th), s1 = sin(th), s3 = sin(3 * th);

    u[0] = c * (r * (k + 1) * c1 + 2 / r * ((1 + k) * c1 + c3) - 2 / r3 * c3);
    u[1] = c * (r * (k - 3) * s1 + 2 / r * ((1 - k) * s1 + s3) - 2 / r3 * s3);
}
