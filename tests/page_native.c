/* page_native.c - a model run by the page's calls, outside a browser: the bits of its vertices.
 *     page_native MODEL */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "../page/page.h"

int main(int argc, char *argv[])
{
    page *g = argc == 2 ? page_load(argv[1]) : NULL;

    while (g && page_state(g) == 0)
        page_step(g);
    for (int n = g ? page_numbers(g, 'v') : 0, k = 0; k < n; k++) {
        uint64_t bits;
        memcpy(&bits, &page_data(g)[k], sizeof bits);
        printf("%" PRIx64 "\n", bits);
    }
    page_free(g);
    return 0;
}
