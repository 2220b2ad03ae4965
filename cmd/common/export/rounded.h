/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formats that have few digits of a coordinate. */
#ifndef CMD_COMMON_ROUNDED_H
#define CMD_COMMON_ROUNDED_H

#include "../../../lib/stream/stream.h"
#include "../app/filter.h"

/* Instead of digits: 32-bit floats. */
enum { ROUNDED_TO_FLOATS = 0 };

/* A note where elements, or facets of polyhedra, have two corners that differ, but are
 * one in so many significant digits. O(stream). */
void rounded_note(const filter *f, const tm_stream *stream, int digits);

#endif
