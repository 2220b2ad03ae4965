/* SPDX-License-Identifier: GPL-3.0-or-later */
/* io make CELLS: a stream of a grid of CELLS³ cells, six tetrahedra each, with random
 *     nodes, on standard output.
 * io read [THREADS] | io getline: reads a stream from standard input with all checks,
 *     or as a simple program would, with getline, strtol and strtod.
 * io both | io printf: what read does, then writes the stream to /dev/null, by the
 *     library or by fprintf with %.17g and %d. */
#include "../../lib/stream/stream.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void fail(const tm_error *error)
{
    fprintf(stderr, "io: line %zu: %s: %s\n", error->line, error->block, error->what);
    exit(EXIT_FAILURE);
}

static uint32_t node_at(uint32_t n, uint32_t x, uint32_t y, uint32_t z)
{
    return (z * (n + 1) + y) * (n + 1) + x;
}

static void fill_tets(tm_block *ele, uint32_t n)
{
    static const uint32_t corner[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                          {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    uint32_t *to = ele->integer;
    for (uint32_t z = 0; z < n; z++)
        for (uint32_t y = 0; y < n; y++)
            for (uint32_t x = 0; x < n; x++)
                for (int k = 0; k < 6; k++)
                    for (int i = 0; i < 4; i++) {
                        uint32_t c = corner[k][i];
                        *to++ =
                            node_at(n, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1));
                    }
}

/* Nodes of the grid, each moved by up to a fifth of a cell. */
static void make(uint32_t n)
{
    tm_error error = {0};
    tm_stream stream;
    tm_stream_init(&stream);
    tm_stream_add(&stream, ".node");
    tm_stream_add(&stream, ".ele");
    tm_block *node = tm_stream_find(&stream, ".node");
    tm_block *ele = tm_stream_find(&stream, ".ele");
    size_t side = (size_t)n + 1, cells = (size_t)n * n * n;
    if (tm_block_allocate(node, side * side * side, 0, &error) != TM_OK ||
        tm_block_allocate(ele, 6 * cells, 0, &error) != TM_OK)
        fail(&error);
    srand48(1);
    const double shake = 0.2;
    double *to = node->real;
    for (size_t z = 0; z < side; z++)
        for (size_t y = 0; y < side; y++)
            for (size_t x = 0; x < side; x++) {
                *to++ = ((double)x + shake * drand48()) / n;
                *to++ = ((double)y + shake * drand48()) / n;
                *to++ = ((double)z + shake * drand48()) / n;
            }
    fill_tets(ele, n);
    if (tm_stream_write(&stream, STDOUT_FILENO, 1, &error) != TM_OK)
        fail(&error);
    tm_stream_free(&stream);
}

static void read_stream(tm_stream *stream, unsigned threads)
{
    tm_error error = {0};
    tm_stream_init(stream);
    if (tm_stream_read(stream, STDIN_FILENO, "<stdin>", threads, &error) != TM_OK)
        fail(&error);
}

/* Reads one block's rows into arrays as one does. */
static void read_by_getline(void)
{
    char *line = NULL;
    size_t room = 0;
    double *xyz = NULL;
    long *tet = NULL;
    size_t nodes = 0, tets = 0;
    while (getline(&line, &room, stdin) > 0) {
        if (strcmp(line, ".node\n") == 0 && getline(&line, &room, stdin) > 0) {
            nodes = (size_t)strtol(line, NULL, 10);
            xyz = malloc(nodes * 3 * sizeof *xyz);
            for (size_t i = 0; i < nodes && getline(&line, &room, stdin) > 0; i++) {
                char *at = line;
                strtol(at, &at, 10);
                for (size_t k = 0; k < 3; k++)
                    xyz[3 * i + k] = strtod(at, &at);
            }
        } else if (strcmp(line, ".ele\n") == 0 && getline(&line, &room, stdin) > 0) {
            tets = (size_t)strtol(line, NULL, 10);
            tet = malloc(tets * 4 * sizeof *tet);
            for (size_t i = 0; i < tets && getline(&line, &room, stdin) > 0; i++) {
                char *at = line;
                strtol(at, &at, 10);
                for (size_t k = 0; k < 4; k++)
                    tet[4 * i + k] = strtol(at, &at, 10);
            }
        }
    }
    free(line);
    free(xyz);
    free(tet);
}

static void write_by_printf(const tm_stream *stream)
{
    FILE *null = fopen("/dev/null", "w");
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    for (size_t i = 0; i < node->count; i++)
        fprintf(null, "%zu %.17g %.17g %.17g\n", i, node->real[3 * i],
                node->real[3 * i + 1], node->real[3 * i + 2]);
    for (size_t i = 0; i < ele->count; i++) {
        const uint32_t *n = ele->integer + 4 * i;
        fprintf(null, "%zu %d %d %d %d\n", i, (int)n[0], (int)n[1], (int)n[2], (int)n[3]);
    }
    fclose(null);
}

int main(int argc, char **argv)
{
    const char *what = argc > 1 ? argv[1] : "";
    tm_error error = {0};
    tm_stream stream;
    if (strcmp(what, "make") == 0 && argc > 2) {
        make((uint32_t)atoi(argv[2]));
        return 0;
    }
    if (strcmp(what, "getline") == 0) {
        read_by_getline();
        return 0;
    }
    read_stream(&stream, argc > 2 ? (unsigned)atoi(argv[2]) : 1);
    if (strcmp(what, "printf") == 0)
        write_by_printf(&stream);
    if (strcmp(what, "both") == 0 &&
        tm_stream_write(&stream, open("/dev/null", O_WRONLY), 1, &error) != TM_OK)
        fail(&error);
    tm_stream_free(&stream);
    return 0;
}
