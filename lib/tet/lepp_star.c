/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What LEPP improvement does with one terminal star. */
#include "lepp_engine.h"

#include "../base/array.h"
#include "../geom/vector.h"
#include "star_insertion.h"

#include <float.h>

/* On one target swap-centroid swaps at so many stars at most, then only inserts: swaps
 * alone may undo each other for ever, insertions end as bisection does. */
enum { SWAPS_PER_TARGET = 64 };

/* What is to be done with a terminal star. */
typedef enum { REFUSE, REMOVE_EDGE, INSERT_CENTROID, INSERT_MIDPOINT } operation;

/* The longest edge of a tetrahedron, 0 … 5. */
static uint8_t longest_edge(const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    unsigned longest = 0;
    double longest_length = -1;
    uint64_t longest_key = 0;
    for (unsigned e = 0; e < 6; e++) {
        uint32_t a = n[tm_edge_corner[e][0]], b = n[tm_edge_corner[e][1]];
        double length = tm_distance2(mesh->xyz[a], mesh->xyz[b]);
        if (length < longest_length)
            continue;
        uint64_t key = tm_edge_key(a, b);
        if (length > longest_length || key > longest_key) {
            longest = e;
            longest_length = length;
            longest_key = key;
        }
    }
    return (uint8_t)longest;
}

void tm_lepp_measure(tm_lepp_engine *e, uint32_t t)
{
    const tm_tet_mesh *mesh = e->mesh;
    const uint32_t *n = mesh->tet[t];
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]];
    const double *c = mesh->xyz[n[2]], *d = mesh->xyz[n[3]];
    double sine2 = tm_tet_sine2(a, b, c, d);
    e->quality[t] = e->options->measure == TM_MEASURE_DIHEDRAL
                        ? sine2
                        : tm_tet_measure_of(e->options->measure, a, b, c, d);
    e->mark[t] =
        (uint8_t)(longest_edge(mesh, t) | (sine2 < e->bad_below ? TM_LEPP_BAD : 0));
}

/* How good the tetrahedra must be that replace the star. */
static double least_quality(const tm_lepp_engine *e, const tm_star *star)
{
    if (e->options->algorithm != TM_LEPP_SELECTIVE)
        return DBL_MIN;
    double worst = HUGE_VAL;
    for (size_t i = 0; i < star->size; i++)
        worst = fmin(worst, e->quality[star->tet[i]]);
    double factor = fmax(e->options->factor, 1 + TM_LEPP_GAIN);
    double times = tm_tet_measure_times(e->options->measure, worst, factor);
    return times > 0 ? nextafter(times, HUGE_VAL) : DBL_MIN;
}

/* Chooses the point to insert: the centroid where it is allowed and valid, else the
 * midpoint. REFUSE where that is not valid either. */
static operation choose_point(tm_lepp_engine *e, const tm_star *star, bool is_free,
                              double p[3])
{
    const tm_tet_mesh *mesh = e->mesh;
    if (e->options->algorithm != TM_LEPP_BISECTION && is_free) {
        if (e->options->algorithm == TM_LEPP_WCENTROID)
            tm_star_wcentroid(mesh, star, p);
        else
            tm_star_centroid(mesh, star, p);
        if (tm_star_sees(mesh, star, p))
            return INSERT_CENTROID;
        if (tm_star_contains(mesh, star, p))
            e->report->tangled++;
        else
            e->report->outside++;
    }
    tm_star_midpoint(mesh, star, p);
    return tm_star_sees(mesh, star, p) ? INSERT_MIDPOINT : REFUSE;
}

/* The better of the best edge removal and the insertion, if it is good enough. */
static operation choose(tm_lepp_engine *e, const tm_star *star, bool is_free,
                        bool may_swap, double p[3])
{
    const tm_tet_mesh *mesh = e->mesh;
    if (tm_edge_map_get(&mesh->locked, star->a, star->b) ||
        !tm_star_is_simple(mesh, star)) {
        e->report->locked++;
        return REFUSE;
    }
    if (e->options->max_star > 0 && star->size > e->options->max_star) {
        e->report->above_max++;
        return REFUSE;
    }
    double least = least_quality(e, star), inserted = 0;
    if (least == HUGE_VAL)
        return REFUSE;
    operation insertion = choose_point(e, star, is_free, p);
    if (insertion != REFUSE)
        inserted = tm_star_insertion_quality(mesh, star, p, e->options->measure, least);
    e->report->too_large += star->closed && star->size > TM_REMOVAL_MAX;
    if (may_swap && is_free && tm_edge_is_removable(star) &&
        tm_edge_removal_plan(mesh, star, e->options->measure, fmax(least, inserted),
                             &e->removal))
        return REMOVE_EDGE;
    return inserted >= least ? insertion : REFUSE;
}

static void count_star(tm_lepp_engine *e, const tm_star *star, bool is_free,
                       operation chosen)
{
    tm_lepp_report *r = e->report;
    size_t size = tm_lepp_bin(star->size, TM_LEPP_SIZES);
    r->closed += star->closed;
    r->open += !star->closed;
    if (star->closed)
        r->closed_size[size]++;
    else
        r->open_size[size]++;
    r->refused_closed += chosen == REFUSE && star->closed;
    r->refused_open += chosen == REFUSE && !star->closed;
    r->swaps += chosen == REMOVE_EDGE;
    r->swap_size[size] += chosen == REMOVE_EDGE;
    r->centroids += chosen == INSERT_CENTROID;
    r->midpoints += chosen == INSERT_MIDPOINT && is_free;
    r->open_midpoints += chosen == INSERT_MIDPOINT && !is_free;
    r->insertion_size[size] +=
        star->closed && (chosen == INSERT_CENTROID || chosen == INSERT_MIDPOINT);
}

/* Frees the edges of the tetrahedra that an operation made. Those that it made new were
 * never blocked, and the one it removed was not: a path does not lead there. */
static void unblock(tm_lepp_engine *e, const tm_star *star)
{
    for (size_t i = 0; i <= star->size; i++) {
        tm_edge_map_remove(&e->refused, star->a, star->ring[i]);
        tm_edge_map_remove(&e->refused, star->b, star->ring[i]);
        if (i < star->size)
            tm_edge_map_remove(&e->refused, star->ring[i], star->ring[i + 1]);
    }
}

/* Room in the engine's arrays for what an operation on the star makes. */
static bool reserve(tm_lepp_engine *e, const tm_star *star)
{
    size_t most = 2 * star->size, slots = e->mesh->slots + most;
    uint8_t *mark = tm_grow(e->mark, &e->mark_room, slots, sizeof *mark);
    e->mark = mark ? mark : e->mark;
    double *quality = tm_grow(e->quality, &e->quality_room, slots, sizeof *quality);
    e->quality = quality ? quality : e->quality;
    uint32_t *created = tm_grow(e->created, &e->created_room, most, sizeof *created);
    e->created = created ? created : e->created;
    return mark && quality && created;
}

/* Changes the star as chosen; measures what was made. */
static tm_status change(tm_lepp_engine *e, const tm_star *star, operation chosen,
                        const double p[3])
{
    if (!reserve(e, star))
        return tm_fail_memory(e->error);
    size_t made = 2 * star->size;
    tm_status status;
    if (chosen == REMOVE_EDGE) {
        made -= 4;
        status = tm_edge_removal_apply(e->mesh, star, &e->removal, e->created, e->error);
    } else {
        status = tm_star_insert(e->mesh, star, p, chosen == INSERT_MIDPOINT, e->created,
                                e->error);
    }
    if (status != TM_OK)
        return status;
    unblock(e, star);
    e->operations++;
    for (size_t i = 0; i < made; i++) {
        uint32_t t = e->created[i];
        tm_lepp_measure(e, t);
        if (e->options->stop == TM_LEPP_CONVERGED && (e->mark[t] & TM_LEPP_BAD) &&
            !tm_lepp_add_target(e, t))
            return tm_fail_memory(e->error);
    }
    return TM_OK;
}

tm_status tm_lepp_process_star(tm_lepp_engine *e, const tm_star *star, size_t visited)
{
    double p[3];
    uint32_t a = star->a, b = star->b;
    tm_lepp_algorithm algorithm = e->options->algorithm;
    bool may_swap = algorithm == TM_LEPP_SELECTIVE ||
                    (algorithm == TM_LEPP_SWAP_CENTROID && visited <= SWAPS_PER_TARGET);
    uint32_t *round = tm_edge_map_get(&e->refused, a, b);
    if (round) {
        *round = e->round;
        return TM_OK;
    }
    bool is_free = tm_star_is_free(e->mesh, star);
    operation chosen = choose(e, star, is_free, may_swap, p);
    count_star(e, star, is_free, chosen);
    if (chosen != REFUSE)
        return change(e, star, chosen, p);
    if (!tm_edge_map_reserve(&e->refused, 1))
        return tm_fail_memory(e->error);
    tm_edge_map_put(&e->refused, a, b, e->round);
    return TM_OK;
}
