/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search: begin with the sides of the cube, each face piece asking for an element
 * that has it. Take the piece with the fewest elements that would fit, try each, and let
 * its other faces ask in turn, or meet those that ask for them from the other side. When
 * none is left, the elements fill the cube once: their faces cancel but for its sides,
 * and all have a positive volume. */
#include "division.h"

#include "../../forest/octree.h"

#include <stdlib.h>
#include <string.h>

enum { FACES = 6, MOST_OPEN = 128, SLOTS = 1 << 12, MOST_FITTING = 512 };

typedef struct open_faces {
    unsigned n;
    piece_face face[MOST_OPEN];
} open_faces;

struct search {
    const candidates *all;
    open_faces sides;
    double least; /* J_ENS */
    int largest;  /* volume of an element that can be used */
    division now, *best;
    /* Lists of the elements that can be used, by hashed face and in the order of the
     * candidates: PIECE_FACES · candidate + face + 1; 0 ends a list. */
    size_t first[SLOTS];
    size_t next[];
};

static const double rounding = 1e-12;

void star_of(tm_leaf_state state, division *star)
{
    *star = (division){.centre = true, .worst = 1};
    for (unsigned f = 0; f < FACES; f++) {
        tm_piece face[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, face);
        for (unsigned p = 0; p < n; p++) {
            tm_piece *piece = &star->piece[star->pieces++];
            piece->k = (uint8_t)(face[p].k + 1);
            for (unsigned i = 0; i < face[p].k; i++)
                piece->point[i] = face[p].point[face[p].k - 1 - i];
            piece->point[face[p].k] = TM_LEAF_CENTRE;
            const double quality = quality_of(piece);
            star->worst = quality < star->worst ? quality : star->worst;
        }
    }
}

static size_t slot_of(piece_face face)
{
    const uint32_t golden = 2654435769U;
    return (uint32_t)(face * golden) / (UINT32_MAX / SLOTS + 1);
}

search *new_search(const candidates *all)
{
    search *s = calloc(1, sizeof *s + all->n * PIECE_FACES * sizeof s->next[0]);
    if (s != NULL)
        s->all = all;
    return s;
}

static unsigned find_face(const open_faces *open, piece_face face)
{
    unsigned i = 0;
    while (i < open->n && open->face[i] != face)
        i++;
    return i;
}

/* Whether the faces of an element on the sides of the cube are pieces there. */
static bool keeps_sides(const search *s, const candidate *c)
{
    for (unsigned f = 0; f < c->faces; f++) {
        if ((c->on_side >> f & 1) != 0 && find_face(&s->sides, c->face[f]) == s->sides.n)
            return false;
    }
    return true;
}

/* Lists the elements that can be used with these nodes. */
static void list_elements(search *s, uint32_t nodes)
{
    s->largest = 1;
    memset(s->first, 0, sizeof s->first);
    for (size_t c = s->all->n; c-- > 0;) {
        const candidate *is = &s->all->at[c];
        if ((s->all->points[c] & ~nodes) != 0 || is->quality < s->least - rounding ||
            !keeps_sides(s, is))
            continue;
        s->largest = is->volume > s->largest ? is->volume : s->largest;
        for (unsigned f = 0; f < is->faces; f++) {
            size_t *first = &s->first[slot_of(is->face[f])];
            const size_t here = PIECE_FACES * c + f;
            s->next[here] = *first;
            *first = here + 1;
        }
    }
}

/* Takes the faces of an element out, or puts in what it asks for. False: a face would be
 * there twice. */
static bool close_faces(open_faces *open, const candidate *c)
{
    for (unsigned f = 0; f < c->faces; f++) {
        const unsigned at = find_face(open, c->face[f]);
        const piece_face other = c->face[f] ^ FACE_TURNS;
        if (at < open->n)
            open->face[at] = open->face[--open->n];
        else if (open->n == MOST_OPEN || find_face(open, other) < open->n)
            return false;
        else
            open->face[open->n++] = other;
    }
    return true;
}

/* The elements that fit to a face and what is there, up to `most`; returns how many there
 * are. Elements that have a sample in common overlap. */
static size_t fitting(const search *s, piece_face face, uint64_t samples, int room,
                      size_t most, const candidate **fit)
{
    size_t n = 0;
    for (size_t i = s->first[slot_of(face)]; i != 0 && n < most; i = s->next[i - 1]) {
        const candidate *c = &s->all->at[(i - 1) / PIECE_FACES];
        if (c->face[(i - 1) % PIECE_FACES] == face && (c->samples & samples) == 0 &&
            c->volume <= room)
            fit[n++] = c;
    }
    return n;
}

static bool has_centre(const tm_piece *piece)
{
    for (unsigned i = 0; i < piece->k; i++) {
        if (piece->point[i] == TM_LEAF_CENTRE)
            return true;
    }
    return false;
}

/* Keeps the division that was found if it is better. */
static void keep_better(search *s)
{
    const division *now = &s->now, *best = s->best;
    const bool better = now->pieces != best->pieces ? now->pieces < best->pieces
                        : now->centre != best->centre
                            ? !now->centre
                            : now->worst > best->worst + rounding;
    if (better)
        *s->best = *now;
}

/* Whether more elements than the best division has are needed for what is left: none is
 * larger than the largest, and none closes more than its faces. */
static bool is_hopeless(const search *s, const open_faces *open, int room)
{
    const unsigned by_volume = (unsigned)((room + s->largest - 1) / s->largest);
    const unsigned by_faces = (open->n + PIECE_FACES - 1) / PIECE_FACES;
    const unsigned more = by_volume > by_faces ? by_volume : by_faces;
    return s->now.pieces + more > s->best->pieces;
}

/* Tries all ways to go on from s->now, where `samples` are covered and `room` is left. */
static void divide(search *s, const open_faces *open, uint64_t samples, int room)
{
    if (open->n == 0 && room == 0)
        keep_better(s);
    if (open->n == 0 || room <= 0 || is_hopeless(s, open, room))
        return;
    const candidate *fit[MOST_FITTING];
    size_t fewest = MOST_FITTING;
    piece_face face = open->face[0];
    for (unsigned i = 0; i < open->n && fewest > 0; i++) {
        const size_t n = fitting(s, open->face[i], samples, room, fewest, fit);
        if (n < fewest) {
            fewest = n;
            face = open->face[i];
        }
    }
    const size_t n = fitting(s, face, samples, room, MOST_FITTING, fit);
    const division before = s->now;
    for (size_t i = 0; i < n; i++) {
        open_faces rest = *open;
        if (!close_faces(&rest, fit[i]))
            continue;
        s->now.piece[s->now.pieces++] = fit[i]->piece;
        s->now.centre = before.centre || has_centre(&fit[i]->piece);
        s->now.worst = fit[i]->quality < before.worst ? fit[i]->quality : before.worst;
        divide(s, &rest, samples | fit[i]->samples, room - fit[i]->volume);
        s->now.pieces = before.pieces;
    }
    s->now.centre = before.centre;
    s->now.worst = before.worst;
}

void best_division(search *s, tm_leaf_state state, division *best)
{
    star_of(state, best);
    s->best = best;
    s->least = best->worst;
    s->now = (division){.worst = 1};
    s->sides.n = 0;
    for (unsigned f = 0; f < FACES; f++) {
        tm_piece face[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, face);
        for (unsigned p = 0; p < n; p++)
            s->sides.face[s->sides.n++] = face_of(face[p].k, face[p].point);
    }
    list_elements(s, 0xffU | state << TM_LEAF_EDGE | (uint32_t)1 << TM_LEAF_CENTRE);
    const open_faces open = s->sides;
    divide(s, &open, 0, CUBE_VOLUME);
}
