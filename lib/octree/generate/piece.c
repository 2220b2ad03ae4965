/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "piece.h"

#include "../octree.h"

#include <math.h>
#include <stddef.h>

enum { CORNERS = 8, POINTS = 64 };

/* Of each kind: the faces, counter-clockwise seen from outside; the triples of edges that
 * J_ENS looks at, each with the corner that they leave, and how many of them have which
 * K. The apex of a pyramid is the only corner with another K. */
typedef struct kind {
    unsigned faces;
    tm_piece face[PIECE_FACES];
    unsigned triples;
    uint8_t triple[CORNERS][4];
    unsigned first; /* of them have the K of the kind, the rest that of an apex */
} kind;

static const kind tetrahedron = {
    .faces = 4,
    .face = {{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}},
    .triples = 4,
    .triple = {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 0, 2, 1}},
    .first = 4,
};
static const kind pyramid = {
    .faces = 5,
    .face = {{4, {0, 3, 2, 1}},
             {3, {0, 1, 4}},
             {3, {1, 2, 4}},
             {3, {2, 3, 4}},
             {3, {3, 0, 4}}},
    .triples = 8,
    .triple = {{0, 1, 3, 4},
               {1, 2, 0, 4},
               {2, 3, 1, 4},
               {3, 0, 2, 4},
               {4, 2, 1, 0},
               {4, 3, 2, 1},
               {4, 0, 3, 2},
               {4, 1, 0, 3}},
    .first = 4,
};
static const kind wedge = {
    .faces = 5,
    .face = {{3, {0, 1, 2}},
             {3, {3, 5, 4}},
             {4, {0, 3, 4, 1}},
             {4, {1, 4, 5, 2}},
             {4, {2, 5, 3, 0}}},
    .triples = 6,
    .triple = {{0, 2, 1, 3},
               {1, 0, 2, 4},
               {2, 1, 0, 5},
               {3, 4, 5, 0},
               {4, 5, 3, 1},
               {5, 3, 4, 2}},
    .first = 6,
};
static const kind hexahedron = {
    .faces = 6,
    .face = {{4, {0, 3, 2, 1}},
             {4, {4, 5, 6, 7}},
             {4, {0, 1, 5, 4}},
             {4, {1, 2, 6, 5}},
             {4, {2, 3, 7, 6}},
             {4, {3, 0, 4, 7}}},
    .triples = 8,
    .triple = {{0, 1, 3, 4},
               {1, 2, 0, 5},
               {2, 3, 1, 6},
               {3, 0, 2, 7},
               {4, 7, 5, 0},
               {5, 4, 6, 1},
               {6, 5, 7, 2},
               {7, 6, 4, 3}},
    .first = 8,
};

static const kind *kind_of(const tm_piece *piece)
{
    switch (piece->k) {
    case 4:
        return &tetrahedron;
    case 5:
        return &pyramid;
    case 6:
        return &wedge;
    default:
        return &hexahedron;
    }
}

static void edge_of(unsigned from, unsigned to, int edge[3])
{
    for (int i = 0; i < 3; i++)
        edge[i] = tm_leaf_place[to][i] - tm_leaf_place[from][i];
}

static void normal_of(const uint8_t place[3], int n[3])
{
    int u[3], v[3];
    edge_of(place[0], place[1], u);
    edge_of(place[0], place[2], v);
    n[0] = u[1] * v[2] - u[2] * v[1];
    n[1] = u[2] * v[0] - u[0] * v[2];
    n[2] = u[0] * v[1] - u[1] * v[0];
}

int volume_of_four(unsigned a, unsigned b, unsigned c, unsigned d)
{
    int n[3], w[3];
    normal_of((uint8_t[3]){(uint8_t)a, (uint8_t)b, (uint8_t)c}, n);
    edge_of(a, d, w);
    return n[0] * w[0] + n[1] * w[1] + n[2] * w[2];
}

bool is_convex(const uint8_t place[4])
{
    if (volume_of_four(place[0], place[1], place[2], place[3]) != 0)
        return false;
    int first[3];
    normal_of(place, first);
    for (unsigned i = 0; i < 4; i++) {
        int n[3];
        normal_of((uint8_t[3]){place[i], place[(i + 1) % 4], place[(i + 2) % 4]}, n);
        if (n[0] * first[0] + n[1] * first[1] + n[2] * first[2] <= 0)
            return false;
    }
    return true;
}

piece_face face_of(unsigned k, const uint8_t *place)
{
    piece_face face = 0;
    for (unsigned i = 0; i < k; i++)
        face |= 1U << place[i];
    int n[3];
    normal_of(place, n);
    const int sign = n[0] != 0 ? n[0] : n[1] != 0 ? n[1] : n[2];
    return sign > 0 ? face : face | FACE_TURNS;
}

/* Face f of an element. */
static tm_piece face_at(const tm_piece *piece, unsigned f)
{
    tm_piece face = kind_of(piece)->face[f];
    for (unsigned i = 0; i < face.k; i++)
        face.place[i] = piece->place[face.place[i]];
    return face;
}

unsigned faces_of_piece(const tm_piece *piece, piece_face face[PIECE_FACES])
{
    const unsigned n = kind_of(piece)->faces;
    for (unsigned f = 0; f < n; f++) {
        const tm_piece is = face_at(piece, f);
        face[f] = face_of(is.k, is.place);
    }
    return n;
}

bool is_convex_piece(const tm_piece *piece)
{
    for (unsigned f = 0; f < kind_of(piece)->faces; f++) {
        const tm_piece face = face_at(piece, f);
        if (face.k == 4 && !is_convex(face.place))
            return false;
        for (unsigned i = 0; i < piece->k; i++) {
            if (volume_of_four(face.place[0], face.place[1], face.place[2],
                               piece->place[i]) > 0)
                return false;
        }
    }
    return true;
}

int volume_of(const tm_piece *piece)
{
    int volume = 0;
    for (unsigned f = 0; f < kind_of(piece)->faces; f++) {
        const tm_piece face = face_at(piece, f);
        for (unsigned i = 2; i < face.k; i++)
            volume -= volume_of_four(face.place[0], face.place[i - 1], face.place[i],
                                     piece->place[0]);
    }
    return volume;
}

/* Points that are evenly spread, on no plane through places: multiples of a vector that
 * is far from rational (Roberts 2018, with the root of x^4 = x + 1). */
static void point(unsigned i, double at[3])
{
    static const double root = 1.2207440846057596;
    double step = 1;
    for (unsigned k = 0; k < 3; k++) {
        step /= root;
        at[k] = 2 * fmod(step * (i + 1), 1);
    }
}

uint64_t points_in(const tm_piece *piece)
{
    uint64_t in = UINT64_MAX;
    for (unsigned f = 0; f < kind_of(piece)->faces; f++) {
        const tm_piece face = face_at(piece, f);
        const unsigned char *origin = tm_leaf_place[face.place[0]];
        int n[3];
        normal_of(face.place, n);
        for (unsigned i = 0; i < POINTS; i++) {
            double at[3];
            point(i, at);
            if (n[0] * (at[0] - origin[0]) + n[1] * (at[1] - origin[1]) +
                    n[2] * (at[2] - origin[2]) >
                0)
                in &= ~((uint64_t)1 << i);
        }
    }
    return in;
}

static double length_of(const int u[3])
{
    return sqrt((double)(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]));
}

static double normalised(const uint8_t *place, const uint8_t triple[4], double k)
{
    const unsigned at = place[triple[0]];
    double length = 1;
    for (unsigned i = 1; i < 4; i++) {
        int u[3];
        edge_of(at, place[triple[i]], u);
        length *= length_of(u);
    }
    const int volume =
        volume_of_four(at, place[triple[1]], place[triple[2]], place[triple[3]]);
    const double js = volume / length;
    return js > k ? 1 + k - js : js < -k ? -(1 + k) - js : js / k;
}

double quality_of(const tm_piece *piece)
{
    const kind *is = kind_of(piece);
    const double k = is == &hexahedron ? 1
                     : is == &wedge    ? sqrt(3) / 2
                     : is == &pyramid  ? sqrt(6) / 3
                                       : sqrt(2) / 2;
    const double apex = 2 * sqrt(6) / 9;
    double worst = 1;
    for (unsigned t = 0; t < is->triples; t++)
        worst = fmin(worst,
                     normalised(piece->place, is->triple[t], t < is->first ? k : apex));
    return worst;
}
