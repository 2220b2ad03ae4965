/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "dg.h"

#include "quadrature.h"
#include "system.h"

#include "../../lib/geom/vector.h"

enum { BASIS = 4, SIDES = 2 };

typedef struct {
    const solve_mesh *mesh;
    const solution *exact;
    linear_system system;
    quadrature q;
} assembly;

/* The functions of a cell at a point: 1, and the coordinates around its centroid by its
 * diameter. */
static void basis(const solve_mesh *mesh, size_t c, const double x[3],
                  double value[BASIS])
{
    value[0] = 1;
    for (int k = 0; k < 3; k++)
        value[k + 1] = (x[k] - mesh->centroid[c][k]) / mesh->diameter[c];
}

static bool add_cell(assembly *a, size_t c)
{
    const double h = a->mesh->diameter[c];
    double *right = a->system.right + BASIS * c, value[BASIS];
    if (!quadrature_of_cell(&a->q, a->mesh, c))
        return false;
    for (size_t i = 0; i < a->q.count; i++) {
        basis(a->mesh, c, a->q.x[i], value);
        for (int k = 0; k < BASIS; k++)
            right[k] += a->q.weight[i] * a->exact->f(a->q.x[i]) * value[k];
    }
    for (size_t k = BASIS * c + 1; k < BASIS * (c + 1); k++)
        if (!linear_system_add(&a->system, k, k, a->mesh->volume[c] / h / h))
            return false;
    return true;
}

static double penalty(const solve_mesh *mesh, size_t f, size_t sides)
{
    const double inside = 1.5, boundary = 3;
    double most = 0;
    for (size_t s = 0; s < sides; s++) {
        const uint32_t c = mesh->of.side[f][s];
        most = fmax(most, mesh->surface[c] / mesh->volume[c]);
    }
    return most * (sides == SIDES ? inside : boundary);
}

/* What the functions of the cells at a facet have there: the jump, and the mean of the
 * gradients along the normal, times the point's weight. */
typedef struct {
    double jump[SIDES * BASIS], flux[SIDES * BASIS];
} trace;

static trace trace_at(const assembly *a, size_t f, size_t sides, size_t i)
{
    trace t = {{0}, {0}};
    for (size_t s = 0; s < sides; s++) {
        const uint32_t c = a->mesh->of.side[f][s];
        double value[BASIS];
        basis(a->mesh, c, a->q.x[i], value);
        for (size_t k = 0; k < BASIS; k++) {
            t.jump[BASIS * s + k] = s == 0 ? value[k] : -value[k];
            if (k > 0)
                t.flux[BASIS * s + k] =
                    a->q.normal[i][k - 1] / a->mesh->diameter[c] / (double)sides;
        }
    }
    return t;
}

/* The boundary's values to the right side. */
static void add_boundary(assembly *a, size_t c, const trace *t, const double x[3],
                         double stiffness)
{
    const double u = a->exact->u(x);
    for (size_t k = 0; k < BASIS; k++)
        a->system.right[BASIS * c + k] += u * (stiffness * t->jump[k] - t->flux[k]);
}

static bool add_facet(assembly *a, size_t f)
{
    const uint32_t *side = a->mesh->of.side[f];
    const size_t sides = side[1] == TM_NONE ? 1 : SIDES, n = BASIS * sides;
    const double sigma = penalty(a->mesh, f, sides);
    double local[SIDES * BASIS][SIDES * BASIS] = {{0}};
    if (!quadrature_of_facet(&a->q, a->mesh, f))
        return false;
    for (size_t i = 0; i < a->q.count; i++) {
        const double stiffness = sigma * a->q.weight[i];
        const trace t = trace_at(a, f, sides, i);
        for (size_t r = 0; r < n; r++)
            for (size_t s = 0; s < n; s++)
                local[r][s] += stiffness * t.jump[r] * t.jump[s] - t.flux[r] * t.jump[s] -
                               t.jump[r] * t.flux[s];
        if (sides == 1)
            add_boundary(a, side[0], &t, a->q.x[i], stiffness);
    }
    for (size_t r = 0; r < n; r++)
        for (size_t s = 0; s < n; s++)
            if (!linear_system_add(&a->system, BASIS * side[r / BASIS] + r % BASIS,
                                   BASIS * side[s / BASIS] + s % BASIS, local[r][s]))
                return false;
    return true;
}

tm_status dg_solve(solve_cell *found, size_t *unknowns, const solve_mesh *mesh,
                   const solution *exact, tm_error *error)
{
    assembly a = {.mesh = mesh, .exact = exact};
    *unknowns = BASIS * mesh->of.cells;
    tm_status status = linear_system_start(&a.system, *unknowns, error);
    bool done = true;
    for (size_t c = 0; c < mesh->of.cells && status == TM_OK && done; c++)
        done = add_cell(&a, c);
    for (size_t f = 0; f < mesh->of.facets && status == TM_OK && done; f++)
        done = add_facet(&a, f);
    if (!done)
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = linear_system_solve(&a.system, error);
    for (size_t c = 0; c < mesh->of.cells && status == TM_OK; c++) {
        const double *value = a.system.right + BASIS * c;
        found[c].value = value[0];
        for (int k = 0; k < 3; k++)
            found[c].gradient[k] = value[k + 1] / mesh->diameter[c];
    }
    quadrature_free(&a.q);
    linear_system_free(&a.system);
    return status;
}
