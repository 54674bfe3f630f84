/* build.h - the library's model of what the statements say, and the statements that need it. */
#ifndef BUILD_H
#define BUILD_H

#include "reader.h"

int model_build(model_reader *r);
int model_finish(model_reader *r);
int model_fix(model_reader *r);
int model_load_nodes(model_reader *r);
int model_traction(model_reader *r);
int model_pressure(model_reader *r);
int model_water(model_reader *r);
int model_velocities(model_reader *r);
int model_stress(model_reader *r);
int model_joint(model_reader *r);
int model_monitors(model_reader *r);

#endif
