/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a rank's nodes of the interior boundary are closest to the surface. One search
 * begins where that of the node before it ended, in chunks of the whole boundary: of two
 * triangles that are as close that decides. So a rank also searches for those of the
 * ranks before it that are in the chunk of its first one. */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_octree_mesh *mesh;
    const tm_surface *surface;
    tm_own_range own;
    size_t begin;          /* of the chunk of the first own node */
    uint32_t (*before)[3]; /* [own.number - begin]: on the lattice */
} finder;

static void find_closest_of(void *context, size_t first, size_t past)
{
    const finder *f = context;
    tm_interior_boundary b = f->mesh->boundary;
    uint32_t guess = TM_NONE;
    for (size_t i = first; i < past; i++) {
        const size_t number = f->begin + i;
        const bool is_own = number >= f->own.number;
        const size_t s = is_own ? f->own.first + number - f->own.number : i;
        tm_surface_point other, *at = is_own ? &f->mesh->at[s] : &other;
        double xyz[3];
        b.grid = is_own ? f->mesh->boundary.grid : f->before;
        tm_boundary_node_point(&b, s, xyz);
        at->triangle = guess;
        tm_surface_closest(f->surface, xyz, TM_NONE, at);
        guess = at->triangle;
    }
}

/* How many of the nodes [first, past) a rank needs that has nodes from `number` on. */
static size_t needed(size_t number, size_t count, size_t first, size_t past,
                     size_t *begin)
{
    const size_t chunk = number - number % TM_CHUNK;
    *begin = first > chunk ? first : chunk;
    const size_t end = past < number ? past : number;
    return count > 0 && end > *begin ? end - *begin : 0;
}

/* Gets `before` of the ranks before this one. range[ranks]: what each has. */
static tm_status get_before(finder *f, const tm_own_range *range, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const size_t first = f->own.number, past = first + f->own.past - f->own.first;
    size_t *count = tm_new(ranks, sizeof *count), all = 0, begin;
    for (unsigned r = 0; count && r < ranks; r++)
        all += count[r] =
            needed(range[r].number, range[r].past - range[r].first, first, past, &begin);
    uint32_t(*send)[3] = tm_new(all, sizeof *send);
    tm_status status =
        tm_ranks_agree(count && send ? TM_OK : tm_fail_memory(error), error);
    void *got = NULL;
    all = 0;
    for (unsigned r = 0; status == TM_OK && r < ranks; r++) {
        needed(range[r].number, range[r].past - range[r].first, first, past, &begin);
        for (size_t i = 0; i < count[r]; i++)
            memcpy(send[all++], boundary->grid[f->own.first + begin - first + i],
                   sizeof *send);
    }
    if (status == TM_OK)
        status = tm_ranks_exchange(send, count, sizeof *send, &got, count, error);
    f->before = got;
    free(count);
    free(send);
    return status;
}

tm_status tm_octree_mesh_find_closest_on_ranks(tm_octree_mesh *mesh, tm_own_range own,
                                               const tm_surface *surface, tm_error *error)
{
    const size_t count = own.past - own.first;
    finder f = {.mesh = mesh,
                .surface = surface,
                .own = own,
                .begin = count > 0 ? own.number - own.number % TM_CHUNK : own.number};
    void *range = NULL;
    mesh->at = tm_new(mesh->boundary.nodes, sizeof *mesh->at);
    mesh->off_surface = calloc(mesh->boundary.nodes + 1, sizeof *mesh->off_surface);
    tm_status status = mesh->at && mesh->off_surface ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_ranks_share(&own, 1, sizeof own, &range, NULL, error);
    if (status == TM_OK)
        status = get_before(&f, range, error);
    if (status == TM_OK)
        tm_parallel_runs(surface->threads, own.number - f.begin + count, TM_CHUNK,
                         find_closest_of, &f);
    free(range);
    free(f.before);
    return status;
}
