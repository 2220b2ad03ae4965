/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Swaps of faces between passes of selective: the two tetrahedra at a face become three
 * around a new edge, or, where two of their faces are in a flat facet of the boundary,
 * two at another face. (Balboa 2020, section 3.3; C. L. Lawson, Properties of
 * n-dimensional triangulations, Computer Aided Geometric Design 3 (1986).) */
#include "lepp_engine.h"

#include "../../geom/predicates.h"

#include <string.h>

/* Two tetrahedra, and what they are to become. */
typedef struct swap {
    uint32_t old[2];
    uint32_t node[3][4];
    size_t count;
    tm_face_renewal renewal[2];
    size_t renewals;
} swap;

static bool is_valid(const tm_lepp_engine *e, const swap *s)
{
    const double(*xyz)[3] = (const double(*)[3])e->mesh->xyz;
    for (size_t k = 0; k < s->count; k++) {
        const uint32_t *n = s->node[k];
        if (tm_orient3d(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[n[3]]) <= 0)
            return false;
    }
    return true;
}

static bool is_better(const tm_lepp_engine *e, const swap *s)
{
    const double(*xyz)[3] = (const double(*)[3])e->mesh->xyz;
    tm_tet_measure measure = e->options->measure;
    double worst = fmin(e->quality[s->old[0]], e->quality[s->old[1]]);
    double least = tm_tet_measure_times(measure, worst, 1 + TM_LEPP_GAIN);
    for (size_t k = 0; k < s->count; k++) {
        const uint32_t *n = s->node[k];
        const double *a = xyz[n[0]], *b = xyz[n[1]], *c = xyz[n[2]], *d = xyz[n[3]];
        double quality = tm_tet_measure_of(measure, a, b, c, d);
        if (quality < least || !(quality > worst) ||
            !tm_angles_are_within(&e->sweeper.limits, a, b, c, d))
            return false;
    }
    return true;
}

/* Does a swap if it is valid and better. */
static tm_status consider(tm_lepp_engine *e, const swap *s, size_t sweep, bool *done)
{
    tm_lepp_sweep_report *report = &e->report->swap;
    report->tried++;
    *done = false;
    if (!is_valid(e, s)) {
        report->invalid++;
        return TM_OK;
    }
    if (!is_better(e, s) || !tm_lepp_may_grow(e, s->count - 2))
        return TM_OK;
    if (!tm_lepp_reserve(e, s->count))
        return tm_fail_memory(e->error);
    tm_replacement what = {.old = s->old,
                           .old_count = 2,
                           .node = s->node,
                           .count = s->count,
                           .renewal = s->renewal,
                           .renewals = s->renewals,
                           .created = e->created};
    tm_status status = tm_tet_replace(e->mesh, &what, &e->sweeper.table, e->error);
    if (status != TM_OK)
        return status;
    *done = true;
    report->done[sweep]++;
    report->on_surface += s->renewals > 0;
    return tm_lepp_note(e, e->created, s->count) &&
                   tm_lepp_unblock(e, e->created, s->count)
               ? TM_OK
               : tm_fail_memory(e->error);
}

/* 2-3: face i of t, whose edges are joined to the edge between the two far nodes. */
static swap across_face(const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t g = mesh->neighbour[t][i], face[3];
    swap s = {.old = {t, g / 4}, .count = 3};
    tm_tet_face_below(mesh, t, i, face);
    for (int k = 0; k < 3; k++)
        memcpy(s.node[k],
               (uint32_t[4]){face[k], face[(k + 1) % 3], mesh->tet[g / 4][g % 4],
                             mesh->tet[t][i]},
               sizeof s.node[k]);
    return s;
}

/* 2-2: the edge of an open star of two tetrahedra goes, and the ring's ends are joined in
 * its facet. */
static swap in_facet(tm_lepp_engine *e, const tm_star *star)
{
    swap s = {.old = {star->tet[0], star->tet[1]}, .renewals = 2};
    e->removal.apex[0][2] = 1; /* the ring is one triangle */
    s.count = tm_edge_removal_list(star, &e->removal, s.node);
    tm_edge_removal_renewals(e->mesh, star, true, s.renewal);
    return s;
}

static bool is_at_boundary(const tm_tet_mesh *mesh, uint32_t t)
{
    for (uint32_t i = 0; i < 4; i++)
        if (mesh->neighbour[t][i] & TM_FACE_BIT)
            return true;
    return false;
}

/* 2-2 at the edges of t; each is tried from one of its two tetrahedra. */
static tm_status swap_edges(tm_lepp_engine *e, uint32_t t, size_t sweep)
{
    tm_star *star = &e->sweeper.star;
    size_t constrained[2];
    for (unsigned i = 0; i < TM_TET_EDGES; i++) {
        bool done;
        if (!tm_star_around(e->mesh, t, i, star))
            return tm_fail_memory(e->error);
        if (star->closed || star->size != 2 || (star->tet[0] < t || star->tet[1] < t) ||
            tm_features_classify(&e->sweeper.features, e->mesh, star, constrained) !=
                TM_EDGE_IN_FACET)
            continue;
        swap s = in_facet(e, star);
        tm_status status = consider(e, &s, sweep, &done);
        if (status != TM_OK || done)
            return status;
    }
    return TM_OK;
}

/* 2-3 at the faces of t that are shared with a later tetrahedron, then 2-2. */
static tm_status swap_at(tm_lepp_engine *e, uint32_t t, size_t sweep)
{
    const tm_tet_mesh *mesh = e->mesh;
    for (uint32_t i = 0; i < 4; i++) {
        bool done;
        uint32_t g = mesh->neighbour[t][i];
        if (g & TM_FACE_BIT || g / 4 < t)
            continue;
        swap s = across_face(mesh, t, i);
        tm_status status = consider(e, &s, sweep, &done);
        if (status != TM_OK || done)
            return status;
    }
    return is_at_boundary(mesh, t) ? swap_edges(e, t, sweep) : TM_OK;
}

tm_status tm_lepp_swap(tm_lepp_engine *e)
{
    tm_lepp_sweeper *s = &e->sweeper;
    size_t sweep = tm_lepp_bin(e->report->swap.sweeps++, TM_LEPP_SWEEPS);
    tm_features_free(&s->features);
    tm_status status = tm_features_find(&s->features, e->mesh, NULL, &s->marks, e->error);
    tm_progress_at at = {.what = "swapping faces", .pass = e->report->swap.sweeps};
    for (uint32_t t = 0; t < e->mesh->slots && status == TM_OK; t++) {
        at.of = e->mesh->slots; /* swaps may add some */
        tm_progress_step(e->options->progress, &at, t);
        if (tm_tet_lives(e->mesh, t))
            status = swap_at(e, t, sweep);
    }
    e->operations++; /* stars that paths have collected may have changed */
    return status;
}
