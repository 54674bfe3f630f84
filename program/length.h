/* length.h - how many items an array has, so that a table may get one more row. */
#ifndef LENGTH_H
#define LENGTH_H

#define LENGTH(array) ((int)(sizeof array / sizeof *array))

#endif
