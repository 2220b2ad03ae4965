/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Input files of Abaqus and CalculiX (.inp): the mesh in them. (Abaqus Keywords
 * Reference; G. Dhondt: CalculiX CrunchiX User's Manual, version 2.20, section 7.)
 *
 * Of a stream with names, the file holds
 *
 *     *NODE, NSET=Nall               all nodes, numbered from 1
 *     *ELEMENT, TYPE=…, ELSET=Eall   all elements: C3D4, C3D5, C3D6, C3D8; of a surface
 * S3 *ELSET, ELSET=steel            the elements of a region; triangles by their markers
 *     *SURFACE, NAME=inlet           the marked faces, as element and number of the face
 *     *NSET, NSET=support            the marked nodes
 *
 * "** termesh" is the first line, and "** termesh end" the last. Comments behind the
 * first have dimension, value and name of groups, "** termesh 2 11 inlet 100%", which a
 * set's name cannot always be; one before each set has its dimension and value. */
#ifndef TM_FORMAT_ABAQUS_ABAQUS_H
#define TM_FORMAT_ABAQUS_ABAQUS_H

#include "../../base/extern_c.h"
#include "../../stream/stream.h"
#include "../../text/text.h"

#include <stddef.h>

TM_EXTERN_C_BEGIN

/* What was done to be a stream, and what is not in it. */
typedef struct tm_abaqus_report {
    size_t instances;    /* parts that stand in the assembly, if it is more than one */
    size_t several;      /* markers and regions that stand for more than one set */
    size_t turned;       /* left-handed elements */
    size_t cut;          /* quadrilaterals of a surface, cut into triangles */
    size_t higher_order; /* elements that are their corners now, */
    size_t middle_nodes; /* and nodes that are left out */
    size_t loose;        /* faces that no element has, left out */
    size_t others;       /* elements of types that a stream has not, left out */
    size_t no_members;   /* members of sets that are not there, left out */
    size_t no_faces;     /* entries of surfaces that name no face of an element */
    size_t surfaces;     /* surfaces of other types, left out */
    tm_text types;       /* "MASS, SPRINGA": of the other elements */
} tm_abaqus_report;

void tm_abaqus_report_free(tm_abaqus_report *report);

/* Reads the nodes, elements and sets of a file. *stream must be empty and gets nodes,
 * .ele or .mix, or .face where no element has a volume, .face or .facet, .edge and
 * .group; nodes and elements in the order of their ids, those of one instance behind
 * those of another. After an error it is empty again: TM_ERROR_INPUT with the line.
 * Expected O(size log size), and O(sets x members) for sets of sets. */
tm_status tm_abaqus_read(tm_stream *stream, const char *bytes, size_t size,
                         const char *name, tm_abaqus_report *report, tm_error *error);

/* Appends the file to *text; *loose is how many marked faces are no face of an element,
 * which are not in it. `threads` format; the bytes are the same for any number.
 * TM_ERROR_INPUT for polyhedra and without nodes, TM_ERROR_SYSTEM where memory is out.
 * Expected O(n log n). */
tm_status tm_abaqus_write(tm_text *text, const tm_stream *stream, unsigned threads,
                          size_t *loose, tm_error *error);

TM_EXTERN_C_END

#endif
