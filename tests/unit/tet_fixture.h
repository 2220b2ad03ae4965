/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small random meshes for the tests of lib/tet, and what no operation may change: volume
 * of each region, area under each marker, length under each edge marker, the Euler
 * number. */
#ifndef TESTS_UNIT_TET_FIXTURE_H
#define TESTS_UNIT_TET_FIXTURE_H

#include "../../lib/geom/predicates.h"
#include "../../lib/geom/vector.h"
#include "../../lib/stream/stream.h"
#include "../../lib/tet/mesh.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { FIXTURE_MARKERS = 8, FIXTURE_REGIONS = 3 };

/* The six tetrahedra of a cube whose corners are numbered by the bits x y z: one for each
 * order of the axes (Kuhn, Freudenthal). Neighbouring cubes agree. */
static const int cube_tet[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

static inline uint32_t grid_node(int n, int x, int y, int z)
{
    return (uint32_t)((z * (n + 1) + y) * (n + 1) + x);
}

static inline bool all_positive(const tm_block *node, const tm_block *ele)
{
    const double(*xyz)[3] = (const double(*)[3])node->real;
    for (size_t t = 0; t < ele->count; t++) {
        const uint32_t *n = ele->integer + 4 * t;
        if (tm_orient3d(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]) <= 0)
            return false;
    }
    return true;
}

/* Moves inner nodes of the grid by up to `by` cells each along the first axes, where all
 * stays positive. */
static inline void shake(tm_block *node, const tm_block *ele, int n, double by, int axes)
{
    for (int z = 1; z < n; z++)
        for (int y = 1; y < n; y++)
            for (int x = 1; x < n; x++) {
                double *p = node->real + 3 * grid_node(n, x, y, z), old[3];
                memcpy(old, p, sizeof old);
                for (int k = 0; k < axes; k++)
                    p[k] += by * (2 * random_unit() - 1);
                if (!all_positive(node, ele))
                    memcpy(p, old, sizeof old);
            }
}

/* Which side of the cube all three nodes are on, 1…6; 0 inside. */
static inline int32_t side_of(const tm_block *node, const uint32_t v[3], int n)
{
    for (int k = 0; k < 3; k++)
        for (int s = 0; s < 2; s++) {
            int on = 0;
            for (int i = 0; i < 3; i++)
                on += node->real[3 * v[i] + (size_t)k] == (s ? n : 0);
            if (on == 3)
                return 1 + 2 * k + s;
        }
    return 0;
}

/* The boundary faces, each with its side's marker, and some inner ones without. */
static inline void add_faces(tm_stream *stream, int n)
{
    tm_block *face = tm_stream_add(stream, ".face");
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    static const int corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    face->markers = true;
    assert_int_equal(tm_block_allocate(face, 12 * (size_t)(n * n), 0, NULL), TM_OK);
    size_t row = 0;
    for (size_t t = 0; t < ele->count; t++)
        for (int f = 0; f < 4; f++) {
            uint32_t v[3];
            for (int i = 0; i < 3; i++)
                v[i] = ele->integer[4 * t + (size_t)corner[f][i]];
            int32_t side = side_of(node, v, n);
            if (side == 0)
                continue;
            memcpy(face->integer + 3 * row, v, sizeof v);
            face->marker[row++] = side;
        }
    assert_int_equal(row, face->count);
}

/* A cube of n³ cells in a stream: shaken inner nodes, node attribute x + 2y - z, node
 * markers, regions by z (if regions), marked sides, a marked edge inside and one on the
 * boundary. */
static inline void make_grid(tm_stream *stream, int n, double by, bool regions)
{
    tm_stream_init(stream);
    size_t nodes = (size_t)((n + 1) * (n + 1) * (n + 1));
    tm_stream_add(stream, ".node");
    tm_stream_add(stream, ".ele");
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *ele = tm_stream_find(stream, ".ele");
    node->markers = true;
    node->attributes = 1;
    ele->attributes = regions;
    assert_int_equal(tm_block_allocate(node, nodes, 0, NULL), TM_OK);
    assert_int_equal(tm_block_allocate(ele, 6 * (size_t)(n * n * n), 0, NULL), TM_OK);
    for (int z = 0; z <= n; z++)
        for (int y = 0; y <= n; y++)
            for (int x = 0; x <= n; x++) {
                double *p = node->real + 3 * grid_node(n, x, y, z);
                p[0] = x, p[1] = y, p[2] = z;
            }
    size_t t = 0;
    for (int z = 0; z < n; z++)
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++)
                for (int k = 0; k < 6; k++, t++) {
                    for (int i = 0; i < 4; i++) {
                        int c = cube_tet[k][i];
                        ele->integer[4 * t + (size_t)i] =
                            grid_node(n, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2 & 1));
                    }
                    if (regions)
                        ele->attribute[t] = 1 + z % FIXTURE_REGIONS;
                }
    assert_true(all_positive(node, ele));
    shake(node, ele, n, by, regions ? 2 : 3); /* the regions stay flat */
    for (size_t v = 0; v < nodes; v++) {
        const double *p = node->real + 3 * v;
        node->attribute[v] = p[0] + 2 * p[1] - p[2];
    }
    add_faces(stream, n);
    tm_block *edge = tm_stream_add(stream, ".edge");
    edge->markers = true;
    assert_int_equal(tm_block_allocate(edge, 3, 0, NULL), TM_OK);
    uint32_t ends[3][2] = {
        {grid_node(n, 0, 0, 0), grid_node(n, 1, 0, 0)},      /* on the boundary */
        {grid_node(n, 1, 1, 0), grid_node(n, 1, 1, 1)},      /* inside */
        {grid_node(n, 0, 0, n - 1), grid_node(n, 1, 1, n)}}; /* without a marker */
    memcpy(edge->integer, ends, sizeof ends);
    edge->marker[0] = 5;
    edge->marker[1] = 6;
    edge->marker[2] = 0;
}

typedef struct {
    double volume[FIXTURE_REGIONS + 1]; /* by region; [0] without regions */
    double area[FIXTURE_MARKERS];
    double length[FIXTURE_MARKERS]; /* of marked edges */
    long euler_boundary;            /* V - E + F of the boundary */
    double worst_attribute;         /* how far an attribute is from x + 2y - z */
} invariants;

static inline void measure_faces(const tm_tet_mesh *mesh, invariants *i)
{
    tm_edge_map edges = {0};
    uint8_t *on = calloc(mesh->nodes + 1, 1);
    assert_non_null(on);
    assert_true(tm_edge_map_reserve(&edges, 3 * mesh->faces));
    for (size_t f = 0; f < mesh->faces; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (face->side[0] == TM_NONE && face->side[1] == TM_NONE)
            continue; /* removed */
        if (face->marker >= 0 && face->marker < FIXTURE_MARKERS)
            i->area[face->marker] +=
                tm_triangle_area(mesh->xyz[face->node[0]], mesh->xyz[face->node[1]],
                                 mesh->xyz[face->node[2]]);
        if (face->side[0] != TM_NONE && face->side[1] != TM_NONE)
            continue;
        i->euler_boundary++;
        for (int k = 0; k < 3; k++) {
            tm_edge_map_put(&edges, face->node[k], face->node[(k + 1) % 3], 0);
            i->euler_boundary += on[face->node[k]] == 0;
            on[face->node[k]] = 1;
        }
    }
    i->euler_boundary -= (long)edges.count;
    tm_edge_map_free(&edges);
    free(on);
}

static inline invariants measure_invariants(const tm_tet_mesh *mesh)
{
    invariants i = {0};
    for (uint32_t t = 0; t < mesh->slots; t++) {
        if (!tm_tet_lives(mesh, t))
            continue;
        const uint32_t *n = mesh->tet[t];
        size_t region = mesh->regions ? (size_t)mesh->region[t * mesh->regions] : 0;
        i.volume[region] += tm_tet_volume(mesh->xyz[n[0]], mesh->xyz[n[1]],
                                          mesh->xyz[n[2]], mesh->xyz[n[3]]);
    }
    measure_faces(mesh, &i);
    for (size_t e = 0; e < mesh->edges; e++)
        if (!mesh->edge[e].gone)
            i.length[mesh->edge[e].marker] += sqrt(tm_distance2(
                mesh->xyz[mesh->edge[e].node[0]], mesh->xyz[mesh->edge[e].node[1]]));
    for (uint32_t v = 0; v < mesh->nodes && mesh->node_attributes; v++) {
        const double *p = mesh->xyz[v];
        if (!tm_node_lives(mesh, v))
            continue;
        i.worst_attribute = fmax(
            i.worst_attribute, fabs(mesh->node_attribute[v] - (p[0] + 2 * p[1] - p[2])));
    }
    return i;
}

static inline void assert_same(double a, double b)
{
    assert_true(fabs(a - b) <= 1e-11 * (1 + fabs(a)));
}

/* An edge without a marker may go; all else stays. */
static inline void assert_same_invariants(const invariants *a, const invariants *b)
{
    for (int r = 0; r <= FIXTURE_REGIONS; r++)
        assert_same(a->volume[r], b->volume[r]);
    for (int m = 0; m < FIXTURE_MARKERS; m++) {
        assert_same(a->area[m], b->area[m]);
        if (m > 0)
            assert_same(a->length[m], b->length[m]);
    }
    assert_int_equal(a->euler_boundary, b->euler_boundary);
    assert_true(b->worst_attribute < 1e-10);
}

static inline void assert_valid(const tm_tet_mesh *mesh)
{
    tm_error error = {0};
    if (tm_tet_mesh_check(mesh, &error) != TM_OK)
        fail_msg("%s", error.what);
}

/* The grid as a mesh. */
static inline void make_mesh(tm_tet_mesh *mesh, tm_stream *stream, int n, double by,
                             bool regions)
{
    tm_error error = {0};
    make_grid(stream, n, by, regions);
    if (tm_tet_mesh_from_stream(mesh, stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_valid(mesh);
}

#endif
