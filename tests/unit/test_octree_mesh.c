/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole meshes: what is sharp at turned boxes, which of two boxes is worth edges, and
 * whether the elements of random solids are valid, fit together, and end on the surface.
 */
#include "../../lib/element/jens.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/octree/feature/feature_parts.h"
#include "../../lib/octree/layer/adaptive_refinement.h"
#include "../../lib/octree/repair/repair_stream.h"
#include "octree_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { BOX_CORNERS = 8, BOX_CURVES = 12, BOX_PATCHES = 6, BOXES = 8, ROUNDS = 20 };

static void make_mesh(tm_octree_mesh *mesh, const tm_octree *octree, tm_surface *surface)
{
    tm_error error;
    assert_ok(tm_octree_mesh_make(mesh, octree, surface, NULL, &error), &error);
}

static const double *outer_point(const tm_octree_mesh *mesh, size_t s)
{
    return mesh->assembly.mesh.xyz[mesh->assembly.outer + s];
}

/* No element is inverted, they fit together, and none of the nodes is idle. */
static void check_elements(const tm_octree_mesh *mesh)
{
    const tm_mixed_mesh *m = &mesh->assembly.mesh;
    const double(*xyz)[3] = (const double(*)[3])m->xyz;
    for (size_t e = 0; e < m->elements; e++)
        assert_true(tm_jens(m->start[e + 1] - m->start[e], xyz, m->item + m->start[e]) >
                    0);
    assert_int_equal(mesh->report.invalid, 0);
    const tm_examination found = assert_elements_fit(m, xyz);
    assert_int_equal(found.unused_nodes, 0);
    assert_true(found.components <= mesh->report.components);
    assert_int_equal(2 * found.euler, mesh->report.euler);
}

/* How far an outer node is from where it should be. */
static double distance_from_place(const tm_octree_mesh *mesh, const tm_surface *surface,
                                  size_t s)
{
    const double *at = outer_point(mesh, s);
    const uint32_t of = mesh->feature.of[s];
    double place[3];
    if (mesh->feature.kind[s] == TM_ON_CORNER)
        return sqrt(tm_distance2(at, surface->xyz[surface->corner[of]]));
    if (mesh->feature.kind[s] == TM_ON_CURVE) {
        size_t segment;
        tm_surface_closest_on_curve(surface, of, at, place, &segment);
        return sqrt(tm_distance2(at, place));
    }
    tm_surface_point closest = {.triangle = TM_NONE};
    tm_surface_closest(surface, at, TM_NONE, &closest);
    return sqrt(closest.distance2);
}

/* All boundary nodes are on the surface, but those that are off it. */
static void check_boundary(const tm_octree_mesh *mesh, const tm_surface *surface)
{
    const double close = 1e-9 * sqrt(tm_distance2(surface->low, surface->high));
    size_t off_surface = 0;
    for (size_t s = 0; s < mesh->boundary.nodes; s++) {
        off_surface += mesh->off_surface[s];
        assert_true(mesh->off_surface[s] ||
                    distance_from_place(mesh, surface, s) <= close);
    }
    assert_int_equal(off_surface, mesh->report.off_surface);
}

/* Whether two interior boundary nodes are the ends of an edge, or of a diagonal that cuts
 * a face. */
static bool are_joined(const tm_interior_boundary *boundary, uint32_t a, uint32_t b)
{
    for (size_t i = boundary->around_start[a]; i < boundary->around_start[a + 1]; i++) {
        const size_t f = boundary->around[i];
        const uint32_t *face = boundary->face[f];
        const unsigned k = tm_boundary_face_corners(boundary, f);
        unsigned at = 0;
        while (face[at] != a)
            at++;
        if (face[(at + 1) % k] == b || face[(at + k - 1) % k] == b)
            return true;
        if (boundary->cut[f] == (at % 2 == 0 ? TM_CUT_02 : TM_CUT_13) &&
            face[(at + 2) % k] == b)
            return true;
    }
    return false;
}

/* From a node on a curve, away from `before`, to its end: a corner. Returns how many
 * nodes are passed, this one too. */
static size_t walk_curve(const tm_octree_mesh *mesh, uint32_t s, uint32_t before,
                         uint32_t *corner)
{
    const tm_feature *feature = &mesh->feature;
    const uint32_t curve = feature->of[s];
    size_t passed = 0;
    while (feature->kind[s] == TM_ON_CURVE) {
        assert_int_equal(feature->of[s], curve);
        const uint32_t *along = feature->along[s];
        assert_true(along[0] == before || along[1] == before);
        assert_true(are_joined(&mesh->boundary, before, s));
        const uint32_t next = along[0] == before ? along[1] : along[0];
        before = s;
        s = next;
        assert_true(++passed <= mesh->boundary.nodes);
    }
    assert_true(are_joined(&mesh->boundary, before, s));
    assert_int_equal(feature->kind[s], TM_ON_CORNER);
    *corner = feature->of[s];
    return passed;
}

/* Each curve of a box is one path between its two corners. */
static void check_curves(const tm_octree_mesh *mesh, const tm_surface *surface)
{
    const tm_feature *feature = &mesh->feature;
    size_t nodes[BOX_CURVES] = {0};
    uint32_t first[BOX_CURVES] = {0};
    for (uint32_t s = 0; s < mesh->boundary.nodes; s++)
        if (feature->kind[s] == TM_ON_CURVE) {
            first[feature->of[s]] = s;
            nodes[feature->of[s]]++;
        }
    for (size_t c = 0; c < BOX_CURVES; c++) {
        assert_true(nodes[c] > 0);
        uint32_t end[2];
        const uint32_t *along = feature->along[first[c]];
        const size_t passed = walk_curve(mesh, first[c], along[0], &end[0]) +
                              walk_curve(mesh, first[c], along[1], &end[1]);
        assert_int_equal(passed, nodes[c] + 1);
        const uint32_t from = surface->curve_node[surface->curve_start[c]];
        const uint32_t to = surface->curve_node[surface->curve_start[c + 1] - 1];
        const uint32_t a = surface->corner[end[0]], b = surface->corner[end[1]];
        assert_true((a == from && b == to) || (a == to && b == from));
    }
}

/* Each corner of a box has one node, at its place. */
static void check_corners(const tm_octree_mesh *mesh, const tm_surface *surface)
{
    size_t nodes[BOX_CORNERS] = {0};
    for (size_t s = 0; s < mesh->boundary.nodes; s++)
        if (mesh->feature.kind[s] == TM_ON_CORNER) {
            const uint32_t corner = mesh->feature.of[s];
            nodes[corner]++;
            if (!mesh->off_surface[s])
                assert_memory_equal(outer_point(mesh, s),
                                    surface->xyz[surface->corner[corner]],
                                    3 * sizeof(double));
        }
    for (size_t c = 0; c < BOX_CORNERS; c++)
        assert_int_equal(nodes[c], 1);
}

/* Each of the six sides has nodes, and no face has nodes of two of them; a node on a
 * curve has only sides of the curve beside it. */
static void check_patches(const tm_octree_mesh *mesh, const tm_surface *surface)
{
    const tm_feature *feature = &mesh->feature;
    bool there[BOX_PATCHES] = {false};
    for (size_t f = 0; f < mesh->boundary.faces; f++) {
        const uint32_t *face = mesh->boundary.face[f];
        const unsigned k = tm_boundary_face_corners(&mesh->boundary, f);
        for (unsigned i = 0; i < k; i++) {
            if (feature->kind[face[i]] != TM_ON_PATCH)
                continue;
            const uint32_t patch = feature->of[face[i]], next = face[(i + 1) % k];
            assert_true(patch < BOX_PATCHES);
            there[patch] = true;
            if (feature->kind[next] == TM_ON_PATCH)
                assert_int_equal(feature->of[next], patch);
            if (feature->kind[next] == TM_ON_CURVE) {
                const uint32_t *beside = surface->curve_patch[feature->of[next]];
                assert_true(beside[0] == patch || beside[1] == patch);
            }
        }
    }
    for (size_t p = 0; p < BOX_PATCHES; p++)
        assert_true(there[p]);
}

static void make_turned_box(tm_surface *surface)
{
    tm_error error;
    tm_polygon_surface p;
    const double low[3] = {0, 0, 0};
    const double high[3] = {1, random_between(1, 2), random_between(1, 2)};
    tm_polygon_surface_init(&p);
    add_box(&p, low, high, false);
    turn_nodes(&p, random_between(0, 2));
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE,
                                        .unless_rough = true};
    assert_ok(tm_surface_build(surface, &p, &options, &error), &error);
    tm_polygon_surface_free(&p);
    assert_int_equal(surface->corners, BOX_CORNERS);
    assert_int_equal(surface->curves, BOX_CURVES);
    assert_int_equal(surface->patches, BOX_PATCHES);
}

/* All corners, edges and faces of boxes are there. */
static void test_boxes(void **state)
{
    (void)state;
    for (int round = 0; round < BOXES; round++) {
        const uint64_t seed = random_state;
        const tm_octree_rule rule = {.kind = TM_RULE_SURFACE,
                                     .level = 4 + random_below(2)};
        tm_surface surface;
        tm_octree octree;
        tm_octree_mesh mesh;
        tm_error error;
        make_turned_box(&surface);
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        printf("box %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed, octree.leaves);
        make_mesh(&mesh, &octree, &surface);
        assert_int_equal(mesh.report.corners_lost, 0);
        assert_int_equal(mesh.report.components, 1);
        assert_int_equal(mesh.report.euler, 2);
        check_corners(&mesh, &surface);
        assert_int_equal(mesh.report.curves_lost, 0);
        check_curves(&mesh, &surface);
        check_patches(&mesh, &surface);
        check_elements(&mesh);
        check_boundary(&mesh, &surface);
        tm_octree_mesh_free(&mesh);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
    }
}

/* Whether a mesh can be made: a leaf is inside. */
static bool has_solid(const tm_octree *octree, const tm_surface *surface)
{
    tm_error error;
    tm_interior interior;
    assert_ok(tm_interior_choose(&interior, octree, surface, &error), &error);
    const bool has = interior.count > 0;
    tm_interior_free(&interior);
    return has;
}

static unsigned deepest_level(const tm_octree *octree)
{
    unsigned deepest = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        if (octree->leaf[l].level > deepest)
            deepest = octree->leaf[l].level;
    return deepest;
}

static void test_random(void **state)
{
    (void)state;
    size_t elements = 0, boundary = 0, off_surface = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t seed = random_state;
        tm_surface surface;
        tm_octree octree;
        tm_octree_mesh mesh;
        tm_error error;
        make_random_surface(&surface);
        make_random_octree(&octree, &surface);
        printf("round %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed,
               octree.leaves);
        const size_t patches = surface.patches;
        const tm_status status =
            tm_octree_mesh_refine_lost(&mesh, &octree, &surface, deepest_level(&octree),
                                       random_below(2), random_below(2), NULL, &error);
        assert_int_equal(status, has_solid(&octree, &surface) ? TM_OK : TM_ERROR_INPUT);
        if (status == TM_OK) {
            check_elements(&mesh);
            check_boundary(&mesh, &surface);
            elements += mesh.assembly.mesh.elements;
            boundary += mesh.boundary.nodes;
            off_surface += mesh.report.off_surface;
        }
        assert_int_equal(surface.patches, patches);
        assert_ok(tm_surface_check(&surface, &error), &error);
        tm_octree_mesh_free(&mesh);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
    }
    printf("%zu elements; %zu of %zu boundary nodes are held back\n", elements,
           off_surface, boundary);
    assert_true(elements > 0 && off_surface < boundary);
}

/* A cube with a thin wall, in the middle of which are leaves from level 5 on. */
static void make_hollow_cube(tm_surface *surface)
{
    const double low[3] = {0, 0, 0}, high[3] = {4, 4, 4};
    const double hollow_low[3] = {0.1, 0.1, 0.1}, hollow_high[3] = {3.9, 3.9, 3.9};
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    tm_error error;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    add_box(&p, low, high, false);
    add_box(&p, hollow_low, hollow_high, true);
    assert_ok(tm_surface_build(surface, &p, &options, &error), &error);
    tm_polygon_surface_free(&p);
}

/* Leaves in which a part of the surface is lost. */
static size_t count_lost(const tm_octree *octree, const tm_surface *surface)
{
    tm_error error;
    tm_interior interior;
    uint8_t *lost = malloc(octree->leaves);
    assert_ok(tm_interior_choose(&interior, octree, surface, &error), &error);
    const size_t count = tm_interior_find_lost(&interior, octree, surface, lost);
    tm_interior_free(&interior);
    free(lost);
    return count;
}

/* It is refined where it would be lost, as far as is allowed and as is needed. */
static void test_resolve(void **state)
{
    (void)state;
    enum { LEVEL = 3, NEEDED = 2, MORE = 4 };
    const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = LEVEL};
    tm_surface surface;
    make_hollow_cube(&surface);
    for (unsigned more = 0; more < MORE; more++) {
        tm_error error;
        tm_octree octree;
        tm_octree_mesh mesh;
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        const tm_status status = tm_octree_mesh_refine_lost(
            &mesh, &octree, &surface, LEVEL, more, true, NULL, &error);
        assert_int_equal(deepest_level(&octree), LEVEL + (more < NEEDED ? more : NEEDED));
        if (more < NEEDED) {
            assert_int_equal(status, TM_ERROR_INPUT);
            assert_true(count_lost(&octree, &surface) > 0);
        } else {
            assert_ok(status, &error);
            assert_int_equal(mesh.report.lost, 0);
            assert_int_equal(mesh.report.components, 2);
            assert_int_equal(mesh.report.euler, 4);
            check_elements(&mesh);
        }
        tm_octree_mesh_free(&mesh);
        tm_octree_free(&octree);
    }
    tm_surface_free(&surface);
}

/* Without an octree in the stream, and with nobody to tell why, nodes get their rules. */
static void test_repair_without_octree(void **state)
{
    (void)state;
    const double low[3] = {0, 0, 0}, high[3] = {1, 1, 1};
    static const uint32_t tetrahedron[] = {0, 1, 2, 4}; /* corners of the box */
    tm_polygon_surface box;
    tm_surface surface;
    tm_stream stream;
    tm_repair_state repair;
    tm_repair_notes notes;
    tm_polygon_surface_init(&box);
    tm_stream_init(&stream);
    add_box(&box, low, high, false);
    assert_int_equal(tm_surface_build(&surface, &box, &(tm_surface_options){0}, NULL),
                     TM_OK);
    assert_non_null(tm_stream_add(&stream, ".node"));
    tm_block *mix = tm_stream_add(&stream, ".mix");
    assert_int_equal(tm_repair_from_stream(&repair, &stream, NULL), TM_ERROR_INPUT);
    tm_repair_state_free(&repair);
    tm_block *node = tm_stream_find(&stream, ".node");
    assert_int_equal(tm_block_allocate(node, surface.nodes, 0, NULL), TM_OK);
    assert_int_equal(tm_block_allocate(mix, 1, 4, NULL), TM_OK);
    memcpy(node->real, surface.xyz, surface.nodes * sizeof *surface.xyz);
    memcpy(mix->item, tetrahedron, sizeof tetrahedron);
    mix->start[1] = 4;
    assert_int_equal(tm_repair_from_stream(&repair, &stream, NULL), TM_OK);
    assert_int_equal(tm_repair_prepare(&repair, &stream, &surface, &notes, NULL), TM_OK);
    assert_true(notes.no_octree.what[0] != '\0');
    tm_repair_state_free(&repair);
    tm_stream_free(&stream);
    tm_surface_free(&surface);
    tm_polygon_surface_free(&box);
}

/* Curves and corners of a cube of this side beside one of side 8 get paths and nodes, or
 * not; those of the large one always do. */
static void check_choice(const double at[3], double side, bool wanted)
{
    tm_polygon_surface p;
    tm_surface surface;
    tm_feature_choice choice;
    tm_error error;
    const double large = 8;
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    tm_polygon_surface_init(&p);
    add_cube(&p, at[0], at[1], at[2], large);
    add_cube(&p, at[0] + large + 1, at[1] + 1, at[2] + 1, side);
    assert_ok(tm_surface_build(&surface, &p, &options, &error), &error);
    assert_int_equal(surface.curves, 2 * BOX_CURVES);
    assert_int_equal(surface.corners, 2 * BOX_CORNERS);
    double size[2 * BOX_CURVES];
    for (size_t c = 0; c < surface.curves; c++)
        size[c] = 1;
    assert_ok(tm_feature_choose(&choice, &surface, size, &error), &error);
    for (size_t c = 0; c < surface.curves; c++) {
        const double *end = surface.xyz[surface.curve_node[surface.curve_start[c]]];
        assert_int_equal(choice.curve[c], wanted || end[0] <= at[0] + large);
    }
    for (size_t c = 0; c < surface.corners; c++)
        assert_int_equal(choice.corner[c],
                         wanted || surface.xyz[surface.corner[c]][0] <= at[0] + large);
    tm_feature_choice_free(&choice);
    tm_surface_free(&surface);
    tm_polygon_surface_free(&p);
}

/* What is less than two leaves across is left out, wherever it is. */
static void test_choice(void **state)
{
    (void)state;
    for (int i = 0; i < 27; i++) {
        const double at[3] = {64.0 * (i % 3 - 1), 64.0 * (i / 3 % 3 - 1),
                              64.0 * (i / 9 - 1)};
        check_choice(at, 1.75, false);
        check_choice(at, 2, true);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_boxes),
        cmocka_unit_test(test_choice),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_resolve),
        cmocka_unit_test(test_repair_without_octree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
