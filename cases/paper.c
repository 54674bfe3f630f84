/* paper.c - the paper's way, for `make paper`: models of the core alone, and experiments that show
 * nothing beyond the paper. All other programs have beyond.c in its place. */
#include "exp.h"

bbm_model *case_model(void)
{
    bbm_model *m;

    case_must(NULL, bbm_model_new(&m));
    return m;
}

bbm_model *case_paper_model(void) { return case_model(); }

int scene_edge_load(const bbm_model *m, int k, scene_line *l)
{
    (void)m, (void)k, (void)l;
    return 0;
}

void exp1_show_beyond(const case_reference *b) { (void)b; }

const exp3_variant exp3_beyond = { .name = NULL };
