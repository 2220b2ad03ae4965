/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far the surface of a mesh may move: its constrained faces stay within a distance of
 * those of the input, the *reference*, and the reference within that distance of them;
 * feature curves of feature curves; corners where they are.
 *
 * What is promised of each face, each edge on a feature curve and each node of the
 * reference, and proved before a change is made:
 *
 * - The reference above and below a face, seen along its normal, covers it once, and all
 *   of it there is within the distance of its plane: envelope_cover.c. So every point of
 *   the face has one of the reference within the distance. Distances are linear on the
 *   pieces in which triangles overlap, so the corners of the pieces say it for all.
 * - Of a curve of the reference, what is between the ends of an edge is within the
 *   distance of the edge: envelope_curve.c. So both are near each other.
 * - Every node of the reference inside a patch is within the distance of a face. With the
 *   pieces above, so is what is between the nodes.
 *
 * Faces of a patch are faces that came connected across edges that are no features; a
 * face keeps its patch. (B. Wang, T. Schneider, Y. Hu, M. Attene, D. Panozzo, Exact and
 * efficient polyhedral envelope containment check, 2020, cut faces into pieces; here the
 * reference cuts them.) */
#ifndef TM_ENVELOPE_ENVELOPE_H
#define TM_ENVELOPE_ENVELOPE_H

#include "../../surface/surface.h"
#include "../marks.h"
#include "../mesh.h"

/* A face that is above a triangle of the reference, in a list of them. */
typedef struct tm_envelope_link {
    uint32_t face, next;
} tm_envelope_link;

/* What can be written over: a number of one of the arrays, the curve of an edge, or the
 * place of a node. */
typedef enum tm_envelope_was {
    TM_WAS_BELOW,
    TM_WAS_FIRST,
    TM_WAS_NEXT,
    TM_WAS_CURVE,
    TM_WAS_PLACE
} tm_envelope_was;

/* What was, of what was written over while changes are recorded. */
typedef struct tm_envelope_entry {
    tm_envelope_was what;
    uint32_t at[2]; /* an index; the nodes of an edge */
    uint32_t was;   /* a curve: TM_NONE for none */
    double place;
} tm_envelope_entry;

typedef struct tm_envelope {
    double tolerance; /* the distance: a length */
    tm_surface *reference;
    bool *closed;            /* [curves of the reference]: those without an end */
    uint32_t *leaf, *parent; /* by triangle, and node, of the reference's tree */
    bool borrowed; /* all these are those of the envelope that this is a copy of */

    /* By constrained face: a triangle of the reference below it, which has its patch; the
     * nodes of the reference that are near it, as a list in next_kept. */
    size_t face_room;
    uint32_t *below, *first_kept;
    uint32_t *next_kept; /* [nodes of the reference] */

    /* By triangle of the reference: the faces that are above it, with the largest part of
     * them, and some that were. So each face is found by its own box. */
    uint32_t *first_link; /* [triangles of the reference] */
    tm_envelope_link *link;
    size_t links, link_room, links_at_first;
    double (
        *reach)[6]; /* by node of the tree: a box with all those faces; low and high */

    tm_edge_map curve; /* edges on feature curves: the curve */
    size_t node_room;
    double *place; /* by node: where it is on its curve, in segments of that from its
                      beginning; NaN: at an end, or on none */

    /* While changes are recorded. */
    bool recording;
    tm_envelope_entry *entry;
    size_t entries, entry_room;

    /* For one question. */
    tm_tet_marks seen; /* triangles of the reference, or faces */
    uint32_t *flood;   /* triangles of the reference */
    size_t flood_count, flood_room;
} tm_envelope;

/* A change of the surface. Faces old[0 … olds) go; triangle k with the nodes node[k],
 * which are where they will be, comes as a constrained face face[k], which may be one of
 * the old ones; it is in the patch of the old face from[k]. */
enum { TM_CHANGE_MOST = 96 };
typedef struct tm_surface_change {
    size_t olds, count;
    uint32_t old[TM_CHANGE_MOST];
    uint32_t node[TM_CHANGE_MOST][3];
    uint32_t face[TM_CHANGE_MOST];
    uint32_t from[TM_CHANGE_MOST];
} tm_surface_change;

/* Whether a face is one of the old ones. */
static inline bool tm_surface_change_takes(const tm_surface_change *change, uint32_t face)
{
    for (size_t i = 0; i < change->olds; i++)
        if (change->old[i] == face)
            return true;
    return false;
}

/* Takes the surface of the mesh for the reference. Its feature edges: between other
 * numbers of constrained faces than two, or such that differ in marker, and where the
 * normals of two differ by more than feature_angle; with unless_rough, none of the latter
 * where many of those end freely, as on a scan. The envelope is empty where the mesh has
 * no faces. O(n log n). */
tm_status tm_envelope_build(tm_envelope *envelope, const tm_tet_mesh *mesh,
                            double tolerance, double feature_angle, bool unless_rough,
                            tm_error *error);
void tm_envelope_free(tm_envelope *envelope);

/* Makes *to, which is {0} or a copy, the same as *from, or *to the same as its copy;
 * false where memory is out, with *to as it was. */
bool tm_envelope_copy(tm_envelope *to, const tm_envelope *from);

/* Verifies what is promised of faces and nodes. TM_ERROR_INTERNAL with the first thing
 * that does not hold. As long as all of it takes to be found; for tests. */
tm_status tm_envelope_check(tm_envelope *envelope, const tm_tet_mesh *mesh,
                            tm_error *error);

/* The largest distance between the surface of the mesh and the reference, both ways, as
 * tm_surface_compare() finds it. Where the reference is folded more finely than the
 * distance, a point of it between its nodes may be left behind by more than that. */
tm_status tm_envelope_measure(const tm_envelope *envelope, const tm_tet_mesh *mesh,
                              double *most, tm_error *error);

/* Room for so many faces and nodes of the mesh in all; false where memory is out. */
bool tm_envelope_reserve(tm_envelope *envelope, size_t faces, size_t nodes);

/* Whether the surface may be changed so: the triangles are within the distance, the nodes
 * that the old faces keep are near them, normals stay near the reference's, and on the
 * outside no triangle meets another or a face. False where memory is out, too. Expected
 * O(triangles of the reference below). */
bool tm_envelope_allows(tm_envelope *envelope, const tm_tet_mesh *mesh,
                        const tm_surface_change *change);

/* Notes that it was changed so. There must be room. False where memory is out. */
bool tm_envelope_follow(tm_envelope *envelope, const tm_tet_mesh *mesh,
                        const tm_surface_change *change);

/* Changes are recorded from here on, or not any more; they are kept, or undone. */
void tm_envelope_record(tm_envelope *envelope, bool on);
void tm_envelope_undo(tm_envelope *envelope);

/* An edge of the mesh is on a curve, or on none for TM_NONE; a node is at a place of its
 * curve, or on none for NaN. There is room after tm_envelope_reserve(), for the few of an
 * operation. */
void tm_envelope_put_edge(tm_envelope *envelope, uint32_t a, uint32_t b, uint32_t curve);
void tm_envelope_put_node(tm_envelope *envelope, uint32_t v, double place);

/* Whether a curve of the reference, between two places on it in order, is within the
 * distance of the edge pq whose ends are there. */
bool tm_envelope_allows_edge(const tm_envelope *envelope, uint32_t curve, double from,
                             double to, const double p[3], const double q[3]);

/* The point of a curve between two places on it that is closest to p; its place. */
double tm_envelope_onto_curve(const tm_envelope *envelope, uint32_t curve, double from,
                              double to, double p[3]);

/* The point closest to p in the patch of a face. */
void tm_envelope_onto_patch(const tm_envelope *envelope, uint32_t face, double p[3]);

/* The number of segments of a curve, and whether it is closed without a corner: then
 * places are modulo that number. */
size_t tm_envelope_segments(const tm_envelope *envelope, uint32_t curve);
bool tm_envelope_is_closed(const tm_envelope *envelope, uint32_t curve);

/* The node of the mesh at which a curve begins, as it came. */
uint32_t tm_envelope_begins(const tm_envelope *envelope, uint32_t curve);

#endif
