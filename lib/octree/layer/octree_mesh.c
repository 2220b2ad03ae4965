/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"
#include "../../surface/surface_tree.h"
#include "../interior/region_leaves.h"
#include "octree_mesh_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int compare_keys(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

/* The place of the first such key of a sorted list, or TM_NONE. */
static uint32_t find_key(const uint64_t *key, size_t count, uint64_t which)
{
    size_t begin = 0, end = count;
    while (begin < end) {
        const size_t middle = begin + (end - begin) / 2;
        if (key[middle] < which)
            begin = middle + 1;
        else
            end = middle;
    }
    return begin < count && key[begin] == which ? (uint32_t)begin : TM_NONE;
}

/* Where walls meet nodes between two regions go to the walls between these: all such
 * walls are made one patch for a while. pair[s] becomes that patch, TM_NONE of a node
 * between more regions. */
static tm_status join_walls(const tm_interior_boundary *boundary, tm_surface *surface,
                            uint32_t *pair, tm_error *error)
{
    const uint64_t past = surface->cells + 1;
    const size_t count = surface->triangles;
    uint64_t *key = tm_new(count, sizeof *key);
    if (!key)
        return tm_fail_memory(error);
    for (size_t t = 0; t < count; t++)
        key[t] = surface->side[t][0] * past + surface->side[t][1];
    qsort(key, count, sizeof *key, compare_keys);
    for (size_t t = 0; t < count; t++)
        surface->patch[t] =
            find_key(key, count, surface->side[t][0] * past + surface->side[t][1]);
    tm_surface_tree_refresh(surface);
    for (size_t s = 0; s < boundary->nodes; s++) {
        const size_t first = boundary->around[boundary->around_start[s]];
        const uint32_t *a = boundary->region[first];
        const uint64_t low = a[0] < a[1] ? a[0] : a[1], high = a[0] + a[1] - low;
        bool same = true;
        for (size_t i = boundary->around_start[s]; i < boundary->around_start[s + 1];
             i++) {
            const uint32_t *b = boundary->region[boundary->around[i]];
            same &= (a[0] == b[0] && a[1] == b[1]) || (a[0] == b[1] && a[1] == b[0]);
        }
        pair[s] = same ? find_key(key, count, low * past + high) : TM_NONE;
    }
    free(key);
    return TM_OK;
}

static void set_patches(tm_surface *surface, const uint32_t *patch)
{
    memcpy(surface->patch, patch, surface->triangles * sizeof *patch);
    tm_surface_tree_refresh(surface);
}

typedef struct {
    tm_octree_mesh *mesh;
    const tm_surface *surface;
    const uint32_t *patch; /* [nodes of the interior boundary], or NULL */
} closest_finder;

/* Neighbours in number are mostly close to each other, so that each begins where the last
 * one ended. */
static void find_closest_of(void *context, size_t first, size_t past)
{
    const closest_finder *f = context;
    tm_octree_mesh *m = f->mesh;
    uint32_t guess = TM_NONE;
    for (size_t s = first; s < past; s++) {
        const uint32_t of = f->patch ? f->patch[s] : TM_NONE;
        double xyz[3];
        tm_boundary_node_point(&m->boundary, s, xyz);
        if (of != TM_NONE && guess != TM_NONE && f->surface->patch[guess] != of)
            guess = TM_NONE;
        m->at[s].triangle = guess;
        tm_surface_closest(f->surface, xyz, of, &m->at[s]);
        guess = m->at[s].triangle;
    }
}

/* Where the interior boundary's nodes are closest to the surface, of the patches that are
 * given; NULL: to any. */
static void find_closest_on(tm_octree_mesh *m, const tm_surface *surface,
                            const uint32_t *patch)
{
    closest_finder f = {m, surface, patch};
    tm_parallel_runs(surface->threads, m->boundary.nodes, TM_CHUNK, find_closest_of, &f);
}

static tm_status find_closest(tm_octree_mesh *m, tm_surface *surface, tm_error *error)
{
    m->at = tm_new(m->boundary.nodes, sizeof *m->at);
    m->off_surface = calloc(m->boundary.nodes + 1, sizeof *m->off_surface);
    if (!m->at || !m->off_surface)
        return tm_fail_memory(error);
    if (!surface->walls) {
        find_closest_on(m, surface, NULL);
        return TM_OK;
    }
    uint32_t *pair = tm_new(m->boundary.nodes, sizeof *pair);
    uint32_t *patch = tm_new(surface->triangles, sizeof *patch);
    const bool ok = pair && patch;
    tm_status status = TM_OK;
    if (ok) {
        memcpy(patch, surface->patch, surface->triangles * sizeof *patch);
        status = join_walls(&m->boundary, surface, pair, error);
    } else {
        status = tm_fail_memory(error);
    }
    if (ok && status == TM_OK) {
        find_closest_on(m, surface, pair);
        set_patches(surface, patch);
    }
    free(pair);
    free(patch);
    return status;
}

/* The first face with the edge from corner i of a face on. */
static size_t first_at_edge(const tm_interior_boundary *boundary, size_t f, unsigned i)
{
    const unsigned k = tm_boundary_face_corners(boundary, f);
    const uint32_t s = boundary->face[f][i], t = boundary->face[f][(i + 1) % k];
    size_t first = f;
    for (size_t j = boundary->around_start[s]; j < boundary->around_start[s + 1]; j++) {
        const size_t g = boundary->around[j];
        for (unsigned c = 0; c < tm_boundary_face_corners(boundary, g); c++)
            if (g < first && boundary->face[g][c] == t)
                first = g;
    }
    return first;
}

/* The pieces of the boundary, and its Euler number. */
static tm_status measure_boundary(tm_octree_mesh *m, tm_error *error)
{
    const tm_interior_boundary *boundary = &m->boundary;
    uint32_t *parent = tm_new(boundary->nodes, sizeof *parent);
    if (!parent)
        return tm_fail_memory(error);
    for (size_t s = 0; s < boundary->nodes; s++)
        parent[s] = (uint32_t)s;
    int64_t edges = 0, half_edges = 0;
    for (size_t f = 0; f < boundary->faces; f++) {
        const unsigned k = tm_boundary_face_corners(boundary, f);
        half_edges += k;
        for (unsigned i = 0; boundary->region && i < k; i++)
            edges += first_at_edge(boundary, f, i) == f;
        for (unsigned i = 1; i < k; i++)
            tm_set_unite(parent, boundary->face[f][0], boundary->face[f][i]);
    }
    for (size_t s = 0; s < boundary->nodes; s++)
        m->report.components += tm_set_root(parent, (uint32_t)s) == s;
    if (!boundary->region) /* each has two faces */
        edges = half_edges / 2;
    m->report.euler = (int64_t)boundary->nodes - edges + (int64_t)boundary->faces;
    free(parent);
    return TM_OK;
}

/* The same, where walls meet, of the faces beyond which there is nothing: each edge has
 * two of them. */
static tm_status measure_outside(tm_octree_mesh *m, tm_error *error)
{
    const tm_interior_boundary *boundary = &m->boundary;
    size_t half_edges = 0, faces = 0, nodes = 0;
    m->report.outer_components = 0;
    uint32_t *parent = tm_new(boundary->nodes, sizeof *parent);
    bool *met = calloc(boundary->nodes + 1, sizeof *met);
    const bool ok = parent && met;
    for (size_t s = 0; ok && s < boundary->nodes; s++)
        parent[s] = (uint32_t)s;
    for (size_t f = 0; ok && f < boundary->faces; f++) {
        const unsigned k = tm_boundary_face_corners(boundary, f);
        if (boundary->region[f][1] != 0)
            continue;
        half_edges += k;
        faces++;
        for (unsigned i = 0; i < k; i++) {
            met[boundary->face[f][i]] = true;
            tm_set_unite(parent, boundary->face[f][0], boundary->face[f][i]);
        }
    }
    for (size_t s = 0; ok && s < boundary->nodes; s++) {
        nodes += met[s];
        m->report.outer_components += met[s] && tm_set_root(parent, (uint32_t)s) == s;
    }
    m->report.outer_euler = (int64_t)(nodes + faces) - (int64_t)(half_edges / 2);
    free(parent);
    free(met);
    return ok ? TM_OK : tm_fail_memory(error);
}

static tm_status find_boundary_once(tm_octree_mesh *m, const tm_octree *octree,
                                    tm_surface *surface, tm_error *error)
{
    tm_interior_boundary_free(&m->boundary);
    free(m->at);
    free(m->off_surface);
    m->at = NULL;
    m->off_surface = NULL;
    m->report.components = 0;
    tm_status status =
        tm_interior_boundary_of_parts(&m->boundary, octree, m->part, m->parts, error);
    if (status == TM_OK)
        status = measure_boundary(m, error);
    m->report.outer_components = m->report.components;
    m->report.outer_euler = m->report.euler;
    if (status == TM_OK && m->boundary.region)
        status = measure_outside(m, error);
    if (status == TM_OK)
        status = find_closest(m, surface, error);
    return status;
}

/* Takes away pieces that the surface does not have; says whether there are any. */
static tm_status remove_spurious(const tm_octree_mesh *m, const tm_octree *octree,
                                 const tm_surface *surface, bool *changed,
                                 tm_error *error)
{
    const tm_boundary_view all = {.octree = octree,
                                  .boundary = &m->boundary,
                                  .nodes.past = m->boundary.nodes,
                                  .faces.past = m->boundary.faces};
    tm_boundary_pieces pieces;
    tm_status status = tm_boundary_pieces_find(&pieces, &all, error);
    if (status == TM_OK)
        status = tm_spurious_components_remove(m->part, &all, &pieces, surface, m->at,
                                               changed, error);
    tm_boundary_pieces_free(&pieces);
    return status;
}

/* The interior boundary, without pieces that the surface does not have. */
static tm_status find_boundary(tm_octree_mesh *m, const tm_octree *octree,
                               tm_surface *surface, tm_error *error)
{
    bool changed = false;
    tm_status status = TM_OK;
    if (surface->walls) {
        status = tm_interior_divide(&m->part, &m->parts, octree, surface->cells, error);
        return status == TM_OK ? find_boundary_once(m, octree, surface, error) : status;
    }
    status = find_boundary_once(m, octree, surface, error);
    if (status == TM_OK && m->report.components > surface->components)
        status = remove_spurious(m, octree, surface, &changed, error);
    if (status == TM_OK && changed)
        status = find_boundary_once(m, octree, surface, error);
    if (status != TM_OK || !surface->regions)
        return status;
    if (m->report.components < 2) /* what is enclosed has a boundary of its own */
        return TM_OK;
    status = tm_interior_find_enclosed(&m->part[1], m->part, octree, surface, error);
    m->parts += m->part[1].chosen != NULL;
    if (status == TM_OK && m->parts > 1)
        status = find_boundary_once(m, octree, surface, error);
    return status;
}

/* Joins the nodes of each region, which has no other in common with another one than
 * outer ones. */
static void join_regions(const tm_octree_mesh *m, uint32_t *parent)
{
    const tm_mixed_mesh *mesh = &m->assembly.mesh;
    const size_t outer = m->assembly.outer, past = outer + m->boundary.nodes;
    for (size_t n = 0; n < mesh->nodes; n++)
        parent[n] = (uint32_t)n;
    for (size_t e = 0; e < mesh->elements; e++) {
        uint32_t first = TM_NONE;
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
            const uint32_t n = mesh->item[i];
            if (n >= outer && n < past)
                continue;
            if (first == TM_NONE)
                first = n;
            tm_set_unite(parent, first, n);
        }
    }
}

/* What most of the outside of a region is closest to (R. Boyer and J. Moore's count). */
typedef struct {
    uint32_t shell;
    size_t votes;
} election;

static void vote(election *e, uint32_t shell)
{
    if (e->votes == 0)
        e->shell = shell;
    if (e->shell == shell)
        e->votes++;
    else
        e->votes--;
}

/* A region is that of the shell around it: of those at its faces the one that is turned
 * outward, seen from the region. */
static void elect_shells(const tm_octree_mesh *m, const tm_surface *surface,
                         const double *volume, uint32_t *parent, election *at)
{
    const tm_assembly *a = &m->assembly;
    for (size_t f = 0; f < m->boundary.faces; f++) {
        const uint32_t s = m->boundary.face[f][0];
        const uint32_t shell = surface->shell[m->at[s].triangle];
        if (volume[shell] > 0)
            vote(&at[tm_set_root(parent, a->inner[0][s])], shell);
        else if (a->parts > 1 && a->inner[1][s] != TM_NONE)
            vote(&at[tm_set_root(parent, a->inner[1][s])], shell);
    }
}

/* Numbers the regions of leaves, from 1 as the shells come; counts those there are. */
static void number_regions(tm_octree_mesh *m, const tm_octree *octree,
                           const tm_surface *surface, uint32_t *parent,
                           const election *at, bool *met)
{
    const tm_assembly *a = &m->assembly;
    for (size_t l = 0; l < octree->leaves; l++) {
        const size_t p = tm_interior_part_of(m->part, m->parts, l);
        if (p == m->parts)
            continue;
        const uint32_t shell =
            at[tm_set_root(parent, a->core_node[p][octree->node[l][0]])].shell;
        m->region[l] = shell + 1;
        met[shell] = true;
    }
    for (size_t i = 0; i < surface->components; i++)
        m->report.regions += met[i];
}

static tm_status find_regions(tm_octree_mesh *m, const tm_octree *octree,
                              const tm_surface *surface, const double *volume,
                              tm_error *error)
{
    const size_t nodes = m->assembly.mesh.nodes;
    bool *met = calloc(surface->components + 1, sizeof *met);
    uint32_t *parent = tm_new(nodes, sizeof *parent);
    election *at = calloc(nodes + 1, sizeof *at);
    m->region = calloc(octree->leaves + 1, sizeof *m->region);
    const bool done = met && parent && at && m->region;
    if (done) {
        join_regions(m, parent);
        elect_shells(m, surface, volume, parent, at);
        number_regions(m, octree, surface, parent, at, met);
    }
    free(met);
    free(parent);
    free(at);
    return done ? TM_OK : tm_fail_memory(error);
}

/* The same where walls meet: leaves know their regions. */
static tm_status count_labels(tm_octree_mesh *m, const tm_octree *octree,
                              const tm_surface *surface, tm_error *error)
{
    bool *met = calloc(surface->cells + 1, sizeof *met);
    m->region = tm_new(octree->leaves, sizeof *m->region);
    if (!met || !m->region) {
        free(met);
        return tm_fail_memory(error);
    }
    memcpy(m->region, m->part->label, octree->leaves * sizeof *m->region);
    for (size_t l = 0; l < octree->leaves; l++)
        met[m->region[l]] = true;
    for (size_t r = 1; r <= surface->cells; r++)
        m->report.regions += met[r];
    m->report.regions_lost = surface->cells - m->report.regions;
    free(met);
    return TM_OK;
}

/* The regions that leaves are in, where there are several, or the file numbers them; and
 * how many are not there: shells in others, or around such, but for holes. */
static tm_status count_regions(tm_octree_mesh *m, const tm_octree *octree,
                               const tm_surface *surface, tm_error *error)
{
    double *volume = tm_new(surface->components, sizeof *volume);
    if (!volume)
        return tm_fail_memory(error);
    tm_surface_shell_volumes(surface, volume);
    size_t within = 0;
    for (size_t i = 0; i < surface->components; i++)
        within += volume[i] < 0;
    tm_status status = TM_OK;
    if (m->parts > 1 || surface->region)
        status = find_regions(m, octree, surface, volume, error);
    const size_t found = m->parts > 1 ? m->report.regions : 1;
    if ((m->parts > 1 || within > surface->holes) && !surface->by_winding &&
        surface->components > found + surface->holes)
        m->report.regions_lost = surface->components - found - surface->holes;
    free(volume);
    return status;
}

static double find_worst(const tm_mixed_mesh *mesh)
{
    double worst = 1;
    for (size_t e = 0; e < mesh->elements; e++)
        worst = fmin(worst, tm_mixed_jens(mesh, e));
    return worst;
}

tm_status tm_octree_mesh_fail_empty(tm_error *error)
{
    return tm_fail(error, TM_ERROR_INPUT,
                   "no leaf is inside the surface: it needs a finer level");
}

tm_status tm_octree_mesh_complete_report(tm_octree_mesh *m, const tm_octree *octree,
                                         const tm_surface *surface, tm_error *error)
{
    tm_octree_mesh_report *r = &m->report;
    tm_status status = TM_OK;
    if (surface->walls)
        status = count_labels(m, octree, surface, error);
    else if (surface->regions)
        status = count_regions(m, octree, surface, error);
    r->corners_lost = m->feature.corners_lost;
    r->curves_lost = m->feature.curves_lost;
    if (m->feature.lost != TM_NONE)
        memcpy(r->feature_lost_at, surface->xyz[m->feature.lost],
               sizeof r->feature_lost_at);
    return status;
}

static tm_status make(tm_octree_mesh *m, const tm_octree *octree, tm_surface *surface,
                      const tm_progress *progress, tm_error *error)
{
    tm_status status = TM_OK;
    if (m->part->count == 0)
        status = tm_octree_mesh_fail_empty(error);
    tm_progress_stage(progress, "finding the interior boundary");
    if (status == TM_OK)
        status = find_boundary(m, octree, surface, error);
    tm_progress_stage(progress, "matching features");
    if (status == TM_OK)
        status = tm_feature_find(&m->feature, &m->boundary, surface, m->at, error);
    tm_progress_stage(progress, "assembling elements");
    if (status == TM_OK)
        status =
            tm_assemble(&m->assembly, octree, m->part, m->parts, &m->boundary, error);
    tm_progress_stage(progress, "projecting the layer");
    if (status == TM_OK)
        status = tm_project_layer(&m->assembly, &m->boundary, &m->feature, surface, m->at,
                                  NULL, error);
    if (status == TM_OK)
        status = tm_untangle_layer(m, octree, surface, progress, error);
    if (status == TM_OK && surface->walls)
        m->report.worst = find_worst(&m->assembly.mesh);
    return status == TM_OK ? tm_octree_mesh_complete_report(m, octree, surface, error)
                           : status;
}

tm_status tm_octree_mesh_make(tm_octree_mesh *mesh, const tm_octree *octree,
                              tm_surface *surface, const tm_progress *progress,
                              tm_error *error)
{
    tm_interior interior;
    *mesh = (tm_octree_mesh){0};
    tm_progress_stage(progress, "choosing octants");
    tm_status status = tm_interior_choose(&interior, octree, surface, error);
    if (status == TM_OK)
        status =
            tm_octree_mesh_make_of(mesh, octree, &interior, surface, progress, error);
    tm_interior_free(&interior);
    return status;
}

tm_status tm_octree_mesh_make_of(tm_octree_mesh *mesh, const tm_octree *octree,
                                 tm_interior *interior, tm_surface *surface,
                                 const tm_progress *progress, tm_error *error)
{
    enum { PARTS = 2 };
    *mesh = (tm_octree_mesh){.part = calloc(PARTS, sizeof *mesh->part)};
    if (!mesh->part)
        return tm_fail_memory(error);
    mesh->parts = 1;
    *mesh->part = *interior;
    *interior = (tm_interior){0};
    const size_t bytes = surface->triangles * sizeof *surface->patch;
    uint32_t *patch = tm_new(surface->triangles, sizeof *patch);
    if (!patch)
        return tm_fail_memory(error);
    memcpy(patch, surface->patch, bytes);
    const tm_status status = make(mesh, octree, surface, progress, error);
    memcpy(surface->patch, patch, bytes);
    tm_surface_tree_refresh(surface);
    free(patch);
    return status;
}

size_t tm_octree_mesh_elements(const tm_octree_mesh *mesh)
{
    return mesh->share ? mesh->share->elements.all : mesh->assembly.mesh.elements;
}

void tm_octree_mesh_free(tm_octree_mesh *mesh)
{
    for (size_t p = 0; p < mesh->parts; p++)
        tm_interior_free(&mesh->part[p]);
    free(mesh->part);
    tm_interior_boundary_free(&mesh->boundary);
    tm_feature_free(&mesh->feature);
    tm_assembly_free(&mesh->assembly);
    free(mesh->region);
    free(mesh->at);
    free(mesh->off_surface);
    if (mesh->share)
        tm_mesh_share_free(mesh->share);
    free(mesh->share);
    *mesh = (tm_octree_mesh){0};
}
