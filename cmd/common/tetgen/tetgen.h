/* SPDX-License-Identifier: GPL-3.0-or-later */
/* TetGen, run on a surface or on points. */
#ifndef CMD_COMMON_TETGEN_H
#define CMD_COMMON_TETGEN_H

#include "../../../lib/number/number.h"
#include "../../../lib/surface/polygon_surface.h"
#include "../app/filter.h"

enum { TETGEN_SWITCH = TM_DOUBLE_CHARS + 4 };

/* What TetGen is told. */
typedef struct tetgen_request {
    const char *program;
    char quality[TETGEN_SWITCH]; /* "-q1.4"; "" for none */
    char volume[TETGEN_SWITCH];  /* "-a0.1" */
    bool keep_surface;           /* -Y */
    bool regions;                /* -A */
    const char *more;            /* other switches, with "-" before them; NULL: none */
    const double *size; /* [nodes]: how long edges are to be, 0 where that is all the
                           same; or NULL: -m */
    double timeout;     /* seconds; 0: none */
} tetgen_request;

/* Runs TetGen in a private folder and adds what it made, .node, .ele, .face and .edge, to
 * *mesh, with TetGen's numbering. Without facets in the surface TetGen makes the
 * Delaunay tetrahedra of its nodes. Notes and TetGen's complaints go to stderr. Fails
 * with TM_ERROR_INPUT where TetGen says that the surface intersects itself, with
 * TM_ERROR_SYSTEM where the program is missing or fails otherwise, has no room, is not
 * done in time, or makes what is not TetGen's. Success does not mean that there are
 * tetrahedra. */
tm_status tetgen_run(const filter *f, const tetgen_request *r,
                     const tm_polygon_surface *surface, tm_stream *mesh, tm_error *error);

/* The same, but refines tetrahedra: .node, .ele, .face and .edge of a stream (-r). */
tm_status tetgen_refine(const filter *f, const tetgen_request *r, const tm_stream *tets,
                        tm_stream *mesh, tm_error *error);

#endif
