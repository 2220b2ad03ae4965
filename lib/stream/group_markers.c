/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows of .group by name and by value. */
#include "group_markers.h"

#include "group_names.h"

#include <string.h>

/* The slot of a name in a dimension, or the free one where it belongs. */
static uint32_t *slot_of(const tm_hash_table *table, const tm_block *group,
                         tm_group_dimension dimension, const char *name)
{
    uint32_t *slot = tm_hash_slot(table, tm_hash(tm_hash_string(name), dimension));
    while (*slot != TM_HASH_FREE && (tm_group_dimension_of(group, *slot) != dimension ||
                                     strcmp(tm_group_name(group, *slot), name) != 0))
        slot = tm_hash_next(table, slot);
    return slot;
}

static uint32_t *slot_of_value(const tm_hash_table *table, const tm_block *group,
                               size_t g)
{
    const tm_group_dimension dimension = tm_group_dimension_of(group, g);
    const int32_t value = group->marker[g];
    uint32_t *slot = tm_hash_slot(table, tm_hash(tm_hash(0, (uint32_t)value), dimension));
    while (*slot != TM_HASH_FREE && (tm_group_dimension_of(group, *slot) != dimension ||
                                     group->marker[*slot] != value))
        slot = tm_hash_next(table, slot);
    return slot;
}

tm_status tm_group_check(const tm_block *group, unsigned base, const char *file,
                         tm_error *error)
{
    tm_hash_table names = {0}, values = {0};
    tm_status status = TM_OK;
    if (!tm_hash_make(&names, group->count) || !tm_hash_make(&values, group->count))
        status = tm_fail_memory(error);
    for (size_t g = 0; g < group->count && status == TM_OK; g++) {
        const tm_group_dimension dimension = tm_group_dimension_of(group, g);
        uint32_t *name = slot_of(&names, group, dimension, tm_group_name(group, g));
        uint32_t *value = slot_of_value(&values, group, g);
        const uint32_t other = *name != TM_HASH_FREE ? *name : *value;
        if (other != TM_HASH_FREE)
            status = tm_fail_at(error, TM_ERROR_INPUT, file, 0, group->name,
                                "rows %zu and %zu have the same %s (each may be there "
                                "once in a dimension)",
                                (size_t)other + base, g + base,
                                *name != TM_HASH_FREE ? "name" : "value");
        *name = *value = (uint32_t)g;
    }
    tm_hash_free(&names);
    tm_hash_free(&values);
    return status;
}

static bool reserve_names(tm_group_markers *m)
{
    enum { FIRST = 16 };
    const tm_block *group = m->group;
    if (group->count < m->room)
        return true;
    const size_t room = m->room ? 2 * m->room : FIRST + 2 * group->count;
    tm_hash_free(&m->table);
    m->room = 0;
    if (!tm_hash_make(&m->table, room))
        return false;
    m->room = room;
    for (size_t g = 0; g < group->count; g++)
        *slot_of(&m->table, group, tm_group_dimension_of(group, g),
                 tm_group_name(group, g)) = (uint32_t)g;
    return true;
}

/* The marker of a clean name. */
static tm_status find_or_add(tm_group_markers *m, const char *name, int32_t *marker,
                             tm_error *error)
{
    if (!reserve_names(m))
        return tm_fail_memory(error);
    uint32_t *slot = slot_of(&m->table, m->group, m->dimension, name);
    if (*slot != TM_HASH_FREE) {
        *marker = m->group->marker[*slot];
        return TM_OK;
    }
    const tm_status status =
        tm_group_add(m->group, m->dimension, m->values + 1, name, error);
    if (status == TM_OK) {
        *slot = (uint32_t)(m->group->count - 1);
        *marker = ++m->values;
    }
    return status;
}

tm_status tm_group_marker(tm_group_markers *m, const char *bytes, size_t size,
                          int32_t *marker, tm_error *error)
{
    tm_text name = {0};
    tm_status status = TM_OK;
    tm_group_clean(&name, bytes, size);
    if (name.failed)
        status = tm_fail_memory(error);
    else if (m->values == INT32_MAX)
        status = tm_fail(error, TM_ERROR_INPUT, "more than %d groups", INT32_MAX);
    else if (name.size == 0)
        *marker = ++m->values;
    else
        status = find_or_add(m, name.byte, marker, error);
    tm_text_free(&name);
    return status;
}

void tm_group_markers_free(tm_group_markers *m)
{
    tm_hash_free(&m->table);
    m->room = 0;
}
