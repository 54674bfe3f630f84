/* strain.c - plane strain: a slice of a long dam or tunnel, which cannot strain along its axis.
 *
 * Beyond the paper, whose plates are free to: plane stress. With ezz = 0 Hooke's law (7) is the
 * same in the plane with
 *
 *     E/(1 - nu^2) in place of E,      nu/(1 - nu) in place of nu
 *
 * (Timoshenko and Goodier, Theory of Elasticity, chapter 2), G stays, and out of the plane there is
 * szz = nu (sx + sy), with n = nu/(1 - nu): nu = n/(1 + n).
 */
#include "beyond.h"

static double stress_out_of_plane(const bbm_element *e)
{
    const double n = e->material.nu;

    return n / (1 + n) * (e->stress[0] + e->stress[1]);
}

/* All elements of a prepared model, once. */
void bbm_set_plane_strain(bbm_model *m)
{
    for (int i = 0; i < m->elements; i++) {
        bbm_material *a = &m->element[i].material;
        a->E /= 1 - a->nu * a->nu;
        a->nu /= 1 - a->nu;
    }
    m->hook->out_of_plane = stress_out_of_plane;
}
