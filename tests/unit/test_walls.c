/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions that touch, of random cubes of a block: their walls, the leaves of each, and
 * the elements, which fit together where regions meet. */
#include "../../lib/element/jens.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/examine/mixed_volume.h"
#include "../../lib/octree/interior/region_layout.h"
#include "../../lib/octree/interior/region_leaves.h"
#include "../../lib/octree/interior/node_lattice.h"
#include "../../lib/octree/interior/wall_refinement.h"
#include "../../lib/octree/interior/wall_sectors.h"
#include "../../lib/octree/layer/adaptive_refinement.h"
#include "../../lib/octree/layer/octree_mesh_parts.h"
#include "octree_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { SIDE = 3, CUBES = SIDE * SIDE * SIDE, OCTANTS = 8, ROUNDS = 15 };

/* The label of a cube; 0 beyond the block. */
static unsigned label_at(const unsigned *label, const int at[3])
{
    for (int i = 0; i < 3; i++)
        if (at[i] < 0 || at[i] >= SIDE)
            return 0;
    return label[at[0] + SIDE * (at[1] + SIDE * at[2])];
}

/* The square between a cube and the next one below it along an axis, from any side. */
static void add_wall(tm_polygon_surface *p, const int at[3], int axis)
{
    static const int ring[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const uint32_t turned = random_below(4), back = random_below(2);
    uint32_t node[4];
    for (uint32_t c = 0; c < 4; c++) {
        const int *corner = ring[(back ? 7 - c - turned : c + turned) % 4];
        int q[3] = {at[0], at[1], at[2]};
        q[(axis + 1) % 3] += corner[0];
        q[(axis + 2) % 3] += corner[1];
        node[c] = add_node(p, q[0], q[1], q[2]);
    }
    add_polygon(p, node, 4);
}

static void add_walls(tm_polygon_surface *p, const unsigned *label)
{
    for (int i = 0; i < (SIDE + 1) * (SIDE + 1) * (SIDE + 1); i++)
        for (int axis = 0; axis < 3; axis++) {
            const int at[3] = {i % (SIDE + 1), i / (SIDE + 1) % (SIDE + 1),
                               i / (SIDE + 1) / (SIDE + 1)};
            int below[3] = {at[0], at[1], at[2]};
            below[axis]--;
            if (label_at(label, at) == label_at(label, below))
                continue;
            add_wall(p, at, axis);
            if (random_below(4) == 0) /* each region has its own */
                add_wall(p, at, axis);
        }
}

/* Fills group[cube] with one of its cubes: those that faces join have the same. */
static void find_groups(const unsigned *label, int *group)
{
    for (int i = 0; i < CUBES; i++)
        group[i] = i;
    for (int sweep = 0; sweep < CUBES; sweep++)
        for (int i = 0; i < CUBES; i++)
            for (int side = 0; side < 6; side++) {
                static const int step[3] = {1, SIDE, SIDE * SIDE};
                int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
                at[side / 2] += side % 2 ? 1 : -1;
                const int next = i + (side % 2 ? 1 : -1) * step[side / 2];
                if (at[side / 2] < 0 || at[side / 2] >= SIDE || label[next] != label[i])
                    continue;
                if (group[next] < group[i])
                    group[i] = group[next];
            }
}

/* Whether a group of empty cubes is closed in. */
static bool is_closed_in(const int *group, int which)
{
    for (int i = 0; i < CUBES; i++)
        if (group[i] == which &&
            (i % SIDE != 1 || i / SIDE % SIDE != 1 || i / SIDE / SIDE != 1))
            return false;
    return true;
}

/* A block of cubes of three regions, and some of none, with walls; turned or not. Some
 * have no edge at which three walls meet: then another one is made. */
static void make_surface(tm_surface *surface, unsigned *label, tm_polygon_surface *p)
{
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    tm_error error;
    bool walls = false;
    while (!walls) {
        for (int i = 0; i < CUBES; i++)
            label[i] = random_below(4);
        label[0] = 1;
        label[1] = 2;
        tm_polygon_surface_init(p);
        add_walls(p, label);
        assert_ok(tm_surface_build(surface, p, &options, &error), &error);
        assert_ok(tm_surface_check(surface, &error), &error);
        walls = surface->walls;
        if (!walls) {
            tm_surface_free(surface);
            tm_polygon_surface_free(p);
        }
    }
}

static void test_regions(void **state)
{
    (void)state;
    for (int round = 0; round < ROUNDS; round++) {
        unsigned label[CUBES];
        int group[CUBES];
        size_t regions = 0;
        tm_polygon_surface p;
        tm_surface surface;
        make_surface(&surface, label, &p);
        find_groups(label, group);
        uint32_t region[CUBES];
        for (int i = 0; i < CUBES; i++) {
            const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
            const double centre[3] = {at[0] + 0.5, at[1] + 0.5, at[2] + 0.5};
            region[i] = tm_surface_region_at(&surface, centre);
            const bool is = label[i] != 0 || is_closed_in(group, group[i]);
            assert_int_equal(region[i] != 0, is);
            regions += is && group[i] == i;
            assert_int_equal(tm_surface_has_mesh(&surface, centre), is);
            for (int k = 0; k < i && is; k++)
                assert_int_equal(region[k] == region[i], group[k] == group[i]);
        }
        assert_int_equal(surface.cells, regions);
        const double far[3] = {-1, -1, -1}, beside[3] = {-0.001, 0.5, 0.5};
        assert_int_equal(tm_surface_region_at(&surface, far), 0);
        assert_int_equal(tm_surface_region_at(&surface, beside), 0);
        tm_surface_free(&surface);
        tm_polygon_surface_free(&p);
    }
}

/* The octants around each node: of each region they are a good mask, and in each part of
 * one region at most. */
static void check_parts(const tm_octree *octree, const tm_interior *part, size_t parts)
{
    for (size_t n = 0; n < octree->nodes; n++) {
        const uint32_t *octant = part->octant[n];
        unsigned of_part[CUBES] = {0}; /* there are no more regions, nor parts */
        for (unsigned o = 0; o < OCTANTS; o++) {
            unsigned mask = 0;
            for (unsigned i = 0; i < OCTANTS; i++)
                mask |= (unsigned)(octant[i] == octant[o]) << i;
            assert_true(tm_octant_mask_is_good((tm_octant_mask)mask));
            for (size_t p = 0; p < parts; p++)
                if (part[p].mask[n] >> o & 1) {
                    assert_true(octant[o] != 0 && p < CUBES);
                    assert_true(of_part[p] == 0 || of_part[p] == octant[o]);
                    of_part[p] = octant[o];
                }
        }
    }
    for (size_t l = 0; l < octree->leaves; l++)
        assert_int_equal(tm_interior_part_of(part, parts, l) < parts,
                         part->label[l] != 0);
}

/* Cuts some quadrilaterals, as the paths of curves do. */
static void cut_some(tm_interior_boundary *boundary)
{
    for (size_t f = 0; f < boundary->faces; f++)
        if (tm_boundary_face_corners(boundary, f) == 4 && random_below(8) == 0)
            boundary->cut[f] = random_below(2) ? TM_CUT_02 : TM_CUT_13;
}

/* On the lattice all elements are valid, those of each leaf fill it but for the layer,
 * all together fill what there is, and they fit together. */
static void check_elements(const tm_octree *octree, const tm_interior *part, size_t parts,
                           const tm_interior_boundary *boundary, const tm_assembly *a)
{
    const tm_mixed_mesh *mesh = &a->mesh;
    const double clearly = 0.05;
    tm_error error;
    double(*base)[3] = malloc(mesh->nodes * sizeof *base);
    assert_ok(tm_lattice_points(a, octree, part, parts, boundary, base, &error), &error);
    double volume = 0, sum = 0;
    for (size_t l = 0; l < octree->leaves; l++) {
        const double side = tm_leaf_side(octree, &octree->leaf[l]);
        volume += part->label[l] != 0 ? side * side * side : 0;
        assert_int_equal(a->first[l + 1] > a->first[l], part->label[l] != 0);
    }
    for (size_t e = 0; e < mesh->elements; e++) {
        const size_t k = mesh->start[e + 1] - mesh->start[e];
        const uint32_t *item = mesh->item + mesh->start[e];
        assert_true(tm_jens(k, (const double(*)[3])base, item) > clearly);
        sum += tm_mixed_volume((const double(*)[3])base, item, k);
    }
    assert_true(fabs(sum - volume) <= 1e-9 * volume);
    assert_elements_fit(mesh, (const double(*)[3])base);
    for (size_t f = 0; f < boundary->faces; f++)
        assert_int_equal(a->layer_across && a->layer_across[f] != TM_NONE,
                         boundary->region[f][1] != 0);
    free(base);
}

static void test_leaves(void **state)
{
    (void)state;
    size_t shared = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t seed = random_state;
        unsigned label[CUBES];
        tm_polygon_surface p;
        tm_surface surface;
        tm_octree octree;
        tm_interior *part = malloc(sizeof *part);
        tm_interior_boundary boundary;
        tm_assembly assembly;
        tm_error error;
        size_t parts = 1;
        make_surface(&surface, label, &p);
        make_random_octree(&octree, &surface);
        printf("round %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed,
               octree.leaves);
        assert_ok(tm_interior_choose(part, &octree, &surface, &error), &error);
        assert_ok(tm_interior_divide(&part, &parts, &octree, surface.cells, &error),
                  &error);
        check_parts(&octree, part, parts);
        assert_ok(tm_interior_boundary_of_parts(&boundary, &octree, part, parts, &error),
                  &error);
        cut_some(&boundary);
        assert_ok(tm_assemble(&assembly, &octree, part, parts, &boundary, &error),
                  &error);
        check_elements(&octree, part, parts, &boundary, &assembly);
        for (size_t f = 0; f < boundary.faces; f++)
            shared += boundary.region[f][1] != 0;
        tm_assembly_free(&assembly);
        tm_interior_boundary_free(&boundary);
        for (size_t i = 0; i < parts; i++)
            tm_interior_free(&part[i]);
        free(part);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
        tm_polygon_surface_free(&p);
    }
    assert_true(shared > 0);
}

/* Gives leaves the labels that their centres have, and lays corners and curves out. */
static void lay_out(tm_region_layout *layout, const uint32_t *label)
{
    tm_error error;
    for (uint32_t l = 0; l < layout->lattice.octree->leaves; l++)
        tm_interior_set_label(layout->interior, layout->lattice.octree, l, label[l]);
    assert_ok(tm_region_lay_out(layout, &error), &error);
}

/* What is laid out again, after some nodes cost more, is as if it were the first time. */
static void check_layout(const tm_octree *octree, const tm_surface *surface,
                         tm_interior *interior, const uint32_t *label)
{
    tm_region_layout layout;
    tm_error error;
    uint32_t *again = malloc(octree->leaves * sizeof *again);
    bool *taken = malloc(octree->nodes * sizeof *taken);
    float *history = calloc(octree->nodes, sizeof *history);
    assert_ok(tm_region_layout_make(&layout, octree, surface, interior, &error), &error);
    lay_out(&layout, label);
    for (size_t n = 0; n < octree->nodes; n++)
        if (layout.taken[n] && random_below(8) == 0)
            history[n] = 2;
    memcpy(layout.history, history, octree->nodes * sizeof *history);
    for (int time = 0; time < 2; time++) {
        lay_out(&layout, label);
        memcpy(again, interior->label, octree->leaves * sizeof *again);
        memcpy(taken, layout.taken, octree->nodes * sizeof *taken);
    }
    const size_t lost = layout.lost;
    tm_region_layout_free(&layout);
    assert_ok(tm_region_layout_make(&layout, octree, surface, interior, &error), &error);
    memcpy(layout.history, history, octree->nodes * sizeof *history);
    lay_out(&layout, label);
    assert_int_equal(layout.lost, lost);
    assert_memory_equal(interior->label, again, octree->leaves * sizeof *again);
    assert_memory_equal(layout.taken, taken, octree->nodes * sizeof *taken);
    tm_region_layout_free(&layout);
    free(again);
    free(taken);
    free(history);
}

static void test_layout(void **state)
{
    (void)state;
    for (int round = 0; round < ROUNDS / 3; round++) {
        const uint64_t seed = random_state;
        unsigned cube[CUBES];
        tm_polygon_surface p;
        tm_surface surface;
        tm_octree octree;
        tm_interior interior;
        tm_error error;
        make_surface(&surface, cube, &p);
        make_random_octree(&octree, &surface);
        printf("layout %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed,
               octree.leaves);
        assert_ok(tm_interior_choose(&interior, &octree, &surface, &error), &error);
        uint32_t *label = calloc(octree.leaves, sizeof *label);
        assert_non_null(label);
        for (size_t l = 0; l < octree.leaves; l++) {
            double centre[3];
            tm_leaf_centre(&octree, &octree.leaf[l], centre);
            label[l] = tm_surface_region_at(&surface, centre);
        }
        check_layout(&octree, &surface, &interior, label);
        free(label);
        tm_interior_free(&interior);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
        tm_polygon_surface_free(&p);
    }
}

/* Meshes of cubes at odd angles, too: no element is inverted, whatever comes together. */
static void test_meshes(void **state)
{
    (void)state;
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    for (int round = 0; round < ROUNDS / 5; round++) {
        const uint64_t seed = random_state;
        const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = 3};
        unsigned label[CUBES];
        tm_polygon_surface p;
        tm_surface surface;
        tm_octree octree;
        tm_octree_mesh mesh;
        tm_error error;
        make_surface(&surface, label, &p);
        tm_surface_free(&surface);
        turn_nodes(&p, random_between(0, 2));
        assert_ok(tm_surface_build(&surface, &p, &options, &error), &error);
        assert_ok(tm_surface_check(&surface, &error), &error);
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        printf("mesh %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed, octree.leaves);
        assert_ok(tm_octree_mesh_refine_lost(&mesh, &octree, &surface, 3, 0, true, NULL,
                                             &error),
                  &error);
        assert_int_equal(mesh.report.invalid, 0);
        const tm_mixed_mesh *m = &mesh.assembly.mesh;
        tm_examination found;
        const tm_mesh_view arrays = {.nodes = m->nodes,
                                     .xyz = (const double(*)[3])m->xyz,
                                     .elements = m->elements,
                                     .start = m->start,
                                     .item = m->item};
        assert_ok(tm_element_examine(&found, &arrays, 1, &error), &error);
        /* cubes that touch in a corner may both have a node there */
        found.defect[TM_DUPLICATE_NODE].count = 0;
        assert_true(tm_examination_is_good(&found));
        tm_octree_mesh_free(&mesh);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
        tm_polygon_surface_free(&p);
    }
}

/* Where leaves are larger than those that a segment runs through, or runs beside: how
 * many points of it. */
static size_t count_larger(const tm_octree *octree, const double a[3], const double b[3])
{
    enum { POINTS = 20 };
    tm_node_lattice lattice;
    tm_error error;
    size_t count = 0;
    assert_ok(tm_node_lattice_make(&lattice, octree, &error), &error);
    for (int k = 0; k <= POINTS; k++)
        for (int way = 0; way < 27; way++) {
            const int step[3] = {way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1};
            double at[3], beside[3];
            for (int i = 0; i < 3; i++)
                at[i] = a[i] + k * (b[i] - a[i]) / POINTS;
            const uint32_t leaf = tm_node_lattice_leaf_at(&lattice, at);
            if (leaf == TM_NONE)
                continue;
            for (int i = 0; i < 3; i++)
                beside[i] = at[i] + step[i] * tm_leaf_side(octree, &octree->leaf[leaf]);
            const uint32_t next = tm_node_lattice_leaf_at(&lattice, beside);
            count +=
                next != TM_NONE && octree->leaf[next].level < octree->leaf[leaf].level;
        }
    tm_node_lattice_free(&lattice);
    return count;
}

/* The same of all curves where walls meet sharply. */
static size_t count_larger_at_walls(const tm_octree *octree, const tm_surface *surface)
{
    tm_wall_sectors sectors;
    tm_error error;
    size_t count = 0;
    assert_ok(tm_wall_sectors_find(&sectors, surface, &error), &error);
    for (size_t c = 0; c < surface->curves; c++)
        for (size_t i = surface->curve_start[c];
             sectors.sharp[c] && i + 1 < surface->curve_start[c + 1]; i++)
            count += count_larger(octree, surface->xyz[surface->curve_node[i]],
                                  surface->xyz[surface->curve_node[i + 1]]);
    tm_wall_sectors_free(&sectors);
    return count;
}

/* Blocks that lean over: along all curves where walls meet sharply leaves are of one size
 * then. */
static void test_refine(void **state)
{
    (void)state;
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    size_t before = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = 4};
        unsigned label[CUBES];
        tm_polygon_surface p;
        tm_surface surface;
        tm_octree octree;
        tm_error error;
        make_surface(&surface, label, &p);
        tm_surface_free(&surface);
        for (size_t v = 0; v < p.nodes; v++)
            p.xyz[v][0] += 0.6 * p.xyz[v][1];
        assert_ok(tm_surface_build(&surface, &p, &options, &error), &error);
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        before += count_larger_at_walls(&octree, &surface);
        assert_ok(tm_octree_refine_walls(&octree, &surface, &error), &error);
        assert_ok(tm_octree_check(&octree, &surface, &error), &error);
        assert_int_equal(count_larger_at_walls(&octree, &surface), 0);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
        tm_polygon_surface_free(&p);
    }
    assert_true(before > 0);
}

/* The ends of patterns: each number is that of one direction and the octants there. */
static void test_ends(void **state)
{
    (void)state;
    for (unsigned sectors = 3; sectors <= TM_SECTORS; sectors++) {
        tm_line_patterns patterns;
        tm_error error;
        assert_ok(tm_line_patterns_make(&patterns, sectors, &error), &error);
        assert_true(patterns.ends > 0 && patterns.ends < patterns.count);
        for (uint32_t i = 0; i < patterns.count; i++) {
            const tm_line_pattern *a = &patterns.pattern[i];
            assert_true(a->end < patterns.ends);
            for (uint32_t k = 0; k < i; k++) {
                const tm_line_pattern *b = &patterns.pattern[k];
                assert_int_equal(a->end == b->end,
                                 a->to == b->to && tm_side_code(a->code, a->to) ==
                                                       tm_side_code(b->code, b->to));
            }
        }
        tm_line_patterns_free(&patterns);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regions), cmocka_unit_test(test_leaves),
        cmocka_unit_test(test_layout),  cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_refine),  cmocka_unit_test(test_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
