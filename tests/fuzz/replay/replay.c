/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gives a target the files of its corpus, one after the other, without a fuzzer:
 *
 *     TARGET FILE… */
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* The whole of a file; NULL with errno where it cannot be read. The bytes are where
 * reading one more is an error that a sanitizer sees. */
static uint8_t *read_file(FILE *file, size_t *size)
{
    if (fseek(file, 0, SEEK_END) != 0)
        return NULL;
    const long end = ftell(file);
    if (end < 0 || fseek(file, 0, SEEK_SET) != 0)
        return NULL;
    *size = (size_t)end;
    uint8_t *bytes = malloc(*size + !*size);
    if (bytes && fread(bytes, 1, *size, file) != *size) {
        free(bytes);
        return NULL;
    }
    return bytes;
}

static int replay(const char *name)
{
    FILE *file = fopen(name, "rb");
    size_t size = 0;
    uint8_t *bytes = file ? read_file(file, &size) : NULL;
    if (!bytes)
        perror(name);
    if (file)
        fclose(file);
    if (!bytes)
        return EXIT_FAILURE;
    fprintf(stderr, "%s\n", name);
    LLVMFuzzerTestOneInput(bytes, size);
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
