/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "fetch.h"

#include "../../base/array.h"
#include "../../stream/ranks/slices.h"

#include <stdlib.h>

tm_status tm_ranks_fetch(const tm_rows *rows, const void *mine, size_t size,
                         const tm_number_set *wanted, void **got, tm_error *error)
{
    uint32_t *number = tm_new(wanted->count, sizeof *number);
    *got = tm_new(wanted->count, size);
    tm_status status = tm_ranks_any(!number || !*got) ? tm_fail_memory(error) : TM_OK;
    if (status == TM_OK) {
        tm_number_set_list(wanted, number);
        status =
            tm_slices_fetch(mine, rows->total, size, number, wanted->count, *got, error);
    }
    free(number);
    if (status != TM_OK) {
        free(*got);
        *got = NULL;
    }
    return status;
}
