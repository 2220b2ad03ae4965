/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Buckets and their edges, aspect ratios and Verdict's measures of elements with known
 * ones, and the same statistics on any number of threads. */
#include "../../lib/element/aspect_ratio.h"
#include "../../lib/element/jens.h"
#include "../../lib/examine/jens_statistics.h"
#include "../../lib/element/verdict.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { KINDS = 4 };

static const uint32_t item[] = {0, 1, 2, 3, 4, 5, 6, 7};
static const size_t kinds[KINDS] = {4, 5, 6, 8};

/* All edges are of length 1. */
static const double regular[9][8][3] = {
    [4] = {{0, 0, 0},
           {1, 0, 0},
           {0.5, TM_SQRT_3 / 2, 0},
           {0.5, TM_SQRT_3 / 6, TM_SQRT_6 / 3}},
    [5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, TM_SQRT_2 / 2}},
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

/* A hexahedron with a plane base of which one corner has the sine q, the others more: its
 * J_ENS is q, to rounding. */
static void hexahedron_of(double p[8][3], double q)
{
    const double side[2] = {sqrt(1 - q * q), q};
    memcpy(p, regular[8], sizeof regular[8]);
    for (size_t v = 0; v < 8; v++) {
        p[v][0] = regular[8][v][0] + side[0] * regular[8][v][1];
        p[v][1] = side[1] * regular[8][v][1];
    }
}

static tm_jens_statistics measure(const tm_elements *elements, tm_jens_request request)
{
    tm_error error;
    tm_jens_statistics s;
    assert_int_equal(tm_jens_statistics_measure(&s, elements, &request, &error), TM_OK);
    return s;
}

/* The bucket of one element: its place, or TM_JENS_BUCKETS for the negative one. */
static size_t bucket_of(const double (*p)[3], size_t nodes)
{
    const size_t start[] = {0, nodes};
    const tm_elements one = {p, 1, start, item};
    const tm_jens_statistics s = measure(&one, (tm_jens_request){.threads = 1});
    size_t found = TM_JENS_BUCKETS, all = s.jens.negative;
    for (size_t i = 0; i < TM_JENS_BUCKETS; i++) {
        all += s.jens.bucket[i];
        found = s.jens.bucket[i] == 1 ? i : found;
    }
    assert_true(all == 1);
    return found;
}

/* Right at an edge the element's own J_ENS decides, exactly, whatever its last digit; a
 * step away there is no doubt. */
static void test_edges(void **state)
{
    (void)state;
    double p[8][3];
    for (size_t i = 0; i < TM_JENS_BUCKETS - 1; i++) {
        const double edge = tm_jens_edge[i];
        assert_true(edge == (i == 0 ? 0.0333 : (double)i / 20));
        hexahedron_of(p, edge + 1e-12);
        assert_int_equal(bucket_of(p, 8), i + 1);
        hexahedron_of(p, edge - 1e-12);
        assert_int_equal(bucket_of(p, 8), i);
        for (int ulps = -4; ulps <= 4; ulps++) {
            hexahedron_of(p, edge + 1e-16 * ulps);
            const size_t expected = tm_jens(8, p, item) < edge ? i : i + 1;
            assert_int_equal(bucket_of(p, 8), expected);
        }
    }
    hexahedron_of(p, 1);
    assert_int_equal(bucket_of(p, 8), TM_JENS_BUCKETS - 1);
    hexahedron_of(p, 0);
    assert_int_equal(bucket_of(p, 8), 0);
    hexahedron_of(p, -1e-9);
    assert_int_equal(bucket_of(p, 8), TM_JENS_BUCKETS);
    /* A regular element that rounding leaves above or below 1 is in the last bucket. */
    for (size_t k = 0; k < KINDS; k++)
        if (kinds[k] != 5)
            assert_int_equal(bucket_of(regular[kinds[k]], kinds[k]), TM_JENS_BUCKETS - 1);
}

static void test_aspect_ratio(void **state)
{
    (void)state;
    static const double of_regular[KINDS] = {1, TM_SQRT_2 / 2, TM_SQRT_3 / 2, 1};
    double p[8][3];
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        assert_near(tm_aspect_ratio(nodes, regular[nodes], item), of_regular[k], 1e-15);
        memset(p, 0, sizeof p);
        assert_true(tm_aspect_ratio(nodes, p, item) == 0);
        for (int e = -1060; e <= 1000; e += 20) { /* subnormal ones, too */
            for (size_t v = 0; v < nodes; v++)
                for (size_t i = 0; i < 3; i++)
                    p[v][i] = ldexp(regular[nodes][v][i], e);
            assert_near(tm_aspect_ratio(nodes, p, item), of_regular[k],
                        e < -1000 ? 1e-3 : 1e-15);
        }
        /* Without height */
        memcpy(p, regular[nodes], sizeof p);
        for (size_t v = 0; v < nodes; v++)
            p[v][2] = 0;
        assert_near(tm_aspect_ratio(nodes, p, item), 0, 0);
    }
    /* A box of 1, 2, 5; a wedge of height 3. */
    memcpy(p, regular[8], sizeof p);
    for (size_t v = 0; v < 8; v++) {
        p[v][1] *= 2;
        p[v][2] *= 5;
    }
    assert_near(tm_aspect_ratio(8, p, item), 0.2, 1e-15);
    memcpy(p, regular[6], sizeof p);
    for (size_t v = 0; v < 6; v++)
        p[v][2] *= 3;
    assert_near(tm_aspect_ratio(6, p, item), TM_SQRT_3 / 6, 1e-15);
    /* The corner of a cube: V = 1/6, mean squared edge 3/2. */
    const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assert_near(tm_aspect_ratio(4, corner, item), sqrt(2) / pow(1.5, 1.5), 1e-15);
    /* A pyramid of base 1 by 3 and height 2. */
    const double pyramid[5][3] = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}, {7, 5, 2}};
    assert_near(tm_aspect_ratio(5, pyramid, item), 1.0 / 3, 1e-15);
}

static void test_verdict(void **state)
{
    (void)state;
    double p[8][3];
    for (size_t k = 0; k < KINDS; k++) {
        const size_t nodes = kinds[k];
        assert_near(tm_verdict_scaled_jacobian(nodes, regular[nodes], item), 1, 1e-15);
        assert_near(tm_verdict_shape(nodes, regular[nodes], item), 1, 1e-15);
        memcpy(p, regular[nodes], sizeof p);
        for (size_t v = 0; v < nodes; v++)
            p[v][2] = -p[v][2];
        assert_near(tm_verdict_scaled_jacobian(nodes, p, item), nodes == 5 ? 0 : -1,
                    1e-15);
        assert_true(tm_verdict_shape(nodes, p, item) == 0);
        memcpy(p[1], p[0], sizeof p[1]);
        assert_true(tm_verdict_scaled_jacobian(nodes, p, item) <= 0);
        memset(p, 0, sizeof p);
        assert_true(tm_verdict_scaled_jacobian(nodes, p, item) == 0);
        assert_true(tm_verdict_shape(nodes, p, item) == 0);
    }
    /* The corner of a cube: J_S is 1 at it and 1/2 at the others. */
    const double corner[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assert_near(tm_verdict_scaled_jacobian(4, corner, item), sqrt(0.5), 1e-15);
    assert_near(tm_verdict_shape(4, corner, item), 3 * pow(2, 1.0 / 3) / 4.5, 1e-15);
    /* A pyramid on a square, as high as its side is long: determinants of 1 over three
     * lateral edges √(3/2), times 2, is above 1; the shape is 1/√2 of such an edge over
     * the height. */
    memcpy(p, regular[5], sizeof p);
    p[4][2] = 1;
    assert_near(tm_verdict_scaled_jacobian(5, p, item), 2 - 2 / pow(1.5, 1.5), 1e-15);
    assert_near(tm_verdict_shape(5, p, item), sqrt(1.5) * sqrt(0.5), 1e-15);
    /* A box of 1, 1, 2 loses shape, but no Jacobian. */
    memcpy(p, regular[8], sizeof p);
    for (size_t v = 4; v < 8; v++)
        p[v][2] = 2;
    assert_near(tm_verdict_scaled_jacobian(8, p, item), 1, 1e-15);
    assert_near(tm_verdict_shape(8, p, item), 3 * pow(4, 1.0 / 3) / 6, 1e-15);
}

enum { MANY = 30000 };

/* Random elements of all kinds: counts and averages against a plain loop; threads. */
static void test_many(void **state)
{
    (void)state;
    static double xyz[1000][3];
    static size_t start[MANY + 1];
    static uint32_t node[MANY * 8];
    for (size_t v = 0; v < 1000; v++)
        for (size_t i = 0; i < 3; i++)
            xyz[v][i] = random_unit();
    double sum = 0, worst = 1;
    size_t negative = 0, below = 0, positive = 0;
    for (size_t e = 0; e < MANY; e++) {
        const size_t nodes = kinds[random_below(KINDS)];
        start[e + 1] = start[e] + nodes;
        for (size_t i = 0; i < nodes; i++)
            node[start[e] + i] = random_below(1000);
        const double q = tm_jens(nodes, xyz, node + start[e]);
        sum += q;
        worst = fmin(worst, q);
        negative += q < 0;
        below += q < -0.25;
        positive += tm_certify(nodes, xyz, node + start[e]) == TM_POSITIVE;
    }
    const tm_elements elements = {xyz, MANY, start, node};
    tm_jens_request request = {
        .threshold = -0.25, .scaled_jacobian = true, .others = true, .certify = true};
    tm_jens_statistics s[2];
    for (unsigned t = 0; t < 2; t++) {
        request.threads = 1 + 2 * t;
        memset(&s[t], 0, sizeof s[t]);
        s[t] = measure(&elements, request);
    }
    assert_true(s[0].elements == MANY && s[0].jens.negative == negative);
    assert_true(s[0].jens.below == below && s[0].jens.all.worst == worst);
    assert_true(s[0].certified[TM_POSITIVE].count == positive);
    assert_near(s[0].jens.all.average, sum / MANY, 1e-12);
    tm_text text[2] = {{0}, {0}};
    for (size_t t = 0; t < 2; t++) {
        tm_json json = {.text = &text[t]};
        tm_json_open(&json, NULL, '{');
        tm_jens_statistics_json(&json, &s[t], &request, 1);
        tm_json_close(&json, '}');
    }
    assert_int_equal(text[0].size, text[1].size);
    assert_memory_equal(text[0].byte, text[1].byte, text[0].size);
    tm_text_free(&text[0]);
    tm_text_free(&text[1]);
}

static void test_nothing(void **state)
{
    (void)state;
    const tm_elements none = {0};
    const tm_jens_statistics s = measure(&none, (tm_jens_request){.others = true});
    assert_true(s.jens.all.worst == 0 && s.jens.all.average == 0);
    assert_true(s.aspect_ratio.worst == 0 && s.verdict_shape.average == 0);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edges),   cmocka_unit_test(test_aspect_ratio),
        cmocka_unit_test(test_verdict), cmocka_unit_test(test_many),
        cmocka_unit_test(test_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
