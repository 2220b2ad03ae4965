/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vem.h"

#include "system.h"

#include "../../lib/base/array.h"
#include "../../lib/geom/vector.h"

#include <stdlib.h>
#include <string.h>

/* One cell. */
typedef struct {
    size_t nodes;
    const uint32_t *node;  /* [nodes]: of the mesh, each once */
    double (*place)[3];    /* [nodes]: from the mean of all, `origin` */
    double (*gradient)[3]; /* [nodes]: of the projection of each node's function */
    double origin[3];
    double arm[3];        /* from the origin to the centroid */
    double product[3][3]; /* the sum of place × place over the nodes */
    double volume;
    double diameter;
    uint32_t *local; /* [nodes of the mesh]: the place in node[] */
} element;

typedef struct {
    const solve_mesh *mesh;
    const solution *exact;
    element e;
    linear_system system;
    size_t unknowns;
    uint32_t *unknown; /* [nodes]: its number, or TM_NONE: known, or in no facet */
    double *value;     /* [nodes]: the solution's, then what was found */
} assembly;

static void assembly_free(assembly *a)
{
    free(a->e.place);
    free(a->e.gradient);
    free(a->e.local);
    free(a->unknown);
    free(a->value);
    linear_system_free(&a->system);
}

/* Numbers the nodes that facets have and the boundary has not. */
static void number_unknowns(assembly *a)
{
    enum { INSIDE = 0 };
    const tm_poly_arrays *mesh = &a->mesh->of;
    for (size_t v = 0; v < mesh->nodes; v++)
        a->unknown[v] = TM_NONE;
    for (size_t k = 0; k < mesh->facet_start[mesh->facets]; k++)
        a->unknown[mesh->facet_node[k]] = INSIDE;
    for (size_t f = 0; f < mesh->facets; f++)
        for (size_t k = mesh->facet_start[f]; k < mesh->facet_start[f + 1]; k++)
            if (mesh->side[f][1] == TM_NONE)
                a->unknown[mesh->facet_node[k]] = TM_NONE;
    for (size_t v = 0; v < mesh->nodes; v++)
        if (a->unknown[v] == INSIDE)
            a->unknown[v] = (uint32_t)a->unknowns++;
}

static tm_status start(assembly *a, tm_error *error)
{
    const solve_mesh *mesh = a->mesh;
    size_t most = 0;
    for (size_t c = 0; c < mesh->of.cells; c++) {
        const size_t nodes = mesh->node_start[c + 1] - mesh->node_start[c];
        most = nodes > most ? nodes : most;
    }
    a->e.place = tm_new(most, sizeof *a->e.place);
    a->e.gradient = tm_new(most, sizeof *a->e.gradient);
    a->e.local = tm_new(mesh->of.nodes, sizeof *a->e.local);
    a->unknown = tm_new(mesh->of.nodes, sizeof *a->unknown);
    a->value = tm_new(mesh->of.nodes, sizeof *a->value);
    if (!a->e.place || !a->e.gradient || !a->e.local || !a->unknown || !a->value)
        return tm_fail_memory(error);
    number_unknowns(a);
    for (size_t v = 0; v < mesh->of.nodes; v++)
        a->value[v] = a->exact->u(mesh->of.xyz[v]);
    return linear_system_start(&a->system, a->unknowns, error);
}

/* Where the nodes are, and what is known from that. */
static void place_nodes(element *e, const solve_mesh *mesh)
{
    memset(e->origin, 0, sizeof e->origin);
    memset(e->product, 0, sizeof e->product);
    for (size_t i = 0; i < e->nodes; i++) {
        e->local[e->node[i]] = (uint32_t)i;
        for (int k = 0; k < 3; k++)
            e->origin[k] += mesh->of.xyz[e->node[i]][k] / (double)e->nodes;
    }
    for (size_t i = 0; i < e->nodes; i++) {
        tm_subtract(e->place[i], mesh->of.xyz[e->node[i]], e->origin);
        for (int x = 0; x < 3; x++)
            for (int y = 0; y < 3; y++)
                e->product[x][y] += e->place[i][x] * e->place[i][y];
    }
}

/* Adds, for each corner of the facet, the mean over the facet of the projection of its
 * function, 1/n + g·(c - m), where g is its gradient, c the centroid and m the corners'
 * mean, times the facet's area outward. An edge from a to b gives both its nodes
 * (b - a) × normal / 2. */
static void add_facet(element *e, const solve_mesh *mesh, size_t f, double side)
{
    enum { TRIANGLE = 3 };
    const size_t n = solve_corners(mesh, f);
    const double *area = mesh->area[f], area2 = tm_norm2(area);
    double arm[3];
    tm_subtract(arm, mesh->middle[f], e->origin);
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            arm[k] -= e->place[e->local[solve_corner(mesh, f, i)]][k] / (double)n;
    for (size_t i = 0; i < n; i++) {
        const uint32_t v = e->local[solve_corner(mesh, f, i)];
        double share = 1 / (double)n, along[3], across[3];
        if (n > TRIANGLE && area2 > 0) {
            tm_subtract(along, e->place[e->local[solve_corner(mesh, f, (i + 1) % n)]],
                        e->place[e->local[solve_corner(mesh, f, (i + n - 1) % n)]]);
            tm_cross(across, along, area);
            share += tm_dot(across, arm) / 2 / area2;
        }
        for (int k = 0; k < 3; k++)
            e->gradient[v][k] += side * share * area[k];
    }
}

/* Sets it to a cell: the gradients by Gauss. */
static void set(element *e, const solve_mesh *mesh, size_t c)
{
    e->nodes = mesh->node_start[c + 1] - mesh->node_start[c];
    e->node = mesh->node + mesh->node_start[c];
    e->volume = mesh->volume[c];
    e->diameter = mesh->diameter[c];
    place_nodes(e, mesh);
    tm_subtract(e->arm, mesh->centroid[c], e->origin);
    memset(e->gradient, 0, e->nodes * sizeof *e->gradient);
    for (size_t k = mesh->of.cell_start[c]; k < mesh->of.cell_start[c + 1]; k++) {
        const uint32_t f = mesh->of.cell_facet[k];
        add_facet(e, mesh, f, solve_side(mesh, f, c));
    }
    for (size_t i = 0; i < e->nodes; i++)
        for (int k = 0; k < 3; k++)
            e->gradient[i][k] /= e->volume;
}

/* The value at node j of the projection of node i's function. */
static double projected(const element *e, size_t i, size_t j)
{
    return 1 / (double)e->nodes + tm_dot(e->gradient[i], e->place[j]);
}

/* The stiffness between its nodes i and j. */
static double stiffness(const element *e, size_t i, size_t j)
{
    const double *g = e->gradient[i], *h = e->gradient[j];
    /* The sum over all nodes of the product of what is not projected, multiplied out. */
    double rest = (i == j) - projected(e, i, j) - projected(e, j, i);
    rest += 1 / (double)e->nodes;
    for (int x = 0; x < 3; x++)
        rest += g[x] * tm_dot(e->product[x], h);
    return e->volume * tm_dot(g, h) + e->diameter * rest;
}

/* Adds a cell's equations. */
static bool add_cell(assembly *a, size_t c)
{
    element *e = &a->e;
    set(e, a->mesh, c);
    const double source = a->exact->f(a->mesh->centroid[c]);
    for (size_t i = 0; i < e->nodes; i++) {
        const uint32_t row = a->unknown[e->node[i]];
        if (row == TM_NONE)
            continue;
        const double mean = 1 / (double)e->nodes + tm_dot(e->gradient[i], e->arm);
        a->system.right[row] += source * e->volume * mean;
        for (size_t j = 0; j < e->nodes; j++) {
            const uint32_t column = a->unknown[e->node[j]];
            const double entry = stiffness(e, i, j);
            if (column == TM_NONE)
                a->system.right[row] -= entry * a->value[e->node[j]];
            else if (!linear_system_add(&a->system, row, column, entry))
                return false;
        }
    }
    return true;
}

/* The projection of what was found in a cell. */
static solve_cell project(assembly *a, size_t c)
{
    element *e = &a->e;
    solve_cell found = {0};
    set(e, a->mesh, c);
    for (size_t i = 0; i < e->nodes; i++) {
        found.value += a->value[e->node[i]] / (double)e->nodes;
        for (int k = 0; k < 3; k++)
            found.gradient[k] += a->value[e->node[i]] * e->gradient[i][k];
    }
    found.value += tm_dot(found.gradient, e->arm);
    return found;
}

tm_status vem_solve(solve_cell *found, size_t *unknowns, const solve_mesh *mesh,
                    const solution *exact, tm_error *error)
{
    assembly a = {.mesh = mesh, .exact = exact};
    tm_status status = start(&a, error);
    for (size_t c = 0; c < mesh->of.cells && status == TM_OK; c++)
        if (!add_cell(&a, c))
            status = tm_fail_memory(error);
    if (status == TM_OK && a.unknowns > 0)
        status = linear_system_solve(&a.system, error);
    for (size_t v = 0; v < mesh->of.nodes && status == TM_OK; v++)
        if (a.unknown[v] != TM_NONE)
            a.value[v] = a.system.right[a.unknown[v]];
    for (size_t c = 0; c < mesh->of.cells && status == TM_OK; c++)
        found[c] = project(&a, c);
    *unknowns = a.unknowns;
    assembly_free(&a);
    return status;
}
