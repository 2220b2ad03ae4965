/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory runs out in the middle of the work, at every allocation once, that one alone or
 * all later ones too: what is improved is still a valid mesh then, of the same volume,
 * surface and markers. The program is linked with --wrap for malloc, calloc and realloc.
 */
#include "../../lib/tet/improve/improve.h"
#include "../../lib/tet/lepp/lepp.h"
#include "tet_fixture.h"

/* The linker's names. NOLINTBEGIN(bugprone-reserved-identifier) */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);

static size_t allocations, fails_at; /* 0: none fails */
static bool all_later;               /* fail too */

static bool fails(void)
{
    allocations++;
    return allocations == fails_at ||
           (all_later && fails_at > 0 && allocations > fails_at);
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    return fails() ? NULL : __real_realloc(old, size);
}

/* NOLINTEND(bugprone-reserved-identifier) */

typedef tm_status improver(tm_tet_mesh *mesh, tm_error *error);

/* Several targets, growth and shrinking: meshes are kept and come back. */
static tm_status improve(tm_tet_mesh *mesh, tm_error *error)
{
    const tm_improve_options options = {
        .angle = 45, .ops = TM_IMPROVE_ALL_OPS, .passes = 30};
    tm_improve_report report;
    return tm_improve(mesh, &options, &report, error);
}

static tm_status improve_to_size(tm_tet_mesh *mesh, tm_error *error)
{
    const tm_improve_options options = {
        .angle = 30, .ops = TM_IMPROVE_ALL_OPS, .max_growth = 0.8, .passes = 12};
    tm_improve_report report;
    return tm_improve(mesh, &options, &report, error);
}

static tm_status follow_paths(tm_tet_mesh *mesh, tm_error *error)
{
    const tm_lepp_options options = {.algorithm = TM_LEPP_SELECTIVE,
                                     .factor = 1.1,
                                     .angle = 30,
                                     .stop = TM_LEPP_PASSES,
                                     .passes = 2,
                                     .sweeps = TM_SWEEP_SMOOTH | TM_SWEEP_SWAP};
    tm_lepp_report report;
    return tm_lepp_improve(mesh, &options, &report, error);
}

static tm_status insert_delaunay(tm_tet_mesh *mesh, tm_error *error)
{
    const tm_lepp_options options = {
        .algorithm = TM_LEPP_DELAUNAY, .angle = 40, .stop = TM_LEPP_ORIGINAL};
    tm_lepp_report report;
    return tm_lepp_improve(mesh, &options, &report, error);
}

/* Runs with allocation `which` failing; returns how many there were. */
static size_t run(improver *work, size_t which)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    make_mesh(&mesh, &stream, 3, 0.5, true);
    const invariants before = measure_invariants(&mesh);
    allocations = 0;
    fails_at = which;
    const tm_status status = work(&mesh, &error);
    const size_t count = allocations;
    fails_at = 0;
    if (which == 0) {
        assert_int_equal(status, TM_OK);
    } else if (status != TM_OK) {
        assert_int_equal(status, TM_ERROR_SYSTEM);
        assert_string_equal(error.what, "out of memory");
    }
    assert_valid(&mesh);
    const invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    return count;
}

static void test_all(improver *work)
{
    const uint64_t seed = random_bits();
    random_state = seed;
    const size_t count = run(work, 0);
    assert_true(count > 10);
    for (size_t k = 1; k <= 2 * count; k++) {
        random_state = seed;
        all_later = k > count;
        run(work, all_later ? k - count : k);
    }
}

static void test_improve(void **state)
{
    (void)state;
    test_all(improve);
}

static void test_size(void **state)
{
    (void)state;
    test_all(improve_to_size);
}

static void test_paths(void **state)
{
    (void)state;
    test_all(follow_paths);
}

static void test_delaunay(void **state)
{
    (void)state;
    test_all(insert_delaunay);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_improve), cmocka_unit_test(test_size),
        cmocka_unit_test(test_paths), cmocka_unit_test(test_delaunay)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
