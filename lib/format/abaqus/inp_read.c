/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_reader.h"

#include "../../base/array.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, NODES_MAX = 27 };

static const tm_word nothing = {"", 0};

static tm_inp_scope *scope_of(const tm_inp_reader *r)
{
    return &r->model->scope[r->scope];
}

void tm_inp_skip_data(tm_inp_reader *r)
{
    while (r->text->kind == TM_INP_DATA)
        tm_inp_next(r->text);
}

/* An error at the keyword's line. */
tm_status tm_inp_fail_keyword(const tm_inp_reader *r, const char *what, tm_word word)
{
    return tm_fail_at(r->model->error, TM_ERROR_INPUT, r->text->name, r->keyword.line,
                      NULL, "*%s: %s%.*s", r->keyword.name, what, tm_word_shown(word),
                      word.begin);
}

/* What is in another file is not read. */
tm_status tm_inp_check_input(const tm_inp_reader *r)
{
    const tm_word *input = tm_inp_parameter(&r->keyword, "INPUT");
    return input ? tm_inp_fail_keyword(
                       r,
                       "its data are in another file, which is not read (put "
                       "it in here): ",
                       *input)
                 : TM_OK;
}

/* Nodes ----------------------------------------------------------------------------- */

static tm_status take_node(tm_inp_reader *r)
{
    tm_inp_scope *scope = scope_of(r);
    const size_t row = scope->nodes.count;
    tm_word field = nothing;
    int32_t id = 0;
    void *moved = tm_grow(scope->xyz, &scope->xyz_room, row + 1, sizeof *scope->xyz);
    if (!moved)
        return tm_fail_memory(r->model->error);
    scope->xyz = moved;
    tm_inp_field(r->text, &field);
    tm_status status = tm_inp_id(r->text, field, "the number of a node", &id);
    for (size_t i = 0; i < COORDINATES && status == TM_OK; i++) {
        const bool is_there = tm_inp_field(r->text, &field);
        if (!is_there && i < 2)
            return tm_inp_fail(r->text,
                               "node %d: the line ends where a coordinate "
                               "should be",
                               (int)id);
        status = tm_inp_real(r->text, is_there ? field : nothing, "a coordinate",
                             &scope->xyz[row][i]);
    }
    if (status == TM_OK && !tm_inp_ids_add(&scope->nodes, id))
        status = tm_fail_memory(r->model->error);
    return status;
}

/* The rows that were added become members of the set that a parameter names. */
static tm_status name_rows(tm_inp_reader *r, tm_inp_set_kind kind, const char *key,
                           size_t first, size_t past)
{
    const tm_word name = tm_inp_value(r, key);
    if (name.size == 0 || past == first)
        return TM_OK;
    tm_inp_set *set = tm_inp_add_set(r->model, kind, r->scope, name);
    tm_inp_chunk *chunk = set ? tm_inp_add_chunk(r->model, set, TM_INP_ROWS) : NULL;
    if (!chunk)
        return r->model->status;
    chunk->is.range.first = first;
    chunk->is.range.count = past - first;
    return TM_OK;
}

static tm_status take_nodes(tm_inp_reader *r)
{
    const size_t first = scope_of(r)->nodes.count;
    const tm_word system = tm_inp_value(r, "SYSTEM");
    if (system.size > 0 && !tm_word_is_like(system, "R"))
        return tm_inp_fail_keyword(
            r, "only rectangular coordinates are read, not SYSTEM=", system);
    tm_status status = tm_inp_check_input(r);
    for (; status == TM_OK && r->text->kind == TM_INP_DATA; tm_inp_next(r->text))
        status = take_node(r);
    if (status != TM_OK)
        return status;
    return name_rows(r, TM_INP_NODES, "NSET", first, scope_of(r)->nodes.count);
}

/* Elements -------------------------------------------------------------------------- */

/* The ids of `count` nodes, on this line and those behind it. */
static tm_status take_corners(tm_inp_reader *r, size_t count, int32_t element,
                              uint32_t *node)
{
    tm_word field;
    size_t taken = 0;
    while (taken < count) {
        while (taken < count && tm_inp_field(r->text, &field)) {
            int32_t id;
            if (field.size == 0)
                continue;
            const tm_status status =
                tm_inp_id(r->text, field, "the number of a node", &id);
            if (status != TM_OK)
                return status;
            node[taken++] = (uint32_t)id;
        }
        if (taken == count)
            break;
        tm_inp_next(r->text);
        if (r->text->kind != TM_INP_DATA)
            return tm_inp_fail(r->text, "element %d ends behind %zu nodes (it has %zu)",
                               (int)element, taken, count);
    }
    if (tm_inp_field(r->text, &field) && field.size > 0)
        return tm_inp_fail(r->text, "element %d: '%.*s' follows its %zu nodes",
                           (int)element, tm_word_shown(field), field.begin, count);
    return TM_OK;
}

static tm_status take_element(tm_inp_reader *r, const tm_inp_type *type)
{
    tm_inp_scope *scope = scope_of(r);
    const size_t row = scope->elements.count;
    uint32_t node[NODES_MAX];
    tm_word field = nothing;
    int32_t id = 0;
    tm_inp_field(r->text, &field);
    tm_status status = tm_inp_id(r->text, field, "the number of an element", &id);
    if (status == TM_OK && type->dimension > 0)
        status = take_corners(r, type->nodes, id, node);
    while (status == TM_OK && type->dimension == 0 && tm_inp_goes_on(r->text) &&
           r->text->kind == TM_INP_DATA)
        tm_inp_next(r->text);
    if (status != TM_OK)
        return status;
    void *moved = tm_grow(scope->type, &scope->type_room, row + 1, sizeof *type);
    uint32_t *to = tm_lists_room(&scope->of, type->nodes);
    if (!moved || !to)
        return tm_fail_memory(r->model->error);
    scope->type = moved;
    scope->type[row] = *type;
    tm_inp_reorder(type, node);
    memcpy(to, node, type->nodes * sizeof *node);
    if (!tm_lists_end(&scope->of, type->nodes) || !tm_inp_ids_add(&scope->elements, id))
        return tm_fail_memory(r->model->error);
    return TM_OK;
}

/* A type that a stream has not is said once. */
static void note_type(tm_inp_reader *r, tm_word name)
{
    tm_text *types = &r->model->report->types;
    const char *at = types->byte ? types->byte : "";
    while (*at) {
        const size_t size = strcspn(at, ",");
        if (tm_inp_same_name((tm_word){at, size}, name))
            return;
        at += size;
        at += strspn(at, ", ");
    }
    tm_text_format(types, "%s%.*s", types->size > 0 ? ", " : "", tm_word_shown(name),
                   name.begin);
}

static tm_status take_elements(tm_inp_reader *r)
{
    const size_t first = scope_of(r)->elements.count;
    const tm_word name = tm_inp_value(r, "TYPE");
    if (name.size == 0)
        return tm_inp_fail_keyword(r, "has no TYPE", nothing);
    const tm_inp_type type = tm_inp_type_of(name);
    tm_status status = tm_inp_check_input(r);
    for (; status == TM_OK && r->text->kind == TM_INP_DATA; tm_inp_next(r->text))
        status = take_element(r, &type);
    if (status != TM_OK)
        return status;
    const size_t past = scope_of(r)->elements.count;
    if (type.dimension == 0 && past > first) {
        r->model->report->others += past - first;
        note_type(r, name);
    }
    return name_rows(r, TM_INP_ELEMENTS, "ELSET", first, past);
}

/* Parts and instances --------------------------------------------------------------- */

static tm_status begin_part(tm_inp_reader *r)
{
    if (r->scope != 0)
        return tm_inp_fail_keyword(r, "stands in another part or instance", nothing);
    const tm_word name = tm_inp_value(r, "NAME");
    if (!tm_inp_add_scope(r->model, name))
        return r->model->status;
    r->scope = r->model->scopes - 1;
    return TM_OK;
}

/* Three numbers of a line of data; or six. */
static tm_status take_reals(tm_inp_reader *r, double *to, size_t count)
{
    tm_word field;
    tm_status status = TM_OK;
    for (size_t i = 0; i < count && status == TM_OK; i++)
        status = tm_inp_real(r->text, tm_inp_field(r->text, &field) ? field : nothing,
                             "a number of a translation or rotation", &to[i]);
    return status;
}

/* The scope of its own, which may get a mesh, comes behind the last part. */
static tm_status begin_instance(tm_inp_reader *r)
{
    enum { TURN = 7 };
    const tm_word name = tm_inp_value(r, "NAME");
    double turn[TURN];
    if (r->scope != 0)
        return tm_inp_fail_keyword(r, "stands in another part or instance", nothing);
    tm_inp_instance *instance = tm_inp_add_instance(r->model, name);
    if (!instance || !tm_inp_add_scope(r->model, name))
        return r->model->status;
    r->instance = r->model->instances - 1;
    r->scope = r->model->scopes - 1;
    instance->scope = r->scope;
    instance->line = r->keyword.line;
    instance->part = tm_inp_value(r, "PART");
    tm_status status = TM_OK;
    if (r->text->kind == TM_INP_DATA) {
        instance->is_moved = true;
        status = take_reals(r, instance->move, COORDINATES);
        tm_inp_next(r->text);
    }
    if (status == TM_OK && r->text->kind == TM_INP_DATA) {
        instance->is_turned = true;
        status = take_reals(r, turn, TURN);
        memcpy(instance->axis, turn, sizeof instance->axis);
        instance->degrees = turn[TURN - 1];
        tm_inp_next(r->text);
    }
    tm_inp_skip_data(r);
    return status;
}

/* An instance without a mesh of its own is its part, if there is one; else it is as if
 * the part came behind. */
static tm_status find_part(tm_inp_reader *r, tm_inp_instance *instance)
{
    const tm_inp_model *model = r->model;
    if (model->scope[instance->scope].nodes.count > 0)
        return TM_OK;
    for (size_t s = 1; s < model->scopes; s++)
        if (s != instance->scope &&
            tm_inp_same_name(model->scope[s].name, instance->part)) {
            instance->scope = s;
            return TM_OK;
        }
    return tm_fail_at(model->error, TM_ERROR_INPUT, r->text->name, instance->line, NULL,
                      "there is no part '%.*s'", tm_word_shown(instance->part),
                      instance->part.begin);
}

static tm_status end_scope(tm_inp_reader *r)
{
    r->scope = r->instance = 0;
    tm_inp_skip_data(r);
    return TM_OK;
}

/* Where no instance places parts, each stands where it is. */
static tm_status place_parts(tm_inp_reader *r)
{
    tm_inp_model *model = r->model;
    tm_status status = TM_OK;
    for (size_t i = 1; i < model->instances && status == TM_OK; i++)
        status = find_part(r, &model->instance[i]);
    if (model->instances > 1 || status != TM_OK)
        return status;
    for (size_t s = 1; s < model->scopes; s++) {
        tm_inp_instance *instance = tm_inp_add_instance(model, model->scope[s].name);
        if (!instance)
            return model->status;
        instance->scope = s;
    }
    return TM_OK;
}

/* Sections -------------------------------------------------------------------------- */

/* *SOLID SECTION, *SHELL SECTION, … give a set a material. */
static tm_status take_section(tm_inp_reader *r)
{
    tm_inp_model *model = r->model;
    const tm_word set = tm_inp_value(r, "ELSET");
    tm_inp_skip_data(r);
    if (set.size == 0)
        return TM_OK;
    tm_word *moved =
        tm_grow(model->section, &model->section_room, model->sections + 1, sizeof *moved);
    if (moved)
        model->section = moved;
    uint32_t *scope = tm_grow(model->section_scope, &model->section_scope_room,
                              model->sections + 1, sizeof *scope);
    if (scope)
        model->section_scope = scope;
    if (!moved || !scope)
        return tm_fail_memory(model->error);
    scope[model->sections] = (uint32_t)r->scope;
    moved[model->sections++] = set;
    return TM_OK;
}

static void mark_sections(tm_inp_model *model)
{
    for (size_t i = 0; i < model->sections; i++) {
        tm_inp_set *set = tm_inp_find_set(model, TM_INP_ELEMENTS, model->section_scope[i],
                                          model->section[i]);
        if (set)
            set->is_of_section = true;
    }
}

/* Comments -------------------------------------------------------------------------- */

/* "2 11 inlet 100%" behind "** termesh": a name, if there is one, is a row of .group. */
static tm_status take_group(tm_inp_reader *r, const char *at, const char *end)
{
    char number[64];
    const size_t size = (size_t)(end - at);
    snprintf(number, sizeof number, "%.*s", size < sizeof number ? (int)size : 63, at);
    char *dimension_end, *value_end;
    const long dimension = strtol(number, &dimension_end, 10);
    const long value = strtol(dimension_end, &value_end, 10);
    if (dimension_end == number || value_end == dimension_end || dimension < 0 ||
        dimension >= TM_GROUP_DIMENSIONS || value < INT32_MIN || value > INT32_MAX)
        return tm_inp_fail(r->text, "this is no group ('%s DIMENSION VALUE NAME')",
                           TM_INP_OWN);
    r->own = (tm_inp_own){true, (int)dimension, (int32_t)value};
    const char *begin = at + (value_end - number);
    tm_text name = {0};
    tm_group_clean(&name, begin, (size_t)(end - begin));
    tm_status status = name.failed ? tm_fail_memory(r->model->error) : TM_OK;
    if (status == TM_OK && name.size > 0)
        status = tm_group_add(&r->model->group, (tm_group_dimension)dimension,
                              (int32_t)value, name.byte, r->model->error);
    tm_text_free(&name);
    return status;
}

static tm_status take_comment(tm_inp_reader *r)
{
    const char *at = r->text->row.begin + sizeof TM_INP_OWN - 1;
    const char *end = r->text->row.begin + r->text->row.size;
    tm_status status = TM_OK;
    while (at < end && *at == ' ')
        at++;
    if (at == end)
        r->is_own = true;
    else if (tm_word_is((tm_word){at, (size_t)(end - at)}, "end"))
        r->has_end = true;
    else
        status = take_group(r, at, end);
    tm_inp_next(r->text);
    return status;
}

/* Keywords -------------------------------------------------------------------------- */

static tm_status take_keyword(tm_inp_reader *r)
{
    /* what makes nodes and elements otherwise than by listing them */
    static const char *const makers[] = {
        "NGEN",        "NFILL",  "NCOPY",  "NMAP",
        "ELGEN",       "ELCOPY", "SYSTEM", "SYMMETRICMODELGENERATION",
        "SUBSTRUCTURE"};
    static const char section[] = "SECTION";
    tm_inp_keyword_take(r->text, &r->keyword);
    const char *name = r->keyword.name;
    const size_t size = strlen(name);
    r->own.is_there &= strstr("NSET ELSET SURFACE", name) != NULL;
    if (strcmp(name, "NODE") == 0)
        return take_nodes(r);
    if (strcmp(name, "ELEMENT") == 0)
        return take_elements(r);
    if (strcmp(name, "NSET") == 0)
        return tm_inp_take_set(r, TM_INP_NODES, "NSET");
    if (strcmp(name, "ELSET") == 0)
        return tm_inp_take_set(r, TM_INP_ELEMENTS, "ELSET");
    if (strcmp(name, "SURFACE") == 0)
        return tm_inp_take_surface(r);
    if (strcmp(name, "PART") == 0)
        return begin_part(r);
    if (strcmp(name, "INSTANCE") == 0)
        return begin_instance(r);
    if (strcmp(name, "ENDPART") == 0 || strcmp(name, "ENDINSTANCE") == 0)
        return end_scope(r);
    if (strcmp(name, "INCLUDE") == 0)
        return tm_inp_fail_keyword(
            r, "another file is not read (put it in here): ", tm_inp_value(r, "INPUT"));
    for (size_t m = 0; m < sizeof makers / sizeof *makers; m++)
        if (strcmp(name, makers[m]) == 0)
            return tm_inp_fail_keyword(
                r, "only nodes and elements that are listed are read", nothing);
    if (size >= sizeof section - 1 &&
        strcmp(name + size - (sizeof section - 1), section) == 0)
        return take_section(r);
    tm_inp_skip_data(r);
    return TM_OK;
}

static tm_status check_whole(const tm_inp_reader *r)
{
    const tm_inp_model *model = r->model;
    size_t nodes = 0;
    for (size_t s = 0; s < model->scopes; s++)
        nodes += model->scope[s].nodes.count;
    if (r->is_own && !r->has_end)
        return tm_fail_at(model->error, TM_ERROR_INPUT, r->text->name, 0, NULL,
                          "the file is cut short: '%s end' is missing", TM_INP_OWN);
    if (r->scope != 0)
        return tm_fail_at(model->error, TM_ERROR_INPUT, r->text->name, 0, NULL,
                          "the file is cut short: a part or instance has no end");
    if (nodes == 0)
        return tm_fail_at(model->error, TM_ERROR_INPUT, r->text->name, 0, NULL,
                          "has no nodes (*NODE)");
    return TM_OK;
}

tm_status tm_inp_read(tm_inp_model *model, const char *bytes, size_t size,
                      const char *name)
{
    tm_inp_reader r = {.model = model, .text = &model->text};
    tm_status status = TM_OK;
    tm_inp_begin(&model->text, bytes, size, name, model->error);
    while (status == TM_OK && model->text.kind != TM_INP_END) {
        if (model->text.kind == TM_INP_COMMENT)
            status = take_comment(&r);
        else if (model->text.kind == TM_INP_KEYWORD)
            status = take_keyword(&r);
        else
            status =
                tm_inp_fail(&model->text, "no keyword line, such as *NODE, is before "
                                          "this one");
    }
    if (status == TM_OK)
        status = check_whole(&r);
    if (status == TM_OK)
        status = place_parts(&r);
    mark_sections(model);
    return status;
}
