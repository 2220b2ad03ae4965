/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octant_faces.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../../mesh/mixed_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Whether corner c of an octant is one of the edge or face that point p is the middle of.
 */
static bool is_corner_of(unsigned c, unsigned p)
{
    for (int i = 0; i < 3; i++)
        if (tm_leaf_point[p][i] != 1 && tm_leaf_point[p][i] != tm_leaf_point[c][i])
            return false;
    return true;
}

/* Moves the middle of a face outward, which is at the mean of the corners x, by so much
 * that its quarters are convex. */
static void bulge(const double *const x[4], const double centre[3], double middle[3])
{
    const double margin = 1.2, least = 1e-3;
    double along[3], across[3], normal[3], outward[3], saddle[3];
    tm_subtract(along, x[3], x[0]);
    tm_subtract(across, x[2], x[1]);
    tm_cross(normal, along, across);
    tm_subtract(outward, middle, centre);
    const double length = tm_norm(normal);
    if (!(length > 0))
        return;
    for (int i = 0; i < 3; i++)
        saddle[i] = (x[0][i] + x[3][i] - x[1][i] - x[2][i]) / 4;
    const double bent = fabs(tm_dot(normal, saddle)) / length;
    const double step =
        (margin * bent + least * sqrt(length)) * (tm_dot(normal, outward) < 0 ? -1 : 1);
    for (int i = 0; i < 3; i++)
        middle[i] += step * normal[i] / length;
}

static void level_octant(const uint32_t node[TM_OCTANT_POINTS], double (*xyz)[3],
                         const bool *outer)
{
    double centre[3] = {0, 0, 0};
    for (unsigned c = 0; c < TM_LEAF_EDGE; c++)
        for (int i = 0; i < 3; i++)
            centre[i] += xyz[node[c]][i] / TM_LEAF_EDGE;
    for (unsigned p = TM_LEAF_EDGE; p < TM_LEAF_NODES; p++) {
        const double *corner[4];
        double sum[3] = {0, 0, 0};
        int corners = 0;
        if (node[p] == TM_NONE || outer[node[p]])
            continue;
        for (unsigned c = 0; c < TM_LEAF_EDGE; c++)
            if (is_corner_of(c, p))
                corner[corners++] = xyz[node[c]];
        for (int k = 0; k < corners; k++)
            for (int i = 0; i < 3; i++)
                sum[i] += corner[k][i] / corners;
        if (corners == 4)
            bulge(corner, centre, sum);
        memcpy(xyz[node[p]], sum, sizeof sum);
    }
}

static void level_all(const tm_octant_points *points, double (*xyz)[3], const bool *outer)
{
    for (unsigned level = 0; level <= points->finest; level++)
        for (size_t o = 0; o < points->octant->count; o++) {
            uint32_t node[TM_OCTANT_POINTS];
            if (tm_octant_level(points, o) == level && tm_octant_is_filled(points, o) &&
                tm_octant_points_find(points, o, node))
                level_octant(node, xyz, outer);
        }
}

/* Elements at the boundary stay what they are, and their nodes are not moved at a cost to
 * them. */
typedef struct {
    tm_mixed_mesh mesh;
    double (*old)[3];
    uint32_t *element; /* those that have outer nodes */
    size_t elements, room;
    double *jens; /* [elements]: before */
} layer;

static bool find_layer(layer *l, const tm_block *mix, const bool *outer)
{
    const tm_mixed_mesh *mesh = &l->mesh;
    for (uint32_t e = 0; e < mesh->elements; e++)
        if (tm_element_has(mix, e, outer) &&
            !tm_append(&l->element, &l->elements, &l->room, e))
            return false;
    l->jens = tm_new(l->elements, sizeof *l->jens);
    for (size_t k = 0; k < l->elements && l->jens; k++)
        l->jens[k] = tm_mixed_jens(mesh, l->element[k]);
    return l->jens;
}

static bool is_same(const double a[3], const double b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool take_back(layer *l, size_t e)
{
    const tm_mixed_mesh *mesh = &l->mesh;
    bool any = false;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
        const uint32_t v = mesh->item[i];
        any |= !is_same(mesh->xyz[v], l->old[v]);
        memcpy(mesh->xyz[v], l->old[v], sizeof *l->old);
    }
    return any;
}

/* Until no element is worse: each time nodes go back, of which there are so many. */
static void take_back_worse(layer *l)
{
    const double enough = 0.2;
    for (bool again = true; again;) {
        again = false;
        for (size_t k = 0; k < l->elements; k++) {
            const double now = tm_mixed_jens(&l->mesh, l->element[k]);
            if (now < l->jens[k] && now < enough)
                again |= take_back(l, l->element[k]);
        }
    }
}

tm_status tm_octant_faces_level(const tm_octant_points *points, double (*xyz)[3],
                                size_t nodes, const bool *outer, size_t *moved,
                                tm_error *error)
{
    const tm_block *mix = points->mix;
    layer l = {.mesh = {nodes, xyz, mix->count, mix->start, mix->item, .threads = 1}};
    l.old = tm_new(nodes, sizeof *l.old);
    const bool done = l.old && find_layer(&l, mix, outer);
    *moved = 0;
    if (done) {
        memcpy(l.old, xyz, nodes * sizeof *xyz);
        level_all(points, xyz, outer);
        take_back_worse(&l);
        for (size_t v = 0; v < nodes; v++)
            *moved += !is_same(xyz[v], l.old[v]);
    }
    free(l.old);
    free(l.element);
    free(l.jens);
    return done ? TM_OK : tm_fail_memory(error);
}
