/* numbers.h - `let`, $(...) and `repeat`. */
#ifndef NUMBERS_H
#define NUMBERS_H

#include "reader.h"

int model_expand(model_reader *r);      /* the statements as the file has them become those that count */

#endif
