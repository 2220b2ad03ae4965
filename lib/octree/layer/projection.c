/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../element/shape.h"

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

static void project_boundary(const fitter *projection)
{
    double point[3];
    for (size_t s = 0; s < projection->boundary->nodes; s++) {
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
    for (int sweep = 0; sweep < CURVE_SWEEPS + BOUNDARY_SWEEPS; sweep++)
        for (size_t s = 0; s < projection->boundary->nodes; s++) {
            const uint8_t kind = projection->feature->kind[s];
            if (kind == TM_ON_CORNER || (kind == TM_ON_PATCH && sweep < CURVE_SWEEPS))
                continue;
            mean_on_boundary(projection, s, point);
            put(projection, s, point);
        }
}

/* The nodes below the interior boundary that may move, and their neighbours. */
typedef struct {
    uint32_t *order; /* [nodes of the mesh]: its index in node[], or TM_NONE */
    size_t nodes;
    uint32_t *node;
    size_t *start;   /* [nodes + 1] */
    uint32_t *count; /* [nodes]: of neighbours, from neighbour[start[n]] */
    uint32_t *neighbour;
    double (*bias)[3]; /* [nodes]: what the mean of the neighbours lacks on the lattice */
} zone;

static bool has_moving(const zone *z, const tm_mixed_mesh *mesh, size_t e)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (z->order[mesh->item[i]] != TM_NONE)
            return true;
    return false;
}

/* The inner nodes, those in an element with one of them, and those of elements that are
 * no hexahedra, without the outer ones. */
static tm_status find_moving(const fitter *projection, zone *z, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    const tm_mixed_mesh *mesh = &a->mesh;
    const size_t outer_end = a->outer + projection->boundary->nodes;
    z->order = tm_new(mesh->nodes, sizeof *z->order);
    bool *moves = calloc(mesh->nodes + 1, 1);
    if (!z->order || !moves) {
        free(moves);
        return tm_fail_memory(error);
    }
    for (size_t n = 0; n < mesh->nodes; n++)
        z->order[n] = TM_NONE;
    for (size_t s = 0; s < projection->boundary->nodes; s++) {
        for (size_t p = 0; p < a->parts; p++)
            if (a->inner[p][s] != TM_NONE)
                z->order[a->inner[p][s]] = 0;
    }
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e) || mesh->start[e + 1] - mesh->start[e] != HEXAHEDRON)
            for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
                moves[mesh->item[i]] = true;
    for (size_t n = 0; n < mesh->nodes; n++) {
        const bool is_outer = n >= a->outer && n < outer_end;
        z->order[n] = moves[n] && !is_outer ? (uint32_t)z->nodes++ : TM_NONE;
    }
    free(moves);
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

/* Calls visit for both directions of an element's edges whose first end moves. */
static void visit_edges(zone *z, const tm_mixed_mesh *mesh, size_t e,
                        void (*visit)(zone *z, uint32_t from, uint32_t to))
{
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_shape *shape =
        &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
    for (unsigned i = 0; i < shape->edges; i++)
        for (unsigned end = 0; end < 2; end++) {
            const uint32_t from = z->order[item[shape->edge[i][end]]];
            if (from != TM_NONE)
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

/* An edge inside has three elements at least, so a third of the edges that are counted is
 * room enough for the neighbours. */
static tm_status find_neighbours(zone *z, const tm_mixed_mesh *mesh, tm_error *error)
{
    const uint32_t elements_least = 3;
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e))
            visit_edges(z, mesh, e, count_neighbour);
    for (size_t n = 0; n < z->nodes; n++) {
        z->start[n + 1] = z->start[n] + z->count[n] / elements_least;
        z->count[n] = 0;
    }
    z->neighbour = tm_new(z->start[z->nodes], sizeof *z->neighbour);
    if (!z->neighbour)
        return tm_fail_memory(error);
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e))
            visit_edges(z, mesh, e, enter_neighbour);
    return TM_OK;
}

/* The mean of a node's neighbours. */
static void mean_of(const zone *z, size_t n, const double (*xyz)[3], double mean[3])
{
    const uint32_t *neighbour = z->neighbour + z->start[n];
    double sum[3] = {0, 0, 0};
    for (uint32_t i = 0; i < z->count[n]; i++)
        for (int j = 0; j < 3; j++)
            sum[j] += xyz[neighbour[i]][j];
    for (int j = 0; j < 3; j++)
        mean[j] = sum[j] / (double)z->count[n];
}

/* A node below the interior boundary that has smaller neighbours on one side only is not
 * at their mean on the lattice. The middle of a leaf stays so; other nodes go half of the
 * way: then a leaf is less high than wide over a face that is divided in four, and its
 * elements are better than on the lattice (J_ENS of tetrahedra 0.59 in the mean, not
 * 0.47). */
static tm_status find_bias(const fitter *projection, zone *z, tm_error *error)
{
    const tm_assembly *a = projection->assembly;
    const double core_share = 0.5;
    z->bias = calloc(z->nodes + 1, sizeof *z->bias);
    if (!z->bias)
        return tm_fail_memory(error);
    for (size_t n = 0; n < z->nodes; n++) {
        const double *at = a->mesh.xyz[z->node[n]];
        const double share = z->node[n] < a->outer ? core_share : 1;
        mean_of(z, n, (const double(*)[3])a->mesh.xyz, z->bias[n]);
        for (int j = 0; j < 3; j++)
            z->bias[n][j] = share * (at[j] - z->bias[n][j]);
    }
    for (size_t s = 0; s < projection->boundary->nodes; s++) {
        for (size_t p = 0; p < a->parts; p++)
            if (a->inner[p][s] != TM_NONE)
                memset(z->bias[z->order[a->inner[p][s]]], 0, sizeof *z->bias);
    }
    return TM_OK;
}

static void average(const zone *z, tm_mixed_mesh *mesh)
{
    for (int sweep = 0; sweep < CORE_SWEEPS; sweep++)
        for (size_t n = 0; n < z->nodes; n++) {
            double mean[3];
            mean_of(z, n, (const double(*)[3])mesh->xyz, mean);
            for (int j = 0; j < 3; j++)
                mesh->xyz[z->node[n]][j] = mean[j] + z->bias[n][j];
        }
}

tm_status tm_project_layer(tm_assembly *assembly, const tm_interior_boundary *boundary,
                           const tm_feature *feature, const tm_surface *surface,
                           tm_surface_point *at, tm_error *error)
{
    const fitter projection = {assembly, boundary, feature, surface, at};
    zone z = {0};
    tm_status status = find_moving(&projection, &z, error);
    if (status == TM_OK)
        status = find_neighbours(&z, &assembly->mesh, error);
    if (status == TM_OK)
        status = find_bias(&projection, &z, error);
    if (status == TM_OK) {
        project_boundary(&projection);
        average(&z, &assembly->mesh);
    }
    free(z.order);
    free(z.node);
    free(z.start);
    free(z.count);
    free(z.neighbour);
    free(z.bias);
    return status;
}
