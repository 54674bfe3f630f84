/* wrong.c - ./bbm on one wrong model after the other, in one process: the sanitizers find what one of
 * them does not release, or leaves behind for the next.
 *
 *     wrong FOLDER MODEL ...
 *
 * Each must end with status 2. */
int bbm_main(int argc, char *argv[]);

#define main bbm_main
#include "../program/main.c"
#undef main

int main(int argc, char *argv[])
{
    char name[] = "bbm", folder[] = "-o";

    for (int k = 2; k < argc; k++) {
        const int status = bbm_main(4, (char *[]){ name, argv[k], folder, argv[1], NULL });
        if (status != 2) {
            fprintf(stderr, "%s: status %d in place of 2\n", argv[k], status);
            return EXIT_FAILURE;
        }
    }
    return EXIT_SUCCESS;
}
