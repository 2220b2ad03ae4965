/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_groups.h"

#include "../../../lib/base/array.h"

#include <stdlib.h>
#include <string.h>

/* Sets ----------------------------------------------------------------------------- */

static int compare(const void *a, const void *b)
{
    const int p = *(const int *)a, q = *(const int *)b;
    return (p > q) - (p < q);
}

/* Adds a set, whose list becomes the sets' own, or finds it; one of no group is that of
 * its entity, which is new unless it has parts. */
static tm_status add_set(gmsh_sets *sets, gmsh_set set, bool is_new, uint32_t *which,
                         tm_error *error)
{
    for (size_t s = 0; !is_new && s < sets->sets; s++) {
        const gmsh_set *known = &sets->set[s];
        if (known->dimension != set.dimension || known->groups != set.groups ||
            (set.groups == 0 && known->entity != set.entity) ||
            (set.groups > 0 &&
             memcmp(known->group, set.group, set.groups * sizeof *set.group) != 0))
            continue;
        free(set.group);
        *which = (uint32_t)s;
        return TM_OK;
    }
    gmsh_set *moved = tm_grow(sets->set, &sets->room, sets->sets + 1, sizeof *moved);
    if (!moved) {
        free(set.group);
        return tm_fail_memory(error);
    }
    sets->set = moved;
    *which = (uint32_t)sets->sets;
    moved[sets->sets++] = set;
    return TM_OK;
}

/* The set of groups, as Gmsh gives them: in any order, negative where they are turned. */
static tm_status add_groups(gmsh_sets *sets, gmsh_set set, const int *first,
                            size_t firsts, const int *second, size_t seconds,
                            uint32_t *which, tm_error *error)
{
    set.group = tm_new(firsts + seconds, sizeof *set.group);
    if (!set.group)
        return tm_fail_memory(error);
    size_t count = 0;
    for (size_t i = 0; i < firsts + seconds; i++) {
        const int group = i < firsts ? first[i] : second[i - firsts];
        if (group != 0)
            set.group[count++] = group < 0 ? -group : group;
    }
    qsort(set.group, count, sizeof *set.group, compare);
    for (size_t i = 0; i < count; i++)
        if (set.groups == 0 || set.group[set.groups - 1] != set.group[i])
            set.group[set.groups++] = set.group[i];
    const bool is_new = set.groups == 0 && !set.is_part;
    return add_set(sets, set, is_new, which, error);
}

/* An entity without groups; of a part of one that is the whole. */
static gmsh_set set_of(const gmsh_entity *entity)
{
    return (gmsh_set){.dimension = entity->dimension,
                      .entity = gmsh_entity_whole(entity),
                      .is_part = gmsh_entity_is_part(entity)};
}

tm_status gmsh_sets_of_entities(gmsh_sets *sets, const gmsh_model *model,
                                const gmsh_model *swapped, tm_error *error)
{
    *sets = (gmsh_sets){.model = model, .swapped = swapped};
    sets->of_entity = tm_new(model->entities, sizeof *sets->of_entity);
    tm_status status = sets->of_entity ? TM_OK : tm_fail_memory(error);
    for (size_t i = 0; i < model->entities && status == TM_OK; i++) {
        const gmsh_entity *entity = &model->entity[i];
        status = add_groups(sets, set_of(entity), entity->group, entity->groups, NULL, 0,
                            &sets->of_entity[i], error);
    }
    return status;
}

void gmsh_sets_free(gmsh_sets *sets)
{
    for (size_t s = 0; s < sets->sets; s++)
        free(sets->set[s].group);
    free(sets->set);
    free(sets->of_entity);
    *sets = (gmsh_sets){0};
}

tm_status gmsh_sets_join(gmsh_sets *sets, uint32_t a, uint32_t b, uint32_t *both,
                         tm_error *error)
{
    const gmsh_set *p = &sets->set[a], *q = &sets->set[b];
    if (a == b || q->groups == 0 || p->groups == 0) {
        *both = p->groups == 0 ? b : a;
        return TM_OK;
    }
    return add_groups(sets, (gmsh_set){.dimension = p->dimension}, p->group, p->groups,
                      q->group, q->groups, both, error);
}

tm_status gmsh_sets_single(gmsh_sets *sets, int dimension, int group, uint32_t *set,
                           tm_error *error)
{
    return add_groups(sets, (gmsh_set){.dimension = dimension}, &group, 1, NULL, 0, set,
                      error);
}

tm_status gmsh_sets_ungrouped(gmsh_sets *sets, const gmsh_entity *entity, uint32_t *set,
                              tm_error *error)
{
    return add_set(sets, set_of(entity), false, set, error);
}

/* Values --------------------------------------------------------------------------- */

static bool is_used(const gmsh_set *set, int dimension)
{
    return set->is_used && set->dimension == dimension;
}

/* Whether a group of that number is in some set that is used. */
static bool is_group(const gmsh_sets *sets, int dimension, int number)
{
    for (size_t s = 0; s < sets->sets; s++)
        for (size_t i = 0; is_used(&sets->set[s], dimension) && i < sets->set[s].groups;
             i++)
            if (sets->set[s].group[i] == number)
                return true;
    return false;
}

/* A number that is above those of all groups and entities of the dimension. */
static int32_t first_free(const gmsh_sets *sets, int dimension)
{
    int32_t above = 1;
    for (size_t s = 0; s < sets->sets; s++) {
        const gmsh_set *set = &sets->set[s];
        if (!is_used(set, dimension))
            continue;
        const int most = set->groups > 0 ? set->group[set->groups - 1] : set->entity;
        if (most >= above && most < INT32_MAX)
            above = most + 1;
    }
    return above;
}

static void give_values(gmsh_sets *sets, int dimension)
{
    int32_t next = first_free(sets, dimension);
    bool any = false; /* group; where there is none nobody need look for it */
    for (size_t s = 0; s < sets->sets; s++)
        any |= is_used(&sets->set[s], dimension) && sets->set[s].groups > 0;
    for (size_t s = 0; s < sets->sets; s++) {
        gmsh_set *set = &sets->set[s];
        if (!is_used(set, dimension))
            continue;
        const bool is_taken =
            any && set->groups == 0 && is_group(sets, dimension, set->entity);
        sets->renumbered += is_taken;
        if (set->groups > 1 || is_taken)
            set->value = next++;
        else
            set->value = set->groups == 1 ? set->group[0] : set->entity;
    }
}

/* Names ---------------------------------------------------------------------------- */

static const gmsh_name *find_name(const gmsh_name *list, size_t count, int dimension,
                                  int tag)
{
    for (size_t i = 0; i < count; i++)
        if (list[i].dimension == dimension && list[i].tag == tag)
            return &list[i];
    return NULL;
}

/* Adds a name, or nothing where nothing is left of it; one that is there already gets the
 * value behind it. */
static tm_status add_name(tm_block *group, int dimension, int32_t value,
                          const char *bytes, size_t size, tm_error *error)
{
    tm_text name = {0};
    tm_group_clean(&name, bytes, size);
    tm_status status = TM_OK;
    if (name.size > 0 &&
        tm_group_named(group, (tm_group_dimension)dimension, name.byte, name.size))
        tm_text_format(&name, " (%d)", (int)value);
    if (name.failed)
        status = tm_fail_memory(error);
    else if (name.size > 0)
        status =
            tm_group_add(group, (tm_group_dimension)dimension, value, name.byte, error);
    tm_text_free(&name);
    return status;
}

/* "steel + 7": the name of each group, of one that has none its number. */
static tm_status add_joined(const gmsh_set *set, tm_block *group, tm_error *error)
{
    tm_text name = {0};
    for (size_t i = 0; i < set->groups; i++) {
        const char *known =
            tm_group_find(group, (tm_group_dimension)set->dimension, set->group[i]);
        if (i > 0)
            tm_text_string(&name, TM_GROUP_AND);
        if (known)
            tm_text_string(&name, known);
        else
            tm_text_integer(&name, set->group[i]);
    }
    const tm_status status = name.failed ? tm_fail_memory(error)
                                         : add_name(group, set->dimension, set->value,
                                                    name.byte, name.size, error);
    tm_text_free(&name);
    return status;
}

tm_status gmsh_sets_name(gmsh_sets *sets, tm_block *group, tm_error *error)
{
    const gmsh_model *model = sets->model;
    tm_status status = TM_OK;
    for (int d = 0; d < GMSH_DIMENSIONS; d++)
        give_values(sets, d);
    for (size_t i = 0; i < model->groups && status == TM_OK; i++) {
        const gmsh_name *name = &model->group[i];
        if (is_group(sets, name->dimension, name->tag))
            status = add_name(group, name->dimension, name->tag, name->name, name->size,
                              error);
    }
    for (size_t s = 0; s < sets->sets && status == TM_OK; s++) {
        const gmsh_set *set = &sets->set[s];
        const gmsh_name *name = set->groups == 0 ? find_name(model->name, model->names,
                                                             set->dimension, set->entity)
                                                 : NULL;
        if (set->is_used && name)
            status = add_name(group, set->dimension, set->value, name->name, name->size,
                              error);
        else if (set->is_used && set->groups > 1)
            status = add_joined(set, group, error);
    }
    return status;
}
