/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of meshes with known ones; the same for every number of threads. */
#include "../../lib/base/parallel.h"
#include "../../lib/element/tet_quality.h"
#include "../../lib/examine/tet_statistics.h"
#include "../../lib/text/report.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { DIMENSIONS = 3, CORNERS = 4, MANY = 50000 };

/* A regular tetrahedron and the corner of a cube. */
static const double points[][DIMENSIONS] = {{1, 1, 1},   {-1, 1, -1}, {1, -1, -1},
                                            {-1, -1, 1}, {0, 0, 0},   {1, 0, 0},
                                            {0, 1, 0},   {0, 0, 1}};
static const uint32_t two[][CORNERS] = {{0, 1, 2, 3}, {4, 5, 6, 7}};

static tm_tet_statistics measure(const double (*xyz)[DIMENSIONS],
                                 const uint32_t (*tet)[CORNERS], size_t tets,
                                 double limit, unsigned threads)
{
    tm_tet_statistics s;
    memset(&s, 0, sizeof s);
    assert_int_equal(
        tm_tet_statistics_measure(&s, xyz, 8, tet, tets, limit, threads, NULL), TM_OK);
    return s;
}

static void test_two_known(void **state)
{
    (void)state;
    const tm_tet_statistics s = measure(points, two, 2, 30, 1);
    assert_int_equal(s.nodes, 8);
    assert_int_equal(s.tets, 2);
    assert_int_equal(s.bad, 0);
    assert_true(fabs(s.volume - (8.0 / 3 + 1.0 / 6)) < 1e-15);
    assert_true(fabs(s.min_dihedral - 54.735610317245346) < 1e-12);
    assert_true(fabs(s.max_dihedral - 90) < 1e-12);
    assert_int_equal(s.dihedral[10], 3); /* 54.7° */
    assert_int_equal(s.dihedral[14], 6); /* 70.5° */
    assert_int_equal(s.dihedral[18], 3); /* 90°, however it is rounded */
    assert_int_equal(s.volume_quality[10], 1);
    assert_int_equal(s.volume_quality[19], 1);
    assert_int_equal(tm_count_through(s.dihedral, 13), 3);
    assert_int_equal(tm_count_through(s.dihedral, 35), 12);
    assert_int_equal(measure(points, two, 2, 60, 1).bad, 1);
}

static void test_flat(void **state)
{
    (void)state;
    static const double square[][DIMENSIONS] = {
        {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const uint32_t tet[][CORNERS] = {{0, 1, 2, 3}};
    const tm_tet_statistics s = measure(square, tet, 1, 30, 1);
    assert_int_equal(s.bad, 1);
    assert_int_equal(s.dihedral[0], 4);
    assert_int_equal(s.dihedral[35], 2);
    for (size_t i = 0; i < TM_LARGE_LIMITS; i++)
        assert_int_equal(s.large[i], 2);
    assert_int_equal(s.volume_quality[0], 1);
    assert_true(s.volume == 0 && s.min_dihedral == 0 && s.max_dihedral == 180);
}

static void test_nothing(void **state)
{
    (void)state;
    const tm_tet_statistics s = measure(NULL, NULL, 0, 30, 4);
    assert_int_equal(s.tets, 0);
    assert_true(s.volume == 0 && s.min_dihedral == 0 && s.max_dihedral == 0);
    assert_true(tm_percent(s.bad, s.tets) == 0);
    tm_text text = {0};
    tm_tet_statistics_table(&text, &s, &s);
    assert_non_null(strstr(text.byte, "tetrahedra"));
    assert_null(strstr(text.byte, "nan"));
    tm_text_free(&text);
}

/* Exactly 150° is not above 150 and not below it; 30° is not below 30. */
static void test_exact_limits(void **state)
{
    (void)state;
    const double pi = 3.14159265358979323846;
    for (int n = 0; n < 200; n++) {
        const double angle = (n % 2 == 0 ? 30 : 150) * pi / 180;
        const double turn = 7 * random_unit();
        const double wedge[][DIMENSIONS] = {{0, 0, 0},
                                            {0, 0, 1},
                                            {cos(turn), sin(turn), 0},
                                            {cos(turn + angle), sin(turn + angle), 0}};
        static const uint32_t tet[][CORNERS] = {{0, 1, 2, 3}};
        const tm_tet_statistics s = measure(wedge, tet, 1, 30, 1);
        assert_int_equal(s.bad, tm_count_through(s.dihedral, 5) > 0);
        assert_int_equal(s.dihedral[n % 2 == 0 ? 6 : 30], 1);
        assert_int_equal(s.large[0], 0);
    }
}

static void random_mesh(double (*xyz)[DIMENSIONS], uint32_t (*tet)[CORNERS])
{
    for (size_t v = 0; v < MANY; v++) {
        for (size_t i = 0; i < DIMENSIONS; i++)
            xyz[v][i] = random_unit();
    }
    for (size_t t = 0; t < MANY; t++) {
        for (size_t i = 0; i < CORNERS; i++)
            tet[t][i] = random_below(MANY);
    }
}

static size_t count_bad(const double (*xyz)[DIMENSIONS], const uint32_t (*tet)[CORNERS],
                        size_t tets)
{
    size_t bad = 0;
    for (size_t t = 0; t < tets; t++)
        bad += tm_tet_sine2(xyz[tet[t][0]], xyz[tet[t][1]], xyz[tet[t][2]],
                            xyz[tet[t][3]]) < tm_bad_sine2(30);
    return bad;
}

static void test_threads(void **state)
{
    (void)state;
    double(*xyz)[DIMENSIONS] = malloc(MANY * sizeof *xyz);
    uint32_t(*tet)[CORNERS] = malloc(MANY * sizeof *tet);
    assert_true(xyz && tet);
    random_mesh(xyz, tet);
    static const size_t counts[] = {1, 8191, 8192, 8193, MANY};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        const double(*const_xyz)[DIMENSIONS] = (const double(*)[DIMENSIONS])xyz;
        const uint32_t(*const_tet)[CORNERS] = (const uint32_t(*)[CORNERS])tet;
        const tm_tet_statistics one = measure(const_xyz, const_tet, counts[i], 30, 1);
        assert_int_equal(one.tets, counts[i]);
        assert_int_equal(one.bad, count_bad(const_xyz, const_tet, counts[i]));
        assert_int_equal(tm_count_through(one.volume_quality, TM_VOLUME_QUALITY_BINS - 1),
                         counts[i]);
        for (unsigned threads = 2; threads < 6; threads++) {
            const tm_tet_statistics more =
                measure(const_xyz, const_tet, counts[i], 30, threads);
            assert_memory_equal(&one, &more, sizeof one);
        }
    }
    free(xyz);
    free(tet);
}

static void mark(void *context, size_t chunk)
{
    ((unsigned char *)context)[chunk]++;
}

static void test_parallel_visits_each_chunk_once(void **state)
{
    (void)state;
    static const size_t chunks[] = {0, 1, 2, 3, 1000};
    static const unsigned threads[] = {0, 1, 2, 7, 1000};
    for (size_t i = 0; i < sizeof chunks / sizeof *chunks; i++) {
        for (size_t j = 0; j < sizeof threads / sizeof *threads; j++) {
            unsigned char visits[1001] = {0};
            tm_parallel(threads[j], chunks[i], mark, visits);
            for (size_t chunk = 0; chunk < sizeof visits; chunk++)
                assert_int_equal(visits[chunk], chunk < chunks[i]);
        }
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_known),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_exact_limits),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_parallel_visits_each_chunk_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
