/* beyond.c - the programs' models: with all of beyond/. `make paper` has paper.c in its place. */
#include "../beyond/beyond.h"
#include "case.h"

bbm_model *case_model(void)
{
    bbm_model *m;

    case_must(NULL, bbm_beyond_new(&m));
    return m;
}

bbm_model *case_augmented_model(void)
{
    bbm_model *m = case_model();

    m->beyond->multiplier_rounds = 2;
    return m;
}
