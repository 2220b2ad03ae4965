/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "candidates.h"

#include "../../forest/octree.h"

#include <stdlib.h>
#include <string.h>

/* Plane convex quadrilaterals, the lowest point first, both ways round. */
typedef struct quads {
    size_t n;
    uint8_t (*at)[4];
} quads;

static const uint8_t points = LEAF_POINTS;
static const double rounding = 1e-12;

/* Whether a face is on a side of the cube. */
static bool is_on_side(piece_face face)
{
    for (unsigned f = 0; f < 6; f++) {
        bool all = true;
        for (unsigned p = 0; p < LEAF_POINTS; p++) {
            if ((face >> p & 1) != 0 && tm_leaf_point[p][f / 2] != 2 * (f % 2))
                all = false;
        }
        if (all)
            return true;
    }
    return false;
}

/* Adds an element if it is one to use. */
static bool add(candidates *all, double least, const tm_piece *piece)
{
    const double quality = quality_of(piece);
    if (quality < least - rounding || !is_convex_piece(piece))
        return true;
    if (all->n == all->room) {
        const size_t room = all->room > 0 ? 2 * all->room : 1024;
        candidate *at = realloc(all->at, room * sizeof *at);
        if (at == NULL)
            return false;
        all->at = at;
        all->room = room;
    }
    candidate *c = &all->at[all->n++];
    *c = (candidate){.piece = *piece, .quality = quality};
    c->faces = faces_of_piece(piece, c->face);
    c->volume = volume_of(piece);
    c->samples = samples_in(piece);
    for (unsigned f = 0; f < c->faces; f++)
        c->on_side |= (uint8_t)(is_on_side(c->face[f]) << f);
    return true;
}

static bool all_quads(quads *q)
{
    q->n = 0;
    q->at =
        malloc(sizeof *q->at * LEAF_POINTS * LEAF_POINTS * LEAF_POINTS * LEAF_POINTS / 4);
    if (q->at == NULL)
        return false;
    for (uint8_t a = 0; a < points; a++)
        for (uint8_t b = a + 1; b < points; b++)
            for (uint8_t c = a + 1; c < points; c++)
                for (uint8_t d = a + 1; d < points; d++) {
                    const uint8_t quad[4] = {a, b, c, d};
                    if (is_convex(quad))
                        memcpy(q->at[q->n++], quad, sizeof quad);
                }
    return true;
}

static bool add_tetrahedra(candidates *all, double least)
{
    for (uint8_t a = 0; a < points; a++)
        for (uint8_t b = a + 1; b < points; b++)
            for (uint8_t c = b + 1; c < points; c++)
                for (uint8_t d = c + 1; d < points; d++) {
                    const bool turns = volume_of_four(a, b, c, d) < 0;
                    const tm_piece piece = {4, {a, turns ? c : b, turns ? b : c, d}};
                    if (!add(all, least, &piece))
                        return false;
                }
    return true;
}

static bool add_pyramids(candidates *all, double least, const quads *q)
{
    for (size_t i = 0; i < q->n; i++) {
        const uint8_t *b = q->at[i];
        for (uint8_t apex = 0; apex < points; apex++) {
            const tm_piece piece = {5, {b[0], b[1], b[2], b[3], apex}};
            if (volume_of_four(b[0], b[1], b[3], apex) > 0 && !add(all, least, &piece))
                return false;
        }
    }
    return true;
}

/* A side of the wedge, and the edge opposite to it. The lowest point is corner 0. */
static bool add_wedges(candidates *all, double least, const quads *q)
{
    for (size_t i = 0; i < q->n; i++) {
        const uint8_t *s = q->at[i];
        for (uint8_t c = s[0] + 1; c < points; c++)
            for (uint8_t f = s[0] + 1; f < points; f++) {
                const tm_piece piece = {6, {s[0], s[3], c, s[1], s[2], f}};
                if (volume_of_four(s[0], s[1], f, c) == 0 &&
                    volume_of_four(s[3], s[2], f, c) == 0 &&
                    volume_of_four(s[0], s[1], s[3], c) < 0 && !add(all, least, &piece))
                    return false;
            }
    }
    return true;
}

/* Two opposite faces, the second of them turned to fit. The lowest point is corner 0, and
 * the lowest of its neighbours is corner 1. */
static bool add_hexahedra(candidates *all, double least, const quads *q)
{
    for (size_t i = 0; i < q->n; i++) {
        const uint8_t *b = q->at[i];
        for (size_t j = 0; b[1] < b[3] && j < 4 * q->n; j++) {
            const uint8_t *quad = q->at[j / 4];
            uint8_t t[4];
            for (unsigned k = 0; k < 4; k++)
                t[k] = quad[(j + k) % 4];
            const tm_piece piece = {8, {b[0], b[1], b[2], b[3], t[0], t[1], t[2], t[3]}};
            if (quad[0] > b[0] && t[0] > b[1] &&
                volume_of_four(b[0], b[1], t[1], t[0]) == 0 &&
                volume_of_four(b[2], b[3], t[3], t[2]) == 0 &&
                volume_of_four(b[0], b[1], b[3], t[0]) > 0 && !add(all, least, &piece))
                return false;
        }
    }
    return true;
}

/* Large ones first, then good ones; what is left decides for an order that does not
 * depend on qsort(). */
static int compare(const void *p, const void *q)
{
    const candidate *a = p, *b = q;
    if (a->volume != b->volume)
        return a->volume > b->volume ? -1 : 1;
    if (a->quality < b->quality - rounding || a->quality > b->quality + rounding)
        return a->quality > b->quality ? -1 : 1;
    if (a->piece.k != b->piece.k)
        return a->piece.k > b->piece.k ? -1 : 1;
    return memcmp(a->piece.point, b->piece.point, a->piece.k);
}

static uint32_t points_of(const tm_piece *piece)
{
    uint32_t set = 0;
    for (unsigned i = 0; i < piece->k; i++)
        set |= 1U << piece->point[i];
    return set;
}

bool all_candidates(double least, candidates *all)
{
    quads q;
    *all = (candidates){.n = 0};
    if (!all_quads(&q))
        return false;
    const bool done = add_tetrahedra(all, least) && add_pyramids(all, least, &q) &&
                      add_wedges(all, least, &q) && add_hexahedra(all, least, &q);
    free(q.at);
    all->points = done ? malloc(all->n * sizeof *all->points) : NULL;
    if (all->points == NULL)
        return false;
    qsort(all->at, all->n, sizeof *all->at, compare);
    for (size_t c = 0; c < all->n; c++)
        all->points[c] = points_of(&all->at[c].piece);
    return true;
}

void free_candidates(candidates *all)
{
    free(all->at);
    free(all->points);
}
