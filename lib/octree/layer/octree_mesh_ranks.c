/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of a share of an octree: each rank has that of its leaves and of the ghosts
 * around them. */
#include "octree_mesh_ranks.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"
#include "../../ranks/ranks.h"
#include "../../surface/surface_tree.h"
#include "octree_mesh_parts.h"
#include "skin.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_octree_mesh *mesh;
    const tm_octree_share *share;
    tm_surface *surface;
    tm_boundary_share boundary;
} maker;

static tm_boundary_view view_of(const maker *m)
{
    return (tm_boundary_view){.octree = &m->share->octree,
                              .boundary = &m->mesh->boundary,
                              .share = m->share,
                              .nodes = m->boundary.nodes,
                              .faces = m->boundary.faces};
}

/* The pieces of the boundary, and its Euler number. */
static tm_status measure_boundary(const maker *m, tm_boundary_pieces *pieces,
                                  tm_error *error)
{
    const tm_boundary_share *s = &m->boundary;
    tm_octree_mesh_report *r = &m->mesh->report;
    const tm_boundary_view view = view_of(m);
    size_t half_edges = 0;
    for (size_t f = s->faces.first; f < s->faces.past; f++)
        half_edges += tm_boundary_face_corners(&m->mesh->boundary, f);
    tm_ranks_sum(&half_edges, 1);
    const tm_status status = tm_boundary_pieces_find(pieces, &view, error);
    r->components = r->outer_components = pieces->count;
    r->euler = r->outer_euler =
        (int64_t)(s->nodes.all + s->faces.all) - (int64_t)(half_edges / 2);
    return status;
}

/* Where own nodes of the boundary are closest to the surface. One search begins where
 * that of the node before it ended, in chunks of the whole boundary: of two triangles
 * that are as close that decides. So a rank also searches for those of the ranks before
 * it that are in the chunk of its first one. */
typedef struct {
    tm_octree_mesh *mesh;
    const tm_surface *surface;
    tm_own_range own;
    size_t begin;          /* of the chunk of the first own node */
    uint32_t (*before)[3]; /* [own.number - begin]: on the lattice */
} closest_finder;

static void find_closest_of(void *context, size_t first, size_t past)
{
    const closest_finder *f = context;
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
static tm_status get_before(closest_finder *f, const tm_own_range *range, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const tm_interior_boundary *boundary = &f->mesh->boundary;
    const size_t first = f->own.number, past = first + f->own.past - f->own.first;
    size_t *count = tm_new(ranks, sizeof *count), all = 0, begin;
    for (unsigned r = 0; count && r < ranks; r++)
        all += count[r] =
            needed(range[r].number, range[r].past - range[r].first, first, past, &begin);
    uint32_t(*send)[3] = tm_new(all, sizeof *send);
    tm_status status = tm_ranks_enough(count && send, error);
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

static tm_status find_closest(tm_octree_mesh *mesh, tm_own_range own,
                              const tm_surface *surface, tm_error *error)
{
    const size_t count = own.past - own.first;
    closest_finder f = {.mesh = mesh,
                        .surface = surface,
                        .own = own,
                        .begin =
                            count > 0 ? own.number - own.number % TM_CHUNK : own.number};
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

static tm_status find_boundary_once(maker *m, tm_boundary_pieces *pieces, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_interior_boundary_free(&mesh->boundary);
    tm_boundary_share_free(&m->boundary);
    tm_boundary_pieces_free(pieces);
    free(mesh->at);
    free(mesh->off_surface);
    mesh->at = NULL;
    mesh->off_surface = NULL;
    tm_status status =
        tm_interior_boundary_find(&mesh->boundary, &m->share->octree, mesh->part, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_boundary_share_find(&m->boundary, m->share, &mesh->boundary, error);
    if (status == TM_OK)
        status = measure_boundary(m, pieces, error);
    return status == TM_OK ? find_closest(mesh, m->boundary.nodes, m->surface, error)
                           : status;
}

/* As find_boundary() of octree_mesh.c, but for what is in hollows. */
static tm_status find_boundary(maker *m, bool *alone, tm_error *error)
{
    tm_boundary_pieces pieces = {0};
    bool changed = false;
    tm_status status = find_boundary_once(m, &pieces, error);
    if (status == TM_OK && m->mesh->report.components > m->surface->components) {
        const tm_boundary_view view = view_of(m);
        status = tm_spurious_components_remove(m->mesh->part, &view, &pieces, m->surface,
                                               m->mesh->at, &changed, error);
    }
    if (status == TM_OK && changed)
        status = find_boundary_once(m, &pieces, error);
    for (size_t i = 0; status == TM_OK && i < pieces.count; i++)
        *alone |= m->surface->regions && pieces.piece[i].volume < 0;
    tm_boundary_pieces_free(&pieces);
    return status;
}

/* The boundary node here that has that number, or TM_NONE. */
static uint32_t node_here(const maker *m, uint32_t number)
{
    const size_t nodes = m->mesh->boundary.nodes;
    const size_t s = tm_first_not_below(m->boundary.number, nodes, number);
    return s < nodes && m->boundary.number[s] == number ? (uint32_t)s : TM_NONE;
}

/* This rank's part of the features of the whole boundary, and how that is cut. */
static void take_features(const maker *m, const tm_feature *of,
                          const tm_interior_boundary *skin)
{
    tm_feature *to = &m->mesh->feature;
    tm_interior_boundary *b = &m->mesh->boundary;
    for (size_t s = 0; s < b->nodes; s++) {
        const uint32_t n = m->boundary.number[s];
        to->kind[s] = of->kind[n];
        to->of[s] = of->of[n];
        for (int i = 0; i < 2; i++)
            to->along[s][i] =
                of->along[n][i] == TM_NONE ? TM_NONE : node_here(m, of->along[n][i]);
    }
    for (size_t f = 0; f < b->faces; f++)
        b->cut[f] = skin->cut[m->boundary.face_number[f]];
    to->corners_lost = of->corners_lost;
    to->curves_lost = of->curves_lost;
    to->lost = of->lost;
}

/* They are found on all ranks alike, each of which changes the surface's patches. */
static tm_status find_features(maker *m, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_interior_boundary skin = {0}, none = {.nodes = mesh->boundary.nodes};
    tm_surface bare = {0};
    tm_feature feature = {0};
    void *at = NULL;
    tm_status status = tm_feature_find(&mesh->feature, &none, &bare, NULL, error);
    status = tm_ranks_agree(status, error);
    if (status != TM_OK || m->surface->corners + m->surface->curves == 0)
        return status;
    status = tm_skin_share(&skin, &m->boundary, &mesh->boundary, error);
    if (status == TM_OK)
        status = tm_own_share(m->boundary.nodes, mesh->at, sizeof *mesh->at, &at, error);
    if (status == TM_OK)
        status = tm_ranks_agree(tm_feature_find(&feature, &skin, m->surface, at, error),
                                error);
    if (status == TM_OK)
        take_features(m, &feature, &skin);
    tm_feature_free(&feature);
    tm_interior_boundary_free(&skin);
    free(at);
    return status;
}

static tm_status make_elements(const maker *m, const tm_progress *progress,
                               tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    tm_progress_stage(progress, "assembling elements");
    tm_status status = tm_assemble(&mesh->assembly, &m->share->octree, mesh->part, 1,
                                   &mesh->boundary, error);
    mesh->share = calloc(1, sizeof *mesh->share);
    if (status == TM_OK && !mesh->share)
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_mesh_share_find(mesh->share, m->share, &mesh->assembly,
                                    &mesh->boundary, error);
    tm_progress_stage(progress, "projecting the layer");
    if (status == TM_OK)
        status = tm_project_layer(&mesh->assembly, &mesh->boundary, &mesh->feature,
                                  m->surface, mesh->at, mesh->share, error);
    if (status == TM_OK)
        status = tm_untangle_layer(mesh, &m->share->octree, m->surface, progress, error);
    return status;
}

static tm_status make(maker *m, const tm_progress *progress, bool *alone, tm_error *error)
{
    *alone = false;
    if (m->mesh->part->count == 0)
        return tm_octree_mesh_fail_empty(error);
    tm_progress_stage(progress, "finding the interior boundary");
    tm_status status = find_boundary(m, alone, error);
    if (status != TM_OK || *alone)
        return status;
    tm_progress_stage(progress, "matching features");
    status = find_features(m, error);
    if (status == TM_OK)
        status = make_elements(m, progress, error);
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_octree_mesh_complete_report(m->mesh, &m->share->octree, m->surface, error),
            error);
    return status;
}

tm_status tm_octree_mesh_make_on_ranks(tm_octree_mesh *mesh, const tm_octree_share *share,
                                       tm_interior *interior, tm_surface *surface,
                                       const tm_progress *progress, bool *alone,
                                       tm_error *error)
{
    maker m = {.mesh = mesh, .share = share, .surface = surface};
    const size_t bytes = surface->triangles * sizeof *surface->patch;
    uint32_t *patch = tm_new(surface->triangles, sizeof *patch);
    *mesh = (tm_octree_mesh){.part = calloc(1, sizeof *mesh->part)};
    tm_status status = tm_ranks_enough(mesh->part && patch, error);
    if (status == TM_OK) {
        mesh->parts = 1;
        *mesh->part = *interior;
        *interior = (tm_interior){0};
        memcpy(patch, surface->patch, bytes);
        status = make(&m, progress, alone, error);
        memcpy(surface->patch, patch, bytes);
        tm_surface_tree_refresh(surface);
    }
    free(patch);
    tm_boundary_share_free(&m.boundary);
    return status;
}
