/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../coordinates.h"

#include "../../ranks/ranks.h"
#include "slices.h"

tm_status tm_slices_check_coordinates(const tm_slices *slices, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t b = 0; b < slices->stream.blocks && status == TM_OK; b++) {
        const tm_block *block = &slices->stream.block[b];
        double largest = 0;
        status = tm_ranks_agree(
            tm_block_check_coordinates(
                block, slices->stream.base + slices->slice[b].before, &largest, error),
            error);
        tm_ranks_largest(&largest, 1);
        if (status == TM_OK)
            status = tm_coordinates_check_largest(largest, block->name, error);
    }
    return status;
}
