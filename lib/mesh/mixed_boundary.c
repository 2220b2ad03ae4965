/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_boundary.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "face_table.h"

#include <stdlib.h>

static double region_of(const tm_mixed_regions *regions, uint32_t half)
{
    return regions->value[regions->stride * regions->origin[half >> TM_FACE_SHIFT]];
}

/* Whether a half face is one of those that are listed. */
static bool is_listed(const tm_mixed_regions *regions, uint32_t half, uint32_t mate)
{
    return half == mate || (regions->value && half < mate && mate != TM_NONE &&
                            region_of(regions, half) != region_of(regions, mate));
}

tm_status tm_mixed_boundary_faces(const tm_mixed_mesh *mesh, uint32_t **face,
                                  size_t *faces, tm_error *error)
{
    return tm_mixed_region_faces(mesh, &(tm_mixed_regions){0}, face, faces, error);
}

typedef struct lister {
    const tm_mixed_regions *regions;
    const uint32_t *mate;
    size_t *count; /* [chunks of half faces]; then where theirs go: */
    uint32_t *face;
} lister;

static void count_chunk(void *context, size_t first, size_t past)
{
    const lister *l = context;
    size_t count = 0;
    for (size_t half = first; half < past; half++)
        count += is_listed(l->regions, (uint32_t)half, l->mate[half]);
    l->count[first / TM_CHUNK] = count;
}

static void list_chunk(void *context, size_t first, size_t past)
{
    const lister *l = context;
    size_t next = l->count[first / TM_CHUNK];
    for (size_t half = first; half < past; half++)
        if (is_listed(l->regions, (uint32_t)half, l->mate[half]))
            l->face[next++] = (uint32_t)half;
}

static bool list(lister *l, size_t halves, unsigned threads, size_t *faces)
{
    const size_t chunks = tm_parallel_chunks(halves, TM_CHUNK);
    l->count = tm_new(chunks, sizeof *l->count);
    if (!l->count)
        return false;
    tm_parallel_runs(threads, halves, TM_CHUNK, count_chunk, l);
    for (size_t i = 0; i < chunks; i++) {
        const size_t count = l->count[i];
        l->count[i] = *faces;
        *faces += count;
    }
    l->face = tm_new(*faces, sizeof *l->face);
    if (l->face)
        tm_parallel_runs(threads, halves, TM_CHUNK, list_chunk, l);
    free(l->count);
    return l->face != NULL;
}

tm_status tm_mixed_region_faces(const tm_mixed_mesh *mesh,
                                const tm_mixed_regions *regions, uint32_t **face,
                                size_t *faces, tm_error *error)
{
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .elements = mesh->elements,
                               .start = mesh->start,
                               .item = mesh->item,
                               .threads = mesh->threads};
    *face = NULL;
    *faces = 0;
    uint32_t *mate;
    tm_status status = tm_face_mates(&mate, &view, error);
    lister l = {.regions = regions, .mate = mate};
    if (status == TM_OK &&
        !list(&l, mesh->elements << TM_FACE_SHIFT, mesh->threads, faces)) {
        *faces = 0;
        status = tm_fail_memory(error);
    }
    *face = l.face;
    free(mate);
    return status;
}
