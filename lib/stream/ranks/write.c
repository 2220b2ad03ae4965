/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "../writer.h"
#include "pass.h"

#include <stdlib.h>

/* In order, by rank 0 ------------------------------------------------------------------
 */

static tm_status put_message(void *to, const char *bytes, size_t size, tm_error *error)
{
    (void)to;
    (void)error;
    tm_pass_text(bytes, size);
    return TM_OK;
}

/* Those of rank 0, then of the others. */
static tm_status collect_rows(const tm_slices *s, size_t b, int fd, unsigned threads,
                              tm_writing *writing, tm_error *error)
{
    const tm_block *block = &s->stream.block[b];
    const tm_sink sink = {tm_sink_put_fd, &fd};
    tm_status status = tm_put_name(block, &sink, error);
    if (status == TM_OK)
        status = tm_put_header(block, s->slice[b].total, &sink, error);
    if (status == TM_OK)
        status = tm_put_rows(block, 0, s->stream.base, threads, &sink, writing, error);
    return tm_pass_on(fd, status, error);
}

static tm_status send_rows(const tm_slices *s, size_t b, unsigned threads,
                           tm_writing *writing, tm_error *error)
{
    const tm_block *block = &s->stream.block[b];
    const tm_sink sink = {put_message, NULL};
    tm_status status = TM_OK;
    if (block->count > 0)
        status = tm_put_rows(block, s->slice[b].before, s->stream.base, threads, &sink,
                             writing, error);
    tm_pass_end();
    return status;
}

tm_status tm_slices_write(const tm_slices *slices, int fd, unsigned threads,
                          tm_error *error)
{
    const bool first = tm_rank() == 0;
    const tm_sink sink = {tm_sink_put_fd, &fd};
    tm_writing writing = {slices->stream.progress, {.what = "writing"}};
    tm_status status = TM_OK;
    if (first)
        status = tm_put_begin(&slices->stream, &sink, error);
    status = tm_ranks_agree(status, error);
    for (size_t b = 0; b < slices->stream.blocks && status == TM_OK; b++) {
        status = first ? collect_rows(slices, b, fd, threads, &writing, error)
                       : send_rows(slices, b, threads, &writing, error);
        status = tm_ranks_agree(status, error);
    }
    if (status == TM_OK && first)
        status = tm_put_end(&sink, error);
    return tm_ranks_agree(status, error);
}

/* Each its part of a file --------------------------------------------------------------
 */

static tm_status count_bytes(void *to, const char *bytes, size_t size, tm_error *error)
{
    (void)bytes;
    (void)error;
    *(size_t *)to += size;
    return TM_OK;
}

typedef struct {
    tm_ranks_file *file;
    size_t at;
} file_writer;

static tm_status put_at(void *to, const char *bytes, size_t size, tm_error *error)
{
    file_writer *w = to;
    const tm_status status = tm_ranks_file_put(w->file, w->at, bytes, size, error);
    w->at += size;
    return status;
}

/* What this rank has of block b: rank 0 its name and its header, too, and what is before
 * the first block. */
static tm_status put_part(const tm_slices *s, size_t b, unsigned threads,
                          const tm_sink *sink, tm_writing *writing, tm_error *error)
{
    const tm_block *block = &s->stream.block[b];
    tm_status status = TM_OK;
    if (tm_rank() == 0 && b == 0)
        status = tm_put_begin(&s->stream, sink, error);
    if (tm_rank() == 0 && status == TM_OK)
        status = tm_put_name(block, sink, error);
    if (tm_rank() == 0 && status == TM_OK)
        status = tm_put_header(block, s->slice[b].total, sink, error);
    if (status == TM_OK && block->count + block->text.size > 0)
        status = tm_put_rows(block, s->slice[b].before, s->stream.base, threads, sink,
                             writing, error);
    return status;
}

/* Where in the file this rank's part of each block begins; *end is that of the last one.
 */
static tm_status find_places(const tm_slices *s, unsigned threads, size_t *place,
                             size_t *end, tm_error *error)
{
    tm_writing nobody = {0};
    tm_status status = TM_OK;
    *end = 0;
    for (size_t b = 0; b < s->stream.blocks; b++) {
        size_t bytes = 0, all;
        const tm_sink sink = {count_bytes, &bytes};
        if (status == TM_OK)
            status = put_part(s, b, threads, &sink, &nobody, error);
        place[b] = *end + tm_ranks_before(bytes, &all);
        *end += all;
    }
    return tm_ranks_agree(status, error);
}

static tm_status put_parts(const tm_slices *s, unsigned threads, tm_ranks_file *file,
                           const size_t *place, size_t end, tm_error *error)
{
    file_writer w = {.file = file};
    const tm_sink sink = {put_at, &w};
    tm_writing writing = {s->stream.progress, {.what = "writing"}};
    tm_status status = TM_OK;
    for (size_t b = 0; b < s->stream.blocks && status == TM_OK; b++) {
        w.at = place[b];
        status = put_part(s, b, threads, &sink, &writing, error);
    }
    w.at = end;
    if (status == TM_OK && tm_rank() == 0)
        status = tm_put_end(&sink, error);
    return status;
}

tm_status tm_slices_write_file(const tm_slices *slices, const char *name,
                               unsigned threads, tm_error *error)
{
    size_t *place = tm_new(slices->stream.blocks, sizeof *place), end;
    tm_ranks_file *file = NULL;
    tm_status status = tm_ranks_enough(place, error);
    if (status == TM_OK)
        status = find_places(slices, threads, place, &end, error);
    if (status == TM_OK)
        status = tm_ranks_file_open(&file, name, error);
    if (status == TM_OK) {
        tm_error of_closing;
        status = put_parts(slices, threads, file, place, end, error);
        const tm_status closed = tm_ranks_file_close(&file, &of_closing);
        status = tm_ranks_agree(status, error);
        if (status == TM_OK && closed != TM_OK)
            status = tm_fail_as(error, &of_closing);
    }
    free(place);
    return status;
}
