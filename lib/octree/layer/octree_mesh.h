/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From a surface and an octree over it to a mesh: the leaves inside, a layer of elements
 * around them whose outer nodes are on the surface. */
#ifndef TM_LAYER_OCTREE_MESH_H
#define TM_LAYER_OCTREE_MESH_H

#include "../../base/extern_c.h"
#include "../../base/progress.h"
#include "assemble.h"
#include "../feature/feature.h"

TM_EXTERN_C_BEGIN

/* What was made, and what could not be. Places are points. */
typedef struct tm_octree_mesh_report {
    size_t lost;       /* leaves with surface that the boundary is farther from than half
                          of their side; those that are split for such count once */
    double lost_at[3]; /* surface in one of them */
    size_t rounded; /* parts of the surface that are as far, around nodes of it: tips */
    double rounded_at[3], rounded_by; /* the farthest of all, and its distance */
    size_t dropped;                   /* shells that the boundary has nothing of */
    double dropped_at[3];             /* a node of one of them */
    size_t corners_lost, curves_lost; /* of the surface */
    double feature_lost_at[3];
    size_t off_surface;  /* boundary nodes that are not on the surface */
    size_t invalid;      /* elements with J_ENS <= 0 */
    size_t not_positive; /* others that are not certified (certify.h); where walls meet */
    double worst;        /* J_ENS; where walls meet */
    size_t regions;      /* 0 where none is inside of another */
    size_t regions_lost; /* shells inside of others that have none, or around such */
    size_t components;   /* of the boundary, with what is between regions */
    int64_t euler;
    size_t outer_components; /* where regions touch, without that */
    int64_t outer_euler;
} tm_octree_mesh_report;

typedef struct tm_octree_mesh {
    /* The leaves of the mesh, in parts: those of a part that touch are of one region. The
       second one are the leaves of regions that the first ones enclose, if there are any;
       where regions touch, see tm_interior_divide(). */
    size_t parts;
    tm_interior *part;
    tm_interior_boundary boundary;
    tm_feature feature;
    tm_assembly assembly;
    tm_surface_point
        *at; /* [nodes of the interior boundary]: where they are on the surface */
    bool *off_surface; /* [nodes of the interior boundary]: it is not there */
    uint32_t *region;  /* [leaves]: one more than the shell around them, 0 outside; NULL
                          where no region is in another, and the file numbers none */
    struct tm_mesh_share *share;  /* where this is what one of several ranks has of it, as
                                     mesh_share.h says; else NULL */
    tm_octree_mesh_report report; /* of the whole mesh */
} tm_octree_mesh;

/* Makes the mesh of an octree. With surface->regions a shell inside of another one bounds
 * a region of its own, and elements on both sides of it have their faces there in common.
 * What is lost, rounded and dropped is only said by
 * tm_octree_mesh_refine_lost(). The surface's patches are joined for a while where one of
 * its curves is too fine, and are as they were after. TM_ERROR_INPUT where no leaf is
 * inside; TM_ERROR_SYSTEM where memory or 32-bit ids are out. *mesh is to be freed, after
 * an error too. `progress` may be NULL. */
tm_status tm_octree_mesh_make(tm_octree_mesh *mesh, const tm_octree *octree,
                              tm_surface *surface, const tm_progress *progress,
                              tm_error *error);
/* The same where the leaves are chosen already: tm_interior_choose() filled *interior,
 * which becomes the mesh's and is empty then. */
tm_status tm_octree_mesh_make_of(tm_octree_mesh *mesh, const tm_octree *octree,
                                 tm_interior *interior, tm_surface *surface,
                                 const tm_progress *progress, tm_error *error);
void tm_octree_mesh_free(tm_octree_mesh *mesh);

/* The elements of all ranks. */
size_t tm_octree_mesh_elements(const tm_octree_mesh *mesh);

TM_EXTERN_C_END

#endif
