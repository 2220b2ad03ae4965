/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fit.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "../mixed/element_edges.h"
#include "../quality/jens.h"

#include <stdlib.h>
#include <string.h>

/* Measured on the bench's surfaces: more sweeps change the worst elements little. */
enum { SKIN_SWEEPS = 4, CORE_SWEEPS = 6 };

typedef struct {
    tm_assembly *assembly;
    const tm_skin *skin;
    const tm_feature *feature;
    const tm_surface *surface;
    tm_surface_point *at;
} fitter;

/* Puts an outer node to the place that its feature has closest to a point. */
static void put(const fitter *fit, size_t s, const double point[3])
{
    double *xyz = fit->assembly->mesh.xyz[fit->assembly->outer + s];
    const uint32_t of = fit->feature->of[s];
    if (fit->feature->kind[s] == TM_ON_CORNER) {
        memcpy(xyz, fit->surface->xyz[fit->surface->corner[of]], 3 * sizeof *xyz);
    } else if (fit->feature->kind[s] == TM_ON_CURVE) {
        size_t segment;
        tm_surface_closest_on_curve(fit->surface, of, point, xyz, &segment);
    } else {
        tm_surface_point *at = &fit->at[s];
        if (of != TM_NONE && fit->surface->patch[at->triangle] != of)
            at->triangle = TM_NONE;
        tm_surface_closest(fit->surface, point, of, at);
        memcpy(xyz, at->xyz, 3 * sizeof *xyz);
    }
}

/* The mean of the neighbours of an outer node: along its curve, or the corners of the
 * faces around it, of which those across an edge count twice. */
static void mean_on_skin(const fitter *fit, size_t s, double mean[3])
{
    const tm_skin *skin = fit->skin;
    const double(*xyz)[3] = (const double(*)[3])fit->assembly->mesh.xyz;
    const uint32_t outer = fit->assembly->outer;
    double sum[3] = {0, 0, 0};
    size_t count = 0;
    if (fit->feature->kind[s] == TM_ON_CURVE) {
        count = 2;
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 3; i++)
                sum[i] += xyz[outer + fit->feature->along[s][j]][i];
    } else {
        for (size_t a = skin->around_start[s]; a < skin->around_start[s + 1]; a++) {
            const uint32_t *face = skin->face[skin->around[a]];
            const unsigned k = tm_skin_corners(skin, skin->around[a]);
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

static void fit_skin(const fitter *fit)
{
    double point[3];
    const double(*xyz)[3] = (const double(*)[3])fit->assembly->mesh.xyz;
    for (size_t s = 0; s < fit->skin->nodes; s++) {
        memcpy(point, xyz[fit->assembly->outer + s], sizeof point);
        put(fit, s, point);
    }
    for (int sweep = 0; sweep < SKIN_SWEEPS; sweep++)
        for (size_t s = 0; s < fit->skin->nodes; s++) {
            if (fit->feature->kind[s] == TM_ON_CORNER)
                continue;
            mean_on_skin(fit, s, point);
            put(fit, s, point);
        }
}

/* The nodes below the skin that may move, and their neighbours. */
typedef struct {
    uint32_t *order; /* [nodes of the mesh]: its place in node[], or TM_NONE */
    size_t nodes;
    uint32_t *node;
    size_t *start; /* [nodes + 1] */
    uint32_t *neighbour;
    double *weight; /* of each neighbour */
} zone;

/* About the volume of an element: the mean of the determinants at its corners is that of a
 * hexahedron, twice that of a wedge, about three times that of a pyramid and six times
 * that of a tetrahedron. */
static double volume_of(const tm_mixed_mesh *mesh, const double (*xyz)[3], size_t e)
{
    static const double part[] = {[4] = 1 / 6., [5] = 1 / 3., [6] = 1 / 2., [8] = 1};
    const size_t k = mesh->start[e + 1] - mesh->start[e];
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_shape *shape = &tm_element_shapes[k];
    const size_t corners = k == 5 ? 4 : k;
    double sum = 0;
    for (size_t c = 0; c < corners; c++) {
        const unsigned char *n = shape->node[c];
        sum += 6 * tm_tet_volume(xyz[item[n[0]]], xyz[item[n[1]]], xyz[item[n[2]]],
                                 xyz[item[n[3]]]);
    }
    return part[k] * sum / (double)corners;
}

static bool has_moving(const zone *z, const tm_mixed_mesh *mesh, size_t e)
{
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (z->order[mesh->item[i]] != TM_NONE)
            return true;
    return false;
}

/* The inner nodes, and those in an element with one of them that are not outer ones. */
static tm_status find_moving(const fitter *fit, zone *z, tm_error *error)
{
    const tm_assembly *a = fit->assembly;
    const tm_mixed_mesh *mesh = &a->mesh;
    const size_t outer_end = a->outer + fit->skin->nodes;
    z->order = tm_new(mesh->nodes, sizeof *z->order);
    bool *moves = calloc(mesh->nodes + 1, 1);
    if (!z->order || !moves) {
        free(moves);
        return tm_fail_memory(error);
    }
    for (size_t n = 0; n < mesh->nodes; n++)
        z->order[n] = TM_NONE;
    for (size_t s = 0; s < fit->skin->nodes; s++)
        z->order[a->inner[s]] = 0;
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e))
            for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
                moves[mesh->item[i]] = true;
    for (size_t n = 0; n < mesh->nodes; n++) {
        const bool is_outer = n >= a->outer && n < outer_end;
        z->order[n] = moves[n] && !is_outer ? (uint32_t)z->nodes++ : TM_NONE;
    }
    free(moves);
    z->node = tm_new(z->nodes, sizeof *z->node);
    z->start = calloc(z->nodes + 2, sizeof *z->start);
    if (!z->node || !z->start)
        return tm_fail_memory(error);
    for (size_t n = 0; n < mesh->nodes; n++)
        if (z->order[n] != TM_NONE)
            z->node[z->order[n]] = (uint32_t)n;
    return TM_OK;
}

/* Counts the ends of an element's edges that move. */
static void count_edges(zone *z, const tm_mixed_mesh *mesh, size_t e)
{
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_edges *edges =
        tm_element_edges_of((unsigned)(mesh->start[e + 1] - mesh->start[e]));
    for (unsigned i = 0; i < edges->count; i++)
        for (unsigned end = 0; end < 2; end++) {
            const uint32_t from = z->order[item[edges->edge[i][end]]];
            if (from != TM_NONE)
                z->start[from + 2]++;
        }
}

/* Enters them, with the element's volume over the square of the edge's length: the sum over
 * the elements around an edge is as a spring of a solid's stiffness has it, soft along long
 * edges and stiff along short ones. */
static void enter_edges(zone *z, const tm_mixed_mesh *mesh, const double (*xyz)[3],
                        size_t e)
{
    const uint32_t *item = mesh->item + mesh->start[e];
    const tm_element_edges *edges =
        tm_element_edges_of((unsigned)(mesh->start[e + 1] - mesh->start[e]));
    const double volume = volume_of(mesh, xyz, e);
    for (unsigned i = 0; i < edges->count; i++)
        for (unsigned end = 0; end < 2; end++) {
            const uint32_t to = item[edges->edge[i][1 - end]];
            const uint32_t from = z->order[item[edges->edge[i][end]]];
            if (from == TM_NONE)
                continue;
            const size_t at = z->start[from + 1]++;
            z->neighbour[at] = to;
            z->weight[at] = volume / tm_distance2(xyz[z->node[from]], xyz[to]);
        }
}

/* Adds up the weights of equal neighbours. */
static void merge_repeats(zone *z)
{
    size_t kept = 0, begin = 0;
    for (size_t n = 0; n < z->nodes; n++) {
        const size_t first = kept, end = z->start[n + 1];
        for (size_t i = begin; i < end; i++) {
            size_t j = first;
            while (j < kept && z->neighbour[j] != z->neighbour[i])
                j++;
            if (j == kept) {
                z->neighbour[kept] = z->neighbour[i];
                z->weight[kept++] = 0;
            }
            z->weight[j] += z->weight[i];
        }
        begin = end;
        z->start[n + 1] = kept;
    }
}

static tm_status find_neighbours(zone *z, const tm_mixed_mesh *mesh,
                                 const double (*xyz)[3], tm_error *error)
{
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e))
            count_edges(z, mesh, e);
    for (size_t n = 0; n <= z->nodes; n++)
        z->start[n + 1] += z->start[n];
    z->neighbour = tm_new(z->start[z->nodes + 1], sizeof *z->neighbour);
    z->weight = tm_new(z->start[z->nodes + 1], sizeof *z->weight);
    if (!z->neighbour || !z->weight)
        return tm_fail_memory(error);
    for (size_t e = 0; e < mesh->elements; e++)
        if (has_moving(z, mesh, e))
            enter_edges(z, mesh, xyz, e);
    merge_repeats(z);
    return TM_OK;
}

/* How far each node has gone from where it began is averaged, not its place: so what is
 * unequal on the lattice, at small neighbours of large leaves, stays in shape. */
static void average(const zone *z, tm_mixed_mesh *mesh, const double (*from)[3])
{
    for (int sweep = 0; sweep < CORE_SWEEPS; sweep++)
        for (size_t n = 0; n < z->nodes; n++) {
            double sum[3] = {0, 0, 0};
            double weights = 0;
            for (size_t i = z->start[n]; i < z->start[n + 1]; i++) {
                const uint32_t m = z->neighbour[i];
                weights += z->weight[i];
                for (int j = 0; j < 3; j++)
                    sum[j] += z->weight[i] * (mesh->xyz[m][j] - from[m][j]);
            }
            for (int j = 0; j < 3; j++)
                mesh->xyz[z->node[n]][j] = from[z->node[n]][j] + sum[j] / weights;
        }
}

tm_status tm_fit(tm_assembly *assembly, const tm_skin *skin, const tm_feature *feature,
                 const tm_surface *surface, tm_surface_point *at, tm_error *error)
{
    const fitter fit = {assembly, skin, feature, surface, at};
    zone z = {0};
    double(*from)[3] = malloc(assembly->mesh.nodes * sizeof *from);
    memcpy(from, assembly->mesh.xyz, assembly->mesh.nodes * sizeof *from);
    fit_skin(&fit);
    tm_status status = find_moving(&fit, &z, error);
    if (status == TM_OK)
        status = find_neighbours(&z, &assembly->mesh, (const double(*)[3])from, error);
    if (status == TM_OK)
        average(&z, &assembly->mesh, (const double(*)[3])from);
    free(from);
    free(z.order);
    free(z.node);
    free(z.start);
    free(z.neighbour);
    free(z.weight);
    return status;
}
