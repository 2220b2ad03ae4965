/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of random solids for the repair, damaged or not, and what is true of its states
 * whatever was done to them. */
#ifndef TESTS_UNIT_REPAIR_FIXTURE_H
#define TESTS_UNIT_REPAIR_FIXTURE_H

#include "../../lib/element/certify.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/octree/forest/mpi_start.h"
#include "../../lib/octree/layer/octree_mesh.h"
#include "../../lib/octree/layer/octree_mesh_stream.h"
#include "../../lib/octree/repair/repair_boundary.h"
#include "../../lib/octree/repair/repair_state.h"
#include "../../lib/octree/repair/repair_stream.h"
#include "octree_fixture.h"

#include <stdlib.h>
#include <string.h>

typedef struct repair_case {
    tm_surface surface;
    tm_stream stream;
    tm_repair_notes notes;
    tm_repair_state state;
} repair_case;

/* Of an octree of the surface with leaves of a level at it, or where none of these is
 * inside the first finer one of which some are; facets have markers. */
static inline void start_case(repair_case *c, tm_polygon_surface *p, unsigned level)
{
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE,
                                        .unless_rough = true};
    tm_octree_rule rule = {.kind = TM_RULE_SURFACE, .level = level};
    tm_status status;
    tm_error error;
    tm_surface surface;
    tm_octree octree;
    tm_octree_mesh mesh;
    p->has_facet_markers = true;
    for (size_t f = 0; f < p->facets; f++)
        p->facet_marker[f] = (int32_t)f + 1;
    assert_ok(tm_surface_build(&surface, p, &options, &error), &error);
    assert_ok(tm_surface_build(&c->surface, p, &options, &error), &error);
    for (;; rule.level++) {
        assert_ok(tm_octree_build(&octree, &surface, &rule, 1, &error), &error);
        status = tm_octree_mesh_make(&mesh, &octree, &surface, NULL, &error);
        if (status != TM_ERROR_INPUT || rule.level > level + 2)
            break;
        tm_octree_mesh_free(&mesh);
        tm_octree_free(&octree);
    }
    assert_ok(status, &error);
    tm_stream_init(&c->stream);
    assert_ok(
        tm_octree_mesh_to_stream(&mesh, &octree, &surface, true, &c->stream, &error),
        &error);
    assert_ok(tm_repair_from_stream(&c->state, &c->stream, &error), &error);
    assert_ok(tm_repair_prepare(&c->state, &c->stream, &c->surface, &c->notes, &error),
              &error);
    assert_true(c->notes.attributed);
    assert_string_equal(c->notes.no_octree.what, "");
    tm_octree_mesh_free(&mesh);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
    tm_polygon_surface_free(p);
}

static inline void end_case(repair_case *c)
{
    tm_repair_state_free(&c->state);
    tm_stream_free(&c->stream);
    tm_surface_free(&c->surface);
}

/* Solids with sharp corners: a pyramid, the corner of a cube, a wedge. */
static inline void add_pyramid(tm_polygon_surface *p, double height)
{
    const uint32_t a = add_node(p, 0, 0, 0), b = add_node(p, 1, 0, 0),
                   c = add_node(p, 1, 1, 0), d = add_node(p, 0, 1, 0),
                   top = add_node(p, 0.5, 0.5, height);
    add_polygon(p, (const uint32_t[]){a, d, c, b}, 4);
    add_triangle(p, a, b, top);
    add_triangle(p, b, c, top);
    add_triangle(p, c, d, top);
    add_triangle(p, d, a, top);
}

static inline void add_cube_corner(tm_polygon_surface *p)
{
    const uint32_t a = add_node(p, 0, 0, 0), b = add_node(p, 1, 0, 0),
                   c = add_node(p, 0, 1, 0), d = add_node(p, 0, 0, 1);
    add_triangle(p, a, c, b);
    add_triangle(p, a, b, d);
    add_triangle(p, a, d, c);
    add_triangle(p, b, c, d);
}

static inline void add_wedge(tm_polygon_surface *p, double length, double height)
{
    const double outline[3][2] = {{0, 0}, {length, 0}, {0, 1}};
    add_prism(p, outline, 3, height);
}

static inline void add_random_solid(tm_polygon_surface *p)
{
    enum { KINDS = 6 };
    const double low[3] = {0, 0, 0}, high[3] = {1, random_between(0.5, 2), 1};
    double width;
    switch (random_below(KINDS)) {
    case 0:
        add_pyramid(p, random_between(0.5, 2));
        break;
    case 1:
        add_cube_corner(p);
        break;
    case 2:
        width = random_between(1, 3);
        add_wedge(p, width, random_between(0.5, 1));
        break;
    case 3:
        add_random_star(p);
        break;
    case 4:
        add_sphere(p, low, 1, 6, false);
        break;
    default:
        add_box(p, low, high, false);
        break;
    }
    if (random_below(2))
        turn_nodes(p, random_between(0, 2));
}

static inline void start_random_case(repair_case *c)
{
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    add_random_solid(&p);
    start_case(c, &p, 2 + random_below(2));
}

/* Moves some nodes inside, and takes some off their patch, by up to a half of `size`. */
static inline void damage(repair_case *c, size_t inside, size_t off)
{
    tm_repair_state *s = &c->state;
    const double size = sqrt(tm_distance2(c->surface.low, c->surface.high)) / 8;
    for (size_t n = 0; n < (inside + off) * 100 && inside + off > 0; n++) {
        const size_t v = random_below((unsigned)s->mesh.nodes);
        const bool free = s->rule[v].freedom == TM_MOVES_FREELY;
        if (free ? inside == 0
                 : off == 0 || s->rule[v].off_surface ||
                       s->rule[v].freedom != TM_MOVES_ON_SURFACE)
            continue;
        for (int i = 0; i < 3; i++)
            s->mesh.xyz[v][i] += size * (random_unit() - 0.5) * (free ? 1 : 0.2);
        s->rule[v].off_surface = !free;
        inside -= free;
        off -= !free;
    }
}

/* The score by other means, and that it is what is said. */
static inline void check_score(const tm_repair_state *s, const tm_repair_score *score,
                               double threshold)
{
    const double least = 1e-6;
    double worst = 1, lowest = 1, sum = 0;
    size_t invalid = 0, bad = 0, off_surface = 0;
    for (size_t v = 0; v < s->mesh.nodes; v++)
        off_surface += s->rule[v].off_surface;
    for (size_t e = 0; e < s->mesh.elements; e++) {
        const double jens = tm_mixed_jens(&s->mesh, e);
        const bool certified = tm_certify(s->mesh.start[e + 1] - s->mesh.start[e],
                                          (const double(*)[3])s->mesh.xyz,
                                          s->mesh.item + s->mesh.start[e]) == TM_POSITIVE;
        invalid += !certified || jens < least;
        bad += !certified || jens < fmax(threshold, least);
        worst = fmin(worst, jens);
        lowest = fmin(lowest, certified ? jens : fmin(jens, 0));
        sum += jens;
    }
    assert_int_equal(score->off_surface, off_surface);
    assert_int_equal(score->invalid, invalid);
    assert_int_equal(score->bad, bad);
    assert_true(score->worst == worst);
    assert_true(score->least == lowest);
    assert_true(score->good == fmax(threshold, 0.2));
    assert_true(score->valid == 0.2);
    assert_true(fabs(score->average - sum / (double)s->mesh.elements) < 1e-12);
}

/* What a step promises of the scores before and after it. */
static inline void check_not_worse(const tm_repair_score *before,
                                   const tm_repair_score *after)
{
    const double good = after->invalid < before->invalid ? before->valid : before->good;
    assert_true(after->worst >= fmin(before->worst, good));
    assert_true(after->least >= fmin(before->least, good));
    assert_true(after->invalid <= before->invalid);
    assert_true(after->off_surface <= before->off_surface);
    assert_true(after->bad <= before->bad || after->invalid < before->invalid);
}

static inline tm_examination examine_state(const tm_repair_state *s)
{
    tm_error error;
    tm_examination found;
    const tm_mesh_view view = {.nodes = s->mesh.nodes,
                               .xyz = (const double(*)[3])s->mesh.xyz,
                               .elements = s->mesh.elements,
                               .start = s->mesh.start,
                               .item = s->mesh.item};
    assert_ok(tm_element_examine(&found, &view, 1, &error), &error);
    return found;
}

/* Nodes that are not off the surface are where they belong. */
static inline void check_points(const tm_repair_state *s, const tm_surface *surface)
{
    const double close = TM_ON_SURFACE * sqrt(tm_distance2(surface->low, surface->high));
    for (size_t v = 0; v < s->mesh.nodes; v++) {
        const double *at = s->mesh.xyz[v];
        tm_surface_point closest = {.triangle = TM_NONE};
        assert_int_equal(s->on[v] == TM_NODE_INSIDE,
                         s->rule[v].freedom == TM_MOVES_FREELY);
        if (s->on[v] == TM_NODE_INSIDE || s->rule[v].off_surface)
            continue;
        tm_surface_closest(surface, at, TM_NONE, &closest);
        assert_true(closest.distance2 <= close * close);
        if (s->rule[v].freedom == TM_MOVES_ON_CURVE) {
            double place[3];
            size_t segment;
            tm_surface_closest_on_curve(surface, s->rule[v].where, at, place, &segment);
            assert_true(tm_distance2(at, place) <= close * close);
        }
        bool corner = s->on[v] != TM_NODE_ON_CORNER;
        for (size_t i = 0; i < surface->corners && !corner; i++)
            corner = tm_distance2(at, surface->xyz[surface->corner[i]]) <= close * close;
        assert_true(corner);
    }
}

/* Elements fit together whatever their shape, and each array is what repair_state.h says;
 * the boundary is that of a mesh with the same components and Euler characteristic. */
static inline void check_state(const tm_repair_state *s, const tm_surface *surface,
                               const tm_examination *first)
{
    tm_error error;
    const tm_examination found = examine_state(s);
    const tm_repair_score score = tm_repair_measure(s, 0);
    static const tm_defect never[] = {TM_UNMATCHED_FACE,    TM_OPEN_EDGE,
                                      TM_NON_MANIFOLD_EDGE, TM_NON_MANIFOLD_VERTEX,
                                      TM_DUPLICATE_NODE,    TM_DANGLING_FACE};
    for (size_t i = 0; i < sizeof never / sizeof *never; i++)
        assert_int_equal(found.defect[never[i]].count, 0);
    assert_true(score.invalid > 0 || tm_examination_is_good(&found));
    assert_int_equal(found.unused_nodes, 0);
    assert_int_equal(found.components, first->components);
    assert_int_equal(found.euler, first->euler);
    for (size_t e = 0; e < s->mesh.elements; e++) {
        assert_true(s->octree.leaves == 0 || s->octant[e] < s->octree.leaves);
        assert_true(e == 0 || s->origin[e] >= s->origin[e - 1]);
    }
    if (s->octree.leaves > 0)
        assert_ok(tm_octree_check(&s->octree, NULL, &error), &error);
    if (surface)
        check_points(s, surface);
}

/* Its mesh, rules and places. */
static inline tm_repair_state copy_elements(const tm_repair_state *s)
{
    tm_repair_state copy = {
        .mesh = {.nodes = s->mesh.nodes, .elements = s->mesh.elements}};
    const size_t items = s->mesh.start[s->mesh.elements];
    copy.mesh.xyz = malloc(s->mesh.nodes * sizeof *copy.mesh.xyz);
    copy.mesh.start = malloc((s->mesh.elements + 1) * sizeof *copy.mesh.start);
    copy.mesh.item = malloc(items * sizeof *copy.mesh.item);
    copy.rule = malloc(s->mesh.nodes * sizeof *copy.rule);
    copy.on = malloc(s->mesh.nodes);
    memcpy(copy.mesh.xyz, s->mesh.xyz, s->mesh.nodes * sizeof *copy.mesh.xyz);
    memcpy(copy.mesh.start, s->mesh.start,
           (s->mesh.elements + 1) * sizeof *copy.mesh.start);
    memcpy(copy.mesh.item, s->mesh.item, items * sizeof *copy.mesh.item);
    memcpy(copy.rule, s->rule, s->mesh.nodes * sizeof *copy.rule);
    memcpy(copy.on, s->on, s->mesh.nodes);
    return copy;
}

/* Nodes that may not move have not; and no node has another place. */
static inline void check_still(const tm_repair_state *old, const tm_repair_state *now)
{
    for (size_t v = 0; v < old->mesh.nodes; v++) {
        assert_int_equal(old->on[v], now->on[v]);
        if (old->rule[v].freedom == TM_MOVES_NOT)
            assert_memory_equal(old->mesh.xyz[v], now->mesh.xyz[v], 3 * sizeof(double));
    }
}

static inline void check_same_elements(const tm_repair_state *old,
                                       const tm_repair_state *now)
{
    assert_int_equal(old->mesh.nodes, now->mesh.nodes);
    assert_int_equal(old->mesh.elements, now->mesh.elements);
    assert_memory_equal(old->mesh.start, now->mesh.start,
                        (old->mesh.elements + 1) * sizeof *old->mesh.start);
    assert_memory_equal(old->mesh.item, now->mesh.item,
                        old->mesh.start[old->mesh.elements] * sizeof *old->mesh.item);
}

static inline tm_repair_score measured(const tm_repair_state *s, double threshold)
{
    const tm_repair_score score = tm_repair_measure(s, threshold);
    check_score(s, &score, threshold);
    return score;
}

/* For all tests of a program. */
static inline int start_mpi(void **unused)
{
    (void)unused;
    tm_error error;
    return tm_mpi_start(&error) == TM_OK ? 0 : -1;
}

#endif
