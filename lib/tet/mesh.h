/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of tetrahedra that knows its neighbours, its boundary and the faces between
 * its regions; flat arrays over nodes, tetrahedra and faces.
 *
 * Corner i of tetrahedron t is node tet[t][i]; its face i is the one opposite corner i.
 * The *half face* 4t + i is face i seen from t. All tetrahedra are right-hand positive
 * (tm_orient3d > 0) but the flat ones that the input had. */
#ifndef TM_TET_MESH_H
#define TM_TET_MESH_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../base/ids.h"
#include "../stream/stream.h"
#include "../mesh/edge_map.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

TM_EXTERN_C_BEGIN

/* A value of neighbour[t][i] with this bit is the number of a tm_constrained_face;
 * without it, the half face on the other side. So a mesh has fewer than 2^29 tetrahedra.
 */
#define TM_FACE_BIT ((uint32_t)1 << 31)
#define TM_TETS_MAX TM_IDS_EIGHTH

/* A face that has to stay: on the boundary, between two regions, or inside with a marker
 * that is not 0. */
typedef struct tm_constrained_face {
    uint32_t node[3]; /* in the order of .face */
    uint32_t side[2]; /* half faces; TM_NONE where there is no tetrahedron */
    int32_t marker;
    bool listed; /* .face has it: written again */
} tm_constrained_face;

/* An edge of .edge. */
typedef struct tm_marked_edge {
    uint32_t node[2];
    int32_t marker;
    bool gone; /* removed from the mesh: not written again */
} tm_marked_edge;

typedef struct tm_tet_mesh {
    size_t nodes;
    size_t node_room;
    double (*xyz)[3]; /* xyz[v][0] is NaN: removed, xyz[v][1] the one removed before */
    size_t removed_nodes;
    uint32_t last_removed;
    size_t node_attributes;
    double *node_attribute; /* [nodes][node_attributes] */
    int32_t *node_marker;   /* [nodes], or NULL */

    size_t slots; /* of tetrahedra, dead ones among them */
    size_t slot_room;
    size_t tets;              /* that live */
    uint32_t (*tet)[4];       /* tet[t][0] == TM_NONE: dead, tet[t][1] the next dead */
    uint32_t (*neighbour)[4]; /* see TM_FACE_BIT */
    uint32_t first_dead;
    size_t regions; /* attributes of a tetrahedron */
    double *region; /* [slots][regions] */
    bool has_set;   /* the last of them is one of mesh_set.h */

    size_t faces;
    size_t face_room;
    tm_constrained_face *face;

    size_t edges;
    size_t edge_room;
    tm_marked_edge *edge;
    bool edge_markers;
    bool inner_edges;        /* some edge is not on the boundary */
    bool inner_marked_edges; /* some such edge has a marker */
    tm_edge_map edge_of;     /* two nodes -> edge[…] */
    tm_edge_map locked;      /* edges where the mesh is not manifold: never changed */

    size_t turned;        /* tetrahedra that came left-handed and were turned */
    size_t flat;          /* that came with volume 0 */
    size_t dropped_faces; /* rows of .face inside, without marker, in one region */
    size_t dangling;      /* rows of .face that are no face of a tetrahedron */
} tm_tet_mesh;

/* Whether slot t has a tetrahedron, and whether node v was not removed. */
static inline bool tm_tet_lives(const tm_tet_mesh *mesh, uint32_t t)
{
    return mesh->tet[t][0] != TM_NONE;
}

static inline bool tm_node_lives(const tm_tet_mesh *mesh, uint32_t v)
{
    return !isnan(mesh->xyz[v][0]);
}

static inline bool tm_face_has_node(const uint32_t face[3], uint32_t v)
{
    return face[0] == v || face[1] == v || face[2] == v;
}

/* The node of a face that is neither a nor b, which it has. */
static inline uint32_t tm_face_third_node(const uint32_t face[3], uint32_t a, uint32_t b)
{
    for (int i = 0; i < 2; i++)
        if (face[i] != a && face[i] != b)
            return face[i];
    return face[2];
}

/* The half face on the other side of face i of t; TM_NONE on the boundary. */
static inline uint32_t tm_tet_across(const tm_tet_mesh *mesh, uint32_t t, uint32_t i)
{
    uint32_t n = mesh->neighbour[t][i];
    if (!(n & TM_FACE_BIT))
        return n;
    const tm_constrained_face *face = &mesh->face[n & ~TM_FACE_BIT];
    return face->side[face->side[0] == 4 * t + i];
}

/* The corner of t that is node v; v must be one. */
static inline uint32_t tm_tet_corner(const tm_tet_mesh *mesh, uint32_t t, uint32_t v)
{
    const uint32_t *n = mesh->tet[t];
    return (uint32_t)(n[1] == v) + 2 * (uint32_t)(n[2] == v) + 3 * (uint32_t)(n[3] == v);
}

/* Takes .node, .ele, .face and .edge out of the stream (their arrays move, the empty
 * blocks stay in place) and connects them: tetrahedra are turned to be positive,
 * neighbours found, faces and edges with markers attached. No .ele is a mesh without
 * tetrahedra. TM_ERROR_INPUT where the tetrahedra are no mesh: three at a face, two on
 * the same side of one, a node twice in one, a face or edge listed twice, and where
 * coordinates are too large or too small (stream/coordinates.h). *mesh need not be
 * initialised; tm_tet_mesh_free() also after an error. The same for every number of
 * threads >= 1. Expected O(n). */
tm_status tm_tet_mesh_from_stream(tm_tet_mesh *mesh, tm_stream *stream, unsigned threads,
                                  tm_error *error);

/* Gives the mesh back to the blocks that it was taken from; the mesh is empty then.
 * Dead slots are filled by the last tetrahedra; nodes that were not removed keep their
 * order. */
tm_status tm_tet_mesh_to_stream(tm_tet_mesh *mesh, tm_stream *stream, tm_error *error);

/* Whether a block of the stream refers to numbers that nodes will not have any more:
 * other elements than tetrahedra, where nodes were removed. tm_tet_mesh_to_stream()
 * removes such blocks. */
bool tm_tet_mesh_invalidates(const tm_tet_mesh *mesh, const tm_block *block);

void tm_tet_mesh_free(tm_tet_mesh *mesh);

/* How many tetrahedra are `growth` times those that the mesh has; for growth 0, or more
 * than a mesh can have, TM_TETS_MAX. */
size_t tm_tet_mesh_most(const tm_tet_mesh *mesh, double growth);

/* Makes *to, which is a mesh or {0}, the same as *from. TM_ERROR_SYSTEM, with *to as it
 * was, where memory is out. O(n). */
tm_status tm_tet_mesh_copy(tm_tet_mesh *to, const tm_tet_mesh *from, tm_error *error);

/* Puts the tetrahedra of a mesh without dead slots in the order of a space-filling curve,
 * and their corners in that of their places, so that what is near comes near and nothing
 * depends on how the mesh was numbered, where no two nodes are at one place. order[k] is
 * which tetrahedron the k-th was; may be NULL. O(n log n), by several threads. The mesh
 * cannot be given back after an error, only freed. */
tm_status tm_tet_mesh_sort(tm_tet_mesh *mesh, uint32_t *order, unsigned threads,
                           tm_error *error);

/* The even permutation of the corners that sorts them by rank, or all but the last two:
 * as tm_tet_mesh_sort() has them. Its order is that of the curve's positions of first
 * corners, then of the ranks of all four. */
void tm_tet_sort_corners(const uint32_t rank[4], uint8_t corner[4]);

/* rank[v] is how many nodes come before node v by x, y and z; at one place by their
 * numbers. False where memory is out. O(n log n), by several threads. */
bool tm_tet_mesh_rank_nodes(const tm_tet_mesh *mesh, uint32_t *rank, unsigned threads);

/* Verifies every invariant that this header states. TM_ERROR_INTERNAL with the first
 * that does not hold. O(n log n), for tests and self-checks. */
tm_status tm_tet_mesh_check(const tm_tet_mesh *mesh, tm_error *error);

/* Whether two tetrahedra are in one region, whatever set they are in. */
static inline bool tm_tet_same_region(const tm_tet_mesh *mesh, uint32_t t, uint32_t u)
{
    const size_t width = mesh->regions;
    for (size_t r = 0; r + mesh->has_set < width; r++)
        if (mesh->region[t * width + r] != mesh->region[u * width + r])
            return false;
    return true;
}

/* Makes node w of a mesh what node v of another one is, which has as many attributes and
 * markers as it: its place, attributes and marker. */
static inline void tm_tet_copy_node(tm_tet_mesh *to, uint32_t w, const tm_tet_mesh *from,
                                    uint32_t v)
{
    const size_t width = from->node_attributes;
    memcpy(to->xyz[w], from->xyz[v], sizeof to->xyz[w]);
    if (from->node_marker)
        to->node_marker[w] = from->node_marker[v];
    if (width > 0)
        memcpy(to->node_attribute + w * width, from->node_attribute + v * width,
               width * sizeof *to->node_attribute);
}

/* What operations are made of. Each is O(1) on average; those that may run out of
 * memory make room first, so that an operation that has begun cannot fail. */

/* Room for so many more nodes, tetrahedra, faces and edges. */
tm_status tm_tet_mesh_reserve(tm_tet_mesh *mesh, size_t nodes, size_t tets, size_t faces,
                              size_t edges, tm_error *error);

/* A slot for a tetrahedron; its contents are the caller's to set. */
uint32_t tm_tet_mesh_new_tet(tm_tet_mesh *mesh);

/* Frees the slot of a tetrahedron; who its neighbours were is the caller's to forget. */
void tm_tet_mesh_delete_tet(tm_tet_mesh *mesh, uint32_t t);

/* A node at p, without attributes and marker: they are the caller's to set. There must
 * be room for it. */
uint32_t tm_tet_mesh_new_node(tm_tet_mesh *mesh, const double p[3]);

/* Removes a node that no tetrahedron has any more. */
void tm_tet_mesh_delete_node(tm_tet_mesh *mesh, uint32_t v);

/* Makes half faces h and g each other's neighbours, with no constrained face between
 * them.
 */
static inline void tm_tet_join(tm_tet_mesh *mesh, uint32_t h, uint32_t g)
{
    mesh->neighbour[h / 4][h % 4] = g;
    mesh->neighbour[g / 4][g % 4] = h;
}

/* Half face h takes the place that `old` had on this side of its face; `across` is what
 * stood in the neighbour entry of `old`. */
static inline void tm_tet_replace_half(tm_tet_mesh *mesh, uint32_t h, uint32_t old,
                                       uint32_t across)
{
    mesh->neighbour[h / 4][h % 4] = across;
    if (across & TM_FACE_BIT) {
        tm_constrained_face *face = &mesh->face[across & ~TM_FACE_BIT];
        face->side[face->side[0] != old] = h;
    } else {
        mesh->neighbour[across / 4][across % 4] = h;
    }
}

/* The edge of .edge between two nodes, or NULL. */
tm_marked_edge *tm_tet_mesh_edge(const tm_tet_mesh *mesh, uint32_t a, uint32_t b);

/* For an edge that is removed from the mesh: .edge forgets it too, if it had it. */
void tm_tet_mesh_forget_edge(tm_tet_mesh *mesh, uint32_t a, uint32_t b);

/* Writes the weights of the corners of tetrahedron t that make p; returns how deep p is
 * in it: see tm_barycentric(). */
double tm_tet_coordinates(const tm_tet_mesh *mesh, uint32_t t, const double p[3],
                          double weight[4]);

/* Attributes of nodes are a field that is linear in each tetrahedron: writes its values
 * at p to value[0 … node_attributes), by the tetrahedron of the `count` ones in tet that
 * p is deepest in. O(count). */
void tm_tet_interpolate(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                        const double p[3], double *value);

TM_EXTERN_C_END

#endif
