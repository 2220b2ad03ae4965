/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of polyhedra as solvers see it: the blocks of a stream, and what is measured
 * once for all. A facet is the fan of triangles around its first node, which are the same
 * for both its cells and may overlap: integrals over them, with signs, are those over the
 * polygon where it is plane. */
#ifndef TESTS_SOLVE_MESH_H
#define TESTS_SOLVE_MESH_H

#include "../../lib/mesh/poly_arrays.h"

typedef struct solve_mesh {
    tm_poly_arrays of;
    double (*area)[3];   /* [facets]: outward from the first cell, as long as the area */
    double (*middle)[3]; /* [facets]: centroids */
    double (*centroid)[3]; /* [cells] */
    double *volume;        /* [cells]: above 0 */
    double *surface;       /* [cells]: the sum of the areas of the facets */
    double *diameter;      /* [cells]: the largest distance of two nodes */
    size_t *node_start;    /* [cells + 1]: the nodes of c, each once, are */
    uint32_t *node;        /* node[node_start[c] … node_start[c + 1]) */
} solve_mesh;

/* Measures the polyhedra of a stream, which stays the owner of them. TM_ERROR_INPUT where
 * there are none, where a facet of a cell does not name it, or where a volume is not
 * above 0. solve_mesh_free() also after an error. O(nodes²) for each cell. */
tm_status solve_mesh_start(solve_mesh *mesh, const tm_stream *stream, tm_error *error);
void solve_mesh_free(solve_mesh *mesh);

static inline size_t solve_corners(const solve_mesh *mesh, size_t f)
{
    return mesh->of.facet_start[f + 1] - mesh->of.facet_start[f];
}

static inline uint32_t solve_corner(const solve_mesh *mesh, size_t f, size_t i)
{
    return mesh->of.facet_node[mesh->of.facet_start[f] + i];
}

/* 1 where the cell is the facet's first one, -1 where it is the second. */
static inline double solve_side(const solve_mesh *mesh, size_t f, size_t c)
{
    return mesh->of.side[f][0] == c ? 1 : -1;
}

#endif
