/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What users call markers and regions: the rows of .group. */
#ifndef TM_STREAM_GROUP_H
#define TM_STREAM_GROUP_H

#include "../base/extern_c.h"
#include "stream.h"

TM_EXTERN_C_BEGIN

/* Of what the value is that a group names: of markers, or of a region, which is the first
 * attribute of an element. */
typedef enum tm_group_dimension {
    TM_GROUP_NODES,
    TM_GROUP_EDGES,
    TM_GROUP_FACES,
    TM_GROUP_REGIONS,
    TM_GROUP_DIMENSIONS
} tm_group_dimension;

/* Row g of a block of kind TM_GROUP. */
tm_group_dimension tm_group_dimension_of(const tm_block *group, size_t g);
int32_t tm_group_value(const tm_block *group, size_t g);
const char *tm_group_name(const tm_block *group, size_t g);

/* The name of a value, or NULL where it has none; `group` may be NULL. O(groups). */
const char *tm_group_find(const tm_block *group, tm_group_dimension dimension,
                          int32_t value);

/* The value that has that name of so many bytes; NULL where none has. `group` may be
 * NULL. O(groups). */
const int32_t *tm_group_named(const tm_block *group, tm_group_dimension dimension,
                              const char *name, size_t size);

/* Between the names of several groups, in the name of the value for what is in all of
 * them. */
#define TM_GROUP_AND " + "

/* The values of the groups that a name joins, in tm_compare_numbers()'s order and each
 * once: a name in that dimension of `group`, which may be NULL, or the number of a value
 * without one. *parts is 0, and *part NULL, where they are not at least two such. *part
 * is to be freed. TM_ERROR_SYSTEM where memory is out. O(groups) for each. */
tm_status tm_group_parts(const tm_block *group, tm_group_dimension dimension,
                         const char *name, int32_t **part, size_t *parts,
                         tm_error *error);

/* Which attribute of .ele, .mix or .cell is the region: the first, of polyhedra the
 * second (the first is how many tetrahedra they were). There may be fewer. */
size_t tm_group_region_attribute(const tm_block *cells);

/* The region of row e; false where there is none, or no whole number of 32 bits. */
bool tm_group_region(const tm_block *cells, size_t e, int32_t *region);

/* Makes *group, which is {0} or anything else that holds no memory, a block of that name
 * without rows. */
void tm_group_init(tm_block *group, const char *name);

void tm_group_free(tm_block *group);

/* Appends the rows of that dimension of another one, or with TM_GROUP_DIMENSIONS all;
 * none of their names and values is there yet. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_group_append(tm_block *group, const tm_block *from,
                          tm_group_dimension dimension, tm_error *error);

/* Adds all of them as a block of that name, which is not there yet; none where there are
 * none. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_group_to_stream(const tm_block *from, tm_stream *stream, const char *name,
                             tm_error *error);

/* Appends a row: the name is as tm_group_clean() leaves it, and neither it nor the value
 * is there yet in that dimension. TM_ERROR_SYSTEM where memory is out. O(1) on average.
 */
tm_status tm_group_add(tm_block *group, tm_group_dimension dimension, int32_t value,
                       const char *name, tm_error *error);

/* That no name and no value is there twice in a dimension: TM_ERROR_INPUT, with the file
 * and the rows, numbered from base. Expected O(groups). */
tm_status tm_group_check(const tm_block *group, unsigned base, const char *file,
                         tm_error *error);

/* Appends to an empty text what any bytes are as a name: UTF-8 (bytes that are none are
 * taken for Latin-1) with control characters as \x1b and without blanks at the ends.
 * Empty where nothing is left. */
void tm_group_clean(tm_text *name, const char *bytes, size_t size);

TM_EXTERN_C_END

#endif
