/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The division of a leaf in every state that occurs: the elements fill the cube and
 * nothing else, face to face, their faces on its sides are those of the face rule, none
 * is inverted anywhere, and none is worse than J_ENS 0.36 or the star's worst. */
#include "../../lib/octree/forest/octree.h"
#include "../../lib/octree/transition/transition.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

enum { EDGES = 12, FACES = 6, STATES = 6210, ELEMENT_FACES = 6, MOST_FACES = 512 };

static const double least_quality = 0.36;

/* The faces of an element counter-clockwise seen from outside: their number, then of each
 * how many corners, and which. */
typedef struct shape {
    unsigned faces;
    tm_piece face[ELEMENT_FACES];
} shape;

static const shape tetrahedron = {
    4, {{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}}};
static const shape pyramid = {
    5,
    {{4, {0, 3, 2, 1}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
static const shape wedge = {5,
                            {{3, {0, 1, 2}},
                             {3, {3, 5, 4}},
                             {4, {0, 3, 4, 1}},
                             {4, {1, 4, 5, 2}},
                             {4, {2, 5, 3, 0}}}};
static const shape hexahedron = {6,
                                 {{4, {0, 3, 2, 1}},
                                  {4, {4, 5, 6, 7}},
                                  {4, {0, 1, 5, 4}},
                                  {4, {1, 2, 6, 5}},
                                  {4, {2, 3, 7, 6}},
                                  {4, {3, 0, 4, 7}}}};

static const shape *shape_of(const tm_piece *element)
{
    switch (element->k) {
    case 4:
        return &tetrahedron;
    case 5:
        return &pyramid;
    case 6:
        return &wedge;
    case 8:
        return &hexahedron;
    default:
        fail_msg("an element of %u corners", element->k);
        return NULL;
    }
}

/* Whether a state occurs: a face has a node in its middle only where its edges have. */
static bool occurs(tm_leaf_state state)
{
    for (unsigned e = 0; e < EDGES; e++) {
        const unsigned char *at = tm_leaf_point[TM_LEAF_EDGE + e];
        for (unsigned f = 0; f < FACES; f++) {
            if (at[f / 2] == 2 * (f % 2) && (state >> (EDGES + f) & 1) != 0 &&
                (state >> e & 1) == 0)
                return false;
        }
    }
    return true;
}

/* Calls a test for each of them. */
static void each_state(void (*test)(tm_leaf_state state))
{
    unsigned states = 0;
    for (tm_leaf_state s = 0; s < 1U << TM_LEAF_STATE_BITS; s++) {
        if (occurs(s)) {
            test(s);
            states++;
        }
    }
    assert_int_equal(states, STATES);
}

static void edge_of(unsigned from, unsigned to, int edge[3])
{
    for (int i = 0; i < 3; i++)
        edge[i] = tm_leaf_point[to][i] - tm_leaf_point[from][i];
}

/* Six times the volume of a tetrahedron at a node, in half sides. */
static int determinant(unsigned at, unsigned p, unsigned q, unsigned r)
{
    int u[3], v[3], w[3];
    edge_of(at, p, u);
    edge_of(at, q, v);
    edge_of(at, r, w);
    return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/* Six times the volume inside the faces of an element; no quadrilateral is bent. */
static int volume(const tm_piece *element)
{
    const shape *is = shape_of(element);
    int sum = 0;
    for (unsigned f = 0; f < is->faces; f++) {
        unsigned at[4] = {0};
        for (unsigned i = 0; i < is->face[f].k; i++)
            at[i] = element->point[is->face[f].point[i]];
        sum += determinant(element->point[0], at[0], at[1], at[2]);
        if (is->face[f].k == 4) {
            assert_int_equal(determinant(at[0], at[1], at[2], at[3]), 0);
            sum += determinant(element->point[0], at[0], at[2], at[3]);
        }
    }
    return sum;
}

static void check_volume(tm_leaf_state state)
{
    const tm_transition is = tm_transition_of(state);
    const int cube = 6 * 2 * 2 * 2;
    int sum = 0;
    for (unsigned p = 0; p < is.pieces; p++) {
        const int part = volume(&is.piece[p]);
        assert_true(part > 0);
        sum += part;
    }
    assert_int_equal(sum, cube);
}

static void test_volume(void **state)
{
    (void)state;
    each_state(check_volume);
}

/* A list of faces. A face that is put twice, once from either side, goes. */
typedef struct face_list {
    unsigned n;
    tm_piece face[MOST_FACES];
} face_list;

/* Whether b is a, seen from the other side. */
static bool opposite(const tm_piece *a, const tm_piece *b)
{
    if (a->k != b->k)
        return false;
    for (unsigned shift = 0; shift < a->k; shift++) {
        unsigned same = 0;
        while (same < a->k && a->point[same] == b->point[(shift + a->k - same) % a->k])
            same++;
        if (same == a->k)
            return true;
    }
    return false;
}

static void put_face(face_list *list, const tm_piece *face)
{
    for (unsigned i = 0; i < list->n; i++) {
        if (opposite(&list->face[i], face)) {
            list->face[i] = list->face[--list->n];
            return;
        }
    }
    assert_true(list->n < MOST_FACES);
    list->face[list->n++] = *face;
}

static void turn_over(tm_piece *face)
{
    for (unsigned i = 0; i < face->k / 2U; i++) {
        const uint8_t other = face->point[face->k - 1U - i];
        face->point[face->k - 1U - i] = face->point[i];
        face->point[i] = other;
    }
}

/* Whether the leaf has a node at each point that the elements use, and they use each. */
static void check_places(tm_leaf_state state)
{
    const tm_transition is = tm_transition_of(state);
    uint32_t used = 0;
    for (unsigned p = 0; p < is.pieces; p++) {
        for (unsigned i = 0; i < is.piece[p].k; i++)
            used |= 1U << is.piece[p].point[i];
    }
    assert_int_equal(used, 0xffU | state << TM_LEAF_EDGE |
                               (uint32_t)is.centre << TM_LEAF_CENTRE);
}

/* What is left of the faces of the elements is that of the sides of the leaf. */
static void check_faces(tm_leaf_state state)
{
    const tm_transition is = tm_transition_of(state);
    face_list list = {.n = 0};
    for (unsigned p = 0; p < is.pieces; p++) {
        const shape *as = shape_of(&is.piece[p]);
        for (unsigned f = 0; f < as->faces; f++) {
            tm_piece face = {.k = as->face[f].k};
            for (unsigned i = 0; i < face.k; i++)
                face.point[i] = is.piece[p].point[as->face[f].point[i]];
            put_face(&list, &face);
        }
    }
    for (unsigned f = 0; f < FACES; f++) {
        tm_piece face[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, face);
        const unsigned before = list.n;
        for (unsigned i = 0; i < n; i++) {
            turn_over(&face[i]);
            put_face(&list, &face[i]);
        }
        assert_int_equal(list.n, before - n);
    }
    assert_int_equal(list.n, 0);
    check_places(state);
}

static void test_faces(void **state)
{
    (void)state;
    each_state(check_faces);
}

/* Scaled Jacobian at a corner, over that of the perfect element. */
static double normalised(unsigned at, unsigned p, unsigned q, unsigned r, double k)
{
    int u[3], v[3], w[3];
    edge_of(at, p, u);
    edge_of(at, q, v);
    edge_of(at, r, w);
    const double length = sqrt((double)(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) *
                               (double)(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) *
                               (double)(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]));
    const double js = determinant(at, p, q, r) / length;
    return js > k ? 1 + k - js : js < -k ? -(1 + k) - js : js / k;
}

/* The edges at the corners of an element: corner, then its three neighbours. */
static double worst_corner(const tm_piece *element, unsigned n, const uint8_t corner[][4],
                           double k)
{
    const uint8_t *at = element->point;
    double worst = 1;
    for (unsigned c = 0; c < n; c++)
        worst = fmin(worst, normalised(at[corner[c][0]], at[corner[c][1]],
                                       at[corner[c][2]], at[corner[c][3]], k));
    return worst;
}

static double quality(const tm_piece *element)
{
    static const uint8_t tet[4][4] = {
        {0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}};
    static const uint8_t base[4][4] = {
        {0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}};
    static const uint8_t apex[4][4] = {
        {4, 2, 1, 0}, {4, 3, 2, 1}, {4, 0, 3, 2}, {4, 1, 0, 3}};
    static const uint8_t prism[6][4] = {{0, 2, 1, 3}, {1, 0, 2, 4}, {2, 1, 0, 5},
                                        {3, 4, 5, 0}, {4, 5, 3, 1}, {5, 3, 4, 2}};
    static const uint8_t cube[8][4] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6},
                                       {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1},
                                       {6, 5, 7, 2}, {7, 6, 4, 3}};
    switch (element->k) {
    case 4:
        return worst_corner(element, 4, tet, sqrt(2) / 2);
    case 5:
        return fmin(worst_corner(element, 4, base, sqrt(6) / 3),
                    worst_corner(element, 4, apex, 2 * sqrt(6) / 9));
    case 6:
        return worst_corner(element, 6, prism, sqrt(3) / 2);
    default:
        return worst_corner(element, 8, cube, 1);
    }
}

/* Of the division that joins all pieces of the faces to the centre: the worst element,
 * and how many there are. */
static double star(tm_leaf_state state, unsigned *pieces)
{
    double worst = 1;
    *pieces = 0;
    for (unsigned f = 0; f < FACES; f++) {
        tm_piece face[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, face);
        for (unsigned p = 0; p < n; p++) {
            turn_over(&face[p]);
            face[p].point[face[p].k++] = TM_LEAF_CENTRE;
            worst = fmin(worst, quality(&face[p]));
        }
        *pieces += n;
    }
    return worst;
}

static void check_quality(tm_leaf_state state)
{
    const tm_transition is = tm_transition_of(state);
    double worst = 1;
    for (unsigned p = 0; p < is.pieces; p++)
        worst = fmin(worst, quality(&is.piece[p]));
    unsigned most;
    const double least = fmax(least_quality, star(state, &most) - 1e-12);
    if (!(worst >= least) || is.pieces > most)
        fail_msg("state %#x: %u elements, J_ENS %g; the star has %u, %g", state,
                 is.pieces, worst, most, least);
}

static void test_quality(void **state)
{
    (void)state;
    each_state(check_quality);
}

/* The cell itself; halves and quarters; eighths. */
static void test_hexahedra(void **state)
{
    (void)state;
    const struct {
        tm_leaf_state state;
        unsigned pieces;
    } plain[] = {{0, 1}, {0xf, 2}, {0xff | 3U << (EDGES + 4), 4}, {0x3ffff, 8}};
    for (size_t i = 0; i < sizeof plain / sizeof plain[0]; i++) {
        const tm_transition is = tm_transition_of(plain[i].state);
        assert_int_equal(is.pieces, plain[i].pieces);
        assert_int_equal(is.centre, plain[i].pieces == 8);
        for (unsigned p = 0; p < is.pieces; p++)
            assert_int_equal(is.piece[p].k, 8);
    }
}

/* The edges of an element in the direction of each of its coordinates. The Jacobian at
 * any point is a mean of the determinants of one edge of each, with weights that are not
 * negative, and positive for those at its corners. (At the apex of a pyramid it vanishes,
 * as it has to.) */
typedef struct directions {
    unsigned n[3];
    uint8_t edge[3][4][2];
} directions;

static const directions of_tetrahedron = {{1, 1, 1}, {{{0, 1}}, {{0, 2}}, {{0, 3}}}};
static const directions of_pyramid = {
    {2, 2, 4}, {{{0, 1}, {3, 2}}, {{0, 3}, {1, 2}}, {{0, 4}, {1, 4}, {2, 4}, {3, 4}}}};
static const directions of_wedge = {
    {2, 2, 3}, {{{0, 2}, {3, 5}}, {{0, 1}, {3, 4}}, {{0, 3}, {1, 4}, {2, 5}}}};
static const directions of_hexahedron = {{4, 4, 4},
                                         {{{0, 1}, {3, 2}, {4, 5}, {7, 6}},
                                          {{0, 3}, {1, 2}, {4, 7}, {5, 6}},
                                          {{0, 4}, {1, 5}, {2, 6}, {3, 7}}}};

static int triple_product(const tm_piece *element, const uint8_t edge[3][2])
{
    int u[3][3];
    for (int i = 0; i < 3; i++)
        edge_of(element->point[edge[i][0]], element->point[edge[i][1]], u[i]);
    return u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) -
           u[0][1] * (u[1][0] * u[2][2] - u[1][2] * u[2][0]) +
           u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
}

static void check_inside(tm_leaf_state state)
{
    const tm_transition is = tm_transition_of(state);
    for (unsigned p = 0; p < is.pieces; p++) {
        const tm_piece *element = &is.piece[p];
        const directions *d = element->k == 4   ? &of_tetrahedron
                              : element->k == 5 ? &of_pyramid
                              : element->k == 6 ? &of_wedge
                                                : &of_hexahedron;
        for (unsigned i = 0; i < d->n[0] * d->n[1] * d->n[2]; i++) {
            uint8_t edge[3][2];
            memcpy(edge[0], d->edge[0][i % d->n[0]], sizeof edge[0]);
            memcpy(edge[1], d->edge[1][i / d->n[0] % d->n[1]], sizeof edge[1]);
            memcpy(edge[2], d->edge[2][i / d->n[0] / d->n[1]], sizeof edge[2]);
            if (triple_product(element, edge) < 0)
                fail_msg("state %#x: element %u", state, p);
        }
    }
}

/* No element is inverted anywhere inside. */
static void test_inside(void **state)
{
    (void)state;
    each_state(check_inside);
}

/* What of a state can be seen at one face. */
static tm_leaf_state seen_at(tm_leaf_state state, unsigned f)
{
    tm_leaf_state seen = state & 1U << (EDGES + f);
    for (unsigned e = 0; e < EDGES; e++) {
        if (tm_leaf_point[TM_LEAF_EDGE + e][f / 2] == 2 * (f % 2))
            seen |= state & 1U << e;
    }
    return seen;
}

/* The point of the leaf beyond face f that is at a point on that face. */
static uint8_t beyond(uint8_t place, unsigned f)
{
    for (unsigned p = 0; p < TM_LEAF_CENTRE; p++) {
        bool same = true;
        for (unsigned i = 0; i < 3; i++) {
            const int moved = i != f / 2 ? 0 : f % 2 == 0 ? 2 : -2;
            same = same && tm_leaf_point[p][i] == tm_leaf_point[place][i] + moved;
        }
        if (same)
            return (uint8_t)p;
    }
    fail_msg("place %u is not on face %u", place, f);
    return 0;
}

/* The leaf beyond each face divides it alike, and neither looks at anything else. */
static void check_neighbours(tm_leaf_state state)
{
    for (unsigned f = 0; f < FACES; f++) {
        const tm_leaf_state seen = seen_at(state, f);
        tm_leaf_state across = 0;
        for (unsigned b = 0; b < TM_LEAF_STATE_BITS; b++) {
            if ((seen >> b & 1) != 0)
                across |= 1U << (beyond((uint8_t)(TM_LEAF_EDGE + b), f) - TM_LEAF_EDGE);
        }
        tm_piece here[TM_FACE_PIECES], alone[TM_FACE_PIECES], there[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, here);
        assert_true(n > 0 && n <= TM_FACE_PIECES);
        assert_int_equal(tm_face_pieces(seen, f, alone), n);
        assert_int_equal(tm_face_pieces(across, f ^ 1U, there), n);
        face_list list = {.n = 0};
        for (unsigned p = 0; p < n; p++) {
            assert_int_equal(here[p].k, alone[p].k);
            assert_memory_equal(here[p].point, alone[p].point, here[p].k);
            for (unsigned i = 0; i < here[p].k; i++)
                here[p].point[i] = beyond(here[p].point[i], f);
            put_face(&list, &here[p]);
        }
        assert_int_equal(list.n, n);
        for (unsigned p = 0; p < n; p++)
            put_face(&list, &there[p]);
        assert_int_equal(list.n, 0);
    }
}

static void test_neighbours(void **state)
{
    (void)state;
    each_state(check_neighbours);
}

/* Corner c is at bit 0 of c in x, 1 in y, 2 in z; an edge and a face in the middle of
 * theirs, numbered as octree.h says. */
static void test_places(void **state)
{
    (void)state;
    for (unsigned c = 0; c < 8; c++) {
        for (unsigned i = 0; i < 3; i++)
            assert_int_equal(tm_leaf_point[c][i], 2 * (c >> i & 1));
    }
    for (unsigned e = 0; e < EDGES; e++) {
        const unsigned along = e / 4, low = along == 0 ? 1 : 0, high = along == 2 ? 1 : 2;
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][along], 1);
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][low], 2 * (e & 1));
        assert_int_equal(tm_leaf_point[TM_LEAF_EDGE + e][high], 2 * (e >> 1 & 1));
    }
    for (unsigned f = 0; f < FACES; f++) {
        for (unsigned i = 0; i < 3; i++)
            assert_int_equal(tm_leaf_point[TM_LEAF_FACE + f][i],
                             i == f / 2 ? 2 * (f % 2) : 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_places),  cmocka_unit_test(test_neighbours),
        cmocka_unit_test(test_volume),  cmocka_unit_test(test_faces),
        cmocka_unit_test(test_quality), cmocka_unit_test(test_hexahedra),
        cmocka_unit_test(test_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
