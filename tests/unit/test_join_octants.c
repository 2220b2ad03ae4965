/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of random solids as polyhedra: that nodes are found at the points of octants,
 * and that joining moves nothing on the surface and makes nothing worse. */
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/octree/layer/octree_mesh_stream.h"
#include "../../lib/poly/octant/join_octants.h"
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

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(random_solids)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
