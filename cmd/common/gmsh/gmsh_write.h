/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stream as a model of Gmsh, and that as a file. */
#ifndef CMD_COMMON_GMSH_WRITE_H
#define CMD_COMMON_GMSH_WRITE_H

#include "../../../lib/stream/stream.h"
#include "gmsh_model.h"

#include <stdint.h>

/* The formats that are written. */
typedef enum gmsh_output {
    GMSH_MSH4,
    GMSH_MSH40,
    GMSH_MSH2,
    GMSH_MSH1,
    GMSH_TO_MEDIT,
    GMSH_TO_INP,
    GMSH_TO_BDF,
    GMSH_TO_UNV,
    GMSH_TO_SU2,
    GMSH_TO_KEY,
    GMSH_TO_MED,
    GMSH_TO_CGNS,
    GMSH_OUTPUTS
} gmsh_output;

/* What Gmsh is told, and what its writer knows. */
typedef struct gmsh_output_format {
    const char *name;   /* of --format */
    const char *suffix; /* by which Gmsh tells it */
    bool has_binary;
    bool has_points;
    int digits;       /* of a coordinate, in text */
    unsigned shapes;  /* bit k: cells of k nodes */
    int32_t most;     /* the highest number of a group: above, numbers run together */
    size_t most_rows; /* of nodes and of elements, likewise */
} gmsh_output_format;
extern const gmsh_output_format gmsh_output_formats[GMSH_OUTPUTS];

/* The format of a file by its suffix, or GMSH_OUTPUTS. */
gmsh_output gmsh_output_of(const char *name);

/* A row that becomes an element: of .face, .facet, .edge, .ele or .mix, or of .node. */
typedef struct gmsh_item {
    const tm_block *block;
    uint32_t row;
    uint32_t order; /* of its dimension, as they come */
    uint32_t group; /* in the plan's list of the dimension */
} gmsh_item;

/* The rows of one value: an entity of Gmsh's, and the physical groups that it is in, most
 * often one. */
typedef struct gmsh_value {
    int32_t value;
    int32_t number; /* the value, or where that is below 1 another one */
    size_t groups;
    int32_t *group;
} gmsh_value;

/* What of a stream becomes what of a model. */
typedef struct gmsh_plan {
    const tm_stream *stream;
    const tm_block *node, *names;
    size_t items[GMSH_DIMENSIONS];
    gmsh_item *item[GMSH_DIMENSIONS]; /* by group, then by number of nodes, then by row */
    size_t values[GMSH_DIMENSIONS];
    gmsh_value *value[GMSH_DIMENSIONS]; /* ascending */
    size_t renumbered;                  /* values below 1 that are there */
    size_t unused;                      /* nodes that no item has: they are not written */
    size_t polygons;                    /* of more than four nodes: not written */
    bool points;                        /* nodes with a marker are written as points */
} gmsh_plan;

/* What is written: the cells, else the triangles, else all nodes as points; and of .face,
 * .facet, .edge and .node what has a marker other than 0 beside them. A name of several
 * names, joined as TM_GROUP_AND says, is of all those groups. *plan has `points` set and
 * is to be freed, after an error too; the stream has to stay. TM_ERROR_SYSTEM where
 * memory is out. O(n log n). */
tm_status gmsh_plan_make(gmsh_plan *plan, const tm_stream *stream, tm_error *error);
void gmsh_plan_free(gmsh_plan *plan);

/* Gmsh writes names in quotes: makes quotes in them apostrophes. */
void gmsh_change_quotes(char *name);

/* Lets Gmsh write a file; appends it to *text. TM_ERROR_SYSTEM with what Gmsh says where
 * it cannot. */
tm_status gmsh_write(tm_text *text, const gmsh_plan *plan, gmsh_output format,
                     bool binary, tm_error *error);

#endif
