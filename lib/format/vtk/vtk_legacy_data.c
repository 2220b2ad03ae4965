/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_legacy_read.h"

#include "../../base/array.h"
#include "../binary.h"

#include <stdlib.h>
#include <string.h>

/* Names and strings: %XX is a byte. */
static void decode(tm_text *to, const char *bytes, size_t size)
{
    enum { HEX = 16, CODE = 3 };
    for (size_t i = 0; i < size; i++) {
        char digits[CODE] = "", *end = digits;
        long byte = 0;
        if (bytes[i] == '%' && size - i >= CODE) {
            memcpy(digits, bytes + i + 1, CODE - 1);
            byte = strtol(digits, &end, HEX);
        }
        const bool is_code = end == digits + CODE - 1 && byte > 0;
        const char plain = is_code ? (char)byte : bytes[i];
        tm_text_append(to, &plain, 1);
        i += is_code ? CODE - 1 : 0;
    }
}

/* Strings --------------------------------------------------------------------------- */

/* The length before a string: of its first two bits depends in how many bytes. */
static tm_status take_length(tm_vtk_file *file, size_t *length)
{
    static const uint8_t size_of[] = {8, 4, 2, 1};
    enum { BITS = 8, TOP = 6 };
    tm_scan *scan = &file->scan;
    const size_t left = (size_t)(scan->end - scan->at);
    if (left == 0)
        return tm_scan_fail(scan, file->error, "the file ends in an array of strings");
    const size_t size = size_of[(unsigned char)*scan->at >> TOP];
    if (left < size)
        return tm_scan_fail(scan, file->error, "the file ends in an array of strings");
    const uint64_t bits = tm_binary_unsigned(scan->at, size, true);
    scan->at += size;
    *length = (size_t)(bits & ~((uint64_t)3 << (BITS * size - 2)));
    if (*length > left - size)
        return tm_scan_fail(scan, file->error, "the file ends in a string");
    return TM_OK;
}

/* Strings behind the line; to `to`, if that is not NULL, with 0 behind each. */
static tm_status take_strings(tm_vtk_file *file, size_t count, tm_text *to)
{
    tm_scan *scan = &file->scan;
    tm_scan_end_line(scan);
    for (size_t i = 0; i < count; i++) {
        tm_word string = {scan->at, 0};
        if (scan->at == scan->end)
            return tm_scan_fail(scan, file->error,
                                "the file ends in an array of strings");
        if (file->binary) {
            const tm_status status = take_length(file, &string.size);
            if (status != TM_OK)
                return status;
            string.begin = scan->at;
            scan->at += string.size;
        } else {
            string = tm_scan_rest(scan);
            tm_scan_end_line(scan);
        }
        if (!to)
            continue;
        if (file->binary)
            tm_text_append(to, string.begin, string.size);
        else
            decode(to, string.begin, string.size);
        tm_text_append(to, "", 1);
    }
    return to && to->failed ? tm_fail_memory(file->error) : TM_OK;
}

/* Arrays ---------------------------------------------------------------------------- */

/* An array to be read: where it goes, and how many values of each of how many. */
typedef struct array {
    tm_vtk_data_list *list; /* NULL: it is passed over, but for group_names */
    tm_word name;
    size_t components, tuples;
    tm_vtk_number type;
} array;

/* Of strings the numbers are NULL. */
static tm_status keep(tm_vtk_file *file, const array *a, const tm_numbers *numbers)
{
    tm_vtk_mesh *cells = file->cells;
    tm_text name = {0};
    if (a->list->arrays == TM_ATTRIBUTES_MAX)
        return tm_scan_fail(&file->scan, file->error, "there are more than %d arrays",
                            TM_ATTRIBUTES_MAX);
    decode(&name, a->name.begin, a->name.size);
    tm_text_append(&name, "", 1);
    tm_vtk_data *data =
        name.failed ? NULL : tm_vtk_data_named(cells, a->list, name.byte, true);
    tm_text_free(&name);
    if (!data)
        return tm_fail_memory(file->error);
    data->components = a->components;
    data->strings = data->lacks = !numbers;
    return numbers ? tm_vtk_add_values(data, 0, numbers, file->error) : TM_OK;
}

static tm_status take_array(tm_vtk_file *file, const array *a)
{
    tm_numbers numbers = {0};
    size_t count;
    if (__builtin_mul_overflow(a->components, a->tuples, &count))
        return tm_scan_fail(&file->scan, file->error,
                            "an array has more numbers than memory can hold");
    if (a->type.kind == TM_VTK_STRINGS) {
        tm_text *groups = &file->cells->groups;
        const bool wanted = tm_word_is(a->name, "group_names") && groups->size == 0;
        tm_status status = take_strings(file, count, wanted ? groups : NULL);
        if (status == TM_OK && a->list && count > 0)
            status = keep(file, a, NULL);
        return status;
    }
    tm_status status =
        tm_vtk_take_numbers(file, &a->type, count, "a number of an array", &numbers);
    if (status == TM_OK && a->list && count > 0)
        status = keep(file, a, &numbers);
    tm_numbers_free(&numbers);
    return status;
}

/* "FIELD name n", then n times "name components tuples type" and numbers. */
static tm_status take_field(tm_vtk_file *file, tm_vtk_data_list *list, size_t count)
{
    size_t arrays = 0;
    tm_scan *scan = &file->scan;
    tm_scan_word(scan);
    tm_status status = tm_vtk_take_count(file, "the number of arrays", &arrays);
    for (size_t i = 0; i < arrays && status == TM_OK; i++) {
        array a = {.list = list};
        tm_scan_seek(scan);
        a.name = tm_scan_word(scan);
        if (tm_word_is(a.name, "METADATA")) { /* of the array before it */
            tm_vtk_skip_metadata(file);
            tm_scan_seek(scan);
            a.name = tm_scan_word(scan);
        }
        status = tm_vtk_take_count(file, "the number of components", &a.components);
        if (status == TM_OK)
            status = tm_vtk_take_count(file, "the number of tuples", &a.tuples);
        if (status == TM_OK)
            status = tm_vtk_take_type(file, &a.type);
        if (status == TM_OK && list && a.tuples != count)
            status = tm_scan_fail(scan, file->error,
                                  "array '%.*s' has %zu tuples (%zu would be right)",
                                  tm_word_shown(a.name), a.name.begin, a.tuples, count);
        if (status == TM_OK)
            status = take_array(file, &a);
    }
    return status;
}

/* The numbers of colours: bytes, or 0 to 1 in text. */
static tm_vtk_number type_of_colours(const tm_vtk_file *file)
{
    return (tm_vtk_number){TM_VTK_NUMBERS, file->binary ? TM_UINT8 : TM_FLOAT32};
}

/* "LOOKUP_TABLE name n": four numbers of colour each, passed over. */
static tm_status take_table(tm_vtk_file *file)
{
    array a = {.components = 4, .type = type_of_colours(file)};
    a.name = tm_scan_word(&file->scan);
    const tm_status status = tm_vtk_take_count(file, "the size of a table", &a.tuples);
    return status == TM_OK ? take_array(file, &a) : status;
}

/* Behind the type of SCALARS may stand how many they are, and then the name of a table.
 */
static tm_status take_scalars(tm_vtk_file *file, array *a)
{
    tm_scan *scan = &file->scan;
    tm_status status = tm_vtk_take_type(file, &a->type);
    if (status == TM_OK && tm_scan_more(scan))
        status = tm_vtk_take_count(file, "the number of components", &a->components);
    tm_scan table = *scan;
    tm_scan_end_line(&table);
    if (tm_scan_more(&table) && tm_word_is_like(tm_scan_word(&table), "LOOKUP_TABLE")) {
        tm_scan_rest(&table);
        *scan = table;
    }
    return status == TM_OK ? take_array(file, a) : status;
}

static tm_status take_colours(tm_vtk_file *file, array *a)
{
    a->type = type_of_colours(file);
    const tm_status status =
        tm_vtk_take_count(file, "the number of components", &a->components);
    return status == TM_OK ? take_array(file, a) : status;
}

tm_status tm_vtk_take_data(tm_vtk_file *file, tm_word word, tm_vtk_data_list *list,
                           size_t count, bool *known)
{
    static const struct {
        const char *word;
        size_t components;
    } plain[] = {{"VECTORS", 3},  {"NORMALS", 3},    {"TENSORS", 9},
                 {"TENSORS6", 6}, {"GLOBAL_IDS", 1}, {"PEDIGREE_IDS", 1}};
    array a = {.list = list, .components = 1, .tuples = count};
    *known = true;
    if (tm_word_is_like(word, "FIELD"))
        return take_field(file, list, count);
    if (tm_word_is_like(word, "LOOKUP_TABLE"))
        return take_table(file);
    *known = list != NULL;
    if (!list)
        return TM_OK;
    tm_scan before = file->scan;
    a.name = tm_scan_word(&file->scan);
    if (tm_word_is_like(word, "SCALARS"))
        return take_scalars(file, &a);
    if (tm_word_is_like(word, "COLOR_SCALARS"))
        return take_colours(file, &a);
    const bool texture = tm_word_is_like(word, "TEXTURE_COORDINATES");
    tm_status status = TM_OK;
    if (texture)
        status = tm_vtk_take_count(file, "the dimension", &a.components);
    *known = texture;
    for (size_t i = 0; i < sizeof plain / sizeof *plain; i++)
        if (tm_word_is_like(word, plain[i].word)) {
            a.components = plain[i].components;
            *known = true;
        }
    if (!*known) {
        file->scan = before;
        return TM_OK;
    }
    if (status == TM_OK)
        status = tm_vtk_take_type(file, &a.type);
    return status == TM_OK ? take_array(file, &a) : status;
}
