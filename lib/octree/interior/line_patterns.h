/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ways in which octants of three or four sectors can lie around a node through which
 * a line goes where all of them meet. */
#ifndef TM_INTERIOR_LINE_PATTERNS_H
#define TM_INTERIOR_LINE_PATTERNS_H

#include "../../base/error.h"

#include <stdbool.h>
#include <stdint.h>

/* The sectors of octants 0 … 7 around a node, two bits each. */
typedef uint16_t tm_line_code;

/* Direction 2 a is down axis a, 2 a + 1 up: the octants on that side of a node, in the
 * order in which they turn counter-clockwise, seen against the direction. */
extern const uint8_t tm_side_octants[6][4];

static inline unsigned tm_code_at(tm_line_code code, unsigned octant)
{
    return (unsigned)code >> 2 * octant & 3u;
}

/* A node that a line comes to from one direction and leaves in another. */
typedef struct tm_line_pattern {
    tm_line_code code;
    uint8_t from, to;
    uint16_t end; /* the number of its direction and octants there: how a line can go on
                     depends on nothing else */
} tm_line_pattern;

enum { TM_SIDE_CODES = 256 };

/* Those of a number of sectors, in order of the direction from which the line comes, and
 * of the octants on that side: start[TM_SIDE_CODES * from + tm_side_code()] … */
typedef struct tm_line_patterns {
    uint32_t count, ends;
    tm_line_pattern *pattern;
    uint32_t start[6 * TM_SIDE_CODES + 1];
} tm_line_patterns;

/* All in which octants of each sector are a good mask (octant_mask.h), all sectors meet
 * along two of the six edges from the node, in their order around the line, and sectors
 * that are not neighbours have no face in common, nor an edge with a third one.
 * TM_ERROR_SYSTEM where memory is out; to be freed, after an error too. */
tm_status tm_line_patterns_make(tm_line_patterns *patterns, unsigned sectors,
                                tm_error *error);
void tm_line_patterns_free(tm_line_patterns *patterns);

/* The sectors of the octants on a side, as a number: in the order of tm_side_octants. */
static inline unsigned tm_side_code(tm_line_code code, unsigned side)
{
    unsigned all = 0;
    for (unsigned i = 0; i < 4; i++)
        all |= tm_code_at(code, tm_side_octants[side][i]) << 2 * i;
    return all;
}

/* Whether labels turn as 0 … count - 1 do, each in one piece: those around an edge. */
bool tm_sectors_turn(const unsigned label[4], unsigned count);

#endif
