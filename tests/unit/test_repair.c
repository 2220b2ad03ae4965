/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole repair, from stream to stream, on random solids that were damaged: what it
 * promises of mesh, boundary, octants, markers and counts, before and after. */
#include "../../lib/octree/forest/mpi_start.h"
#include "../../lib/octree/repair/repair.h"
#include "../../lib/octree/repair/repair_shape.h"
#include "../../lib/octree/repair/repair_trace.h"
#include "repair_fixture.h"

enum { ROUNDS = 4 };

/* The elements of each octant, in order, are those of its row. */
static void check_octants(const tm_stream *stream)
{
    enum { FIRST = 4, PAST, COLUMNS };
    const tm_block *octant = tm_stream_find(stream, ".octant");
    const tm_block *mix = tm_stream_find(stream, ".mix");
    uint32_t next = 0;
    for (size_t o = 0; o < octant->count; o++) {
        const uint32_t *row = octant->integer + o * COLUMNS;
        if (row[FIRST] == row[PAST])
            continue;
        assert_int_equal(row[FIRST], next);
        next = row[PAST];
        for (uint32_t e = row[FIRST]; e < next; e++)
            assert_true(mix->attribute[e] == row[0]);
    }
    assert_int_equal(next, mix->count);
}

/* Each face of the boundary is a row of .facet, with a marker of the surface. */
static void check_facets(const tm_stream *stream, const tm_examination *found)
{
    const tm_block *facet = tm_stream_find(stream, ".facet");
    const tm_block *face = tm_stream_find(stream, "surface.face");
    int32_t most = 0;
    assert_non_null(facet);
    assert_true(facet->markers);
    assert_int_equal(facet->count, found->boundary_faces);
    for (size_t f = 0; f < face->count; f++)
        most = face->marker[f] > most ? face->marker[f] : most;
    for (size_t f = 0; f < facet->count; f++)
        assert_in_range(facet->marker[f], 1, most);
}

/* A facet has the marker of the one that it is a part of. */
static void check_markers(const tm_block *old, const tm_block *now)
{
    for (size_t f = 0; f < now->count; f++) {
        bool found = false;
        for (size_t g = 0; g < old->count && !found; g++) {
            size_t same = 0;
            for (size_t i = now->start[f]; i < now->start[f + 1]; i++)
                for (size_t j = old->start[g]; j < old->start[g + 1]; j++)
                    same += now->item[i] == old->item[j];
            found = same == now->start[f + 1] - now->start[f] &&
                    now->marker[f] == old->marker[g];
        }
        assert_true(found);
    }
}

static void copy_facets(tm_block *to, const tm_block *from)
{
    tm_error error;
    to->markers = true;
    assert_ok(tm_block_allocate(to, from->count, from->start[from->count], &error),
              &error);
    memcpy(to->start, from->start, (from->count + 1) * sizeof *to->start);
    memcpy(to->item, from->item, from->start[from->count] * sizeof *to->item);
    memcpy(to->marker, from->marker, from->count * sizeof *to->marker);
}

/* The attribute of a node says whether it is off the surface. */
static void check_attributes(const tm_stream *stream, size_t off_surface)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    for (size_t v = 0; v < node->count; v++)
        off_surface -= node->attribute[v] < 0;
    assert_int_equal(off_surface, 0);
}

typedef struct {
    const repair_case *c;
    const tm_repair_options *options;
    unsigned visits, iteration;
    tm_repair_score last;
} witness;

/* Every state that is kept is good enough to be the last; and its trace is a mesh. */
static tm_status visit(void *context, unsigned iteration, const tm_repair_state *state,
                       const uint32_t *bad, size_t count, tm_error *error)
{
    witness *w = context;
    const tm_repair_score score = tm_repair_measure(state, w->options->threshold);
    check_score(state, &score, w->options->threshold);
    assert_true(w->visits == 0 || iteration > w->iteration);
    if (w->visits > 0 && w->options->method == TM_REPAIR_FULL)
        check_not_worse(&w->last, &score);
    for (size_t i = 1; i < count; i++)
        assert_true(bad[i] > bad[i - 1]);
    assert_true(count > 0 || score.bad == 0);
    tm_stream stream;
    tm_stream_init(&stream);
    assert_ok(tm_repair_trace(state, &w->c->surface, &stream, error), error);
    assert_int_equal(tm_stream_find(&stream, ".mix")->count, state->mesh.elements);
    assert_int_equal(tm_stream_find(&stream, "surface.face")->count,
                     w->c->surface.triangles);
    const tm_mesh_view view = tm_mesh_view_of_mixed(&stream);
    tm_examination found;
    assert_ok(tm_element_examine(&found, &view, 1, error), error);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 0);
    check_attributes(&stream, score.off_surface);
    tm_stream_free(&stream);
    w->visits++;
    w->iteration = iteration;
    w->last = score;
    return TM_OK;
}

/* What comes out, as a stream; c->state is given back. */
static void check_stream(repair_case *c, const tm_repair_report *report)
{
    tm_error error;
    tm_examination found;
    const size_t elements = c->state.mesh.elements;
    const bool only_divided = c->state.divided && !c->state.remade;
    tm_stream old;
    tm_stream_init(&old);
    tm_block *facet = tm_stream_add(&old, ".facet");
    copy_facets(facet, tm_stream_find(&c->stream, ".facet"));
    assert_ok(tm_repair_to_stream(&c->state, &c->stream, &c->surface, &c->notes, &error),
              &error);
    assert_string_equal(c->notes.dropped, "");
    assert_int_equal(tm_stream_find(&c->stream, ".mix")->count, elements);
    const tm_mesh_view view = tm_mesh_view_of_mixed(&c->stream);
    assert_ok(tm_element_examine(&found, &view, 1, &error), &error);
    /* It looks at corners: a hexahedron that is inverted between them is good to it. */
    assert_true(report->after.invalid > 0 || tm_examination_is_good(&found));
    check_octants(&c->stream);
    check_facets(&c->stream, &found);
    check_attributes(&c->stream, report->after.off_surface);
    if (only_divided)
        check_markers(facet, tm_stream_find(&c->stream, ".facet"));
    tm_stream_free(&old);
}

/* What all of the repair promises: the worst J_ENS may fall further for fewer invalid
 * elements than that of a step. */
static void check_repaired(const tm_repair_report *report)
{
    tm_repair_score before = report->before;
    before.valid = TM_REPAIR_FLAT;
    check_not_worse(&before, &report->after);
}

/* Repairs a case that was started; ends it. */
static tm_repair_report repair(repair_case *c, tm_repair_options options)
{
    tm_error error;
    tm_repair_report report;
    witness w = {.c = c, .options = &options};
    options.visit = visit;
    options.context = &w;
    tm_repair_shape was, is;
    const tm_examination first = examine_state(&c->state);
    assert_ok(tm_repair_shape_measure(&was, &c->state, &c->surface, &error), &error);
    const size_t elements = c->state.mesh.elements;
    const tm_repair_score before = tm_repair_measure(&c->state, options.threshold);
    assert_ok(tm_repair(&c->state, &c->surface, &options, &report, &error), &error);
    assert_memory_equal(&report.before, &before, sizeof before);
    check_score(&c->state, &report.after, options.threshold);
    assert_true(report.iterations <= options.iterations);
    assert_true(w.visits > 0);
    if (options.method == TM_REPAIR_FULL) {
        check_repaired(&report);
        if (c->state.remade)
            assert_true((double)c->state.mesh.elements <=
                        options.growth * (double)elements);
        check_state(&c->state, &c->surface, &first);
        assert_ok(tm_repair_shape_measure(&is, &c->state, &c->surface, &error), &error);
        assert_true(is.corners >= was.corners);
        assert_true(is.curves >= 0.95 * was.curves); /* chords, where it bends */
        assert_true(is.defects <= was.defects);
    }
    check_stream(c, &report);
    end_case(c);
    return report;
}

/* Valid and on the surface is what threshold 0 always reaches here. */
static void test_valid(void **unused)
{
    (void)unused;
    size_t mended = 0;
    for (int round = 0; round < ROUNDS; round++) {
        repair_case c;
        start_random_case(&c);
        damage(&c, 1 + random_below(4), random_below(3));
        const tm_repair_report report = repair(
            &c,
            (tm_repair_options){.method = TM_REPAIR_FULL, .iterations = 5, .growth = 4});
        assert_true(report.before.invalid == 0 ||
                    report.after.invalid < report.before.invalid);
        mended += report.before.invalid - report.after.invalid;
    }
    assert_true(mended > 0);
}

/* High thresholds: all that can be is done, nothing is worse. */
static void test_thresholds(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        repair_case c;
        start_random_case(&c);
        damage(&c, random_below(2), random_below(2));
        repair(&c, (tm_repair_options){.method = TM_REPAIR_FULL,
                                       .threshold = random_between(0, 0.2),
                                       .iterations = random_below(3),
                                       .growth = random_between(1, 3)});
    }
}

/* Octants are split where nothing else helps: that is kept only if it is better, and not
 * if there are more elements than allowed. */
static void test_split(void **unused)
{
    (void)unused;
    static const struct {
        double height; /* of a pyramid; 0: the corner of a cube */
        unsigned level;
        double threshold, growth;
    } of[] = {{2.4, 3, 0.2, 2}, {2.4, 3, 0.2, 1.001}, {0, 2, 0.2, 4}};
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        tm_polygon_surface p;
        repair_case c;
        tm_polygon_surface_init(&p);
        if (of[i].height > 0)
            add_pyramid(&p, of[i].height);
        else
            add_cube_corner(&p);
        start_case(&c, &p, of[i].level);
        const tm_repair_report report =
            repair(&c, (tm_repair_options){.method = TM_REPAIR_FULL,
                                           .threshold = of[i].threshold,
                                           .iterations = i < 2 ? 4 : 1,
                                           .growth = of[i].growth});
        assert_int_equal(report.iterations > 0, i != 1); /* there is no room */
        assert_true(i != 0 || report.after.bad == 0);
    }
}

/* Nodes come to the surface, but not so that what stays behind is worse than before. */
static void test_held(void **unused)
{
    (void)unused;
    size_t brought = 0;
    /* some have no node that is held back */
    for (int round = 0; round < ROUNDS || (brought == 0 && round < 5 * ROUNDS); round++) {
        tm_polygon_surface p;
        repair_case c;
        tm_polygon_surface_init(&p);
        add_random_star(&p);
        start_case(&c, &p, 3);
        damage(&c, 0, 3);
        const tm_repair_report report = repair(
            &c,
            (tm_repair_options){.method = TM_REPAIR_FULL, .threshold = 0.1, .growth = 1});
        brought += report.before.off_surface - report.after.off_surface;
    }
    assert_true(brought > 0);
}

/* Octants are split until nothing is bad; the mesh is that of an octree again. */
static void test_refine(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        repair_case c;
        start_random_case(&c);
        damage(&c, 2, 0);
        const tm_repair_report report =
            repair(&c, (tm_repair_options){.method = TM_REPAIR_REFINE, .iterations = 2});
        assert_int_equal(report.corners + report.divided, 0);
        assert_true(report.before.bad == 0 || report.iterations > 0);
    }
}

/* Elements that cannot be moved are divided, and what refers to them follows. */
static void test_divided(void **unused)
{
    (void)unused;
    size_t divided = 0;
    for (int round = 0; round < 8 * ROUNDS && divided < ROUNDS; round++) {
        tm_polygon_surface p;
        repair_case c;
        tm_polygon_surface_init(&p);
        if (round % 4 == 0)
            add_pyramid(&p, 3);
        else
            add_cube(&p, 0, 0, 0, 1);
        start_case(&c, &p, 2);
        /* Nothing on the boundary moves; a corner of some element is flat. */
        if (round % 4 > 0)
            for (size_t v = 0; v < c.state.mesh.nodes; v++)
                c.state.rule[v].freedom =
                    c.state.on[v] == TM_NODE_INSIDE ? TM_MOVES_FREELY : TM_MOVES_NOT;
        const double threshold = round % 4 == 0 ? 0.2 : 0.3;
        size_t v = 0;
        while (c.state.on[v] != TM_NODE_ON_PATCH)
            v++;
        if (round % 4 > 0)
            for (int i = 0; i < 3; i++)
                c.state.mesh.xyz[v][i] +=
                    random_between(0, 0.6) * (0.5 - c.state.mesh.xyz[v][i]);
        tm_error error;
        const tm_repair_options options = {
            .method = TM_REPAIR_FULL, .threshold = threshold, .growth = 1.5};
        tm_repair_report report;
        assert_ok(tm_repair(&c.state, &c.surface, &options, &report, &error), &error);
        check_score(&c.state, &report.after, threshold);
        check_repaired(&report);
        divided += c.state.divided;
        check_stream(&c, &report);
        end_case(&c);
    }
    assert_true(divided > 0);
}

typedef struct {
    size_t left; /* questions until it is wanted */
    bool wanted;
} patience;

static bool is_wanted(void *context)
{
    patience *p = context;
    p->wanted = p->wanted || p->left-- == 0;
    return p->wanted;
}

/* Whenever it is ended, what there is then is as good as it was at first, and whole. */
static void test_ended(void **unused)
{
    (void)unused;
    size_t ended = 0;
    for (int round = 0; round < 2 * ROUNDS; round++) {
        repair_case c;
        patience p = {.left = random_below(1u << random_below(10))};
        const tm_stop stop = {is_wanted, &p};
        start_random_case(&c);
        damage(&c, 1 + random_below(4), random_below(3));
        repair(&c, (tm_repair_options){.method = TM_REPAIR_FULL,
                                       .threshold = random_between(0, 0.5),
                                       .iterations = 3,
                                       .growth = 2,
                                       .stop = &stop});
        ended += p.wanted;
    }
    assert_true(ended > 0);
}

/* High thresholds never leave more that is invalid than 0 does. */
static void test_valid_first(void **unused)
{
    (void)unused;
    for (int round = 0; round < ROUNDS; round++) {
        size_t invalid[2];
        const double threshold = random_between(0.1, 0.4);
        tm_polygon_surface p;
        repair_case c[2];
        for (int i = 0; i < 2; i++) {
            tm_polygon_surface_init(&p);
            add_pyramid(&p, 1.5);
            start_case(&c[i], &p, 3);
        }
        damage(&c[0], 3 + random_below(4), random_below(3));
        memcpy(c[1].state.mesh.xyz, c[0].state.mesh.xyz,
               c[0].state.mesh.nodes * sizeof *c[0].state.mesh.xyz);
        memcpy(c[1].state.rule, c[0].state.rule,
               c[0].state.mesh.nodes * sizeof *c[0].state.rule);
        for (int i = 0; i < 2; i++)
            invalid[i] =
                repair(&c[i], (tm_repair_options){.method = TM_REPAIR_FULL,
                                                  .threshold = i == 0 ? 0 : threshold,
                                                  .growth = 1})
                    .after.invalid;
        assert_true(invalid[1] <= invalid[0]);
    }
}

/* Without octants, and without a surface, nodes inside move still. */
static void test_alone(void **unused)
{
    (void)unused;
    tm_error error;
    repair_case c;
    tm_repair_report report;
    start_random_case(&c);
    damage(&c, 2, 0);
    tm_octree_free(&c.state.octree);
    const tm_repair_options refine = {.method = TM_REPAIR_REFINE, .iterations = 1};
    if (tm_repair_measure(&c.state, 0).bad > 0)
        assert_int_equal(tm_repair(&c.state, &c.surface, &refine, &report, &error),
                         TM_ERROR_INPUT);
    tm_repair_state_free(&c.state);
    for (size_t e = 0; e < 2; e++) { /* .node and .mix were taken */
        const char *const name[] = {".node", ".mix"};
        tm_stream_remove(&c.stream, tm_stream_find(&c.stream, name[e]));
    }
    assert_int_equal(tm_repair_from_stream(&c.state, &c.stream, &error), TM_ERROR_INPUT);
    end_case(&c);
    start_random_case(&c);
    assert_false(tm_repair_is_needed(&c.state, &c.stream, 0) &&
                 tm_repair_measure(&c.state, 0).off_surface == 0);
    tm_repair_notes notes;
    assert_ok(tm_repair_prepare(&c.state, &c.stream, NULL, &notes, &error), &error);
    for (size_t v = 0; v < c.state.mesh.nodes; v++)
        assert_int_equal(c.state.rule[v].freedom, c.state.on[v] == TM_NODE_INSIDE
                                                      ? TM_MOVES_FREELY
                                                      : TM_MOVES_NOT);
    end_case(&c);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_valid),       cmocka_unit_test(test_thresholds),
        cmocka_unit_test(test_split),       cmocka_unit_test(test_held),
        cmocka_unit_test(test_refine),      cmocka_unit_test(test_divided),
        cmocka_unit_test(test_alone),       cmocka_unit_test(test_ended),
        cmocka_unit_test(test_valid_first),
    };
    return cmocka_run_group_tests(tests, start_mpi, NULL);
}
