/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solution.h"

#include "quadrature.h"

#include "../../lib/geom/vector.h"

#include <math.h>
#include <string.h>

static const double slope[3] = {2, -3, 0.5}, wave_number[2] = {2, 3};

static double linear(const double x[3])
{
    return 1 + tm_dot(slope, x);
}

static double linear_source(const double x[3])
{
    (void)x;
    return 0;
}

static void linear_gradient(const double x[3], double g[3])
{
    (void)x;
    memcpy(g, slope, sizeof slope);
}

static double wave(const double x[3])
{
    return sin(wave_number[0] * x[0]) * cos(wave_number[1] * x[1]) * exp(x[2]);
}

static double wave_source(const double x[3])
{
    const double *k = wave_number;
    return (k[0] * k[0] + k[1] * k[1] - 1) * wave(x);
}

static void wave_gradient(const double x[3], double g[3])
{
    const double *k = wave_number;
    g[0] = k[0] * cos(k[0] * x[0]) * cos(k[1] * x[1]) * exp(x[2]);
    g[1] = -k[1] * sin(k[0] * x[0]) * sin(k[1] * x[1]) * exp(x[2]);
    g[2] = wave(x);
}

const solution solution_linear = {linear, linear_source, linear_gradient};
const solution solution_wave = {wave, wave_source, wave_gradient};

/* Sums of squares: of the errors, and of the solution. */
typedef struct {
    double off[2], all[2];
} squares;

static void add_cell(squares *s, const solution *exact, const quadrature *q,
                     const double centroid[3], const solve_cell *found)
{
    for (size_t i = 0; i < q->count; i++) {
        const double *x = q->x[i], w = q->weight[i], u = exact->u(x);
        double from[3], g[3], difference[3];
        tm_subtract(from, x, centroid);
        exact->gradient(x, g);
        tm_subtract(difference, g, found->gradient);
        const double off = u - found->value - tm_dot(found->gradient, from);
        s->off[0] += w * off * off;
        s->off[1] += w * tm_norm2(difference);
        s->all[0] += w * u * u;
        s->all[1] += w * tm_norm2(g);
    }
}

tm_status solution_errors(solve_errors *errors, const solution *exact,
                          const solve_mesh *mesh, const solve_cell *found,
                          tm_error *error)
{
    quadrature q = {0};
    squares s = {{0}, {0}};
    tm_status status = TM_OK;
    for (size_t c = 0; c < mesh->of.cells && status == TM_OK; c++)
        if (quadrature_of_cell(&q, mesh, c))
            add_cell(&s, exact, &q, mesh->centroid[c], &found[c]);
        else
            status = tm_fail_memory(error);
    quadrature_free(&q);
    errors->l2 = sqrt(s.off[0] / s.all[0]);
    errors->h1 = sqrt(s.off[1] / s.all[1]);
    return status;
}
