/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "examination.h"

#include <string.h>

static bool comes_before(const uint32_t *place, const uint32_t *other)
{
    size_t i = 0;
    while (i + 1 < TM_DEFECT_NUMBERS && place[i] == other[i])
        i++;
    return place[i] < other[i];
}

static size_t places(const tm_defect_list *list)
{
    return list->count < TM_DEFECTS_LISTED ? list->count : TM_DEFECTS_LISTED;
}

/* Puts a place where its numbers belong; the last one makes room. */
static void remember(tm_defect_list *list, const uint32_t *place)
{
    size_t i = places(list);
    if (i == TM_DEFECTS_LISTED && !comes_before(place, list->place[--i]))
        return;
    for (; i > 0 && comes_before(place, list->place[i - 1]); i--)
        memcpy(list->place[i], list->place[i - 1], sizeof list->place[i]);
    memcpy(list->place[i], place, sizeof list->place[i]);
}

void tm_defect_add(tm_defect_list *list, const uint32_t place[TM_DEFECT_NUMBERS])
{
    remember(list, place);
    list->count++;
}

void tm_defect_add_list(tm_defect_list *list, const tm_defect_list *more)
{
    for (size_t i = 0; i < places(more); i++)
        tm_defect_add(list, more->place[i]);
    list->count += more->count - places(more);
}

bool tm_examination_is_good(const tm_examination *found)
{
    for (size_t d = 0; d < TM_DEFECTS; d++)
        if (found->defect[d].count > 0)
            return false;
    return true;
}
