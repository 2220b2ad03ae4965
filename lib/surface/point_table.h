/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Joins identical points: a hash table from coordinates to the number of the first point
 * that has them. Points are the same where all three coordinates are equal, 0 and -0
 * too. Open addressing with linear probing; O(1) expected per point. */
#ifndef TM_SURFACE_POINT_TABLE_H
#define TM_SURFACE_POINT_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Begins as {0}. */
typedef struct tm_point_table {
    uint32_t *slot; /* [slots]: id, or UINT32_MAX for free */
    size_t slots;   /* a power of two, or 0 */
    size_t points;
} tm_point_table;

/* The id of the first point with the coordinates of xyz[id], which is id itself where
 * there was none: it is put in. Ids in the table refer to `xyz`, which may have moved
 * since. False where memory is out. */
bool tm_point_table_join(tm_point_table *table, double (*xyz)[3], uint32_t id,
                         uint32_t *first);

/* Puts all points of an array into an empty table. False where memory is out; the table
 * is to be freed in any case. Expected O(count). */
bool tm_point_table_fill(tm_point_table *table, double (*xyz)[3], size_t count);

/* unique[v] becomes the id of the first point with the coordinates of point v, of count
 * points; *joined is how many had another one before them. False where memory is out.
 * Expected O(count). */
bool tm_points_weld(double (*xyz)[3], size_t count, uint32_t *unique, size_t *joined);

/* The id of the first point with those coordinates, or UINT32_MAX. */
uint32_t tm_point_table_find(const tm_point_table *table, double (*xyz)[3],
                             const double point[3]);

void tm_point_table_free(tm_point_table *table);

#endif
