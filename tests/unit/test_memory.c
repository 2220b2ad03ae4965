/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Both engines promise a mesh that is still valid after an error. Here every allocation
 * of a small run fails in its turn: that one alone, then that one and all later ones.
 * Linked with --wrap, so that the library allocates through this file. */
#include "../../lib/tet/improve/improve.h"
#include "../../lib/tet/lepp/lepp.h"
#include "tet_fixture.h"

/* So many allocations are still granted. */
static size_t granted = SIZE_MAX;
static bool all_later;

static bool is_granted(void)
{
    if (granted == SIZE_MAX || granted-- > 0)
        return true;
    granted = all_later ? 0 : SIZE_MAX;
    return false;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);

void *__wrap_malloc(size_t size)
{
    return is_granted() ? __real_malloc(size) : NULL;
}

void *__wrap_calloc(size_t count, size_t size)
{
    return is_granted() ? __real_calloc(count, size) : NULL;
}

void *__wrap_realloc(void *old, size_t size)
{
    return is_granted() ? __real_realloc(old, size) : NULL;
}

/* A run of an engine. */
typedef tm_status (*engine)(tm_tet_mesh *mesh, const void *options, tm_error *error);

static tm_status improve(tm_tet_mesh *mesh, const void *options, tm_error *error)
{
    tm_improve_report report;
    return tm_improve(mesh, options, &report, error);
}

static tm_status lepp(tm_tet_mesh *mesh, const void *options, tm_error *error)
{
    tm_lepp_report report;
    return tm_lepp_improve(mesh, options, &report, error);
}

/* Runs the engine on the same mesh again, with so many allocations granted. */
static tm_status run_with(engine run, const void *options, uint64_t seed, size_t most)
{
    enum { GRID = 3 };
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    random_state = seed;
    make_mesh(&mesh, &stream, GRID, 0.9, true);
    invariants before = measure_invariants(&mesh);
    granted = most;
    tm_status status = run(&mesh, options, &error);
    granted = SIZE_MAX;
    assert_valid(&mesh);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    if (status != TM_OK)
        assert_int_equal(status, TM_ERROR_SYSTEM);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    return status;
}

static void fail_in_turn(engine run, const void *options)
{
    enum { SOME = 20 };
    uint64_t seed = random_state;
    for (int k = 0; k < 2; k++) {
        size_t most = 0;
        all_later = k == 1;
        while (run_with(run, options, seed, most) != TM_OK)
            most++;
        assert_true(most > SOME);
    }
}

/* Targets above 30 degrees: all three states to come back to are kept. */
static void test_improve(void **state)
{
    (void)state;
    const tm_improve_options options = {.angle = 40,
                                        .measure = TM_MEASURE_DIHEDRAL,
                                        .passes = 60,
                                        .ops = TM_IMPROVE_ALL_OPS};
    fail_in_turn(improve, &options);
}

static void test_lepp(void **state)
{
    (void)state;
    tm_lepp_options options = {.algorithm = TM_LEPP_SELECTIVE,
                               .factor = 1.1,
                               .angle = 40,
                               .stop = TM_LEPP_PASSES,
                               .passes = 2,
                               .max_growth = 3};
    fail_in_turn(lepp, &options);
    options.sweeps = TM_SWEEP_SMOOTH | TM_SWEEP_SWAP;
    fail_in_turn(lepp, &options);
    options.path = TM_LEPP_FULL;
    options.sweeps = 0;
    options.algorithm = TM_LEPP_DELAUNAY;
    fail_in_turn(lepp, &options);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_improve),
                                       cmocka_unit_test(test_lepp)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
