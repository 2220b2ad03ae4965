/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A mesh of tetrahedra cut into polyhedra: each is a set of tetrahedra. First regions are
 * found, then each region is repaired: taken apart into pieces that are balls.
 *
 * No polyhedron goes across a face that is kept (mesh.h): regions of the mesh and marked
 * faces bound it. A. E. Cerda, Generador de mallas de poliedros en tres dimensiones,
 * Universidad de Chile (2022); S. Salinas-Fernández and others, POLYLLA: polygonal
 * meshing algorithm based on terminal-edge regions, Engineering with Computers (2022).
 *
 * All of it is faster if the mesh is in the order of a space-filling curve
 * (tm_tet_mesh_sort()). */
#ifndef TM_POLY_PARTITION_H
#define TM_POLY_PARTITION_H

#include "../base/extern_c.h"
#include "../base/progress.h"
#include "../tet/mesh.h"

TM_EXTERN_C_BEGIN

/* How regions are found: a row of tm_poly_modes. */
typedef enum tm_poly_mode {
    TM_POLY_TERMINAL, /* one for each terminal edge: fans and their outlets */
    TM_POLY_EDGE,     /* tetrahedra with one longest edge: what the 2022 program did */
    TM_POLY_FACE,     /* joined across best faces, no barrier face left: best_faces.h */
    TM_POLY_TERMINAL_FACE, /* the same with barrier faces as if they were none */
    TM_POLY_CAVITY,        /* circumcentres in the circumscribed sphere of a seed */
    TM_POLY_COMPACT,       /* compact ones of even size: compact.h */
    TM_POLY_MODES
} tm_poly_mode;

/* Which face is best. */
typedef enum tm_face_metric { TM_FACE_AREA, TM_FACE_INRADIUS } tm_face_metric;

/* Which cells are stars. The extent is the diagonal of a box around the cell. */
typedef enum tm_poly_star {
    TM_NO_STAR,       /* they need not be */
    TM_STAR_BALL,     /* some ball sees all of it */
    TM_STAR_RADIUS,   /* of that radius, by the extent */
    TM_STAR_CENTROID, /* the centroid is inside of the planes of all facets */
} tm_poly_star;

typedef struct tm_poly_options {
    tm_poly_mode mode;
    tm_face_metric face_metric;
    size_t cells;          /* compact: about so many, or with 0 */
    double size;           /* about as large as cubes of this side */
    const uint32_t *given; /* [slots]: the regions, in place of a mode's; or NULL */
    bool repair;           /* the rest is for this */
    tm_poly_star star;
    double radius;          /* of TM_STAR_RADIUS */
    bool absorb;            /* cells of a few tetrahedra join one beside them */
    bool no_swallow;        /* no node inside of a polyhedron */
    size_t max_tets;        /* in one polyhedron; 0: any number */
    const double (*box)[3]; /* [2]: around the whole that a mesh is a part of; or NULL */
    unsigned threads;
    const tm_progress *progress;
} tm_poly_options;

/* Labels each tetrahedron by its region, 0 … *regions-1 in any order. */
typedef tm_status tm_poly_label(const tm_tet_mesh *mesh, const tm_poly_options *options,
                                uint32_t *label, size_t *regions, tm_error *error);

typedef struct tm_poly_mode_row {
    const char *name;
    tm_poly_label *label;
} tm_poly_mode_row;

extern const tm_poly_mode_row tm_poly_modes[TM_POLY_MODES];

/* Of TM_POLY_TERMINAL: for each tetrahedron another one on the way to the root of its
 * region, or itself. */
tm_poly_label tm_poly_outlets;

typedef struct tm_poly_report {
    size_t tets, regions, cells;
    size_t taken_apart; /* regions that were no ball, or no star, or too large */
    size_t absorbed;    /* tetrahedra */
    size_t single;      /* with star: cells of one tetrahedron, and */
    size_t not_star;    /* no stars: those of a flat one, or what has no such radius */
} tm_poly_report;

typedef struct tm_partition {
    size_t cells;
    uint32_t *cell;  /* [slots]: 0 … cells-1, in the order of their first tetrahedra */
    uint32_t *order; /* [slots]: tetrahedra by their cells, ascending in each */
} tm_partition;

/* Cuts a mesh without dead slots. *partition is to be freed also after an error. Expected
 * O(tetrahedra) while stars of edges are small; cavity O(n log n). */
tm_status tm_partition_make(tm_partition *partition, const tm_tet_mesh *mesh,
                            const tm_poly_options *options, tm_poly_report *report,
                            tm_error *error);
void tm_partition_free(tm_partition *partition);

/* The two steps of it with TM_POLY_TERMINAL, for who has a part of a mesh: up[slots]
 * leads to the root of the region, as far as all tetrahedra at an edge of each are there.
 * And partition->cell, the regions 0 … report->regions-1, become cells, numbered as
 * above; what is of region report->regions is in none, and gets partition->cells. */
tm_status tm_partition_outlets(const tm_tet_mesh *mesh, const tm_poly_options *options,
                               uint32_t *up, tm_error *error);
tm_status tm_partition_repair(tm_partition *partition, const tm_tet_mesh *mesh,
                              const tm_poly_options *options, tm_poly_report *report,
                              tm_error *error);

/* Marked faces inside of one region of the mesh are no longer kept. */
void tm_ignore_markers(tm_tet_mesh *mesh);

TM_EXTERN_C_END

#endif
