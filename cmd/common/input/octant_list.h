/* SPDX-License-Identifier: GPL-3.0-or-later */
/* --octants FILE.ref: octants that a list names by their ids. */
#ifndef CMD_COMMON_OCTANT_LIST_H
#define CMD_COMMON_OCTANT_LIST_H

#include "../../../lib/stream/stream.h"
#include "../app/filter.h"

/* The rows of .octant that a .ref file lists (tm_octants_of_ids()), malloc'ed. What is
 * wrong with the file, or an id that no octant has, ends the program. */
uint32_t *octant_list_read(const filter *f, const char *file, const tm_stream *stream,
                           size_t *count);

#endif
