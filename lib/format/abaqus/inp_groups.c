/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_groups.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* Classes --------------------------------------------------------------------------- */

static tm_status add_class(tm_inp_classes *classes, uint32_t parent, uint32_t group,
                           tm_error *error)
{
    tm_inp_class *moved =
        tm_grow(classes->class, &classes->room, classes->classes + 1, sizeof *moved);
    if (!moved)
        return tm_fail_memory(error);
    classes->class = moved;
    moved[classes->classes++] =
        (tm_inp_class){.parent = parent, .group = group, .child_of = TM_INP_NONE};
    return TM_OK;
}

tm_status tm_inp_classes_new(tm_inp_classes *classes, size_t items, tm_error *error)
{
    *classes = (tm_inp_classes){.items = items};
    classes->of = calloc(items + 1, sizeof *classes->of);
    if (!classes->of)
        return tm_fail_memory(error);
    return add_class(classes, 0, TM_INP_NONE, error);
}

void tm_inp_classes_free(tm_inp_classes *classes)
{
    free(classes->of);
    free(classes->class);
}

tm_status tm_inp_classes_put(tm_inp_classes *classes, uint32_t item, uint32_t group,
                             bool only_free, tm_error *error)
{
    const uint32_t old = classes->of[item];
    if (classes->class[old].group == group || (only_free && old != 0))
        return TM_OK;
    if (classes->class[old].child_of != group) {
        const uint32_t child = (uint32_t)classes->classes;
        const tm_status status = add_class(classes, old, group, error);
        if (status != TM_OK)
            return status;
        classes->class[old].child = child;
        classes->class[old].child_of = group;
    }
    classes->of[item] = classes->class[old].child;
    return TM_OK;
}

/* Groups ---------------------------------------------------------------------------- */

bool tm_inp_says_nothing(const tm_inp_set *set)
{
    return tm_word_is_like(set->name, "Nall") || tm_word_is_like(set->name, "Eall");
}

/* Gmsh and Abaqus/CAE give the nodes of a set of elements the same name: they say nothing
 * that the elements do not. */
static bool counts(const tm_inp_model *model, const tm_inp_set *set)
{
    if (set->dimension >= 0 || set->is_of_section || set->kind == TM_INP_FACES)
        return true;
    if (set->kind == TM_INP_NODES &&
        tm_inp_find_set(model, TM_INP_ELEMENTS, set->scope, set->name))
        return false;
    return !set->is_internal && !tm_inp_says_nothing(set) && !set->is_of_surface;
}

/* The group of a set in an instance, or TM_INP_NONE. They are in the order of sets. */
static uint32_t group_of(const tm_inp_groups *groups, size_t set, size_t instance)
{
    size_t lo = 0, hi = groups->groups;
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (groups->group[middle].set < set)
            lo = middle + 1;
        else
            hi = middle;
    }
    for (; lo < groups->groups && groups->group[lo].set == set; lo++)
        if (groups->group[lo].instance == instance)
            return (uint32_t)lo;
    return TM_INP_NONE;
}

/* The group that a surface shares its name with, or its own; what abaqus-export says a
 * value of is that alone. */
static uint32_t same_name(const tm_inp_groups *groups, uint32_t group)
{
    const tm_inp_group *is = &groups->group[group];
    const tm_inp_model *model = groups->model;
    const tm_inp_set *set = &model->set[is->set], *other = NULL;
    if (set->kind == TM_INP_FACES && set->dimension < 0)
        other = tm_inp_find_set(model, TM_INP_ELEMENTS, set->scope, set->name);
    const uint32_t same =
        other ? group_of(groups, (size_t)(other - model->set), is->instance)
              : TM_INP_NONE;
    return same == TM_INP_NONE ? group : same;
}

/* "1 + 3", of values in the order of tm_group_parts(). */
static void append_values(tm_text *key, const int32_t *value, size_t count)
{
    for (size_t i = 0; i < count; i++)
        tm_text_format(key, "%s%d", i > 0 ? TM_GROUP_AND : "", (int)value[i]);
}

/* What names of the file's comments are joined. */
static tm_status find_joined(tm_inp_groups *groups)
{
    const tm_block *said = &groups->model->group;
    tm_error *error = groups->model->error;
    tm_status status = TM_OK;
    for (size_t g = 0; g < said->count && status == TM_OK; g++) {
        const tm_group_dimension d = tm_group_dimension_of(said, g);
        tm_text key = {0};
        int32_t *part;
        size_t parts;
        status = tm_group_parts(said, d, tm_group_name(said, g), &part, &parts, error);
        append_values(&key, part, parts);
        if (status == TM_OK && key.failed)
            status = tm_fail_memory(error);
        if (status == TM_OK && parts > 0 &&
            !tm_group_named(&groups->joined, d, key.byte, key.size))
            status = tm_group_add(&groups->joined, d, tm_group_value(said, g), key.byte,
                                  error);
        tm_text_free(&key);
        free(part);
    }
    return status;
}

tm_status tm_inp_groups_find(tm_inp_groups *groups, tm_inp_model *model)
{
    size_t room = 0;
    *groups = (tm_inp_groups){.model = model};
    tm_group_init(&groups->named, ".group");
    tm_group_init(&groups->joined, ".group");
    for (size_t s = 0; s < model->sets; s++)
        for (size_t i = 0; counts(model, &model->set[s]) && i < model->instances; i++) {
            if (model->instance[i].scope != model->set[s].scope)
                continue;
            tm_inp_group *moved =
                tm_grow(groups->group, &room, groups->groups + 1, sizeof *moved);
            if (!moved)
                return tm_fail_memory(model->error);
            groups->group = moved;
            moved[groups->groups++] =
                (tm_inp_group){.set = (uint32_t)s, .instance = (uint32_t)i};
        }
    for (uint32_t g = 0; g < groups->groups; g++)
        groups->group[g].same = same_name(groups, g);
    return find_joined(groups);
}

void tm_inp_groups_free(tm_inp_groups *groups)
{
    free(groups->group);
    tm_group_free(&groups->named);
    tm_group_free(&groups->joined);
}

/* Values and names ------------------------------------------------------------------ */

/* Adds a name; one that is there already gets the value behind it. */
static tm_status add_name(tm_inp_groups *groups, int dimension, int32_t value,
                          const tm_text *bytes)
{
    tm_error *error = groups->model->error;
    const tm_group_dimension at = (tm_group_dimension)dimension;
    tm_text name = {0};
    tm_group_clean(&name, bytes->byte ? bytes->byte : "", bytes->size);
    if (name.size > 0 && tm_group_named(&groups->named, at, name.byte, name.size))
        tm_text_format(&name, " (%d)", (int)value);
    tm_status status = bytes->failed || name.failed ? tm_fail_memory(error) : TM_OK;
    if (status == TM_OK && name.size > 0)
        status = tm_group_add(&groups->named, at, value, name.byte, error);
    tm_text_free(&name);
    return status;
}

/* The name of a set, with that of its instance where there are several. */
static void append_name(tm_text *name, const tm_inp_groups *groups, uint32_t group,
                        int dimension)
{
    const tm_inp_group *is = &groups->group[group];
    const tm_inp_model *model = groups->model;
    const tm_word word = model->set[is->set].name;
    const tm_word of = model->instance[is->instance].name;
    const char *known = tm_group_find(&groups->named, (tm_group_dimension)dimension,
                                      is->value[dimension]);
    enum { FEW = 2 };
    if (known) {
        tm_text_string(name, known);
        return;
    }
    if (is->instance > 0 && model->instances > FEW) {
        tm_text_append(name, of.begin, of.size);
        tm_text_string(name, ".");
    }
    tm_text_append(name, word.begin, word.size);
}

static bool has_value(const tm_inp_groups *groups, const tm_inp_group *group, int d)
{
    return groups->model->set[group->set].dimension == d;
}

/* Above what comments say. */
static void find_next(tm_inp_groups *groups, int d)
{
    const tm_block *said = &groups->model->group;
    int32_t above = 0;
    for (size_t g = 0; g < said->count; g++)
        if ((int)tm_group_dimension_of(said, g) == d && tm_group_value(said, g) > above)
            above = tm_group_value(said, g);
    for (size_t g = 0; g < groups->groups; g++) {
        const tm_inp_group *group = &groups->group[g];
        if (has_value(groups, group, d) && groups->model->set[group->set].value > above)
            above = groups->model->set[group->set].value;
    }
    groups->next[d] = above < INT32_MAX ? above + 1 : above;
}

static tm_status name_dimension(tm_inp_groups *groups, int d)
{
    tm_status status = TM_OK;
    find_next(groups, d);
    for (uint32_t g = 0; g < groups->groups && status == TM_OK; g++) {
        tm_inp_group *group = &groups->group[g];
        const tm_inp_group *same = &groups->group[group->same];
        const bool shares = group->same != g && same->count[d] > 0;
        if (group->count[d] == 0)
            continue;
        if (shares)
            group->value[d] = same->value[d];
        else if (has_value(groups, group, d))
            group->value[d] = groups->model->set[group->set].value;
        else
            group->value[d] = groups->next[d]++;
        tm_text name = {0};
        if (!shares && !has_value(groups, group, d)) {
            append_name(&name, groups, g, d);
            status = add_name(groups, d, group->value[d], &name);
        }
        tm_text_free(&name);
    }
    return status;
}

tm_status tm_inp_groups_name(tm_inp_groups *groups)
{
    tm_inp_model *model = groups->model;
    tm_status status = tm_group_check(&model->group, 0, model->text.name, model->error);
    if (status == TM_OK)
        status = tm_group_append(&groups->named, &model->group, TM_GROUP_DIMENSIONS,
                                 model->error);
    for (int d = 0; d < TM_GROUP_DIMENSIONS && status == TM_OK; d++)
        status = name_dimension(groups, d);
    return status;
}

/* "a + b" of the groups of a class. */
static tm_status name_joined(const tm_inp_class *class, tm_inp_groups *groups,
                             const uint32_t *chain, size_t count, int d)
{
    tm_text name = {0};
    for (size_t i = 0; i < count; i++) {
        append_name(&name, groups, chain[i], d);
        tm_text_string(&name, i + 1 < count ? TM_GROUP_AND : "");
    }
    const tm_status status = add_name(groups, d, class->value[d], &name);
    tm_text_free(&name);
    return status;
}

/* The value that abaqus-export says of what is in these groups, or NULL. */
static const int32_t *find_said(const tm_inp_groups *groups, const uint32_t *chain,
                                size_t count, int d, tm_status *status)
{
    tm_text key = {0};
    const int32_t *said = NULL;
    int32_t *value = tm_new(count, sizeof *value);
    for (size_t i = 0; value && i < count; i++)
        value[i] = groups->group[chain[i]].value[d];
    if (value) {
        qsort(value, count, sizeof *value, tm_compare_numbers);
        append_values(&key, value, count);
    }
    if (!value || key.failed)
        *status = tm_fail_memory(groups->model->error);
    else
        said = tm_group_named(&groups->joined, (tm_group_dimension)d, key.byte, key.size);
    tm_text_free(&key);
    free(value);
    return said;
}

/* The value of a class of several groups; the first that it was put in first. */
static tm_status give_value(tm_inp_classes *classes, uint32_t c, tm_inp_groups *groups,
                            int d, size_t *several)
{
    tm_inp_class *class = &classes->class[c];
    uint32_t *chain = NULL;
    size_t count = 0, room = 0;
    tm_status status = TM_OK;
    for (uint32_t at = c; at != 0 && status == TM_OK; at = classes->class[at].parent)
        if (!tm_append(&chain, &count, &room, classes->class[at].group))
            status = tm_fail_memory(groups->model->error);
    for (size_t i = 0; i < count / 2; i++) {
        const uint32_t group = chain[i];
        chain[i] = chain[count - 1 - i];
        chain[count - 1 - i] = group;
    }
    const int32_t *said = status == TM_OK && groups->joined.count > 0
                              ? find_said(groups, chain, count, d, &status)
                              : NULL;
    if (said) {
        class->value[d] = *said;
    } else if (status == TM_OK) {
        ++*several;
        class->value[d] = groups->next[d]++;
        status = name_joined(class, groups, chain, count, d);
    }
    free(chain);
    return status;
}

tm_status tm_inp_classes_name(tm_inp_classes *classes, tm_inp_groups *groups,
                              size_t *several)
{
    tm_status status = TM_OK;
    for (uint32_t c = 1; c < classes->classes && status == TM_OK; c++)
        for (int d = 0; d < TM_GROUP_DIMENSIONS && status == TM_OK; d++) {
            tm_inp_class *class = &classes->class[c];
            if (!class->is_used[d])
                continue;
            if (class->parent == 0) {
                class->value[d] = groups->group[class->group].value[d];
                continue;
            }
            status = give_value(classes, c, groups, d, several);
        }
    return status;
}
