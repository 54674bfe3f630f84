/* msh.h - Gmsh's mesh files: their nodes, elements, blocks and sets go to the reader. */
#ifndef MSH_H
#define MSH_H

#include "reader.h"

int model_read_mesh(model_reader *r, const char *path, model_place statement);

#endif
