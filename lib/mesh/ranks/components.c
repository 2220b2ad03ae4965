/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "components.h"

#include "../../base/disjoint_sets.h"
#include "../../base/number_set.h"
#include "fetch.h"
#include "../../ranks/post.h"

#include <stdlib.h>

#define NOTHING UINT32_MAX

/* What the numbers in a list have as parents, put in their place. */
static tm_status look_up(const tm_rows *rows, const uint32_t *parent, uint32_t *list,
                         size_t count, tm_error *error)
{
    tm_number_set set = {0};
    uint32_t *found = NULL;
    const bool made = tm_number_set_of(&set, list, count, NOTHING);
    tm_status status = tm_ranks_enough(made, error);
    if (status == TM_OK)
        status =
            tm_ranks_fetch(rows, parent, sizeof *parent, &set, (void **)&found, error);
    for (size_t i = 0; status == TM_OK && i < count; i++)
        list[i] = found[tm_number_set_below(&set, list[i])];
    tm_number_set_free(&set);
    free(found);
    return status;
}

/* Ways within the slice need nobody else: each goes to a root, or to where the way leaves
 * the slice. */
static void shorten_own(const tm_rows *rows, uint32_t *parent)
{
    for (size_t i = 0; i < rows->count; i++) {
        uint32_t end = parent[i];
        while (tm_rows_have(rows, end) && parent[end - rows->first] != end)
            end = parent[end - rows->first];
        for (uint32_t x = (uint32_t)(rows->first + i), next;
             x != end && tm_rows_have(rows, x); x = next) {
            next = parent[x - rows->first];
            parent[x - rows->first] = end;
        }
    }
}

tm_status tm_ranks_find_roots(const tm_rows *rows, uint32_t *parent, tm_error *error)
{
    tm_status status = TM_OK;
    uint32_t *above = malloc((rows->count + 1) * sizeof *above);
    bool again = true;
    if (tm_ranks_any(!above))
        status = tm_fail_memory(error);
    while (status == TM_OK && again) {
        size_t count = 0;
        shorten_own(rows, parent);
        for (size_t i = 0; i < rows->count; i++)
            if (!tm_rows_have(rows, parent[i]))
                above[count++] = parent[i];
        status = look_up(rows, parent, above, count, error);
        again = false;
        count = 0;
        for (size_t i = 0; status == TM_OK && i < rows->count; i++)
            if (!tm_rows_have(rows, parent[i])) {
                again |= parent[i] != above[count];
                parent[i] = above[count++];
            }
        if (status == TM_OK)
            again = tm_ranks_any(again);
    }
    free(above);
    return status;
}

/* Keeps the pairs of two different things. */
static size_t drop_joined(uint32_t (*pair)[2], size_t pairs)
{
    size_t left = 0;
    for (size_t i = 0; i < pairs; i++)
        if (pair[i][0] != pair[i][1]) {
            pair[left][0] = pair[i][0];
            pair[left++][1] = pair[i][1];
        }
    return left;
}

/* Gives the larger root of each pair the smaller one as its parent, or a smaller one. */
static tm_status hook(const tm_rows *rows, uint32_t (*pair)[2], size_t pairs,
                      uint32_t *parent, tm_error *error)
{
    tm_post post = {0};
    uint32_t *got;
    size_t count;
    for (size_t i = 0; i < pairs; i++) {
        const bool back = pair[i][0] > pair[i][1];
        const uint32_t letter[2] = {pair[i][!back], pair[i][back]};
        tm_post_put(&post, tm_rows_owner(rows, letter[0]), letter, 2);
    }
    const tm_status status = tm_post_deliver(&post, &got, &count, error);
    for (size_t i = 0; status == TM_OK && i < count; i += 2) {
        uint32_t *up = &parent[got[i] - rows->first];
        *up = got[i + 1] < *up ? got[i + 1] : *up;
    }
    free(got);
    return status;
}

/* Joins what is in the slice on both sides. */
static size_t join_own(const tm_rows *rows, uint32_t (*pair)[2], size_t pairs,
                       uint32_t *parent)
{
    const uint32_t first = (uint32_t)rows->first;
    for (size_t i = 0; i < rows->count; i++)
        parent[i] = (uint32_t)i;
    for (size_t i = 0; i < pairs; i++)
        if (tm_rows_have(rows, pair[i][0]) && tm_rows_have(rows, pair[i][1])) {
            tm_set_unite(parent, pair[i][0] - first, pair[i][1] - first);
            pair[i][0] = pair[i][1];
        }
    for (size_t i = 0; i < rows->count; i++)
        parent[i] = tm_set_root(parent, (uint32_t)i);
    for (size_t i = 0; i < rows->count; i++)
        parent[i] += first;
    return drop_joined(pair, pairs);
}

tm_status tm_ranks_unite(const tm_rows *rows, uint32_t (*pair)[2], size_t pairs,
                         uint32_t *parent, tm_error *error)
{
    tm_status status = TM_OK;
    pairs = join_own(rows, pair, pairs, parent);
    while (status == TM_OK && tm_ranks_any(pairs > 0)) {
        status = look_up(rows, parent, pair ? pair[0] : NULL, 2 * pairs, error);
        pairs = status == TM_OK ? drop_joined(pair, pairs) : 0;
        if (status == TM_OK)
            status = hook(rows, pair, pairs, parent, error);
        if (status == TM_OK)
            status = tm_ranks_find_roots(rows, parent, error);
    }
    return status;
}
