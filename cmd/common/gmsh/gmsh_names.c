/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_names.h"

#include "../../../lib/base/array.h"
#include "../../../lib/stream/group.h"

#include <stdlib.h>
#include <string.h>

/* A group, and its name as it is written; NULL where it has none. */
typedef struct named_group {
    int dimension;
    int32_t group, value;
    char *name;
} named_group;

static bool is_msh(gmsh_output format)
{
    return format <= GMSH_MSH2;
}

/* Whether the format has names for groups of a dimension. */
static bool has_names(gmsh_output format, int dimension)
{
    switch (format) {
    case GMSH_MSH1:
    case GMSH_TO_MEDIT:
    case GMSH_TO_BDF:
        return false;
    case GMSH_TO_SU2:
        return dimension == GMSH_FACES;
    default:
        return is_msh(format) || dimension != GMSH_POINTS;
    }
}

/* Programs that read .inp take capitals for small letters. */
static void write_name(char *name, gmsh_output format)
{
    gmsh_change_quotes(name);
    for (char *at = name; *at; at++) {
        if (*at == ' ' && !is_msh(format))
            *at = '_';
        else if (*at >= 'A' && *at <= 'Z' && format == GMSH_TO_INP)
            *at = (char)(*at - 'A' + 'a');
    }
    if (is_msh(format) && strlen(name) > GMSH_NAME_MOST)
        name[GMSH_NAME_MOST] = '\0';
}

/* By number, then by dimension. */
static int compare_groups(const void *a, const void *b)
{
    const named_group *p = a, *q = b;
    if (p->group != q->group)
        return p->group < q->group ? -1 : 1;
    return p->dimension - q->dimension;
}

/* By name, those without one first, then by dimension. */
static int compare_names(const void *a, const void *b)
{
    const named_group *p = a, *q = b;
    const int order = strcmp(p->name ? p->name : "", q->name ? q->name : "");
    return order != 0 ? order : p->dimension - q->dimension;
}

/* The groups of a plan, each once, in the order of compare_groups(); malloc'ed. The name
 * is that of the value that is the group alone, or else of its number. */
static named_group *list_groups(const gmsh_plan *plan, size_t *groups)
{
    size_t count = 0, kept = 0;
    for (int d = 0; d < GMSH_DIMENSIONS; d++)
        for (size_t i = 0; i < plan->values[d]; i++)
            count += plan->value[d][i].groups;
    named_group *list = tm_new(count, sizeof *list);
    count = 0;
    for (int d = 0; list && d < GMSH_DIMENSIONS; d++)
        for (size_t i = 0; i < plan->values[d]; i++) {
            const gmsh_value *is = &plan->value[d][i];
            for (size_t g = 0; g < is->groups; g++)
                list[count++] = (named_group){
                    d, is->group[g], is->groups > 1 ? is->group[g] : is->value, NULL};
        }
    if (count > 0)
        qsort(list, count, sizeof *list, compare_groups);
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || compare_groups(&list[kept - 1], &list[i]) != 0)
            list[kept++] = list[i];
    *groups = kept;
    return list;
}

/* Gives groups the names that are written; false where memory is out. */
static bool name_groups(named_group *list, size_t groups, const gmsh_plan *plan,
                        gmsh_output format, size_t *cut)
{
    for (size_t i = 0; i < groups; i++) {
        const char *name = tm_group_find(
            plan->names, (tm_group_dimension)list[i].dimension, list[i].value);
        if (!name || !has_names(format, list[i].dimension))
            continue;
        list[i].name = strdup(name);
        if (!list[i].name)
            return false;
        *cut += is_msh(format) && strlen(name) > GMSH_NAME_MOST;
        write_name(list[i].name, format);
    }
    return true;
}

/* Of groups in the order of compare_groups(): names where another dimension has the
 * number, too, and the last of these, whose name Gmsh reads, another name or none. */
static size_t count_swapped(const named_group *list, size_t groups)
{
    size_t count = 0;
    for (size_t i = 0; i < groups; i++) {
        size_t last = i;
        while (last + 1 < groups && list[last + 1].group == list[i].group)
            last++;
        count += list[i].name &&
                 (!list[last].name || strcmp(list[i].name, list[last].name) != 0);
    }
    return count;
}

/* Of groups in the order of compare_names(). In .inp a set is its name alone. */
static size_t count_joined(const named_group *list, size_t groups, gmsh_output format)
{
    size_t count = 0;
    for (size_t i = 1; i < groups; i++)
        count += list[i].name && list[i - 1].name &&
                 strcmp(list[i].name, list[i - 1].name) == 0 &&
                 (list[i].dimension == list[i - 1].dimension || format == GMSH_TO_INP);
    return count;
}

tm_status gmsh_find_lost_names(gmsh_lost_names *lost, const gmsh_plan *plan,
                               gmsh_output format, tm_error *error)
{
    size_t groups = 0;
    named_group *list = list_groups(plan, &groups);
    *lost = (gmsh_lost_names){0};
    const bool done = list && name_groups(list, groups, plan, format, &lost->cut);
    if (done && format == GMSH_TO_UNV)
        lost->swapped = count_swapped(list, groups);
    if (done && groups > 0) {
        qsort(list, groups, sizeof *list, compare_names);
        lost->joined = count_joined(list, groups, format);
    }
    for (size_t i = 0; i < groups; i++)
        free(list[i].name);
    free(list);
    return done ? TM_OK : tm_fail_memory(error);
}
