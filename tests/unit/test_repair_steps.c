/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each step of the repair alone, on random solids: all that it promises, before and
 * after; and the rule that decides what is kept. */
#include "../../lib/mesh/mixed_boundary.h"
#include "../../lib/octree/repair/repair_forced.h"
#include "../../lib/octree/repair/repair_shape.h"
#include "../../lib/octree/repair/repair_steps.h"
#include "../../lib/octree/repair/element_division.h"
#include "../../lib/octree/forest/mpi_start.h"
#include "repair_fixture.h"

enum { ROUNDS = 8 };

/* Nodes move: nothing else is other, and nothing is worse. */
static void test_move(void **unused)
{
    (void)unused;
    size_t mended = 0, brought = 0;
    for (int round = 0; round < ROUNDS; round++) {
        tm_error error;
        repair_case c;
        start_random_case(&c);
        damage(&c, random_below(4), 1 + random_below(3));
        const double threshold = random_below(2) ? 0 : random_between(0, 0.4);
        const tm_examination first = examine_state(&c.state);
        tm_repair_state old = copy_elements(&c.state);
        const tm_repair_score before = measured(&c.state, threshold);
        tm_repair_score after = before;
        const tm_repair_effort effort = {
            random_below(3), random_between(0, 0.3),
            random_below(4) ? 1.0 / (1 << random_below(4)) : 0, 10000, 100000};
        assert_ok(tm_repair_move(&c.state, &c.surface, threshold, effort, &after, &error),
                  &error);
        assert_true(effort.share > 0 || after.off_surface == before.off_surface);
        check_score(&c.state, &after, threshold);
        check_not_worse(&before, &after);
        check_same_elements(&old, &c.state);
        check_still(&old, &c.state);
        check_state(&c.state, &c.surface, &first);
        mended += after.invalid < before.invalid;
        brought += after.off_surface < before.off_surface;
        tm_repair_state_free(&old);
        end_case(&c);
    }
    assert_true(mended > 0);
    assert_true(brought > 0);
}

/* Whether a node that leaves its place by so much along y makes nothing better. */
static bool gains_nothing(tm_repair_state *s, size_t node, double off)
{
    const tm_repair_score before = measured(s, 0.2);
    const double y = s->mesh.xyz[node][1];
    s->mesh.xyz[node][1] += off;
    const tm_repair_score after = measured(s, 0.2);
    s->mesh.xyz[node][1] = y;
    return !tm_repair_better(&after, &before);
}

/* Two places of a mesh of a cube: in one a node is off its place, and comes to it; in the
 * other one leaves it. */
static void test_take_back(void **unused)
{
    (void)unused;
    tm_error error;
    tm_polygon_surface p;
    repair_case c;
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 1);
    start_case(&c, &p, 4);
    tm_repair_state *s = &c.state;
    size_t first = 0, second = SIZE_MAX;
    while (s->rule[first].freedom != TM_MOVES_FREELY)
        first++;
    const double off = random_between(0.03, 0.05);
    double farthest = 0;
    for (size_t v = 0; v < s->mesh.nodes; v++) {
        double distance2 = tm_distance2(s->mesh.xyz[first], s->mesh.xyz[v]);
        if (s->rule[v].freedom != TM_MOVES_FREELY || distance2 <= farthest ||
            !gains_nothing(s, v, off))
            continue;
        farthest = distance2;
        second = v;
    }
    assert_true(second < SIZE_MAX);
    double place[2][3];
    memcpy(place[0], s->mesh.xyz[first], sizeof place[0]);
    memcpy(place[1], s->mesh.xyz[second], sizeof place[1]);
    s->mesh.xyz[first][0] += off;
    const tm_repair_score before = measured(s, 0.2);
    tm_repair_points points = {0};
    assert_ok(tm_repair_save(&points, s, &error), &error);
    memcpy(s->mesh.xyz[first], place[0], sizeof place[0]);
    s->mesh.xyz[second][1] += off;
    assert_ok(tm_repair_take_back(s, &points, 0.2, before.worst, &error), &error);
    assert_memory_equal(s->mesh.xyz[first], place[0], sizeof place[0]);
    assert_memory_equal(s->mesh.xyz[second], place[1], sizeof place[1]);
    const tm_repair_score after = measured(s, 0.2);
    assert_true(tm_repair_better(&after, &before));
    tm_repair_points_free(&points);
    end_case(&c);
}

/* What a mesh keeps of its surface. */
static void test_shape(void **unused)
{
    (void)unused;
    tm_error error;
    tm_polygon_surface p;
    repair_case c;
    tm_repair_shape whole, less;
    tm_polygon_surface_init(&p);
    const double side = random_between(0.5, 2), low[3] = {0, 0, 0},
                 high[3] = {side, side, side};
    add_box(&p, low, high, false);
    start_case(&c, &p, 3);
    assert_ok(tm_repair_shape_measure(&whole, &c.state, &c.surface, &error), &error);
    assert_int_equal(whole.corners, 8);
    assert_true(fabs(whole.curves - 12 * side) < 1e-9);
    assert_true(fabs(whole.volume - side * side * side) < 1e-9);
    assert_int_equal(whole.defects, 0);
    assert_int_equal(whole.components, 1);
    assert_int_equal(whole.euler, 2);
    tm_surface_comparison apart;
    assert_ok(tm_repair_shape_compare(&apart, &c.state, &(tm_mixed_regions){0},
                                      &c.surface, 40, &error),
              &error);
    for (int way = 0; way < TM_WAYS; way++) {
        assert_true(apart.surface[way].most < 1e-9);
        assert_true(apart.curve[way].most < 1e-9);
        assert_int_equal(apart.corner[way].parts, 8);
    }
    assert_true(tm_repair_shape_keeps(&whole, &whole, &c.surface));
    for (int what = 0; what < 6; what++) {
        less = whole;
        less.corners -= what == 0;
        less.curves *= what == 1 ? 0.98 : 1;
        less.defects += what == 2;
        less.components += what == 3;
        less.euler -= what == 4 ? 2 : 0;
        less.volume *= what == 5 ? 0.99 : 1;
        assert_false(tm_repair_shape_keeps(&less, &whole, &c.surface));
        assert_true(tm_repair_shape_keeps(&whole, &less, &c.surface));
    }
    /* A node of a sharp edge that is off it. */
    for (size_t v = 0, done = 0; v < c.state.mesh.nodes && !done; v++)
        if (c.state.on[v] == TM_NODE_ON_CURVE)
            done = c.state.rule[v].off_surface = true;
    assert_ok(tm_repair_shape_measure(&less, &c.state, &c.surface, &error), &error);
    assert_true(less.curves < whole.curves);
    end_case(&c);
}

/* A case whose boundary may not move: what is bad is to be divided. */
static void fix_boundary(repair_case *c)
{
    for (size_t v = 0; v < c->state.mesh.nodes; v++)
        if (c->state.on[v] != TM_NODE_INSIDE)
            c->state.rule[v] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_NOT};
}

/* Parts of an element have its octant; together they are what it was. */
static void check_parts(const tm_repair_state *old, const uint32_t *octant,
                        const tm_repair_state *now)
{
    for (size_t e = 0; e < now->mesh.elements; e++) {
        assert_true(now->origin[e] < old->mesh.elements);
        assert_int_equal(now->octant[e], octant[now->origin[e]]);
    }
    for (size_t o = 0, e = 0; o < old->mesh.elements; o++) {
        size_t parts = 0;
        for (; e < now->mesh.elements && now->origin[e] == o; e++)
            parts++;
        assert_true(parts > 0);
    }
}

static void test_divide(void **unused)
{
    (void)unused;
    size_t divided = 0;
    for (int round = 0; round < 2 * ROUNDS; round++) {
        tm_error error;
        repair_case c;
        size_t count = 0;
        start_random_case(&c);
        const bool fixed =
            random_below(2) && tm_repair_measure(&c.state, 0).off_surface == 0;
        if (fixed)
            fix_boundary(&c);
        damage(&c, random_below(3), 0);
        const double threshold = random_between(0, 0.5);
        const tm_examination first = examine_state(&c.state);
        tm_repair_state old = copy_elements(&c.state);
        uint32_t *octant = malloc(old.mesh.elements * sizeof *octant);
        memcpy(octant, c.state.octant, old.mesh.elements * sizeof *octant);
        const tm_repair_score before = measured(&c.state, threshold);
        tm_repair_score after = before;
        assert_ok(tm_repair_divide(&c.state, fixed ? NULL : &c.surface, threshold, &after,
                                   &count, &error),
                  &error);
        check_score(&c.state, &after, threshold);
        check_not_worse(&before, &after);
        check_still(&old, &c.state);
        assert_int_equal(c.state.divided, count > 0);
        assert_int_equal(c.state.mesh.nodes, old.mesh.nodes + count);
        if (count == 0)
            check_same_elements(&old, &c.state);
        if (fixed) {
            for (size_t v = 0; v < old.mesh.nodes; v++) /* for check_state() */
                c.state.rule[v].freedom =
                    old.on[v] == TM_NODE_INSIDE ? TM_MOVES_FREELY : TM_MOVES_NOT;
        }
        check_parts(&old, octant, &c.state);
        check_state(&c.state, &c.surface, &first);
        divided += count;
        free(octant);
        tm_repair_state_free(&old);
        end_case(&c);
    }
    assert_true(divided > 0);
}

/* Octants around some: they, and those that share a node with one of their elements. */
static void test_octants(void **unused)
{
    (void)unused;
    tm_error error;
    repair_case c;
    start_random_case(&c);
    damage(&c, 3, 2);
    const tm_repair_state *s = &c.state;
    for (int off_surface = 0; off_surface < 2; off_surface++) {
        uint32_t *octant;
        size_t count, wide;
        assert_ok(
            tm_repair_bad_octants(s, 0.2, off_surface, NULL, &octant, &count, &error),
            &error);
        uint8_t *is_listed = calloc(s->octree.leaves, 1);
        bool *near = calloc(s->mesh.nodes, sizeof *near);
        for (size_t i = 0; i < count; i++)
            is_listed[octant[i]] = 1;
        for (size_t e = 0; e < s->mesh.elements; e++) {
            bool bad = tm_repair_is_bad(&s->mesh, e, tm_mixed_jens(&s->mesh, e), 0.2);
            for (size_t i = s->mesh.start[e]; i < s->mesh.start[e + 1]; i++) {
                bad |= off_surface && s->rule[s->mesh.item[i]].off_surface;
                near[s->mesh.item[i]] |= is_listed[s->octant[e]];
            }
            assert_true(!bad || is_listed[s->octant[e]]);
        }
        wide = count;
        assert_ok(tm_repair_widen(s, &octant, &wide, &error), &error);
        assert_true(wide >= count);
        memset(is_listed, 0, s->octree.leaves);
        for (size_t i = 0; i < wide; i++) {
            assert_true(i == 0 || octant[i] > octant[i - 1]);
            is_listed[octant[i]] = 1;
        }
        for (size_t e = 0; e < s->mesh.elements; e++)
            for (size_t i = s->mesh.start[e]; i < s->mesh.start[e + 1]; i++)
                assert_true(!near[s->mesh.item[i]] || is_listed[s->octant[e]]);
        free(is_listed);
        free(near);
        free(octant);
    }
    end_case(&c);
}

/* Octants are split, and the mesh is one of the finer octree. */
static void test_remake(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        tm_error error;
        repair_case c;
        tm_repair_state made = {0};
        uint32_t octant[1];
        start_random_case(&c);
        const size_t e = random_below((unsigned)c.state.mesh.elements);
        octant[0] = c.state.octant[e];
        const tm_examination first = examine_state(&c.state);
        assert_ok(tm_repair_remake(&made, &c.state, &c.surface, octant, 1, true, &error),
                  &error);
        assert_true(made.remade);
        assert_true(made.octree.leaves >= c.state.octree.leaves + 7);
        for (size_t l = 0; l < made.octree.leaves; l++)
            assert_int_equal(made.row[l], l);
        for (size_t i = 0; i < made.mesh.elements; i++)
            assert_int_equal(made.origin[i], i);
        const tm_examination now = examine_state(&made);
        check_state(&made, &c.surface, &now);
        assert_int_equal(now.components, first.components);
        check_state(&c.state, &c.surface, &first);
        tm_repair_state_free(&made);
        end_case(&c);
    }
}

/* A cube with a pyramid on each side: leaves inside do not reach the tips. */
static void add_pyramids(tm_polygon_surface *p)
{
    static const uint32_t side[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    uint32_t node[8];
    for (unsigned i = 0; i < 8; i++)
        node[i] = add_node(p, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (size_t f = 0; f < 6; f++) {
        const double sign = f % 2 ? 4 : -4;
        const uint32_t tip = add_node(p, f / 2 == 0 ? sign : 0, f / 2 == 1 ? sign : 0,
                                      f / 2 == 2 ? sign : 0);
        for (size_t i = 0; i < 4; i++)
            add_triangle(p, node[side[f][i]], node[side[f][(i + 1) % 4]], tip);
    }
}

static size_t count_on(const tm_repair_state *s, uint8_t place)
{
    size_t count = 0;
    for (size_t v = 0; v < s->mesh.nodes; v++)
        count += s->on[v] == place;
    return count;
}

/* Octants are split near tips that reach out of them: corners and sharp edges stay. */
static void test_remake_tips(void **unused)
{
    (void)unused;
    tm_error error;
    tm_polygon_surface p;
    repair_case c;
    tm_repair_state made = {0};
    uint32_t *octant;
    size_t count;
    tm_polygon_surface_init(&p);
    add_pyramids(&p);
    start_case(&c, &p, 4);
    assert_int_equal(count_on(&c.state, TM_NODE_ON_CORNER), c.surface.corners);
    assert_ok(tm_repair_bad_octants(&c.state, 0.25, false, NULL, &octant, &count, &error),
              &error);
    assert_true(count > 0);
    assert_ok(tm_repair_remake(&made, &c.state, &c.surface, octant, count, true, &error),
              &error);
    assert_int_equal(count_on(&made, TM_NODE_ON_CORNER), c.surface.corners);
    assert_true(count_on(&made, TM_NODE_ON_CURVE) >=
                count_on(&c.state, TM_NODE_ON_CURVE));
    free(octant);
    tm_repair_state_free(&made);
    end_case(&c);
}

static void make_hexahedron(double xyz[8][3], double by)
{
    static const double cube[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                      {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (int v = 0; v < 8; v++)
        for (int i = 0; i < 3; i++)
            xyz[v][i] = cube[v][i] + by * (2 * random_unit() - 1);
}

/* A hexahedron whose corners are better than that, but that is inverted inside. */
static void find_uncertified(tm_mixed_mesh *mesh, double least)
{
    enum { TRIES = 10000000 };
    for (int i = 0; i < TRIES; i++) {
        make_hexahedron(mesh->xyz, 0.8);
        if (tm_mixed_jens(mesh, 0) > least &&
            tm_certify(8, (const double(*)[3])mesh->xyz, mesh->item) != TM_POSITIVE)
            return;
    }
    fail_msg("no such hexahedron");
}

typedef struct {
    double xyz[8][3];
    size_t start[2];
    uint32_t item[8];
    tm_node_rule rule[8];
    uint8_t on[8];
    uint32_t octant[1], origin[1];
} hexahedron;

static tm_repair_state state_of(hexahedron *h)
{
    for (uint32_t i = 0; i < 8; i++) {
        h->item[i] = i;
        h->rule[i] = (tm_node_rule){.where = TM_NONE, .freedom = TM_MOVES_NOT};
        h->on[i] = TM_NODE_ON_PATCH;
    }
    h->start[0] = 0;
    h->start[1] = 8;
    h->octant[0] = h->origin[0] = 0;
    return (tm_repair_state){.mesh = {.nodes = 8,
                                      .xyz = h->xyz,
                                      .elements = 1,
                                      .start = h->start,
                                      .item = h->item},
                             .rule = h->rule,
                             .on = h->on,
                             .octant = h->octant,
                             .origin = h->origin};
}

/* An element that is not valid inside counts as 0, but what is good stays so: it may
 * become lower ones that are valid only where nothing else helps. */
static void test_uncertified(void **unused)
{
    (void)unused;
    hexahedron h;
    const tm_repair_state s = state_of(&h);
    tm_mixed_mesh mesh = s.mesh;
    find_uncertified(&mesh, 0.02);
    tm_repair_score score = measured(&s, 0.01);
    assert_int_equal(score.invalid, 1);
    assert_int_equal(score.bad, 1);
    assert_true(score.worst > 0.02);
    assert_true(score.least == 0);
    const tm_repair_score valid = {.bad = 1, .worst = 0.02, .least = 0.02, .good = 0.2};
    assert_false(tm_repair_better(&valid, &score));
    score.valid = TM_REPAIR_FLAT;
    assert_true(tm_repair_better(&valid, &score));
    assert_false(tm_repair_better(&score, &valid));
}

/* Puts a hexahedron into a mesh, with nodes of its own that do not move. */
static void add_hexahedron(tm_repair_state *s, const tm_repair_state *one)
{
    tm_error error;
    tm_repair_state old = *s;
    const size_t nodes = old.mesh.nodes, items = old.mesh.start[old.mesh.elements];
    s->mesh.nodes += 8;
    s->mesh.elements += 1;
    assert_ok(tm_repair_allocate(s, items + 8, &error), &error);
    memcpy(s->mesh.xyz, old.mesh.xyz, nodes * sizeof *s->mesh.xyz);
    memcpy(s->mesh.xyz + nodes, one->mesh.xyz, 8 * sizeof *s->mesh.xyz);
    memcpy(s->mesh.start, old.mesh.start, s->mesh.elements * sizeof *s->mesh.start);
    s->mesh.start[s->mesh.elements] = items + 8;
    memcpy(s->mesh.item, old.mesh.item, items * sizeof *s->mesh.item);
    memcpy(s->rule, old.rule, nodes * sizeof *s->rule);
    memcpy(s->on, old.on, nodes * sizeof *s->on);
    memcpy(s->octant, old.octant, old.mesh.elements * sizeof *s->octant);
    memcpy(s->origin, old.origin, old.mesh.elements * sizeof *s->origin);
    s->octant[old.mesh.elements] = TM_NONE;
    s->origin[old.mesh.elements] = (uint32_t)old.mesh.elements;
    for (uint32_t i = 0; i < 8; i++) {
        s->mesh.item[items + i] = (uint32_t)nodes + i;
        s->rule[nodes + i] = one->rule[i];
        s->on[nodes + i] = one->on[i];
    }
    old.octree = (tm_octree){.leaves = 0};
    old.row = old.id = NULL;
    tm_repair_state_free(&old);
}

/* Where an element is not valid inside, others are worth no less for it. */
static void test_uncertified_elsewhere(void **unused)
{
    (void)unused;
    size_t brought = 0;
    for (int round = 0; round < 2 * ROUNDS; round++) {
        tm_error error;
        repair_case c;
        hexahedron h;
        const tm_repair_state one = state_of(&h);
        tm_mixed_mesh mesh = one.mesh;
        find_uncertified(&mesh, 0.2);
        start_random_case(&c);
        damage(&c, 0, 10 + random_below(10));
        add_hexahedron(&c.state, &one);
        const double threshold = random_between(0, 0.3);
        const tm_repair_score before = measured(&c.state, threshold);
        tm_repair_score after = before;
        const tm_repair_effort effort = {random_below(3), TM_REPAIR_GOOD, 0x1p-4, 10000,
                                         100000};
        assert_ok(tm_repair_move(&c.state, &c.surface, threshold, effort, &after, &error),
                  &error);
        check_score(&c.state, &after, threshold);
        check_not_worse(&before, &after);
        brought += before.off_surface - after.off_surface;
        end_case(&c);
    }
    assert_true(brought > 0);
}

/* Less than 1e-6 is not valid, whatever the threshold, in every function that says so. */
static void test_least(void **unused)
{
    (void)unused;
    for (int tenth = 0; tenth < 2; tenth++) {
        hexahedron h;
        tm_repair_state s = state_of(&h);
        make_hexahedron(h.xyz, 0);
        h.start[1] = 4; /* the tetrahedron of corners 0, 1, 3 and 4 */
        h.item[2] = 3;
        h.item[3] = 4;
        h.xyz[4][2] = 1e-8;
        const double threshold = tenth / 10.0;
        const double jens = tm_mixed_jens(&s.mesh, 0);
        assert_true(jens > 0 && jens < TM_REPAIR_LEAST);
        assert_int_equal(measured(&s, threshold).invalid, 1);
        assert_true(tm_repair_is_bad(&s.mesh, 0, jens, threshold));
        h.xyz[4][2] = 1e-3;
        assert_int_equal(measured(&s, threshold).invalid, 0);
        assert_int_equal(
            tm_repair_is_bad(&s.mesh, 0, tm_mixed_jens(&s.mesh, 0), threshold), tenth);
    }
}

/* A tetrahedron with an angle at the edge from node 0 to node 1, and one with its tip at
 * node 0: what it is forced to be. */
static void test_forced(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        hexahedron h;
        tm_error error;
        bool forced[1];
        size_t count;
        tm_repair_state s = state_of(&h);
        const double angle = random_between(0.01, 0.5), cut = random_between(0.3, 0.6);
        const double xyz[4][3] = {
            {0, 0, 0}, {0, 1, 0}, {1, cut, 0}, {cos(angle), 1 - cut, sin(angle)}};
        memcpy(h.xyz, xyz, sizeof xyz);
        h.start[1] = 4;
        if (tm_mixed_jens(&s.mesh, 0) < 0) {
            h.item[2] = 3;
            h.item[3] = 2;
        }
        const double limit = sqrt(2) * sin(angle), jens = tm_mixed_jens(&s.mesh, 0);
        assert_true(jens > 0 && jens <= limit + 1e-12);
        for (int sharp = 0; sharp < 2; sharp++)
            for (int t = 0; t < 3; t++) {
                const double threshold[] = {jens * 0.99, (jens + limit) / 2,
                                            limit * 1.01};
                s.on[0] = s.on[1] = sharp ? TM_NODE_ON_CURVE : TM_NODE_ON_PATCH;
                assert_ok(tm_repair_find_forced(&s, threshold[t], forced, &count, &error),
                          &error);
                assert_int_equal(count, sharp && t == 2 && jens >= limit / 2);
                assert_int_equal(forced[0], count);
            }
        /* Along sharp edges the corner's own J_ENS is all that there can be. */
        s.on[0] = TM_NODE_ON_CORNER;
        s.on[2] = s.on[3] = TM_NODE_ON_CURVE;
        assert_ok(tm_repair_find_forced(&s, 1, forced, &count, &error), &error);
        assert_int_equal(count, 1);
    }
}

/* All pairs of scores: never better both ways, never where one thing is worse. */
/* A mesh that takes another's place has its octants, with their ids. */
static void test_take_mesh(void **unused)
{
    (void)unused;
    repair_case c;
    tm_error error;
    tm_repair_state copy = {0};
    start_random_case(&c);
    tm_repair_state *s = &c.state;
    const tm_leaf *leaf = s->octree.leaf;
    uint32_t *id = calloc(s->octree.leaves + 1, sizeof *id);
    free(s->id);
    s->id = id;
    assert_int_equal(tm_repair_copy_mesh(&copy, s, &error), TM_OK);
    const double(*xyz)[3] = (const double(*)[3])copy.mesh.xyz;
    tm_repair_take_mesh(s, &copy);
    assert_ptr_equal(s->mesh.xyz, xyz);
    assert_ptr_equal(s->octree.leaf, leaf);
    assert_ptr_equal(s->id, id);
    assert_null(copy.mesh.xyz);
    end_case(&c);
}

static void test_better(void **unused)
{
    (void)unused;
    enum { SCORES = 40 };
    tm_repair_score s[SCORES];
    const double threshold = 0.2;
    for (int i = 0; i < SCORES; i++) {
        s[i] = (tm_repair_score){.invalid = random_below(2),
                                 .off_surface = random_below(2),
                                 .worst = random_between(0, 0.4)};
        s[i].bad = s[i].invalid + random_below(2);
        s[i].least = s[i].invalid ? 0 : s[i].worst;
        s[i].good = threshold;
        s[i].valid = random_below(2) ? TM_REPAIR_FLAT : TM_REPAIR_GOOD;
    }
    for (int i = 0; i < SCORES; i++)
        for (int j = 0; j < SCORES; j++) {
            const bool better = tm_repair_better(&s[i], &s[j]);
            assert_false(better && tm_repair_better(&s[j], &s[i]));
            if (better)
                check_not_worse(&s[j], &s[i]);
            const bool other = s[i].off_surface != s[j].off_surface ||
                               s[i].bad != s[j].bad || s[i].least > s[j].least;
            if (s[i].invalid == s[j].invalid && s[i].off_surface <= s[j].off_surface &&
                s[i].bad <= s[j].bad && s[i].worst >= fmin(s[j].worst, threshold))
                assert_int_equal(better, other);
        }
    const tm_repair_score few = {.bad = 1, .worst = 1e-15, .least = 1e-15, .good = 0.2};
    const tm_repair_score many = {.bad = 9, .worst = 0.18, .least = 0.18, .good = 0.2};
    assert_false(tm_repair_better(&few, &many));
    tm_repair_score held = many;
    held.off_surface = 2;
    assert_false(tm_repair_better(&few, &held));
    assert_true(tm_repair_better(&many, &held));
}

/* Parts of an element fill it, whichever faces may be cut. */
static void test_star(void **unused)
{
    (void)unused;
    size_t cut = 0;
    for (int round = 0; round < 4 * ROUNDS; round++) {
        hexahedron h;
        const tm_repair_state s = state_of(&h);
        tm_error error;
        tm_division star;
        make_hexahedron(h.xyz, random_between(0, 0.4));
        const unsigned open = random_below(64);
        assert_ok(tm_division_find(&star, &s.mesh, 0, open, 0.3, &error), &error);
        assert_in_range(star.parts, 6, TM_DIVISION_PARTS);
        double xyz[9][3];
        memcpy(xyz, h.xyz, sizeof h.xyz);
        memcpy(xyz[8], star.middle, sizeof star.middle);
        double worst = 1;
        for (size_t i = 0; i < star.start[star.parts]; i++)
            if (star.item[i] == TM_NONE)
                star.item[i] = 8;
        for (size_t p = 0; p < star.parts; p++)
            worst =
                fmin(worst, tm_jens(star.start[p + 1] - star.start[p],
                                    (const double(*)[3])xyz, star.item + star.start[p]));
        assert_true(worst == star.worst);
        const tm_mesh_view view = {.nodes = 9,
                                   .xyz = (const double(*)[3])xyz,
                                   .elements = star.parts,
                                   .start = star.start,
                                   .item = star.item};
        tm_examination found;
        assert_ok(tm_element_examine(&found, &view, 1, &error), &error);
        assert_true(worst <= 0 || tm_examination_is_good(&found));
        assert_int_equal(found.boundary_faces, star.parts);
        cut += star.parts > 6;
        assert_true(open != 0 || star.parts == 6);
    }
    assert_true(cut > 0);
}

/* Rules from coordinates alone are those from the attribute of nodes. */
static void test_rules(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        tm_error error;
        repair_case c;
        start_random_case(&c);
        tm_repair_state *s = &c.state;
        bool *where = calloc(s->mesh.nodes, sizeof *where);
        tm_node_rule *rule = calloc(s->mesh.nodes, sizeof *rule);
        uint8_t *on = calloc(s->mesh.nodes, 1);
        for (size_t v = 0; v < s->mesh.nodes; v++)
            where[v] = s->on[v] != TM_NODE_INSIDE;
        assert_ok(tm_repair_find_rules(&c.surface, s->mesh.nodes,
                                       (const double(*)[3])s->mesh.xyz, NULL, where, rule,
                                       on, &error),
                  &error);
        for (size_t v = 0; v < s->mesh.nodes; v++) {
            if (s->rule[v].off_surface)
                continue;
            assert_int_equal(on[v] == TM_NODE_INSIDE, s->on[v] == TM_NODE_INSIDE);
            assert_true(on[v] >= s->on[v]);
            assert_int_equal(rule[v].off_surface, false);
            if (on[v] == s->on[v])
                assert_int_equal(rule[v].freedom, s->rule[v].freedom);
        }
        uint32_t *face;
        size_t faces;
        assert_ok(tm_mixed_boundary_faces(&s->mesh, &face, &faces, &error), &error);
        assert_int_equal(faces, examine_state(s).boundary_faces);
        free(face);
        free(where);
        free(rule);
        free(on);
        end_case(&c);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_least),
        cmocka_unit_test(test_uncertified),
        cmocka_unit_test(test_uncertified_elsewhere),
        cmocka_unit_test(test_better),
        cmocka_unit_test(test_take_mesh),
        cmocka_unit_test(test_forced),
        cmocka_unit_test(test_star),
        cmocka_unit_test(test_rules),
        cmocka_unit_test(test_move),
        cmocka_unit_test(test_divide),
        cmocka_unit_test(test_take_back),
        cmocka_unit_test(test_shape),
        cmocka_unit_test(test_octants),
        cmocka_unit_test(test_remake),
        cmocka_unit_test(test_remake_tips),
    };
    return cmocka_run_group_tests(tests, start_mpi, NULL);
}
