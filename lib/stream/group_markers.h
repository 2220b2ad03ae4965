/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Markers for the groups of a foreign file while that is read. */
#ifndef TM_STREAM_GROUP_MARKERS_H
#define TM_STREAM_GROUP_MARKERS_H

#include "../base/hash.h"
#include "group.h"

/* Markers from 1 on; {0} but for group, to which the names are added, and dimension. */
typedef struct tm_group_markers {
    tm_block *group;
    tm_group_dimension dimension;
    int32_t values; /* given so far */
    tm_hash_table table;
    size_t room; /* for so many names */
} tm_group_markers;

/* The marker of the group of that name (cleaned here), a new one where it is new; of one
 * without a name a new one each time. Expected O(size). */
tm_status tm_group_marker(tm_group_markers *markers, const char *bytes, size_t size,
                          int32_t *marker, tm_error *error);
void tm_group_markers_free(tm_group_markers *markers);

#endif
