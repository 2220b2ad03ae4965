/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../../base/array.h"
#include "../../surface/surface_tree.h"
#include "envelope_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void tm_envelope_free(tm_envelope *envelope)
{
    if (envelope->reference && !envelope->borrowed) {
        tm_surface_free(envelope->reference);
        free(envelope->reference);
        free(envelope->closed);
        free(envelope->leaf);
        free(envelope->parent);
    }
    free(envelope->below);
    free(envelope->first_kept);
    free(envelope->next_kept);
    free(envelope->first_link);
    free(envelope->link);
    free(envelope->reach);
    free(envelope->place);
    free(envelope->flood);
    free(envelope->entry);
    tm_edge_map_free(&envelope->curve);
    tm_tet_marks_free(&envelope->seen);
    *envelope = (tm_envelope){0};
}

bool tm_envelope_reserve(tm_envelope *envelope, size_t faces, size_t nodes)
{
    enum { new_edges = 4, entries_most = 16 }; /* of an operation on a curve */
    const size_t old = envelope->face_room, old_nodes = envelope->node_room;
    if (faces > old) {
        size_t room = old, same_room = old;
        uint32_t *below = tm_grow(envelope->below, &room, faces, sizeof *below);
        envelope->below = below ? below : envelope->below;
        uint32_t *kept = tm_grow(envelope->first_kept, &same_room, faces, sizeof *kept);
        envelope->first_kept = kept ? kept : envelope->first_kept;
        if (!below || !kept)
            return false;
        memset(below + old, -1, (room - old) * sizeof *below);
        memset(kept + old, -1, (room - old) * sizeof *kept);
        envelope->face_room = room;
    }
    if (nodes > old_nodes) {
        size_t room = old_nodes;
        double *place = tm_grow(envelope->place, &room, nodes, sizeof *place);
        if (!place)
            return false;
        for (size_t v = old_nodes; v < room; v++)
            place[v] = NAN;
        envelope->place = place;
        envelope->node_room = room;
    }
    tm_envelope_entry *entry = tm_grow(envelope->entry, &envelope->entry_room,
                                       envelope->entries + entries_most, sizeof *entry);
    envelope->entry = entry ? entry : envelope->entry;
    return entry && tm_edge_map_reserve(&envelope->curve, new_edges);
}

static void *copy(const void *from, size_t count, size_t size, bool *done)
{
    void *made = tm_new(count, size);
    if (!made)
        *done = false;
    else if (count > 0)
        memcpy(made, from, count * size);
    return made;
}

bool tm_envelope_copy(tm_envelope *to, const tm_envelope *from)
{
    bool done = true;
    const tm_surface *reference = from->reference;
    if (!reference)
        return true;
    tm_envelope made = *from;
    made.reference = to->reference ? to->reference : from->reference;
    made.borrowed = to->reference ? to->borrowed : true;
    made.link_room = from->links;
    made.below = copy(from->below, from->face_room, sizeof *made.below, &done);
    made.first_kept =
        copy(from->first_kept, from->face_room, sizeof *made.first_kept, &done);
    made.next_kept =
        copy(from->next_kept, reference->nodes, sizeof *made.next_kept, &done);
    made.first_link =
        copy(from->first_link, reference->triangles, sizeof *made.first_link, &done);
    made.link = copy(from->link, from->links, sizeof *made.link, &done);
    made.reach = copy(from->reach, reference->tree->nodes, sizeof *made.reach, &done);
    made.place = copy(from->place, from->node_room, sizeof *made.place, &done);
    made.curve.slot =
        copy(from->curve.slot, from->curve.room, sizeof *made.curve.slot, &done);
    made.recording = false;
    made.entry = NULL;
    made.entries = made.entry_room = 0;
    made.seen = (tm_tet_marks){0};
    made.flood = NULL;
    made.flood_count = made.flood_room = 0;
    if (!done) {
        made.borrowed = true;
        tm_envelope_free(&made);
        return false;
    }
    to->borrowed = true; /* the reference stays */
    tm_envelope_free(to);
    *to = made;
    return true;
}

void tm_envelope_record(tm_envelope *envelope, bool on)
{
    envelope->recording = on;
    envelope->entries = 0;
}

static void put_edge(tm_envelope *e, uint32_t a, uint32_t b, uint32_t curve)
{
    if (curve == TM_NONE)
        tm_edge_map_remove(&e->curve, a, b);
    else
        tm_edge_map_put(&e->curve, a, b, curve);
}

void tm_envelope_put_edge(tm_envelope *envelope, uint32_t a, uint32_t b, uint32_t curve)
{
    const uint32_t *was = tm_edge_map_get(&envelope->curve, a, b);
    if (envelope->recording)
        envelope->entry[envelope->entries++] =
            (tm_envelope_entry){TM_WAS_CURVE, {a, b}, was ? *was : TM_NONE, 0};
    put_edge(envelope, a, b, curve);
}

void tm_envelope_put_node(tm_envelope *envelope, uint32_t v, double place)
{
    if (envelope->recording)
        envelope->entry[envelope->entries++] =
            (tm_envelope_entry){TM_WAS_PLACE, {v, v}, TM_NONE, envelope->place[v]};
    envelope->place[v] = place;
}

static uint32_t *number_at(tm_envelope *e, tm_envelope_was what, uint32_t i)
{
    return what == TM_WAS_BELOW   ? &e->below[i]
           : what == TM_WAS_FIRST ? &e->first_kept[i]
                                  : &e->next_kept[i];
}

/* Writes a number of one of the arrays; false where memory is out. */
static bool put(tm_envelope *e, tm_envelope_was what, uint32_t i, uint32_t number)
{
    uint32_t *at = number_at(e, what, i);
    if (e->recording) {
        tm_envelope_entry *entry =
            tm_grow(e->entry, &e->entry_room, e->entries + 1, sizeof *entry);
        if (!entry)
            return false;
        e->entry = entry;
        entry[e->entries].what = what;
        entry[e->entries].at[0] = i;
        entry[e->entries++].was = *at;
    }
    *at = number;
    return true;
}

void tm_envelope_undo(tm_envelope *envelope)
{
    tm_envelope *e = envelope;
    while (e->entries > 0) {
        const tm_envelope_entry *entry = &e->entry[--e->entries];
        if (entry->what == TM_WAS_CURVE)
            put_edge(e, entry->at[0], entry->at[1], entry->was);
        else if (entry->what == TM_WAS_PLACE)
            e->place[entry->at[0]] = entry->place;
        else
            *number_at(e, entry->what, entry->at[0]) = entry->was;
    }
}

static tm_covered covered(const tm_tet_mesh *mesh, const uint32_t node[3], uint32_t below)
{
    return (tm_covered){{mesh->xyz[node[0]], mesh->xyz[node[1]], mesh->xyz[node[2]]},
                        below};
}

/* The triangle of a change that is nearest to a point; its squared distance. */
static size_t nearest(const tm_tet_mesh *mesh, const tm_surface_change *change,
                      const double p[3], double *distance2)
{
    size_t best = 0;
    *distance2 = HUGE_VAL;
    for (size_t k = 0; k < change->count; k++) {
        const uint32_t *n = change->node[k];
        double to =
            tm_triangle_distance2(p, mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]]);
        if (!(to < *distance2))
            continue;
        *distance2 = to;
        best = k;
    }
    return best;
}

/* Whether the nodes that the old faces keep have a new one near. */
static bool keeps_nodes(const tm_envelope *e, const tm_tet_mesh *mesh,
                        const tm_surface_change *change)
{
    for (size_t i = 0; i < change->olds; i++)
        for (uint32_t v = e->first_kept[change->old[i]]; v != TM_NONE;
             v = e->next_kept[v]) {
            double distance2;
            nearest(mesh, change, e->reference->xyz[v], &distance2);
            if (!(distance2 <= e->tolerance * e->tolerance))
                return false;
        }
    return true;
}

bool tm_envelope_allows(tm_envelope *envelope, const tm_tet_mesh *mesh,
                        const tm_surface_change *change)
{
    if (!keeps_nodes(envelope, mesh, change))
        return false;
    for (size_t k = 0; k < change->count; k++) {
        tm_covered triangle =
            covered(mesh, change->node[k], envelope->below[change->from[k]]);
        if (!tm_envelope_covers(envelope, &triangle) ||
            tm_envelope_crosses(envelope, mesh, change, k))
            return false;
    }
    return true;
}

bool tm_envelope_is_linked(const tm_envelope *e, uint32_t t, uint32_t face)
{
    for (uint32_t l = e->first_link[t]; l != TM_NONE; l = e->link[l].next)
        if (e->link[l].face == face)
            return true;
    return false;
}

/* The boxes of the tree above triangle t hold the face, too. */
static void extend_reach(tm_envelope *e, const tm_tet_mesh *mesh, uint32_t t,
                         const uint32_t n[3])
{
    for (uint32_t node = e->leaf[t]; node != TM_NONE; node = e->parent[node]) {
        double *box = e->reach[node];
        bool grown = false;
        for (int i = 0; i < 3; i++)
            for (int x = 0; x < 3; x++) {
                double p = mesh->xyz[n[i]][x];
                grown |= p < box[x] || p > box[3 + x];
                box[x] = p < box[x] ? p : box[x];
                box[3 + x] = p > box[3 + x] ? p : box[3 + x];
            }
        if (!grown)
            return;
    }
}

/* Face `face`, which has or will have the nodes n, is above triangle t, mostly. */
static bool add_link(tm_envelope *e, const tm_tet_mesh *mesh, uint32_t t, uint32_t face,
                     const uint32_t n[3])
{
    extend_reach(e, mesh, t, n);
    if (tm_envelope_is_linked(e, t, face))
        return true;
    tm_envelope_link *link =
        tm_grow(e->link, &e->link_room, e->links + 1, sizeof *e->link);
    if (!link)
        return false;
    e->link = link;
    link[e->links] = (tm_envelope_link){face, e->first_link[t]};
    e->first_link[t] = (uint32_t)e->links++;
    return true;
}

/* Links all faces anew: those that were above another triangle once go. */
bool tm_envelope_link_all(tm_envelope *e, const tm_tet_mesh *mesh)
{
    e->links = 0;
    memset(e->first_link, -1, e->reference->triangles * sizeof *e->first_link);
    for (size_t node = 0; node < e->reference->tree->nodes; node++)
        for (int x = 0; x < 6; x++)
            e->reach[node][x] = x < 3 ? HUGE_VAL : -HUGE_VAL;
    for (uint32_t f = 0; f < mesh->faces; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (face->side[0] == TM_NONE && face->side[1] == TM_NONE)
            continue;
        if (!add_link(e, mesh, e->below[f], f, face->node))
            return false;
    }
    e->links_at_first = e->links;
    return true;
}

/* The nodes kept by the old faces, as one list. */
static bool gather_kept(tm_envelope *e, const tm_surface_change *change, uint32_t *kept)
{
    *kept = TM_NONE;
    for (size_t i = 0; i < change->olds; i++) {
        for (uint32_t v = e->first_kept[change->old[i]], next; v != TM_NONE; v = next) {
            next = e->next_kept[v];
            if (!put(e, TM_WAS_NEXT, v, *kept))
                return false;
            *kept = v;
        }
        if (!put(e, TM_WAS_FIRST, change->old[i], TM_NONE))
            return false;
    }
    return true;
}

/* Face `face` is new, or new there. */
static bool place_face(tm_envelope *e, const tm_tet_mesh *mesh, uint32_t face,
                       const uint32_t node[3], uint32_t below)
{
    tm_covered triangle = covered(mesh, node, below);
    return tm_envelope_covers(e, &triangle) && put(e, TM_WAS_BELOW, face, e->flood[0]) &&
           put(e, TM_WAS_FIRST, face, TM_NONE) &&
           add_link(e, mesh, e->flood[0], face, node);
}

bool tm_envelope_follow(tm_envelope *envelope, const tm_tet_mesh *mesh,
                        const tm_surface_change *change)
{
    const size_t most = 4; /* times the links that there are */
    tm_envelope *e = envelope;
    uint32_t from[TM_CHANGE_MOST], kept, next;
    for (size_t k = 0; k < change->count; k++)
        from[k] = e->below[change->from[k]];
    if (!gather_kept(e, change, &kept))
        return false;
    for (size_t k = 0; k < change->count; k++)
        if (!place_face(e, mesh, change->face[k], change->node[k], from[k]))
            return false;
    for (uint32_t v = kept; v != TM_NONE; v = next) {
        double distance2;
        uint32_t face =
            change->face[nearest(mesh, change, e->reference->xyz[v], &distance2)];
        next = e->next_kept[v];
        if (!put(e, TM_WAS_NEXT, v, e->first_kept[face]) ||
            !put(e, TM_WAS_FIRST, face, v))
            return false;
    }
    return e->recording || e->links <= most * e->links_at_first ||
           tm_envelope_link_all(e, mesh);
}

void tm_envelope_onto_patch(const tm_envelope *envelope, uint32_t face, double p[3])
{
    uint32_t below = envelope->below[face];
    tm_surface_point at = {.triangle = below};
    tm_surface_closest(envelope->reference, p, envelope->reference->patch[below], &at);
    memcpy(p, at.xyz, sizeof at.xyz);
}
