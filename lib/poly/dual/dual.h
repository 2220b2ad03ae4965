/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The dual of a mesh of tetrahedra: a polyhedron for each node, as finite volume methods
 * like them (R. V. Garimella, J. Kim, M. Berndt, Polyhedral mesh generation and
 * optimization for non-manifold domains, 22nd International Meshing Roundtable, 2014).
 *
 * Each tetrahedron has a point inside; around each edge, the points of the tetrahedra
 * there are a facet between the cells of its two nodes. A face that has to stay
 * (mesh.h) has a point, too, and so have the edges and nodes where such faces meet but do
 * not continue each other: so the boundary, what is between regions and marked faces are
 * made of the same triangles as before, by those parts of them that are next to a node.
 * A node has a cell for each fan: tetrahedra that are connected around the node through
 * faces that do not have to stay. */
#ifndef TM_POLY_DUAL_DUAL_H
#define TM_POLY_DUAL_DUAL_H

#include "../../base/extern_c.h"
#include "../../base/progress.h"
#include "../../stream/stream.h"
#include "../../tet/mesh.h"

#include <stdbool.h>

TM_EXTERN_C_BEGIN

typedef struct tm_dual_options {
    /* Degrees. The parts of faces at a node become one facet where the normals of two
     * beside each other differ by no more; with 0, where they are in one plane
     * (tm_facet_flatness()), so that the surface stays exactly what it is. With more,
     * cells are cut along all edges where the surface is bent inward by more. */
    double feature_angle;
    bool convex; /* points of cells that are not convex are moved, and these cut, too */
    const tm_progress *progress;
} tm_dual_options;

typedef struct tm_dual_report {
    size_t tets, cells, facets, nodes;
    size_t cut;            /* nodes whose cells were cut where the mesh is concave */
    size_t taken_apart;    /* nodes with a cell for each tetrahedron */
    size_t rounds;         /* of moving points, and cutting what is wrong still */
    size_t work;           /* of moving them: as tm_fit_report */
    size_t moved;          /* points that were moved for better facets */
    size_t wrong_pyramids; /* of a facet and a centroid: not of positive volume */
    size_t bad_facets;     /* of which checkMesh complains, and cells but for concave */
    size_t concave;        /* cells that it finds concave */
    size_t lost_edges;     /* of .edge with a marker, that are inside: dropped */
} tm_dual_report;

enum { TM_DUAL_WORK = 1000 };

/* The blocks of a dual mesh: .node, .edge, .facet and .cell. */
typedef struct tm_dual_blocks {
    tm_block node, edge, facet, cell;
} tm_dual_blocks;

/* Makes the dual of a mesh without dead slots. Nodes have the attributes of the field
 * that is linear in the tetrahedra, and the marker of the node, edge or face that they
 * are on; facets the markers of faces, cells the number of their tetrahedra and the
 * attributes of these. Every cell is closed, a ball, and sees all its facets from its
 * centroid as OpenFOAM's checkMesh asks, but for report->wrong_pyramids. With
 * feature_angle 0 no volume of a region changes. Points are moved until TM_DUAL_WORK
 * has been done for each corner of a facet at first; after that nodes with a wrong
 * pyramid are taken apart at once, later with those beside them, so that this ends.
 * TM_ERROR_SYSTEM where memory is out or there are 2^31 points. *made is to be freed,
 * after an error too. Expected O(n). */
tm_status tm_dual_make(tm_dual_blocks *made, const tm_tet_mesh *mesh,
                       const tm_dual_options *options, tm_dual_report *report,
                       tm_error *error);
void tm_dual_blocks_free(tm_dual_blocks *blocks);

TM_EXTERN_C_END

#endif
