/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of random solids as polyhedra: that nodes are found at the points of octants,
 * and that joining moves nothing on the surface and makes nothing worse. */
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/octree/layer/octree_mesh_stream.h"
#include "../../lib/poly/octant/join_octants.h"
#include "../../lib/poly/octant/octant_faces.h"
#include "../../lib/poly/octant/octant_points.h"
#include "octree_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 20 };

typedef struct {
    tm_surface surface;
    tm_octree octree;
    tm_octree_mesh mesh;
} solid;

/* false: no leaf is inside. */
static bool make_solid(solid *s)
{
    tm_error error;
    make_random_surface(&s->surface);
    const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = 2 + random_below(3)};
    assert_ok(tm_octree_build(&s->octree, &s->surface, &rule, 1, &error), &error);
    const tm_status status =
        tm_octree_mesh_make(&s->mesh, &s->octree, &s->surface, NULL, &error);
    assert_true(status == TM_OK || status == TM_ERROR_INPUT);
    return status == TM_OK;
}

static void free_solid(solid *s)
{
    tm_octree_mesh_free(&s->mesh);
    tm_octree_free(&s->octree);
    tm_surface_free(&s->surface);
}

static size_t part_of(const solid *s, size_t leaf)
{
    return tm_interior_part_of(s->mesh.part, s->mesh.parts, leaf);
}

/* The points of octants against those that the mesh was made from, which it keeps: core
 * nodes are as the octree's leaves have them. */
static size_t check_points(const solid *s, const tm_stream *stream,
                           uint32_t (*core)[TM_LEAF_NODES])
{
    tm_error error;
    tm_octant_points points;
    size_t found = 0;
    assert_ok(tm_octant_points_make(&points, tm_stream_find(stream, ".mix"),
                                    tm_stream_find(stream, ".octant"),
                                    tm_stream_find(stream, ".root"), &error),
              &error);
    for (size_t l = 0; l < s->octree.leaves; l++) {
        uint32_t node[TM_OCTANT_POINTS];
        assert_int_equal(tm_octant_is_filled(&points, l), part_of(s, l) < s->mesh.parts);
        if (!tm_octant_is_filled(&points, l) || !tm_octant_points_find(&points, l, node))
            continue;
        found++;
        for (int p = 0; p < TM_LEAF_NODES; p++)
            if (node[p] != TM_NONE)
                assert_int_equal(node[p], core[l][p]);
    }
    tm_octant_points_free(&points);
    return found;
}

/* The nodes of the mesh at the points of leaves. */
static uint32_t (*find_core(const solid *s))[TM_LEAF_NODES]
{
    uint32_t(*core)[TM_LEAF_NODES] = malloc((s->octree.leaves + 1) * sizeof *core);
    assert_non_null(core);
    for (size_t l = 0; l < s->octree.leaves; l++)
        for (int p = 0; p < TM_LEAF_NODES; p++) {
            const uint32_t node = s->octree.node[l][p];
            const size_t part = part_of(s, l);
            core[l][p] = node == TM_NONE || part == s->mesh.parts
                             ? TM_NONE
                             : s->mesh.assembly.core_node[part][node];
        }
    return core;
}

/* The corners of an octant that are around point p of it, in the order of their bits. */
static int corners_around(int p, const uint32_t *node, uint32_t around[4])
{
    int count = 0;
    for (int c = 0; c < TM_LEAF_EDGE; c++) {
        bool is = true;
        for (int i = 0; i < 3; i++)
            is = is &&
                 (tm_leaf_point[p][i] == 1 || tm_leaf_point[p][i] == tm_leaf_point[c][i]);
        if (is)
            around[count++] = node[c];
    }
    return count;
}

/* Middles of edges are there; those of faces outside of the plane through the middle of
 * the corners by what makes the facets around them convex, but for rounding. */
static void check_level(const uint32_t *node, double (*xyz)[3])
{
    double centre[3] = {0};
    for (int c = 0; c < TM_LEAF_EDGE; c++)
        for (int i = 0; i < 3; i++)
            centre[i] += xyz[node[c]][i] / TM_LEAF_EDGE;
    for (int p = TM_LEAF_EDGE; p < TM_LEAF_NODES; p++) {
        uint32_t n[4];
        double mean[3] = {0}, along[3], across[3], normal[3], outward[3], saddle[3];
        if (node[p] == TM_NONE)
            continue;
        const int count = corners_around(p, node, n);
        for (int k = 0; k < count; k++)
            for (int i = 0; i < 3; i++)
                mean[i] += xyz[n[k]][i] / count;
        double off[3];
        tm_subtract(off, xyz[node[p]], mean);
        if (count == 2) {
            assert_true(tm_norm(off) <= 1e-12 * (1 + tm_norm(mean)));
            continue;
        }
        tm_subtract(along, xyz[n[3]], xyz[n[0]]);
        tm_subtract(across, xyz[n[2]], xyz[n[1]]);
        tm_cross(normal, along, across);
        tm_subtract(outward, mean, centre);
        const double sign = tm_dot(normal, outward) < 0 ? -1 : 1;
        for (int i = 0; i < 3; i++)
            saddle[i] = (xyz[n[0]][i] + xyz[n[3]][i] - xyz[n[1]][i] - xyz[n[2]][i]) / 4;
        assert_true(sign * tm_dot(off, normal) >=
                    fabs(tm_dot(saddle, normal)) - 1e-12 * tm_norm(normal));
    }
}

/* Where no node is held. */
static void check_faces_level(const tm_stream *stream)
{
    tm_error error;
    tm_octant_points points;
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *octant = tm_stream_find(stream, ".octant");
    double(*xyz)[3] = malloc((node->count + 1) * sizeof *xyz);
    bool *outer = calloc(node->count + 1, sizeof *outer);
    size_t moved;
    assert_true(xyz && outer);
    memcpy(xyz, node->real, node->count * sizeof *xyz);
    assert_ok(tm_octant_points_make(&points, tm_stream_find(stream, ".mix"), octant,
                                    tm_stream_find(stream, ".root"), &error),
              &error);
    assert_ok(tm_octant_faces_level(&points, xyz, node->count, outer, &moved, &error),
              &error);
    for (size_t o = 0; o < octant->count; o++) {
        uint32_t at[TM_OCTANT_POINTS];
        if (tm_octant_is_filled(&points, o) && tm_octant_points_find(&points, o, at))
            check_level(at, xyz);
    }
    tm_octant_points_free(&points);
    free(outer);
    free(xyz);
}

static void check_joined(const tm_stream *stream, const tm_octant_join *join,
                         const double (*before)[3])
{
    tm_error error;
    tm_examination found;
    const tm_poly_arrays poly = tm_poly_arrays_of(stream);
    assert_ok(tm_poly_examine(&found, &poly, 1, &error), &error);
    assert_true(tm_examination_is_good(&found));
    assert_int_equal(poly.cells, join->polyhedra);
    assert_true(join->polyhedra <= join->elements);
    for (int k = 0; k < TM_FIT_FAULTS; k++)
        assert_true(join->fit.after[k] <= join->fit.before[k]);
    for (size_t f = 0; f < poly.facets; f++)
        for (size_t i = poly.facet_start[f]; i < poly.facet_start[f + 1]; i++) {
            const uint32_t v = poly.facet_node[i];
            if (poly.side[f][1] == TM_NONE)
                assert_memory_equal(poly.xyz[v], before[v], sizeof *before);
        }
}

static void random_solids(void **state)
{
    (void)state;
    size_t found = 0, filled = 0, levelled = 0, before_fit = 0, faults_left = 0;
    for (int round = 0; round < ROUNDS; round++) {
        solid s = {0};
        tm_stream stream;
        tm_error error;
        tm_octant_join join;
        if (!make_solid(&s)) {
            free_solid(&s);
            continue;
        }
        tm_stream_init(&stream);
        uint32_t(*core)[TM_LEAF_NODES] = find_core(&s);
        assert_ok(tm_octree_mesh_to_stream(&s.mesh, &s.octree, &s.surface, false, &stream,
                                           &error),
                  &error);
        found += check_points(&s, &stream, core);
        check_faces_level(&stream);
        for (size_t l = 0; l < s.octree.leaves; l++)
            filled += part_of(&s, l) < s.mesh.parts;
        const tm_block *node = tm_stream_find(&stream, ".node");
        double(*before)[3] = malloc((node->count + 1) * sizeof *before);
        assert_non_null(before);
        memcpy(before, node->real, node->count * sizeof *before);
        assert_ok(tm_join_octants(&stream, &join, &error), &error);
        check_joined(&stream, &join, (const double(*)[3])before);
        levelled += join.levelled;
        for (int k = 0; k < TM_FIT_FAULTS; k++)
            before_fit += join.fit.before[k];
        faults_left += tm_fit_faults_left(&join.fit);
        free(before);
        free(core);
        tm_stream_free(&stream);
        free_solid(&s);
    }
    assert_true(levelled > 0);
    assert_true(before_fit == 0 || 2 * faults_left < before_fit);
    /* Those with a cut face are not found. */
    assert_true(10 * found > 7 * filled);
    assert_true(found < filled);
}

/* An attribute that is no place of the first node says of none where it is: inner nodes
 * move as without it. */
static void other_attribute(void **state)
{
    (void)state;
    size_t levelled = 0;
    for (int round = 0; round < ROUNDS; round++) {
        solid s = {0};
        tm_stream stream;
        tm_error error;
        tm_octant_join join;
        if (make_solid(&s)) {
            tm_stream_init(&stream);
            assert_ok(tm_octree_mesh_to_stream(&s.mesh, &s.octree, &s.surface, false,
                                               &stream, &error),
                      &error);
            tm_block *node = tm_stream_find(&stream, ".node");
            assert_int_equal(node->attributes, 1);
            for (size_t v = 0; v < node->count; v++)
                node->attribute[v] = v == 0 ? 0.5 : 3;
            assert_ok(tm_join_octants(&stream, &join, &error), &error);
            levelled += join.levelled;
            tm_stream_free(&stream);
        }
        free_solid(&s);
    }
    assert_true(levelled > 0);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_solids),
                                       cmocka_unit_test(other_attribute)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
