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

/* A piece of the boundary, or what a rank has of it. */
typedef struct {
    uint32_t label;
    double volume; /* six times that which it encloses; negative: a hollow */
} piece;

static int compare_pieces(const void *a, const void *b)
{
    const piece *p = a, *q = b;
    return (p->label > q->label) - (p->label < q->label);
}

/* Six times the volume between the origin and triangle abc of boundary nodes. */
static double cone(const tm_interior_boundary *b, uint32_t i, uint32_t j, uint32_t k)
{
    const uint32_t *p = b->grid[i], *q = b->grid[j], *r = b->grid[k];
    const double px = p[0], py = p[1], pz = p[2];
    return px * ((double)q[1] * r[2] - (double)q[2] * r[1]) +
           py * ((double)q[2] * r[0] - (double)q[0] * r[2]) +
           pz * ((double)q[0] * r[1] - (double)q[1] * r[0]);
}

/* What this rank has of pieces: one for each of its faces, those of a label joined. */
static size_t list_pieces(const maker *m, const uint32_t *label, piece *list)
{
    const tm_interior_boundary *b = &m->mesh->boundary;
    size_t count = 0, joined = 0;
    for (size_t f = m->boundary.faces.first; f < m->boundary.faces.past; f++) {
        const uint32_t *face = b->face[f];
        piece *p = &list[count++];
        *p = (piece){label[b->grid_node[face[0]]], cone(b, face[0], face[1], face[2])};
        if (tm_boundary_face_corners(b, f) == 4)
            p->volume += cone(b, face[0], face[2], face[3]);
    }
    if (count > 0)
        qsort(list, count, sizeof *list, compare_pieces);
    for (size_t i = 0; i < count; i++)
        if (joined > 0 && list[joined - 1].label == list[i].label)
            list[joined - 1].volume += list[i].volume;
        else
            list[joined++] = list[i];
    return joined;
}

/* Whether any piece is that of a hollow. */
static tm_status find_hollows(const maker *m, const uint32_t *label, bool *hollow,
                              tm_error *error)
{
    piece *list = tm_new(m->boundary.faces.past - m->boundary.faces.first, sizeof *list);
    void *got = NULL;
    size_t total = 0;
    tm_status status = tm_ranks_agree(list ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK)
        status = tm_ranks_share(list, list_pieces(m, label, list), sizeof *list, &got,
                                &total, error);
    piece *all = got;
    if (status == TM_OK && total > 0)
        qsort(all, total, sizeof *all, compare_pieces);
    double volume = 0;
    *hollow = false;
    for (size_t i = 0; status == TM_OK && i < total; i++) {
        volume = (i > 0 && all[i].label == all[i - 1].label ? volume : 0) + all[i].volume;
        if (i + 1 == total || all[i + 1].label != all[i].label)
            *hollow |= volume < 0;
    }
    free(list);
    free(all);
    return status;
}

/* The pieces of the boundary, its Euler number, and whether one is of a hollow. */
static tm_status measure_boundary(const maker *m, bool *hollow, tm_error *error)
{
    const tm_interior_boundary *b = &m->mesh->boundary;
    const tm_boundary_share *s = &m->boundary;
    tm_octree_mesh_report *r = &m->mesh->report;
    const size_t nodes = m->share->octree.nodes;
    uint32_t *parent = tm_new(nodes, sizeof *parent);
    size_t sums[2] = {0, 0}; /* half edges, pieces */
    tm_status status = tm_ranks_agree(parent ? TM_OK : tm_fail_memory(error), error);
    for (size_t i = 0; status == TM_OK && i < nodes; i++)
        parent[i] = (uint32_t)i;
    for (size_t f = s->faces.first; status == TM_OK && f < s->faces.past; f++) {
        const unsigned k = tm_boundary_face_corners(b, f);
        sums[0] += k;
        for (unsigned i = 1; i < k; i++)
            tm_set_unite(parent, b->grid_node[b->face[f][0]],
                         b->grid_node[b->face[f][i]]);
    }
    if (status == TM_OK)
        status = tm_share_join_sets(m->share, parent, error);
    for (size_t i = s->nodes.first; status == TM_OK && i < s->nodes.past; i++)
        sums[1] += parent[b->grid_node[i]] == m->share->node_number[b->grid_node[i]];
    tm_ranks_sum(sums, 2);
    if (status == TM_OK)
        status = find_hollows(m, parent, hollow, error);
    r->components = r->outer_components = sums[1];
    r->euler = r->outer_euler =
        (int64_t)(s->nodes.all + s->faces.all) - (int64_t)(sums[0] / 2);
    free(parent);
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

static tm_status find_boundary(maker *m, bool *alone, tm_error *error)
{
    tm_octree_mesh *mesh = m->mesh;
    bool hollow = false;
    tm_status status =
        tm_interior_boundary_find(&mesh->boundary, &m->share->octree, mesh->part, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = tm_boundary_share_find(&m->boundary, m->share, &mesh->boundary, error);
    if (status == TM_OK)
        status = measure_boundary(m, &hollow, error);
    *alone = status == TM_OK && (mesh->report.components > m->surface->components ||
                                 (hollow && m->surface->regions));
    return status == TM_OK && !*alone
               ? find_closest(mesh, m->boundary.nodes, m->surface, error)
               : status;
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
    status = tm_skin_gather(&skin, &m->boundary, &mesh->boundary, true, error);
    if (status == TM_OK)
        status = tm_own_gather(m->boundary.nodes, mesh->at, sizeof *mesh->at, true, &at,
                               error);
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
    tm_status status =
        tm_ranks_agree(mesh->part && patch ? TM_OK : tm_fail_memory(error), error);
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
