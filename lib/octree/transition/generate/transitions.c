/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints transitions.h: the division of a leaf in each of the states that occur, for
 * transition.c. */
#include "../../forest/octree.h"
#include "division.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 12, FACES = 6, STATES = 1 << TM_LEAF_STATE_BITS };

/* Which edges are split is a number of 12 bits; these faces have all four of them. */
static unsigned faces_of(unsigned edges)
{
    unsigned faces = 0;
    for (unsigned f = 0; f < FACES; f++) {
        bool all = true;
        for (unsigned e = 0; e < EDGES; e++) {
            const unsigned char *at = tm_leaf_point[TM_LEAF_EDGE + e];
            if (at[f / 2] == 2 * (f % 2) && (edges >> e & 1) == 0)
                all = false;
        }
        faces |= (unsigned)all << f;
    }
    return faces;
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
            printf("%s%u", i > 0 ? "," : "", d->piece[p].point[i]);
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

/* The states that occur, those with the same edges split together. */
typedef struct states {
    unsigned n;
    tm_leaf_state at[STATES];
    unsigned first[1 << EDGES], faces[1 << EDGES]; /* by split edges */
} states;

static void list_states(states *all)
{
    for (unsigned edges = 0; edges < 1 << EDGES; edges++) {
        all->first[edges] = all->n;
        all->faces[edges] = faces_of(edges);
        const unsigned n = 1U << __builtin_popcount(all->faces[edges]);
        for (unsigned i = 0; i < n; i++)
            all->at[all->n++] = state_of(edges, all->faces[edges], i);
    }
}

/* The smallest J_ENS of all stars: no element below it is of use. */
static double least_of_stars(const states *all)
{
    double least = 1;
    for (unsigned s = 0; s < all->n; s++) {
        division star;
        star_of(all->at[s], &star);
        least = star.worst < least ? star.worst : least;
    }
    return least;
}

static void print_divisions(const states *all, search *s)
{
    static unsigned start[STATES + 1], centre[STATES];
    printf("static const tm_piece transition_piece[] = {\n");
    for (unsigned i = 0; i < all->n; i++) {
        division d;
        best_division(s, all->at[i], &d);
        print_pieces(&d);
        centre[i] = d.centre;
        start[i + 1] = start[i] + d.pieces;
    }
    printf("};\n");
    print_table("uint32_t", "transition_start", start, all->n + 1);
    print_table("uint8_t", "transition_centre", centre, all->n);
}

int main(void)
{
    static states all;
    list_states(&all);
    candidates elements;
    search *s = NULL;
    if (!all_candidates(least_of_stars(&all), &elements) ||
        (s = new_search(&elements)) == NULL) {
        fprintf(stderr, "transitions: not enough memory\n");
        return EXIT_FAILURE;
    }
    printf("/* Made by lib/octree/transition/generate/transitions.c. */\n");
    print_divisions(&all, s);
    print_table("uint16_t", "transition_first", all.first, 1U << EDGES);
    print_table("uint8_t", "transition_faces", all.faces, 1U << EDGES);
    free(s);
    free_candidates(&elements);
    if (fclose(stdout) != 0) {
        fprintf(stderr, "transitions: <stdout>: %s\n", strerror(errno));
        return EXIT_FAILURE;
    }
    return EXIT_SUCCESS;
}
