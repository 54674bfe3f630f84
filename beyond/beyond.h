/* beyond.h - what stands beside the paper: its settings, and the model that has it all.
 *
 * The core, the four files on top, knows nothing of this. bbm_beyond_new makes a model as bbm_model_new does and hooks
 * everything into it; what it takes to run is in m->beyond. Each subject is a file of its own with an essay.
 */
#ifndef BBM_BEYOND_H
#define BBM_BEYOND_H

#include "../bbm.h"

struct bbm_beyond {
    int placeholder;
};

bbm_status bbm_beyond_new(bbm_model **m);               /* bbm_model_new, with all of it */

#endif
