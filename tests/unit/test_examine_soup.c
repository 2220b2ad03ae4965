/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random tetrahedra, triangles and edges on few nodes, wrong in all ways at once: every
 * count agrees with one that is made plainly from the definition. */
#include "../../lib/geom/predicates.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/examine/ranks/examine_ranks.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

enum { NODES = 9, TETS = 12, ROWS = 8, ROUNDS = 20000 };

/* A set of nodes as bits: faces, edges and tetrahedra are such sets here. */
typedef uint32_t node_set;
enum { SETS = 1 << NODES };

typedef struct soup {
    size_t nodes, tets, faces, edges;
    double xyz[NODES][3];
    uint32_t tet[TETS][4];
    uint32_t face[ROWS][3];
    uint32_t edge[ROWS][2];
} soup;

static node_set bit(uint32_t v)
{
    return (node_set)1 << v;
}

static node_set set_of(const uint32_t *n, size_t count)
{
    node_set set = 0;
    for (size_t i = 0; i < count; i++)
        set |= bit(n[i]);
    return set;
}

static size_t size_of(node_set set)
{
    return (size_t)__builtin_popcount(set);
}

static bool contains(node_set set, node_set part)
{
    return (set & part) == part;
}

static soup random_soup(void)
{
    enum { GRID = 3 };
    soup s = {.nodes = 4 + random_below(NODES - 3),
              .tets = random_below(TETS + 1),
              .faces = random_below(ROWS + 1),
              .edges = random_below(ROWS + 1)};
    const unsigned nodes = (unsigned)s.nodes;
    for (size_t v = 0; v < s.nodes; v++)
        for (size_t i = 0; i < 3; i++)
            s.xyz[v][i] = random_below(GRID);
    for (size_t i = 0; i < s.tets * 4; i++)
        s.tet[i / 4][i % 4] = random_below(nodes);
    for (size_t i = 0; i < s.faces * 3; i++)
        s.face[i / 3][i % 3] = random_below(nodes);
    for (size_t i = 0; i < s.edges * 2; i++)
        s.edge[i / 2][i % 2] = random_below(nodes);
    return s;
}

/* The whole tetrahedra that contain a set. */
static size_t whole_with(const soup *s, node_set set, size_t with[TETS])
{
    size_t count = 0;
    for (size_t t = 0; t < s->tets; t++) {
        const node_set nodes = set_of(s->tet[t], 4);
        if (size_of(nodes) == 4 && contains(nodes, set))
            with[count++] = t;
    }
    return count;
}

static size_t count_with(const soup *s, node_set set)
{
    size_t with[TETS];
    return whole_with(s, set, with);
}

static int orientation(const soup *s, const uint32_t n[4])
{
    return tm_orient3d(s->xyz[n[0]], s->xyz[n[1]], s->xyz[n[2]], s->xyz[n[3]]);
}

/* On which side of a face the fourth node of a tetrahedron is. */
static int side(const soup *s, size_t t, node_set face)
{
    uint32_t n[4];
    size_t count = 0;
    for (uint32_t v = 0; v < NODES; v++)
        if (face & bit(v))
            n[count++] = v;
    for (uint32_t v = 0; v < NODES; v++)
        if (set_of(s->tet[t], 4) & ~face & bit(v))
            n[count] = v;
    return orientation(s, n);
}

static void count_faces(const soup *s, size_t count[TM_DEFECTS], size_t *boundary)
{
    for (node_set f = 0; f < SETS; f++) {
        size_t with[TETS];
        const size_t tets = size_of(f) == 3 ? whole_with(s, f, with) : 0;
        *boundary += tets == 1;
        count[TM_UNMATCHED_FACE] += tets > 2;
        if (tets == 2)
            count[TM_OVERLAPPING_FACE] += side(s, with[0], f) * side(s, with[1], f) > 0;
    }
}

static bool is_boundary(const soup *s, node_set face)
{
    return size_of(face) == 3 && count_with(s, face) == 1;
}

static void count_edges(const soup *s, size_t count[TM_DEFECTS])
{
    for (node_set e = 0; e < SETS; e++) {
        size_t faces = 0;
        for (uint32_t v = 0; v < NODES && size_of(e) == 2; v++)
            faces += !(e & bit(v)) && is_boundary(s, e | bit(v));
        count[TM_OPEN_EDGE] += faces % 2 == 1;
        count[TM_NON_MANIFOLD_EDGE] += faces > 2;
    }
}

/* How many groups the edges opposite v in its boundary faces fall into, connected in
 * nodes: the pieces of the vertex' link. */
static size_t fans(const soup *s, uint32_t v)
{
    node_set piece[SETS];
    size_t pieces = 0;
    for (node_set f = 0; f < SETS; f++) {
        if (!(f & bit(v)) || !is_boundary(s, f))
            continue;
        node_set joined = f & ~bit(v);
        for (size_t i = 0; i < pieces;)
            if (piece[i] & joined) {
                joined |= piece[i];
                piece[i] = piece[--pieces];
                i = 0;
            } else {
                i++;
            }
        piece[pieces++] = joined;
    }
    return pieces;
}

static bool same_place(const double p[3], const double q[3])
{
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static void count_tets_and_nodes(const soup *s, size_t count[TM_DEFECTS])
{
    for (size_t t = 0; t < s->tets; t++) {
        count[TM_INVERTED] += orientation(s, s->tet[t]) < 0;
        count[TM_DEGENERATE] += orientation(s, s->tet[t]) == 0;
    }
    for (size_t v = 0; v < s->nodes; v++) {
        bool duplicate = false;
        for (size_t u = 0; u < v; u++)
            duplicate = duplicate || same_place(s->xyz[u], s->xyz[v]);
        count[TM_DUPLICATE_NODE] += duplicate;
        count[TM_NON_MANIFOLD_VERTEX] += fans(s, (uint32_t)v) > 1;
    }
}

/* Rows of `width` nodes: those that repeat one before, and others that no tetrahedron
 * has. */
static void count_rows(const soup *s, const uint32_t *row, size_t rows, size_t width,
                       size_t *dangling, size_t *repeated)
{
    for (size_t r = 0; r < rows; r++) {
        const node_set set = set_of(row + r * width, width);
        bool again = false;
        for (size_t q = 0; q < r && size_of(set) == width; q++)
            again = again || set_of(row + q * width, width) == set;
        *repeated += again;
        *dangling += !again && (size_of(set) < width || count_with(s, set) == 0);
    }
}

static size_t components(const soup *s)
{
    size_t group[TETS], groups = 0;
    for (size_t t = 0; t < s->tets; t++)
        group[t] = t;
    for (size_t pass = 0; pass < s->tets; pass++)
        for (node_set f = 0; f < SETS; f++) {
            size_t with[TETS];
            const size_t tets = size_of(f) == 3 ? whole_with(s, f, with) : 0;
            for (size_t i = 1; i < tets; i++) {
                const size_t a = group[with[i - 1]], b = group[with[i]];
                group[with[i - 1]] = group[with[i]] = a < b ? a : b;
            }
        }
    for (size_t t = 0; t < s->tets; t++)
        groups += group[t] == t && size_of(set_of(s->tet[t], 4)) == 4;
    return groups;
}

static int64_t euler(const soup *s)
{
    int64_t sum = 0;
    for (node_set set = 1; set < SETS; set++) {
        const size_t size = size_of(set), tets = size > 4 ? 0 : count_with(s, set);
        if (size == 4)
            sum -= (int64_t)tets;
        else if (tets > 0)
            sum += size == 2 ? -1 : 1;
    }
    return sum;
}

static size_t unused_nodes(const soup *s)
{
    size_t unused = 0;
    for (uint32_t v = 0; v < s->nodes; v++)
        unused += count_with(s, bit(v)) == 0;
    return unused;
}

/* The same tetrahedra as mixed elements have the same defects. */
static void check_as_mixed(const tm_mesh_view *tets, const tm_examination *found)
{
    size_t start[TETS + 1];
    for (size_t t = 0; t <= tets->elements; t++)
        start[t] = 4 * t;
    tm_mesh_view mesh = *tets;
    mesh.start = start;
    tm_examination mixed;
    assert_int_equal(tm_element_examine(&mixed, &mesh, 1 + random_below(3), NULL), TM_OK);
    assert_true(mixed.mixed && !found->mixed);
    assert_int_equal(mixed.kind[TM_TETRAHEDRON], tets->elements);
    assert_memory_equal(mixed.defect, found->defect, sizeof mixed.defect);
    assert_int_equal(mixed.boundary_faces, found->boundary_faces);
    assert_int_equal(mixed.components, found->components);
    assert_int_equal(mixed.euler, found->euler);
    assert_int_equal(mixed.unused_nodes, found->unused_nodes);
    assert_true(mixed.volume == found->volume);
}

/* One rank, whose slices are all of the mesh, finds the same. */
static void check_as_ranks(const tm_mesh_view *mesh, const tm_examination *found)
{
    const tm_element_slices slices = {*mesh,       mesh->nodes, mesh->elements,
                                      mesh->faces, mesh->edges, mesh->facets};
    tm_examination ranks;
    assert_int_equal(tm_element_examine_ranks(&ranks, &slices, 1, NULL), TM_OK);
    assert_memory_equal(ranks.defect, found->defect, sizeof ranks.defect);
    assert_int_equal(ranks.boundary_faces, found->boundary_faces);
    assert_int_equal(ranks.components, found->components);
    assert_int_equal(ranks.euler, found->euler);
    assert_int_equal(ranks.unused_nodes, found->unused_nodes);
    assert_true(ranks.volume == found->volume && ranks.area == found->area);
}

static void check(const soup *s)
{
    const tm_mesh_view mesh = {.nodes = s->nodes,
                               .xyz = s->xyz,
                               .elements = s->tets,
                               .item = (const uint32_t *)s->tet,
                               .faces = s->faces,
                               .face = s->face,
                               .edges = s->edges,
                               .edge = s->edge};
    const soup before = *s;
    size_t count[TM_DEFECTS] = {0}, boundary = 0;
    tm_examination found;
    assert_int_equal(tm_element_examine(&found, &mesh, 1 + random_below(3), NULL), TM_OK);
    assert_memory_equal(s, &before, sizeof before);
    count_tets_and_nodes(s, count);
    count_faces(s, count, &boundary);
    count_edges(s, count);
    count_rows(s, s->face[0], s->faces, 3, &count[TM_DANGLING_FACE],
               &count[TM_REPEATED_FACE]);
    count_rows(s, s->edge[0], s->edges, 2, &count[TM_DANGLING_EDGE],
               &count[TM_REPEATED_EDGE]);
    for (size_t d = 0; d < TM_DEFECTS; d++)
        if (found.defect[d].count != count[d])
            fail_msg("defects of kind %zu: %zu, not %zu", d, found.defect[d].count,
                     count[d]);
    assert_int_equal(found.boundary_faces, boundary);
    assert_int_equal(found.components, components(s));
    assert_int_equal(found.euler, euler(s));
    assert_int_equal(found.unused_nodes, unused_nodes(s));
    check_as_mixed(&mesh, &found);
    check_as_ranks(&mesh, &found);
}

static void test_random_soups(void **state)
{
    (void)state;
    for (size_t round = 0; round < ROUNDS; round++) {
        const soup s = random_soup();
        check(&s);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_soups)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
