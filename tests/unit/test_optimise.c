/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Grids of cubes, divided into elements of all kinds, whose nodes are thrown about: no
 * element stays inverted, none becomes bad, and nodes of the boundary stay on it. */
#include "../../lib/geom/vector.h"
#include "../../lib/optimise/optimise.h"
#include "../../lib/optimise/optimise_surface.h"
#include "../../lib/element/jens.h"
#include "../../lib/stream/stream.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { SIDE = 8, WIDE = SIDE + 1, CELLS = SIDE * SIDE * SIDE, GRID = WIDE * WIDE * WIDE };

/* How a cell is divided, or each in a random way. */
enum { ANY = 0, TETRAHEDRA = 4, PYRAMIDS = 5, WEDGES = 6, HEXAHEDRON = 8 };

typedef struct grid {
    tm_mixed_mesh mesh;
    tm_node_rule *rule;
    double *before; /* [elements]: J_ENS */
} grid;

/* The cube [0, SIDE]³: patch 2d + s is the side where coordinate d is 0 or SIDE; curve 4d
 * + s, along d, is where the next coordinate is at s & 1, the one after it at s & 2. */
static void on_cube(const void *of, uint32_t patch, const double point[3],
                    tm_boundary_point *at)
{
    (void)of;
    memcpy(at->xyz, point, sizeof at->xyz);
    memset(at->axis, 0, sizeof at->axis);
    at->axis[patch / 2] = 1;
    at->xyz[patch / 2] = patch % 2 * SIDE;
}

static void on_cube_edge(const void *of, uint32_t curve, const double point[3],
                         tm_boundary_point *at)
{
    (void)of;
    const uint32_t d = curve / 4;
    memset(at->axis, 0, sizeof at->axis);
    at->axis[d] = 1;
    at->xyz[d] = point[d];
    at->xyz[(d + 1) % 3] = curve % 2 * SIDE;
    at->xyz[(d + 2) % 3] = curve / 2 % 2 * SIDE;
}

static void at_cube_corner(const void *of, uint32_t corner, tm_boundary_point *at)
{
    (void)of;
    for (size_t i = 0; i < 3; i++)
        at->xyz[i] = (corner >> i & 1) * (double)SIDE;
}

static const tm_boundary cube = {NULL, on_cube, on_cube_edge, at_cube_corner};

/* The ball around the origin. */
static const double radius = SIDE / 2.0;

static void on_ball(const void *of, uint32_t patch, const double point[3],
                    tm_boundary_point *at)
{
    (void)of;
    (void)patch;
    const double length = tm_norm(point);
    for (size_t i = 0; i < 3; i++) {
        at->axis[i] = point[i] / length;
        at->xyz[i] = at->axis[i] * radius;
    }
}

static const tm_boundary ball = {NULL, on_ball, NULL, NULL};

static void add_element(tm_mixed_mesh *mesh, const uint32_t *node, const char *corners)
{
    size_t end = mesh->start[mesh->elements];
    for (; *corners; corners++)
        mesh->item[end++] = node[*corners - '0'];
    mesh->start[++mesh->elements] = end;
}

/* Adds a cell: its corners in the order of a hexahedron, then its centre. */
static void add_cell(tm_mixed_mesh *mesh, const uint32_t *node, int kind)
{
    static const int kinds[] = {TETRAHEDRA, PYRAMIDS, WEDGES, HEXAHEDRON};
    static const char *const tetrahedra[] = {"0126", "0516", "0456",
                                             "0746", "0236", "0376"};
    static const char *const pyramids[] = {"01238", "47658", "04518",
                                           "15628", "26738", "37408"};
    switch (kind == ANY ? kinds[random_below(4)] : kind) {
    case TETRAHEDRA:
        for (size_t t = 0; t < 6; t++)
            add_element(mesh, node, tetrahedra[t]);
        break;
    case PYRAMIDS:
        for (size_t t = 0; t < 6; t++)
            add_element(mesh, node, pyramids[t]);
        break;
    case WEDGES:
        add_element(mesh, node, "021465");
        add_element(mesh, node, "032476");
        break;
    default:
        add_element(mesh, node, "01234567");
    }
}

/* The rule of the grid node at `place`, whose coordinates are 0 … SIDE. */
static tm_node_rule rule_of(const uint32_t place[3])
{
    uint32_t sides = 0, side = 0, along = 0;
    for (uint32_t d = 0; d < 3; d++) {
        const bool outer = place[d] == 0 || place[d] == SIDE;
        sides += outer;
        if (outer)
            side = 2 * d + (place[d] == SIDE);
        else
            along = d;
    }
    const uint32_t first = (along + 1) % 3, second = (along + 2) % 3;
    switch (sides) {
    case 0:
        return (tm_node_rule){TM_NONE, TM_MOVES_FREELY, false};
    case 1:
        return (tm_node_rule){side, TM_MOVES_ON_SURFACE, false};
    case 2: {
        const uint32_t curve =
            4 * along + place[first] / SIDE + 2 * (place[second] / SIDE);
        return (tm_node_rule){curve, TM_MOVES_ON_CURVE, false};
    }
    default:
        return (tm_node_rule){place[0] / SIDE + 2 * (place[1] / SIDE) +
                                  4 * (place[2] / SIDE),
                              TM_MOVES_AT_CORNER, false};
    }
}

static grid make_grid(int kind)
{
    grid g = {.mesh = {.nodes = GRID + CELLS}};
    tm_mixed_mesh *mesh = &g.mesh;
    mesh->xyz = calloc(mesh->nodes, sizeof *mesh->xyz);
    mesh->start = calloc(6 * CELLS + 1, sizeof *mesh->start);
    mesh->item = calloc((size_t)6 * CELLS * 5, sizeof *mesh->item);
    g.rule = calloc(mesh->nodes, sizeof *g.rule);
    for (uint32_t v = 0; v < GRID; v++) {
        const uint32_t place[3] = {v % WIDE, v / WIDE % WIDE, v / WIDE / WIDE};
        for (size_t i = 0; i < 3; i++)
            mesh->xyz[v][i] = place[i];
        g.rule[v] = rule_of(place);
    }
    for (uint32_t c = 0; c < CELLS; c++) {
        const uint32_t x = c % SIDE, y = c / SIDE % SIDE, z = c / SIDE / SIDE;
        const uint32_t o = x + WIDE * (y + WIDE * z), up = WIDE * WIDE;
        const uint32_t node[9] = {o,       o + 1,      o + 1 + WIDE,      o + WIDE,
                                  o + up,  o + up + 1, o + up + 1 + WIDE, o + up + WIDE,
                                  GRID + c};
        const double centre[3] = {x + 0.5, y + 0.5, z + 0.5};
        memcpy(mesh->xyz[GRID + c], centre, sizeof centre);
        g.rule[GRID + c] = (tm_node_rule){TM_NONE, TM_MOVES_FREELY, false};
        add_cell(mesh, node, kind);
    }
    return g;
}

static void free_grid(grid *g)
{
    free(g->mesh.xyz);
    free(g->mesh.start);
    free(g->mesh.item);
    free(g->rule);
    free(g->before);
}

/* The cube becomes a ball: what is on a sphere of the maximum norm, on a sphere. */
static void make_round(grid *g)
{
    for (size_t v = 0; v < g->mesh.nodes; v++) {
        double *p = g->mesh.xyz[v], most = 0;
        for (size_t i = 0; i < 3; i++) {
            p[i] -= radius;
            most = fmax(most, fabs(p[i]));
        }
        const double length = tm_norm(p);
        for (size_t i = 0; length > 0 && i < 3; i++)
            p[i] *= most / length;
        if (g->rule[v].freedom != TM_MOVES_FREELY)
            g->rule[v] = (tm_node_rule){TM_NONE, TM_MOVES_ON_SURFACE, false};
    }
}

static void place_node(grid *g, const tm_boundary *boundary, size_t v)
{
    tm_boundary_point at = {.guess = TM_NONE};
    const tm_node_rule *rule = &g->rule[v];
    if (rule->freedom == TM_MOVES_ON_SURFACE)
        boundary->on_surface(boundary->of, rule->where, g->mesh.xyz[v], &at);
    else if (rule->freedom == TM_MOVES_ON_CURVE)
        boundary->on_curve(boundary->of, rule->where, g->mesh.xyz[v], &at);
    else if (rule->freedom == TM_MOVES_AT_CORNER)
        boundary->at_corner(boundary->of, rule->where, &at);
    else
        return;
    memcpy(g->mesh.xyz[v], at.xyz, sizeof at.xyz);
}

/* Moves each node, one of `one_of`, by up to `most`, along the boundary where it is. */
static void throw_nodes(grid *g, const tm_boundary *boundary, double most,
                        unsigned one_of)
{
    for (size_t v = 0; v < g->mesh.nodes; v++) {
        if (g->rule[v].freedom == TM_MOVES_AT_CORNER || random_below(one_of) > 0)
            continue;
        for (size_t i = 0; i < 3; i++)
            g->mesh.xyz[v][i] += most * (2 * random_unit() - 1);
        place_node(g, boundary, v);
    }
}

static double quality(const grid *g, size_t e)
{
    const tm_mixed_mesh *mesh = &g->mesh;
    return tm_jens(mesh->start[e + 1] - mesh->start[e], (const double(*)[3])mesh->xyz,
                   mesh->item + mesh->start[e]);
}

static void remember(grid *g)
{
    g->before = calloc(g->mesh.elements, sizeof *g->before);
    for (size_t e = 0; e < g->mesh.elements; e++)
        g->before[e] = quality(g, e);
}

/* Whether the report says what is so, no element has become bad that was not, and nodes
 * are on the boundary. */
static void check(const grid *g, const tm_boundary *boundary, double threshold,
                  const tm_optimise_report *report)
{
    size_t bad[2] = {0, 0}, inverted[2] = {0, 0};
    double worst[2] = {1, 1};
    for (size_t e = 0; e < g->mesh.elements; e++) {
        const double jens[2] = {g->before[e], quality(g, e)};
        for (size_t i = 0; i < 2; i++) {
            bad[i] += jens[i] < threshold;
            inverted[i] += jens[i] <= 0;
            worst[i] = fmin(worst[i], jens[i]);
        }
        if (jens[1] < threshold)
            assert_true(jens[0] < threshold);
    }
    assert_int_equal(report->bad_before, bad[0]);
    assert_int_equal(report->bad_after, bad[1]);
    assert_int_equal(report->inverted_before, inverted[0]);
    assert_int_equal(report->inverted_after, inverted[1]);
    assert_true(report->worst_before == worst[0]);
    assert_true(report->worst_after == worst[1]);
    assert_true(bad[1] <= bad[0] && inverted[1] <= inverted[0]);
    for (size_t v = 0; v < g->mesh.nodes; v++) {
        double before[3];
        memcpy(before, g->mesh.xyz[v], sizeof before);
        if (g->rule[v].off_surface)
            continue;
        place_node((grid *)g, boundary, v);
        assert_true(tm_distance2(before, g->mesh.xyz[v]) < 1e-18 * SIDE * SIDE);
    }
}

static tm_optimise_report optimise(grid *g, const tm_boundary *boundary, double threshold)
{
    const tm_optimise_options options = {
        .threshold = threshold, .off_surface_threshold = threshold, .effort = 3};
    tm_optimise_report report;
    tm_error error;
    assert_int_equal(
        tm_mixed_optimise(&g->mesh, g->rule, boundary, &options, &report, &error), TM_OK);
    return report;
}

static void test_untangles(void **state)
{
    (void)state;
    const int kinds[] = {HEXAHEDRON, WEDGES, PYRAMIDS, TETRAHEDRA, ANY};
    const double threshold = 0.03;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        grid g = make_grid(kinds[k]);
        throw_nodes(&g, &cube, 0.4, 1);
        remember(&g);
        const tm_optimise_report report = optimise(&g, &cube, threshold);
        check(&g, &cube, threshold, &report);
        assert_true(report.inverted_before > 0);
        assert_int_equal(report.inverted_after, 0);
        assert_int_equal(report.bad_after, 0);
        assert_true(report.moved > 0);
        free_grid(&g);
    }
}

/* A few nodes far from their places, as much as a whole cell. */
static void test_few(void **state)
{
    (void)state;
    const double threshold = 0.1;
    grid g = make_grid(ANY);
    throw_nodes(&g, &cube, 0.9, 50);
    remember(&g);
    const tm_optimise_report report = optimise(&g, &cube, threshold);
    check(&g, &cube, threshold, &report);
    assert_int_equal(report.inverted_after, 0);
    free_grid(&g);
}

static void test_ball(void **state)
{
    (void)state;
    const double threshold = 0.02;
    const int kinds[] = {HEXAHEDRON, ANY};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        grid g = make_grid(kinds[k]);
        make_round(&g);
        throw_nodes(&g, &ball, 0.2, 1);
        remember(&g);
        const tm_optimise_report report = optimise(&g, &ball, threshold);
        check(&g, &ball, threshold, &report);
        assert_true(report.inverted_before > 0);
        assert_int_equal(report.inverted_after, 0);
        free_grid(&g);
    }
}

/* The cube of triangles. */
static tm_surface build_cube(void)
{
    tm_error error;
    tm_polygon_surface polygons;
    tm_polygon_surface_init(&polygons);
    for (unsigned v = 0; v < 8; v++) {
        const double xyz[3] = {(v & 1) * (double)SIDE, (v >> 1 & 1) * (double)SIDE,
                               (v >> 2) * (double)SIDE};
        assert_int_equal(tm_polygon_surface_add_node(&polygons, xyz, &error), TM_OK);
    }
    for (unsigned d = 0; d < 3; d++) {
        const uint32_t u = 1U << (d + 1) % 3, w = 1U << (d + 2) % 3, s = 1U << d;
        const uint32_t low[4] = {0, w, u + w, u}, high[4] = {s, s + u, s + u + w, s + w};
        assert_int_equal(tm_polygon_surface_add_polygon(&polygons, low, 4, &error),
                         TM_OK);
        assert_int_equal(tm_polygon_surface_add_polygon(&polygons, high, 4, &error),
                         TM_OK);
    }
    tm_surface surface;
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    assert_int_equal(tm_surface_build(&surface, &polygons, &options, &error), TM_OK);
    tm_polygon_surface_free(&polygons);
    return surface;
}

/* The patch or curve that a node is on, in place of a side or an edge of the cube. */
static uint32_t where_on(const tm_surface *surface, const tm_node_rule *rule,
                         const double p[3])
{
    if (rule->freedom == TM_MOVES_ON_SURFACE) {
        tm_surface_point at = {.triangle = TM_NONE};
        tm_surface_closest(surface, p, TM_NONE, &at);
        return surface->patch[at.triangle];
    }
    if (rule->freedom == TM_MOVES_AT_CORNER) {
        uint32_t c = 0;
        while (tm_distance2(p, surface->xyz[surface->corner[c]]) > 0)
            c++;
        return c;
    }
    for (uint32_t c = 0; c < surface->curves; c++) {
        double closest[3];
        size_t segment;
        tm_surface_closest_on_curve(surface, c, p, closest, &segment);
        if (tm_distance2(p, closest) == 0)
            return c;
    }
    fail();
    return TM_NONE;
}

/* The same with a surface of triangles in place of formulas. */
static void test_surface(void **state)
{
    (void)state;
    tm_surface surface = build_cube();
    assert_int_equal(surface.patches, 6);
    assert_int_equal(surface.curves, 12);
    const tm_boundary boundary = tm_boundary_of_surface(&surface);
    const double threshold = 0.03;
    grid g = make_grid(ANY);
    for (size_t v = 0; v < GRID; v++)
        if (g.rule[v].freedom != TM_MOVES_FREELY)
            g.rule[v].where = where_on(&surface, &g.rule[v], g.mesh.xyz[v]);
    throw_nodes(&g, &boundary, 0.4, 1);
    remember(&g);
    const tm_optimise_report report = optimise(&g, &boundary, threshold);
    check(&g, &boundary, threshold, &report);
    assert_int_equal(report.bad_after, 0);
    free_grid(&g);
    tm_surface_free(&surface);
}

/* What is good already is left alone. */
static void test_nothing(void **state)
{
    (void)state;
    grid g = make_grid(ANY);
    remember(&g);
    double(*xyz)[3] = malloc(g.mesh.nodes * sizeof *xyz);
    memcpy(xyz, g.mesh.xyz, g.mesh.nodes * sizeof *xyz);
    const tm_optimise_report report = optimise(&g, &cube, 0.3);
    assert_int_equal(report.bad_before, 0);
    assert_int_equal(report.moved, 0);
    assert_memory_equal(xyz, g.mesh.xyz, g.mesh.nodes * sizeof *xyz);
    free(xyz);
    free_grid(&g);
    grid empty = {.mesh = {.start = (size_t[]){0}}};
    const tm_optimise_report none = optimise(&empty, NULL, 0.3);
    assert_int_equal(none.bad_after, 0);
    assert_true(none.worst_after == 1);
}

/* Where all nodes are fixed nothing can be done, and nothing is. */
static void test_fixed(void **state)
{
    (void)state;
    grid g = make_grid(ANY);
    throw_nodes(&g, &cube, 0.45, 1);
    remember(&g);
    for (size_t v = 0; v < g.mesh.nodes; v++)
        g.rule[v].freedom = TM_MOVES_NOT;
    const tm_optimise_report report = optimise(&g, NULL, 0.03);
    check(&g, NULL, 0.03, &report);
    assert_int_equal(report.moved, 0);
    assert_int_equal(report.bad_before, report.bad_after);
    free_grid(&g);
}

/* Nodes of one side, its edges and corners are up to half a cell inside: the elements are
 * valid. All of them come to it. */
static void test_held(void **state)
{
    (void)state;
    const int kinds[] = {HEXAHEDRON, WEDGES, PYRAMIDS, TETRAHEDRA, ANY};
    const double threshold = 0.03;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        grid g = make_grid(kinds[k]);
        for (uint32_t v = 0; v < GRID; v++) {
            tm_node_rule *rule = &g.rule[v];
            if (g.mesh.xyz[v][0] > 0 || random_below(8) > 0)
                continue;
            rule->off_surface = true;
            g.mesh.xyz[v][0] = 0.2 + 0.3 * random_unit();
        }
        remember(&g);
        const tm_optimise_report report = optimise(&g, &cube, threshold);
        check(&g, &cube, threshold, &report);
        assert_true(report.off_surface_before > 0);
        assert_int_equal(report.off_surface_after, 0);
        for (uint32_t v = 0; v < GRID; v++)
            assert_false(g.rule[v].off_surface);
        free_grid(&g);
    }
}

/* A node that would have to pass through its opposite one, which is fixed, stays. */
static void test_held_stays(void **state)
{
    (void)state;
    grid g = make_grid(HEXAHEDRON);
    const uint32_t v = WIDE * (SIDE / 2 + WIDE * (SIDE / 2));
    for (size_t i = 0; i < g.mesh.nodes; i++)
        if (i != v)
            g.rule[i].freedom = TM_MOVES_NOT;
    g.rule[v].off_surface = true;
    g.mesh.xyz[v + 1][0] = -0.5;
    g.mesh.xyz[v][0] = -0.9;
    remember(&g);
    const tm_optimise_report report = optimise(&g, &cube, 0.03);
    assert_int_equal(report.off_surface_before, 1);
    assert_int_equal(report.off_surface_after, 1);
    assert_true(g.rule[v].off_surface);
    check(&g, &cube, 0.03, &report);
    free_grid(&g);
}

/* Two neighbours have to be at the same corner: their elements are valid only if one of
 * them may leave it. */
static void test_released(void **state)
{
    (void)state;
    tm_surface surface = build_cube();
    const tm_boundary boundary = tm_boundary_of_surface(&surface);
    for (int may = 0; may < 2; may++) {
        grid g = make_grid(HEXAHEDRON);
        for (size_t v = 0; v < GRID; v++)
            if (g.rule[v].freedom != TM_MOVES_FREELY)
                g.rule[v].where = where_on(&surface, &g.rule[v], g.mesh.xyz[v]);
        g.rule[1] = g.rule[0];
        memcpy(g.mesh.xyz[1], g.mesh.xyz[0], sizeof *g.mesh.xyz);
        remember(&g);
        const tm_optimise_options options = {.threshold = 0.03,
                                             .off_surface_threshold = 0.03,
                                             .release_threshold = may * 0.01,
                                             .effort = 1};
        tm_optimise_report report;
        tm_error error;
        assert_int_equal(
            tm_mixed_optimise(&g.mesh, g.rule, &boundary, &options, &report, &error),
            TM_OK);
        check(&g, &boundary, 0.03, &report);
        assert_int_equal(report.inverted_before, 1);
        assert_int_equal(report.inverted_after, 1 - may);
        assert_int_equal(report.bad_after, 1 - may);
        assert_int_equal(report.released > 0, may);
        for (size_t v = 0; v < 2 && !may; v++)
            assert_int_equal(g.rule[v].freedom, TM_MOVES_AT_CORNER);
        free_grid(&g);
    }
    tm_surface_free(&surface);
}

/* Thresholds of elements: only those that are to be good are looked after. */
static void test_thresholds(void **state)
{
    (void)state;
    grid g = make_grid(HEXAHEDRON);
    throw_nodes(&g, &cube, 0.35, 1);
    remember(&g);
    double *thresholds = calloc(g.mesh.elements, sizeof *thresholds);
    size_t bad = 0;
    for (size_t e = 0; e < g.mesh.elements; e++) {
        thresholds[e] = e % 7 == 0 ? 0.25 : 0.02;
        bad += g.before[e] < thresholds[e];
    }
    const tm_optimise_options options = {
        .thresholds = thresholds, .off_surface_threshold = 0.02, .effort = 3};
    tm_optimise_report report;
    tm_error error;
    assert_int_equal(tm_mixed_optimise(&g.mesh, g.rule, &cube, &options, &report, &error),
                     TM_OK);
    assert_int_equal(report.bad_before, bad);
    assert_true(bad > 0);
    assert_int_equal(report.bad_after, 0);
    for (size_t e = 0; e < g.mesh.elements; e += 7)
        assert_true(quality(&g, e) >= 0.25);
    free(thresholds);
    free_grid(&g);
}

/* An end to the work: nothing is begun after the first cluster, and what was done stays.
 */
static void test_spent(void **state)
{
    (void)state;
    grid g = make_grid(ANY);
    throw_nodes(&g, &cube, 0.45, 1);
    for (uint32_t v = 0; v < GRID; v += WIDE * WIDE + 1)
        g.rule[v].off_surface = g.rule[v].freedom == TM_MOVES_ON_SURFACE;
    remember(&g);
    const tm_optimise_options options = {.threshold = 0.1,
                                         .off_surface_threshold = 0.1,
                                         .release_threshold = 0.1,
                                         .effort = 1,
                                         .most_measured = 1};
    tm_optimise_report report;
    tm_error error;
    assert_int_equal(tm_mixed_optimise(&g.mesh, g.rule, &cube, &options, &report, &error),
                     TM_OK);
    check(&g, &cube, 0.1, &report);
    assert_int_equal(report.clusters, 1);
    assert_int_equal(report.off_surface_after, report.off_surface_before);
    free_grid(&g);
}

static void test_deterministic(void **state)
{
    (void)state;
    const uint64_t seed = random_state;
    double(*first)[3] = NULL;
    for (int run = 0; run < 2; run++) {
        random_state = seed;
        grid g = make_grid(ANY);
        throw_nodes(&g, &cube, 0.5, 1);
        optimise(&g, &cube, 0.1);
        if (run == 0) {
            first = malloc(g.mesh.nodes * sizeof *first);
            memcpy(first, g.mesh.xyz, g.mesh.nodes * sizeof *first);
        } else {
            assert_memory_equal(first, g.mesh.xyz, g.mesh.nodes * sizeof *first);
        }
        free_grid(&g);
    }
    free(first);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_untangles), cmocka_unit_test(test_few),
        cmocka_unit_test(test_ball),      cmocka_unit_test(test_surface),
        cmocka_unit_test(test_nothing),   cmocka_unit_test(test_fixed),
        cmocka_unit_test(test_held),      cmocka_unit_test(test_held_stays),
        cmocka_unit_test(test_released),  cmocka_unit_test(test_thresholds),
        cmocka_unit_test(test_spent),     cmocka_unit_test(test_deterministic),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
