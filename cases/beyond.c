/* beyond.c - the programs' models: with all of beyond/. `make paper` has paper.c in its place. */
#include "../beyond/beyond.h"
#include "case.h"

bbm_model *case_model(void)
{
    bbm_model *m;

    case_must(NULL, bbm_beyond_new(&m));
    return m;
}

/* Eisenstat's form has the iterates of the paper's SSOR-PCG in about 0.7 of the time. */
bbm_model *case_paper_model(void)
{
    bbm_model *m = case_model();

    m->beyond->bonding = BBM_VERTICES;
    m->par.pcg.method = &bbm_eisenstat;
    return m;
}
