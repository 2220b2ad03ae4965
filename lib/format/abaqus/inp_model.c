/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_model.h"

#include "../../base/array.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

tm_status tm_inp_model_new(tm_inp_model *model, tm_abaqus_report *report, tm_error *error)
{
    *model = (tm_inp_model){.report = report, .error = error};
    tm_group_init(&model->group, ".group");
    const bool done =
        tm_inp_add_scope(model, (tm_word){0}) && tm_inp_add_instance(model, (tm_word){0});
    return done ? TM_OK : model->status;
}

static void free_ids(tm_inp_ids *ids)
{
    free(ids->id);
    free(ids->order);
    free(ids->rank);
}

void tm_inp_model_free(tm_inp_model *model)
{
    for (size_t s = 0; s < model->scopes; s++) {
        tm_inp_scope *scope = &model->scope[s];
        free_ids(&scope->nodes);
        free_ids(&scope->elements);
        free(scope->xyz);
        free(scope->type);
        tm_lists_free(&scope->of);
    }
    free(model->scope);
    free(model->instance);
    free(model->set);
    tm_hash_free(&model->by_name);
    free(model->chunk);
    free(model->id);
    free(model->word);
    free(model->section);
    free(model->section_scope);
    tm_group_free(&model->group);
}

tm_inp_scope *tm_inp_add_scope(tm_inp_model *model, tm_word name)
{
    tm_inp_scope *moved =
        tm_grow(model->scope, &model->scope_room, model->scopes + 1, sizeof *moved);
    if (moved) {
        model->scope = moved;
        moved[model->scopes] = (tm_inp_scope){.name = name};
    }
    if (!moved || !tm_lists_begin(&moved[model->scopes].of)) {
        model->status = tm_fail_memory(model->error);
        return NULL;
    }
    return &moved[model->scopes++];
}

tm_inp_instance *tm_inp_add_instance(tm_inp_model *model, tm_word name)
{
    tm_inp_instance *moved = tm_grow(model->instance, &model->instance_room,
                                     model->instances + 1, sizeof *moved);
    if (!moved) {
        model->status = tm_fail_memory(model->error);
        return NULL;
    }
    model->instance = moved;
    moved[model->instances] = (tm_inp_instance){.name = name};
    return &moved[model->instances++];
}

/* Sets ------------------------------------------------------------------------------ */

bool tm_inp_same_name(tm_word a, tm_word b)
{
    return a.size == b.size && strncasecmp(a.begin, b.begin, a.size) == 0;
}

static uint32_t *slot_of(const tm_inp_model *model, tm_inp_set_kind kind, size_t scope,
                         tm_word name)
{
    uint64_t hash = tm_hash(tm_hash(0, scope), kind);
    for (size_t i = 0; i < name.size; i++)
        hash = tm_hash(hash, (uint64_t)toupper((unsigned char)name.begin[i]));
    uint32_t *slot = tm_hash_slot(&model->by_name, hash);
    for (; *slot != TM_HASH_FREE; slot = tm_hash_next(&model->by_name, slot)) {
        const tm_inp_set *set = &model->set[*slot];
        if (set->kind == kind && set->scope == scope && tm_inp_same_name(set->name, name))
            break;
    }
    return slot;
}

static bool reserve_sets(tm_inp_model *model)
{
    enum { FIRST = 16 };
    if (model->sets < model->hash_room)
        return true;
    const size_t room = model->hash_room ? 2 * model->hash_room : FIRST;
    tm_hash_free(&model->by_name);
    model->hash_room = 0;
    if (!tm_hash_make(&model->by_name, room))
        return false;
    model->hash_room = room;
    for (size_t s = 0; s < model->sets; s++) {
        const tm_inp_set *set = &model->set[s];
        *slot_of(model, set->kind, set->scope, set->name) = (uint32_t)s;
    }
    return true;
}

tm_inp_set *tm_inp_find_set(const tm_inp_model *model, tm_inp_set_kind kind, size_t scope,
                            tm_word name)
{
    if (model->sets == 0)
        return NULL;
    const uint32_t *slot = slot_of(model, kind, scope, name);
    return *slot == TM_HASH_FREE ? NULL : &model->set[*slot];
}

tm_inp_set *tm_inp_add_set(tm_inp_model *model, tm_inp_set_kind kind, size_t scope,
                           tm_word name)
{
    tm_inp_set *there = tm_inp_find_set(model, kind, scope, name);
    if (there)
        return there;
    tm_inp_set *moved =
        tm_grow(model->set, &model->set_room, model->sets + 1, sizeof *moved);
    if (moved)
        model->set = moved;
    if (!moved || !reserve_sets(model)) {
        model->status = tm_fail_memory(model->error);
        return NULL;
    }
    *slot_of(model, kind, scope, name) = (uint32_t)model->sets;
    moved[model->sets] = (tm_inp_set){.kind = kind,
                                      .scope = (uint32_t)scope,
                                      .name = name,
                                      .dimension = -1,
                                      .first = TM_INP_NONE,
                                      .last = TM_INP_NONE};
    return &moved[model->sets++];
}

tm_inp_chunk *tm_inp_add_chunk(tm_inp_model *model, tm_inp_set *set, tm_inp_members kind)
{
    tm_inp_chunk *moved =
        tm_grow(model->chunk, &model->chunk_room, model->chunks + 1, sizeof *moved);
    if (!moved) {
        model->status = tm_fail_memory(model->error);
        return NULL;
    }
    model->chunk = moved;
    const uint32_t at = (uint32_t)model->chunks++;
    moved[at] = (tm_inp_chunk){.kind = kind,
                               .next = TM_INP_NONE,
                               .instance = TM_INP_NONE,
                               .line = (uint32_t)model->text.line};
    if (set->last == TM_INP_NONE)
        set->first = at;
    else
        moved[set->last].next = at;
    set->last = at;
    return &moved[at];
}

/* Ids ------------------------------------------------------------------------------- */

bool tm_inp_ids_add(tm_inp_ids *ids, int32_t id)
{
    int32_t *moved = tm_grow(ids->id, &ids->room, ids->count + 1, sizeof *moved);
    if (!moved)
        return false;
    ids->id = moved;
    moved[ids->count++] = id;
    return true;
}

/* An id above its row, so that they are sorted as numbers. */
static int compare(const void *a, const void *b)
{
    const uint64_t p = *(const uint64_t *)a, q = *(const uint64_t *)b;
    return (p > q) - (p < q);
}

static tm_status sort(tm_inp_ids *ids, const tm_inp_model *model)
{
    enum { HALF = 32 };
    uint64_t *key = tm_new(ids->count, sizeof *key);
    ids->order = tm_new(ids->count, sizeof *ids->order);
    ids->rank = tm_new(ids->count, sizeof *ids->rank);
    if (!key || !ids->order || !ids->rank) {
        free(key);
        return tm_fail_memory(model->error);
    }
    for (size_t row = 0; row < ids->count; row++)
        key[row] = (uint64_t)ids->id[row] << HALF | row;
    qsort(key, ids->count, sizeof *key, compare);
    for (size_t r = 0; r < ids->count; r++) {
        ids->order[r] = (uint32_t)key[r];
        ids->rank[ids->order[r]] = (uint32_t)r;
    }
    free(key);
    return TM_OK;
}

tm_status tm_inp_ids_sort(tm_inp_ids *ids, const tm_inp_model *model, const char *what)
{
    size_t row = 1;
    while (row < ids->count && ids->id[row - 1] < ids->id[row])
        row++;
    if (row >= ids->count)
        return TM_OK;
    const tm_status status = sort(ids, model);
    for (size_t r = 1; r < ids->count && status == TM_OK; r++)
        if (ids->id[ids->order[r - 1]] == ids->id[ids->order[r]])
            return tm_fail_at(model->error, TM_ERROR_INPUT, model->text.name, 0, NULL,
                              "%s %d is there twice", what, (int)ids->id[ids->order[r]]);
    return status;
}

size_t tm_inp_ids_from(const tm_inp_ids *ids, int32_t id)
{
    size_t lo = 0, hi = ids->count;
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (ids->id[tm_inp_row(ids, middle)] < id)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

uint32_t tm_inp_ids_find(const tm_inp_ids *ids, int32_t id)
{
    if (ids->count == 0)
        return TM_INP_NONE;
    const int64_t guess = (int64_t)id - ids->id[tm_inp_row(ids, 0)];
    if (guess >= 0 && guess < (int64_t)ids->count &&
        ids->id[tm_inp_row(ids, (size_t)guess)] == id)
        return (uint32_t)guess;
    const size_t r = tm_inp_ids_from(ids, id);
    return r < ids->count && ids->id[tm_inp_row(ids, r)] == id ? (uint32_t)r
                                                               : TM_INP_NONE;
}
