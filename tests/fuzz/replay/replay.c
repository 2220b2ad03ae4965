/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gives a target the files of its corpus, one after the other, without a fuzzer:
 *
 *     TARGET FILE… */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* The bytes are where reading one more is an error that a sanitizer sees. */
static int replay(const char *name)
{
    FILE *file = fopen(name, "rb");
    long size = -1;
    uint8_t *bytes = NULL;
    if (file && fseek(file, 0, SEEK_END) == 0)
        size = ftell(file);
    if (size >= 0)
        bytes = malloc((size_t)size + !size);
    if (!bytes || fseek(file, 0, SEEK_SET) != 0 ||
        fread(bytes, 1, (size_t)size, file) != (size_t)size) {
        perror(name);
        free(bytes);
        return EXIT_FAILURE;
    }
    fclose(file);
    fprintf(stderr, "%s\n", name);
    LLVMFuzzerTestOneInput(bytes, (size_t)size);
    free(bytes);
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    int status = argc > 1 ? EXIT_SUCCESS : EXIT_FAILURE;
    for (int i = 1; i < argc && status == EXIT_SUCCESS; i++)
        status = replay(argv[i]);
    return status;
}
