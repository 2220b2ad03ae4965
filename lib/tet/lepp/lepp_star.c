/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What LEPP improvement does with one terminal star. */
#include "lepp_engine.h"

#include "../../geom/predicates.h"
#include "../../geom/vector.h"
#include "../operation/star_insertion.h"

#include <float.h>

/* On one target swap-centroid swaps at so many stars at most, then only inserts: swaps
 * alone may undo each other for ever, insertions end as bisection does. */
enum { SWAPS_PER_TARGET = 64 };

/* What is to be done with a terminal star. */
typedef enum { REFUSE, REMOVE_EDGE, INSERT_CENTROID, INSERT_MIDPOINT } operation;

static double worst_quality(const tm_lepp_engine *e, const tm_star *star)
{
    double worst = HUGE_VAL;
    for (size_t i = 0; i < star->size; i++)
        worst = tm_lesser(worst, e->quality[star->tet[i]]);
    return worst;
}

/* Chooses the point to insert: the centroid where it is allowed and valid, else the
 * midpoint. REFUSE where that is not valid either. *quality is what its insertion would
 * make, or 0 where that is below `least`. */
static operation choose_point(tm_lepp_engine *e, const tm_star *star, bool is_free,
                              double least, double p[3], double *quality)
{
    const tm_tet_mesh *mesh = e->mesh;
    tm_lepp_algorithm algorithm = e->options->algorithm;
    tm_tet_measure measure = e->options->measure;
    if (algorithm != TM_LEPP_BISECTION && algorithm != TM_LEPP_DELAUNAY && is_free) {
        if (algorithm == TM_LEPP_WCENTROID)
            tm_star_wcentroid(mesh, star, p);
        else
            tm_star_centroid(mesh, star, p);
        if (tm_star_try_insertion(mesh, star, p, measure, least, quality))
            return INSERT_CENTROID;
        if (tm_star_contains(mesh, star, p))
            e->report->tangled++;
        else
            e->report->outside++;
    }
    tm_star_midpoint(mesh, star, p);
    return tm_star_try_insertion(mesh, star, p, measure, least, quality) ? INSERT_MIDPOINT
                                                                         : REFUSE;
}

/* Whether the two tetrahedra on triangle i k j of the ring are positive. */
static bool is_valid_triangle(const tm_tet_mesh *mesh, const tm_star *star, size_t i,
                              size_t k, size_t j)
{
    const double *x = mesh->xyz[star->ring[i]], *y = mesh->xyz[star->ring[k]];
    const double *z = mesh->xyz[star->ring[j]];
    return tm_orient3d(x, y, z, mesh->xyz[star->b]) > 0 &&
           tm_orient3d(x, z, y, mesh->xyz[star->a]) > 0;
}

/* Whether the ring has a triangulation whose tetrahedra are all positive, however good:
 * can[i][j] is that the polygon i … j has one. */
static bool has_removal(const tm_tet_mesh *mesh, const tm_star *star)
{
    bool can[TM_REMOVAL_MAX][TM_REMOVAL_MAX];
    size_t n = star->size;
    for (size_t i = 0; i + 1 < n; i++)
        can[i][i + 1] = true;
    for (size_t length = 2; length < n; length++)
        for (size_t i = 0; i + length < n; i++) {
            size_t j = i + length;
            can[i][j] = false;
            for (size_t k = i + 1; k < j && !can[i][j]; k++)
                can[i][j] =
                    can[i][k] && can[k][j] && is_valid_triangle(mesh, star, i, k, j);
        }
    return can[0][n - 1];
}

/* The better of the best edge removal and the insertion, if it is good enough. What that
 * is exactly is only asked where something is better than a lower bound of it. */
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
    bool must_gain = e->options->algorithm == TM_LEPP_SELECTIVE;
    double worst = must_gain ? worst_quality(e, star) : 0;
    double least = must_gain ? tm_gain_bound(&e->gain, worst) : DBL_MIN, inserted = 0;
    if (least == HUGE_VAL)
        return REFUSE;
    operation insertion = choose_point(e, star, is_free, least, p, &inserted);
    e->report->too_large += star->closed && star->size > TM_REMOVAL_MAX;
    if (may_swap && is_free && tm_edge_is_removable(star)) {
        if (tm_edge_removal_plan(mesh, star, e->options->measure,
                                 inserted > least ? inserted : least, &e->removal) &&
            (!must_gain || e->removal.quality >= tm_gain_least(&e->gain, worst)))
            return REMOVE_EDGE;
        e->report->no_swap += e->options->count_invalid_swaps && !has_removal(mesh, star);
    }
    if (inserted < least)
        return REFUSE;
    return !must_gain || inserted >= tm_gain_least(&e->gain, worst) ? insertion : REFUSE;
}

/* Whether what was chosen makes no angle that the mesh had none of. */
static bool keeps_angles(const tm_lepp_engine *e, const tm_star *star, operation chosen,
                         const double p[3])
{
    const double(*xyz)[3] = (const double(*)[3])e->mesh->xyz;
    const double *a = xyz[star->a], *b = xyz[star->b];
    if (chosen == REMOVE_EDGE) {
        uint32_t node[2 * TM_REMOVAL_MAX][4];
        size_t count = tm_edge_removal_list(star, &e->removal, node);
        for (size_t i = 0; i < count; i++)
            if (!tm_angles_are_within(&e->sweeper.limits, xyz[node[i][0]],
                                      xyz[node[i][1]], xyz[node[i][2]], xyz[node[i][3]]))
                return false;
        return true;
    }
    for (size_t i = 0; i < star->size; i++) {
        const double *r = xyz[star->ring[i]], *s = xyz[star->ring[i + 1]];
        if (!tm_angles_are_within(&e->sweeper.limits, a, p, r, s) ||
            !tm_angles_are_within(&e->sweeper.limits, p, b, r, s))
            return false;
    }
    return true;
}

/* What an operation adds to the mesh; of a Delaunay insertion only when it is foreseen.
 */
static size_t growth_of(const tm_lepp_engine *e, const tm_star *star, operation chosen)
{
    if (chosen == REMOVE_EDGE)
        return star->size > 4 ? star->size - 4 : 0;
    return e->options->algorithm == TM_LEPP_DELAUNAY ? 0 : star->size;
}

/* The same for a Delaunay insertion, which must leave a Delaunay mesh if the input was
 * one. */
static tm_status keeps_delaunay(tm_lepp_engine *e, const tm_star *star, const double p[3],
                                bool *keeps)
{
    const tm_delaunay_cavity *cavity = &e->delaunay.cavity;
    bool is_whole;
    if (e->report->not_delaunay_before > 0 && e->most_tets == TM_TETS_MAX)
        return TM_OK;
    tm_status status =
        tm_delaunay_foresee(e->mesh, star, p, &e->delaunay, &is_whole, e->error);
    if (status != TM_OK)
        return status;
    size_t more = cavity->faces > cavity->size ? cavity->faces - cavity->size : 0;
    bool has_room = tm_lepp_may_grow(e, more);
    e->report->no_room += !has_room;
    *keeps = has_room && (is_whole || e->report->not_delaunay_before > 0);
    return TM_OK;
}

/* Whether what was chosen leaves what the whole run promises: the size of the mesh, with
 * sweeps its extreme angles, with delaunay a Delaunay mesh. */
static tm_status keeps_promise(tm_lepp_engine *e, const tm_star *star, operation chosen,
                               const double p[3], bool *keeps)
{
    *keeps = tm_lepp_may_grow(e, growth_of(e, star, chosen));
    e->report->no_room += !*keeps;
    if (!*keeps)
        return TM_OK;
    if (e->options->algorithm == TM_LEPP_DELAUNAY)
        return keeps_delaunay(e, star, p, keeps);
    *keeps = !e->options->sweeps || keeps_angles(e, star, chosen, p);
    e->report->angle_kept += !*keeps;
    return TM_OK;
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
    bool inserted = chosen == INSERT_CENTROID || chosen == INSERT_MIDPOINT;
    r->insertion_size[size] += star->closed && inserted;
    r->open_insertion_size[size] += !star->closed && inserted;
}

/* Inserts the midpoint by its Delaunay cavity. */
static tm_status change_by_cavity(tm_lepp_engine *e, const tm_star *star,
                                  const double p[3])
{
    tm_delaunay *d = &e->delaunay;
    tm_status status = tm_delaunay_insert(e->mesh, star, p, d, e->error);
    if (status != TM_OK)
        return status;
    e->operations++;
    if (!tm_lepp_reserve(e, 0) || !tm_lepp_note(e, d->created, d->made))
        return tm_fail_memory(e->error);
    return tm_lepp_unblock(e, d->created, d->made) ? TM_OK : tm_fail_memory(e->error);
}

/* Changes the star as chosen; measures what was made. */
static tm_status change(tm_lepp_engine *e, const tm_star *star, operation chosen,
                        const double p[3])
{
    if (e->options->algorithm == TM_LEPP_DELAUNAY)
        return change_by_cavity(e, star, p);
    size_t made = 2 * star->size;
    if (!tm_lepp_reserve(e, made) || !tm_lepp_unblock_star(e, star))
        return tm_fail_memory(e->error);
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
    e->operations++;
    return tm_lepp_note(e, e->created, made) ? TM_OK : tm_fail_memory(e->error);
}

tm_status tm_lepp_process_star(tm_lepp_engine *e, const tm_star *star, size_t visited)
{
    double p[3];
    tm_lepp_algorithm algorithm = e->options->algorithm;
    bool may_swap = algorithm == TM_LEPP_SELECTIVE ||
                    (algorithm == TM_LEPP_SWAP_CENTROID && visited <= SWAPS_PER_TARGET);
    if (tm_lepp_is_refused(e, star))
        return tm_lepp_block(e, star);
    bool is_free = tm_star_is_free(e->mesh, star);
    operation chosen = choose(e, star, is_free, may_swap, p);
    if (chosen != REFUSE) {
        bool keeps = true;
        tm_status status = keeps_promise(e, star, chosen, p, &keeps);
        if (status != TM_OK)
            return status;
        chosen = keeps ? chosen : REFUSE;
    }
    count_star(e, star, is_free, chosen);
    if (chosen != REFUSE)
        return change(e, star, chosen, p);
    return tm_lepp_block(e, star);
}
