/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libtermesh: all that a program may use, floor by floor. These headers, and no others,
 * are installed; each can be included alone. README.md beside this file is the map. */
#ifndef TERMESH_H
#define TERMESH_H

/* base: errors, arrays, hashes, threads, progress */
#include "base/array.h"
#include "base/error.h"
#include "base/extern_c.h"
#include "base/hash.h"
#include "base/ids.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/stop.h"
#include "base/version.h"

/* ranks: processes that work on one mesh */
#include "ranks/ranks.h"
#include "ranks/mail.h"

/* number: numbers from and to text */
#include "number/number.h"

/* text: growing text, files, JSON and tables */
#include "text/file.h"
#include "text/input.h"
#include "text/json.h"
#include "text/report.h"
#include "text/text.h"
#include "text/utf8.h"

/* geom: predicates and kernels */
#include "geom/vector.h"

/* stream: the stream and its blocks; what other files look like */
#include "stream/coordinates.h"
#include "stream/group.h"
#include "stream/slice.h"
#include "stream/sniff.h"
#include "stream/stream.h"
#include "stream/ranks/pass.h"
#include "stream/ranks/slices.h"

/* element: shapes and measures of one element */
#include "element/aspect_ratio.h"
#include "element/certify.h"
#include "element/jens.h"
#include "element/shape.h"
#include "element/tet_measure.h"
#include "element/tet_quality.h"
#include "element/verdict.h"

/* mesh: views of flat arrays */
#include "mesh/cell_faces.h"
#include "mesh/edge_map.h"
#include "mesh/face_table.h"
#include "mesh/mesh_view.h"
#include "mesh/mixed_boundary.h"
#include "mesh/mixed_mesh.h"
#include "mesh/poly_arrays.h"
#include "mesh/polyhedra.h"

/* surface: triangulated surfaces */
#include "surface/polygon_surface.h"
#include "surface/surface.h"
#include "surface/surface_defects.h"
#include "surface/mend/mend.h"
#include "surface/measure/surface_curvature.h"
#include "surface/measure/surface_distance.h"
#include "surface/measure/surface_evaluate.h"
#include "surface/surface_apart.h"
#include "surface/surface_crossings.h"
#include "surface/surface_seeds.h"

/* examine: what is wrong with a mesh, and how good it is */
#include "examine/element_examine.h"
#include "examine/examination.h"
#include "examine/jens_statistics.h"
#include "examine/mixed_volume.h"
#include "examine/surface_examine.h"
#include "examine/poly/poly_boundary.h"
#include "examine/poly/poly_examine.h"
#include "examine/poly/poly_finite_volume.h"
#include "examine/poly/poly_statistics.h"
#include "examine/ranks/examine_ranks.h"
#include "examine/tet_statistics.h"

/* format: files of other programs */
#include "format/abaqus/abaqus.h"
#include "format/medit/medit.h"
#include "format/mesh_format.h"
#include "format/oct.h"
#include "format/openfoam/openfoam.h"
#include "format/surface/surface_format.h"
#include "format/surface/surface_write.h"
#include "format/tetgen.h"
#include "format/visf.h"
#include "format/vtk/vtk.h"
#include "format/vtk/vtk_piece.h"
#include "format/vtk/vtk_read.h"

/* optimise: node positions */
#include "optimise/optimise.h"

/* tet: tetrahedra, and what makes them better */
#include "tet/mesh.h"
#include "tet/mesh_set.h"
#include "tet/surface_limits.h"
#include "tet/mesh_measure.h"
#include "tet/evaluate.h"
#include "tet/star.h"
#include "tet/parts/parts.h"
#include "tet/share/share.h"
#include "tet/share/take.h"
#include "tet/delaunay/delaunay.h"
#include "tet/improve/improve.h"
#include "tet/improve/improve_forced.h"
#include "tet/improve/improve_parts.h"
#include "tet/improve/improve_ranks.h"
#include "tet/lepp/lepp.h"

/* octree: octrees, and the elements made of them */
#include "octree/forest/mpi_start.h"
#include "octree/forest/octree.h"
#include "octree/forest/octree_build.h"
#include "octree/forest/octree_estimate.h"
#include "octree/share/mesh_ghosts.h"
#include "octree/share/octree_share.h"
#include "octree/forest/rule_files.h"
#include "octree/transition/transition.h"
#include "octree/layer/adaptive_refinement.h"
#include "octree/layer/assemble.h"
#include "octree/feature/feature.h"
#include "octree/interior/interior_boundary.h"
#include "octree/interior/interior_leaves.h"
#include "octree/interior/octant_mask.h"
#include "octree/layer/mesh_choice.h"
#include "octree/layer/octree_mesh.h"
#include "octree/layer/octree_mesh_stream.h"
#include "octree/layer/mesh_share.h"
#include "octree/layer/octree_mesh_ranks.h"
#include "octree/shared_repair/repair_share.h"
#include "octree/repair/repair.h"
#include "octree/repair/repair_forced.h"
#include "octree/repair/repair_shape.h"
#include "octree/repair/repair_state.h"
#include "octree/repair/repair_stream.h"
#include "octree/repair/repair_trace.h"

/* poly: polyhedra made of tetrahedra */
#include "poly/cluster/clusters.h"
#include "poly/dual/dual.h"
#include "poly/facets.h"
#include "poly/fit/fit.h"
#include "poly/given.h"
#include "poly/join_cells.h"
#include "poly/octant/join_octants.h"
#include "poly/partition.h"
#include "poly/ranks/polyhedra_ranks.h"

/* view: a page that shows meshes */
#include "view/view.h"

#endif
