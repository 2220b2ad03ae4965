/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ids of octants in .oct and .ref files. */
#include "oct.h"

#include "../base/array.h"

#include <math.h>
#include <stdlib.h>

typedef struct octant_id {
    uint32_t id;
    uint32_t row; /* of .octant, from 0 */
} octant_id;

static int compare(const void *a, const void *b)
{
    const octant_id *p = a, *q = b;
    if (p->id != q->id)
        return p->id < q->id ? -1 : 1;
    return (p->row > q->row) - (p->row < q->row);
}

static tm_status take(octant_id *to, const tm_block *octant, unsigned base,
                      tm_error *error)
{
    const size_t k = octant->attributes;
    for (size_t o = 0; o < octant->count; o++) {
        const double id = k > 0 ? octant->attribute[o * k] : (double)o;
        if (!(id >= 0 && id < UINT32_MAX && id == floor(id)))
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".octant",
                              "row %zu: %g is no id of an octant (a whole number, "
                              "0..%u)",
                              o + base, id, UINT32_MAX - 1);
        to[o] = (octant_id){(uint32_t)id, (uint32_t)o};
    }
    return TM_OK;
}

static tm_status check_once(const octant_id *sorted, size_t count, unsigned base,
                            tm_error *error)
{
    for (size_t i = 1; i < count; i++)
        if (sorted[i].id == sorted[i - 1].id)
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".octant",
                              "octants %zu and %zu both have the id %u",
                              sorted[i - 1].row + (size_t)base,
                              sorted[i].row + (size_t)base, sorted[i].id);
    return TM_OK;
}

/* The ids, ascending; malloc'ed, NULL after an error. */
static tm_status sort_ids(octant_id **sorted, const tm_block *octant, unsigned base,
                          tm_error *error)
{
    *sorted = tm_new(octant->count, sizeof **sorted);
    if (!*sorted)
        return tm_fail_memory(error);
    tm_status status = take(*sorted, octant, base, error);
    if (status == TM_OK && octant->count > 0)
        qsort(*sorted, octant->count, sizeof **sorted, compare);
    if (status == TM_OK)
        status = check_once(*sorted, octant->count, base, error);
    if (status != TM_OK) {
        free(*sorted);
        *sorted = NULL;
    }
    return status;
}

tm_status tm_octant_ids(uint32_t **id, const tm_block *octant, unsigned base,
                        tm_error *error)
{
    octant_id *sorted;
    *id = NULL;
    const tm_status status = sort_ids(&sorted, octant, base, error);
    if (status != TM_OK)
        return status;
    *id = tm_new(octant->count, sizeof **id);
    for (size_t i = 0; *id && i < octant->count; i++)
        (*id)[sorted[i].row] = sorted[i].id;
    free(sorted);
    return *id ? TM_OK : tm_fail_memory(error);
}

tm_status tm_octants_of_ids(uint32_t *list, size_t *count, const tm_block *octant,
                            unsigned base, tm_error *error)
{
    octant_id *sorted;
    size_t kept = 0, o = 0;
    tm_status status = sort_ids(&sorted, octant, base, error);
    if (status == TM_OK && *count > 0)
        qsort(list, *count, sizeof *list, tm_compare_numbers);
    for (size_t i = 0; i < *count && status == TM_OK; i++) {
        const uint32_t id = list[i];
        while (o < octant->count && sorted[o].id < id)
            o++;
        if (o == octant->count || sorted[o].id != id)
            status = tm_fail(error, TM_ERROR_INPUT,
                             "octant %u is not in the mesh (no octant has that id)", id);
        else if (kept == 0 || list[kept - 1] != sorted[o].row)
            list[kept++] = sorted[o].row;
    }
    if (status == TM_OK && kept > 0)
        qsort(list, kept, sizeof *list, tm_compare_numbers);
    *count = kept;
    free(sorted);
    return status;
}
