/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scaled Jacobians and J_ENS of elements with known ones; slopes against differences. */
#include "../../lib/geom/vector.h"
#include "../../lib/element/jens.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static const uint32_t item[] = {0, 1, 2, 3, 4, 5, 6, 7};
static const size_t kinds[] = {4, 5, 6, 8};
enum { KINDS = 4 };

/* Regular elements: those that K is of. */
static const double regular[9][8][3] = {
    [4] = {{0, 0, 0},
           {1, 0, 0},
           {0.5, TM_SQRT_3 / 2, 0},
           {0.5, TM_SQRT_3 / 6, TM_SQRT_6 / 3}},
    [5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
    [6] = {{0, 0, 0},
           {0.5, TM_SQRT_3 / 2, 0},
           {1, 0, 0},
           {0, 0, 1},
           {0.5, TM_SQRT_3 / 2, 1},
           {1, 0, 1}},
    [8] = {{0, 0, 0},
           {1, 0, 0},
           {1, 1, 0},
           {0, 1, 0},
           {0, 0, 1},
           {1, 0, 1},
           {1, 1, 1},
           {0, 1, 1}},
};

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static void test_constants(void **state)
{
    (void)state;
    assert_near(TM_K_TETRAHEDRON, sqrt(2) / 2, 1e-16);
    assert_near(TM_K_WEDGE, sqrt(3) / 2, 1e-16);
    assert_near(TM_K_PYRAMID_BASE, sqrt(6) / 3, 1e-16);
    assert_near(TM_K_PYRAMID_APEX, 2 * sqrt(6) / 9, 1e-16);
}

static void test_mirror(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        uint32_t node[8];
        memcpy(node, item, sizeof item);
        tm_mixed_mirror(node, nodes);
        assert_near(tm_jens(nodes, regular[nodes], node), -1, 1e-14);
        tm_mixed_mirror(node, nodes);
        assert_memory_equal(node, item, sizeof item);
    }
}

static void test_regular(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        const tm_element_shape *shape = &tm_element_shapes[nodes];
        double jacobian[TM_ELEMENT_CORNERS];
        tm_scaled_jacobians(shape, regular[nodes], item, jacobian);
        for (size_t i = 0; i < shape->corners; i++)
            assert_near(jacobian[i], shape->k[i], 4e-16);
        assert_near(tm_jens(nodes, regular[nodes], item), 1, 1e-15);
    }
    assert_true(tm_jens(8, regular[8], item) == 1);
    assert_near(tm_least_scaled_jacobian(5, regular[5], item), TM_K_PYRAMID_APEX, 4e-16);
}

/* What J_ENS is of other J_S than K, and where it has its corners. */
static void test_normalisation(void **state)
{
    (void)state;
    const double k = TM_K_TETRAHEDRON;
    assert_true(tm_jens_of(k, k) == 1);
    assert_true(tm_jens_of(-k, k) == -1);
    assert_true(tm_jens_of(0, k) == 0);
    assert_near(tm_jens_of(1, k), k, 1e-15);
    assert_near(tm_jens_of(-1, k), -k, 1e-15);
    assert_near(tm_jens_of(0.1, k), 0.1 / k, 1e-15);
    /* The corner of a cube, cut off: J_S is 1 at it and 1/2 at the others. */
    const double right[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assert_near(tm_jens(4, right, item), 0.5 / k, 1e-15);
}

/* Elements turned inside out: the sign changes, nothing else. */
static void test_inverted(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        double mirror[8][3];
        memcpy(mirror, regular[nodes], sizeof mirror);
        for (size_t v = 0; v < nodes; v++)
            mirror[v][0] = -mirror[v][0];
        assert_near(tm_jens(nodes, mirror, item), -1, 1e-15);
    }
}

/* Two nodes in one place: corners with an edge of length 0 are worth 0. */
static void test_degenerate(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        double p[8][3], slope[4][3];
        memcpy(p, regular[nodes], sizeof p);
        memcpy(p[1], p[0], sizeof p[1]);
        assert_true(tm_jens(nodes, p, item) == 0);
        assert_true(tm_scaled_jacobian(p[0], p[1], p[2], p[3]) == 0);
        assert_true(tm_scaled_jacobian_slope(p[0], p[1], p[2], p[3], slope) == 0);
        for (size_t i = 0; i < 4; i++)
            assert_true(tm_norm2(slope[i]) == 0);
    }
}

/* Neither very small nor very large elements lose their quality, as long as the
 * differences of coordinates are doubles. */
static void test_range(void **state)
{
    (void)state;
    const double factor[] = {1e-300, 1e-120, 1e-60, 1e60, 1e120, 1e300};
    for (size_t f = 0; f < sizeof factor / sizeof *factor; f++) {
        for (size_t k = 0; k < KINDS; k++) {
            const size_t nodes = kinds[k];
            double p[8][3];
            for (size_t v = 0; v < nodes; v++)
                for (size_t i = 0; i < 3; i++)
                    p[v][i] = regular[nodes][v][i] * factor[f];
            assert_near(tm_jens(nodes, p, item), 1, 1e-14);
        }
    }
    double huge[8][3];
    for (size_t v = 0; v < 8; v++)
        for (size_t i = 0; i < 3; i++)
            huge[v][i] = (regular[8][v][i] * 2 - 1) * 1.7e308;
    assert_true(tm_jens(8, huge, item) == 0);
}

static void random_points(double p[][3], size_t count)
{
    for (size_t v = 0; v < count; v++)
        for (size_t i = 0; i < 3; i++)
            p[v][i] = random_unit();
}

/* All ways to compute a value give it, in whatever places the nodes are; no J_S is
 * outside of [-1, 1]. */
static void test_random(void **state)
{
    (void)state;
    for (int trial = 0; trial < 1000; trial++) {
        double p[8][3], jacobian[TM_ELEMENT_CORNERS], slope[4][3];
        random_points(p, 8);
        for (size_t k = 0; k < KINDS; k++) {
            const tm_element_shape *shape = &tm_element_shapes[kinds[k]];
            double least = 2, jens = 2;
            tm_scaled_jacobians(shape, p, item, jacobian);
            for (size_t i = 0; i < shape->corners; i++) {
                const unsigned char *n = shape->corner[i];
                const double one = tm_scaled_jacobian(p[n[0]], p[n[1]], p[n[2]], p[n[3]]);
                assert_true(jacobian[i] == one);
                assert_near(
                    tm_scaled_jacobian_slope(p[n[0]], p[n[1]], p[n[2]], p[n[3]], slope),
                    one, 1e-13);
                assert_true(fabs(one) <= 1 + 1e-13);
                least = fmin(least, jacobian[i]);
                jens = fmin(jens, tm_jens_of(jacobian[i], shape->k[i]));
            }
            assert_true(tm_least_scaled_jacobian(kinds[k], p, item) == least);
            assert_true(tm_jens(kinds[k], p, item) == jens);
        }
    }
}

/* J_S as the other programs have it that print J_ENS: (a × b)·c over the product of the
 * three lengths, each rounded in turn. */
static double plain_jacobian(const double *p, const double *to[3])
{
    double edge[3][3], length[3];
    for (int i = 0; i < 3; i++) {
        tm_subtract(edge[i], to[i], p);
        length[i] = sqrt(edge[i][0] * edge[i][0] + edge[i][1] * edge[i][1] +
                         edge[i][2] * edge[i][2]);
    }
    const double *a = edge[0], *b = edge[1], *c = edge[2];
    return ((a[1] * b[2] - a[2] * b[1]) * c[0] + (a[2] * b[0] - a[0] * b[2]) * c[1] +
            (a[0] * b[1] - a[1] * b[0]) * c[2]) /
           (length[0] * length[1] * length[2]);
}

/* The neighbours of each corner in that order: the third one matters. */
static const unsigned char plain_corner[9][8][4] = {
    [4] = {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}},
    [5] = {{0, 1, 3, 4},
           {1, 2, 0, 4},
           {2, 3, 1, 4},
           {3, 0, 2, 4},
           {4, 1, 0, 3},
           {4, 2, 1, 0},
           {4, 3, 2, 1},
           {4, 0, 3, 2}},
    [6] = {{0, 2, 1, 3},
           {2, 1, 0, 5},
           {1, 0, 2, 4},
           {3, 4, 5, 0},
           {5, 3, 4, 2},
           {4, 5, 3, 1}},
    [8] = {{0, 1, 3, 4},
           {1, 2, 0, 5},
           {2, 3, 1, 6},
           {3, 0, 2, 7},
           {4, 7, 5, 0},
           {5, 4, 6, 1},
           {6, 5, 7, 2},
           {7, 6, 4, 3}}};

/* To the last bit, so that an element is in the same bucket of a histogram. */
static void test_last_bit(void **state)
{
    (void)state;
    for (int trial = 0; trial < 1000; trial++) {
        double p[8][3];
        random_points(p, 8);
        for (size_t k = 0; k < KINDS; k++) {
            const tm_element_shape *shape = &tm_element_shapes[kinds[k]];
            double least = 2;
            for (size_t i = 0; i < shape->corners; i++) {
                const unsigned char *n = plain_corner[kinds[k]][i];
                const double *to[3] = {p[n[1]], p[n[2]], p[n[3]]};
                const double plain = plain_jacobian(p[n[0]], to);
                assert_true(tm_scaled_jacobian(p[n[0]], to[0], to[1], to[2]) == plain);
                least = fmin(least, tm_jens_of(plain, shape->k[i]));
            }
            assert_true(tm_jens(kinds[k], p, item) == least);
        }
    }
}

static double moved(double p[4][3], size_t v, size_t i, double by)
{
    const double before = p[v][i];
    p[v][i] += by;
    const double value = tm_scaled_jacobian(p[0], p[1], p[2], p[3]);
    p[v][i] = before;
    return value;
}

/* Central differences are off by h² times third derivatives, which grow as 1/length³. */
static void test_slope(void **state)
{
    (void)state;
    const double h = 1e-6;
    for (int trial = 0; trial < 1000; trial++) {
        double p[4][3], slope[4][3];
        random_points(p, 4);
        double shortest = 1;
        for (size_t v = 1; v < 4; v++)
            shortest = fmin(shortest, sqrt(tm_distance2(p[0], p[v])));
        if (shortest < 0.1)
            continue;
        tm_scaled_jacobian_slope(p[0], p[1], p[2], p[3], slope);
        for (size_t v = 0; v < 4; v++)
            for (size_t i = 0; i < 3; i++)
                assert_near(slope[v][i],
                            (moved(p, v, i, h) - moved(p, v, i, -h)) / (2 * h), 1e-7);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constants), cmocka_unit_test(test_mirror),
        cmocka_unit_test(test_regular),   cmocka_unit_test(test_normalisation),
        cmocka_unit_test(test_inverted),  cmocka_unit_test(test_degenerate),
        cmocka_unit_test(test_range),     cmocka_unit_test(test_random),
        cmocka_unit_test(test_last_bit),  cmocka_unit_test(test_slope),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
