/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Octrees over ellipsoids: against the leaves that plain splitting until nothing is left
 * to split gives, and against what octree.h promises. */
#include "../../lib/octree/forest/brick.h"
#include "../../lib/octree/forest/mpi_start.h"
#include "../../lib/octree/forest/octree_build.h"
#include "../../lib/octree/forest/octree_stream.h"
#include "../../lib/octree/forest/p4est_call.h"
#include "random.h"

#include <math.h>
#include <p4est.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { CHILDREN = 8, LEAVES_MAX = 6000, RINGS = 8, SECTORS = 12 };

static const double pi = 3.14159265358979323846;

static void assert_ok(tm_status status, const tm_error *error)
{
    if (status != TM_OK)
        fail_msg("%s", error->what);
}

static void assert_refused(tm_status status, const tm_error *error, const char *part)
{
    assert_int_equal(status, TM_ERROR_INPUT);
    if (!strstr(error->what, part))
        fail_msg("'%s' is not in '%s'", part, error->what);
}

static void add_triangle(tm_polygon_surface *p, uint32_t a, uint32_t b, uint32_t c)
{
    tm_error error = {0};
    assert_ok(tm_polygon_surface_add_polygon(p, (uint32_t[3]){a, b, c}, 3, &error),
              &error);
}

/* Poles are nodes 0 and 1; then ring by ring. */
static uint32_t ring_node(unsigned ring, unsigned sector)
{
    return 2 + ring * SECTORS + sector % SECTORS;
}

static void add_triangles(tm_polygon_surface *p)
{
    for (unsigned s = 0; s < SECTORS; s++) {
        add_triangle(p, 0, ring_node(0, s), ring_node(0, s + 1));
        for (unsigned r = 0; r + 1 < RINGS; r++) {
            const uint32_t a = ring_node(r, s), b = ring_node(r, s + 1);
            const uint32_t c = ring_node(r + 1, s), d = ring_node(r + 1, s + 1);
            add_triangle(p, a, c, b);
            add_triangle(p, b, c, d);
        }
        add_triangle(p, 1, ring_node(RINGS - 1, s + 1), ring_node(RINGS - 1, s));
    }
}

static void make_ellipsoid(tm_surface *surface, const double centre[3],
                           const double axis[3])
{
    tm_error error = {0};
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    for (int pole = 1; pole >= -1; pole -= 2)
        assert_ok(tm_polygon_surface_add_node(
                      &p, (double[3]){centre[0], centre[1], centre[2] + pole * axis[2]},
                      &error),
                  &error);
    for (unsigned r = 0; r < RINGS; r++)
        for (unsigned s = 0; s < SECTORS; s++) {
            const double polar = pi * (r + 1) / (RINGS + 1);
            const double around = 2 * pi * s / SECTORS;
            const double xyz[3] = {centre[0] + axis[0] * sin(polar) * cos(around),
                                   centre[1] + axis[1] * sin(polar) * sin(around),
                                   centre[2] + axis[2] * cos(polar)};
            assert_ok(tm_polygon_surface_add_node(&p, xyz, &error), &error);
        }
    add_triangles(&p);
    const tm_surface_options options = {.feature_angle = 40};
    assert_ok(tm_surface_build(surface, &p, &options, &error), &error);
    tm_polygon_surface_free(&p);
}

static void make_sphere(tm_surface *surface)
{
    make_ellipsoid(surface, (double[3]){0.1, -0.2, 0.3}, (double[3]){1, 1, 1});
}

/* With axes of lengths such that there are some roots along each axis. */
static void make_some_ellipsoid(tm_surface *surface)
{
    double centre[3], axis[3];
    for (int i = 0; i < 3; i++) {
        centre[i] = random_unit();
        axis[i] = 1 + 1.5 * random_unit();
    }
    make_ellipsoid(surface, centre, axis);
}

static void check(const tm_octree *octree, const tm_surface *surface)
{
    tm_error error = {0};
    assert_ok(tm_octree_check(octree, surface, &error), &error);
}

/* Leaves without order, split one by one. */
typedef struct plain_octree {
    size_t leaves;
    tm_leaf leaf[LEAVES_MAX];
} plain_octree;

static uint32_t side_of(const tm_leaf *leaf)
{
    return (uint32_t)1 << (TM_OCTREE_FINEST - leaf->level);
}

static void split_plain(plain_octree *plain, size_t i)
{
    assert_true(plain->leaves + CHILDREN <= LEAVES_MAX);
    const tm_leaf parent = plain->leaf[i];
    for (unsigned c = 0; c < CHILDREN; c++) {
        tm_leaf child = {.level = (uint8_t)(parent.level + 1)};
        for (unsigned k = 0; k < 3; k++)
            child.anchor[k] = parent.anchor[k] + (c >> k & 1) * side_of(&parent) / 2;
        plain->leaf[c == 0 ? i : plain->leaves++] = child;
    }
}

/* Whether two leaves share a face or a part of an edge: they touch, in more than a
 * point. */
static bool adjoin(const tm_leaf *a, const tm_leaf *b)
{
    unsigned points = 0;
    for (int k = 0; k < 3; k++) {
        const uint32_t from = a->anchor[k] > b->anchor[k] ? a->anchor[k] : b->anchor[k];
        const uint32_t a_to = a->anchor[k] + side_of(a), b_to = b->anchor[k] + side_of(b);
        const uint32_t to = a_to < b_to ? a_to : b_to;
        if (from > to)
            return false;
        points += from == to;
    }
    return points < 3;
}

static bool unbalanced(const plain_octree *plain, size_t i)
{
    for (size_t j = 0; j < plain->leaves; j++)
        if (plain->leaf[j].level > plain->leaf[i].level + 1 &&
            adjoin(&plain->leaf[i], &plain->leaf[j]))
            return true;
    return false;
}

static void balance_plain(plain_octree *plain)
{
    for (bool again = true; again;) {
        again = false;
        for (size_t i = 0; i < plain->leaves; i++)
            if (unbalanced(plain, i)) {
                split_plain(plain, i);
                again = true;
            }
    }
}

static void box_of(const tm_octree *octree, const tm_leaf *leaf, double low[3],
                   double high[3])
{
    uint32_t far[3];
    for (int k = 0; k < 3; k++)
        far[k] = leaf->anchor[k] + side_of(leaf);
    tm_octree_point(octree, leaf->anchor, low);
    tm_octree_point(octree, far, high);
}

static bool meets_or_inside(const tm_surface *surface, const double low[3],
                            const double high[3])
{
    const double centre[3] = {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2,
                              (low[2] + high[2]) / 2};
    return tm_surface_meets_box(surface, low, high) ||
           tm_surface_has_inside(surface, centre);
}

static bool wanted(const tm_surface *surface, const tm_octree_rule *rule,
                   const double low[3], const double high[3])
{
    bool meets = true;
    switch (rule->kind) {
    case TM_RULE_SURFACE:
        return tm_surface_meets_box(surface, low, high);
    case TM_RULE_BOX:
        for (int i = 0; i < 3; i++)
            meets &= rule->low[i] <= high[i] && low[i] <= rule->high[i];
        return meets;
    case TM_RULE_REGION:
        return meets_or_inside(rule->region, low, high);
    default:
        return rule->kind == TM_RULE_EVERYTHING;
    }
}

/* What the rules ask for, where `octree` has its brick. */
static void build_plain(plain_octree *plain, const tm_octree *octree,
                        const tm_surface *surface, const tm_octree_rule *rule,
                        size_t rules)
{
    plain->leaves = 0;
    const uint32_t *roots = octree->roots;
    for (uint32_t r = 0; r < roots[0] * roots[1] * roots[2]; r++) {
        const uint32_t place[3] = {r % roots[0], r / roots[0] % roots[1],
                                   r / (roots[0] * roots[1])};
        tm_leaf *root = &plain->leaf[plain->leaves++];
        *root = (tm_leaf){.level = 0};
        for (int k = 0; k < 3; k++)
            root->anchor[k] = place[k] << TM_OCTREE_FINEST;
    }
    for (size_t i = 0; i < plain->leaves; i++)
        for (size_t r = 0; r < rules; r++) {
            double low[3], high[3];
            box_of(octree, &plain->leaf[i], low, high);
            while (plain->leaf[i].level < rule[r].level &&
                   wanted(surface, &rule[r], low, high) &&
                   meets_or_inside(surface, low, high)) {
                split_plain(plain, i);
                box_of(octree, &plain->leaf[i], low, high);
                r = 0;
            }
        }
    balance_plain(plain);
}

static int compare_leaves(const void *a, const void *b)
{
    const tm_leaf *p = a;
    const tm_leaf *q = b;
    for (int k = 0; k < 3; k++)
        if (p->anchor[k] != q->anchor[k])
            return p->anchor[k] < q->anchor[k] ? -1 : 1;
    return (p->level > q->level) - (p->level < q->level);
}

static void assert_same_leaves(const tm_octree *octree, plain_octree *plain)
{
    assert_int_equal(octree->leaves, plain->leaves);
    tm_leaf *sorted = malloc(octree->leaves * sizeof *sorted);
    assert_non_null(sorted);
    memcpy(sorted, octree->leaf, octree->leaves * sizeof *sorted);
    qsort(sorted, octree->leaves, sizeof *sorted, compare_leaves);
    qsort(plain->leaf, plain->leaves, sizeof *plain->leaf, compare_leaves);
    for (size_t i = 0; i < plain->leaves; i++)
        assert_int_equal(compare_leaves(&sorted[i], &plain->leaf[i]), 0);
    free(sorted);
}

static void test_places(void **state)
{
    (void)state;
    for (unsigned c = 0; c < CHILDREN; c++)
        for (unsigned k = 0; k < 3; k++)
            assert_int_equal(tm_leaf_point[TM_LEAF_CORNER + c][k], 2 * (c >> k & 1));
    for (unsigned e = 0; e < 12; e++) {
        const unsigned along = e / 4, lower = along == 0 ? 1 : 0,
                       upper = along == 2 ? 1 : 2;
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][along], 1);
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][lower], 2 * (e & 1));
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][upper], 2 * (e >> 1 & 1));
    }
    for (unsigned f = 0; f < 6; f++)
        for (unsigned k = 0; k < 3; k++)
            assert_int_equal(tm_leaf_point[TM_LEAF_FACE + f][k],
                             k == f / 2 ? 2 * (f & 1) : 1);
    for (unsigned k = 0; k < 3; k++)
        assert_int_equal(tm_leaf_point[TM_LEAF_CENTRE][k], 1);
}

static void assert_brick(const double low[3], const double high[3], double size,
                         const uint32_t roots[3], double side)
{
    tm_error error = {0};
    tm_brick brick;
    assert_ok(tm_brick_over(&brick, low, high, size, &error), &error);
    assert_true(fabs(brick.side - side) <= 1e-12 * side);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(brick.roots[i], roots[i]);
        assert_true(brick.low[i] < low[i]);
        assert_true(brick.low[i] + brick.roots[i] * brick.side > high[i]);
    }
    tm_brick_free(&brick);
}

/* A box of whole octants has its faces between octants, not in planes of centres. */
static void test_brick_of_octants(void **state)
{
    (void)state;
    const double close = 1e-5;
    for (int k = 0; k < 1000; k++) {
        const double size = 0.01 + random_unit();
        double low[3], high[3];
        for (int i = 0; i < 3; i++) {
            low[i] = 10 * random_unit();
            high[i] = low[i] + size * (1 + random_below(20));
        }
        tm_error error = {0};
        tm_brick brick;
        assert_ok(tm_brick_over(&brick, low, high, size, &error), &error);
        for (int i = 0; i < 3; i++) {
            const double below = (low[i] - brick.low[i]) / size;
            const double above =
                (brick.low[i] + brick.roots[i] * brick.side - high[i]) / size;
            assert_true(fabs(below - round(below)) < close && below > close);
            assert_true(fabs(above - round(above)) < close && above > close);
        }
        tm_brick_free(&brick);
    }
}

static void test_brick(void **state)
{
    (void)state;
    const double zero[3] = {0, 0, 0};
    assert_brick(zero, (double[3]){1, 1, 1}, 0, (uint32_t[3]){1, 1, 1}, 1.01);
    assert_brick(zero, (double[3]){2, 1, 5}, 0, (uint32_t[3]){2, 1, 5}, 1.01);
    /* Twice 1.01: two cubes would touch the box. */
    assert_brick(zero, (double[3]){1, 2.02, 1}, 0, (uint32_t[3]){1, 3, 1}, 1.01);
    /* A plate: as many cubes as there may be. */
    assert_brick(zero, (double[3]){100, 100, 0.01}, 0, (uint32_t[3]){32, 32, 1},
                 1.0002 * 100 / 32);
    /* Of a given size, doubled. */
    assert_brick(zero, (double[3]){1, 1, 1}, 0.3, (uint32_t[3]){1, 1, 1}, 1.2);
    assert_brick(zero, (double[3]){1, 1, 1}, 3, (uint32_t[3]){1, 1, 1}, 3);
    assert_brick(zero, (double[3]){100, 100, 0.01}, 1, (uint32_t[3]){26, 26, 1}, 4);
    tm_error error = {0};
    tm_brick brick;
    assert_refused(tm_brick_over(&brick, zero, zero, 0, &error), &error, "no extent");
    tm_brick_free(&brick);
    assert_refused(tm_brick_over(&brick, (double[3]){1e16, 0, 0},
                                 (double[3]){1e16 + 2, 1, 1}, 0, &error),
                   &error, "too far");
    tm_brick_free(&brick);
}

static void test_root_only(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    make_sphere(&surface);
    tm_octree octree;
    assert_ok(tm_octree_build(&octree, &surface, NULL, 0, &error), &error);
    check(&octree, &surface);
    const uint32_t *n = octree.roots;
    assert_int_equal(octree.leaves, n[0] * n[1] * n[2]);
    assert_int_equal(octree.nodes, (n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    assert_true(octree.leaf[0].crossed);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
}

static tm_octree_rule some_rule(const tm_surface *region)
{
    tm_octree_rule rule = {.kind = (tm_octree_rule_kind)random_below(TM_RULE_LEAVES)};
    rule.level = random_below(rule.kind == TM_RULE_BOX ? 6 : 4);
    rule.region = region;
    for (int i = 0; i < 3; i++) {
        rule.low[i] = -1.5 + 3 * random_unit();
        rule.high[i] = rule.low[i] + 0.3 * random_unit();
    }
    return rule;
}

static void test_random_rules(void **state)
{
    (void)state;
    static plain_octree plain;
    tm_error error = {0};
    for (int turn = 0; turn < 25; turn++) {
        tm_surface surface, region;
        make_some_ellipsoid(&surface);
        make_ellipsoid(&region, (double[3]){random_unit(), random_unit(), random_unit()},
                       (double[3]){0.3, 0.4, 0.5});
        tm_octree_rule rule[3];
        const size_t rules = 1 + random_below(3);
        for (size_t r = 0; r < rules; r++)
            rule[r] = some_rule(&region);
        tm_octree octree;
        assert_ok(tm_octree_build(&octree, &surface, rule, rules, &error), &error);
        check(&octree, &surface);
        build_plain(&plain, &octree, &surface, rule, rules);
        assert_same_leaves(&octree, &plain);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
        tm_surface_free(&region);
    }
}

/* Marks few leaves, the more likely the smaller. */
static uint8_t *some_leaves(const tm_octree *octree, unsigned rarely)
{
    uint8_t *split = calloc(octree->leaves, 1);
    assert_non_null(split);
    for (size_t i = 0; i < octree->leaves; i++)
        split[i] = octree->leaf[i].level < 5 && random_below(rarely) == 0;
    return split;
}

static void refine_both(tm_octree *octree, plain_octree *plain, const tm_surface *surface)
{
    tm_error error = {0};
    uint8_t *split = some_leaves(octree, 12);
    plain->leaves = octree->leaves;
    memcpy(plain->leaf, octree->leaf, octree->leaves * sizeof *octree->leaf);
    for (size_t i = 0; i < octree->leaves; i++)
        if (split[i])
            split_plain(plain, i);
    balance_plain(plain);
    assert_ok(tm_octree_refine(octree, surface, split, &error), &error);
    free(split);
    check(octree, surface);
    assert_same_leaves(octree, plain);
}

static void test_random_refinement(void **state)
{
    (void)state;
    static plain_octree plain;
    tm_error error = {0};
    for (int turn = 0; turn < 12; turn++) {
        tm_surface surface;
        make_some_ellipsoid(&surface);
        tm_octree octree;
        const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = random_below(2)};
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        while (octree.leaves < 800)
            refine_both(&octree, &plain, &surface);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
    }
}

static void assert_same(const tm_octree *a, const tm_octree *b)
{
    assert_int_equal(a->leaves, b->leaves);
    assert_int_equal(a->nodes, b->nodes);
    assert_memory_equal(a->low, b->low, sizeof a->low);
    assert_memory_equal(a->roots, b->roots, sizeof a->roots);
    assert_true(a->side == b->side);
    for (size_t i = 0; i < a->leaves; i++) {
        assert_int_equal(compare_leaves(&a->leaf[i], &b->leaf[i]), 0);
        assert_int_equal(a->leaf[i].crossed, b->leaf[i].crossed);
    }
    assert_memory_equal(a->node, b->node, a->leaves * sizeof *a->node);
    assert_memory_equal(a->grid, b->grid, a->nodes * sizeof *a->grid);
}

static void test_listed_leaves(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    make_sphere(&surface);
    const uint32_t list[] = {3, 70, 3, 15};
    tm_octree_rule rule[] = {{.kind = TM_RULE_LEAVES, .leaf = list, .leaves = 2},
                             {.kind = TM_RULE_SURFACE, .level = 3},
                             {.kind = TM_RULE_LEAVES, .leaf = list + 2, .leaves = 2}};
    tm_octree refined, listed;
    assert_ok(tm_octree_build(&refined, &surface, rule + 1, 1, &error), &error);
    uint8_t *split = calloc(refined.leaves, 1);
    assert_non_null(split);
    split[3] = split[15] = split[70] = 1;
    assert_ok(tm_octree_refine(&refined, &surface, split, &error), &error);
    free(split);
    assert_ok(tm_octree_build(&listed, &surface, rule, 3, &error), &error);
    assert_same(&refined, &listed);
    check(&listed, &surface);
    const uint32_t beyond = 100000;
    rule[0] = (tm_octree_rule){.kind = TM_RULE_LEAVES, .leaf = &beyond, .leaves = 1};
    tm_octree none;
    assert_refused(tm_octree_build(&none, &surface, rule, 2, &error), &error,
                   "octant 100000 is not in the octree");
    tm_octree_free(&refined);
    tm_octree_free(&listed);
    tm_surface_free(&surface);
}

/* A point where leaves of the deepest level are, and a level beyond. */
static void test_deepest(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    make_sphere(&surface);
    tm_octree_rule rule = {.kind = TM_RULE_BOX, .level = TM_OCTREE_LEVEL_MAX};
    tm_octree octree;
    assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
    check(&octree, &surface);
    uint8_t *split = calloc(octree.leaves, 1);
    assert_non_null(split);
    for (size_t i = 0; i < octree.leaves; i++)
        split[i] = octree.leaf[i].level == TM_OCTREE_LEVEL_MAX;
    const size_t before = octree.leaves;
    assert_refused(tm_octree_refine(&octree, &surface, split, &error), &error,
                   "cannot be split");
    assert_int_equal(octree.leaves, before);
    free(split);
    tm_octree_free(&octree);
    rule.level++;
    assert_refused(tm_octree_build(&octree, &surface, &rule, 1, &error), &error,
                   "level 18 is too deep");
    tm_surface_free(&surface);
}

/* The brick of an octree. */
static tm_octree brick_only(const tm_octree *octree)
{
    tm_octree brick = {.side = octree->side};
    memcpy(brick.low, octree->low, sizeof brick.low);
    memcpy(brick.roots, octree->roots, sizeof brick.roots);
    return brick;
}

static void build_some(tm_octree *octree, tm_surface *surface)
{
    tm_error error = {0};
    make_some_ellipsoid(surface);
    const tm_octree_rule rule[] = {
        {.kind = TM_RULE_SURFACE, .level = 2},
        {.kind = TM_RULE_BOX, .level = 4, .high = {0.5, 0.5, 0.5}}};
    assert_ok(tm_octree_build(octree, surface, rule, 2, &error), &error);
}

static void test_from_leaves(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    tm_octree octree;
    build_some(&octree, &surface);
    const size_t leaves = octree.leaves;
    tm_leaf *shuffled = malloc(leaves * sizeof *shuffled);
    uint32_t *order;
    assert_non_null(shuffled);
    memcpy(shuffled, octree.leaf, leaves * sizeof *shuffled);
    for (size_t i = leaves; i > 1; i--) {
        const size_t other = random_below((unsigned)i);
        const tm_leaf last = shuffled[i - 1];
        shuffled[i - 1] = shuffled[other];
        shuffled[other] = last;
    }
    tm_octree again = brick_only(&octree);
    assert_ok(tm_octree_from_leaves(&again, shuffled, leaves, &surface, &order, &error),
              &error);
    assert_same(&octree, &again);
    for (size_t i = 0; i < leaves; i++)
        assert_int_equal(compare_leaves(&again.leaf[i], &shuffled[order[i]]), 0);
    tm_octree_free(&again);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
    free(shuffled);
    free(order);
}

static void refuse_leaves(const tm_octree *octree, const tm_leaf *leaf, size_t leaves,
                          const char *part)
{
    tm_error error = {0};
    tm_octree again = brick_only(octree);
    uint32_t *order;
    assert_refused(tm_octree_from_leaves(&again, leaf, leaves, NULL, &order, &error),
                   &error, part);
    assert_null(again.leaf);
    assert_null(order);
}

static void test_wrong_leaves(void **state)
{
    (void)state;
    tm_surface surface;
    tm_octree octree;
    build_some(&octree, &surface);
    const size_t leaves = octree.leaves;
    tm_leaf *leaf = malloc(leaves * sizeof *leaf);
    assert_non_null(leaf);
    memcpy(leaf, octree.leaf, leaves * sizeof *leaf);
    refuse_leaves(&octree, leaf, 0, "no octants");
    leaf[5] = leaf[4];
    refuse_leaves(&octree, leaf, leaves, "octant 5 ");
    leaf[5] = octree.leaf[5];
    leaf[7].anchor[1]++;
    refuse_leaves(&octree, leaf, leaves, "octant 7 ");
    leaf[7] = octree.leaf[7];
    leaf[9].anchor[2] = octree.roots[2] << TM_OCTREE_FINEST;
    refuse_leaves(&octree, leaf, leaves, "outside the roots");
    leaf[9] = octree.leaf[9];
    leaf[9].level = TM_OCTREE_FINEST;
    refuse_leaves(&octree, leaf, leaves, "too deep");
    free(leaf);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
}

/* The octree of the leaves with keep[leaf] != 0. */
static void make_of_kept(const tm_octree *octree, const tm_surface *surface,
                         const uint8_t *keep, tm_octree *again)
{
    tm_error error = {0};
    uint32_t *order;
    size_t kept = 0;
    tm_leaf *leaf = malloc(octree->leaves * sizeof *leaf);
    assert_non_null(leaf);
    for (size_t i = 0; i < octree->leaves; i++)
        if (keep[i])
            leaf[kept++] = octree->leaf[i];
    *again = brick_only(octree);
    assert_ok(tm_octree_from_leaves(again, leaf, kept, surface, &order, &error), &error);
    check(again, surface);
    size_t next = 0;
    for (size_t i = 0; i < again->leaves; i++)
        if (order[i] != TM_NONE) {
            assert_int_equal(order[i], next);
            assert_int_equal(compare_leaves(&again->leaf[i], &leaf[next++]), 0);
        }
    assert_int_equal(next, kept);
    free(order);
    free(leaf);
}

/* Leaves that no rule asks for, or all but a crossed one: they come again as they were.
 */
static void test_missing_leaves(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    tm_octree octree, again;
    make_some_ellipsoid(&surface);
    const tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = 4};
    assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
    uint8_t *keep = malloc(octree.leaves);
    assert_non_null(keep);
    size_t one = octree.leaves;
    for (size_t i = 0; i < octree.leaves; i++) {
        keep[i] = octree.leaf[i].crossed;
        one = keep[i] ? i : one;
    }
    make_of_kept(&octree, &surface, keep, &again);
    assert_same(&octree, &again);
    tm_octree_free(&again);
    memset(keep, 0, octree.leaves);
    keep[one] = 1;
    make_of_kept(&octree, &surface, keep, &again);
    assert_same(&octree, &again);
    tm_octree_free(&again);
    free(keep);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
}

/* Any leaves may be missing, whole roots too: those that are given stay. */
static void test_any_missing_leaves(void **state)
{
    (void)state;
    tm_surface surface;
    tm_octree octree, again;
    build_some(&octree, &surface);
    uint8_t *keep = malloc(octree.leaves);
    assert_non_null(keep);
    for (unsigned of = 2; of < 40; of += 9) {
        for (size_t i = 0; i < octree.leaves; i++)
            keep[i] = random_below(of) == 0;
        keep[0] = 1;
        make_of_kept(&octree, &surface, keep, &again);
        tm_octree_free(&again);
    }
    free(keep);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
}

/* A root that is split twice at one corner, beside one that is not split. */
static void test_unbalanced_leaves(void **state)
{
    (void)state;
    static plain_octree plain;
    plain.leaves = 2;
    plain.leaf[0] = (tm_leaf){.anchor = {(uint32_t)1 << TM_OCTREE_FINEST, 0, 0}};
    plain.leaf[1] = (tm_leaf){.level = 0};
    const tm_octree brick = {.side = 1, .roots = {2, 1, 1}};
    split_plain(&plain, 0);
    split_plain(&plain, 0);
    refuse_leaves(&brick, plain.leaf, plain.leaves, "not balanced");
}

static void write_and_read(const tm_stream *stream, tm_stream *again)
{
    tm_error error = {0};
    char name[] = "/tmp/test_octree_XXXXXX";
    const int fd = mkstemp(name);
    assert_true(fd >= 0);
    assert_ok(tm_stream_write(stream, fd, 1, &error), &error);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    assert_ok(tm_stream_read(again, fd, name, 1, &error), &error);
    close(fd);
    unlink(name);
}

static void test_stream(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_surface surface;
    tm_octree octree, back;
    build_some(&octree, &surface);
    uint32_t *none = calloc(octree.leaves + 1, sizeof *none);
    assert_non_null(none);
    tm_stream stream, again;
    tm_stream_init(&stream);
    tm_stream_init(&again);
    tm_block *node = tm_stream_add(&stream, ".node");
    assert_non_null(node);
    assert_ok(tm_block_allocate(node, 1, 0, &error), &error);
    assert_ok(
        tm_octree_to_stream(&octree, tm_octree_deepest(&octree), none, &stream, &error),
        &error);
    write_and_read(&stream, &again);
    uint32_t *order = NULL;
    assert_ok(tm_octree_read_blocks(&back, &again, &surface, &order, &error), &error);
    assert_same(&octree, &back);
    for (size_t i = 0; i < octree.leaves; i++)
        assert_int_equal(order[i], i);
    tm_octree_free(&back);
    free(order);
    tm_block *root = tm_stream_find(&again, ".root");
    root->real[0] += octree.side / 3;
    assert_int_equal(tm_octree_read_blocks(&back, &again, NULL, &order, &error),
                     octree.roots[0] * octree.roots[1] * octree.roots[2] == 1
                         ? TM_OK
                         : TM_ERROR_INPUT);
    tm_octree_free(&back);
    free(order);
    tm_stream_remove(&again, root);
    assert_refused(tm_octree_read_blocks(&back, &again, NULL, &order, &error), &error,
                   "no octree");
    tm_stream_free(&stream);
    tm_stream_free(&again);
    free(none);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
}

static void allocate_too_much(void *size)
{
    sc_free(sc_package_id, sc_malloc(sc_package_id, *(const size_t *)size));
}

static void find_wrong(void *is_right)
{
    SC_CHECK_ABORT(*(const bool *)is_right, "brick, not octree");
}

/* libsc's abort becomes an error that says what it is; a call after it works. */
static void test_p4est_abort(void **state)
{
    (void)state;
    tm_error error = {0};
    size_t much = PTRDIFF_MAX, little = 8;
    bool wrong = false, right = true;
    for (int again = 0; again < 2; again++) {
        assert_int_equal(tm_p4est_call(allocate_too_much, &much, &error),
                         TM_ERROR_SYSTEM);
        assert_string_equal(error.what, "out of memory");
        assert_int_equal(tm_p4est_call(find_wrong, &wrong, &error), TM_ERROR_SYSTEM);
        assert_string_equal(error.what, "p4est gives up: brick, not octree");
        assert_ok(tm_p4est_call(find_wrong, &right, &error), &error);
        assert_ok(tm_p4est_call(allocate_too_much, &little, &error), &error);
    }
}

static int start_mpi(void **state)
{
    (void)state;
    tm_error error = {0};
    /* What MPI and what it uses are asked for is not the library's to say. */
    static const char variable[] = "HWLOC_COMPONENTS";
    if (unsetenv(variable) != 0 || tm_mpi_start(&error) != TM_OK)
        return -1;
    return getenv(variable) ? -1 : 0;
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_brick),
        cmocka_unit_test(test_brick_of_octants),
        cmocka_unit_test(test_root_only),
        cmocka_unit_test(test_random_rules),
        cmocka_unit_test(test_random_refinement),
        cmocka_unit_test(test_listed_leaves),
        cmocka_unit_test(test_deepest),
        cmocka_unit_test(test_from_leaves),
        cmocka_unit_test(test_wrong_leaves),
        cmocka_unit_test(test_missing_leaves),
        cmocka_unit_test(test_any_missing_leaves),
        cmocka_unit_test(test_unbalanced_leaves),
        cmocka_unit_test(test_stream),
        cmocka_unit_test(test_p4est_abort),
    };
    return cmocka_run_group_tests(tests, start_mpi, NULL);
}
