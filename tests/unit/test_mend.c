/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles made a closed surface: what is reported is so, whatever they are. */
#include "mend_fixture.h"

#include <malloc.h>

static void test_random(void **state)
{
    (void)state;
    enum { ROUNDS = 3000 };
    size_t closed = 0, better = 0;
    for (int round = 0; round < ROUNDS; round++) {
        tm_polygon_surface p;
        tm_stream stream;
        tm_mend_report report;
        tm_error error;
        tm_polygon_surface_init(&p);
        if (random_below(2))
            make_soup(&p);
        else
            add_random_cubes(&p);
        if (take_triangles(&stream, &p)) {
            change_corners(&stream);
            const tm_mend_options options = random_mend_options();
            assert_ok(tm_mend(&stream, &options, &report, &error), &error);
            check_mended(&stream, &report);
            closed += report.manifold;
            better += report.open_edges < report.open_before;
        }
        tm_stream_free(&stream);
    }
    assert_true(closed > 0 && better > 0);
}

/* A fin at an edge of two other triangles, one of whose ends they close: there a node has
 * one open edge, from which no hole goes on. */
static void add_fin(tm_polygon_surface *p, double x)
{
    const uint32_t a = add_node(p, x, 0, 0), b = add_node(p, x, 0, 1),
                   c = add_node(p, x + 1, 0, 0), d = add_node(p, x, 1, 0),
                   e = add_node(p, x - 1, -1, 0);
    add_triangle(p, b, a, e);
    add_triangle(p, a, b, c);
    add_triangle(p, b, a, d);
    add_triangle(p, a, c, d);
}

static void test_fins(void **state)
{
    (void)state;
    enum { FINS = 100, APART = 4, OPEN = 5 };
    tm_polygon_surface p;
    tm_stream stream;
    tm_mend_report report;
    tm_error error;
    const tm_mend_options options = {.weld = -1, .fill = 10};
    tm_polygon_surface_init(&p);
    for (int i = 0; i < FINS; i++)
        add_fin(&p, APART * i);
    assert_true(take_triangles(&stream, &p));
    assert_ok(tm_mend(&stream, &options, &report, &error), &error);
    check_mended(&stream, &report);
    assert_int_equal(report.open_before, FINS * OPEN);
    tm_stream_free(&stream);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_fins),
    };
    random_start();
    mallopt(M_PERTURB, 1); /* memory that was not set has no 0 */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
