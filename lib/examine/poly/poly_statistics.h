/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The statistics by which meshes of polyhedra are compared: how many are simple, and
 * star-shaped, how many facets and tetrahedra each has, and how good their shapes are. */
#ifndef TM_EXAMINE_POLY_STATISTICS_H
#define TM_EXAMINE_POLY_STATISTICS_H

#include "../../base/extern_c.h"
#include "../../base/error.h"
#include "../../text/json.h"
#include "../../text/text.h"
#include "../../mesh/poly_arrays.h"
#include "poly_boundary.h"
#include "poly_finite_volume.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

enum {
    TM_COUNT_BINS = 64,       /* of counts: see tm_count_bin_begin() */
    TM_KERNEL_RATIO_BINS = 20 /* of 0.05 */
};

/* Of a quantity of each polyhedron. */
typedef struct tm_poly_range {
    double min;
    double mean;
} tm_poly_range;

/* Sizes of a mesh. */
typedef struct tm_poly_sizes {
    size_t elements;
    size_t faces;
    size_t edges;
    size_t nodes;
} tm_poly_sizes;

/* All reals are 0 where there are no polyhedra. */
typedef struct tm_poly_statistics {
    tm_poly_sizes size;  /* nodes that are used */
    tm_poly_sizes input; /* of the tetrahedra that it was made of; 0: not known */
    size_t swallowed;    /* nodes that no facet uses */
    size_t unmatched;    /* facets that do not belong to the cells that they name */
    size_t non_simple;
    size_t cause[TM_POLY_CAUSES]; /* polyhedra; one may have several */
    size_t not_star_shaped;       /* see TM_POLY_STAR */
    size_t largest_faces;         /* the most facets of one polyhedron */
    size_t largest_tets;
    double faces_per_polyhedron; /* means */
    double tets_per_polyhedron;
    double volume;
    double min_volume; /* of a polyhedron */
    double min_edge;
    double min_face_area;
    double min_dihedral; /* degrees, up to 360 */
    double max_dihedral;
    tm_poly_range edge_ratio;    /* shortest edge over diameter */
    tm_poly_range kernel_radius; /* see poly_parts.h */
    tm_poly_range kernel_ratio;
    tm_poly_range centroid_depth;
    size_t centroid_outside; /* polyhedra whose kernel does not hold their centroid */
    tm_poly_range rho[3];    /* see tm_poly_indicator() in poly_parts.h, and the one of */
    double vem_indicator;    /* the mesh */
    double max_diameter;     /* the largest distance of two nodes of a polyhedron */
    size_t faces[TM_COUNT_BINS]; /* polyhedra by their facets, and */
    size_t tets[TM_COUNT_BINS];  /* by their tetrahedra, if input.elements > 0 */
    size_t kernel_ratios[TM_KERNEL_RATIO_BINS];
    tm_poly_finite_volume fv;
} tm_poly_statistics;

/* What polyhedra may be for, and whether all of a mesh are fit for it: all are balls with
 * a volume above 0, and */
typedef enum tm_poly_use {
    TM_USE_FV,  /* finite volumes: within checkMesh's limits, see poly_finite_volume.h */
    TM_USE_VEM, /* virtual elements: star-shaped, too */
    TM_USE_DG,  /* discontinuous Galerkin methods: nothing more */
    TM_POLY_USES
} tm_poly_use;

extern const char *const tm_poly_use_names[TM_POLY_USES];

/* Whether they are, by what was measured. */
bool tm_poly_is_fit(const tm_poly_statistics *statistics, tm_poly_use use);

/* The first count of a bin: 1, 2, 3, 4, 6, 8, 12, 16, 24 … two for each power of 2. */
size_t tm_count_bin_begin(size_t bin);

/* How many bins of a histogram of counts there are up to the last one in use. */
size_t tm_count_bins(const size_t *histogram);

/* Measures all polyhedra. The tetrahedra of each are its first attribute, if there is one
 * and all are integers above 0. Where all facets of the boundary are triangles, the faces
 * of the tetrahedra are known, (4 tetrahedra + boundary faces) / 2, and where all
 * polyhedra are simple, so that Euler's number tells, their edges, if they used all
 * nodes. The same result for every number of threads. TM_ERROR_SYSTEM where memory is
 * out. About O(corners of facets). */
tm_status tm_poly_statistics_measure(tm_poly_statistics *statistics,
                                     const tm_poly_arrays *mesh, unsigned threads,
                                     tm_error *error);

/* Measures each polyhedron c: its volume to volume[c], and to kernel_radius[c] the radius
 * of the largest ball in its kernel over its diameter, 0 where it is not star-shaped. The
 * same result for every number of threads. TM_ERROR_SYSTEM where memory is out. About
 * O(corners of facets). */
tm_status tm_poly_measure_each(double *volume, double *kernel_radius,
                               const tm_poly_arrays *mesh, unsigned threads,
                               tm_error *error);

/* Writes, into an object that the caller opened, the keys of poly-stats(1). */
void tm_poly_statistics_json(tm_json *json, const tm_poly_statistics *statistics);

/* Writes the tables to read. */
void tm_poly_statistics_table(tm_text *text, const tm_poly_statistics *statistics);

TM_EXTERN_C_END

#endif
