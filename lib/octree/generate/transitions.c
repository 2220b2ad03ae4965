/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints transitions.h: the division of a leaf in each of the states that occur, for
 * lib/octree/transition.c. */
#include "../octree.h"
#include "../transition.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 12, FACES = 6, STATES = 1 << TM_LEAF_STATE_BITS, MOST = 64 };

typedef struct division {
    unsigned pieces;
    bool centre;
    tm_piece piece[MOST];
} division;

/* Which edges are split is a number of 12 bits; these faces have all four of them. */
static unsigned faces_of(unsigned edges)
{
    unsigned faces = 0;
    for (unsigned f = 0; f < FACES; f++) {
        bool all = true;
        for (unsigned e = 0; e < EDGES; e++) {
            const unsigned char *at = tm_leaf_place[TM_LEAF_EDGE + e];
            if (at[f / 2] == 2 * (f % 2) && (edges >> e & 1) == 0)
                all = false;
        }
        faces |= (unsigned)all << f;
    }
    return faces;
}

/* Every piece of a face, joined to the centre. */
static void star_of(tm_leaf_state state, division *d)
{
    d->pieces = 0;
    d->centre = true;
    for (unsigned f = 0; f < FACES; f++) {
        tm_piece face[TM_FACE_PIECES];
        const unsigned n = tm_face_pieces(state, f, face);
        for (unsigned p = 0; p < n; p++) {
            tm_piece *piece = &d->piece[d->pieces++];
            piece->k = (uint8_t)(face[p].k + 1);
            for (unsigned i = 0; i < face[p].k; i++)
                piece->place[i] = face[p].place[face[p].k - 1 - i];
            piece->place[face[p].k] = TM_LEAF_CENTRE;
        }
    }
}

/* The n-th state with these edges split and some of these faces. */
static tm_leaf_state state_of(unsigned edges, unsigned faces, unsigned n)
{
    tm_leaf_state state = edges;
    for (unsigned f = 0; f < FACES; f++) {
        if ((faces >> f & 1) != 0) {
            state |= (n & 1) << (EDGES + f);
            n >>= 1;
        }
    }
    return state;
}

static void print_pieces(const division *d)
{
    for (unsigned p = 0; p < d->pieces; p++) {
        printf("{%u,{", d->piece[p].k);
        for (unsigned i = 0; i < d->piece[p].k; i++)
            printf("%s%u", i > 0 ? "," : "", d->piece[p].place[i]);
        printf("}},");
    }
    printf("\n");
}

/* A table in C of n numbers. */
static void print_table(const char *type, const char *name, const unsigned *value,
                        unsigned n)
{
    printf("static const %s %s[%u] = {\n", type, name, n);
    for (unsigned i = 0; i < n; i++)
        printf("%u,%s", value[i], i % 16 == 15 || i == n - 1 ? "\n" : "");
    printf("};\n");
}

int main(void)
{
    static unsigned first[1 << EDGES], faces[1 << EDGES], start[STATES], centre[STATES];
    unsigned states = 0;
    printf("/* Made by lib/octree/generate/transitions.c. */\n");
    printf("static const tm_piece transition_piece[] = {\n");
    for (unsigned edges = 0; edges < 1 << EDGES; edges++) {
        first[edges] = states;
        faces[edges] = faces_of(edges);
        const unsigned n = 1U << __builtin_popcount(faces[edges]);
        for (unsigned i = 0; i < n; i++) {
            division d;
            star_of(state_of(edges, faces[edges], i), &d);
            print_pieces(&d);
            centre[states] = d.centre;
            start[states + 1] = start[states] + d.pieces;
            states++;
        }
    }
    printf("};\n");
    print_table("uint32_t", "transition_start", start, states + 1);
    print_table("uint8_t", "transition_centre", centre, states);
    print_table("uint16_t", "transition_first", first, 1U << EDGES);
    print_table("uint8_t", "transition_faces", faces, 1U << EDGES);
    if (fclose(stdout) != 0) {
        fprintf(stderr, "transitions: <stdout>: %s\n", strerror(errno));
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
