/* test_alloc.c - an allocator that fails at a chosen call.
 *
 * The library under test is compiled with -Dmalloc=test_malloc -Dcalloc=test_calloc -Drealloc=test_realloc. A test sets
 * test_allocations_left to k and all calls after the k-th return NULL, as they do when memory runs out. malloc has no
 * parameter through which the count could come, so here, and only here, a variable has file scope.
 */
#include "check.h"

int test_allocations_left = TEST_ALLOCATIONS_UNLIMITED;

static int one_more(void)
{
    if (test_allocations_left == 0)
        return 0;
    test_allocations_left--;
    return 1;
}

void *test_malloc(size_t size)
{
    return one_more() ? malloc(size) : NULL;
}

void *test_calloc(size_t count, size_t size)
{
    return one_more() ? calloc(count, size) : NULL;
}

void *test_realloc(void *old, size_t size)
{
    return one_more() ? realloc(old, size) : NULL;
}
