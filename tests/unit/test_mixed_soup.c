/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random mixed elements, triangles, facets and edges on few nodes, wrong in all ways at
 * once: every count agrees with one that is made plainly from the definition. */
#include "../../lib/geom/predicates.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/element/shape.h"
#include "random.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

enum { NODES = 10, ELEMENTS = 6, ROWS = 6, ROUNDS = 8000, FACES = 6 * ELEMENTS };

/* The elements of 4, 5, 6 and 8 nodes, in a positive order. */
static const double model[9][8][3] = {
    [4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    [5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}},
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

typedef struct polygon {
    size_t k;
    uint32_t node[5];
    uint32_t element;
} polygon;

typedef struct soup {
    tm_mesh_view mesh;
    double xyz[NODES][3];
    size_t start[ELEMENTS + 1];
    uint32_t item[8 * ELEMENTS];
    uint32_t face[ROWS][3], edge[ROWS][2];
    uint32_t side[ROWS][2];
    size_t facet_start[ROWS + 1];
    uint32_t facet_node[5 * ROWS];
    int sign[ELEMENTS]; /* 2: names a node twice */
    polygon of[FACES];  /* all faces of the elements that do not */
    size_t faces;
} soup;

static size_t size_of(const soup *s, size_t e)
{
    return s->start[e + 1] - s->start[e];
}

static bool has_twice(const uint32_t *n, size_t k)
{
    for (size_t i = 0; i < k; i++)
        for (size_t j = 0; j < i; j++)
            if (n[i] == n[j])
                return true;
    return false;
}

/* A random row of nodes, most of them different. */
static void random_nodes(uint32_t *n, size_t k, unsigned nodes)
{
    do
        for (size_t i = 0; i < k; i++)
            n[i] = random_below(nodes);
    while (has_twice(n, k) && random_below(40) > 0);
}

/* Mostly some face of some element, as it is, turned, or with two nodes exchanged. */
static size_t random_polygon(const soup *s, uint32_t node[5], unsigned sizes)
{
    if (s->faces > 0 && random_below(4) > 0) {
        const polygon *p = &s->of[random_below((unsigned)s->faces)];
        if (p->k - 3 < sizes) {
            const size_t by = random_below((unsigned)p->k), back = random_below(3) == 0;
            for (size_t i = 0; i < p->k; i++)
                node[i] = p->node[(back ? 2 * p->k - i : i + p->k - by) % p->k];
            return p->k;
        }
    }
    const size_t k = 3 + random_below(sizes);
    random_nodes(node, k, (unsigned)s->mesh.nodes);
    return k;
}

static void add_element(soup *s, size_t e)
{
    static const size_t kinds[] = {4, 5, 6, 8};
    const size_t k = kinds[random_below(s->mesh.nodes < 8 ? 3 : 4)];
    uint32_t *n = s->item + s->start[e];
    s->start[e + 1] = s->start[e] + k;
    random_nodes(n, k, (unsigned)s->mesh.nodes);
    /* So that faces meet: the first nodes are those of a face of an earlier element. */
    if (e > 0 && random_below(3) > 0) {
        const uint32_t *other = s->item + s->start[random_below((unsigned)e)];
        const size_t same = k == 6 || random_below(2) ? 3 : 4;
        if (has_twice(other, same))
            return;
        memcpy(n, other, same * sizeof *n);
        for (size_t i = same; i < k; i++)
            do
                n[i] = random_below((unsigned)s->mesh.nodes);
            while (has_twice(n, i + 1));
    }
}

/* The elements' faces, by the table that test_mixed_examine.c checks. */
static void list_faces(soup *s)
{
    for (size_t e = 0; e < s->mesh.elements; e++) {
        const uint32_t *n = s->item + s->start[e];
        const tm_element_shape *shape = &tm_element_shapes[size_of(s, e)];
        s->sign[e] = has_twice(n, size_of(s, e)) ? 2 : 0;
        for (size_t f = 0; s->sign[e] != 2 && f < shape->faces; f++) {
            polygon *p = &s->of[s->faces++];
            p->k = tm_mixed_face_nodes(shape->face[f]);
            p->element = (uint32_t)e;
            for (size_t i = 0; i < p->k; i++)
                p->node[i] = n[shape->face[f][i]];
        }
    }
}

static void make_rows(soup *s)
{
    const unsigned nodes = (unsigned)s->mesh.nodes;
    uint32_t node[5];
    for (size_t r = 0; r < s->mesh.faces; r++) {
        random_polygon(s, node, 1);
        memcpy(s->face[r], node, sizeof s->face[r]);
    }
    for (size_t r = 0; r < s->mesh.edges; r++)
        for (size_t i = 0; i < 2; i++)
            s->edge[r][i] = random_below(nodes);
    for (size_t r = 0; r < s->mesh.facets; r++) {
        const size_t k = random_polygon(s, s->facet_node + s->facet_start[r], 3);
        s->facet_start[r + 1] = s->facet_start[r] + k;
        s->side[r][0] = random_below((unsigned)s->mesh.elements);
        s->side[r][1] =
            random_below(3) > 0 ? TM_NONE : random_below((unsigned)s->mesh.elements);
        /* Mostly the element that it is a face of. */
        for (size_t f = 0; f < s->faces && random_below(5) > 0; f++)
            if (s->of[f].k == k &&
                memcmp(s->of[f].node, s->facet_node + s->facet_start[r], 12) == 0)
                s->side[r][0] = s->of[f].element;
    }
}

static void make(soup *s)
{
    enum { GRID = 3 };
    *s = (soup){.mesh = {.nodes = 6 + random_below(NODES - 5),
                         .elements = 1 + random_below(ELEMENTS),
                         .faces = random_below(ROWS + 1),
                         .edges = random_below(ROWS + 1),
                         .facets = random_below(ROWS + 1)}};
    for (size_t v = 0; v < s->mesh.nodes; v++)
        for (size_t i = 0; i < 3; i++)
            s->xyz[v][i] = random_below(GRID);
    for (size_t e = 0; e < s->mesh.elements; e++)
        add_element(s, e);
    list_faces(s);
    make_rows(s);
    s->mesh.xyz = (const double(*)[3])s->xyz;
    s->mesh.start = s->start;
    s->mesh.item = s->item;
    s->mesh.face = (const uint32_t(*)[3])s->face;
    s->mesh.edge = (const uint32_t(*)[2])s->edge;
    s->mesh.side = (const uint32_t(*)[2])s->side;
    s->mesh.facet_start = s->facet_start;
    s->mesh.facet_node = s->facet_node;
}

/* From the definition --------------------------------------------------------------- */

/* +1: the same polygon, turning alike; -1: the other way; 0: not the same. */
static int same(const polygon *p, const polygon *q)
{
    for (size_t by = 0; p->k == q->k && by < p->k; by++) {
        size_t alike = 0, against = 0;
        for (size_t i = 0; i < p->k; i++) {
            alike += p->node[i] == q->node[(by + i) % p->k];
            against += p->node[i] == q->node[(by + p->k - i) % p->k];
        }
        if (alike == p->k || against == p->k)
            return alike == p->k ? 1 : -1;
    }
    return 0;
}

static size_t common(const polygon *p, const polygon *q)
{
    size_t count = 0;
    for (size_t i = 0; i < p->k; i++)
        for (size_t j = 0; j < q->k; j++)
            count += p->node[i] == q->node[j];
    return count;
}

static bool has_edge(const polygon *p, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < p->k; i++) {
        const uint32_t c = p->node[i], d = p->node[(i + 1) % p->k];
        if ((a == c && b == d) || (a == d && b == c))
            return true;
    }
    return false;
}

/* The elements at a polygon, the first two faces that are it. */
static size_t elements_at(const soup *s, const polygon *p, const polygon *face[2])
{
    size_t count = 0;
    for (size_t f = 0; f < s->faces; f++)
        if (same(p, &s->of[f]) != 0 && count++ < 2)
            face[count - 1] = &s->of[f];
    return count;
}

static bool is_first(const soup *s, size_t f)
{
    for (size_t g = 0; g < f; g++)
        if (same(&s->of[g], &s->of[f]) != 0)
            return false;
    return true;
}

static int determinant_sign(const soup *s, size_t e, const size_t c[4])
{
    const size_t k = size_of(s, e);
    const uint32_t *n = s->item + s->start[e];
    return tm_orient3d(model[k][c[0]], model[k][c[1]], model[k][c[2]], model[k][c[3]]) *
           tm_orient3d(s->xyz[n[c[0]]], s->xyz[n[c[1]]], s->xyz[n[c[2]]],
                       s->xyz[n[c[3]]]);
}

/* Corner by corner, in the sense in which that of the model is positive. */
static void count_corners(const soup *s, size_t e, size_t count[3])
{
    const size_t k = size_of(s, e);
    const tm_element_shape *shape = &tm_element_shapes[k];
    for (size_t v = 0; v < k; v++) {
        size_t c[5] = {v}, found = 1;
        for (size_t i = 0; i < shape->edges; i++)
            for (size_t j = 0; j < 2; j++)
                if (shape->edge[i][j] == v)
                    c[found++] = shape->edge[i][!j];
        if (found == 5) /* the apex: its edges go to 0 1 2 3 */
            for (size_t i = 0; i < 4; i++)
                count[1 + determinant_sign(s, e,
                                           (size_t[]){v, i, (i + 1) % 4, (i + 2) % 4})]++;
        else
            count[1 + determinant_sign(s, e, c)]++;
    }
}

/* The volume as the integral of the Jacobian of a hexahedron, of which a wedge and a
 * pyramid have edges of length 0: two Gauss points each way are exact. */
static double volume(const soup *s, size_t e)
{
    static const size_t as_hexahedron[9][8] = {[4] = {0, 1, 2, 2, 3, 3, 3, 3},
                                               [5] = {0, 1, 2, 3, 4, 4, 4, 4},
                                               [6] = {0, 2, 1, 1, 3, 5, 4, 4},
                                               [8] = {0, 1, 2, 3, 4, 5, 6, 7}};
    const size_t *corner = as_hexahedron[size_of(s, e)];
    double sum = 0;
    for (int g = 0; g < 8; g++) {
        double at[3], j[3][3] = {{0}};
        for (int d = 0; d < 3; d++)
            at[d] = 0.5 + (g >> d & 1 ? 1 : -1) / sqrt(12);
        for (size_t c = 0; c < 8; c++) {
            const double *x = s->xyz[s->item[s->start[e] + corner[c]]];
            for (int d = 0; d < 3; d++) {
                double slope = 1;
                for (int i = 0; i < 3; i++) {
                    const bool high = model[8][c][i] > 0;
                    slope *= i == d ? (high ? 1 : -1) : high ? at[i] : 1 - at[i];
                }
                for (int i = 0; i < 3; i++)
                    j[d][i] += slope * x[i];
            }
        }
        sum += j[0][0] * (j[1][1] * j[2][2] - j[1][2] * j[2][1]) -
               j[0][1] * (j[1][0] * j[2][2] - j[1][2] * j[2][0]) +
               j[0][2] * (j[1][0] * j[2][1] - j[1][1] * j[2][0]);
    }
    return sum / 8;
}

static void expect_elements(soup *s, tm_examination *x)
{
    for (size_t e = 0; e < s->mesh.elements; e++) {
        size_t count[3] = {0};
        const size_t k = size_of(s, e);
        x->kind[k == 8 ? TM_HEXAHEDRON : k - 4]++;
        if (s->sign[e] == 2) {
            x->defect[TM_DEGENERATE].count++;
            continue;
        }
        count_corners(s, e, count);
        x->defect[TM_INVERTED].count += count[0] > 0;
        x->defect[TM_DEGENERATE].count += count[0] == 0 && count[1] > 0;
        s->sign[e] = (count[0] == 0 && count[2] > 0) - (count[2] == 0 && count[0] > 0);
        x->volume += volume(s, e);
    }
}

static void expect_faces(const soup *s, tm_examination *x)
{
    const polygon *at[2], *others[2];
    for (size_t f = 0; f < s->faces; f++) {
        if (!is_first(s, f))
            continue;
        const polygon *p = &s->of[f];
        const size_t count = elements_at(s, p, at);
        x->euler++;
        x->boundary_faces += count == 1;
        x->defect[TM_UNMATCHED_FACE].count += count > 2;
        const int product = s->sign[p->element] * s->sign[at[count > 1]->element];
        x->defect[TM_OVERLAPPING_FACE].count +=
            count == 2 && product != 0 && same(p, at[1]) == product;
        bool in_another_order = false;
        for (size_t g = 0; g < s->faces; g++) {
            const polygon *q = &s->of[g];
            if (!is_first(s, g) || g == f)
                continue;
            in_another_order |= g < f && p->k == 4 && q->k == 4 && common(p, q) == 4;
            x->defect[TM_UNMATCHED_FACE].count += p->k == 3 && q->k == 4 &&
                                                  common(p, q) == 3 && count == 1 &&
                                                  elements_at(s, q, others) == 1;
        }
        x->defect[TM_UNMATCHED_FACE].count += in_another_order;
    }
}

static bool is_edge(const soup *s, uint32_t a, uint32_t b)
{
    for (size_t f = 0; f < s->faces; f++)
        if (has_edge(&s->of[f], a, b))
            return true;
    return false;
}

/* Fans of boundary faces at v. */
static size_t fans(const soup *s, const bool *boundary, uint32_t v)
{
    size_t fan[FACES], count = 0;
    for (size_t f = 0; f < s->faces; f++) {
        const polygon *p = &s->of[f];
        fan[f] = f;
        if (!boundary[f] || common(p, &(polygon){.k = 1, .node = {v}}) == 0)
            continue;
        count++;
        for (size_t g = 0; g < f; g++)
            for (uint32_t u = 0; boundary[g] && u < s->mesh.nodes; u++) {
                if (fan[g] == fan[f] || !has_edge(p, v, u) || !has_edge(&s->of[g], v, u))
                    continue;
                const size_t old = fan[f];
                count--;
                for (size_t h = 0; h <= f; h++)
                    if (fan[h] == old)
                        fan[h] = fan[g];
            }
    }
    return count;
}

static void expect_nodes(const soup *s, tm_examination *x)
{
    bool boundary[FACES];
    const polygon *at[2];
    for (size_t f = 0; f < s->faces; f++)
        boundary[f] = elements_at(s, &s->of[f], at) == 1;
    for (uint32_t v = 0; v < s->mesh.nodes; v++) {
        bool used = false, duplicate = false;
        for (uint32_t u = 0; u < s->mesh.nodes; u++) {
            const bool edge = u != v && is_edge(s, u, v);
            size_t faces = 0;
            used |= edge;
            duplicate |= u < v && s->xyz[u][0] == s->xyz[v][0] &&
                         s->xyz[u][1] == s->xyz[v][1] && s->xyz[u][2] == s->xyz[v][2];
            x->euler -= u < v && edge;
            for (size_t f = 0; f < s->faces && u < v; f++)
                faces += boundary[f] && has_edge(&s->of[f], u, v);
            x->defect[TM_OPEN_EDGE].count += faces % 2;
            x->defect[TM_NON_MANIFOLD_EDGE].count += faces > 2;
        }
        x->euler += used;
        x->unused_nodes += !used;
        x->defect[TM_DUPLICATE_NODE].count += duplicate;
        x->defect[TM_NON_MANIFOLD_VERTEX].count += fans(s, boundary, v) > 1;
    }
}

static void expect_components(const soup *s, tm_examination *x)
{
    size_t part[ELEMENTS];
    for (size_t e = 0; e < s->mesh.elements; e++) {
        part[e] = e;
        x->components += s->sign[e] != 2;
        x->euler -= s->sign[e] != 2;
    }
    for (size_t f = 0; f < s->faces; f++)
        for (size_t g = 0; g < f; g++) {
            const size_t p = part[s->of[f].element], q = part[s->of[g].element];
            if (same(&s->of[f], &s->of[g]) == 0 || p == q)
                continue;
            x->components--;
            for (size_t e = 0; e < s->mesh.elements; e++)
                if (part[e] == p)
                    part[e] = q;
        }
}

static polygon facet_of(const soup *s, size_t r)
{
    polygon p = {.k = s->facet_start[r + 1] - s->facet_start[r]};
    memcpy(p.node, s->facet_node + s->facet_start[r], p.k * sizeof *p.node);
    return p;
}

static bool is_right(const soup *s, size_t r, const polygon *p)
{
    const polygon *at[2];
    const size_t count = elements_at(s, p, at);
    const uint32_t first = s->side[r][0], second = s->side[r][1];
    if (count != (second == TM_NONE ? 1 : 2))
        return false;
    const bool other = at[0]->element != first;
    if (at[other && count == 2]->element != first ||
        (count == 2 && at[!other]->element != second))
        return false;
    return s->sign[first] == 0 || same(p, at[other]) == s->sign[first];
}

static void expect_rows(const soup *s, tm_examination *x)
{
    const polygon *at[2];
    tm_defect_list *dangling = &x->defect[TM_DANGLING_FACE];
    for (size_t r = 0; r < s->mesh.faces; r++) {
        const uint32_t *n = s->face[r];
        const polygon p = {.k = 3, .node = {n[0], n[1], n[2]}};
        bool repeated = false;
        for (size_t q = 0; q < r && !has_twice(n, 3); q++) {
            const uint32_t *m = s->face[q];
            repeated |= same(&p, &(polygon){.k = 3, .node = {m[0], m[1], m[2]}}) != 0;
        }
        x->defect[TM_REPEATED_FACE].count += repeated;
        dangling->count += !repeated && elements_at(s, &p, at) == 0;
    }
    for (size_t r = 0; r < s->mesh.facets; r++) {
        const polygon p = facet_of(s, r);
        const bool is_face = p.k < 5 && !has_twice(p.node, p.k);
        bool repeated = false;
        for (size_t q = 0; q < r && is_face; q++) {
            const polygon earlier = facet_of(s, q);
            repeated |= same(&p, &earlier) != 0;
        }
        x->defect[TM_REPEATED_FACE].count += repeated;
        dangling->count += !repeated && (!is_face || !is_right(s, r, &p));
    }
    for (size_t r = 0; r < s->mesh.edges; r++) {
        const uint32_t a = s->edge[r][0], b = s->edge[r][1];
        bool repeated = false;
        for (size_t q = 0; q < r && a != b; q++)
            repeated |= has_edge(&(polygon){.k = 2, .node = {a, b}}, s->edge[q][0],
                                 s->edge[q][1]);
        x->defect[TM_REPEATED_EDGE].count += repeated;
        x->defect[TM_DANGLING_EDGE].count += !repeated && (a == b || !is_edge(s, a, b));
    }
}

static void test_soup(void **state)
{
    (void)state;
    size_t seen[TM_DEFECTS] = {0};
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t seed = random_state;
        soup s;
        tm_examination found, expected = {0};
        tm_error error;
        make(&s);
        expect_elements(&s, &expected);
        expect_faces(&s, &expected);
        expect_nodes(&s, &expected);
        expect_components(&s, &expected);
        expect_rows(&s, &expected);
        assert_int_equal(tm_element_examine(&found, &s.mesh, 1 + random_below(3), &error),
                         TM_OK);
        for (tm_defect d = 0; d < TM_DEFECTS; d++) {
            if (found.defect[d].count != expected.defect[d].count)
                fail_msg("round %d, TM_SEED=%" PRIu64
                         ": defects of kind %u: %zu, not %zu",
                         round, seed, d, found.defect[d].count, expected.defect[d].count);
            seen[d] += found.defect[d].count;
        }
        assert_memory_equal(found.kind, expected.kind, sizeof found.kind);
        assert_int_equal(found.boundary_faces, expected.boundary_faces);
        assert_int_equal(found.components, expected.components);
        assert_int_equal(found.unused_nodes, expected.unused_nodes);
        assert_int_equal(found.euler, expected.euler);
        assert_true(fabs(found.volume - expected.volume) < 1e-12);
    }
    for (tm_defect d = 0; d <= TM_REPEATED_EDGE; d++)
        if (seen[d] < 100)
            fail_msg("only %zu defects of kind %u", seen[d], d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_soup)};
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
