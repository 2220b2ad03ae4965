/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes as one page of HTML that shows them in a browser: everything that it needs is in
 * it, and nothing is loaded from elsewhere.
 *
 * The page holds a header in JSON, arrays of 32-bit numbers, and the program of page/,
 * with three.js, which draws. Of an array the lowest bytes of all numbers come first,
 * then the next ones; they are deflated (RFC 1951) and in base64. Coordinates are less
 * the centre of all meshes' box, and so many times `scale`, in the header: 32-bit floats
 * are enough for what is seen. Measures are rounded to 16 significant bits, which halves
 * their size. */
#ifndef TM_VIEW_VIEW_H
#define TM_VIEW_VIEW_H

#include "../base/extern_c.h"
#include "../stream/stream.h"

TM_EXTERN_C_BEGIN

enum { TM_VIEW_MESHES = 2 };

typedef struct tm_view_mesh {
    const tm_stream *stream;
    const char *name; /* any bytes */
    size_t elements;  /* set by tm_view_write(): how many there are, and */
    size_t shown;     /* how many of them are in the page */
} tm_view_mesh;

typedef struct tm_view_options {
    const char *title; /* any bytes */
    size_t most; /* of tetrahedra, mixed elements or polyhedra of a mesh: above it only
                    those at the boundary and the worst hundredth are in the page */
} tm_view_options;

/* Appends a page with one mesh or two to *page. What the main mesh of a stream is, see
 * tm_content_of(); elements may be wrong in any way. `threads` measure and deflate; the
 * bytes are the same for any number of them. TM_ERROR_INPUT without nodes,
 * TM_ERROR_SYSTEM where memory is out. O(n). */
tm_status tm_view_write(tm_text *page, tm_view_mesh *mesh, size_t meshes,
                        const tm_view_options *options, unsigned threads,
                        tm_error *error);

TM_EXTERN_C_END

#endif
