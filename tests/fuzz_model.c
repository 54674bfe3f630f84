/* fuzz_model.c - feeds arbitrary bytes to the readers of model and mesh files: `make fuzz`.
 *
 * An input that begins like a mesh file is read as one, by a small model that names it; any other is a model file. The
 * reader may refuse it, with a message, or accept it: then the model it built must stand a step. Built with clang's
 * libFuzzer this is the whole program; without it (-DSTANDALONE, for AFL++ or to repeat a finding) it reads the files
 * named as arguments. */
#define _POSIX_C_SOURCE 200809L
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../program/model.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { LARGE = 2000 };          /* elements and steps beyond which a run would only cost time */

static void write_bytes(const char *path, const void *data, size_t size)
{
    FILE *f = fopen(path, "wb");

    if (!f || fwrite(data, 1, size, f) != size || fclose(f))
        abort();
}

/* A status without a message, or a message without a status, is a finding. */
static void check_reader(const char *path)
{
    model p;

    if ((model_read(path, 0, NULL, &p) != 0) != (p.message[0] != '\0') || p.status < 0 || p.status > 2)
        abort();
    if (p.status == 0 && p.m->elements < LARGE) {
        p.m->par.pcg.iterations = 50;
        model_start(&p);
        bbm_step(p.m);
    }
    model_free(&p);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char head[] = "$MeshFormat";
    char path[64], text[256], mesh[64];

    snprintf(path, sizeof path, "/tmp/bbm_fuzz_%ld.model", (long)getpid());
    snprintf(mesh, sizeof mesh, "/tmp/bbm_fuzz_%ld.msh", (long)getpid());
    if (size >= sizeof head - 1 && memcmp(data, head, sizeof head - 1) == 0) {
        snprintf(text, sizeof text, "mesh %s\nmaterial m E 1 nu 0 density 1\nuse m on *\nfix set left\nstatic\n", mesh);
        write_bytes(path, text, strlen(text));
        write_bytes(mesh, data, size);
    } else {
        write_bytes(path, data, size);
    }
    check_reader(path);
    remove(path);
    remove(mesh);
    return 0;
}

#ifdef STANDALONE
int main(int argc, char *argv[])
{
    for (int k = 1; k < argc; k++) {
        FILE *f = fopen(argv[k], "rb");
        uint8_t *data = malloc(1 << 20);
        if (!f || !data)
            return 1;
        const size_t size = fread(data, 1, 1 << 20, f);
        fclose(f);
        LLVMFuzzerTestOneInput(data, size);
        free(data);
    }
    return 0;
}
#endif
