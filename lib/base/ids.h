/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many things can be numbered. */
#ifndef TM_BASE_IDS_H
#define TM_BASE_IDS_H

#include <stddef.h>
#include <stdint.h>

/* Ids are below it: nodes, elements, faces, … of 32 bits, of which the last number is
 * none (TM_NONE). Where there would be as many, or one of the limits below, the result is
 * an error that says so. tests/limits.sh builds with a lower one. */
#ifndef TM_IDS
#define TM_IDS UINT32_MAX
#endif

/* Of ids that are told apart by their highest bit, and of 3 or 8 numbers for each thing.
 */
#define TM_IDS_HALF   ((size_t)TM_IDS / 2 + 1)
#define TM_IDS_THIRD  ((size_t)TM_IDS / 3)
#define TM_IDS_EIGHTH ((size_t)TM_IDS / 8 + 1)

#endif
