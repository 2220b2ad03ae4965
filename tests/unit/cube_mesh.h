/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of cubes, each cut into six tetrahedra along the same diagonal, so that they
 * fit (Kuhn's triangulation). The cubes lie in a box; any of them may be missing. */
#ifndef TESTS_UNIT_CUBE_MESH_H
#define TESTS_UNIT_CUBE_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

typedef struct cube_mesh {
    unsigned size[3]; /* cubes along x, y, z */
    bool *present;    /* [cubes of the box], x fastest */
    size_t nodes;
    double (*xyz)[3]; /* all corners of the box, at whole numbers */
    size_t tets;
    uint32_t (*tet)[4];
} cube_mesh;

enum { CUBE_TETS = 6 };

static inline size_t cube_mesh_cubes(const cube_mesh *m)
{
    return (size_t)m->size[0] * m->size[1] * m->size[2];
}

static inline uint32_t cube_mesh_node(const cube_mesh *m, const unsigned at[3])
{
    return at[0] + (m->size[0] + 1) * (at[1] + (m->size[1] + 1) * at[2]);
}

/* A box with all cubes present; cube_mesh_cut() makes the tetrahedra. */
static inline cube_mesh cube_mesh_box(unsigned x, unsigned y, unsigned z)
{
    cube_mesh m = {.size = {x, y, z}};
    m.present = malloc(cube_mesh_cubes(&m));
    memset(m.present, true, cube_mesh_cubes(&m));
    m.nodes = (size_t)(x + 1) * (y + 1) * (z + 1);
    m.xyz = malloc(m.nodes * sizeof *m.xyz);
    m.tet = malloc((size_t)CUBE_TETS * cube_mesh_cubes(&m) * sizeof *m.tet);
    unsigned at[3];
    for (at[2] = 0; at[2] <= z; at[2]++)
        for (at[1] = 0; at[1] <= y; at[1]++)
            for (at[0] = 0; at[0] <= x; at[0]++)
                for (size_t i = 0; i < 3; i++)
                    m.xyz[cube_mesh_node(&m, at)][i] = at[i];
    return m;
}

static inline void cube_mesh_free(cube_mesh *m)
{
    free(m->present);
    free(m->xyz);
    free(m->tet);
}

/* Cuts one cube: each path along three edges from its lowest corner to the highest one
 * gives a tetrahedron. */
static inline void cube_mesh_cut_one(cube_mesh *m, const unsigned lowest[3])
{
    static const unsigned path[CUBE_TETS][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                                {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
    for (size_t p = 0; p < CUBE_TETS; p++) {
        unsigned at[3] = {lowest[0], lowest[1], lowest[2]};
        uint32_t *n = m->tet[m->tets++];
        n[0] = cube_mesh_node(m, at);
        for (size_t i = 0; i < 3; i++) {
            at[path[p][i]]++;
            n[i + 1] = cube_mesh_node(m, at);
        }
        if (p >= CUBE_TETS / 2) { /* an odd permutation of the axes */
            const uint32_t third = n[2];
            n[2] = n[3];
            n[3] = third;
        }
    }
}

static inline bool cube_mesh_has(const cube_mesh *m, const unsigned at[3])
{
    for (size_t i = 0; i < 3; i++)
        if (at[i] >= m->size[i])
            return false;
    return m->present[at[0] + m->size[0] * (at[1] + (size_t)m->size[1] * at[2])];
}

static inline void cube_mesh_cut(cube_mesh *m)
{
    unsigned at[3];
    m->tets = 0;
    for (at[2] = 0; at[2] < m->size[2]; at[2]++)
        for (at[1] = 0; at[1] < m->size[1]; at[1]++)
            for (at[0] = 0; at[0] < m->size[0]; at[0]++)
                if (cube_mesh_has(m, at))
                    cube_mesh_cut_one(m, at);
}

/* Whether one of the cubes that have the corner `at` and those with the offsets of
 * `along` beside it is present: along is the direction of an edge or square's own
 * extent, which the cubes share. */
static inline bool cube_mesh_touches(const cube_mesh *m, const unsigned at[3],
                                     const unsigned along[3])
{
    for (unsigned corner = 0; corner < 8; corner++) {
        unsigned cube[3];
        bool possible = true;
        for (size_t i = 0; i < 3; i++) {
            const unsigned back = corner >> i & 1;
            possible = possible && !(along[i] && back) && at[i] >= back;
            cube[i] = at[i] - back;
        }
        if (possible && cube_mesh_has(m, cube))
            return true;
    }
    return false;
}

/* The Euler number of the cubes: points - edges + squares - cubes. */
static inline int cube_mesh_euler(const cube_mesh *m)
{
    int euler = 0;
    unsigned at[3];
    for (at[2] = 0; at[2] <= m->size[2]; at[2]++)
        for (at[1] = 0; at[1] <= m->size[1]; at[1]++)
            for (at[0] = 0; at[0] <= m->size[0]; at[0]++)
                for (unsigned extent = 0; extent < 8; extent++) {
                    const unsigned along[3] = {extent & 1, extent >> 1 & 1, extent >> 2};
                    const bool odd = (along[0] + along[1] + along[2]) % 2;
                    if (cube_mesh_touches(m, at, along))
                        euler += odd ? -1 : 1;
                }
    return euler;
}

/* How many squares have a cube on one side only. */
static inline size_t cube_mesh_exposed(const cube_mesh *m)
{
    size_t exposed = 0;
    unsigned at[3];
    for (at[2] = 0; at[2] < m->size[2]; at[2]++)
        for (at[1] = 0; at[1] < m->size[1]; at[1]++)
            for (at[0] = 0; at[0] < m->size[0]; at[0]++)
                for (size_t i = 0; i < 3 && cube_mesh_has(m, at); i++) {
                    unsigned beside[3] = {at[0], at[1], at[2]};
                    beside[i]++;
                    exposed += !cube_mesh_has(m, beside);
                    beside[i] -= 2; /* wraps to what is outside */
                    exposed += !cube_mesh_has(m, beside);
                }
    return exposed;
}

#endif
