/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "element.h"

#include "../../lib/base/array.h"
#include "../../lib/geom/vector.h"

#include <stdlib.h>
#include <string.h>

/* A facet as seen from its first cell. */
typedef struct {
    size_t nodes;
    const uint32_t *node;
    double area[3]; /* the normal, as long as the area */
    double centroid[3];
} facet;

static const uint32_t *facet_nodes(const vem_mesh *mesh, size_t f, size_t *count)
{
    const size_t *start = mesh->facet->start;
    *count = start[f + 1] - start[f];
    return mesh->facet->item + start[f];
}

tm_status vem_element_start(vem_element *e, const vem_mesh *mesh, tm_error *error)
{
    size_t largest = 0;
    *e = (vem_element){0};
    for (size_t f = 0; f < mesh->facet->count; f++) {
        size_t count;
        facet_nodes(mesh, f, &count);
        largest = count > largest ? count : largest;
    }
    e->local = tm_new(mesh->nodes, sizeof *e->local);
    e->weight = tm_new(largest, sizeof *e->weight);
    if (!e->local || !e->weight)
        return tm_fail_memory(error);
    for (size_t v = 0; v < mesh->nodes; v++)
        e->local[v] = TM_NONE;
    return TM_OK;
}

void vem_element_free(vem_element *e)
{
    free(e->node);
    free(e->place);
    free(e->gradient);
    free(e->local);
    free(e->weight);
    *e = (vem_element){0};
}

/* Makes room for one more node in all three arrays, which grow alike. */
static bool reserve(vem_element *e)
{
    size_t room[3] = {e->room, e->room, e->room};
    uint32_t *node = tm_grow(e->node, &room[0], e->nodes + 1, sizeof *node);
    e->node = node ? node : e->node;
    double(*place)[3] = tm_grow(e->place, &room[1], e->nodes + 1, sizeof *place);
    e->place = place ? place : e->place;
    double(*gradient)[3] = tm_grow(e->gradient, &room[2], e->nodes + 1, sizeof *gradient);
    e->gradient = gradient ? gradient : e->gradient;
    if (!node || !place || !gradient)
        return false;
    for (int k = 0; k < 3; k++)
        e->room = k == 0 || room[k] < e->room ? room[k] : e->room;
    return true;
}

/* Gathers the nodes of the facets, and their mean. */
static bool gather(vem_element *e, const vem_mesh *mesh, size_t c)
{
    const tm_block *cell = mesh->cell;
    for (size_t i = 0; i < e->nodes; i++)
        e->local[e->node[i]] = TM_NONE;
    e->nodes = 0;
    double sum[3] = {0};
    for (size_t k = cell->start[c]; k < cell->start[c + 1]; k++) {
        size_t count;
        const uint32_t *node = facet_nodes(mesh, cell->item[k], &count);
        for (size_t i = 0; i < count; i++) {
            if (e->local[node[i]] != TM_NONE)
                continue;
            if (!reserve(e))
                return false;
            e->local[node[i]] = (uint32_t)e->nodes;
            for (int x = 0; x < 3; x++)
                sum[x] += mesh->xyz[node[i]][x];
            e->node[e->nodes++] = node[i];
        }
    }
    for (int x = 0; x < 3; x++)
        e->origin[x] = e->nodes > 0 ? sum[x] / (double)e->nodes : 0;
    return true;
}

/* Where the nodes are, and what is known from that. */
static void measure_nodes(vem_element *e, const vem_mesh *mesh)
{
    double diameter2 = 0;
    memset(e->product, 0, sizeof e->product);
    for (size_t i = 0; i < e->nodes; i++) {
        tm_subtract(e->place[i], mesh->xyz[e->node[i]], e->origin);
        for (size_t j = 0; j < i; j++)
            diameter2 = fmax(diameter2, tm_distance2(e->place[i], e->place[j]));
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                e->product[x][y] += e->place[i][x] * e->place[i][y];
    }
    e->diameter = sqrt(diameter2);
}

static const double *place(const vem_element *e, uint32_t v)
{
    return e->place[e->local[v]];
}

/* The facet's area and centroid, by the triangles of a fan, which may overlap; what each
 * of them spans with the origin goes to the volume and the centroid of the cell. */
static facet measure_facet(vem_element *e, const vem_mesh *mesh, size_t f, double side)
{
    facet made = {0};
    made.node = facet_nodes(mesh, f, &made.nodes);
    const double *a = place(e, made.node[0]);
    for (size_t i = 2; i < made.nodes; i++) {
        double normal[3];
        tm_triangle_normal(normal, a, place(e, made.node[i - 1]), place(e, made.node[i]));
        for (int x = 0; x < 3; x++)
            made.area[x] += normal[x] / 2;
    }
    double area2 = tm_norm2(made.area);
    for (size_t i = 2; i < made.nodes && area2 > 0; i++) {
        double normal[3];
        const double *b = place(e, made.node[i - 1]), *c = place(e, made.node[i]);
        tm_triangle_normal(normal, a, b, c);
        double part = tm_dot(normal, made.area) / 2 / area2;
        const double sixth = 1. / 6, triangle = 3, tetrahedron = 4;
        double volume = side * sixth * tm_dot(normal, a);
        e->volume += volume;
        for (int x = 0; x < 3; x++) {
            double sum = a[x] + b[x] + c[x];
            made.centroid[x] += part * sum / triangle;
            e->centroid[x] += volume * sum / tetrahedron;
        }
    }
    return made;
}

/* weight[i]: the mean over the facet of the projection of node i's function: 1/n + g·(c -
 * m), where g is its gradient, c the centroid and m the nodes' mean. An edge from a to b
 * gives both its nodes (b - a) × normal / 2. */
static void weigh_facet(vem_element *e, const facet *f)
{
    enum { TRIANGLE = 3 };
    double area2 = tm_norm2(f->area), arm[3];
    memcpy(arm, f->centroid, sizeof arm);
    for (size_t i = 0; i < f->nodes; i++)
        for (int x = 0; x < 3; x++)
            arm[x] -= place(e, f->node[i])[x] / (double)f->nodes;
    for (size_t i = 0; i < f->nodes; i++) {
        e->weight[i] = 1 / (double)f->nodes;
        if (f->nodes == TRIANGLE || !(area2 > 0))
            continue;
        double along[3], across[3];
        tm_subtract(along, place(e, f->node[(i + 1) % f->nodes]),
                    place(e, f->node[(i + f->nodes - 1) % f->nodes]));
        tm_cross(across, along, f->area);
        e->weight[i] += tm_dot(across, arm) / 2 / area2;
    }
}

/* The gradients, times the volume, by Gauss. */
static tm_status integrate(vem_element *e, const vem_mesh *mesh, size_t c,
                           tm_error *error)
{
    const tm_block *cell = mesh->cell;
    memset(e->gradient, 0, e->nodes * sizeof *e->gradient);
    memset(e->centroid, 0, sizeof e->centroid);
    e->volume = 0;
    for (size_t k = cell->start[c]; k < cell->start[c + 1]; k++) {
        uint32_t f = cell->item[k];
        const uint32_t *of = mesh->facet->integer + 2 * (size_t)f;
        if (of[0] == of[1] || (of[0] != c && of[1] != c))
            return tm_fail(error, TM_ERROR_INPUT,
                           "cell %zu has facet %u, which is between others", c, f);
        double side = of[0] == c ? 1 : -1;
        facet made = measure_facet(e, mesh, f, side);
        weigh_facet(e, &made);
        for (size_t i = 0; i < made.nodes; i++)
            for (int x = 0; x < 3; x++)
                e->gradient[e->local[made.node[i]]][x] +=
                    side * e->weight[i] * made.area[x];
    }
    return TM_OK;
}

tm_status vem_element_set(vem_element *e, const vem_mesh *mesh, size_t c, tm_error *error)
{
    if (!gather(e, mesh, c))
        return tm_fail_memory(error);
    measure_nodes(e, mesh);
    if (integrate(e, mesh, c, error) != TM_OK)
        return error->status;
    if (!(e->volume > 0))
        return tm_fail(error, TM_ERROR_INPUT, "cell %zu has the volume %g", c, e->volume);
    for (int x = 0; x < 3; x++)
        e->centroid[x] /= e->volume;
    for (size_t i = 0; i < e->nodes; i++)
        for (int x = 0; x < 3; x++)
            e->gradient[i][x] /= e->volume;
    return TM_OK;
}

/* The value at node j of the projection of node i's function. */
static double projected(const vem_element *e, size_t i, size_t j)
{
    return 1 / (double)e->nodes + tm_dot(e->gradient[i], e->place[j]);
}

double vem_stiffness(const vem_element *e, size_t i, size_t j)
{
    const double *g = e->gradient[i], *h = e->gradient[j];
    /* The sum over all nodes of the product of what is not projected, multiplied out. */
    double rest = (i == j) - projected(e, i, j) - projected(e, j, i);
    rest += 1 / (double)e->nodes;
    for (int x = 0; x < 3; x++)
        rest += g[x] * tm_dot(e->product[x], h);
    return e->volume * tm_dot(g, h) + e->diameter * rest;
}

double vem_integral(const vem_element *e, size_t i)
{
    return e->volume * (1 / (double)e->nodes + tm_dot(e->gradient[i], e->centroid));
}
