/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lepp.c (paths and passes) and lepp_star.c (what is done with one terminal star)
 * share; for these two only. */
#ifndef TM_TET_LEPP_ENGINE_H
#define TM_TET_LEPP_ENGINE_H

#include "lepp.h"

#include "edge_removal.h"

/* What is remembered of each tetrahedron beside its quality: its longest edge, 0 … 5, and
 * these bits. One byte, because paths look at it most. */
enum { TM_LEPP_LONGEST = 7, TM_LEPP_BAD = 8, TM_LEPP_QUEUED = 16 };

/* A step of the path: the tetrahedron and its longest edge, and how far the star of that
 * has been searched for the next step. */
typedef struct tm_lepp_step {
    uint32_t t;
    uint32_t a, b;
    tm_star star;
    size_t searched;
    size_t operations; /* done when the star was collected; SIZE_MAX: not collected */
} tm_lepp_step;

typedef struct tm_lepp_engine {
    tm_tet_mesh *mesh;
    const tm_lepp_options *options;
    tm_lepp_report *report;
    tm_error *error;
    double bad_below; /* sin² */
    uint8_t *mark;    /* [mesh->slots] */
    double *quality;  /* [mesh->slots], by options->measure */
    size_t mark_room, quality_room;

    /* Edges whose star has not changed since it was refused, with the round in which it
     * was found so: those of the current round are the non-refinable ones. */
    tm_edge_map refused;
    uint32_t round;

    tm_lepp_step *path; /* [path_room]; the stars keep their memory */
    size_t depth, path_room;
    size_t operations;
    uint32_t *target; /* S */
    size_t targets, target_room;
    tm_edge_removal removal;
    uint32_t *created;
    size_t created_room;
} tm_lepp_engine;

/* Measures a tetrahedron: its mark and quality. */
void tm_lepp_measure(tm_lepp_engine *e, uint32_t t);

/* Appends a tetrahedron to S; false where memory is out. */
bool tm_lepp_add_target(tm_lepp_engine *e, uint32_t t);

/* The terminal star of a path, the visited-th for its target: changes it, or makes its
 * edge non-refinable. */
tm_status tm_lepp_process_star(tm_lepp_engine *e, const tm_star *star, size_t visited);

static inline bool tm_lepp_is_blocked(const tm_lepp_engine *e, uint32_t a, uint32_t b)
{
    const uint32_t *round = tm_edge_map_get(&e->refused, a, b);
    return round && *round == e->round;
}

/* Where a value is counted in a histogram whose last bin is for all larger ones. */
static inline size_t tm_lepp_bin(size_t value, size_t bins)
{
    return value < bins ? value : bins - 1;
}

#endif
