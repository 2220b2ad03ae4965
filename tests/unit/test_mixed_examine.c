/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shapes of mixed elements; each kind of them alone; each defect, where it is said to
 * be; random divisions of cubes, which are good. test_mixed_soup.c has what is wrong in
 * many ways at once. */
#include "../../lib/geom/vector.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/element/shape.h"
#include "../../lib/element/jens.h"
#include "../../lib/examine/mixed_volume.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

static const size_t kinds[] = {4, 5, 6, 8};

/* Of each kind, by its number of nodes: positive. */
static const double model[9][8][3] = {
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
static const uint32_t identity[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static tm_examination examine(const tm_mesh_view *mesh)
{
    tm_examination found;
    tm_error error;
    assert_int_equal(tm_element_examine(&found, mesh, 1, &error), TM_OK);
    return found;
}

static size_t all_defects(const tm_examination *found)
{
    size_t count = 0;
    for (int d = 0; d < TM_DEFECTS; d++)
        count += found->defect[d].count;
    return count;
}

/* Exactly one defect, of this kind and at this place. */
static void assert_one(const tm_examination *found, tm_defect d,
                       const uint32_t place[TM_DEFECT_NUMBERS])
{
    assert_int_equal(found->defect[d].count, 1);
    assert_int_equal(all_defects(found), 1);
    for (size_t i = 0; i < TM_DEFECT_NUMBERS; i++)
        assert_int_equal(found->defect[d].place[0][i], place[i]);
}

#define ASSERT_ONE(found, d, ...)                                                        \
    assert_one(found, d, (const uint32_t[TM_DEFECT_NUMBERS]){__VA_ARGS__})

/* One element of k nodes that are where `xyz` says. */
static tm_examination examine_one(size_t k, const double (*xyz)[3])
{
    const size_t start[2] = {0, k};
    return examine(&(tm_mesh_view){
        .nodes = k, .xyz = xyz, .elements = 1, .start = start, .item = identity});
}

/* Faces are outward, each edge is in two of them and runs both ways, corners go along the
 * edges; so a mistake in the table does not stay hidden. */
static void test_shapes(void **state)
{
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        const size_t k = kinds[i];
        const tm_element_shape *s = &tm_element_shapes[k];
        int run[8][8] = {{0}};
        double centre[3] = {0};
        for (size_t v = 0; v < k; v++)
            for (size_t j = 0; j < 3; j++)
                centre[j] += model[k][v][j] / (double)k;
        for (size_t f = 0; f < s->faces; f++) {
            const uint8_t *n = s->face[f];
            double normal[3], out[3];
            tm_triangle_normal(normal, model[k][n[0]], model[k][n[1]], model[k][n[2]]);
            tm_subtract(out, model[k][n[0]], centre);
            assert_true(tm_dot(normal, out) > 0);
            const size_t corners = tm_mixed_face_nodes(n);
            for (size_t j = 0; j < corners; j++) {
                run[n[j]][n[(j + 1) % corners]] |= 1 << f;
            }
        }
        size_t edges = 0;
        for (size_t a = 0; a < 8; a++)
            for (size_t b = 0; b < a; b++) {
                assert_int_equal(run[a][b] != 0, run[b][a] != 0);
                edges += run[a][b] != 0;
            }
        assert_int_equal(edges, s->edges);
        for (size_t e = 0; e < s->edges; e++) {
            const uint8_t *n = s->edge[e], *f = s->edge_face[e];
            assert_int_equal(run[n[0]][n[1]] | run[n[1]][n[0]], 1 << f[0] | 1 << f[1]);
            assert_true(f[0] != f[1]);
        }
        const unsigned char(*corner)[4] = tm_element_shapes[kinds[i]].corner;
        for (size_t c = 0; c < s->corners; c++)
            for (size_t j = 1; j < 4; j++)
                assert_true(run[corner[c][0]][corner[c][j]] != 0);
        assert_in_range(s->determinants, 1, s->corners);
        assert_int_equal(s->kind, i);
        assert_int_equal(tm_element_kind_nodes[i], k);
    }
}

static void test_each_kind(void **state)
{
    (void)state;
    static const double volumes[9] = {[4] = 1. / 6, [5] = 1. / 3, [6] = 0.5, [8] = 1};
    const double areas[9] = {
        [4] = 1.5 + sqrt(0.75), [5] = 1 + sqrt(5), [6] = 3 + sqrt(2), [8] = 6};
    for (size_t i = 0; i < 4; i++) {
        const size_t k = kinds[i];
        const tm_examination found = examine_one(k, model[k]);
        assert_true(tm_examination_is_good(&found));
        assert_int_equal(found.nodes, k);
        assert_int_equal(found.element_count, 1);
        for (size_t j = 0; j < 4; j++)
            assert_int_equal(found.kind[j], i == j);
        assert_int_equal(found.boundary_faces, tm_element_shapes[k].faces);
        assert_int_equal(found.components, 1);
        assert_int_equal(found.unused_nodes, 0);
        assert_int_equal(found.euler, 1);
        assert_true(fabs(found.volume - volumes[k]) < 1e-15);
        assert_true(fabs(found.area - areas[k]) < 1e-14);
    }
}

/* Each corner pushed through the element, and exactly into the plane of its neighbours.
 */
static void test_corners(void **state)
{
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        const size_t k = kinds[i];
        const tm_element_shape *s = &tm_element_shapes[k];
        const unsigned char(*corner)[4] = tm_element_shapes[k].corner;
        for (size_t c = 0; c < s->determinants; c++) {
            double xyz[8][3], middle[3], *x = xyz[corner[c][0]];
            memcpy(xyz, model[k], sizeof xyz);
            for (size_t j = 0; j < 3; j++)
                middle[j] = (xyz[corner[c][1]][j] + xyz[corner[c][2]][j]) / 2;
            memcpy(x, middle, sizeof middle);
            tm_examination found = examine_one(k, (const double(*)[3])xyz);
            ASSERT_ONE(&found, TM_DEGENERATE, 0, TM_NONE);
            for (size_t j = 0; j < 3; j++)
                x[j] = middle[j] + (middle[j] - model[k][corner[c][0]][j]) / 4;
            found = examine_one(k, (const double(*)[3])xyz);
            ASSERT_ONE(&found, TM_INVERTED, 0);
        }
        /* Mirrored, and flat. */
        double mirrored[8][3], flat[8][3];
        for (size_t v = 0; v < 8; v++)
            for (size_t j = 0; j < 3; j++) {
                mirrored[v][j] = model[k][v][j] * (j == 0 ? -1 : 1);
                flat[v][j] = j == 2 ? model[k][v][0] : model[k][v][j] + (double)v / 16;
            }
        tm_examination found = examine_one(k, (const double(*)[3])mirrored);
        const tm_examination upright = examine_one(k, model[k]);
        ASSERT_ONE(&found, TM_INVERTED, 0);
        assert_true(found.volume == -upright.volume);
        found = examine_one(k, (const double(*)[3])flat);
        assert_int_equal(
            found.defect[TM_INVERTED].count + found.defect[TM_DEGENERATE].count, 1);
    }
    /* The apex of a pyramid over three of the corners of its base. */
    double pyramid[8][3];
    memcpy(pyramid, model[5], sizeof pyramid);
    pyramid[2][0] = pyramid[2][1] = 0.25;
    const tm_examination found = examine_one(5, (const double(*)[3])pyramid);
    ASSERT_ONE(&found, TM_INVERTED, 0);
}

/* The area of a warped square against one cut into many, and the volume under it. */
static void test_warped(void **state)
{
    (void)state;
    enum { CUTS = 400 };
    for (int step = 1; step <= 4; step++) {
        double xyz[8][3], area = 5;
        const double h = step / 8.;
        memcpy(xyz, model[8], sizeof xyz);
        xyz[6][2] += h;
        /* z = 1 + h u v; the normal is (-h v, -h u, 1), integrated by midpoints. */
        for (int i = 0; i < CUTS; i++)
            for (int j = 0; j < CUTS; j++) {
                const double u = (i + 0.5) / CUTS, v = (j + 0.5) / CUTS;
                area += sqrt(1 + h * h * (u * u + v * v)) / (CUTS * CUTS);
            }
        area += h; /* two sides with a triangle of area h / 2 more */
        const tm_examination found = examine_one(8, (const double(*)[3])xyz);
        assert_true(tm_examination_is_good(&found));
        assert_true(fabs(found.volume - (1 + h / 4)) < 1e-15);
        assert_true(fabs(found.area - area) < 2e-3 * pow(h, 4));
    }
}

/* Defects of several elements ------------------------------------------------------- */

/* Two cubes beside each other along x, nodes numbered along x, then y, then z. */
static const double two[12][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0},
                                  {1, 1, 0}, {2, 1, 0}, {0, 0, 1}, {1, 0, 1},
                                  {2, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}};
static const uint32_t two_cubes[16] = {0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10};
static const size_t two_start[3] = {0, 8, 16};

static tm_mesh_view cubes(void)
{
    return (tm_mesh_view){
        .nodes = 12, .xyz = two, .elements = 2, .start = two_start, .item = two_cubes};
}

static void test_two_cubes(void **state)
{
    (void)state;
    const tm_mesh_view mesh = cubes();
    const tm_examination found = examine(&mesh);
    assert_true(tm_examination_is_good(&found));
    assert_int_equal(found.boundary_faces, 10);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.euler, 1);
    assert_true(found.volume == 2 && found.area == 10);
}

/* The second cube becomes two wedges or pyramids whose side to the first is a
 * quadrilateral, or is cut along its diagonal. */
static void test_halves(void **state)
{
    (void)state;
    static const size_t start[4] = {0, 8, 14, 20};
    /* Cut by the plane of 1, 7, 11, 5: the side 1 4 10 7 stays. */
    uint32_t item[20] = {0, 1, 4, 3, 6, 7, 10, 9, 1, 5, 2, 7, 11, 8, 1, 4, 5, 7, 10, 11};
    tm_mesh_view mesh = {
        .nodes = 12, .xyz = two, .elements = 3, .start = start, .item = item};
    tm_examination found = examine(&mesh);
    assert_true(tm_examination_is_good(&found));
    assert_true(found.volume == 2);
    assert_int_equal(found.boundary_faces, 12);
    /* Cut by the plane of 1, 2, 11, 10: the side is two triangles. */
    static const uint32_t cut[12] = {1, 7, 10, 2, 8, 11, 1, 10, 4, 2, 11, 5};
    memcpy(item + 8, cut, sizeof cut);
    found = examine(&mesh);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 2);
    /* The quadrilateral and the triangles are on the boundary, which meets itself there.
     */
    assert_int_equal(found.defect[TM_NON_MANIFOLD_EDGE].count, 4);
    assert_int_equal(all_defects(&found), 6);
    static const uint32_t places[2][4] = {{1, 4, 10, TM_FACE_HALVED},
                                          {1, 7, 10, TM_FACE_HALVED}};
    assert_memory_equal(found.defect[TM_UNMATCHED_FACE].place, places, sizeof places);
    assert_int_equal(found.components, 2);
    assert_true(found.volume == 2);
}

static void test_unmatched(void **state)
{
    (void)state;
    static const size_t start[4] = {0, 8, 16, 21};
    uint32_t item[21];
    memcpy(item, two_cubes, sizeof two_cubes);
    memcpy(item + 16, (const uint32_t[]){1, 4, 10, 7, 12}, 5 * sizeof *item);
    double xyz[13][3] = {{0}};
    memcpy(xyz, two, sizeof two);
    xyz[12][0] = 3;
    tm_mesh_view mesh = {.nodes = 13,
                         .xyz = (const double(*)[3])xyz,
                         .elements = 3,
                         .start = start,
                         .item = item};
    /* A third element at the common face. */
    tm_examination found = examine(&mesh);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 1);
    assert_memory_equal(found.defect[TM_UNMATCHED_FACE].place[0],
                        ((const uint32_t[4]){1, 4, 7, 3}), sizeof(uint32_t[4]));
    /* The same four nodes in another order: with the second cube left out. */
    static const size_t less[3] = {0, 8, 13};
    memcpy(item + 8, (const uint32_t[]){1, 10, 4, 7, 2}, 5 * sizeof *item);
    mesh.elements = 2;
    mesh.start = less;
    found = examine(&mesh);
    assert_int_equal(found.defect[TM_UNMATCHED_FACE].count, 1);
    assert_memory_equal(found.defect[TM_UNMATCHED_FACE].place[0],
                        ((const uint32_t[4]){1, 4, 7, TM_FACE_IN_ANOTHER_ORDER}),
                        sizeof(uint32_t[4]));
    assert_int_equal(found.components, 2);
}

static void test_overlapping(void **state)
{
    (void)state;
    /* A pyramid inside of the first cube, on its face to the second, which is left out.
     */
    static const size_t start[3] = {0, 8, 13};
    static const double apex[3] = {0.5, 0.5, 0.5};
    double xyz[13][3];
    uint32_t item[13] = {0, 1, 4, 3, 6, 7, 10, 9, 1, 7, 10, 4, 12};
    memcpy(xyz, two, sizeof two);
    memcpy(xyz[12], apex, sizeof apex);
    const tm_mesh_view mesh = {.nodes = 13,
                               .xyz = (const double(*)[3])xyz,
                               .elements = 2,
                               .start = start,
                               .item = item};
    tm_examination found = examine(&mesh);
    ASSERT_ONE(&found, TM_OVERLAPPING_FACE, 0, 1);
    /* Turned it is inverted, and still on that side. */
    memcpy(item + 8, (const uint32_t[]){1, 4, 10, 7, 12}, 5 * sizeof *item);
    found = examine(&mesh);
    assert_int_equal(found.defect[TM_INVERTED].count, 1);
    assert_int_equal(found.defect[TM_OVERLAPPING_FACE].count, 1);
    assert_int_equal(all_defects(&found), 2);
    /* With its apex on the other side all is well. */
    xyz[12][0] = 1.5;
    found = examine(&mesh);
    assert_true(tm_examination_is_good(&found));
    /* Without a side it does not overlap. */
    xyz[12][0] = 1;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_DEGENERATE, 1, TM_NONE);
}

/* Two cubes that touch in an edge, in a node. */
static void test_contacts(void **state)
{
    (void)state;
    enum { NODES = 15 };
    double xyz[NODES][3];
    uint32_t item[16];
    memcpy(xyz, model[8], sizeof model[8]);
    memcpy(item, identity, sizeof identity);
    for (uint32_t v = 0; v < 8; v++)
        item[8 + v] = v == 0 ? 6 : 7 + v;
    for (size_t v = 1; v < 8; v++)
        for (size_t j = 0; j < 3; j++)
            xyz[7 + v][j] = model[8][v][j] + 1;
    const tm_mesh_view mesh = {.nodes = NODES,
                               .xyz = (const double(*)[3])xyz,
                               .elements = 2,
                               .start = two_start,
                               .item = item};
    tm_examination found = examine(&mesh);
    ASSERT_ONE(&found, TM_NON_MANIFOLD_VERTEX, 6, 2);
    assert_int_equal(found.components, 2);
    assert_int_equal(found.euler, 1);
    /* The second one comes down by one: nodes 2 and 6 are its lower edge. */
    for (size_t v = 8; v < NODES; v++)
        xyz[v][2]--;
    item[8] = 2;
    item[12] = 6;
    xyz[11][2] = 7; /* left over */
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_NON_MANIFOLD_EDGE, 2, 6, 4);
    assert_int_equal(found.unused_nodes, 1);
}

static void test_nodes(void **state)
{
    (void)state;
    static const size_t start[3] = {0, 8, 14};
    uint32_t item[14];
    double xyz[13][3];
    memcpy(item, two_cubes, sizeof item);
    memcpy(item + 8, (const uint32_t[]){1, 5, 2, 7, 5, 8}, 6 * sizeof *item);
    memcpy(xyz, two, sizeof two);
    memcpy(xyz[12], two[3], sizeof xyz[12]);
    tm_mesh_view mesh = {
        .nodes = 12, .xyz = two, .elements = 2, .start = start, .item = item};
    /* It has no part in anything else. */
    tm_examination found = examine(&mesh);
    ASSERT_ONE(&found, TM_DEGENERATE, 1, 5);
    assert_int_equal(found.boundary_faces, 6);
    assert_int_equal(found.components, 1);
    assert_int_equal(found.unused_nodes, 4);
    assert_true(found.volume == 1);
    mesh = cubes();
    mesh.nodes = 13;
    mesh.xyz = (const double(*)[3])xyz;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_DUPLICATE_NODE, 12, 3);
    assert_int_equal(found.unused_nodes, 1);
}

/* Rows ------------------------------------------------------------------------------ */

static tm_examination examine_facet(uint32_t e, uint32_t g, size_t k, const uint32_t *n)
{
    const uint32_t side[1][2] = {{e, g}};
    const size_t start[2] = {0, k};
    tm_mesh_view mesh = cubes();
    mesh.facets = 1;
    mesh.side = side;
    mesh.facet_start = start;
    mesh.facet_node = n;
    return examine(&mesh);
}

static void test_facets(void **state)
{
    (void)state;
    static const struct {
        uint32_t side[2];
        size_t k;
        uint32_t node[5];
        bool good;
    } rows[] = {
        {{0, TM_NONE}, 4, {0, 3, 4, 1}, true}, /* below the first cube, from below */
        {{0, TM_NONE}, 4, {4, 1, 0, 3}, true},
        {{0, TM_NONE}, 4, {0, 1, 4, 3}, false}, /* turned */
        {{1, TM_NONE}, 4, {0, 3, 4, 1}, false}, /* of the other element */
        {{0, 1}, 4, {0, 3, 4, 1}, false},
        {{0, 1}, 4, {1, 4, 10, 7}, true}, /* between them */
        {{1, 0}, 4, {1, 7, 10, 4}, true},
        {{1, 0}, 4, {1, 4, 10, 7}, false},
        {{0, TM_NONE}, 4, {1, 4, 10, 7}, false}, /* not on the boundary */
        {{0, 0}, 4, {1, 4, 10, 7}, false},
        {{0, TM_NONE}, 4, {0, 3, 1, 4}, false}, /* in another order */
        {{0, TM_NONE}, 3, {0, 3, 4}, false},    /* a part of it */
        {{0, TM_NONE}, 4, {0, 3, 3, 1}, false},
        {{0, TM_NONE}, 5, {0, 3, 4, 1, 2}, false},
        {{0, TM_NONE}, 4, {0, 2, 8, 6}, false}, /* of no element */
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        const tm_examination found =
            examine_facet(rows[r].side[0], rows[r].side[1], rows[r].k, rows[r].node);
        if (rows[r].good)
            assert_true(tm_examination_is_good(&found));
        else
            ASSERT_ONE(&found, TM_DANGLING_FACE, 0, 0, 1);
    }
}

static void test_rows(void **state)
{
    (void)state;
    /* A wedge, of which .face has both triangles. */
    static const size_t start[2] = {0, 6};
    uint32_t face[3][3] = {{2, 0, 1}, {3, 4, 5}, {0, 1, 3}};
    uint32_t edge[3][2] = {{4, 1}, {2, 0}, {1, 4}};
    static const uint32_t side[2][2] = {{0, TM_NONE}, {0, TM_NONE}};
    static const size_t facet_start[3] = {0, 4, 8};
    static const uint32_t facet_node[8] = {0, 3, 4, 1, 1, 0, 3, 4};
    tm_mesh_view mesh = {.nodes = 6,
                         .xyz = model[6],
                         .elements = 1,
                         .start = start,
                         .item = identity,
                         .faces = 2,
                         .face = (const uint32_t(*)[3])face,
                         .edges = 2,
                         .edge = (const uint32_t(*)[2])edge,
                         .facets = 1,
                         .side = side,
                         .facet_start = facet_start,
                         .facet_node = facet_node};
    tm_examination found = examine(&mesh);
    assert_true(tm_examination_is_good(&found));
    mesh.faces = 3;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_DANGLING_FACE, 2);
    memcpy(face[2], (const uint32_t[]){0, 2, 1}, sizeof face[2]);
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_REPEATED_FACE, 2, 0);
    mesh.faces = 2;
    mesh.facets = 2;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_REPEATED_FACE, 1, 0, 1);
    mesh.facets = 1;
    mesh.edges = 3;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_REPEATED_EDGE, 2, 0);
    edge[2][1] = 3;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_DANGLING_EDGE, 2);
    edge[2][1] = 1;
    found = examine(&mesh);
    ASSERT_ONE(&found, TM_DANGLING_EDGE, 2);
}

/* Random divisions ------------------------------------------------------------------ */

/* N^3 cubes with nodes moved, but not off the sides. The faces between them are whole or
 * cut along a diagonal; a cube becomes a hexahedron, two wedges, or is joined to a node
 * in its middle by pyramids and tetrahedra. */
enum { N = 5, M = N + 1, GRID = M * M * M, CELLS = N * N * N, MOST = 12 * CELLS };

typedef struct division {
    double xyz[GRID + CELLS][3];
    size_t nodes, elements, facets;
    size_t start[MOST + 1];
    uint32_t item[8 * MOST];
    uint32_t side[MOST][2];
    size_t facet_start[MOST + 1];
    uint32_t facet_node[4 * MOST];
    uint8_t cut[3][GRID]; /* the face of a node along an axis: 0 whole, 1 or 2 */
} division;

static uint32_t node_at(const int p[3])
{
    return (uint32_t)(p[0] + M * (p[1] + M * p[2]));
}

static void add_element(division *d, size_t k, const uint32_t *node)
{
    memcpy(d->item + d->start[d->elements], node, k * sizeof *node);
    d->start[d->elements + 1] = d->start[d->elements] + k;
    d->elements++;
}

/* Joins a polygon, which is outward, to the node in the middle. */
static void join(division *d, size_t k, const uint32_t *n, uint32_t middle)
{
    uint32_t element[5];
    for (size_t i = 0; i < k; i++)
        element[i] = n[k - 1 - i];
    element[k] = middle;
    add_element(d, k + 1, element);
}

static void join_face(division *d, const uint32_t *n, int cut, uint32_t middle)
{
    if (cut == 0) {
        join(d, 4, n, middle);
        return;
    }
    /* Cut 1 is by the diagonal from the node at the lowest place: always n[0] or n[2]. */
    const uint32_t turn[4] = {n[cut - 1], n[cut], n[(cut + 1) % 4], n[(cut + 2) % 4]};
    join(d, 3, turn, middle);
    join(d, 3, (const uint32_t[]){turn[0], turn[2], turn[3]}, middle);
}

static void divide(division *d, const int p[3])
{
    uint32_t n[8];
    int cuts[6], whole = 0;
    for (int v = 0; v < 8; v++)
        n[v] =
            node_at((const int[3]){p[0] + (int)model[8][v][0], p[1] + (int)model[8][v][1],
                                   p[2] + (int)model[8][v][2]});
    for (int f = 0; f < 6; f++) {
        int q[3] = {p[0], p[1], p[2]};
        q[f / 2] += f % 2;
        cuts[f] = d->cut[f / 2][node_at(q)];
        whole += cuts[f] == 0;
    }
    if (whole == 6 && random_below(2)) {
        add_element(d, 8, n);
    } else if (whole == 4 && cuts[4] != 0 && cuts[4] == cuts[5]) {
        const size_t a = (size_t)cuts[4] - 1, b = a + 1, c = a + 2, e = (a + 3) % 4;
        add_element(d, 6,
                    (const uint32_t[]){n[a], n[c], n[b], n[4 + a], n[4 + c], n[4 + b]});
        add_element(d, 6,
                    (const uint32_t[]){n[a], n[e], n[c], n[4 + a], n[4 + e], n[4 + c]});
    } else {
        /* In the order of the faces: low x, high x, low y …; the first node is the lowest
         * or the third one is. */
        static const uint8_t face[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                           {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
        const uint32_t middle = (uint32_t)d->nodes++;
        for (int i = 0; i < 3; i++)
            d->xyz[middle][i] = p[i] + 0.5;
        for (int f = 0; f < 6; f++) {
            uint32_t q[4];
            for (int i = 0; i < 4; i++)
                q[i] = n[face[f][i]];
            join_face(d, q, cuts[f], middle);
        }
    }
}

/* A facet for each face of an element that lies on a side of the whole. */
static void add_facets(division *d)
{
    for (size_t e = 0; e < d->elements; e++) {
        const uint32_t *n = d->item + d->start[e];
        const tm_element_shape *s = &tm_element_shapes[d->start[e + 1] - d->start[e]];
        for (size_t f = 0; f < s->faces; f++) {
            const size_t k = tm_mixed_face_nodes(s->face[f]);
            for (int side = 0; side < 6; side++) {
                size_t on = 0;
                for (size_t i = 0; i < k; i++)
                    on += d->xyz[n[s->face[f][i]]][side / 2] == (side % 2 ? N : 0);
                if (on < k)
                    continue;
                d->side[d->facets][0] = (uint32_t)e;
                d->side[d->facets][1] = TM_NONE;
                const size_t begin = d->facet_start[d->facets++];
                for (size_t i = 0; i < k; i++)
                    d->facet_node[begin + i] = n[s->face[f][i]];
                d->facet_start[d->facets] = begin + k;
            }
        }
    }
}

static void make(division *d)
{
    memset(d, 0, sizeof *d);
    d->nodes = GRID;
    for (int z = 0; z < M; z++)
        for (int y = 0; y < M; y++)
            for (int x = 0; x < M; x++) {
                const int p[3] = {x, y, z};
                const uint32_t v = node_at(p);
                for (int i = 0; i < 3; i++) {
                    const bool inside = p[i] > 0 && p[i] < N;
                    d->xyz[v][i] = p[i] + (inside ? 0.3 * random_unit() - 0.15 : 0);
                    /* Columns of cubes along z are cut alike, so that there are wedges.
                     */
                    const uint8_t cut =
                        random_below(6) ? 0 : 1 + (uint8_t)random_below(2);
                    d->cut[i][v] =
                        i == 2 && z > 0 ? d->cut[2][node_at((int[]){x, y, 0})] : cut;
                }
            }
    for (int c = 0; c < CELLS; c++)
        divide(d, (const int[3]){c % N, c / N % N, c / N / N});
    add_facets(d);
}

static void test_divisions(void **state)
{
    (void)state;
    enum { ROUNDS = 40 };
    division *d = malloc(sizeof *d);
    assert_non_null(d);
    size_t seen[TM_ELEMENT_KINDS] = {0};
    for (int round = 0; round < ROUNDS; round++) {
        make(d);
        const tm_mesh_view mesh = {.nodes = d->nodes,
                                   .xyz = (const double(*)[3])d->xyz,
                                   .elements = d->elements,
                                   .start = d->start,
                                   .item = d->item,
                                   .facets = d->facets,
                                   .side = (const uint32_t(*)[2])d->side,
                                   .facet_start = d->facet_start,
                                   .facet_node = d->facet_node};
        const tm_examination found = examine(&mesh);
        assert_true(tm_examination_is_good(&found));
        assert_int_equal(found.components, 1);
        assert_int_equal(found.euler, 1);
        assert_int_equal(found.unused_nodes, 0);
        assert_int_equal(found.boundary_faces, d->facets);
        assert_true(fabs(found.volume - CELLS) < 1e-11);
        assert_true(fabs(found.area - 6 * N * N) < 1e-11);
        for (size_t k = 0; k < TM_ELEMENT_KINDS; k++)
            seen[k] += found.kind[k];
        tm_examination again;
        tm_error error;
        assert_int_equal(tm_element_examine(&again, &mesh, 3, &error), TM_OK);
        assert_memory_equal(again.defect, found.defect, sizeof found.defect);
        assert_true(again.volume == found.volume && again.area == found.area);
    }
    for (size_t k = 0; k < TM_ELEMENT_KINDS; k++)
        assert_true(seen[k] > 10 * ROUNDS);
    free(d);
}

static void test_nothing(void **state)
{
    (void)state;
    const tm_mesh_view mesh = {.nodes = 0};
    const tm_examination found = examine(&mesh);
    assert_true(tm_examination_is_good(&found));
    assert_int_equal(found.euler, 0);
    assert_true(found.volume == 0 && found.area == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes),    cmocka_unit_test(test_each_kind),
        cmocka_unit_test(test_corners),   cmocka_unit_test(test_warped),
        cmocka_unit_test(test_two_cubes), cmocka_unit_test(test_halves),
        cmocka_unit_test(test_unmatched), cmocka_unit_test(test_overlapping),
        cmocka_unit_test(test_contacts),  cmocka_unit_test(test_nodes),
        cmocka_unit_test(test_facets),    cmocka_unit_test(test_rows),
        cmocka_unit_test(test_divisions), cmocka_unit_test(test_nothing),
    };
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
