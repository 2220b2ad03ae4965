/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OpenFOAM's polyMesh: files of text or, read only, binary (OpenFOAM User Guide, section
 * Mesh description).
 *
 * Faces inside come first, in upper-triangular order: by their owner, the lesser of their
 * two cells, then by the other one, their neighbour; their normals point to the
 * neighbour. Then those of the boundary, outward, patch by patch. */
#ifndef TM_FORMAT_OPENFOAM_OPENFOAM_H
#define TM_FORMAT_OPENFOAM_OPENFOAM_H

#include "../../base/extern_c.h"
#include "../../examine/poly/poly_finite_volume.h"
#include "../../stream/stream.h"
#include "../../text/text.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef enum tm_openfoam_kind {
    TM_FOAM_POINTS,
    TM_FOAM_FACES,
    TM_FOAM_OWNER,
    TM_FOAM_NEIGHBOUR,
    TM_FOAM_BOUNDARY,
    TM_FOAM_CELL_ZONES,
    TM_FOAM_FACE_ZONES,
    TM_OPENFOAM_FILES
} tm_openfoam_kind;

/* points, faces, owner, neighbour, boundary; cellZones and faceZones, which may be lists
 * of none */
extern const char *const tm_openfoam_name[TM_OPENFOAM_FILES];

typedef struct tm_openfoam_counts {
    size_t points, cells, faces, patches, cell_zones, face_zones;
} tm_openfoam_counts;

/* Appends the files of a stream's tetrahedra, mixed elements or polyhedra to file[i], in
 * the order of tm_openfoam_name. Boundary facets with the same marker N are a patch of
 * the name that .group has for it, else marker_N, patches in the order of N; without
 * markers there is one, marker_0. Facets inside with a marker other than 0 are a zone of
 * faces, cells of a region (tm_group_region()) with a name, or another than 0, a zone of
 * cells, named alike, else marker_N and region_N. What a word of OpenFOAM cannot have
 * becomes '_', and a name that is taken gets the value behind it. Nodes that no cell has
 * are left out. What checkMesh will measure goes to *measures, if that is not NULL; with
 * all_geometry what it does with that option, too. TM_ERROR_INPUT as
 * tm_cell_faces_find(), or where there are no cells. Expected O(n + b log b) for b facets
 * of the boundary, and what the measures take. */
tm_status tm_openfoam_write(tm_text file[TM_OPENFOAM_FILES], const tm_stream *stream,
                            tm_openfoam_counts *counts, tm_poly_finite_volume *measures,
                            bool all_geometry, tm_error *error);

/* A file to be read. */
typedef struct tm_openfoam_file {
    const char *path; /* for messages; NULL: it is not there */
    tm_text bytes;
} tm_openfoam_file;

/* What of a polyMesh is not in the stream, or was not as it says. */
typedef struct tm_openfoam_report {
    size_t types;        /* patches of another type than patch, */
    tm_text type_names;  /* "wall, empty"; to be freed with the report */
    size_t cells_of_two; /* cells of another zone, too: the first one's is the region */
    size_t faces_of_two; /* faces of zones that have a patch, or another zone, already */
    size_t flipped;      /* faces of zones that their zone turns */
    size_t not_elements; /* cells that are no elements, where these were wanted */
} tm_openfoam_report;

void tm_openfoam_report_free(tm_openfoam_report *report);

/* Reads the files file[i], in the order of tm_openfoam_name, of which those of zones may
 * lack, into an empty stream of base 0: .node, .facet and .cell in the order of the
 * files. Patch N of the file gives its facets a marker and the marker its name, in
 * .group; a patch "marker_M", as tm_openfoam_write() calls one without a name, the marker
 * M and no name. Markers of others are the least from 1 that are free, in their order. So
 * are the zones of faces, and those of cells, of which "region_M" has the region M: the
 * second attribute, behind the number of tetrahedra, which is 0. Cells of no zone have 0.
 * With `elements`, if all cells are tetrahedra, pyramids, wedges or hexahedra they are
 * .ele, with the markers in .face, or .mix, with .facet; the region is then the first
 * attribute. Else they stay polyhedra.
 * TM_ERROR_INPUT, with file and line, where a file is damaged or contradicts another one:
 * after an error the stream is empty. Memory grows with what is there. O(size of the
 * files), but for names of patches and zones, O(p^2) for p of them. */
tm_status tm_openfoam_read(tm_stream *stream,
                           const tm_openfoam_file file[TM_OPENFOAM_FILES], bool elements,
                           tm_openfoam_report *report, tm_error *error);

/* How many zones a file of such has, as pointZones, which no stream has a place for:
 * TM_ERROR_INPUT where that is not in it. O(1). */
tm_status tm_openfoam_count_zones(const tm_openfoam_file *file, size_t *count,
                                  tm_error *error);

TM_EXTERN_C_END

#endif
