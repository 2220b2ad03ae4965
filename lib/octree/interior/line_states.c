/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "line_states.h"

#include "../../base/array.h"
#include "../../stream/stream.h"

#include <stdlib.h>

static bool before(tm_line_entry a, tm_line_entry b)
{
    return a.cost < b.cost || (a.cost == b.cost && a.state < b.state);
}

static tm_status push(tm_line_states *s, tm_line_entry e, tm_error *error)
{
    void *more = tm_grow(s->heap, &s->entry_room, s->entries + 1, sizeof *s->heap);
    if (!more)
        return tm_fail_memory(error);
    s->heap = more;
    size_t i = s->entries++;
    for (; i > 0 && before(e, s->heap[(i - 1) / 2]); i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = e;
    return TM_OK;
}

/* The state of the least entry, which is taken out. */
static uint32_t pop(tm_line_states *s)
{
    const uint32_t state = s->heap[0].state;
    const tm_line_entry last = s->heap[--s->entries];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < s->entries; i = child) {
        if (child + 1 < s->entries && before(s->heap[child + 1], s->heap[child]))
            child++;
        if (!before(s->heap[child], last))
            break;
        s->heap[i] = s->heap[child];
    }
    s->heap[i] = last;
    return state;
}

static tm_status add_row(tm_line_states *s, uint32_t ends, uint32_t *row, tm_error *error)
{
    void *more = tm_grow(s->slot, &s->slot_room, (s->rows + 1) * ends, sizeof *s->slot);
    if (!more)
        return tm_fail_memory(error);
    s->slot = more;
    *row = (uint32_t)s->rows++;
    for (size_t i = *row * (size_t)ends; i < s->rows * ends; i++)
        s->slot[i] = TM_NONE;
    return TM_OK;
}

void tm_line_states_clear(tm_line_states *states)
{
    states->count = states->entries = states->rows = 0;
}

void tm_line_states_free(tm_line_states *states)
{
    free(states->state);
    free(states->heap);
    free(states->slot);
    *states = (tm_line_states){0};
}

tm_status tm_line_states_reach(tm_line_states *s, uint32_t ends, uint32_t end,
                               uint32_t *row, const tm_line_state *made, double left,
                               tm_error *error)
{
    if (*row == TM_NONE && add_row(s, ends, row, error) != TM_OK)
        return TM_ERROR_SYSTEM;
    uint32_t *slot = &s->slot[*row * (size_t)ends + end];
    if (*slot != TM_NONE && s->state[*slot].cost <= made->cost)
        return TM_OK;
    if (*slot == TM_NONE) {
        void *more = tm_grow(s->state, &s->room, s->count + 1, sizeof *s->state);
        if (!more)
            return tm_fail_memory(error);
        s->state = more;
        *slot = (uint32_t)s->count++;
    }
    s->state[*slot] = *made;
    return push(s, (tm_line_entry){made->cost + left, *slot}, error);
}

uint32_t tm_line_states_next(tm_line_states *states)
{
    while (states->entries > 0) {
        const uint32_t next = pop(states);
        if (states->state[next].done)
            continue;
        states->state[next].done = true;
        return next;
    }
    return TM_NONE;
}
