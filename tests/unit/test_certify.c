/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Certificates of known elements, and of random ones against the determinant at many
 * points of them. */
#include "../../lib/geom/vector.h"
#include "../../lib/element/certify.h"
#include "../../lib/element/jens.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { KINDS = 4, NODES = 8, GRID = 5 };

typedef double element[NODES][3];

static const uint32_t item[] = {0, 1, 2, 3, 4, 5, 6, 7};
static const size_t kinds[KINDS] = {4, 5, 6, 8};

static const element regular[NODES + 1] = {
    [4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    [5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
    [6] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}},
    [8] = {{0, 0, 0},
           {1, 0, 0},
           {1, 1, 0},
           {0, 1, 0},
           {0, 0, 1},
           {1, 0, 1},
           {1, 1, 1},
           {0, 1, 1}},
};

/* No corner is near to being inverted, and the determinant is negative inside. */
static const element bad_wedge = {{-0.4, 0.9, -0.8}, {-0.3, 1.7, -0.4}, {0.4, 0.9, -0.6},
                                  {0.8, 0.6, 0.6},   {-0.3, 0.1, 0.6},  {0.1, 0.6, 1.2}};
static const element bad_hexahedron = {
    {0, 0.5, -0.9},   {1.8, -0.6, 0.3}, {1.6, 0.2, 0.3}, {-0.8, 0.5, 0.7},
    {0.1, -0.7, 0.2}, {1.9, 0.3, 1.9},  {0.9, 1.2, 1.4}, {-0.8, 0.4, 0.7}};

/* The determinant at a point of the reference element, where a pyramid has it without the
 * factor (1-ζ)², from the map's definition: shape functions of the nodes. */
static void weights(size_t nodes, const double at[3], double weight[NODES])
{
    const double x = at[0], y = at[1], z = at[2];
    if (nodes == 6) {
        const double triangle[3] = {1 - x - y, y, x};
        for (size_t i = 0; i < 3; i++) {
            weight[i] = triangle[i] * (1 - z);
            weight[i + 3] = triangle[i] * z;
        }
        return;
    }
    const double base[4] = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
    for (size_t i = 0; i < 4; i++) {
        weight[i] = base[i] * (1 - z);
        weight[i + 4] = base[i] * z;
    }
    if (nodes == 5)
        weight[4] = z;
}

/* The maps are linear in each coordinate, so that differences are derivatives. */
static void derivative(size_t nodes, const element p, const double at[3], size_t axis,
                       double out[3])
{
    double low[3], high[3], before[NODES], after[NODES];
    memcpy(low, at, sizeof low);
    memcpy(high, at, sizeof high);
    low[axis] = 0;
    high[axis] = 1;
    weights(nodes, low, before);
    weights(nodes, high, after);
    for (size_t i = 0; i < 3; i++) {
        out[i] = 0;
        for (size_t v = 0; v < nodes; v++)
            out[i] += (after[v] - before[v]) * p[v][i];
    }
}

static double determinant(size_t nodes, const element p, const double at[3])
{
    double d[3][3], normal[3];
    const double bottom[3] = {at[0], at[1], nodes == 5 ? 0 : at[2]};
    for (size_t i = 0; i < 3; i++)
        derivative(nodes, p, i < 2 ? bottom : at, i, d[i]);
    tm_cross(normal, d[0], d[1]);
    return tm_dot(normal, d[2]);
}

/* The least determinant on a grid, and, from its lowest place, on finer ones. */
static double least_near(size_t nodes, const element p, double centre[3], double width)
{
    double least = INFINITY;
    for (int level = 0; level < 14; level++) {
        double best[3] = {centre[0], centre[1], centre[2]};
        for (int n = 0; n < GRID * GRID * GRID; n++) {
            const int step[3] = {n % GRID, n / GRID % GRID, n / GRID / GRID};
            double at[3];
            for (size_t i = 0; i < 3; i++)
                at[i] =
                    fmin(fmax(centre[i] + width * (step[i] / (GRID - 1.0) - 0.5), 0), 1);
            if (nodes == 6 && at[0] + at[1] > 1)
                at[1] = 1 - at[0];
            const double value = determinant(nodes, p, at);
            if (value < least) {
                least = value;
                memcpy(best, at, sizeof best);
            }
        }
        memcpy(centre, best, sizeof best);
        width /= 2;
    }
    return least;
}

/* There may be several low places. */
static double least_determinant(size_t nodes, const element p)
{
    double least = INFINITY;
    for (int octant = 0; octant < 8; octant++) {
        double centre[3] = {0.25 + (octant & 1) * 0.5, 0.25 + (octant >> 1 & 1) * 0.5,
                            0.25 + (octant >> 2) * 0.5};
        least = fmin(least, least_near(nodes, p, centre, 0.5));
    }
    return least;
}

static tm_certificate certify(size_t nodes, const element p)
{
    return tm_certify(nodes, p, item);
}

static void random_element(element p, size_t nodes, double amplitude)
{
    for (size_t v = 0; v < nodes; v++)
        for (size_t i = 0; i < 3; i++)
            p[v][i] = regular[nodes][v][i] + amplitude * (2 * random_unit() - 1);
}

static void test_regular_and_inverted(void **state)
{
    (void)state;
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        element p;
        assert_int_equal(certify(nodes, regular[nodes]), TM_POSITIVE);
        memcpy(p, regular[nodes], sizeof p);
        for (size_t v = 0; v < nodes; v++)
            p[v][0] = -p[v][0];
        assert_int_equal(certify(nodes, p), TM_NOT_POSITIVE);
        for (size_t v = 0; v < nodes; v++)
            p[v][0] = 0.1; /* flat */
        assert_int_equal(certify(nodes, p), TM_NOT_POSITIVE);
        memset(p, 0, sizeof p);
        assert_int_equal(certify(nodes, p), TM_NOT_POSITIVE);
        /* Two nodes in one place: the determinant is 0 there. */
        memcpy(p, regular[nodes], sizeof p);
        memcpy(p[1], p[0], sizeof p[1]);
        assert_int_equal(certify(nodes, p), TM_NOT_POSITIVE);
    }
}

static void test_inverted_inside(void **state)
{
    (void)state;
    assert_true(tm_jens(6, bad_wedge, item) > 0.56);
    assert_true(least_determinant(6, bad_wedge) < 0);
    assert_int_equal(certify(6, bad_wedge), TM_NOT_POSITIVE);
    assert_true(tm_jens(8, bad_hexahedron, item) > 0.44);
    assert_true(least_determinant(8, bad_hexahedron) < 0);
    assert_int_equal(certify(8, bad_hexahedron), TM_NOT_POSITIVE);
}

/* Of random elements, some of which are good and some not, at corners or only inside, the
 * points agree with the certificate. */
static void test_random(void **state)
{
    (void)state;
    static const double amplitude[] = {0.1, 0.3, 0.4, 0.5, 0.6, 0.8};
    size_t seen[KINDS][2] = {{0}}, inside[KINDS] = {0};
    for (int trial = 0; trial < 1200; trial++) {
        const size_t k = (size_t)trial % KINDS, nodes = kinds[k];
        element p;
        if (nodes == 4)
            continue;
        random_element(p, nodes, amplitude[trial / KINDS % 6]);
        const bool corners = tm_least_scaled_jacobian(nodes, p, item) > 0;
        const tm_certificate found = certify(nodes, p);
        if (!corners) {
            assert_int_equal(found, TM_NOT_POSITIVE);
            continue;
        }
        const double least = least_determinant(nodes, p);
        assert_int_not_equal(found, TM_UNDECIDED);
        assert_true(found == TM_POSITIVE ? least > 0 : least < 1e-9);
        seen[k][found]++;
        inside[k] += found == TM_NOT_POSITIVE;
    }
    for (size_t k = 1; k < KINDS; k++)
        assert_true(seen[k][TM_POSITIVE] > 20);
    assert_true(inside[1] == 0); /* a pyramid is as good as its corners */
}

/* Wedges and hexahedra that are bad only inside, of which few are random. */
static void test_random_inverted_inside(void **state)
{
    (void)state;
    for (size_t k = 2; k < KINDS; k++) {
        for (int found = 0; found < 40;) {
            element p;
            random_element(p, kinds[k], 0.8);
            if (tm_least_scaled_jacobian(kinds[k], p, item) <= 0)
                continue;
            const double least = least_determinant(kinds[k], p);
            const tm_certificate one = certify(kinds[k], p);
            assert_true(one == TM_POSITIVE ? least > 0 : least < 1e-9);
            found += one == TM_NOT_POSITIVE;
        }
    }
}

/* That a pyramid's determinant is bilinear, and so least at a corner of its base. */
static void test_pyramid_is_bilinear(void **state)
{
    (void)state;
    for (int trial = 0; trial < 1000; trial++) {
        element p;
        random_element(p, 5, 1);
        const double x = random_unit(), y = random_unit(), z = random_unit();
        const double at[5][3] = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}, {x, y, z}};
        const double weight[4] = {(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y};
        double sum = 0;
        for (size_t i = 0; i < 4; i++)
            sum += weight[i] * determinant(5, p, at[i]);
        assert_true(fabs(sum - determinant(5, p, at[4])) < 1e-13);
    }
}

/* The answer does not depend on the scale, in each direction, nor on where the element
 * is; and near to 0 it is never the wrong one. */
static void test_scale(void **state)
{
    (void)state;
    static const int exponent[] = {-1000, -400, -150, -40, 40, 150, 400, 1000};
    for (int trial = 0; trial < 400; trial++) {
        const size_t nodes = kinds[(size_t)trial % KINDS];
        element p, q;
        random_element(p, nodes, 0.5);
        const tm_certificate expected = certify(nodes, p);
        for (size_t s = 0; s < sizeof exponent / sizeof *exponent; s++) {
            for (size_t v = 0; v < nodes; v++)
                for (size_t i = 0; i < 3; i++)
                    q[v][i] = ldexp(p[v][i], exponent[s]);
            assert_int_equal(certify(nodes, q), expected);
        }
        for (size_t v = 0; v < nodes; v++)
            for (size_t i = 0; i < 3; i++)
                q[v][i] = ldexp(p[v][i], i == 2 ? -20 : 10) + (i == 0 ? 64 : 0);
        if (expected != certify(nodes, q))
            assert_true(fabs(least_determinant(nodes, p)) < 1e-6);
    }
}

/* Between a good element and one that is bad inside there is one that touches 0: on both
 * sides of it, as near as 1e-12, the answer is known and right. */
static void test_near_the_edge(void **state)
{
    (void)state;
    const element *bad[] = {&bad_wedge, &bad_hexahedron};
    for (size_t k = 0; k < 2; k++) {
        const size_t nodes = kinds[k + 2];
        double good = 0, worse = 1;
        element p;
        size_t undecided = 0;
        for (int step = 0; step < 60; step++) {
            const double t = (good + worse) / 2;
            for (size_t v = 0; v < nodes; v++)
                for (size_t i = 0; i < 3; i++)
                    p[v][i] = (1 - t) * regular[nodes][v][i] + t * (*bad[k])[v][i];
            const tm_certificate found = certify(nodes, p);
            undecided += found == TM_UNDECIDED;
            *(found == TM_POSITIVE ? &good : &worse) = t;
            if (worse - good > 1e-10)
                assert_int_not_equal(found, TM_UNDECIDED);
            const double least = least_determinant(nodes, p);
            assert_true(found == TM_POSITIVE ? least > -1e-15 : least < 1e-9);
        }
        assert_true(undecided < 30);
    }
}

/* A prism on a trapezium that has become a triangle, or nearly: a corner of 180°. */
static void test_flat_corner(void **state)
{
    (void)state;
    element p;
    memcpy(p, regular[8], sizeof p);
    p[2][0] = p[2][1] = p[6][0] = p[6][1] = 0.5;
    assert_int_equal(certify(8, p), TM_NOT_POSITIVE);
    p[6][0] = nextafter(0.5, 1);
    assert_int_equal(certify(8, p), TM_NOT_POSITIVE);
    p[2][0] = nextafter(0.5, 1);
    assert_int_not_equal(certify(8, p), TM_NOT_POSITIVE);
    p[2][0] = p[6][0] = 0.5 + 1e-12;
    assert_int_equal(certify(8, p), TM_POSITIVE);
}

/* Differences that overflow: no proof, and no wrong one. */
static void test_overflow(void **state)
{
    (void)state;
    element p;
    for (size_t k = 1; k < KINDS; k++) {
        for (size_t v = 0; v < kinds[k]; v++)
            for (size_t i = 0; i < 3; i++)
                p[v][i] = (regular[kinds[k]][v][i] * 2 - 1) * 1.7e308;
        assert_int_equal(certify(kinds[k], p),
                         kinds[k] == 5 ? TM_POSITIVE : TM_UNDECIDED);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regular_and_inverted),
        cmocka_unit_test(test_inverted_inside),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_random_inverted_inside),
        cmocka_unit_test(test_pyramid_is_bilinear),
        cmocka_unit_test(test_scale),
        cmocka_unit_test(test_near_the_edge),
        cmocka_unit_test(test_flat_corner),
        cmocka_unit_test(test_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
