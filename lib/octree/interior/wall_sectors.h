/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How regions lie around the curves of a surface where walls meet: as sectors. */
#ifndef TM_INTERIOR_WALL_SECTORS_H
#define TM_INTERIOR_WALL_SECTORS_H

#include "../../base/error.h"
#include "../../surface/surface.h"

#include <stdint.h>

enum { TM_SECTORS = 4 };

/* Across a segment of a curve: u, v and the direction of the segment are a right-handed
 * frame; sector i begins at the angle begin[i], from u to v, and ends where the next one
 * begins. */
typedef struct tm_sector_frame {
    double u[3], v[3], begin[TM_SECTORS];
} tm_sector_frame;

typedef struct tm_wall_sectors {
    bool *sharp;                   /* [curves]: some sector is of less than 80 degrees */
    uint8_t *count;                /* [curves]: 3 or 4, or 0 where octants cannot follow
                                      the curve */
    uint32_t (*label)[TM_SECTORS]; /* [curves]: the regions of the sectors */
    tm_sector_frame *frame;        /* [curve_start[curves]]: of the segment that begins
                                      with that node of a curve */
} tm_wall_sectors;

/* Finds them, of curves at which three or four different regions meet, none in a sector
 * of less than 15 degrees. TM_ERROR_SYSTEM where memory is out; to be freed, after an
 * error too. O(n log n). */
tm_status tm_wall_sectors_find(tm_wall_sectors *sectors, const tm_surface *surface,
                               tm_error *error);
/* Whether octants that only know where their centres are may not do at some curve: it is
 * sharp, or they cannot follow it. Errors and cost as above. */
tm_status tm_walls_are_sharp(const tm_surface *surface, bool *sharp, tm_error *error);

void tm_wall_sectors_free(tm_wall_sectors *sectors);

/* How far a direction is beside a sector of `count`: the angle between them, times the
 * part of the direction that is across the segment. 0 within it. */
double tm_sector_beside(const tm_sector_frame *frame, unsigned count, unsigned sector,
                        const double direction[3]);

#endif
