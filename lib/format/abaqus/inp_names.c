/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_names.h"

#include "../../base/array.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* What a value needs behind a name. */
enum { VALUE_ROOM = 16 };

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static bool is_of_name(char c)
{
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/* Names that say something else where they are read: all, or an entity of Gmsh. */
static bool is_reserved(const char *name)
{
    static const char *const begin[] = {"Volume",  "Surface", "Line",  "Point",
                                        "Region_", "Face_",   "Node_", "Internal",
                                        "Nall",    "Eall"};
    for (size_t i = 0; i < sizeof begin / sizeof *begin; i++)
        if (strncasecmp(name, begin[i], strlen(begin[i])) == 0)
            return true;
    return false;
}

static void append_value(tm_inp_name *to)
{
    const size_t most = TM_INP_NAME - VALUE_ROOM;
    const size_t size = strlen(to->name) < most ? strlen(to->name) : most;
    snprintf(to->name + size, VALUE_ROOM, "_%d", (int)to->value);
    to->has_value = true;
}

static void make_name(tm_inp_name *to, tm_group_dimension dimension, const char *name)
{
    static const char *const kind[] = {"Node", "Edge", "Face", "Region"};
    size_t k = 0;
    bool changed = !name || is_reserved(name);
    if (!name || !is_letter(*name))
        k = (size_t)snprintf(to->name, TM_INP_NAME, "%s", kind[dimension]);
    changed |= k > 0;
    for (; name && *name && k + 1 < TM_INP_NAME; name++) {
        changed |= !is_of_name(*name);
        to->name[k++] = is_of_name(*name) ? *name : '_';
    }
    to->name[k] = '\0';
    if (changed || (name && *name))
        append_value(to);
}

tm_status tm_inp_names_add(tm_inp_names *names, tm_group_dimension dimension,
                           int32_t value, const char *name, tm_error *error)
{
    tm_inp_name *moved =
        tm_grow(names->list, &names->room, names->count + 1, sizeof *moved);
    if (!moved)
        return tm_fail_memory(error);
    names->list = moved;
    moved[names->count] = (tm_inp_name){.value = value};
    make_name(&moved[names->count++], dimension, name);
    return TM_OK;
}

static int compare_values(const tm_inp_name *p, const tm_inp_name *q)
{
    return (p->value > q->value) - (p->value < q->value);
}

static int by_name(const void *a, const void *b)
{
    const tm_inp_name *p = a, *q = b;
    const int order = strcasecmp(p->name, q->name);
    if (order == 0 && p->has_value != q->has_value)
        return p->has_value ? -1 : 1;
    return order != 0 ? order : compare_values(p, q);
}

static int by_value(const void *a, const void *b)
{
    return compare_values(a, b);
}

/* Appends their values to names that others have; false where there are none. Those with
 * a value differ from each other. */
static bool part_names(tm_inp_name *list, size_t count)
{
    bool parted = false;
    qsort(list, count, sizeof *list, by_name);
    /* the last of each first, while the one before still has its old name */
    for (size_t i = count; i-- > 1;)
        if (strcasecmp(list[i].name, list[i - 1].name) == 0) {
            append_value(&list[i]);
            parted = true;
        }
    return parted;
}

void tm_inp_names_end(tm_inp_names *names)
{
    if (names->count == 0)
        return;
    while (part_names(names->list, names->count))
        ;
    qsort(names->list, names->count, sizeof *names->list, by_value);
}

const char *tm_inp_name_of(const tm_inp_names *names, int32_t value)
{
    size_t lo = 0, hi = names->count;
    while (lo + 1 < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (names->list[middle].value <= value)
            lo = middle;
        else
            hi = middle;
    }
    return names->list[lo].name;
}

void tm_inp_names_free(tm_inp_names *names)
{
    free(names->list);
}
