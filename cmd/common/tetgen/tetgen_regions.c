/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_regions.h"

#include "../../../lib/base/array.h"
#include "../../../lib/base/hash.h"

#include <stdlib.h>
#include <string.h>

static uint64_t hash_row(const double *row, size_t width)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < width; i++) {
        const double value = row[i] + 0.; /* -0 is 0 */
        uint64_t bits;
        memcpy(&bits, &value, sizeof bits);
        hash = tm_hash(hash, bits);
    }
    return hash;
}

static bool is_equal(const double *a, const double *b, size_t width)
{
    for (size_t i = 0; i < width; i++)
        if (a[i] != b[i])
            return false;
    return true;
}

/* Fills region[rows]; returns how many there are. */
static uint32_t number_regions(const tm_block *ele, tm_hash_table *table, uint32_t *first,
                               uint32_t *region)
{
    const size_t width = ele->attributes;
    uint32_t count = 0;
    for (size_t t = 0; t < ele->count; t++) {
        const double *row = ele->attribute + width * t;
        uint32_t *slot = tm_hash_slot(table, hash_row(row, width));
        while (*slot != TM_HASH_FREE &&
               !is_equal(row, ele->attribute + width * first[*slot], width))
            slot = tm_hash_next(table, slot);
        if (*slot == TM_HASH_FREE) {
            first[count] = (uint32_t)t;
            *slot = count++;
        }
        region[t] = *slot;
    }
    return count;
}

void tetgen_hide_regions(const filter *f, tm_stream *tets, tetgen_regions *regions)
{
    tm_block *ele = tm_stream_find(tets, ".ele");
    *regions = (tetgen_regions){NULL};
    if (ele->attributes < 2)
        return;
    tm_hash_table table = {0};
    uint32_t *first = tm_new(ele->count, sizeof *first);
    uint32_t *region = tm_new(ele->count, sizeof *region);
    regions->last = tm_new(ele->count, sizeof *regions->last);
    if (!first || !region || !regions->last || !tm_hash_make(&table, ele->count))
        filter_fail_memory(f);
    const uint32_t count = number_regions(ele, &table, first, region);
    double *last = ele->attribute + ele->attributes - 1;
    for (uint32_t r = 0; r < count; r++)
        regions->last[r] = last[ele->attributes * first[r]];
    for (size_t t = 0; t < ele->count; t++)
        last[ele->attributes * t] = region[t];
    tm_hash_free(&table);
    free(region);
    free(first);
}

void tetgen_restore_regions(tm_stream *mesh, tetgen_regions *regions)
{
    tm_block *ele = tm_stream_find(mesh, ".ele");
    for (size_t t = 0; regions->last && ele && t < ele->count; t++) {
        double *last = ele->attribute + ele->attributes * (t + 1) - 1;
        *last = regions->last[(size_t)*last];
    }
    free(regions->last);
    *regions = (tetgen_regions){NULL};
}
