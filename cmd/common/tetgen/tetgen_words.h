/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What TetGen says, progress, warnings and complaints, all on one stream. */
#ifndef CMD_COMMON_TETGEN_WORDS_H
#define CMD_COMMON_TETGEN_WORDS_H

#include "../../../lib/surface/polygon_surface.h"
#include "../app/filter.h"

/* On stderr: the lines that are no progress, some of them at most. */
void tetgen_show_complaints(const filter *f, const tm_text *output);

/* With -v all of it. */
void tetgen_show_all(const filter *f, const tm_text *output);

/* How many warnings there are, and the first, unless --quiet. */
void tetgen_show_warnings(const filter *f, const tm_text *output);

/* On stderr: the pairs of faces of which `tetgen -d` says that they meet, some of them at
 * most, each with a place. Returns how many there are. */
size_t tetgen_show_pairs(const filter *f, const tm_text *output,
                         const tm_polygon_surface *surface);

/* Passes on to progress what a piece of the output says that TetGen does. */
void tetgen_tell(const filter *f, const char *words, size_t size);

#endif
