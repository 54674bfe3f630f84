/* beyond.c - the programs' models: with all of beyond/. `make paper` has paper.c in its place. */
#include "../beyond/beyond.h"
#include "case.h"

bbm_model *case_beyond_model(int rounds, int moments)
{
    bbm_model *m;

    case_must(NULL, bbm_beyond_new(&m));
    m->beyond->multiplier_rounds = rounds;
    m->beyond->bonding = moments ? BBM_MOMENT : BBM_VERTICES;
    return m;
}
