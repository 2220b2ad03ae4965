/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface_distance.h: known distances, and soups of triangles against dense sampling. */
#include "../../lib/surface/measure/surface_distance.h"
#include "../../lib/surface/surface_tree.h"
#include "random.h"
#include "surface_shapes.h"

#include <string.h>

static const double feature_angle = 40;

/* Boxes at x, each side cut into n x n squares of two triangles. */
static void make_box(tm_surface *s, double x, unsigned n)
{
    tm_error error;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    for (unsigned side = 0; side < 6; side++) {
        const unsigned w = side / 2, u = (w + 1) % 3, v = (w + 2) % 3;
        for (unsigned c = 0; c < n * n; c++) {
            uint32_t at[4];
            for (unsigned i = 0; i < 4; i++) {
                double q[3];
                q[w] = side % 2;
                q[u] = (double)(c % n + (i == 1 || i == 2)) / n;
                const unsigned row = c / n;
                q[v] = (double)(row + (i >= 2)) / n;
                at[i] = add_node(&p, q[0] + x, q[1], q[2]);
            }
            add_triangle(&p, at[0], at[1], at[2]);
            add_triangle(&p, at[0], at[2], at[3]);
        }
    }
    assert_int_equal(tm_surface_of_polygons(s, &p, &error), TM_OK);
    tm_polygon_surface_free(&p);
}

static void assert_distance(const tm_distance *d, double right)
{
    const double rounding = 1e-12;
    assert_true(fabs(d->most - right) <= rounding);
    assert_true(fabs(d->bound - right) <= rounding);
    double length2 = tm_distance2(d->at, d->to);
    assert_true(fabs(sqrt(length2) - d->most) <= rounding);
}

static void test_same(void **state)
{
    (void)state;
    tm_error error;
    tm_surface a, b;
    tm_surface_comparison c;
    make_box(&a, 0, 5);
    make_box(&b, 0, 7);
    assert_int_equal(tm_surface_compare(&c, &a, &b, feature_angle, &error), TM_OK);
    assert_false(c.rough);
    for (int way = 0; way < TM_WAYS; way++) {
        assert_distance(&c.surface[way], 0);
        assert_distance(&c.curve[way], 0);
        assert_distance(&c.corner[way], 0);
        assert_true(c.surface[way].mean < 1e-12);
        assert_int_equal(c.corner[way].parts, 8);
        assert_int_equal(c.curve[way].parts, 12 * (way == TM_THERE ? 5 : 7));
    }
    tm_surface_free(&a);
    tm_surface_free(&b);
}

static void test_moved(void **state)
{
    (void)state;
    tm_error error;
    tm_surface a, b;
    tm_surface_comparison c;
    make_box(&a, 0, 3);
    make_box(&b, 0.25, 4);
    assert_int_equal(tm_surface_compare(&c, &a, &b, feature_angle, &error), TM_OK);
    for (int way = 0; way < TM_WAYS; way++) {
        assert_distance(&c.surface[way], 0.25);
        assert_distance(&c.curve[way], 0.25);
        assert_distance(&c.corner[way], 0.25);
    }
    tm_surface_free(&a);
    tm_surface_free(&b);
}

/* A part of a surface is near to it all over, but not the other way round; an open edge
 * is a feature. */
static void test_one_way(void **state)
{
    (void)state;
    tm_error error;
    tm_surface a, b;
    tm_surface_comparison c;
    const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {7, 7, 7}};
    const uint32_t triangle[1][3] = {{0, 1, 2}};
    assert_int_equal(tm_surface_of_triangles(&a, xyz, 4, triangle, NULL, 1, &error),
                     TM_OK);
    assert_int_equal(a.nodes, 3);
    make_box(&b, 0, 2);
    assert_int_equal(tm_surface_compare(&c, &a, &b, feature_angle, &error), TM_OK);
    assert_distance(&c.surface[TM_THERE], 0);
    assert_distance(&c.surface[TM_BACK], sqrt(1.5)); /* from (0, 1, 1) */
    assert_int_equal(c.curve[TM_THERE].parts, 3);
    assert_distance(&c.curve[TM_THERE], 0.5); /* the middle of the diagonal */
    tm_surface_free(&b);
    assert_int_equal(tm_surface_of_triangles(&b, xyz, 4, triangle, NULL, 0, &error),
                     TM_ERROR_INPUT);
    tm_surface_free(&a);
}

/* Edges between markers are curves only where both have several. */
static void test_markers(void **state)
{
    (void)state;
    tm_error error;
    tm_surface a, b;
    tm_surface_comparison c;
    const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const uint32_t one[2][3] = {{0, 1, 2}, {0, 2, 3}},
                   other[2][3] = {{0, 1, 3}, {1, 2, 3}};
    const int32_t several[2] = {1, 2};
    for (int marked = 0; marked < 2; marked++) {
        assert_int_equal(tm_surface_of_triangles(&a, xyz, 4, one, several, 2, &error),
                         TM_OK);
        assert_int_equal(tm_surface_of_triangles(&b, xyz, 4, other,
                                                 marked ? several : NULL, 2, &error),
                         TM_OK);
        assert_int_equal(tm_surface_compare(&c, &a, &b, feature_angle, &error), TM_OK);
        assert_int_equal(c.curve[TM_THERE].parts, 4 + marked);
        assert_distance(&c.surface[TM_THERE], 0);
        /* from the point of one diagonal that is as far from the other as from a side */
        const double right = marked ? 1 / (2 + sqrt(2)) : 0;
        assert_true(c.curve[TM_THERE].most <= right + 1e-12);
        assert_true(c.curve[TM_THERE].bound >= right - 1e-12);
        assert_true(c.curve[TM_THERE].bound - c.curve[TM_THERE].most <= c.tolerance);
        tm_surface_free(&a);
        tm_surface_free(&b);
    }
}

static void make_soup(tm_surface *s, size_t triangles)
{
    tm_error error;
    double xyz[30][3];
    uint32_t triangle[10][3];
    for (uint32_t i = 0; i < 3 * triangles; i++) {
        for (int k = 0; k < 3; k++)
            xyz[i][k] = random_unit();
        triangle[i / 3][i % 3] = i;
    }
    assert_int_equal(tm_surface_of_triangles(s, (const double(*)[3])xyz, 3 * triangles,
                                             (const uint32_t(*)[3])triangle, NULL,
                                             triangles, &error),
                     TM_OK);
}

/* The largest distance from points that are everywhere in the triangles. */
static double sample(const tm_surface *from, const tm_surface *to)
{
    const int fine = 60;
    double most = 0;
    for (size_t t = 0; t < from->triangles; t++)
        for (int i = 0; i <= fine; i++)
            for (int j = 0; i + j <= fine; j++) {
                double p[3], least = HUGE_VAL;
                const uint32_t *v = from->triangle[t];
                for (int k = 0; k < 3; k++)
                    p[k] = (i * from->xyz[v[0]][k] + j * from->xyz[v[1]][k] +
                            (fine - i - j) * from->xyz[v[2]][k]) /
                           fine;
                for (uint32_t u = 0; u < to->triangles; u++)
                    least = fmin(least, tm_surface_triangle_distance2(to, u, p));
                most = fmax(most, sqrt(least));
            }
    return most;
}

static void test_soups(void **state)
{
    (void)state;
    tm_error error;
    tm_surface a, b;
    tm_surface_comparison c;
    const double step = 1.5 / 60; /* the sampling finds less, by no more */
    for (size_t i = 0; i < 60; i++) {
        make_soup(&a, 1 + i % 5);
        make_soup(&b, 1 + i % 10);
        assert_int_equal(tm_surface_compare(&c, &a, &b, feature_angle, &error), TM_OK);
        const double there = sample(&a, &b), back = sample(&b, &a);
        assert_true(there <= c.surface[TM_THERE].bound + 1e-12);
        assert_true(back <= c.surface[TM_BACK].bound + 1e-12);
        assert_true(there >= c.surface[TM_THERE].most - step);
        assert_true(back >= c.surface[TM_BACK].most - step);
        for (int way = 0; way < TM_WAYS; way++) {
            const tm_distance *d = &c.surface[way];
            assert_true(d->bound >= d->most && d->bound - d->most <= c.tolerance * 1.01);
            assert_true(d->mean <= d->most);
        }
        tm_surface_free(&a);
        tm_surface_free(&b);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same),    cmocka_unit_test(test_moved),
        cmocka_unit_test(test_one_way), cmocka_unit_test(test_markers),
        cmocka_unit_test(test_soups),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
