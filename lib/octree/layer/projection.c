/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"
#include "sweep.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../element/shape.h"
#include "../../mesh/node_rows.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

/* Measured on the bench's surfaces: more sweeps change the worst elements little. Curves
 * are swept alone first: their nodes may be crowded at an end. */
enum { CURVE_SWEEPS = 8, BOUNDARY_SWEEPS = 2, CORE_SWEEPS = 6, HEXAHEDRON = 8 };

typedef struct {
    tm_assembly *assembly;
    const tm_interior_boundary *boundary;
    const tm_feature *feature;
    const tm_surface *surface;
    tm_surface_point *at;
    const tm_mesh_share *share; /* NULL: this is the whole mesh */
    size_t own, own_past;       /* this rank's boundary nodes */
    tm_mesh_ghosts ghosts;      /* outer nodes */
    tm_mesh_ghosts *by_step;    /* those that change in each step of sweeps */
    unsigned threads;
    bool curves_only; /* in this sweep */
} fitter;

/* Puts an outer node to the point of its feature that is closest to one. */
static void put(const fitter *projection, size_t s, const double point[3])
{
    double *xyz = projection->assembly->mesh.xyz[projection->assembly->outer + s];
    const uint32_t of = projection->feature->of[s];
    if (projection->feature->kind[s] == TM_ON_CORNER) {
        memcpy(xyz, projection->surface->xyz[projection->surface->corner[of]],
               3 * sizeof *xyz);
    } else if (projection->feature->kind[s] == TM_ON_CURVE) {
        size_t segment;
        tm_surface_closest_on_curve(projection->surface, of, point, xyz, &segment);
    } else {
        tm_surface_point *at = &projection->at[s];
        if (of != TM_NONE && projection->surface->patch[at->triangle] != of)
            at->triangle = TM_NONE;
        tm_surface_closest(projection->surface, point, of, at);
        memcpy(xyz, at->xyz, 3 * sizeof *xyz);
    }
}

/* The mean of the neighbours of an outer node: along its curve, or the corners of the
 * faces around it, of which those across an edge count twice. */
static void mean_on_boundary(const fitter *projection, size_t s, double mean[3])
{
    const tm_interior_boundary *boundary = projection->boundary;
    const double(*xyz)[3] = (const double(*)[3])projection->assembly->mesh.xyz;
    const uint32_t outer = projection->assembly->outer;
    double sum[3] = {0, 0, 0};
    size_t count = 0;
    if (projection->feature->kind[s] == TM_ON_CURVE) {
        count = 2;
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 3; i++)
                sum[i] += xyz[outer + projection->feature->along[s][j]][i];
    } else {
        for (size_t a = boundary->around_start[s]; a < boundary->around_start[s + 1];
             a++) {
            const uint32_t *face = boundary->face[boundary->around[a]];
            const unsigned k = tm_boundary_face_corners(boundary, boundary->around[a]);
            for (unsigned c = 0; c < k; c++)
                for (int i = 0; i < 3; i++)
                    sum[i] += xyz[outer + face[c]][i];
            for (int i = 0; i < 3; i++)
                sum[i] -= xyz[outer + s][i];
            count += k - 1;
        }
    }
    for (int i = 0; i < 3; i++)
        mean[i] = sum[i] / (double)count;
}

/* Puts outer nodes where they are first. */
static void put_first(void *context, size_t first, size_t past)
{
    const fitter *projection = context;
    double point[3];
    for (size_t s = projection->own + first; s < projection->own + past; s++) {
        double *outer = projection->assembly->mesh.xyz[projection->assembly->outer + s];
        const uint32_t of = projection->feature->of[s];
        if (projection->feature->kind[s] == TM_ON_PATCH &&
            (of == TM_NONE ||
             of == projection->surface->patch[projection->at[s].triangle])) {
            memcpy(outer, projection->at[s].xyz,
                   sizeof point); /* at is where it is closest */
            continue;
        }
        memcpy(point, outer, sizeof point);
        put(projection, s, point);
    }
}

static void sweep_boundary(void *context, size_t first, size_t past)
{
    const fitter *projection = context;
    for (size_t s = projection->own + first; s < projection->own + past; s++) {
        const uint8_t kind = projection->feature->kind[s];
        double point[3];
        if (kind == TM_ON_CORNER || (kind == TM_ON_PATCH && projection->curves_only))
            continue;
        mean_on_boundary(projection, s, point);
        put(projection, s, point);
    }
}

/* The number of a boundary node in the whole mesh. */
static size_t number_of(const fitter *projection, uint32_t s)
{
    const tm_mesh_share *share = projection->share;
    return share ? share->number[projection->assembly->outer + s] - share->core.all : s;
}

static void look_around(const void *context, size_t n, uint64_t *seen)
{
    const fitter *projection = context;
    const tm_interior_boundary *boundary = projection->boundary;
    const size_t s = projection->own + n;
    for (int j = 0; projection->feature->kind[s] == TM_ON_CURVE && j < 2; j++)
        tm_sweep_sees(seen, number_of(projection, projection->feature->along[s][j]));
    for (size_t a = boundary->around_start[s]; a < boundary->around_start[s + 1]; a++) {
        const uint32_t *face = boundary->face[boundary->around[a]];
        const unsigned k = tm_boundary_face_corners(boundary, boundary->around[a]);
        for (unsigned c = 0; c < k; c++)
            tm_sweep_sees(seen, number_of(projection, face[c]));
    }
}

static void give_outer(void *context, size_t step)
{
    const fitter *projection = context;
    double(*xyz)[3] = projection->assembly->mesh.xyz;
    tm_mesh_ghosts_fill(&projection->by_step[step], xyz, sizeof *xyz);
}

/* The ghosts of a range of nodes, of those that have an order, where this is given. */
static tm_status find_ghosts(tm_mesh_ghosts *ghosts, const tm_mesh_share *share,
                             size_t nodes, size_t first, size_t past,
                             const uint32_t *order, tm_error *error)
{
    bool *kept = calloc(nodes + 1, sizeof *kept);
    tm_status status = tm_ranks_enough(kept, error);
    for (size_t n = first; status == TM_OK && n < past; n++)
        kept[n] = !order || order[n] != TM_NONE;
    if (status == TM_OK)
        status = tm_mesh_ghosts_some(ghosts, &share->ghosts, kept, error);
    free(kept);
    return status;
}

static void sweep_all(fitter *projection, const tm_sweep *sweep)
{
    const size_t own = projection->own_past - projection->own;
    tm_parallel_runs(projection->threads, own, TM_CHUNK, put_first, projection);
    double(*xyz)[3] = projection->assembly->mesh.xyz;
    if (projection->share)
        tm_mesh_ghosts_fill(&projection->ghosts, xyz, sizeof *xyz);
    const int begin = projection->surface->curves > 0 ? 0 : CURVE_SWEEPS;
    for (int i = begin; i < CURVE_SWEEPS + BOUNDARY_SWEEPS; i++) {
        projection->curves_only = i < CURVE_SWEEPS;
        tm_sweep_make(sweep, sweep_boundary, give_outer, projection);
    }
}

static tm_status project_boundary(fitter *projection, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    const size_t own = projection->own_past - projection->own;
    tm_sweep sweep;
    tm_status status =
        tm_sweep_plan(&sweep, own, projection->threads, look_around, projection, error);
    if (status == TM_OK && projection->share)
        status =
            find_ghosts(&projection->ghosts, projection->share, a->mesh.nodes, a->outer,
                        a->outer + projection->boundary->nodes, NULL, error);
    if (status == TM_OK && projection->share)
        status = tm_sweep_cut_ghosts(&sweep, &projection->ghosts, a->mesh.nodes,
                                     a->outer + projection->own, NULL,
                                     &projection->by_step, error);
    if (status == TM_OK)
        sweep_all(projection, &sweep);
    tm_sweep_free_ghosts(&sweep, projection->by_step);
    tm_sweep_free(&sweep);
    tm_mesh_ghosts_free(&projection->ghosts);
    return status;
}

/* The nodes below the interior boundary that may move, and their neighbours. */
typedef struct {
    const tm_mixed_mesh *mesh;
    uint32_t *order; /* [nodes of the mesh]: its index in node[], or TM_NONE */
    bool *moves;     /* [nodes of the mesh], while they are looked for */
    size_t nodes;
    size_t core; /* of these: of the octree; behind them are middles of leaves */
    uint32_t *node;
    size_t *start;   /* [nodes + 1] */
    uint32_t *count; /* [nodes]: of neighbours, from neighbour[start[n]] */
    uint32_t *neighbour;
    double (*bias)[3]; /* [nodes]: what the mean of the neighbours lacks on the lattice */
    size_t own, own_past;       /* this rank's of the octree */
    size_t middle, middle_past; /* its middles */
    uint32_t *number; /* [nodes of the mesh]: as order, among those of the octree of all
                         ranks; NULL: that is order */
    tm_mesh_ghosts ghosts[2]; /* of the octree; of its middles */
    tm_mesh_ghosts *by_step;  /* of the first, those that change in each step of sweeps */
} zone;

static bool has_moving(const zone *z, const tm_mixed_mesh *mesh, size_t e)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (z->order[mesh->item[i]] != TM_NONE)
            return true;
    return false;
}

/* Marks nodes of elements with an inner node, or that are no hexahedra. */
static void mark_moving(void *context, size_t first, size_t past)
{
    const zone *z = context;
    const tm_mixed_mesh *mesh = z->mesh;
    for (size_t e = first; e < past; e++)
        if (mesh->start[e + 1] - mesh->start[e] != HEXAHEDRON || has_moving(z, mesh, e))
            for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
                tm_mark(&z->moves[mesh->item[i]]);
}

/* Marks the inner nodes, those in an element with one of them, and those of elements that
 * are no hexahedra. */
static tm_status find_moving(const fitter *projection, zone *z, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    const tm_mixed_mesh *mesh = &a->mesh;
    z->order = tm_new(mesh->nodes, sizeof *z->order);
    z->moves = calloc(mesh->nodes + 1, 1);
    if (!z->order || !z->moves)
        return tm_fail_memory(error);
    for (size_t n = 0; n < mesh->nodes; n++)
        z->order[n] = TM_NONE;
    for (size_t s = 0; s < projection->boundary->nodes; s++) {
        for (size_t p = 0; p < a->parts; p++)
            if (a->inner[p][s] != TM_NONE)
                z->order[a->inner[p][s]] = 0;
    }
    tm_parallel_runs(projection->threads, mesh->elements, TM_CHUNK, mark_moving, z);
    return TM_OK;
}

/* Lists what is marked, without the outer nodes. */
static tm_status list_moving(const fitter *projection, zone *z, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    const tm_mixed_mesh *mesh = &a->mesh;
    const size_t outer_end = a->outer + projection->boundary->nodes;
    for (size_t n = 0; n < mesh->nodes; n++) {
        const bool is_outer = n >= a->outer && n < outer_end;
        z->order[n] = z->moves[n] && !is_outer ? (uint32_t)z->nodes++ : TM_NONE;
        if (n < a->outer)
            z->core = z->nodes;
    }
    z->node = tm_new(z->nodes, sizeof *z->node);
    z->start = calloc(z->nodes + 1, sizeof *z->start);
    z->count = calloc(z->nodes + 1, sizeof *z->count);
    if (!z->node || !z->start || !z->count)
        return tm_fail_memory(error);
    for (size_t n = 0; n < mesh->nodes; n++)
        if (z->order[n] != TM_NONE)
            z->node[z->order[n]] = (uint32_t)n;
    return TM_OK;
}

static size_t place_of(const zone *z, size_t node)
{
    return tm_first_not_below(z->node, z->nodes, (uint32_t)node);
}

/* Which of them are this rank's, their numbers, and who has them as ghosts. */
static tm_status find_own(const fitter *projection, zone *z, tm_error *error)
{
    const tm_mesh_share *share = projection->share;
    const size_t nodes = z->mesh->nodes,
                 middles = projection->assembly->outer + projection->boundary->nodes;
    z->own_past = z->middle = z->core;
    z->middle_past = z->nodes;
    if (!share)
        return TM_OK;
    z->own = place_of(z, share->core.first);
    z->own_past = place_of(z, share->core.past);
    z->middle = place_of(z, middles + share->middles.first);
    z->middle_past = place_of(z, middles + share->middles.past);
    const size_t before = tm_ranks_before(z->own_past - z->own, NULL);
    z->number = tm_new(nodes, sizeof *z->number);
    tm_status status = tm_ranks_enough(z->number, error);
    for (size_t i = z->own; status == TM_OK && i < z->own_past; i++)
        z->number[z->node[i]] = (uint32_t)(before + i - z->own);
    if (status == TM_OK)
        status = find_ghosts(&z->ghosts[0], share, nodes, 0, projection->assembly->outer,
                             z->order, error);
    if (status == TM_OK)
        status =
            find_ghosts(&z->ghosts[1], share, nodes, middles, nodes, z->order, error);
    if (status == TM_OK)
        tm_mesh_ghosts_fill(&z->ghosts[0], z->number, sizeof *z->number);
    return status;
}

/* Calls visit for both directions of an element's edges whose first end is in a range. */
static inline void visit_edges(zone *z, size_t e, tm_row_range range,
                               void (*visit)(zone *z, uint32_t from, uint32_t to))
{
    const tm_mixed_mesh *mesh = z->mesh;
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_shape *shape =
        &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
    for (unsigned i = 0; i < shape->edges; i++)
        for (unsigned end = 0; end < 2; end++) {
            const uint32_t from = z->order[item[shape->edge[i][end]]];
            if (tm_row_is_in(range, from))
                visit(z, from, item[shape->edge[i][1 - end]]);
        }
}

static void count_neighbour(zone *z, uint32_t from, uint32_t to)
{
    (void)to;
    z->count[from]++;
}

static void enter_neighbour(zone *z, uint32_t from, uint32_t to)
{
    uint32_t *list = z->neighbour + z->start[from];
    for (uint32_t i = 0; i < z->count[from]; i++)
        if (list[i] == to)
            return;
    if (z->start[from] + z->count[from] < z->start[from + 1])
        list[z->count[from]++] = to;
}

static void count_neighbours(void *z, size_t e, tm_row_range range)
{
    visit_edges(z, e, range, count_neighbour);
}

static void enter_neighbours(void *z, size_t e, tm_row_range range)
{
    visit_edges(z, e, range, enter_neighbour);
}

/* An edge inside has three elements at least, so a third of the edges that are counted is
 * room enough for the neighbours. */
static tm_status list_neighbours(zone *z, const tm_node_rows *rows, tm_error *error)
{
    const uint32_t elements_least = 3;
    tm_node_rows_visit(rows, count_neighbours, z);
    for (size_t n = 0; n < z->nodes; n++) {
        z->start[n + 1] = z->start[n] + z->count[n] / elements_least;
        z->count[n] = 0;
    }
    z->neighbour = tm_new(z->start[z->nodes], sizeof *z->neighbour);
    if (!z->neighbour)
        return tm_fail_memory(error);
    tm_node_rows_visit(rows, enter_neighbours, z);
    return TM_OK;
}

static tm_status find_neighbours(zone *z, tm_error *error)
{
    tm_node_rows rows;
    tm_status status = tm_node_rows_find(&rows, z->mesh, z->order, z->nodes, error);
    if (status == TM_OK)
        status = list_neighbours(z, &rows, error);
    tm_node_rows_free(&rows);
    return status;
}

/* The mean of a node's neighbours. */
static void mean_of(const zone *z, size_t n, double mean[3])
{
    const double(*xyz)[3] = (const double(*)[3])z->mesh->xyz;
    const uint32_t *neighbour = z->neighbour + z->start[n];
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 0; i < z->count[n]; i++)
        for (int j = 0; j < 3; j++)
            sum[j] += xyz[neighbour[i]][j];
    for (int j = 0; j < 3; j++)
        mean[j] = sum[j] / (double)z->count[n];
}

typedef struct {
    const zone *zone;
    const tm_assembly *assembly;
} biased;

/* A node below the interior boundary that has smaller neighbours on one side only is not
 * at their mean on the lattice. The middle of a leaf stays so; other nodes go half of the
 * way: then a leaf is less high than wide over a face that is divided in four, and its
 * elements are better than on the lattice (J_ENS of tetrahedra 0.59 in the mean, not
 * 0.47). */
static void set_bias(void *context, size_t first, size_t past)
{
    const biased *b = context;
    const zone *z = b->zone;
    const double core_share = 0.5;
    for (size_t n = first; n < past; n++) {
        const double *at = z->mesh->xyz[z->node[n]];
        const double share = z->node[n] < b->assembly->outer ? core_share : 1;
        mean_of(z, n, z->bias[n]);
        for (int j = 0; j < 3; j++)
            z->bias[n][j] = share * (at[j] - z->bias[n][j]);
    }
}

static tm_status find_bias(const fitter *projection, zone *z, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    z->bias = tm_new(z->nodes, sizeof *z->bias);
    if (!z->bias)
        return tm_fail_memory(error);
    biased b = {z, a};
    tm_parallel_runs(projection->threads, z->nodes, TM_CHUNK, set_bias, &b);
    for (size_t s = 0; s < projection->boundary->nodes; s++) {
        for (size_t p = 0; p < a->parts; p++)
            if (a->inner[p][s] != TM_NONE)
                memset(z->bias[z->order[a->inner[p][s]]], 0, sizeof *z->bias);
    }
    return TM_OK;
}

static void average_nodes(const zone *z, size_t first, size_t past)
{
    for (size_t n = first; n < past; n++) {
        double mean[3];
        mean_of(z, n, mean);
        for (int j = 0; j < 3; j++)
            z->mesh->xyz[z->node[n]][j] = mean[j] + z->bias[n][j];
    }
}

static void average_run(void *context, size_t first, size_t past)
{
    const zone *z = context;
    average_nodes(z, z->own + first, z->own + past);
}

static void average_middles(void *context, size_t first, size_t past)
{
    const zone *z = context;
    average_nodes(z, z->middle + first, z->middle + past);
}

static void give_core(void *context, size_t step)
{
    const zone *z = context;
    tm_mesh_ghosts_fill(&z->by_step[step], z->mesh->xyz, sizeof *z->mesh->xyz);
}

static void look_at_neighbours(const void *context, size_t n, uint64_t *seen)
{
    const zone *z = context;
    const uint32_t *neighbour = z->neighbour + z->start[z->own + n];
    for (uint32_t i = 0; i < z->count[z->own + n]; i++) {
        const uint32_t order = z->order[neighbour[i]];
        if (order < z->core)
            tm_sweep_sees(seen, z->number ? z->number[neighbour[i]] : order);
    }
}

/* Middles have no others as neighbours. */
static tm_status average(zone *z, unsigned threads, tm_error *error)
{
    tm_sweep sweep;
    tm_status status = tm_sweep_plan(&sweep, z->own_past - z->own, threads,
                                     look_at_neighbours, z, error);
    if (status == TM_OK && z->number)
        status = tm_sweep_cut_ghosts(&sweep, &z->ghosts[0], z->mesh->nodes, 0,
                                     z->node + z->own, &z->by_step, error);
    for (int i = 0; status == TM_OK && i < CORE_SWEEPS; i++) {
        tm_sweep_make(&sweep, average_run, give_core, z);
        tm_parallel_runs(threads, z->middle_past - z->middle, TM_CHUNK, average_middles,
                         z);
        if (z->number)
            tm_mesh_ghosts_fill(&z->ghosts[1], z->mesh->xyz, sizeof *z->mesh->xyz);
    }
    tm_sweep_free_ghosts(&sweep, z->by_step);
    tm_sweep_free(&sweep);
    return status;
}

tm_status tm_project_layer(tm_assembly *assembly, const tm_interior_boundary *boundary,
                           const tm_feature *feature, const tm_surface *surface,
                           tm_surface_point *at, const tm_mesh_share *share,
                           tm_error *error)
{
    fitter projection = {.assembly = assembly,
                         .boundary = boundary,
                         .feature = feature,
                         .surface = surface,
                         .at = at,
                         .share = share,
                         .own = share ? share->outer.first : 0,
                         .own_past = share ? share->outer.past : boundary->nodes,
                         .threads = surface->threads};
    zone z = {.mesh = &assembly->mesh};
    tm_status status = tm_ranks_agree(find_moving(&projection, &z, error), error);
    if (status == TM_OK && share)
        tm_mesh_ghosts_fill(&share->ghosts, z.moves, sizeof *z.moves);
    if (status == TM_OK)
        status = tm_ranks_agree(list_moving(&projection, &z, error), error);
    if (status == TM_OK)
        status = find_own(&projection, &z, error);
    if (status == TM_OK)
        status = find_neighbours(&z, error);
    if (status == TM_OK)
        status = find_bias(&projection, &z, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = project_boundary(&projection, error);
    if (status == TM_OK)
        status = average(&z, surface->threads, error);
    free(z.order);
    free(z.moves);
    free(z.node);
    free(z.start);
    free(z.count);
    free(z.neighbour);
    free(z.bias);
    free(z.number);
    tm_mesh_ghosts_free(&z.ghosts[0]);
    tm_mesh_ghosts_free(&z.ghosts[1]);
    return status;
}
