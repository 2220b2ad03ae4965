/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random elements and rows on few nodes or around one: who shares a face agrees with a
 * comparison of each face with each. */
#include "../../lib/mesh/face_table.h"
#include "../../lib/mesh/polygon_table.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { ELEMENTS = 40, ROWS = 12, NODES = 40, ROUNDS = 300, HALVES = 8 * ELEMENTS };

typedef struct soup {
    tm_mesh_view mesh;
    size_t start[ELEMENTS + 1];
    uint32_t item[8 * ELEMENTS];
    uint32_t face[ROWS][3];
    size_t facet_start[ROWS + 1];
    uint32_t facet_node[4 * ROWS];
} soup;

/* A face of an element, or a row. */
typedef struct polygon {
    uint32_t id;
    uint32_t node[4];
    size_t k;
} polygon;

/* Different nodes, mostly; the first is `hub`. */
static void random_nodes(uint32_t *n, size_t k, unsigned nodes, uint32_t hub)
{
    for (size_t i = 0; i < k; i++) {
        n[i] = i == 0 ? hub : random_below(nodes);
        for (size_t j = 0; j < i; j++)
            if (n[j] == n[i] && random_below(50) > 0) {
                i--;
                break;
            }
    }
}

static void make(soup *s, bool mixed)
{
    static const size_t kinds[] = {4, 5, 6, 8};
    const unsigned nodes = 9 + random_below(NODES - 8);
    const uint32_t hub = random_below(3) ? random_below(nodes) : 0;
    *s = (soup){.mesh = {.nodes = nodes,
                         .elements = random_below(ELEMENTS + 1),
                         .faces = random_below(ROWS + 1),
                         .facets = mixed ? random_below(ROWS + 1) : 0}};
    for (size_t e = 0; e < s->mesh.elements; e++) {
        const size_t k = kinds[mixed ? random_below(4) : 0];
        s->start[e + 1] = s->start[e] + k;
        random_nodes(s->item + s->start[e], k, nodes, hub);
        /* So that faces meet. */
        if (e > 0 && random_below(3) > 0)
            memcpy(s->item + s->start[e] + 1,
                   s->item + s->start[random_below((unsigned)e)] + 1,
                   3 * sizeof *s->item);
    }
    for (size_t r = 0; r < s->mesh.faces; r++)
        random_nodes(s->face[r], 3, nodes, hub);
    for (size_t r = 0; r < s->mesh.facets; r++) {
        const size_t k = 3 + random_below(2);
        s->facet_start[r + 1] = s->facet_start[r] + k;
        random_nodes(s->facet_node + s->facet_start[r], k, nodes, hub);
    }
    s->mesh.start = mixed ? s->start : NULL;
    s->mesh.item = s->item;
    s->mesh.face = (const uint32_t(*)[3])s->face;
    s->mesh.facet_start = s->facet_start;
    s->mesh.facet_node = s->facet_node;
}

static bool has_twice(const uint32_t *n, size_t k)
{
    for (size_t i = 1; i < k; i++)
        for (size_t j = 0; j < i; j++)
            if (n[i] == n[j])
                return true;
    return false;
}

/* All half faces in ascending order, then the rows. */
static size_t list_polygons(const soup *s, polygon *all)
{
    const tm_mesh_view *mesh = &s->mesh;
    size_t count = 0, k;
    for (size_t e = 0; e < mesh->elements; e++) {
        const uint32_t *n = tm_mesh_view_nodes(mesh, e, &k);
        for (size_t i = 0; i < tm_element_shapes[k].faces && !has_twice(n, k); i++) {
            const uint8_t *face = tm_element_shapes[k].face[i];
            polygon p = {tm_half_face(mesh, e, i), {0}, tm_mixed_face_nodes(face)};
            uint32_t node[4];
            for (size_t j = 0; j < p.k; j++)
                p.node[j] = n[face[j]];
            assert_int_equal(tm_half_face_nodes(mesh, p.id, node), p.k);
            assert_int_equal(tm_polygon_compare(node, p.node, p.k), 1);
            all[count++] = p;
        }
    }
    const uint32_t first_row = (uint32_t)tm_half_faces(mesh);
    for (uint32_t r = 0; r < mesh->faces + mesh->facets; r++) {
        const size_t f = r - mesh->faces;
        const bool is_facet = r >= mesh->faces;
        polygon p = {
            first_row + r, {0}, is_facet ? s->facet_start[f + 1] - s->facet_start[f] : 3};
        memcpy(p.node, is_facet ? s->facet_node + s->facet_start[f] : s->face[r],
               p.k * sizeof *p.node);
        assert_int_equal(tm_row_is_face(mesh, r), !has_twice(p.node, p.k));
        all[count++] = p;
    }
    return count;
}

static bool are_same(const polygon *p, const polygon *q)
{
    return p->k == q->k && !has_twice(p->node, p->k) &&
           tm_polygon_compare(p->node, q->node, p->k) != 0;
}

/* shared[i]: how many half faces have i elements at them, 3 for more. */
static void check_mates(const soup *s, const polygon *all, size_t count, size_t shared[4])
{
    uint32_t *mate;
    const uint32_t first_row = (uint32_t)tm_half_faces(&s->mesh);
    assert_int_equal(tm_face_mates(&mate, &s->mesh, NULL), TM_OK);
    for (size_t i = 0; i < count; i++) {
        uint32_t with[HALVES], before = 0;
        size_t found = 0;
        for (size_t j = 0; j < count; j++)
            if (all[j].id < first_row && (j == i || are_same(&all[j], &all[i]))) {
                before += j < i;
                with[found++] = all[j].id;
            }
        /* In ascending order of elements; of one they have no other. */
        uint32_t expected = TM_NONE;
        if (all[i].id >= first_row)
            expected = found > 0 ? with[0] : TM_NONE;
        else if (found == 1)
            expected = all[i].id;
        else if (before < 2)
            expected = with[1 - before];
        assert_int_equal(mate[all[i].id], expected);
        shared[found < 3 ? found : 3]++;
    }
    free(mate);
}

/* Each is at its smallest node, and listed once; members turn alike if they are. */
static void check_table(const soup *s, const polygon *all, size_t count)
{
    enum { RUNS = 3 };
    tm_face_table lists, table;
    size_t members = 0;
    uint32_t cut[RUNS + 1];
    assert_int_equal(tm_face_table_make(&lists, &s->mesh, 1 + random_below(4), NULL),
                     TM_OK);
    tm_face_table_share(&table, &lists);
    tm_face_table_cut(&table, RUNS, cut);
    assert_true(cut[0] == 0 && cut[RUNS] == s->mesh.nodes);
    for (size_t run = 0; run < RUNS; run++)
        assert_true(cut[run] <= cut[run + 1]);
    for (uint32_t v = 0; v < s->mesh.nodes; v++) {
        uint32_t before[3] = {0}, node[3];
        assert_int_equal(tm_face_table_at(&table, v, NULL), TM_OK);
        tm_face_table_sort(&table);
        members += table.members;
        for (size_t f = 0; f < table.faces; f++) {
            const tm_face *face = &table.face[f];
            const polygon *first = NULL;
            tm_face_others(face, node);
            assert_true(node[0] >= v && node[1] >= node[0] && node[2] >= node[1]);
            assert_true(
                f == 0 || before[0] < node[0] ||
                (before[0] == node[0] && (before[1] < node[1] || before[2] <= node[2])));
            memcpy(before, node, sizeof node);
            for (uint32_t m = face->first; m != TM_FACE_END; m = table.member[m].next) {
                const polygon *p = all;
                while (p->id != table.member[m].id)
                    assert_true(++p < all + count);
                first = first ? first : p;
                if (p != first && !has_twice(p->node, p->k))
                    assert_int_equal(tm_polygon_compare(first->node, p->node, p->k) > 0,
                                     table.member[face->first].turned ==
                                         table.member[m].turned);
            }
        }
    }
    for (size_t i = 0; i < count; i++)
        members -= all[i].k == 3 || !has_twice(all[i].node, all[i].k);
    assert_int_equal(members, 0);
    tm_face_table_free(&table);
    tm_face_table_free(&lists);
}

static void test_soups(void **state)
{
    (void)state;
    static polygon all[HALVES + 2 * ROWS];
    static soup s;
    size_t shared[4] = {0};
    for (size_t round = 0; round < ROUNDS; round++) {
        make(&s, round % 2);
        const size_t count = list_polygons(&s, all);
        check_mates(&s, all, count, shared);
        check_table(&s, all, count);
    }
    for (size_t i = 0; i < 4; i++)
        assert_true(shared[i] > ROUNDS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_soups)};
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
