/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh.h"

#include "../../lib/base/array.h"
#include "../../lib/geom/vector.h"

#include <stdlib.h>
#include <string.h>

void solve_mesh_free(solve_mesh *m)
{
    free(m->area);
    free(m->middle);
    free(m->centroid);
    free(m->volume);
    free(m->surface);
    free(m->diameter);
    free(m->node_start);
    free(m->node);
    *m = (solve_mesh){0};
}

static bool allocate(solve_mesh *m)
{
    const size_t facets = m->of.facets, cells = m->of.cells;
    m->area = tm_new(facets, sizeof *m->area);
    m->middle = tm_new(facets, sizeof *m->middle);
    m->centroid = tm_new(cells, sizeof *m->centroid);
    m->volume = tm_new(cells, sizeof *m->volume);
    m->surface = tm_new(cells, sizeof *m->surface);
    m->diameter = tm_new(cells, sizeof *m->diameter);
    m->node_start = tm_new(cells + 1, sizeof *m->node_start);
    return m->area && m->middle && m->centroid && m->volume && m->surface &&
           m->diameter && m->node_start;
}

/* Lists the nodes of each cell. */
static bool gather_nodes(solve_mesh *m)
{
    size_t count = 0, room = 0;
    uint32_t *last = tm_new(m->of.nodes, sizeof *last); /* the last cell that had it */
    for (size_t v = 0; v < m->of.nodes && last; v++)
        last[v] = TM_NONE;
    bool done = last != NULL;
    for (size_t c = 0; c < m->of.cells && done; c++) {
        m->node_start[c] = count;
        for (size_t k = m->of.cell_start[c]; k < m->of.cell_start[c + 1]; k++) {
            const uint32_t f = m->of.cell_facet[k];
            for (size_t i = 0; i < solve_corners(m, f) && done; i++) {
                const uint32_t v = solve_corner(m, f, i);
                if (last[v] != c)
                    done = tm_append(&m->node, &count, &room, v);
                last[v] = (uint32_t)c;
            }
        }
    }
    m->node_start[m->of.cells] = count;
    free(last);
    return done;
}

/* The normal of triangle i of a facet's fan, 2 ≤ i < corners, twice as long as the area;
 * its nodes around `origin` to x. */
static void triangle(const solve_mesh *m, size_t f, size_t i, const double origin[3],
                     double x[3][3], double normal[3])
{
    const uint32_t corner[3] = {solve_corner(m, f, 0), solve_corner(m, f, i - 1),
                                solve_corner(m, f, i)};
    for (int j = 0; j < 3; j++)
        tm_subtract(x[j], m->of.xyz[corner[j]], origin);
    tm_triangle_normal(normal, x[0], x[1], x[2]);
}

static void measure_facet(solve_mesh *m, size_t f)
{
    const double *origin = m->of.xyz[solve_corner(m, f, 0)];
    double *area = m->area[f], *middle = m->middle[f], x[3][3], normal[3];
    tm_polygon_area(m->of.xyz, m->of.facet_node + m->of.facet_start[f],
                    solve_corners(m, f), area);
    memcpy(middle, origin, sizeof m->middle[f]);
    const double area2 = tm_norm2(area);
    for (size_t i = 2; i < solve_corners(m, f) && area2 > 0; i++) {
        triangle(m, f, i, origin, x, normal);
        const double part = tm_dot(normal, area) / 2 / area2;
        for (int k = 0; k < 3; k++)
            middle[k] += part * (x[1][k] + x[2][k]) / 3;
    }
}

static void measure_diameter(solve_mesh *m, size_t c)
{
    double longest2 = 0;
    for (size_t i = m->node_start[c]; i < m->node_start[c + 1]; i++)
        for (size_t j = m->node_start[c]; j < i; j++)
            longest2 = fmax(longest2,
                            tm_distance2(m->of.xyz[m->node[i]], m->of.xyz[m->node[j]]));
    m->diameter[c] = sqrt(longest2);
}

/* Volume and centroid by the tetrahedra of a node and the triangles. */
static tm_status measure_cell(solve_mesh *m, size_t c, tm_error *error)
{
    enum { NODES = 4 };
    const double determinant_per_volume = 6;
    double moment[3] = {0}, volume = 0, surface = 0, x[3][3], normal[3];
    const double *origin = NULL;
    for (size_t k = m->of.cell_start[c]; k < m->of.cell_start[c + 1]; k++) {
        const uint32_t f = m->of.cell_facet[k], *of = m->of.side[f];
        if (of[0] == of[1] || (of[0] != c && of[1] != c))
            return tm_fail(error, TM_ERROR_INPUT,
                           "cell %zu has facet %u, which is between others", c, f);
        origin = origin ? origin : m->of.xyz[solve_corner(m, f, 0)];
        surface += tm_norm(m->area[f]);
        for (size_t i = 2; i < solve_corners(m, f); i++) {
            triangle(m, f, i, origin, x, normal);
            const double part =
                solve_side(m, f, c) * tm_dot(normal, x[0]) / determinant_per_volume;
            volume += part;
            for (int j = 0; j < 3; j++)
                moment[j] += part * (x[0][j] + x[1][j] + x[2][j]) / NODES;
        }
    }
    if (!(volume > 0))
        return tm_fail(error, TM_ERROR_INPUT, "cell %zu has the volume %g", c, volume);
    m->volume[c] = volume;
    m->surface[c] = surface;
    for (int j = 0; j < 3; j++)
        m->centroid[c][j] = origin[j] + moment[j] / volume;
    return TM_OK;
}

tm_status solve_mesh_start(solve_mesh *m, const tm_stream *stream, tm_error *error)
{
    *m = (solve_mesh){.of = tm_poly_arrays_of(stream)};
    if (m->of.cells == 0)
        return tm_fail(error, TM_ERROR_INPUT, "no polyhedra (polylla3d makes them)");
    if (!allocate(m) || !gather_nodes(m))
        return tm_fail_memory(error);
    tm_status status = TM_OK;
    for (size_t f = 0; f < m->of.facets; f++)
        measure_facet(m, f);
    for (size_t c = 0; c < m->of.cells && status == TM_OK; c++) {
        measure_diameter(m, c);
        status = measure_cell(m, c, error);
    }
    return status;
}
