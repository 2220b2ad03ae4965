/* SPDX-License-Identifier: GPL-3.0-or-later */
/* LEPP's memory: what it knows of each tetrahedron, S, and which edges are refused and
 * not refinable (the marks in lepp_engine.h). It calls none of its other files. */
#include "lepp_engine.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../mesh_measure.h"

#include <stdlib.h>

/* Whether t, with its longest edge, is larger than the sizes say. */
static bool is_larger(const tm_lepp_engine *e, uint32_t t, const uint8_t edge[2])
{
    const double rounding = 1e-9;
    const tm_tet_mesh *mesh = e->mesh;
    const tm_lepp_sizes *sizes = &e->options->sizes;
    const uint32_t *n = mesh->tet[t];
    const double *a = mesh->xyz[n[edge[0]]], *b = mesh->xyz[n[edge[1]]];
    double longest = sizes->longest;
    for (int i = 0; i < 4 && sizes->attribute > 0; i++) {
        const double size =
            mesh->node_attribute[n[i] * mesh->node_attributes + sizes->attribute - 1];
        longest = i == 0 || size < longest ? size : longest;
    }
    return sqrt(tm_distance2(a, b)) > longest * (1 + rounding);
}

/* Whether t is for S, where this is not of all that is bad. */
static bool is_target(const tm_lepp_engine *e, uint32_t t, unsigned longest, bool is_bad)
{
    const tm_lepp_options *o = e->options;
    if (!tm_tet_is_in_set(e->mesh, t))
        return false;
    if (tm_lepp_has_sizes(o))
        return is_larger(e, t, tm_edge_corner[longest]);
    return is_bad || e->is_input || o->algorithm != TM_LEPP_SELECTIVE;
}

void tm_lepp_measure(tm_lepp_engine *e, const uint32_t *tet, size_t count)
{
    const tm_tet_mesh *mesh = e->mesh;
    double sine2[TM_MEASURED_AT_ONCE];
    uint8_t longest[TM_MEASURED_AT_ONCE];
    const bool is_of_bad = !mesh->has_set && !tm_lepp_has_sizes(e->options);
    const unsigned bad = TM_LEPP_BAD | (is_of_bad ? TM_LEPP_TARGET : 0);
    for (size_t i = 0, some; i < count; i += some) {
        some = count - i < TM_MEASURED_AT_ONCE ? count - i : TM_MEASURED_AT_ONCE;
        tm_tet_mesh_measure(mesh, tet + i, some, sine2, longest);
        for (size_t k = 0; k < some; k++) {
            uint32_t t = tet[i + k];
            e->quality[t] = sine2[k];
            const bool is_bad = sine2[k] < e->bad_below;
            e->mark[t] = (uint16_t)(longest[k] | (is_bad ? bad : 0));
            if (!is_of_bad && is_target(e, t, longest[k], is_bad))
                e->mark[t] |= TM_LEPP_TARGET;
        }
    }
    for (size_t i = 0; i < count && e->options->measure != TM_MEASURE_DIHEDRAL; i++) {
        const uint32_t *n = mesh->tet[tet[i]];
        e->quality[tet[i]] =
            tm_tet_measure_of(e->options->measure, mesh->xyz[n[0]], mesh->xyz[n[1]],
                              mesh->xyz[n[2]], mesh->xyz[n[3]]);
    }
}

bool tm_lepp_reserve(tm_lepp_engine *e, size_t more)
{
    size_t slots = e->mesh->slots + more;
    uint16_t *mark = tm_grow(e->mark, &e->mark_room, slots, sizeof *mark);
    e->mark = mark ? mark : e->mark;
    double *quality = tm_grow(e->quality, &e->quality_room, slots, sizeof *quality);
    e->quality = quality ? quality : e->quality;
    uint32_t *created = tm_grow(e->created, &e->created_room, more, sizeof *created);
    e->created = created ? created : e->created;
    return mark && quality && created;
}

bool tm_lepp_add_target(tm_lepp_engine *e, uint32_t t)
{
    const bool appended = tm_append(&e->target, &e->targets, &e->target_room, t);
    e->at.of = e->targets;
    return appended;
}

bool tm_lepp_place_nodes(tm_lepp_engine *e)
{
    const tm_tet_mesh *mesh = e->mesh;
    tm_lepp_sweeper *s = &e->sweeper;
    uint32_t *tet_at = tm_grow(s->tet_at, &s->tet_at_room, mesh->nodes, sizeof *tet_at);
    if (!tet_at)
        return false;
    s->tet_at = tet_at;
    for (size_t v = 0; v < mesh->nodes; v++)
        tet_at[v] = TM_NONE;
    for (uint32_t t = 0; t < mesh->slots; t++)
        for (int i = 0; i < 4 && tm_tet_lives(mesh, t); i++)
            tet_at[mesh->tet[t][i]] = t;
    return true;
}

/* Of tetrahedra that were made. */
static bool place_new_nodes(tm_lepp_engine *e, const uint32_t *tet, size_t count)
{
    tm_lepp_sweeper *s = &e->sweeper;
    uint32_t *tet_at =
        tm_grow(s->tet_at, &s->tet_at_room, e->mesh->nodes, sizeof *tet_at);
    s->tet_at = tet_at ? tet_at : s->tet_at;
    for (size_t i = 0; i < count && tet_at; i++)
        for (int k = 0; k < 4; k++)
            tet_at[e->mesh->tet[tet[i]][k]] = tet[i];
    return tet_at;
}

bool tm_lepp_note(tm_lepp_engine *e, const uint32_t *tet, size_t count)
{
    tm_lepp_measure(e, tet, count);
    if (e->options->path == TM_LEPP_FIXED && !place_new_nodes(e, tet, count))
        return false;
    for (size_t i = 0; i < count; i++) {
        uint32_t t = tet[i];
        if (t < e->graph.room)
            e->graph.stamp[t] = 0; /* another one than the path may have seen */
        if (e->reintroduce && (e->mark[t] & TM_LEPP_TARGET) && !tm_lepp_add_target(e, t))
            return false;
    }
    return true;
}

/* The bits of all six edges, and those of the three of each face. */
enum { ALL_REFUSED = 63 * TM_LEPP_REFUSED };
static const unsigned edges_of_face[4] = {
    TM_LEPP_REFUSED << 3 | TM_LEPP_REFUSED << 4 | TM_LEPP_REFUSED << 5,
    TM_LEPP_REFUSED << 1 | TM_LEPP_REFUSED << 2 | TM_LEPP_REFUSED << 5,
    TM_LEPP_REFUSED << 0 | TM_LEPP_REFUSED << 2 | TM_LEPP_REFUSED << 4,
    TM_LEPP_REFUSED << 0 | TM_LEPP_REFUSED << 1 | TM_LEPP_REFUSED << 3};

/* A locked edge has more than one star, and is refused by its nodes for all of them. */
static bool is_locked(const tm_lepp_engine *e, uint32_t a, uint32_t b)
{
    return tm_edge_map_get(&e->mesh->locked, a, b) != NULL;
}

bool tm_lepp_is_blocked_by_nodes(const tm_lepp_engine *e, uint32_t t)
{
    const uint8_t *corner = tm_edge_corner[e->mark[t] & TM_LEPP_LONGEST];
    const uint32_t *n = e->mesh->tet[t];
    const uint32_t *round = tm_edge_map_get(&e->refused, n[corner[0]], n[corner[1]]);
    return round && *round == e->round;
}

bool tm_lepp_is_refused(const tm_lepp_engine *e, const tm_star *star)
{
    return e->mark[star->tet[0]] & TM_LEPP_REFUSED << star->edge[0] ||
           tm_edge_map_get(&e->refused, star->a, star->b);
}

/* With selective an edge stays blocked until its star changes if it is the longest of all
 * around: to come back in another round would find the same. (The other algorithms may
 * not leave that out: swap-centroid counts how often it was somewhere.) */
tm_status tm_lepp_block(tm_lepp_engine *e, const tm_star *star)
{
    if (is_locked(e, star->a, star->b)) {
        if (!tm_edge_map_reserve(&e->refused, 1))
            return tm_fail_memory(e->error);
        tm_edge_map_put(&e->refused, star->a, star->b, e->round);
        return TM_OK;
    }
    bool is_longest = true;
    for (size_t i = 0; i < star->size; i++)
        is_longest &= (e->mark[star->tet[i]] & TM_LEPP_LONGEST) == star->edge[i];
    bool settled = is_longest && e->options->algorithm == TM_LEPP_SELECTIVE;
    unsigned blocked = TM_LEPP_BLOCKED | (settled ? TM_LEPP_SETTLED : 0);
    for (size_t i = 0; i < star->size; i++) {
        uint16_t *mark = &e->mark[star->tet[i]];
        unsigned more = (unsigned)TM_LEPP_REFUSED << star->edge[i];
        if ((*mark & TM_LEPP_LONGEST) == star->edge[i])
            more |= blocked;
        *mark |= (uint16_t)more;
    }
    return TM_OK;
}

void tm_lepp_start_round(tm_lepp_engine *e)
{
    e->round++;
    for (size_t t = 0; t < e->mesh->slots; t++)
        if (!(e->mark[t] & TM_LEPP_SETTLED))
            e->mark[t] &= (uint16_t)~TM_LEPP_BLOCKED;
}

/* Makes those of the edges of t refinable whose bits are given. */
static bool unblock_edges(tm_lepp_engine *e, uint32_t t, unsigned edges)
{
    for (unsigned left = e->mark[t] & edges; left != 0; left &= left - 1) {
        unsigned edge = (unsigned)__builtin_ctz(left / TM_LEPP_REFUSED);
        tm_star *star = &e->around;
        if (!tm_star_around(e->mesh, t, edge, star))
            return false;
        for (size_t i = 0; i < star->size; i++) {
            uint16_t *mark = &e->mark[star->tet[i]];
            unsigned gone = (unsigned)TM_LEPP_REFUSED << star->edge[i];
            if ((*mark & TM_LEPP_LONGEST) == star->edge[i])
                gone |= TM_LEPP_BLOCKED | TM_LEPP_SETTLED;
            *mark &= (uint16_t)~gone;
        }
    }
    return true;
}

/* The same for the locked edges of t. */
static void unblock_locked(tm_lepp_engine *e, uint32_t t)
{
    const uint32_t *n = e->mesh->tet[t];
    for (int k = 0; k < TM_TET_EDGES && e->refused.count > 0; k++)
        tm_edge_map_remove(&e->refused, n[tm_edge_corner[k][0]], n[tm_edge_corner[k][1]]);
}

bool tm_lepp_unblock_star(tm_lepp_engine *e, const tm_star *star)
{
    for (size_t i = 0; i < star->size; i++) {
        unblock_locked(e, star->tet[i]);
        if (!unblock_edges(e, star->tet[i], ALL_REFUSED))
            return false;
    }
    return true;
}

/* They have no marks of refused edges any more; but what else is around such an edge has,
 * and of that a neighbour of them is a part. */
bool tm_lepp_unblock(tm_lepp_engine *e, const uint32_t *tet, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unblock_locked(e, tet[i]);
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t across = tm_tet_across(e->mesh, tet[i], k);
            if (across != TM_NONE &&
                !unblock_edges(e, across / 4, edges_of_face[across % 4]))
                return false;
        }
    }
    return true;
}
