/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh that ranks have parts of as a stream that they have slices of: each makes the
 * rows of what is its own, in the numbers of the whole mesh, and gives them to the ranks
 * whose slices they are in. */
#include "octree_mesh_stream.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"
#include "mesh_share.h"

#include <stdlib.h>
#include <string.h>

/* Rows that this rank has of a flat array of `total`, from row `before` on, to the slices
 * that they are in; this rank's slice gets what comes for it. */
typedef struct {
    size_t total, next;        /* the next row that comes, in the slice */
    size_t *count, *got_count; /* [ranks] */
} dealer;

static tm_status deal(dealer *d, const void *rows, size_t before, size_t count,
                      size_t size, char *slice, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t range[2] = {before, count};
    void *got = NULL;
    const tm_status status = tm_ranks_share(range, 1, sizeof range, &got, NULL, error);
    const size_t(*all)[2] = got;
    if (status != TM_OK)
        return status;
    for (unsigned r = 0; r < ranks; r++)
        d->got_count[r] =
            tm_slice_share(d->total, ranks, tm_rank(), all[r][0], all[r][1]);
    tm_slice_shares(d->total, ranks, before, count, d->count);
    tm_ranks_swap(rows, d->count, size, slice + d->next * size, d->got_count);
    for (unsigned r = 0; r < ranks; r++)
        d->next += d->got_count[r];
    free(got);
    return TM_OK;
}

/* Deals the nodes: of the octree, outer ones, middles. */
static tm_status deal_nodes(const tm_octree_mesh *m, dealer *d, const void *values,
                            size_t size, void *slice, tm_error *error)
{
    const tm_mesh_share *s = m->share;
    const tm_assembly *a = &m->assembly;
    const tm_own_range *own[] = {&s->core, &s->outer, &s->middles};
    const size_t begin[] = {0, a->outer, a->mesh.nodes - a->middles};
    tm_status status = TM_OK;
    size_t before = 0;
    d->next = 0;
    for (int i = 0; i < 3 && status == TM_OK; i++) {
        const char *rows = (const char *)values + (begin[i] + own[i]->first) * size;
        status = deal(d, rows, before + own[i]->number, own[i]->past - own[i]->first,
                      size, slice, error);
        before += own[i]->all;
    }
    return status;
}

static tm_status nodes_to_slices(const tm_octree_mesh *m, tm_slices *slices, size_t b,
                                 tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t total = m->share->nodes, first = tm_slice_first(total, ranks, tm_rank());
    tm_block *node = &slices->stream.block[b];
    node->count = tm_slice_first(total, ranks, tm_rank() + 1) - first;
    node->attributes = 1;
    node->real = tm_new(3 * node->count, sizeof *node->real);
    node->attribute = tm_new(node->count, sizeof *node->attribute);
    dealer d = {.total = total,
                .count = tm_new(ranks, sizeof *d.count),
                .got_count = tm_new(ranks, sizeof *d.got_count)};
    double *class = tm_octree_mesh_classes(m);
    tm_status status = tm_ranks_enough(
        node->real && node->attribute && d.count && d.got_count && class, error);
    if (status == TM_OK)
        status = deal_nodes(m, &d, m->assembly.mesh.xyz, sizeof *m->assembly.mesh.xyz,
                            node->real, error);
    if (status == TM_OK)
        status = deal_nodes(m, &d, class, sizeof *class, node->attribute, error);
    slices->slice[b] = (tm_slice){first, total};
    free(d.count);
    free(d.got_count);
    free(class);
    return status;
}

/* What this rank has made of each block, behind what those before it have; only rank 0's
 * of what all have made alike. */
static tm_status even_block(tm_slices *slices, size_t b, tm_error *error)
{
    tm_block *block = &slices->stream.block[b];
    static const char *const of_ranks[] = {".mix", ".octant", ".facet"};
    bool own = tm_rank() == 0;
    for (size_t i = 0; i < sizeof of_ranks / sizeof *of_ranks; i++)
        own |= strcmp(block->name, of_ranks[i]) == 0;
    if (!own)
        block->count = 0;
    if (!own && block->start)
        block->start[0] = 0;
    slices->slice[b].before = tm_ranks_before(block->count, &slices->slice[b].total);
    return strcmp(block->name, ".group") == 0 ? TM_OK : tm_slices_even(slices, b, error);
}

tm_status tm_octree_mesh_to_slices(tm_octree_mesh *mesh, const tm_octree_share *share,
                                   unsigned finest, tm_surface *surface, bool levels,
                                   tm_slices *slices, tm_error *error)
{
    tm_stream *stream = &slices->stream;
    tm_status status =
        tm_octree_mesh_rows(mesh, share, finest, surface, levels, stream, error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK)
        return status;
    slices->slice = calloc(stream->blocks, sizeof *slices->slice);
    status = tm_ranks_enough(slices->slice, error);
    for (size_t b = 1; b < stream->blocks && status == TM_OK; b++)
        status = even_block(slices, b, error);
    return status == TM_OK ? nodes_to_slices(mesh, slices, 0, error) : status;
}
