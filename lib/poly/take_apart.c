/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "take_apart.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "item_sets.h"
#include "simple.h"

#include <pthread.h>
#include <stdlib.h>

/* So many regions are taken by one thread, one after the other. */
enum { CHUNK = 256 };

typedef struct {
    size_t taken_apart;
    bool done; /* false: memory is out */
} chunk_result;

typedef struct {
    const tm_shelling *all;
    const uint32_t *label;
    tm_item_lists list;
    chunk_result *result; /* [chunks] */
    pthread_t caller;     /* that is told of progress */
    tm_progress_at at;
} work;

/* A region and its pieces: number `first` and those that follow. */
typedef struct {
    const uint32_t *tet;
    size_t count;
    uint32_t first;
    size_t pieces;
} region;

/* Gives all of a region to one piece, if that is a ball. */
static tm_status try_whole(tm_shelling *s, const region *r, bool *simple)
{
    uint32_t *old = tm_new(r->count, sizeof *old);
    if (!old)
        return TM_ERROR_SYSTEM;
    for (size_t k = 0; k < r->count; k++) {
        old[k] = s->piece[r->tet[k]];
        tm_set_piece(s->piece, r->tet[k], r->first);
    }
    tm_status status =
        tm_tets_are_simple(s->mesh, s->piece, r->first, r->tet, r->count, simple, NULL);
    for (size_t k = 0; k < r->count && !*simple; k++)
        tm_set_piece(s->piece, r->tet[k], old[k]);
    free(old);
    return status;
}

/* Whether a kept face is between two tetrahedra of the region. */
static bool has_face_inside(const tm_shelling *s, const region *r)
{
    for (size_t k = 0; k < r->count; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t across = tm_tet_across(s->mesh, r->tet[k], i);
            if (!(s->mesh->neighbour[r->tet[k]][i] & TM_FACE_BIT) || across == TM_NONE)
                continue;
            const uint32_t piece = tm_piece_of(s->piece, across / 4);
            if (piece >= r->first && piece - r->first < r->pieces)
                return true;
        }
    return false;
}

/* Takes one region apart; *apart is how many are. False where memory is out. */
static bool take_region(tm_shelling *s, const uint32_t *label, region *r, size_t *apart)
{
    const tm_poly_options *o = s->options;
    bool only_simple = !o->star && !o->no_swallow && o->max_tets == 0, simple = false;
    for (size_t k = 0; k < r->count; k++) {
        if (s->piece[r->tet[k]] != TM_NONE)
            continue;
        if (!tm_shelling_begin(s, r->first + (uint32_t)r->pieces++, r->tet[k]) ||
            !tm_shelling_grow(s, label, label[r->tet[k]]))
            return false;
    }
    if (r->pieces > 1 && only_simple && !has_face_inside(s, r) &&
        try_whole(s, r, &simple) != TM_OK)
        return false;
    *apart += r->pieces > 1 && !simple;
    return true;
}

static void tell(work *w, size_t done)
{
    if (!pthread_equal(pthread_self(), w->caller))
        return;
    w->at.done = done;
    tm_progress_tell(w->all->options->progress, &w->at);
}

static void take_chunk(void *context, size_t from, size_t to)
{
    work *w = context;
    chunk_result *result = &w->result[from / CHUNK];
    tm_shelling s;
    const uint32_t *start = w->list.start;
    tell(w, from);
    tm_shelling_fork(&s, w->all);
    result->done = true;
    for (size_t k = from; k < to && result->done; k++) {
        region r = {w->list.item + start[k], start[k + 1] - start[k], start[k], 0};
        result->done = take_region(&s, w->label, &r, &result->taken_apart);
    }
    tm_shelling_end(&s);
}

tm_status tm_take_apart(tm_shelling *s, const uint32_t *label, tm_poly_report *report,
                        tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(report->regions, CHUNK);
    const bool is_ordered = s->options->star == TM_STAR_CENTROID;
    work w = {.all = s,
              .label = label,
              .result = calloc(chunks + 1, sizeof *w.result),
              .caller = pthread_self(),
              .at = {.what = "taking regions apart", .of = report->regions}};
    bool done = w.result && tm_item_lists_make(&w.list, label, s->mesh->slots,
                                               report->regions + 1, NULL);
    if (done)
        tm_parallel_runs(is_ordered ? 1 : s->options->threads, report->regions, CHUNK,
                         take_chunk, &w);
    for (size_t c = 0; c < chunks && done; c++) {
        report->taken_apart += w.result[c].taken_apart;
        done = w.result[c].done;
    }
    tm_item_lists_free(&w.list);
    free(w.result);
    return done ? TM_OK : tm_fail_memory(error);
}
