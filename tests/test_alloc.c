/* test_alloc.c - an allocator that fails at a chosen call.
 *
 * The library under test is compiled with -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc. With
 * test_allocations_left = k the first k calls succeed and all others return NULL, as they do when memory has run out;
 * with -k call k alone returns NULL, counted from 1, as when one large piece could not be had. malloc has no parameter
 * through which the count could come, so here, and only here, a variable has file scope.
 *
 * Behind every piece lie GUARD bytes that are 0x7f: an index read from there is 2139062143, and using it crashes.
 */
#include <string.h>

#include "check.h"

enum { GUARD = 64 };

int test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;

static int one_more(void)
{
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

static void *guarded(void *piece, size_t size)
{
    if (piece)
        memset((char *)piece + size, 0x7f, GUARD);
    return piece;
}

void *test_malloc(size_t size)
{
    return one_more() ? guarded(malloc(size + GUARD), size) : NULL;
}

void *test_calloc(size_t count, size_t size)
{
    return one_more() ? guarded(calloc(count * size + GUARD, 1), count * size) : NULL;
}

void *test_realloc(void *old, size_t size)
{
    return one_more() ? guarded(realloc(old, size + GUARD), size) : NULL;
}
