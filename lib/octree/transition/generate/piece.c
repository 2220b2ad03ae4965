/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "piece.h"

#include "../../../element/jens.h"
#include "../../forest/octree.h"

#include <math.h>
#include <stddef.h>

enum { SAMPLES = 64 };

/* The order of the faces of each kind, which decides between divisions that are as
 * good. */
static const uint8_t order[TM_ELEMENT_NODES + 1][PIECE_FACES] = {
    [TM_TET_NODES] = {3, 0, 1, 2},
    [TM_PYRAMID_NODES] = {0, 1, 2, 3, 4},
    [TM_WEDGE_NODES] = {0, 1, 2, 3, 4},
    [TM_HEX_NODES] = {4, 5, 2, 1, 3, 0},
};

static void edge_of(unsigned from, unsigned to, int edge[3])
{
    for (int i = 0; i < 3; i++)
        edge[i] = tm_leaf_point[to][i] - tm_leaf_point[from][i];
}

static void normal_of(const uint8_t point[3], int n[3])
{
    int u[3], v[3];
    edge_of(point[0], point[1], u);
    edge_of(point[0], point[2], v);
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

bool is_convex(const uint8_t point[4])
{
    if (volume_of_four(point[0], point[1], point[2], point[3]) != 0)
        return false;
    int first[3];
    normal_of(point, first);
    for (unsigned i = 0; i < 4; i++) {
        int n[3];
        normal_of((uint8_t[3]){point[i], point[(i + 1) % 4], point[(i + 2) % 4]}, n);
        if (n[0] * first[0] + n[1] * first[1] + n[2] * first[2] <= 0)
            return false;
    }
    return true;
}

piece_face face_of(unsigned k, const uint8_t *point)
{
    piece_face face = 0;
    for (unsigned i = 0; i < k; i++)
        face |= 1U << point[i];
    int n[3];
    normal_of(point, n);
    const int sign = n[0] != 0 ? n[0] : n[1] != 0 ? n[1] : n[2];
    return sign > 0 ? face : face | FACE_TURNS;
}

/* Face f of an element. */
static tm_piece face_at(const tm_piece *piece, unsigned f)
{
    const uint8_t *corner = tm_element_shapes[piece->k].face[order[piece->k][f]];
    tm_piece face = {.k = (uint8_t)tm_mixed_face_nodes(corner)};
    for (unsigned i = 0; i < face.k; i++)
        face.point[i] = piece->point[corner[i]];
    return face;
}

unsigned faces_of_piece(const tm_piece *piece, piece_face face[PIECE_FACES])
{
    const unsigned n = tm_element_shapes[piece->k].faces;
    for (unsigned f = 0; f < n; f++) {
        const tm_piece is = face_at(piece, f);
        face[f] = face_of(is.k, is.point);
    }
    return n;
}

bool is_convex_piece(const tm_piece *piece)
{
    for (unsigned f = 0; f < tm_element_shapes[piece->k].faces; f++) {
        const tm_piece face = face_at(piece, f);
        if (face.k == 4 && !is_convex(face.point))
            return false;
        for (unsigned i = 0; i < piece->k; i++) {
            if (volume_of_four(face.point[0], face.point[1], face.point[2],
                               piece->point[i]) > 0)
                return false;
        }
    }
    return true;
}

int volume_of(const tm_piece *piece)
{
    int volume = 0;
    for (unsigned f = 0; f < tm_element_shapes[piece->k].faces; f++) {
        const tm_piece face = face_at(piece, f);
        for (unsigned i = 2; i < face.k; i++)
            volume -= volume_of_four(face.point[0], face.point[i - 1], face.point[i],
                                     piece->point[0]);
    }
    return volume;
}

/* Samples that are evenly spread, on no plane through points of the leaf: multiples of a
 * vector that is far from rational (Roberts 2018, with the root of x^4 = x + 1). */
static void sample(unsigned i, double at[3])
{
    static const double root = 1.2207440846057596;
    double step = 1;
    for (unsigned k = 0; k < 3; k++) {
        step /= root;
        at[k] = 2 * fmod(step * (i + 1), 1);
    }
}

uint64_t samples_in(const tm_piece *piece)
{
    uint64_t in = UINT64_MAX;
    for (unsigned f = 0; f < tm_element_shapes[piece->k].faces; f++) {
        const tm_piece face = face_at(piece, f);
        const unsigned char *origin = tm_leaf_point[face.point[0]];
        int n[3];
        normal_of(face.point, n);
        for (unsigned i = 0; i < SAMPLES; i++) {
            double at[3];
            sample(i, at);
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

double quality_of(const tm_piece *piece)
{
    const tm_element_shape *shape = &tm_element_shapes[piece->k];
    double worst = 1;
    for (size_t c = 0; c < shape->corners; c++) {
        const unsigned char *corner = shape->corner[c];
        const unsigned at = piece->point[corner[0]];
        double length = 1;
        for (unsigned i = 1; i < 4; i++) {
            int u[3];
            edge_of(at, piece->point[corner[i]], u);
            length *= length_of(u);
        }
        const int volume =
            volume_of_four(at, piece->point[corner[1]], piece->point[corner[2]],
                           piece->point[corner[3]]);
        worst = fmin(worst, tm_jens_of(volume / length, shape->k[c]));
    }
    return worst;
}
