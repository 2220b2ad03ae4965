/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the examination and the statistics of polyhedra are made of, a file each. */
#ifndef TM_EXAMINE_POLY_PARTS_H
#define TM_EXAMINE_POLY_PARTS_H

#include "poly_examine.h"
#include "poly_boundary.h"
#include "poly_centroids.h"
#include "poly_statistics.h"
#include "../../base/sum.h"
#include "../../geom/kernel.h"

#include <stdbool.h>
#include <stddef.h>

/* poly_examine.c, parts of tm_poly_examine(). */

/* The beginning of an examination: what is looked at. */
tm_examination tm_poly_examination(size_t nodes, size_t cells);

/* Polyhedra whose volumes are added up at a time. */
enum { TM_POLY_CHUNK = 1024 };

/* Finds in *found: inverted and degenerate polyhedra, unclosed and unoriented edges.
 * volume[chunks] are those of chunks of TM_POLY_CHUNK. */
tm_status tm_poly_examine_cells(tm_examination *found, const tm_poly_arrays *mesh,
                                tm_sum *volume, unsigned threads, tm_error *error);

/* Finds in *found: open and non-manifold edges, non-manifold vertices of the facets that
 * name only one cell, those at the nodes first … past-1, an edge at its smaller node. */
tm_status tm_poly_examine_boundary(tm_examination *found, const tm_poly_arrays *mesh,
                                   uint32_t first, uint32_t past, tm_error *error);

/* Adds the areas of these facets. */
void tm_poly_add_boundary_area(tm_sum *sum, const tm_poly_arrays *mesh);

/* Finds in *found how facets and cells fit together: unmatched facets, those with a node
 * twice, components, unused nodes, Euler number. O(nodes + corners). */
tm_status tm_poly_examine_facets(tm_examination *found, const tm_poly_arrays *mesh,
                                 tm_error *error);

/* poly_examine_facets.c: its parts, and repeated facets. */

/* Finds in *found: unmatched facets, those with a node twice, boundary faces.
 * parent[cells] gets a tree for each component (disjoint_sets.h). O(nodes + corners). */
tm_status tm_poly_match_facets(tm_examination *found, const tm_poly_arrays *mesh,
                               uint32_t *parent, tm_error *error);

/* *edges is how many edges facets have, of those whose smaller node is first … past-1;
 * edge[*edges], where that is not NULL, gets both nodes of each, the smaller one first,
 * in the order of these. O(nodes + corners). */
tm_status tm_poly_find_edges(uint32_t (*edge)[2], size_t *edges,
                             const tm_poly_arrays *mesh, uint32_t first, uint32_t past,
                             tm_error *error);

/* Finds in *found: repeated facets, of those whose smallest node is first … past-1.
 * Expected O(corners). */
tm_status tm_poly_find_repeated(tm_examination *found, const tm_poly_arrays *mesh,
                                uint32_t first, uint32_t past, tm_error *error);

/* poly_measure.c: volume and areas of a polyhedron by its boundary. */

/* The volume that the faces enclose, positive if their normals point outward: the sum of
 * the tetrahedra of a node and the triangles into which each facet falls around its
 * first node, which are the same for both its cells. *uncertain is what rounding may
 * have made of it: 16 units of rounding of the sum of all magnitudes. O(corners). */
double tm_poly_volume(const tm_poly_boundary *b, const double (*xyz)[3],
                      double *uncertain);

/* The sign of the volume: 0 where |volume| is at most *uncertain; a tetrahedron's sign is
 * exact. The volume is written to *volume. O(corners). */
int tm_poly_sign(const tm_poly_boundary *b, const double (*xyz)[3], double *volume);

/* poly_shape.c: the shape of one polyhedron: the indicators by which virtual element
 * methods tell good ones (T. Sorgente et al., Polyhedral mesh quality indicator for the
 * virtual element method, arXiv 2112.11365, 2021). */

/* A polyhedron is star-shaped if the radius of the largest ball in its kernel is more
 * than so many times its diameter. */
#define TM_POLY_STAR 1e-9

typedef struct tm_poly_shape {
    double volume;
    double diameter;      /* the largest distance of two of its nodes */
    double min_edge;      /* length */
    double min_face_area; /* of its facets */
    double min_dihedral; /* inside, between facets at an edge, in degrees below 360; of */
    double max_dihedral; /* no edges 360 and 0 */
    double kernel_radius; /* of the largest ball in the kernel, over the diameter; or 0 */
    double kernel_ratio;  /* the kernel's volume over the volume, 0 … 1 */
    double centroid_depth; /* how far the centroid is from leaving the kernel, over the */
    bool star_shaped;      /* diameter; below 0 where it is outside */
    double rho[3];         /* see tm_poly_indicator() */
} tm_poly_shape;

/* A node, around the first one of the polyhedron. */
typedef struct tm_poly_point {
    double x[3];
    double distance; /* from the mean of all nodes */
} tm_poly_point;

/* Memory that is kept from one polyhedron to the next. {0} is empty. */
typedef struct tm_poly_shape_memory {
    tm_poly_point *place; /* of its nodes; then again, farthest first */
    double (*normal)[3];  /* of its facets, length 1; 0 of those without area */
    double (*plane)[4];   /* of those with area */
    size_t planes;
    size_t room[3];
    double (*point)[2]; /* of polygons in their planes */
    size_t point_room;
    tm_kernel_memory kernel;
} tm_poly_shape_memory;

void tm_poly_shape_memory_free(tm_poly_shape_memory *memory);

/* Measures the polyhedron that `b` bounds. The plane of a facet has the normal of its
 * vector area and goes through the innermost of its nodes; those without area have none.
 * TM_ERROR_SYSTEM where memory is out. About O(corners), at worst O(nodes² + facets²):
 * see tm_kernel_volume(); polyhedra that are not star-shaped need no kernel volume. */
tm_status tm_poly_shape_measure(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                                const tm_poly_boundary *b, const double (*xyz)[3],
                                tm_error *error);

/* The same, but only volume, diameter, min_face_area, star_shaped and kernel_radius, and
 * the center of that ball, around the first node. */
tm_status tm_poly_ball_measure(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                               const tm_poly_boundary *b, const double (*xyz)[3],
                               double center[3], tm_error *error);

/* poly_indicator.c: how far a polyhedron P with facets F is from what proofs of virtual
 * elements' convergence suppose, as the quality indicator of Sorgente et al. (2022) has
 * it, each 0 … 1:
 *
 *   rho[0] = |ker P| / |P| · Π |ker F| / |F|
 *   rho[1] = ½ (min(|P|^⅓, min h_F) / max(|P|^⅓, h_P)
 *               + mean of min(|F|^½, shortest edge of F) / max(|F|^½, h_F))
 *   rho[2] = ½ (4 / number of facets + mean of 3 / number of edges of F)
 *
 * with kernels, volumes and areas |·| and diameters h. The indicator of a mesh is
 * sqrt(mean of rho[0] (rho[1] + rho[2]) / 2). Facets that are not plane are taken as
 * their projections along their normal. After tm_poly_shape_measure()'s other measures,
 * which calls it; false where memory is out. O(corners²) of each facet. */
bool tm_poly_indicator(tm_poly_shape *shape, tm_poly_shape_memory *memory,
                       const tm_poly_boundary *b);

/* poly_statistics.c: its parts, for who has the polyhedra in several places. */

/* What some polyhedra add: minima, maxima and counts, where means are not yet divided
 * sums; sums that are compensated beside it. */
typedef struct tm_poly_sums {
    tm_poly_statistics part;
    tm_sum volume;
    tm_status status;
} tm_poly_sums;

/* Whether the first attributes of all cells are numbers of tetrahedra. */
bool tm_poly_has_tets(const tm_poly_arrays *mesh);

/* Those of each 256 cells: *chunk, to be freed. */
tm_status tm_poly_sums_measure(tm_poly_sums **chunk, size_t *chunks,
                               const tm_poly_arrays *mesh, bool with_tets,
                               unsigned threads, tm_error *error);

/* Nothing, to which chunks are added in their order; the end of all `cells`. */
void tm_poly_sums_begin(tm_poly_sums *sums);
void tm_poly_sums_add(tm_poly_sums *sums, const tm_poly_sums *chunk, size_t chunks);
void tm_poly_sums_finish(tm_poly_statistics *s, const tm_poly_sums *sums, size_t cells);

/* The boundary's facets, if they are all triangles. */
size_t tm_poly_boundary_triangles(const tm_poly_arrays *mesh, bool *all_are);

/* The sizes of the mesh, by what tm_poly_examine_facets() has found and by
 * boundary_triangles, 0 where the boundary has other facets, and those before that
 * follow. */
void tm_poly_find_sizes(tm_poly_statistics *s, const tm_examination *found, size_t nodes,
                        size_t facets, size_t cells, size_t boundary_triangles);

/* poly_finite_volume.c: its parts, likewise. */

/* What some facets, or cells, add. */
typedef struct tm_fv_sums {
    tm_poly_finite_volume of; /* the mean is a sum */
    size_t facets;
    size_t inside; /* of these */
} tm_fv_sums;

/* What is judged: facets with all that is measured, or only what
 * tm_poly_finite_volume_check() measures; or what else is measured of cells, by their
 * facets. */
typedef enum tm_fv_judged {
    TM_FV_FACETS,
    TM_FV_FACETS_CHECKED,
    TM_FV_CELLS
} tm_fv_judged;

/* The sums of each 1024 of the first `count` of them: *chunk, to be freed. */
tm_status tm_fv_judge(tm_fv_sums **chunk, size_t *chunks, const tm_poly_centroids *m,
                      tm_fv_judged what, size_t count, unsigned threads, tm_error *error);

/* Nothing, to which chunks are added in their order; the end, of a mesh of `cells`. */
void tm_fv_sums_begin(tm_fv_sums *sums);
void tm_fv_sums_add(tm_fv_sums *sums, const tm_fv_sums *chunk, size_t chunks);
void tm_fv_sums_finish(tm_fv_sums *sums, size_t cells);

/* volume_spread is that of the volume that so many are below and the one that so many are
 * above. */
size_t tm_fv_few(size_t cells);
double tm_fv_spread(double low, double high);

#endif
