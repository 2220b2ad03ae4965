/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Elements at tips of the surface, made anew: sharp ones of random solids, and such that
 * are flat. */
#include "../../lib/octree/repair/repair_steps.h"
#include "repair_fixture.h"

enum { FLAT_MOST = 4, FLAT_NODES = 2 * FLAT_MOST + 2 };

/* Sharp corners: none lost, the solid is the same, and the worst is no worse. */
static void check_sharp_corners(tm_polygon_surface *p, unsigned level, double threshold,
                                size_t *made)
{
    tm_error error;
    repair_case c;
    size_t count = 0;
    start_case(&c, p, level);
    const tm_examination first = examine_state(&c.state);
    const tm_repair_score before = measured(&c.state, threshold);
    tm_repair_score after = before;
    tm_repair_state old = copy_elements(&c.state);
    assert_ok(
        tm_repair_sharp_corners(&c.state, &c.surface, threshold, &after, &count, &error),
        &error);
    check_score(&c.state, &after, threshold);
    check_not_worse(&before, &after);
    check_still(&old, &c.state);
    check_state(&c.state, &c.surface, &first);
    assert_int_equal(c.state.divided, count > 0);
    if (count == 0)
        check_same_elements(&old, &c.state);
    *made += count;
    tm_repair_state_free(&old);
    end_case(&c);
}

static void test_sharp_corners(void **unused)
{
    (void)unused;
    static const struct {
        double height; /* of a pyramid; 0: a wedge, which may have nothing to be made */
        unsigned level;
        double threshold;
    } of[] = {{0.5, 2, 0.27}, {3, 2, 0.2}, {3, 2, 0.3}, {3, 3, 0.2}, {0, 2, 0.2}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        tm_polygon_surface p;
        size_t made = 0;
        tm_polygon_surface_init(&p);
        if (of[i].height > 0)
            add_pyramid(&p, of[i].height);
        else
            add_wedge(&p, 2, 1);
        check_sharp_corners(&p, of[i].level, of[i].threshold, &made);
        assert_true(made > 0 || of[i].height == 0);
    }
}

/* A flat tip: three or four quadrilaterals, each nearly a triangle with its largest angle
 * at a neighbour of the tip, and a pyramid from each to a node below. */
typedef struct {
    double xyz[FLAT_NODES][3];
    tm_node_rule rule[FLAT_NODES];
    uint8_t on[FLAT_NODES];
    size_t start[FLAT_MOST + 1];
    uint32_t item[FLAT_MOST * TM_PYRAMID_NODES];
    uint32_t octant[FLAT_MOST], origin[FLAT_MOST];
} flat_tip;

static void copy_to_heap(tm_repair_state *s, const flat_tip *f, size_t faces)
{
    const size_t nodes = 2 * faces + 2;
    s->mesh.nodes = nodes;
    s->mesh.elements = faces;
    tm_error error;
    assert_ok(tm_repair_allocate(s, f->start[faces], &error), &error);
    memcpy(s->mesh.xyz, f->xyz, nodes * sizeof *f->xyz);
    memcpy(s->rule, f->rule, nodes * sizeof *f->rule);
    memcpy(s->on, f->on, nodes);
    memcpy(s->mesh.start, f->start, (faces + 1) * sizeof *f->start);
    memcpy(s->mesh.item, f->item, f->start[faces] * sizeof *f->item);
    memcpy(s->octant, f->octant, faces * sizeof *f->octant);
    memcpy(s->origin, f->origin, faces * sizeof *f->origin);
}

/* Nodes: the tip, its neighbours, those between them, and that below. */
static void make_flat_tip(tm_repair_state *s, size_t faces)
{
    flat_tip f = {.start = {0}};
    const double pi = acos(-1), turn = random_between(0, 2 * pi);
    for (size_t i = 0; i < faces; i++) {
        const double at = turn + 2 * pi * (double)i / (double)faces;
        const double on = at + random_between(0.01, 0.03), far = 1.6;
        memcpy(f.xyz[1 + i], (double[]){cos(at), sin(at), 0}, sizeof *f.xyz);
        memcpy(f.xyz[1 + faces + i], (double[]){far * cos(on), far * sin(on), 0},
               sizeof *f.xyz);
    }
    for (uint32_t i = 0; i < faces; i++) {
        const uint32_t n = (uint32_t)faces, next = (i + 1) % n;
        const uint32_t item[] = {0, 1 + next, 1 + n + i, 1 + i, 2 * n + 1};
        memcpy(f.item + f.start[i], item, sizeof item);
        f.start[i + 1] = f.start[i] + TM_PYRAMID_NODES;
        f.origin[i] = i;
    }
    for (size_t v = 0; v <= 2 * faces + 1; v++) {
        f.on[v] = v <= 2 * faces ? TM_NODE_ON_PATCH : TM_NODE_INSIDE;
        f.rule[v] = (tm_node_rule){
            .where = TM_NONE, .freedom = v <= 2 * faces ? TM_MOVES_NOT : TM_MOVES_FREELY};
    }
    f.xyz[2 * faces + 1][2] = -random_between(0.7, 1);
    copy_to_heap(s, &f, faces);
}

/* One element on all of such a tip would be flat: its faces are cut, and it is good. */
static void test_flat_tips(void **unused)
{
    (void)unused;
    for (size_t faces = 3; faces <= FLAT_MOST; faces++) {
        const double threshold = 0.1;
        tm_error error;
        size_t count = 0;
        tm_repair_state s = {.divided = false};
        make_flat_tip(&s, faces);
        const tm_repair_score before = measured(&s, threshold);
        assert_int_equal(before.invalid, 0);
        assert_int_equal(before.bad, faces);
        tm_repair_state old = copy_elements(&s);
        tm_repair_score after = before;
        assert_ok(tm_repair_sharp_corners(&s, NULL, threshold, &after, &count, &error),
                  &error);
        check_score(&s, &after, threshold);
        check_still(&old, &s);
        assert_int_equal(count, 1);
        assert_int_equal(after.bad, 0);
        assert_int_equal(s.mesh.elements, 2 * faces);
        tm_repair_state_free(&old);
        tm_repair_state_free(&s);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat_tips),
        cmocka_unit_test(test_sharp_corners),
    };
    return cmocka_run_group_tests(tests, start_mpi, NULL);
}
