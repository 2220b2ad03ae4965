/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "delaunay_cavity.h"

#include "../../base/array.h"
#include "../../geom/predicates.h"
#include "../../geom/vector.h"
#include "../mesh_measure.h"

#include <stdlib.h>
#include <string.h>

/* In the map of sides: both new tetrahedra at the edge are known. */
#define MATCHED TM_NONE

void tm_delaunay_cavity_free(tm_delaunay_cavity *cavity)
{
    free(cavity->tet);
    free(cavity->face);
    free(cavity->constrained);
    tm_tet_marks_free(&cavity->inside);
    tm_tet_marks_free(&cavity->left_out);
    tm_tet_marks_free(&cavity->seen);
    tm_edge_map_free(&cavity->side);
    *cavity = (tm_delaunay_cavity){0};
}

/* Whether the sphere of t holds the node. A flat tetrahedron has none, and had better
 * go. */
static bool holds(const tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]];
    const double *c = mesh->xyz[n[2]], *d = mesh->xyz[n[3]];
    if (mesh->flat > 0 && tm_orient3d(a, b, c, d) == 0)
        return true;
    return tm_insphere(a, b, c, d, mesh->xyz[cavity->node]) > 0;
}

static bool add_tet(tm_delaunay_cavity *cavity, uint32_t t)
{
    if (!tm_append(&cavity->tet, &cavity->size, &cavity->tet_room, t))
        return false;
    tm_tet_mark(&cavity->inside, t);
    return true;
}

/* The tetrahedra: from the ball to all whose sphere holds the node. */
static bool spread(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    if (!tm_tet_marks_clear(&cavity->inside, mesh->slots))
        return false;
    cavity->size = cavity->ball;
    for (size_t k = 0; k < cavity->ball; k++)
        tm_tet_mark(&cavity->inside, cavity->tet[k]);
    for (size_t k = 0; k < cavity->size && !cavity->only_ball; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t g = mesh->neighbour[cavity->tet[k]][i];
            if (g & TM_FACE_BIT || tm_tet_is_marked(&cavity->inside, g / 4) ||
                tm_tet_is_marked(&cavity->left_out, g / 4) || !holds(cavity, mesh, g / 4))
                continue;
            if (!add_tet(cavity, g / 4))
                return false;
        }
    return true;
}

static tm_delaunay_constrained *find_constrained(const tm_delaunay_cavity *cavity,
                                                 uint32_t f)
{
    for (size_t k = 0; k < cavity->constrained_count; k++)
        if (cavity->constrained[k].face == f)
            return &cavity->constrained[k];
    return NULL;
}

static int corner_of(const uint32_t node[3], uint32_t v)
{
    for (int i = 0; i < 3; i++)
        if (node[i] == v)
            return i;
    return -1;
}

/* Appends constrained face f with nodes of its own, and with `to` in the place of one. */
static bool append_constrained(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                               uint32_t f, int corner, uint32_t to)
{
    tm_delaunay_constrained *constrained =
        tm_grow(cavity->constrained, &cavity->constrained_room,
                cavity->constrained_count + 1, sizeof *constrained);
    if (!constrained)
        return false;
    cavity->constrained = constrained;
    constrained += cavity->constrained_count++;
    *constrained = (tm_delaunay_constrained){.face = f, .sides = 1};
    memcpy(constrained->node, mesh->face[f].node, sizeof constrained->node);
    if (corner >= 0)
        constrained->node[corner] = to;
    constrained->open = corner_of(constrained->node, cavity->node) >= 0;
    return true;
}

/* A face at the edge that the node is to split is two. */
static bool add_constrained(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                            uint32_t f)
{
    tm_delaunay_constrained *constrained = find_constrained(cavity, f);
    if (constrained) {
        constrained->sides++;
        return true;
    }
    int a = corner_of(mesh->face[f].node, cavity->edge[0]);
    int b = corner_of(mesh->face[f].node, cavity->edge[1]);
    if (a < 0 || b < 0)
        return append_constrained(cavity, mesh, f, -1, TM_NONE);
    return append_constrained(cavity, mesh, f, b, cavity->node) &&
           append_constrained(cavity, mesh, f, a, cavity->node);
}

/* The constrained faces at the tetrahedra. */
static bool list_constrained(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    cavity->constrained_count = 0;
    for (size_t k = 0; k < cavity->size; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t g = mesh->neighbour[cavity->tet[k]][i];
            if (g & TM_FACE_BIT && !add_constrained(cavity, mesh, g & ~TM_FACE_BIT))
                return false;
        }
    return true;
}

static unsigned sides_of(const tm_tet_mesh *mesh, uint32_t f)
{
    return (unsigned)(mesh->face[f].side[0] != TM_NONE) +
           (unsigned)(mesh->face[f].side[1] != TM_NONE);
}

/* The one face of the cavity that is at edge ab and not f; NULL where there are more. */
static tm_delaunay_constrained *only_other_at(const tm_delaunay_cavity *cavity,
                                              uint32_t f, uint32_t a, uint32_t b)
{
    tm_delaunay_constrained *found = NULL;
    for (size_t k = 0; k < cavity->constrained_count; k++) {
        tm_delaunay_constrained *constrained = &cavity->constrained[k];
        if (constrained->face == f || corner_of(constrained->node, a) < 0 ||
            corner_of(constrained->node, b) < 0)
            continue;
        if (found)
            return NULL;
        found = constrained;
    }
    return found;
}

/* Opens the face that continues the facet of an open one beyond the edge opposite the
 * node, if there is one: of the two triangles (v a b) and (a b d) come (v a d) and
 * (v d b). */
static bool open_next(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                      tm_delaunay_constrained *constrained)
{
    int i = corner_of(constrained->node, cavity->node);
    uint32_t a = constrained->node[(i + 1) % 3], b = constrained->node[(i + 2) % 3];
    tm_delaunay_constrained *next = only_other_at(cavity, constrained->face, a, b);
    if (!next || next->open || next->sides != sides_of(mesh, next->face))
        return false;
    int at_a = corner_of(next->node, a), at_b = corner_of(next->node, b);
    uint32_t d = next->node[0 + 1 + 2 - at_a - at_b];
    if (!tm_facet_continues(mesh, constrained->face, next->face, a, b, cavity->node, d,
                            cavity->flatness))
        return false;
    constrained->node[(i + 2) % 3] = d;
    next->node[at_a] = cavity->node;
    next->open = true;
    return true;
}

static void open_facets(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    for (size_t k = 0; k < cavity->constrained_count && !cavity->no_facets;) {
        tm_delaunay_constrained *constrained = &cavity->constrained[k];
        if (constrained->open && open_next(cavity, mesh, constrained))
            k = 0;
        else
            k++;
    }
}

/* Whether the node sees a face of the cavity as it must. */
static bool is_seen(const tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                    const uint32_t n[3], bool stays)
{
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]], *c = mesh->xyz[n[2]];
    const double *p = mesh->xyz[cavity->node];
    double normal[3], to[3];
    if (tm_orient3d(a, b, c, p) <= 0)
        return false;
    if (!stays)
        return true;
    /* Rounding put the node a bit inside of a facet. */
    tm_triangle_normal(normal, a, b, c);
    tm_subtract(to, p, a);
    return tm_dot(normal, to) > cavity->flatness * tm_norm(normal);
}

static void leave_out(tm_delaunay_cavity *cavity, size_t k)
{
    if (k < cavity->ball)
        cavity->only_ball = true; /* it may not be without constrained faces beside it */
    else
        tm_tet_mark(&cavity->left_out, cavity->tet[k]);
}

static bool add_face(tm_delaunay_cavity *cavity, const uint32_t node[3], uint32_t half,
                     uint32_t beyond)
{
    tm_delaunay_face *face =
        tm_grow(cavity->face, &cavity->face_room, cavity->faces + 1, sizeof *face);
    if (!face)
        return false;
    cavity->face = face;
    face += cavity->faces++;
    *face = (tm_delaunay_face){.half = half, .beyond = beyond};
    memcpy(face->node, node, sizeof face->node);
    return true;
}

/* The faces; *whole becomes false where a tetrahedron had to be left out. */
static bool list_faces(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh, bool *whole)
{
    cavity->faces = 0;
    for (size_t k = 0; k < cavity->size; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t t = cavity->tet[k], g = mesh->neighbour[t][i], node[3];
            bool stays = g & TM_FACE_BIT;
            if (stays ? find_constrained(cavity, g & ~TM_FACE_BIT)->open
                      : tm_tet_is_marked(&cavity->inside, g / 4))
                continue;
            tm_tet_face_below(mesh, t, i, node);
            if (!is_seen(cavity, mesh, node, stays && k >= cavity->ball)) {
                leave_out(cavity, k);
                *whole = false;
            } else if (!add_face(cavity, node, 4 * t + i, g)) {
                return false;
            }
        }
    return true;
}

static bool clear_sides(tm_delaunay_cavity *cavity)
{
    tm_edge_map *side = &cavity->side;
    if (side->room > 0)
        memset(side->slot, 0, side->room * sizeof *side->slot);
    side->count = 0;
    return tm_edge_map_reserve(side, 3 * cavity->faces + cavity->constrained_count);
}

/* Finds what is across the side face at the edge of face k opposite its node i. */
static bool match_side(tm_delaunay_cavity *cavity, uint32_t k, uint32_t i,
                       size_t *waiting)
{
    tm_delaunay_face *face = &cavity->face[k];
    uint32_t a = face->node[(i + 1) % 3], b = face->node[(i + 2) % 3];
    uint32_t *other = tm_edge_map_get(&cavity->side, a, b);
    if (!other) {
        tm_edge_map_put(&cavity->side, a, b, 4 * k + i);
        ++*waiting;
        return true;
    }
    if (*other == MATCHED)
        return false;
    face->partner[i] = *other;
    if (*other & TM_FACE_BIT) {
        cavity->constrained[*other & ~TM_FACE_BIT].joined++;
        return true;
    }
    cavity->face[*other / 4].partner[*other % 4] = 4 * k + i;
    *other = MATCHED;
    --*waiting;
    return true;
}

/* Whether the side faces of the new tetrahedra fit together and on the open constrained
 * faces. They do not where those bend round the end of a constrained face, or are not a
 * disc. */
static bool match_sides(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    size_t waiting = 0;
    for (uint32_t k = 0; k < cavity->constrained_count; k++) {
        const tm_delaunay_constrained *constrained = &cavity->constrained[k];
        int i = corner_of(constrained->node, cavity->node);
        if (constrained->open)
            tm_edge_map_put(&cavity->side, constrained->node[(i + 1) % 3],
                            constrained->node[(i + 2) % 3], k | TM_FACE_BIT);
    }
    for (uint32_t k = 0; k < cavity->faces; k++)
        for (uint32_t i = 0; i < 3; i++)
            if (!match_side(cavity, k, i, &waiting))
                return false;
    for (size_t k = 0; k < cavity->constrained_count; k++)
        if (cavity->constrained[k].open &&
            cavity->constrained[k].joined != sides_of(mesh, cavity->constrained[k].face))
            return false;
    return waiting == 0;
}

/* Marks the nodes of the faces. */
static bool mark_nodes(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    if (!tm_tet_marks_clear(&cavity->seen, mesh->nodes + 1))
        return false;
    for (size_t k = 0; k < cavity->faces; k++)
        for (int i = 0; i < 3; i++)
            tm_tet_mark(&cavity->seen, cavity->face[k].node[i]);
    tm_tet_mark(&cavity->seen, cavity->node);
    return true;
}

/* Whether tetrahedron t has a node or a marked edge that would be lost. */
static bool loses(const tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    for (int i = 0; i < 4; i++) {
        if (!tm_tet_is_marked(&cavity->seen, n[i]))
            return true;
        for (int j = 0; j < i && mesh->edge_of.count > 0; j++) {
            const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, n[i], n[j]);
            if (edge && edge->marker != 0 && n[i] != cavity->node &&
                n[j] != cavity->node && !tm_edge_map_get(&cavity->side, n[i], n[j]))
                return true;
        }
    }
    return false;
}

/* One try; *fits where it will do, and another one is needed where not. */
static bool try_cavity(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh, bool *fits)
{
    *fits = true;
    if (!spread(cavity, mesh) || !list_constrained(cavity, mesh))
        return false;
    if (cavity->only_ball)
        return true;
    open_facets(cavity, mesh);
    if (!list_faces(cavity, mesh, fits))
        return false;
    if (!*fits)
        return true;
    if (!clear_sides(cavity) || !mark_nodes(cavity, mesh))
        return false;
    if (!match_sides(cavity, mesh)) {
        cavity->only_ball = cavity->no_facets;
        cavity->no_facets = true;
        *fits = false;
        return true;
    }
    for (size_t k = cavity->ball; k < cavity->size; k++)
        if (loses(cavity, mesh, cavity->tet[k])) {
            leave_out(cavity, k);
            *fits = false;
        }
    return true;
}

static bool find(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                 const uint32_t *ball, size_t count)
{
    uint32_t *tet = tm_grow(cavity->tet, &cavity->tet_room, count, sizeof *tet);
    cavity->tet = tet ? tet : cavity->tet;
    if (!tet || !tm_tet_marks_clear(&cavity->left_out, mesh->slots))
        return false;
    memcpy(tet, ball, count * sizeof *tet);
    cavity->ball = count;
    cavity->only_ball = cavity->no_facets = cavity->is_cut_back = false;
    for (;;) {
        bool fits;
        if (!try_cavity(cavity, mesh, &fits))
            return false;
        if (fits)
            return true;
        cavity->is_cut_back = true;
    }
}

bool tm_delaunay_cavity_find(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                             uint32_t node, const uint32_t *ball, size_t count)
{
    cavity->node = node;
    cavity->edge[0] = cavity->edge[1] = TM_NONE;
    return find(cavity, mesh, ball, count);
}

bool tm_delaunay_cavity_foresee(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh,
                                uint32_t node, const tm_star *star)
{
    cavity->node = node;
    cavity->edge[0] = star->a;
    cavity->edge[1] = star->b;
    return find(cavity, mesh, star->tet, star->size);
}

bool tm_delaunay_cavity_is_delaunay(const tm_delaunay_cavity *cavity,
                                    const tm_tet_mesh *mesh)
{
    const double(*xyz)[3] = (const double(*)[3])mesh->xyz;
    for (size_t k = 0; k < cavity->faces; k++) {
        const uint32_t *n = cavity->face[k].node;
        for (int i = 0; i < 3; i++) {
            uint32_t partner = cavity->face[k].partner[i];
            if (partner & TM_FACE_BIT || partner / 4 < k)
                continue;
            uint32_t far = cavity->face[partner / 4].node[partner % 4];
            if (tm_insphere(xyz[n[0]], xyz[n[1]], xyz[n[2]], xyz[cavity->node],
                            xyz[far]) > 0)
                return false;
        }
    }
    return true;
}

void tm_delaunay_cavity_count(tm_delaunay_cavity *cavity, const tm_tet_mesh *mesh)
{
    tm_delaunay_report *report = &cavity->report;
    report->insertions++;
    report->removed += cavity->size;
    report->cut_back += cavity->is_cut_back;
    for (size_t k = 0; k < cavity->constrained_count; k++) {
        const tm_delaunay_constrained *constrained = &cavity->constrained[k];
        const tm_constrained_face *face = &mesh->face[constrained->face];
        report->flipped += constrained->open && corner_of(face->node, cavity->node) < 0;
        if (constrained->open || sides_of(mesh, constrained->face) != 2)
            continue;
        int s = tm_tet_is_marked(&cavity->inside, face->side[0] / 4);
        report->stopped += holds(cavity, mesh, face->side[s] / 4);
    }
}
