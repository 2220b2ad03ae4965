/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_sets.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { DEEPEST = 100 };

tm_status tm_inp_walk_new(tm_inp_walk *walk, tm_inp_model *model)
{
    *walk = (tm_inp_walk){.model = model};
    walk->seen = calloc(model->sets + 1, sizeof *walk->seen);
    walk->seen_at = calloc(model->sets + 1, sizeof *walk->seen_at);
    return walk->seen && walk->seen_at ? TM_OK : tm_fail_memory(model->error);
}

void tm_inp_walk_free(tm_inp_walk *walk)
{
    free(walk->seen);
    free(walk->seen_at);
}

/* The instance of that name, or TM_INP_NONE. */
static size_t find_instance(const tm_inp_model *model, tm_word name)
{
    for (size_t i = 1; i < model->instances; i++)
        if (tm_inp_same_name(model->instance[i].name, name))
            return i;
    return TM_INP_NONE;
}

/* Where a name leads from an instance: "Part-1-1.Set" to that of another one. */
static const tm_inp_set *look_up(const tm_inp_model *model, tm_inp_set_kind kind,
                                 tm_word name, size_t *instance)
{
    const tm_inp_set *set =
        tm_inp_find_set(model, kind, model->instance[*instance].scope, name);
    const char *dot = memchr(name.begin, '.', name.size);
    if (set)
        return set;
    if (dot) {
        const tm_word before = {name.begin, (size_t)(dot - name.begin)};
        const tm_word behind = {dot + 1, name.size - before.size - 1};
        const size_t other = find_instance(model, before);
        set = other == TM_INP_NONE
                  ? NULL
                  : tm_inp_find_set(model, kind, model->instance[other].scope, behind);
        *instance = set ? other : *instance;
    }
    if (!set && (set = tm_inp_find_set(model, kind, 0, name)))
        *instance = 0;
    return set;
}

/* Members that are ids -------------------------------------------------------------- */

typedef struct place {
    const tm_inp_ids *ids;
    const tm_inp_scope *scope;
    size_t first; /* of the whole */
} place;

static place place_of(const tm_inp_model *model, bool nodes, size_t instance)
{
    const tm_inp_instance *at = &model->instance[instance];
    const tm_inp_scope *scope = &model->scope[at->scope];
    return (place){nodes ? &scope->nodes : &scope->elements, scope,
                   nodes ? at->first_node : at->first_element};
}

/* Ids of the assembly without a name of an instance are of the only one, where the
 * assembly has no such nodes or elements itself. */
static size_t instance_of(const tm_inp_model *model, bool nodes, size_t instance)
{
    if (instance == 0 && place_of(model, nodes, 0).ids->count == 0 &&
        model->instances == 2)
        return 1;
    return instance;
}

static tm_status take_rank(tm_inp_walk *walk, const place *at, uint32_t rank, int face)
{
    return walk->take(walk->context, (uint32_t)(at->first + rank), face);
}

static tm_status take_id(tm_inp_walk *walk, const place *at, int32_t id, int face)
{
    const uint32_t rank = tm_inp_ids_find(at->ids, id);
    if (rank != TM_INP_NONE)
        return take_rank(walk, at, rank, face);
    walk->model->report->no_members += walk->count_missing;
    return TM_OK;
}

static tm_status take_range(tm_inp_walk *walk, const place *at, const int32_t number[3])
{
    tm_status status = TM_OK;
    for (size_t r = tm_inp_ids_from(at->ids, number[0]);
         r < at->ids->count && status == TM_OK; r++) {
        const int32_t id = at->ids->id[tm_inp_row(at->ids, r)];
        if (id > number[1])
            break;
        if ((id - number[0]) % number[2] == 0)
            status = take_rank(walk, at, (uint32_t)r, walk->face);
    }
    return status;
}

/* Sets ------------------------------------------------------------------------------ */

static tm_status walk_into(tm_inp_walk *walk, const tm_inp_set *set, size_t instance,
                           unsigned depth);

static tm_status fail_at(const tm_inp_walk *walk, uint32_t line, const char *what,
                         tm_word name)
{
    return tm_fail_at(walk->model->error, TM_ERROR_INPUT, walk->model->text.name, line,
                      NULL, "%s '%.*s'", what, tm_word_shown(name), name.begin);
}

static tm_status walk_name(tm_inp_walk *walk, tm_inp_set_kind kind, uint32_t line,
                           tm_word name, size_t instance, unsigned depth)
{
    const tm_inp_set *set = look_up(walk->model, kind, name, &instance);
    if (!set)
        return fail_at(walk, line, "there is no set", name);
    if (depth >= DEEPEST)
        return fail_at(walk, line, "more than 100 sets, each in another, down to", name);
    return walk_into(walk, set, instance, depth + 1);
}

/* "Part-1-1.12": an id in an instance. */
static bool is_id_of_instance(const tm_inp_walk *walk, tm_word field, size_t *instance,
                              tm_word *id)
{
    const char *dot = memchr(field.begin, '.', field.size);
    if (!dot)
        return false;
    const tm_word before = {field.begin, (size_t)(dot - field.begin)};
    const size_t other = find_instance(walk->model, before);
    *id = (tm_word){dot + 1, field.size - before.size - 1};
    if (other == TM_INP_NONE || !tm_inp_is_number(*id))
        return false;
    *instance = other;
    return true;
}

/* A field of a line in which there are names. */
static tm_status walk_field(tm_inp_walk *walk, tm_inp_text *text, tm_inp_set_kind kind,
                            tm_word field, size_t instance, unsigned depth)
{
    tm_word number = field;
    if (!is_id_of_instance(walk, field, &instance, &number) && !tm_inp_is_number(field))
        return walk_name(walk, kind, (uint32_t)text->line, field, instance, depth);
    int32_t id;
    const bool nodes = kind == TM_INP_NODES;
    const place at =
        place_of(walk->model, nodes, instance_of(walk->model, nodes, instance));
    const tm_status status = tm_inp_id(text, number, "a member of the set", &id);
    return status == TM_OK ? take_id(walk, &at, id, walk->face) : status;
}

static tm_status walk_line(tm_inp_walk *walk, tm_inp_set_kind kind,
                           const tm_inp_chunk *chunk, size_t instance, unsigned depth)
{
    tm_inp_text text = walk->model->text;
    tm_word field, label = {"", 0};
    tm_status status = TM_OK;
    text.row = chunk->is.row;
    text.field = text.row.begin;
    text.line = chunk->line;
    if (kind != TM_INP_FACES) {
        while (status == TM_OK && tm_inp_field(&text, &field))
            if (field.size > 0)
                status = walk_field(walk, &text, kind, field, instance, depth);
        return status;
    }
    if (!tm_inp_field(&text, &field))
        return TM_OK;
    tm_inp_field(&text, &label);
    walk->face = tm_inp_face_label(label);
    walk->root++; /* a set may be there with several faces */
    return walk_field(walk, &text, TM_INP_ELEMENTS, field, instance, depth);
}

static tm_status walk_ids(tm_inp_walk *walk, const tm_inp_set *set,
                          const tm_inp_chunk *chunk, size_t instance)
{
    const bool nodes = set->kind == TM_INP_NODES;
    const place at =
        place_of(walk->model, nodes, instance_of(walk->model, nodes, instance));
    const int32_t *id = walk->model->id;
    const size_t first = chunk->is.range.first, count = chunk->is.range.count;
    tm_status status = TM_OK;
    if (chunk->kind == TM_INP_RANGE)
        return take_range(walk, &at, id + first);
    for (size_t i = 0; i < count && status == TM_OK; i++) {
        if (chunk->kind == TM_INP_ROWS)
            status = take_rank(walk, &at, tm_inp_rank(at.ids, first + i), walk->face);
        else if (set->kind == TM_INP_FACES)
            status = take_id(walk, &at, id[first + 2 * i], id[first + 2 * i + 1]);
        else
            status = take_id(walk, &at, id[first + i], walk->face);
    }
    return status;
}

/* The nodes of the elements of a set: their ranks come by the way of elements. */
typedef struct nodes_of {
    tm_inp_walk *walk;
    tm_inp_member *take;
    void *context;
} nodes_of;

static tm_status take_nodes_of(void *context, uint32_t item, int face)
{
    nodes_of *of = context;
    const tm_inp_model *model = of->walk->model;
    size_t i = model->instances - 1;
    (void)face;
    while (model->instance[i].first_element > item)
        i--;
    const tm_inp_scope *scope = &model->scope[model->instance[i].scope];
    const uint32_t row =
        tm_inp_row(&scope->elements, item - model->instance[i].first_element);
    tm_status status = TM_OK;
    for (size_t k = scope->of.start[row]; k < scope->of.start[row + 1] && status == TM_OK;
         k++) {
        const uint32_t rank = tm_inp_ids_find(&scope->nodes, (int32_t)scope->of.item[k]);
        if (rank != TM_INP_NONE)
            status = of->take(of->context,
                              (uint32_t)(model->instance[i].first_node + rank), -1);
    }
    return status;
}

static tm_status walk_nodes_of(tm_inp_walk *walk, const tm_inp_chunk *chunk,
                               size_t instance, unsigned depth)
{
    nodes_of of = {walk, walk->take, walk->context};
    walk->take = take_nodes_of;
    walk->context = &of;
    const tm_status status =
        walk_name(walk, TM_INP_ELEMENTS, chunk->line, chunk->is.row, instance, depth);
    walk->take = of.take;
    walk->context = of.context;
    return status;
}

static tm_status walk_into(tm_inp_walk *walk, const tm_inp_set *set, size_t instance,
                           unsigned depth)
{
    const tm_inp_model *model = walk->model;
    const size_t s = (size_t)(set - model->set);
    if (walk->seen[s] == walk->root && walk->seen_at[s] == instance)
        return TM_OK;
    walk->seen[s] = walk->root;
    walk->seen_at[s] = (uint32_t)instance;
    tm_status status = TM_OK;
    for (uint32_t c = set->first; c != TM_INP_NONE && status == TM_OK;
         c = model->chunk[c].next) {
        const tm_inp_chunk *chunk = &model->chunk[c];
        size_t at = instance;
        if (chunk->instance != TM_INP_NONE)
            at = find_instance(model, model->word[chunk->instance]);
        if (at == TM_INP_NONE)
            status = fail_at(walk, chunk->line, "there is no instance",
                             model->word[chunk->instance]);
        else if (chunk->kind == TM_INP_LINE)
            status = walk_line(walk, set->kind, chunk, at, depth);
        else if (chunk->kind == TM_INP_OF)
            status = walk_nodes_of(walk, chunk, at, depth);
        else
            status = walk_ids(walk, set, chunk, at);
    }
    return status;
}

tm_status tm_inp_walk_set(tm_inp_walk *walk, size_t set, size_t instance)
{
    walk->root++;
    walk->face = -1;
    return walk_into(walk, &walk->model->set[set], instance, 0);
}

void tm_inp_mark_surfaces(tm_inp_model *model)
{
    for (size_t s = 0; s < model->sets; s++) {
        const tm_inp_set *surface = &model->set[s];
        for (uint32_t c = surface->first;
             surface->kind == TM_INP_FACES && c != TM_INP_NONE;
             c = model->chunk[c].next) {
            tm_inp_text text = model->text;
            tm_word field;
            text.row = model->chunk[c].is.row;
            if (model->chunk[c].kind != TM_INP_LINE)
                continue;
            text.field = text.row.begin;
            size_t instance = 0;
            for (size_t i = 0; i < model->instances; i++)
                if (model->instance[i].scope == surface->scope)
                    instance = i;
            const tm_inp_set *of = tm_inp_field(&text, &field)
                                       ? look_up(model, TM_INP_ELEMENTS, field, &instance)
                                       : NULL;
            if (of)
                model->set[of - model->set].is_of_surface = true;
        }
    }
}
