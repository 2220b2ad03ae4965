/* SPDX-License-Identifier: GPL-3.0-or-later */
/* slices_copy IN OUT: a stream through slices, by all ranks; "-" is standard input or
 * output, OUT is there. Before it is written each rank fetches nodes from all over the
 * mesh and compares them with what the node's own rank makes of its number. Used by
 * tests/cli/ranks.bats. */
#include "../../lib/base/array.h"
#include "../../lib/ranks/ranks.h"
#include "../../lib/stream/ranks/slices.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void stop_at(tm_status status, const tm_error *error)
{
    if (status == TM_OK)
        return;
    if (tm_rank() == 0)
        fprintf(stderr, "%s:%zu: %s: %s\n", error->file, error->line, error->block,
                error->what);
    exit(tm_rank() == 0 ? (int)status : EXIT_SUCCESS);
}

/* Every rank asks for every 7th node of all. What comes is added up; so is, by its owner,
 * what should. */
static void check_fetch(const tm_slices *s)
{
    enum { STEP = 7 };
    tm_slice slice;
    tm_error error;
    const tm_block *node = tm_slices_find(s, ".node", &slice);
    if (!node)
        return;
    const size_t count = slice.total / STEP + (slice.total % STEP != 0);
    uint32_t *number = tm_new(count, sizeof *number);
    double(*xyz)[3] = tm_new(count, sizeof *xyz);
    for (size_t i = 0; i < count; i++)
        number[i] = (uint32_t)(STEP * i);
    stop_at(
        tm_slices_fetch(node->real, slice.total, sizeof *xyz, number, count, xyz, &error),
        &error);
    size_t wrong = 0;
    for (size_t i = 0; i < count; i++)
        if (number[i] >= slice.before && number[i] - slice.before < node->count)
            wrong += memcmp(xyz[i], node->real + 3 * (number[i] - slice.before),
                            sizeof *xyz) != 0;
    double *sum = calloc(2 * (size_t)tm_ranks_count(), sizeof *sum);
    for (size_t i = 0; i < count; i++)
        sum[0] += xyz[i][0] + xyz[i][1] + xyz[i][2];
    sum[1] = -sum[0];
    tm_ranks_least(sum, 2);
    if (wrong > 0 || sum[0] != -sum[1]) {
        fprintf(stderr, "rank %u: %zu nodes are not what was asked for\n", tm_rank(),
                wrong);
        tm_ranks_end(1);
    }
    free(number);
    free(xyz);
    free(sum);
}

int main(int argc, char **argv)
{
    tm_error error;
    tm_slices slices = {0};
    if (argc != 3)
        return 2;
    stop_at(tm_ranks_start(&error), &error);
    tm_stream_init(&slices.stream);
    const bool pipe_in = strcmp(argv[1], "-") == 0, pipe_out = strcmp(argv[2], "-") == 0;
    const int fd = pipe_in ? STDIN_FILENO : open(argv[1], O_RDONLY);
    stop_at(tm_slices_read(&slices, fd, argv[1], 2, &error), &error);
    check_fetch(&slices);
    stop_at(pipe_out ? tm_slices_write(&slices, STDOUT_FILENO, 2, &error)
                     : tm_slices_write_file(&slices, argv[2], 2, &error),
            &error);
    tm_slices_free(&slices);
    return 0;
}
