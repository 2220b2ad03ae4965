/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_reader.h"

#include "../../base/array.h"

#include <string.h>

static const tm_word nothing = {"", 0};

/* Sets ------------------------------------------------------------------------------ */

static bool add_number(tm_inp_model *model, int32_t number)
{
    int32_t *moved = tm_grow(model->id, &model->id_room, model->ids + 1, sizeof *moved);
    if (!moved)
        return false;
    model->id = moved;
    moved[model->ids++] = number;
    return true;
}

/* The chunk that the set ends with, if more ids belong there, or a new one. */
static tm_inp_chunk *open_ids(tm_inp_reader *r, tm_inp_set *set, uint32_t instance,
                              bool is_new)
{
    tm_inp_chunk *last = set->last == TM_INP_NONE ? NULL : &r->model->chunk[set->last];
    if (!is_new && last && last->kind == TM_INP_IDS)
        return last;
    tm_inp_chunk *chunk = tm_inp_add_chunk(r->model, set, TM_INP_IDS);
    if (chunk) {
        chunk->is.range.first = r->model->ids;
        chunk->is.range.count = 0;
        chunk->instance = instance;
    }
    return chunk;
}

static tm_status take_range(tm_inp_reader *r, tm_inp_set *set, uint32_t instance)
{
    int32_t number[] = {0, 0, 1};
    tm_word field;
    tm_status status = TM_OK;
    size_t i = 0;
    for (; i < 3 && status == TM_OK && tm_inp_field(r->text, &field); i++)
        if (field.size > 0)
            status = tm_inp_id(r->text, field, "a number of GENERATE", &number[i]);
    if (status == TM_OK && i < 2)
        status = tm_inp_fail(r->text, "the line ends where the last number of GENERATE "
                                      "should be");
    if (status != TM_OK)
        return status;
    tm_inp_chunk *chunk = tm_inp_add_chunk(r->model, set, TM_INP_RANGE);
    if (!chunk)
        return r->model->status;
    chunk->instance = instance;
    chunk->is.range.first = r->model->ids;
    for (i = 0; i < 3; i++)
        if (!add_number(r->model, number[i]))
            return tm_fail_memory(r->model->error);
    return TM_OK;
}

static bool row_is_of_numbers(const tm_inp_text *text)
{
    for (size_t i = 0; i < text->row.size; i++)
        if (!memchr("0123456789, \t", text->row.begin[i], sizeof "0123456789, \t" - 1))
            return false;
    return true;
}

/* A line of ids, or of names and ids. `pairs`: of a surface, an id and a face. */
static tm_status take_members(tm_inp_reader *r, tm_inp_set *set, uint32_t instance,
                              bool is_new)
{
    tm_word field;
    if (!row_is_of_numbers(r->text)) {
        tm_inp_chunk *chunk = tm_inp_add_chunk(r->model, set, TM_INP_LINE);
        if (!chunk)
            return r->model->status;
        chunk->instance = instance;
        chunk->is.row = r->text->row;
        return TM_OK;
    }
    tm_inp_chunk *chunk = open_ids(r, set, instance, is_new);
    if (!chunk)
        return r->model->status;
    while (tm_inp_field(r->text, &field)) {
        int32_t id;
        if (field.size == 0)
            continue;
        const tm_status status = tm_inp_id(r->text, field, "a member of the set", &id);
        if (status != TM_OK)
            return status;
        if (!add_number(r->model, id))
            return tm_fail_memory(r->model->error);
        chunk->is.range.count++;
    }
    return TM_OK;
}

static bool begins_like(tm_word word, const char *with)
{
    const size_t size = strlen(with);
    return word.size >= size && tm_word_is_like((tm_word){word.begin, size}, with);
}

/* Sets that only surfaces need have such names where CAE programs make them. */
static bool is_internal_name(tm_word name)
{
    return begins_like(name, "_") || begins_like(name, "Internal");
}

/* What the comment before a set says of it. */
static void take_own(tm_inp_reader *r, tm_inp_set *set)
{
    if (!r->own.is_there)
        return;
    set->dimension = r->own.dimension;
    set->value = r->own.value;
    r->own.is_there = false;
}

/* The set that the keyword is about; the name of an instance becomes a word. */
static tm_inp_set *open_set(tm_inp_reader *r, tm_inp_set_kind kind, const char *key,
                            uint32_t *instance)
{
    const tm_word name = tm_inp_value(r, key), of = tm_inp_value(r, "INSTANCE");
    tm_inp_model *model = r->model;
    *instance = TM_INP_NONE;
    if (name.size == 0) {
        model->status = tm_inp_fail_keyword(r, "has no name", nothing);
        return NULL;
    }
    if (of.size > 0) {
        tm_word *moved =
            tm_grow(model->word, &model->word_room, model->words + 1, sizeof *moved);
        if (!moved) {
            model->status = tm_fail_memory(model->error);
            return NULL;
        }
        model->word = moved;
        moved[model->words] = of;
        *instance = (uint32_t)model->words++;
    }
    tm_inp_set *set = tm_inp_add_set(model, kind, r->scope, name);
    if (set) {
        set->is_internal |=
            tm_inp_parameter(&r->keyword, "INTERNAL") || is_internal_name(name);
        take_own(r, set);
    }
    return set;
}

/* *NSET with ELSET: the nodes of elements. */
static tm_status take_nodes_of(tm_inp_reader *r, tm_inp_set *set, uint32_t instance)
{
    const tm_word of = tm_inp_value(r, "ELSET");
    if (of.size == 0)
        return TM_OK;
    tm_inp_chunk *chunk = tm_inp_add_chunk(r->model, set, TM_INP_OF);
    if (!chunk)
        return r->model->status;
    chunk->instance = instance;
    chunk->is.row = of;
    return TM_OK;
}

tm_status tm_inp_take_set(tm_inp_reader *r, tm_inp_set_kind kind, const char *key)
{
    const bool ranges = tm_inp_parameter(&r->keyword, "GENERATE") != NULL;
    uint32_t instance;
    tm_status status = tm_inp_check_input(r);
    if (status != TM_OK)
        return status;
    tm_inp_set *set = open_set(r, kind, key, &instance);
    if (!set)
        return r->model->status;
    if (kind == TM_INP_NODES)
        status = take_nodes_of(r, set, instance);
    for (bool is_new = true; status == TM_OK && r->text->kind == TM_INP_DATA;
         tm_inp_next(r->text), is_new = false)
        status = ranges ? take_range(r, set, instance)
                        : take_members(r, set, instance, is_new);
    return status;
}

/* Surfaces -------------------------------------------------------------------------- */

/* "12, S3" or "SET, S3": an element with a number of a face. */
static tm_status take_faces(tm_inp_reader *r, tm_inp_set *set, bool is_new)
{
    tm_word member = nothing, label = nothing;
    const tm_word row = r->text->row;
    tm_inp_field(r->text, &member);
    tm_inp_field(r->text, &label);
    if (!tm_inp_is_number(member)) {
        tm_inp_chunk *chunk = tm_inp_add_chunk(r->model, set, TM_INP_LINE);
        if (!chunk)
            return r->model->status;
        chunk->is.row = row;
        return TM_OK;
    }
    int32_t id;
    const tm_status status = tm_inp_id(r->text, member, "the number of an element", &id);
    if (status != TM_OK)
        return status;
    tm_inp_chunk *chunk = open_ids(r, set, TM_INP_NONE, is_new);
    if (!chunk)
        return r->model->status;
    if (!add_number(r->model, id) || !add_number(r->model, tm_inp_face_label(label)))
        return tm_fail_memory(r->model->error);
    chunk->is.range.count++;
    return TM_OK;
}

tm_status tm_inp_take_surface(tm_inp_reader *r)
{
    const tm_word type = tm_inp_value(r, "TYPE");
    const bool of_nodes = tm_word_is_like(type, "NODE");
    uint32_t instance;
    if (tm_inp_parameter(&r->keyword, "COMBINE") ||
        (type.size > 0 && !of_nodes && !tm_word_is_like(type, "ELEMENT"))) {
        r->model->report->surfaces++;
        tm_inp_skip_data(r);
        return TM_OK;
    }
    tm_inp_set *set =
        open_set(r, of_nodes ? TM_INP_NODES : TM_INP_FACES, "NAME", &instance);
    if (!set)
        return r->model->status;
    tm_status status = TM_OK;
    for (bool is_new = true; status == TM_OK && r->text->kind == TM_INP_DATA;
         tm_inp_next(r->text), is_new = false) {
        if (!of_nodes) {
            status = take_faces(r, set, is_new);
            continue;
        }
        tm_word first = nothing; /* what follows is an area */
        tm_inp_field(r->text, &first);
        r->text->row = first;
        r->text->field = first.begin;
        status = take_members(r, set, instance, is_new);
    }
    return status;
}
