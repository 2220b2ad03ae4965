/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh cut into parts and joined again is the mesh that it was; improved in parts, it
 * keeps what an improvement keeps, whatever the threads. */
#include "../../lib/base/array.h"
#include "../../lib/element/tet_quality.h"
#include "../../lib/tet/improve/improve_parts.h"
#include "../../lib/tet/parts/parts.h"
#include "tet_fixture.h"

enum { GRID = 5, PART = 90, KINDS = 3 };

/* The fixture's mesh; with regions; or every other cube of it, which touch at edges. */
static void make(tm_tet_mesh *mesh, tm_stream *stream, int kind)
{
    tm_error error = {0};
    if (kind < 2) {
        make_mesh(mesh, stream, GRID, 0.9, kind == 1);
        return;
    }
    make_grid(stream, GRID, 0, false);
    tm_block *ele = tm_stream_find(stream, ".ele");
    size_t kept = 0;
    for (size_t t = 0; t < ele->count; t++) {
        const size_t cube = t / 6;
        if ((cube % GRID + cube / GRID % GRID + cube / (GRID * GRID)) % 2 == 0)
            memmove(ele->integer + 4 * kept++, ele->integer + 4 * t,
                    4 * sizeof *ele->integer);
    }
    ele->count = kept;
    tm_stream_find(stream, ".face")->count = 0;
    if (tm_tet_mesh_from_stream(mesh, stream, 1, &error) != TM_OK)
        fail_msg("%s", error.what);
    assert_true(mesh->locked.count > 0);
}

static int compare_tets(const void *a, const void *b)
{
    return memcmp(a, b, 4 * sizeof(uint32_t));
}

/* All tetrahedra, by their nodes: sorted. */
static uint32_t (*list_tets(const tm_tet_mesh *mesh))[4]
{
    uint32_t(*list)[4] = malloc(mesh->tets * sizeof *list);
    size_t count = 0;
    assert_non_null(list);
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (tm_tet_lives(mesh, t)) {
            memcpy(list[count], mesh->tet[t], sizeof *list);
            qsort(list[count++], 4, sizeof **list, tm_compare_numbers);
        }
    qsort(list, count, sizeof *list, compare_tets);
    return list;
}

static size_t count_edges(const tm_tet_mesh *mesh)
{
    size_t count = 0;
    for (size_t e = 0; e < mesh->edges; e++)
        count += !mesh->edge[e].gone;
    return count;
}

/* Cut and joined, nothing done: in each round. */
static void test_nothing_done(void **state)
{
    (void)state;
    for (int round = 0; round < 4 * KINDS; round++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        tm_tet_parts parts;
        tm_error error;
        make(&mesh, &stream, round % KINDS);
        const invariants before = measure_invariants(&mesh);
        const size_t tets = mesh.tets, faces = mesh.faces, edges = count_edges(&mesh);
        uint32_t(*all)[4] = list_tets(&mesh);
        assert_int_equal(tm_tet_parts_cut(&parts, &mesh, PART, (unsigned)round, &error),
                         TM_OK);
        assert_true(parts.count > 3);
        for (size_t p = 0; p < parts.count; p++) {
            assert_int_equal(tm_tet_part_take(&parts, p, &mesh, &error), TM_OK);
            assert_valid(&parts.part[p].mesh);
        }
        assert_int_equal(tm_tet_parts_join(&parts, &mesh, 1 + random_below(3), &error),
                         TM_OK);
        assert_valid(&mesh);
        const invariants after = measure_invariants(&mesh);
        assert_same_invariants(&before, &after);
        uint32_t(*again)[4] = list_tets(&mesh);
        assert_true(mesh.tets == tets && mesh.faces == faces);
        assert_int_equal(count_edges(&mesh), edges);
        assert_memory_equal(all, again, tets * sizeof *all);
        free(all);
        free(again);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

/* Moves a node that is inside of a part; its number in the whole, or TM_NONE. */
static uint32_t move_one(tm_tet_part *part)
{
    tm_tet_mesh *mesh = &part->mesh;
    tm_error error;
    for (uint32_t v = 0; v < mesh->nodes; v++) {
        bool inside = true;
        for (size_t f = 0; f < mesh->faces; f++)
            for (int i = 0; i < 3; i++)
                inside = inside && mesh->face[f].node[i] != v;
        const double old = mesh->xyz[v][0];
        if (!inside)
            continue;
        mesh->xyz[v][0] += 0x1p-10;
        if (tm_tet_mesh_check(mesh, &error) == TM_OK)
            return part->node[v];
        mesh->xyz[v][0] = old;
    }
    return TM_NONE;
}

/* What has changed in a part has changed in the whole, and nothing else. */
static void test_one_moved(void **state)
{
    (void)state;
    size_t all = 0;
    for (int round = 0; round < 4 * KINDS; round++) {
        tm_stream stream;
        tm_tet_mesh mesh, old = {0};
        tm_tet_parts parts;
        tm_error error;
        make(&mesh, &stream, round % KINDS);
        assert_int_equal(tm_tet_mesh_copy(&old, &mesh, NULL), TM_OK);
        assert_int_equal(tm_tet_parts_cut(&parts, &mesh, PART, (unsigned)round, &error),
                         TM_OK);
        bool *moved = calloc(mesh.nodes, sizeof *moved);
        assert_non_null(moved);
        for (size_t p = 0; p < parts.count; p++) {
            assert_int_equal(tm_tet_part_take(&parts, p, &mesh, &error), TM_OK);
            const uint32_t v = move_one(&parts.part[p]);
            if (v != TM_NONE)
                moved[v] = true;
            all += v != TM_NONE;
        }
        assert_int_equal(tm_tet_parts_join(&parts, &mesh, 2, &error), TM_OK);
        assert_int_equal(mesh.nodes, old.nodes);
        for (uint32_t v = 0; v < old.nodes; v++)
            if (tm_node_lives(&old, v))
                assert_true(mesh.xyz[v][0] == old.xyz[v][0] + (moved[v] ? 0x1p-10 : 0));
        free(moved);
        tm_tet_mesh_free(&old);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
    assert_true(all > 0);
}

static double least_sine2(const tm_tet_mesh *mesh)
{
    double least = 1;
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (tm_tet_lives(mesh, t))
            least = fmin(least, tm_tet_sine2(x[n[0]], x[n[1]], x[n[2]], x[n[3]]));
    }
    return least;
}

static void improve(tm_tet_mesh *mesh, const tm_improve_options *options)
{
    const invariants before = measure_invariants(mesh);
    const double least = least_sine2(mesh);
    const size_t tets = mesh->tets;
    tm_improve_report report;
    tm_error error;
    assert_int_equal(tm_improve_parts(mesh, options, PART, tm_improve, &report, &error),
                     TM_OK);
    assert_valid(mesh);
    const invariants after = measure_invariants(mesh);
    assert_same_invariants(&before, &after);
    assert_true(least_sine2(mesh) >= fmin(least, tm_bad_sine2(options->angle)) - 1e-12);
    assert_true(report.tets_before == tets && report.bad_after <= report.bad_before);
    assert_true(report.bad_after * tets <= report.bad_before * mesh->tets);
    assert_int_equal(tm_improve_count_bad_angles(mesh, options->angle), report.bad_after);
    if (options->max_growth > 0)
        assert_true((double)mesh->tets <= options->max_growth * (double)tets);
    if (report.bad_before > 0)
        assert_true(tm_improve_operations(&report) > 0);
}

static void assert_same_mesh(const tm_tet_mesh *a, const tm_tet_mesh *b)
{
    assert_true(a->tets == b->tets && a->nodes == b->nodes && a->faces == b->faces);
    assert_memory_equal(a->tet, b->tet, a->tets * sizeof *a->tet);
    for (uint32_t v = 0; v < a->nodes; v++)
        if (tm_node_lives(a, v))
            assert_memory_equal(a->xyz[v], b->xyz[v], sizeof *a->xyz);
}

static void test_improved(void **state)
{
    (void)state;
    const double growth[] = {0, 1, 1.2};
    for (int round = 0; round < 2 * KINDS; round++) {
        tm_stream stream;
        tm_tet_mesh mesh, other = {0};
        make(&mesh, &stream, round % KINDS);
        assert_int_equal(tm_tet_mesh_copy(&other, &mesh, NULL), TM_OK);
        tm_improve_options options = {.angle = 35,
                                      .measure = TM_MEASURE_DIHEDRAL,
                                      .max_growth = growth[random_below(3)],
                                      .ops = TM_IMPROVE_ALL_OPS,
                                      .threads = 1};
        improve(&mesh, &options);
        options.threads = 2 + random_below(3);
        improve(&other, &options);
        assert_same_mesh(&mesh, &other);
        tm_tet_mesh_free(&other);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nothing_done),
                                       cmocka_unit_test(test_one_moved),
                                       cmocka_unit_test(test_improved)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
