/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "marks.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_tet_marks_free(tm_tet_marks *marks)
{
    free(marks->stamp);
    *marks = (tm_tet_marks){0};
}

bool tm_tet_marks_clear(tm_tet_marks *marks, size_t count)
{
    if (count > marks->room) {
        size_t room = marks->room;
        uint32_t *stamp = tm_grow(marks->stamp, &room, count, sizeof *stamp);
        if (!stamp)
            return false;
        memset(stamp + marks->room, 0, (room - marks->room) * sizeof *stamp);
        marks->stamp = stamp;
        marks->room = room;
    }
    if (++marks->now == 0) {
        memset(marks->stamp, 0, marks->room * sizeof *marks->stamp);
        marks->now = 1;
    }
    return true;
}
