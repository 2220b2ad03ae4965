/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells that are given: by an attribute of the tetrahedra, as METIS or another program
 * that cuts graphs makes it. */
#ifndef TM_POLY_GIVEN_H
#define TM_POLY_GIVEN_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../stream/stream.h"

TM_EXTERN_C_BEGIN

/* Takes an attribute out of a block: `which`, from 0. label[count] are 0 …: the order of
 * its values, equal where they are equal. The caller frees *label, after an error too.
 * TM_ERROR_INPUT where the block has no such attribute. O(count log count). */
tm_status tm_take_given(tm_block *block, size_t which, uint32_t **label, tm_error *error);

TM_EXTERN_C_END

#endif
