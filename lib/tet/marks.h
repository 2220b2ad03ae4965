/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marks on tetrahedra, or on nodes, or on faces, that are all taken away at once. */
#ifndef TM_TET_MARKS_H
#define TM_TET_MARKS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct tm_tet_marks {
    uint32_t *stamp; /* [room]; marked: == now */
    size_t room;
    uint32_t now;
} tm_tet_marks;

void tm_tet_marks_free(tm_tet_marks *marks);

/* Takes all marks away; room for so many. False where memory is out. */
bool tm_tet_marks_clear(tm_tet_marks *marks, size_t count);

/* Marks t; whether it was not marked before. */
static inline bool tm_tet_mark(tm_tet_marks *marks, uint32_t t)
{
    bool fresh = marks->stamp[t] != marks->now;
    marks->stamp[t] = marks->now;
    return fresh;
}

static inline bool tm_tet_is_marked(const tm_tet_marks *marks, uint32_t t)
{
    return marks->stamp[t] == marks->now;
}

#endif
