/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of .group as text; for lib/stream/ only. */
#ifndef TM_STREAM_GROUP_NAMES_H
#define TM_STREAM_GROUP_NAMES_H

#include "group.h"
#include "row.h"

/* Of the row that is being read, number, dimension and value are: the name at `at` is the
 * rest of the line, whose line feed is at `feed`. Returns the begin of the next line, or
 * NULL with the cause in context->problem. */
const char *tm_group_row_name(tm_row_context *context, const char *at, const char *feed);

/* Appends all rows. */
void tm_group_write(tm_text *text, const tm_block *group, unsigned base);

#endif
