/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a search for the line of a curve has reached, the cheapest first. */
#ifndef TM_INTERIOR_LINE_STATES_H
#define TM_INTERIOR_LINE_STATES_H

#include "line_patterns.h"

#include <stddef.h>

/* A node, and sectors for the octants around it. */
typedef struct tm_line_state {
    uint32_t node;
    tm_line_code code;
    uint8_t to;
    bool done;
    uint32_t from; /* the state before, or TM_NONE */
    double cost;
} tm_line_state;

/* A state that is to be looked at; `cost` is with what the line costs from there on. */
typedef struct tm_line_entry {
    double cost;
    uint32_t state;
} tm_line_entry;

typedef struct tm_line_states {
    size_t count, room;
    tm_line_state *state;
    size_t entries, entry_room;
    tm_line_entry *heap;
    size_t rows, slot_room;
    uint32_t *slot; /* [rows][ends]: a state, or TM_NONE */
} tm_line_states;

/* Forgets all; memory is kept. */
void tm_line_states_clear(tm_line_states *states);
void tm_line_states_free(tm_line_states *states);

/* Enters a state with that end of so many (line_patterns.h) if none as cheap is there
 * with it, at the node with that row; `left` is what the line may cost from there on.
 * *row is TM_NONE at first, and then the node's. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_line_states_reach(tm_line_states *states, uint32_t ends, uint32_t end,
                               uint32_t *row, const tm_line_state *made, double left,
                               tm_error *error);

/* The state to look at next, which then is done; TM_NONE: there is none. */
uint32_t tm_line_states_next(tm_line_states *states);

#endif
