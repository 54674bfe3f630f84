/* beyond.c - a model with all that stands beside the paper. */
#include <stdlib.h>

#include "beyond.h"

static void release(bbm_model *m)
{
    free(m->beyond);
}

bbm_status bbm_beyond_new(bbm_model **out)
{
    bbm_status status = bbm_model_new(out);
    bbm_model *m = *out;

    if (status)
        return status;
    m->hook.release = release;
    m->beyond = calloc(1, sizeof *m->beyond);
    if (!m->beyond) {
        bbm_model_free(m);
        *out = NULL;
        return BBM_NO_MEMORY;
    }
    return BBM_OK;
}
