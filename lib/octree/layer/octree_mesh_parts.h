/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The steps of tm_octree_mesh_make() behind interior leaves and boundary, features and
 * assembly, a file each. */
#ifndef TM_LAYER_OCTREE_MESH_PARTS_H
#define TM_LAYER_OCTREE_MESH_PARTS_H

#include "../interior/interior_boundary.h"
#include "assemble.h"
#include "../feature/feature.h"
#include "mesh_share.h"
#include "octree_mesh.h"

/* spurious_components.c: pieces of the mesh, and hollows in it, that the surface does not
 * have: they come off where a part of it is thinner than a leaf. */

/* What of the interior boundary is this rank's: of all, where there is no share. Nodes
 * and faces of ghosts are there, too. */
typedef struct tm_boundary_view {
    const tm_octree *octree;
    const tm_interior_boundary *boundary;
    const tm_octree_share *share; /* NULL: one process has all */
    tm_own_range nodes, faces;
} tm_boundary_view;

/* Exact: coordinates have 32 bits. */
__extension__ typedef __int128 tm_volume;

/* A connected piece of the interior boundary. */
typedef struct tm_boundary_piece {
    uint32_t label; /* the smallest node of the octree in it, of the whole one */
    uint32_t shell; /* of the surface: see tm_spurious_components_remove() */
    bool stays;     /* the same */
    size_t faces;
    tm_volume volume; /* six times that which it encloses; negative: a hollow */
} tm_boundary_piece;

typedef struct tm_boundary_pieces {
    uint32_t *label;          /* [nodes of the octree]: of the piece there is */
    size_t count;             /* of all ranks */
    tm_boundary_piece *piece; /* by label */
} tm_boundary_pieces;

/* Finds the pieces. TM_ERROR_SYSTEM where memory is out; to be freed, after an error too.
 * All ranks call it. O(nodes of the octree). */
tm_status tm_boundary_pieces_find(tm_boundary_pieces *pieces,
                                  const tm_boundary_view *view, tm_error *error);
void tm_boundary_pieces_free(tm_boundary_pieces *pieces);

/* Each piece of the interior boundary belongs to the shell of the surface that most of
 * its nodes are closest to; of those of a shell only the largest stays. The leaves inside
 * of another one are taken away, or, where it is the interior boundary of a hollow,
 * added. at[s] is the point of the surface that is closest to own interior boundary node
 * s. *changed says whether any leaf was; then the interior boundary must be found again.
 * TM_ERROR_SYSTEM where memory is out. All ranks call it. O(leaves). */
tm_status
tm_spurious_components_remove(tm_interior *interior, const tm_boundary_view *view,
                              const tm_boundary_pieces *pieces, const tm_surface *surface,
                              const tm_surface_point *at, bool *changed, tm_error *error);

/* projection.c: the layer's outer nodes go onto the surface, and the nodes below make
 * room. */

/* Puts each outer node where its feature says: on its corner, on its curve, on its patch;
 * between these they are spread by averaging, so that no face is squashed. Then the inner
 * nodes and those next to them are averaged. at[s] is where outer node s is on the
 * surface, before and after. Elements may be inverted by this. `share` says what part of
 * the mesh this rank has, and that all ranks do this; NULL: all of it. TM_ERROR_SYSTEM
 * where memory is out. O(nodes of the interior boundary) queries of the surface,
 * O(elements).
 */
tm_status tm_project_layer(tm_assembly *assembly, const tm_interior_boundary *boundary,
                           const tm_feature *feature, const tm_surface *surface,
                           tm_surface_point *at, const tm_mesh_share *share,
                           tm_error *error);

/* lattice_points.c: positions of a mesh's nodes at which every element is valid. */

/* Fills xyz[assembly->mesh.nodes]: nodes of the lattice as they are on it, but the inner
 * ones 0.08 of the side of the smallest leaf around them inside: outward of the interior
 * boundary (octant_mask.h) is a direction in which all of it can be seen, and nothing is
 * tilted by so much that it would turn: as measured, J_ENS is above 0.09. (With 0.1 a
 * pyramid with three of them can be flat.) Middles are at the means of their leaf's
 * corners. TM_ERROR_SYSTEM where memory is out. O(leaves). */
tm_status tm_lattice_points(const tm_assembly *assembly, const tm_octree *octree,
                            const tm_interior *part, size_t parts,
                            const tm_interior_boundary *boundary, double (*xyz)[3],
                            tm_error *error);

/* losses.c: what of the surface the mesh misses. */

/* What is this rank's of a mesh that ranks have parts of: all leaves of the octree and
 * all faces of the interior boundary of a mesh of one process. */
typedef struct tm_mesh_own {
    size_t first_leaf, past_leaf, first_face, past_face;
} tm_mesh_own;

/* Fills lost, rounded and dropped of the report, which are 0 before, by all ranks
 * together: nodes of the surface that no face is in reach of, by the sides of the leaves
 * there, of which those below `level` are taken for such of it; and leaves with surface
 * but no boundary close by. Only `dropped` where the inside is by the winding number:
 * there surface may be within the mesh. Places of all nodes of own faces are to be known.
 * TM_ERROR_SYSTEM where memory is out. O(n log n).
 */
tm_status tm_octree_mesh_find_losses(tm_octree_mesh *mesh, const tm_octree *octree,
                                     const tm_surface *surface, unsigned level,
                                     const tm_mesh_own *own, tm_error *error);

/* untangling.c: the last step of the mesh: no element is inverted. */

/* Moves nodes around elements of low quality until these are better (optimise.h). Where
 * some are still not valid, their nodes go back towards the lattice, half of the way at a
 * time, until all elements are valid; on the lattice they are. Outer nodes that then are
 * not on the surface are marked and counted. TM_ERROR_SYSTEM where memory is
 * out. */
tm_status tm_untangle_layer(tm_octree_mesh *mesh, const tm_octree *octree,
                            const tm_surface *surface, const tm_progress *progress,
                            tm_error *error);

/* octree_mesh.c: what octree_mesh_ranks.c does, too. */

/* That there is nothing to make. */
tm_status tm_octree_mesh_fail_empty(tm_error *error);

/* Fills of the report what regions and features are lost, of a mesh that is made. */
tm_status tm_octree_mesh_complete_report(tm_octree_mesh *mesh, const tm_octree *octree,
                                         const tm_surface *surface, tm_error *error);

/* adaptive_refinement.c: what adaptive_ranks.c does, too. */

/* Of a mesh with more elements nothing is tried: there would be another one beside it. So
 * many leaves behind a boundary that touch are many. */
enum { TM_MOST_TO_SPLIT = 5000000, TM_BEHIND_MANY = 8 };

/* Finds the leaves whose boundary is that of smaller ones, of those above a level, and
 * whether there are any. */
bool tm_interior_find_behind(const tm_interior *interior, const tm_octree *octree,
                             unsigned level, bool *behind);

/* Sets split[leaves], those that the surface crosses and that have a corner that is near,
 * then makes their corners near. */
void tm_octree_mark_ring(const tm_octree *octree, bool *near, uint8_t *split);

/* One mesh, with its octree, becomes the other one. */
static inline void tm_octree_mesh_exchange(tm_octree_mesh *mesh, tm_octree *octree,
                                           tm_octree_mesh *other_mesh, tm_octree *other)
{
    const tm_octree_mesh moved = *mesh;
    const tm_octree its_octree = *octree;
    *mesh = *other_mesh;
    *octree = *other;
    *other_mesh = moved;
    *other = its_octree;
}

/* By how much pieces and Euler number of the boundary differ from the surface's. */
uint64_t tm_topology_missing(const tm_octree_mesh_report *report,
                             const tm_surface *surface);

#endif
