/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra made of unit cubes: the cubes of a block that have the same label are one
 * cell, whose facets are the squares between them and cubes of other labels. */
#ifndef TESTS_UNIT_VOXELS_H
#define TESTS_UNIT_VOXELS_H

#include "../../lib/mesh/poly_arrays.h"

#include <stdlib.h>
#include <string.h>

enum { NO_CELL = -1 };

typedef struct voxels {
    int size[3];
    int *label; /* [size[0] size[1] size[2]]: x fastest; NO_CELL: nothing */
    int cells;
    tm_poly_arrays mesh; /* after voxels_join() */
    double (*xyz)[3];
    uint32_t (*side)[2];
    size_t *facet_start;
    uint32_t *facet_node;
    size_t *cell_start;
    uint32_t *cell_facet;
    double *attribute; /* the cubes of each cell, times 6 */
} voxels;

static inline voxels voxels_new(int x, int y, int z)
{
    voxels v = {.size = {x, y, z}};
    v.label = malloc((size_t)(x * y * z) * sizeof *v.label);
    for (int i = 0; i < x * y * z; i++)
        v.label[i] = NO_CELL;
    return v;
}

static inline int *voxel_at(const voxels *v, int x, int y, int z)
{
    return &v->label[x + v->size[0] * (y + v->size[1] * z)];
}

/* From a picture of layers of rows of digits, the labels; other letters are nothing. */
static inline voxels voxels_of(int x, int y, int z, const char *picture)
{
    voxels v = voxels_new(x, y, z);
    for (int i = 0; i < x * y * z; i++)
        v.label[i] = picture[i] >= '0' && picture[i] <= '9' ? picture[i] - '0' : NO_CELL;
    return v;
}

static inline int voxel_label(const voxels *v, const int p[3])
{
    for (int k = 0; k < 3; k++)
        if (p[k] < 0 || p[k] >= v->size[k])
            return NO_CELL;
    return *voxel_at(v, p[0], p[1], p[2]);
}

static inline uint32_t voxel_node(const voxels *v, const int p[3])
{
    return (uint32_t)(p[0] + (v->size[0] + 1) * (p[1] + (v->size[1] + 1) * p[2]));
}

/* The square below the cube at p, across the axis, if it is between two labels. */
static inline void voxels_add_facet(voxels *v, const int p[3], int axis)
{
    int below[3] = {p[0], p[1], p[2]}, q[3] = {p[0], p[1], p[2]};
    below[axis]--;
    const int a = voxel_label(v, below), b = voxel_label(v, p);
    if (a == b)
        return;
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    uint32_t node[4];
    node[0] = voxel_node(v, q);
    q[u]++;
    node[1] = voxel_node(v, q);
    q[w]++;
    node[2] = voxel_node(v, q);
    q[u]--;
    node[3] = voxel_node(v, q);
    const size_t f = v->mesh.facets++;
    v->side[f][0] = (uint32_t)(a == NO_CELL ? b : a);
    v->side[f][1] = a == NO_CELL || b == NO_CELL ? TM_NONE : (uint32_t)b;
    for (size_t i = 0; i < 4; i++)
        v->facet_node[4 * f + i] = node[a == NO_CELL ? 3 - i : i];
    v->facet_start[f + 1] = 4 * (f + 1);
}

static inline void voxels_add_nodes(voxels *v)
{
    int p[3];
    for (p[2] = 0; p[2] <= v->size[2]; p[2]++)
        for (p[1] = 0; p[1] <= v->size[1]; p[1]++)
            for (p[0] = 0; p[0] <= v->size[0]; p[0]++)
                for (int k = 0; k < 3; k++)
                    v->xyz[voxel_node(v, p)][k] = p[k];
}

static inline void voxels_add_cells(voxels *v)
{
    size_t next = 0;
    for (size_t c = 0; c < v->mesh.cells; c++) {
        for (size_t f = 0; f < v->mesh.facets; f++)
            if (v->side[f][0] == c || v->side[f][1] == c)
                v->cell_facet[next++] = (uint32_t)f;
        v->cell_start[c + 1] = next;
    }
}

/* Makes the mesh. Labels are 0 … without a gap. */
static inline void voxels_join(voxels *v)
{
    const int cubes = v->size[0] * v->size[1] * v->size[2];
    const size_t nodes = (size_t)((v->size[0] + 1) * (v->size[1] + 1) * (v->size[2] + 1));
    const size_t most = 3 * nodes;
    for (int i = 0; i < cubes; i++)
        v->cells = v->label[i] >= v->cells ? v->label[i] + 1 : v->cells;
    v->xyz = malloc(nodes * sizeof *v->xyz);
    v->side = malloc(most * sizeof *v->side);
    v->facet_start = calloc(most + 1, sizeof *v->facet_start);
    v->facet_node = malloc(4 * most * sizeof *v->facet_node);
    v->cell_start = calloc((size_t)v->cells + 1, sizeof *v->cell_start);
    v->cell_facet = malloc(2 * most * sizeof *v->cell_facet);
    v->attribute = calloc((size_t)v->cells + 1, sizeof *v->attribute);
    v->mesh = (tm_poly_arrays){.nodes = nodes, .cells = (size_t)v->cells};
    voxels_add_nodes(v);
    int p[3];
    for (p[2] = 0; p[2] <= v->size[2]; p[2]++)
        for (p[1] = 0; p[1] <= v->size[1]; p[1]++)
            for (p[0] = 0; p[0] <= v->size[0]; p[0]++)
                for (int axis = 0; axis < 3; axis++)
                    voxels_add_facet(v, p, axis);
    voxels_add_cells(v);
    for (int i = 0; i < cubes; i++)
        if (v->label[i] != NO_CELL)
            v->attribute[v->label[i]] += 6;
    v->mesh.xyz = (const double(*)[3])v->xyz;
    v->mesh.side = (const uint32_t(*)[2])v->side;
    v->mesh.facet_start = v->facet_start;
    v->mesh.facet_node = v->facet_node;
    v->mesh.cell_start = v->cell_start;
    v->mesh.cell_facet = v->cell_facet;
    v->mesh.attributes = 1;
    v->mesh.attribute = v->attribute;
}

static inline void voxels_free(voxels *v)
{
    free(v->label);
    free(v->xyz);
    free(v->side);
    free(v->facet_start);
    free(v->facet_node);
    free(v->cell_start);
    free(v->cell_facet);
    free(v->attribute);
}

#endif
