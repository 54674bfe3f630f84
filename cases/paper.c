/* paper.c - for `make paper`: there are no models but those of the core, and the experiments show
 * nothing beyond the paper. All other programs have beyond.c in its place. */
#include "case.h"

bbm_model *case_beyond_model(int rounds, int moments) { return (void)rounds, (void)moments, NULL; }

int scene_edge_load(const bbm_model *m, int k, scene_line *l)
{
    (void)m, (void)k, (void)l;
    return 0;
}

int scene_is_cracked(const bbm_model *m) { return (void)m, 0; }
