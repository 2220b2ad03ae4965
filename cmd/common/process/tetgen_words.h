/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What TetGen says while it works: progress, warnings and complaints, all on stdout. */
#ifndef CMD_COMMON_TETGEN_WORDS_H
#define CMD_COMMON_TETGEN_WORDS_H

#include "../app/filter.h"

/* On stderr: the lines that are no progress, some of them at most. */
void tetgen_show_complaints(const filter *f, const tm_text *output);

/* With -v all of it. */
void tetgen_show_all(const filter *f, const tm_text *output);

/* How many warnings there are, and the first, unless --quiet. */
void tetgen_show_warnings(const filter *f, const tm_text *output);

bool tetgen_said(const tm_text *output, const char *words);

#endif
