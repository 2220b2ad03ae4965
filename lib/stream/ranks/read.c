/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading: rank 0 reads as one process does, and what is between the rows of blocks it
 * reads alone; when it comes to rows, it tells the others, and all read some. */
#include "slices.h"

#include "../../ranks/ranks.h"
#include "../block.h"
#include "../reader.h"
#include "deal.h"
#include "part.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What rank 0 tells before each block, and at the end. */
typedef struct {
    bool end;
    char name[TM_BLOCK_NAME];
    size_t attributes;
    bool markers;
    unsigned base;
    size_t rows, limit;
    size_t begin, past; /* of a regular file: bytes that the rows are in */
} announcement;

typedef struct {
    tm_slices *slices;
    int fd;
    bool regular;
    bool agreed;           /* upon an error */
    tm_block_places place; /* of a regular file */
} slices_reader;

/* One more slice, of a block that has just been added. */
static bool grow(tm_slices *s)
{
    tm_slice *grown = realloc(s->slice, s->stream.blocks * sizeof *grown);
    if (!grown)
        return false;
    s->slice = grown;
    grown[s->stream.blocks - 1] = (tm_slice){0, 0};
    return true;
}

/* All rows of a block, on all ranks. Then each has its slice. Of a file *lines is how
 * many lines that were. */
static tm_status read_rows(slices_reader *s, tm_reader *r, tm_block *block,
                           const announcement *a, size_t *lines)
{
    const size_t b = (size_t)(block - s->slices->stream.block);
    size_t before = tm_slice_first(a->rows, tm_ranks_count(), tm_rank());
    tm_status status = s->regular
                           ? tm_part_read(r, s->fd, block, a->begin, a->past, a->rows,
                                          a->limit, &before, lines, r->error)
                           : tm_deal_rows(r, block, a->rows, a->limit, r->error);
    s->slices->slice[b] = (tm_slice){before, a->rows};
    s->agreed = status != TM_OK;
    return status;
}

/* Rank 0 goes on behind the rows; fewer than the header says is an error. */
static tm_status go_on(tm_reader *r, const tm_block *block, const announcement *a,
                       size_t lines, size_t count)
{
    const slices_reader *s = r->with;
    tm_status status = TM_OK;
    if (s->regular)
        status = tm_lines_skip(&r->lines, a->past, lines, r->error);
    if (status == TM_OK && count < a->rows)
        status = tm_reader_find_row(r, block, count, a->rows);
    return status;
}

/* A block that rank 0 has announced. */
static tm_status read_together(tm_reader *r, tm_block *block, const announcement *a)
{
    slices_reader *s = r->with;
    size_t lines = 0, count;
    tm_status status = read_rows(s, r, block, a, &lines);
    if (status != TM_OK)
        return status;
    tm_ranks_before(block->count, &count);
    if (tm_rank() == 0)
        status = go_on(r, block, a, lines, count);
    status = tm_ranks_agree(status, r->error);
    if (status == TM_OK)
        status = tm_slices_even(s->slices, (size_t)(block - s->slices->stream.block),
                                r->error);
    s->agreed = status != TM_OK;
    return status;
}

static bool is_text(const tm_block *block)
{
    return block->kind == TM_UNKNOWN || block->kind == TM_GROUP;
}

/* Rank 0 is behind the header of a block. */
static tm_status announce(tm_reader *r, tm_block *block, size_t rows, size_t limit)
{
    slices_reader *s = r->with;
    announcement a = {.attributes = block->attributes,
                      .markers = block->markers,
                      .rows = rows,
                      .limit = limit};
    tm_status status = grow(s->slices) ? TM_OK : tm_fail_memory(r->error);
    r->names.slice = s->slices->slice;
    memcpy(a.name, block->name, sizeof a.name);
    if (status == TM_OK && is_text(block)) {
        status = tm_reader_read_block(r, block, rows, limit);
        s->slices->slice[s->slices->stream.blocks - 1].total = block->count;
    } else if (status == TM_OK && rows > 0) {
        status = tm_reader_find_row(r, block, 0, rows);
    }
    if (status != TM_OK)
        return status;
    a.base = s->slices->stream.base;
    a.begin = tm_lines_place(&r->lines);
    a.past = s->regular ? tm_block_places_next(&s->place, a.begin) : 0;
    tm_ranks_broadcast(&a, sizeof a);
    status = tm_ranks_enough(true, r->error);
    s->agreed = status != TM_OK;
    return status == TM_OK && !is_text(block) ? read_together(r, block, &a) : status;
}

/* A block as rank 0 says that it is; NULL where memory is out. */
static tm_block *add_announced(tm_reader *r, const announcement *a)
{
    slices_reader *s = r->with;
    tm_block *block = tm_stream_add(r->stream, a->name);
    if (!block || !tm_block_names_add(&r->names) || !grow(s->slices))
        return NULL;
    block->attributes = a->attributes;
    block->markers = a->markers;
    r->stream->base = a->base;
    r->names.slice = s->slices->slice;
    return block;
}

/* The others: what rank 0 tells, until the end. */
static tm_status follow(tm_reader *r)
{
    slices_reader *s = r->with;
    announcement a;
    for (;;) {
        tm_ranks_broadcast(&a, sizeof a);
        if (a.end)
            return tm_stream_check_references(&r->names, r->lines.name, r->error);
        tm_block *block = add_announced(r, &a);
        tm_status status = tm_ranks_enough(block, r->error);
        s->agreed = status != TM_OK;
        if (status == TM_OK && !is_text(block))
            status = read_together(r, block, &a);
        if (status != TM_OK)
            return status;
    }
}

/* Rank 0, from the first line to the last. */
static tm_status lead(tm_reader *r)
{
    const slices_reader *s = r->with;
    announcement end = {.end = true};
    const tm_status status = tm_reader_read(r);
    if (!s->agreed)
        tm_ranks_broadcast(&end, sizeof end);
    return status;
}

/* Whether the file is regular and its bytes are as they are, for rank 0; its size. */
static bool is_regular(int fd, size_t *size)
{
    struct stat status;
    unsigned char first[2] = {0, 0};
    static const unsigned char gzip[2] = {0x1f, 0x8b};
    if (fstat(fd, &status) != 0 || !S_ISREG(status.st_mode))
        return false;
    *size = (size_t)status.st_size;
    return lseek(fd, 0, SEEK_CUR) == 0 &&
           (pread(fd, first, sizeof first, 0) < 2 || memcmp(first, gzip, 2) != 0);
}

static tm_status begin(slices_reader *s, tm_reader *r, const char *name)
{
    size_t size = 0;
    if (tm_rank() == 0)
        s->regular = is_regular(s->fd, &size);
    tm_ranks_broadcast(&s->regular, sizeof s->regular);
    tm_ranks_broadcast(&size, sizeof size);
    tm_status status = TM_OK;
    r->lines.name = name;
    if (tm_rank() == 0)
        status = tm_lines_open(&r->lines, s->fd, name, r->stream->progress, r->error);
    status = tm_ranks_agree(status, r->error);
    return status == TM_OK && s->regular
               ? tm_block_places_find(&s->place, s->fd, size, name, r->error)
               : status;
}

tm_status tm_slices_read(tm_slices *slices, int fd, const char *name, unsigned threads,
                         tm_error *error)
{
    tm_error unused;
    tm_reader r;
    slices_reader s = {.slices = slices, .fd = fd};
    tm_reader_init(&r, &slices->stream, threads, error ? error : &unused);
    r.read_block = announce;
    r.with = &s;
    tm_status status = begin(&s, &r, name);
    if (status == TM_OK) {
        status = tm_rank() == 0 ? lead(&r) : follow(&r);
        if (!s.agreed)
            status = tm_ranks_agree(status, r.error);
    }
    tm_block_places_free(&s.place);
    tm_reader_free(&r);
    if (status != TM_OK)
        tm_slices_free(slices);
    return status;
}

void tm_slices_free(tm_slices *slices)
{
    free(slices->slice);
    slices->slice = NULL;
    tm_stream_free(&slices->stream);
}

tm_block *tm_slices_find(const tm_slices *slices, const char *name, tm_slice *slice)
{
    tm_block *block = tm_stream_find(&slices->stream, name);
    if (block)
        *slice = slices->slice[block - slices->stream.block];
    return block;
}
