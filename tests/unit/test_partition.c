/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra out of tetrahedra: the complete test for balls against a slow one, and what
 * every partition of small random meshes promises. */
#include "../../lib/poly/correction.h"
#include "../../lib/poly/facets.h"
#include "../../lib/geom/kernel.h"
#include "../../lib/poly/partition.h"
#include "../../lib/poly/shelling.h"
#include "../../lib/poly/simple.h"
#include "../../lib/tet/operation/ball.h"
#include "tet_fixture.h"

enum { GRID = 3, FACES = 400 };

/* The boundary of a set of tetrahedra, slowly. */
typedef struct {
    size_t faces;
    uint32_t face[FACES][3];
} surface;

static surface surface_of(const tm_tet_mesh *mesh, const uint32_t *piece, uint32_t id)
{
    surface s = {0};
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (uint32_t i = 0; i < 4 && piece[t] == id; i++) {
            uint32_t across = tm_tet_across(mesh, t, i);
            if (across != TM_NONE && piece[across / 4] == id)
                continue;
            assert_true(s.faces < FACES);
            tm_tet_face_below(mesh, t, i, s.face[s.faces++]);
        }
    return s;
}

static bool has(const uint32_t face[3], uint32_t v)
{
    return face[0] == v || face[1] == v || face[2] == v;
}

/* How many faces are reached from face f over edges that have node v; any with TM_NONE.
 */
static size_t reach(const surface *s, size_t f, uint32_t v)
{
    bool seen[FACES] = {false};
    size_t todo[FACES], count = 0;
    seen[f] = true;
    todo[count++] = f;
    for (size_t k = 0; k < count; k++)
        for (size_t g = 0; g < s->faces; g++) {
            int common = 0;
            bool at_node = v == TM_NONE;
            for (int i = 0; i < 3; i++) {
                common += has(s->face[g], s->face[todo[k]][i]);
                at_node |= s->face[todo[k]][i] == v && has(s->face[g], v);
            }
            if (seen[g] || common != 2 || !at_node)
                continue;
            seen[g] = true;
            todo[count++] = g;
        }
    return count;
}

/* Whether the surface is a sphere, by looking at everything. */
static bool is_sphere(const surface *s, size_t nodes)
{
    size_t vertices = 0, edges = 0;
    for (size_t f = 0; f < s->faces; f++)
        for (int i = 0; i < 3; i++) {
            size_t at_edge = 0;
            for (size_t g = 0; g < s->faces; g++)
                at_edge += has(s->face[g], s->face[f][i]) &&
                           has(s->face[g], s->face[f][(i + 1) % 3]);
            if (at_edge != 2)
                return false;
            edges++;
        }
    for (uint32_t v = 0; v < nodes; v++) {
        size_t around = 0, first = 0;
        for (size_t f = s->faces; f > 0; f--)
            if (has(s->face[f - 1], v)) {
                around++;
                first = f - 1;
            }
        vertices += around > 0;
        if (around > 0 && reach(s, first, v) != around)
            return false;
    }
    return reach(s, 0, TM_NONE) == s->faces && vertices + s->faces == edges / 2 + 2;
}

static bool is_ball(const tm_tet_mesh *mesh, const uint32_t *piece, uint32_t id)
{
    surface s = surface_of(mesh, piece, id);
    return s.faces > 0 && is_sphere(&s, mesh->nodes);
}

static bool is_simple(const tm_tet_mesh *mesh, const uint32_t *piece, uint32_t id)
{
    tm_error error;
    bool simple;
    size_t count = 0;
    uint32_t *tet = malloc(mesh->slots * sizeof *tet);
    for (uint32_t t = 0; t < mesh->slots; t++)
        if (piece[t] == id)
            tet[count++] = t;
    assert_int_equal(tm_tets_are_simple(mesh, piece, id, tet, count, &simple, &error),
                     TM_OK);
    free(tet);
    return simple;
}

/* Random sets of tetrahedra, most of them connected. */
static void test_simple(void **state)
{
    (void)state;
    enum { MOST = 60 };
    size_t balls = 0, others = 0;
    for (int k = 0; k < 300; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, GRID, 0.8, false);
        uint32_t *piece = calloc(mesh.slots, sizeof *piece);
        uint32_t t = random_below((unsigned)mesh.slots);
        for (unsigned size = 1 + random_below(MOST); size > 0; size--) {
            piece[t] = 1;
            uint32_t across = mesh.neighbour[t][random_below(4)];
            t = random_below(20) == 0  ? random_below((unsigned)mesh.slots)
                : across & TM_FACE_BIT ? t
                                       : across / 4;
        }
        /* The fixture has marked faces inside; a set is one for both tests anyway. */
        for (size_t f = 0; f < mesh.faces; f++)
            if (mesh.face[f].side[0] != TM_NONE && mesh.face[f].side[1] != TM_NONE)
                tm_tet_join(&mesh, mesh.face[f].side[0], mesh.face[f].side[1]);
        bool ball = is_ball(&mesh, piece, 1);
        assert_int_equal(is_simple(&mesh, piece, 1), ball);
        balls += ball;
        others += !ball;
        free(piece);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
    assert_true(balls > 20 && others > 20);
}

/* A piece does not remember one that had its number before: across each face it grows. */
static void test_number_used_again(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_shelling s;
    tm_error error;
    const tm_poly_options o = {.repair = true};
    size_t grown = 0;
    make_mesh(&mesh, &stream, 3, 0.8, false);
    uint32_t *label = calloc(mesh.slots, sizeof *label);
    assert_int_equal(tm_shelling_start(&s, &mesh, &o, &error), TM_OK);
    for (uint32_t t = 0; t < mesh.slots; t++) {
        const uint32_t across = mesh.neighbour[t][0], u = across / 4;
        if (across & TM_FACE_BIT)
            continue;
        assert_true(tm_shelling_begin(&s, 0, u));
        s.piece[u] = TM_NONE;
        label[t] = label[u] = 1;
        assert_true(tm_shelling_begin(&s, 0, t) && tm_shelling_grow(&s, label, 1));
        assert_int_equal(s.size, 2);
        s.piece[t] = s.piece[u] = TM_NONE;
        label[t] = label[u] = 0;
        grown++;
    }
    assert_true(grown > 20);
    free(label);
    tm_shelling_free(&s);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* Cells that were taken apart for their gains leave none to take apart. */
static void test_calm(void **state)
{
    (void)state;
    size_t taken = 0;
    for (int k = 0; k < 20; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        tm_error error;
        make_mesh(&mesh, &stream, GRID, 0.8, false);
        uint32_t *cell = malloc(mesh.slots * sizeof *cell);
        uint32_t *kept = malloc(mesh.slots * sizeof *kept);
        assert_true(cell && kept);
        const size_t most = 1 + mesh.slots / 3;
        size_t cells = most;
        for (uint32_t t = 0; t < mesh.slots; t++)
            cell[t] = t < most ? t : random_below((unsigned)most);
        assert_int_equal(tm_calm_cells(&mesh, cell, &cells, &error), TM_OK);
        taken += cells - most;
        const size_t calm = cells;
        memcpy(kept, cell, mesh.slots * sizeof *cell);
        assert_int_equal(tm_calm_cells(&mesh, cell, &cells, &error), TM_OK);
        assert_int_equal(cells, calm);
        assert_memory_equal(cell, kept, mesh.slots * sizeof *cell);
        free(kept);
        free(cell);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
    assert_true(taken > 0);
}

/* The mesh is the same in another order. */
static void test_sort(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error;
    make_mesh(&mesh, &stream, 4, 0.8, true);
    invariants before = measure_invariants(&mesh);
    assert_int_equal(tm_tet_mesh_sort(&mesh, NULL, 3, &error), TM_OK);
    assert_valid(&mesh);
    invariants after = measure_invariants(&mesh);
    assert_same_invariants(&before, &after);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

/* The radius of the largest ball that sees all of a cell. */
static double kernel_radius(const tm_tet_mesh *mesh, const uint32_t *cell, uint32_t c)
{
    surface s = surface_of(mesh, cell, c);
    double plane[FACES][4], centre[3], radius;
    for (size_t f = 0; f < s.faces; f++) {
        const double *a = mesh->xyz[s.face[f][0]];
        tm_triangle_normal(plane[f], a, mesh->xyz[s.face[f][2]], mesh->xyz[s.face[f][1]]);
        double length = tm_norm(plane[f]);
        for (int x = 0; x < 3; x++)
            plane[f][x] /= length;
        plane[f][3] = tm_dot(plane[f], a);
    }
    assert_true(tm_kernel_ball((const double(*)[4])plane, s.faces, centre, &radius));
    return radius;
}

/* How deep the centroid of a cell is inside of its faces, slowly. */
static double centroid_depth(const tm_tet_mesh *mesh, const uint32_t *cell, uint32_t c)
{
    surface s = surface_of(mesh, cell, c);
    double centre[3] = {0}, volume = 0, depth = HUGE_VAL;
    for (size_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        if (cell[t] != c)
            continue;
        double v = tm_tet_volume(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                                 mesh->xyz[n[3]]);
        volume += v;
        for (int i = 0; i < 4; i++)
            for (int x = 0; x < 3; x++)
                centre[x] += v * mesh->xyz[n[i]][x] / 4;
    }
    for (int x = 0; x < 3; x++)
        centre[x] /= volume;
    for (size_t f = 0; f < s.faces; f++) {
        double normal[3], to[3];
        const double *a = mesh->xyz[s.face[f][0]];
        tm_triangle_normal(normal, a, mesh->xyz[s.face[f][2]], mesh->xyz[s.face[f][1]]);
        tm_subtract(to, a, centre);
        depth = fmin(depth, tm_dot(normal, to) / tm_norm(normal));
    }
    return depth;
}

static double extent_of(const tm_tet_mesh *mesh, const uint32_t *cell, uint32_t c)
{
    surface s = surface_of(mesh, cell, c);
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3], extent2 = 0;
    for (int x = 0; x < 3; x++) {
        high[x] = -HUGE_VAL;
        for (size_t k = 0; k < 3 * s.faces; k++) {
            low[x] = fmin(low[x], mesh->xyz[s.face[k / 3][k % 3]][x]);
            high[x] = fmax(high[x], mesh->xyz[s.face[k / 3][k % 3]][x]);
        }
        extent2 += (high[x] - low[x]) * (high[x] - low[x]);
    }
    return sqrt(extent2);
}

static void check_faces_inside(const tm_tet_mesh *mesh, const uint32_t *cell)
{
    for (size_t f = 0; f < mesh->faces; f++) {
        const uint32_t *side = mesh->face[f].side;
        if (side[0] != TM_NONE && side[1] != TM_NONE)
            assert_int_not_equal(cell[side[0] / 4], cell[side[1] / 4]);
    }
}

static void check_partition(const tm_tet_mesh *mesh, const tm_poly_options *o)
{
    tm_partition partition;
    tm_poly_report report;
    tm_error error;
    assert_int_equal(tm_partition_make(&partition, mesh, o, &report, &error), TM_OK);
    size_t *size = calloc(partition.cells, sizeof *size), missed = 0;
    for (size_t t = 0; t < mesh->slots; t++) {
        assert_true(partition.cell[t] < partition.cells);
        size[partition.cell[t]]++;
        if (t == 0)
            continue;
        uint32_t before = partition.order[t - 1], now = partition.order[t];
        uint32_t from = partition.cell[before], to = partition.cell[now];
        assert_true(from == to ? before < now : from < to);
    }
    for (uint32_t c = 0; c < partition.cells; c++) {
        assert_true(size[c] > 0);
        if (o->max_tets)
            assert_true(size[c] <= o->max_tets);
        if (o->repair)
            assert_true(is_ball(mesh, partition.cell, c));
        if (o->star)
            assert_true(kernel_radius(mesh, partition.cell, c) > 0);
        if (o->star == TM_STAR_CENTROID)
            assert_true(centroid_depth(mesh, partition.cell, c) > 0);
        if (o->star == TM_STAR_RADIUS)
            missed += kernel_radius(mesh, partition.cell, c) <
                      o->radius * extent_of(mesh, partition.cell, c) * (1 - 1e-9);
    }
    if (o->repair)
        check_faces_inside(mesh, partition.cell);
    assert_int_equal(report.cells, partition.cells);
    assert_int_equal(report.not_star, missed);
    free(size);
    tm_partition_free(&partition);
}

static void test_partitions(void **state)
{
    (void)state;
    for (unsigned k = 0; k < 96; k++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, GRID, 0.8, k % 3 == 0);
        tm_poly_options o = {.mode = (tm_poly_mode)(k % TM_POLY_COMPACT),
                             .face_metric = (tm_face_metric)random_below(2),
                             .repair = k % 8 != 1,
                             .star = (tm_poly_star)random_below(4),
                             .radius = random_below(2) ? 0.03 : 0.1,
                             .absorb = random_below(2),
                             .no_swallow = random_below(2),
                             .max_tets = random_below(2) ? 0 : 1 + random_below(20)};
        if (!o.repair)
            o = (tm_poly_options){.mode = o.mode, .face_metric = o.face_metric};
        check_partition(&mesh, &o);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

static size_t cells_of(const tm_tet_mesh *mesh, const tm_poly_options *o)
{
    tm_partition partition;
    tm_poly_report report;
    tm_error error;
    assert_int_equal(tm_partition_make(&partition, mesh, o, &report, &error), TM_OK);
    const size_t cells = partition.cells;
    tm_partition_free(&partition);
    return cells;
}

/* Cells of few tetrahedra are absorbed, but compact ones of even size. */
static void test_absorb(void **state)
{
    (void)state;
    for (int round = 0; round < 5; round++) {
        tm_stream stream;
        tm_tet_mesh mesh;
        make_mesh(&mesh, &stream, GRID, 0.3, false);
        tm_poly_options o = {.repair = true, .threads = 1};
        const size_t fans = cells_of(&mesh, &o);
        o.absorb = true;
        const size_t fewer = cells_of(&mesh, &o);
        o = (tm_poly_options){.mode = TM_POLY_COMPACT,
                              .cells = mesh.slots / 5,
                              .repair = true,
                              .threads = 1};
        const size_t even = cells_of(&mesh, &o);
        o.absorb = true;
        const size_t spared = cells_of(&mesh, &o);
        assert_true(2 * fewer < fans);
        assert_true(3 * spared > 2 * even);
        tm_tet_mesh_free(&mesh);
        tm_stream_free(&stream);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_simple),     cmocka_unit_test(test_number_used_again),
        cmocka_unit_test(test_calm),       cmocka_unit_test(test_sort),
        cmocka_unit_test(test_partitions), cmocka_unit_test(test_absorb),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
