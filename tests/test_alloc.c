/* test_alloc.c - an allocator that fails at a chosen call, and that notices who writes beyond the end.
 *
 * The library under test is compiled with -Dmalloc=test_malloc and so on. With test_allocations_left = k the first k
 * calls succeed and all others return NULL, as they do when memory has run out; with -k call k alone returns NULL,
 * counted from 1, as when one large piece could not be had. A program that is linked with it takes the number from the
 * environment, TEST_ALLOCATIONS. malloc has no parameter through which the count could come, so here, and only here,
 * variables have file scope.
 *
 * New memory and GUARD bytes behind it are filled with 0x7f: an index read from there is 2139062143, and using it
 * crashes; a number is 1e306. When a piece is freed its guard must be as it was. Tools that watch the memory
 * themselves take GUARD = 0.
 */
#include <stdio.h>
#include <string.h>

#include "check.h"

#ifndef GUARD
#define GUARD 64
#endif

typedef union { size_t size; long double number; void *pointer; } header;      /* in front, aligned for all */

int test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
size_t test_bytes = 0;

static int one_more(void)
{
    static int asked;
    const char *wanted = asked ? NULL : getenv("TEST_ALLOCATIONS");

    asked = 1;
    if (wanted)
        test_allocations_left = atoi(wanted);
    if (test_allocations_left == 0)
        return 0;
    if (test_allocations_left > 0) {
        test_allocations_left--;
        return 1;
    }
    if (++test_allocations_left < 0)
        return 1;
    test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;
    return 0;
}

void *test_malloc(size_t size)
{
    header *h = one_more() ? malloc(sizeof *h + size + GUARD) : NULL;

    if (!h)
        return NULL;
    h->size = size;
    test_bytes += size;
    return memset(h + 1, 0x7f, size + GUARD);
}

void *test_calloc(size_t count, size_t size)
{
    void *piece = test_malloc(count * size);

    return piece ? memset(piece, 0, count * size) : NULL;
}

void *test_realloc(void *old, size_t size)
{
    const header *h = old;
    void *piece = test_malloc(size);

    if (piece && old) {
        memcpy(piece, old, h[-1].size < size ? h[-1].size : size);
        test_free(old);
    }
    return piece;
}

void test_free(void *piece)
{
    header *h = piece;

    if (!piece)
        return;
    for (size_t i = 0; i != GUARD; i++)
        if (((unsigned char *)piece)[h[-1].size + i] != 0x7f) {
            fprintf(stderr, "written beyond the end of %zu bytes\n", h[-1].size);
            abort();
        }
    free(h - 1);
}
