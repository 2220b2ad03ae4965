/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Memory runs out in the middle of the work, at every allocation once, that one alone or
 * all later ones too: what is improved is still a valid mesh then, of the same volume,
 * surface and markers; what is found or made is the same, or there is no memory for it.
 * The program is linked with --wrap for malloc, calloc and realloc.
 */
#include "../../lib/examine/element_examine.h"
#include "../../lib/mesh/face_table.h"
#include "../../lib/poly/dual/dual.h"
#include "../../lib/poly/partition.h"
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

/* Finds or makes something of a mesh, and says what by take(). */
typedef tm_status maker(const tm_tet_mesh *mesh, tm_error *error);

static uint64_t taken; /* FNV-1a */

static void take(const void *bytes, size_t size)
{
    const uint64_t prime = 0x100000001b3;
    for (size_t i = 0; i < size; i++)
        taken = (taken ^ ((const uint8_t *)bytes)[i]) * prime;
}

static tm_mesh_view view_of(const tm_tet_mesh *mesh)
{
    return (tm_mesh_view){.nodes = mesh->nodes,
                          .xyz = (const double(*)[3])mesh->xyz,
                          .elements = mesh->slots,
                          .item = mesh->tet[0]};
}

static tm_status find_mates(const tm_tet_mesh *mesh, tm_error *error)
{
    const tm_mesh_view view = view_of(mesh);
    uint32_t *mate;
    const tm_status status = tm_face_mates(&mate, &view, error);
    if (status == TM_OK)
        take(mate, tm_half_faces(&view) * sizeof *mate);
    free(mate);
    return status;
}

static tm_status examine(const tm_tet_mesh *mesh, tm_error *error)
{
    const tm_mesh_view view = view_of(mesh);
    tm_examination found;
    const tm_status status = tm_element_examine(&found, &view, 1, error);
    if (status != TM_OK)
        return status;
    take(&found.boundary_faces, sizeof found.boundary_faces);
    take(&found.components, sizeof found.components);
    take(&found.euler, sizeof found.euler);
    take(&found.area, sizeof found.area);
    for (int d = 0; d < TM_DEFECTS; d++)
        take(&found.defect[d].count, sizeof found.defect[d].count);
    return TM_OK;
}

static tm_status cut_as(const tm_tet_mesh *mesh, const tm_poly_options *o,
                        tm_error *error)
{
    tm_partition partition;
    tm_poly_report report;
    const tm_status status = tm_partition_make(&partition, mesh, o, &report, error);
    if (status == TM_OK)
        take(partition.cell, mesh->slots * sizeof *partition.cell);
    tm_partition_free(&partition);
    return status;
}

static tm_status cut(const tm_tet_mesh *mesh, tm_error *error)
{
    return cut_as(mesh,
                  &(tm_poly_options){.repair = true,
                                     .star = TM_STAR_CENTROID,
                                     .absorb = true,
                                     .no_swallow = true,
                                     .threads = 1},
                  error);
}

static tm_status cut_compact(const tm_tet_mesh *mesh, tm_error *error)
{
    return cut_as(mesh,
                  &(tm_poly_options){.mode = TM_POLY_COMPACT,
                                     .cells = 6,
                                     .repair = true,
                                     .star = TM_STAR_BALL,
                                     .threads = 1},
                  error);
}

static tm_status make_dual(const tm_tet_mesh *mesh, tm_error *error)
{
    tm_dual_blocks made;
    tm_dual_report report;
    const tm_dual_options options = {.feature_angle = 30, .convex = true};
    const tm_status status = tm_dual_make(&made, mesh, &options, &report, error);
    if (status == TM_OK) {
        take(made.node.real, 3 * made.node.count * sizeof *made.node.real);
        take(made.facet.item, made.facet.start[made.facet.count] * sizeof(uint32_t));
        take(made.cell.item, made.cell.start[made.cell.count] * sizeof(uint32_t));
    }
    tm_dual_blocks_free(&made);
    return status;
}

static void test_results(void **state)
{
    (void)state;
    static maker *const makers[] = {find_mates, examine, cut, cut_compact, make_dual};
    const uint64_t begin = 0xcbf29ce484222325;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error = {0};
    make_mesh(&mesh, &stream, 2, 0.3, true);
    for (size_t m = 0; m < sizeof makers / sizeof *makers; m++) {
        allocations = 0;
        taken = begin;
        assert_int_equal(makers[m](&mesh, &error), TM_OK);
        const uint64_t right = taken;
        const size_t count = allocations;
        assert_int_not_equal(right, begin);
        assert_true(count > 2);
        for (size_t k = 1; k <= 2 * count; k++) {
            all_later = k > count;
            allocations = 0;
            taken = begin;
            fails_at = all_later ? k - count : k;
            const tm_status status = makers[m](&mesh, &error);
            fails_at = 0;
            assert_true(status == TM_OK ? taken == right : status == TM_ERROR_SYSTEM);
        }
    }
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_improve), cmocka_unit_test(test_size),
        cmocka_unit_test(test_paths), cmocka_unit_test(test_delaunay),
        cmocka_unit_test(test_results)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
