/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen's files, as they are in the wild. */
#ifndef TM_FORMAT_TETGEN_H
#define TM_FORMAT_TETGEN_H

#include "../base/extern_c.h"
#include "../text/text.h"
#include "../stream/stream.h"
#include "../surface/polygon_surface.h"

TM_EXTERN_C_BEGIN

/* The .node, .ele, .face and .edge files, and .group, which TetGen does not know:
 * numbered from 0 or 1, with comments anywhere, attributes, markers, CR LF, header fields
 * left out. What such a file holds is what a block of the stream holds. */

/* What the files of one mesh have to know of its nodes; {.base = 1} before the first. */
typedef struct tm_tetgen_nodes {
    unsigned base; /* the number of the first one */
    size_t count;
    bool *middle; /* [count]: in the middle of an edge of elements of second order (-o2),
                     whose rows are longer; NULL where they are of first order */
} tm_tetgen_nodes;

/* Reads a file into *block, whose name and kind are set and which is otherwise empty. Of
 * kind TM_NODE, the first row tells *nodes (base stays as it was where there are no
 * rows); other kinds need it: their indices must be its nodes'. Rows may come in any
 * order, but each number must be there once, from 0 or 1 on; they are put in the order of
 * their numbers. Nothing may follow them. The two tetrahedra that `tetgen -nn` adds to
 * rows of .face, and the one to rows of .edge, are skipped. Of elements of second order
 * the corners are taken; .face and .edge have then to be read after .ele. A marker may be
 * written as a real number that is whole. After an error the block's arrays are freed.
 * O(bytes). */
tm_status tm_tetgen_read(tm_block *block, const char *bytes, size_t size,
                         const char *name, tm_tetgen_nodes *nodes, tm_error *error);

/* Takes the nodes out of .node that are in the middle of edges of second order and no
 * corner of a row of the others, which may be NULL, and numbers these anew. *dropped is
 * how many. TM_ERROR_SYSTEM where memory is out. O(n). */
tm_status tm_tetgen_drop_middles(tm_tetgen_nodes *nodes, tm_block *node,
                                 tm_block *const other[3], size_t *dropped,
                                 tm_error *error);

void tm_tetgen_nodes_free(tm_tetgen_nodes *nodes);

/* As tm_tetgen_read(), of the header and the rows at a scan (scan.h), which goes behind
 * them. */
struct tm_scan;
tm_status tm_tetgen_read_rows(tm_block *block, struct tm_scan *scan,
                              tm_tetgen_nodes *nodes, tm_error *error);

/* TetGen accepts tetrahedra of either orientation; a stream has right-hand positive ones.
 */
typedef struct tm_turned {
    size_t turned; /* negative tetrahedra, whose last two nodes were exchanged */
    size_t flat;   /* without volume, exactly: left as they are */
} tm_turned;

/* Makes the tetrahedra of an .ele block right-hand positive; .node holds their nodes.
 * The signs are exact. O(n). */
tm_turned tm_tetgen_orient(const tm_block *node, tm_block *ele);

/* The .poly and .smesh files, and .node files as surfaces of points alone: nodes,
 * facets, holes, regions, numbered from 0 or 1, with comments, attributes and markers.
 * A .smesh file is a .poly file whose facets are one polygon each. */
typedef enum tm_plc_kind { TM_PLC_NODE, TM_PLC_POLY, TM_PLC_SMESH } tm_plc_kind;

/* True where the text claims no nodes: they are in the .node file of the same name. */
bool tm_plc_lacks_nodes(const char *bytes, size_t size);

/* Of a numeric text, which of the three it looks like: TM_PLC_NODE where nothing
 * follows the nodes. O(size). */
tm_plc_kind tm_plc_kind_of(const char *bytes, size_t size);

/* *surface must be empty; after an error it is again. Where the text has no nodes those
 * that *surface holds already, from the .node file, are its nodes: it then need not be
 * empty. O(size). */
tm_status tm_plc_read(tm_polygon_surface *surface, tm_plc_kind kind, const char *bytes,
                      size_t size, const char *name, tm_error *error);

/* Appends the surface as a .poly file, numbered from surface->base. */
void tm_plc_write(tm_text *text, const tm_polygon_surface *surface);

/* Appends its nodes as a .node file. */
void tm_plc_write_nodes(tm_text *text, const tm_polygon_surface *surface);

TM_EXTERN_C_END

#endif
