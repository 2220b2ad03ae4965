/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "medit_input.h"

#include "../../base/array.h"

#include <stdlib.h>

enum { KINDS_MAX = TM_ATTRIBUTES_MAX };

const unsigned char tm_medit_numbers[TM_MEDIT_KINDS] = {
    [TM_MEDIT_SCALAR] = 1, [TM_MEDIT_VECTOR] = 3, [TM_MEDIT_TENSOR] = 6};

/* "2 1 3": two values, a scalar and a tensor. */
static tm_status take_kinds(tm_medit_input *input, tm_medit_kind **kind, size_t *kinds,
                            size_t *numbers)
{
    int64_t value = 0;
    tm_status status =
        tm_medit_integer(input, "the number of values", 1, KINDS_MAX, &value);
    if (status != TM_OK)
        return status;
    *kinds = (size_t)value;
    *kind = tm_new(*kinds, sizeof **kind);
    if (!*kind)
        return tm_fail_memory(input->error);
    *numbers = 0;
    for (size_t k = 0; k < *kinds && status == TM_OK; k++) {
        status = tm_medit_integer(input, "a kind of value", TM_MEDIT_SCALAR,
                                  TM_MEDIT_TENSOR, &value);
        (*kind)[k] = (tm_medit_kind)value;
        if (status == TM_OK)
            *numbers += tm_medit_numbers_of((*kind)[k], input->dimension);
    }
    return status;
}

static tm_status take_values(tm_medit_input *input, size_t vertices, double **value,
                             tm_medit_kind **kind, size_t *kinds)
{
    size_t count, numbers = 0, room = 0, done = 0;
    tm_status status = tm_medit_count(input, 1, &count);
    if (status == TM_OK && count != vertices)
        return tm_medit_fail(input, "has values of %zu vertices (the mesh has %zu)",
                             count, vertices);
    if (status == TM_OK)
        status = take_kinds(input, kind, kinds, &numbers);
    for (size_t v = 0; v < count && status == TM_OK; v++) {
        double *moved = tm_grow(*value, &room, done + numbers, sizeof *moved);
        if (!moved)
            return tm_fail_memory(input->error);
        *value = moved;
        for (size_t i = 0; i < numbers && status == TM_OK; i++)
            status = tm_medit_real(input, "a value", &moved[done++]);
    }
    return status;
}

tm_status tm_medit_read_solution(const tm_medit_bytes *bytes, size_t vertices,
                                 double **value, tm_medit_kind **kind, size_t *kinds,
                                 int *dimension, tm_text *others, tm_error *error)
{
    tm_medit_input input;
    char name[TM_MEDIT_NAME];
    const tm_medit_section *section = NULL;
    *value = NULL;
    *kind = NULL;
    tm_status status = tm_medit_begin(&input, bytes, error);
    *dimension = input.dimension;
    while (status == TM_OK) {
        status = tm_medit_next(&input, &section, name);
        if (status != TM_OK || (section && section->code == TM_MEDIT_END))
            break;
        if (section && section->code == TM_MEDIT_SOLUTION && *kind)
            status = tm_medit_fail(&input, "a second section SolAtVertices");
        else if (section && section->code == TM_MEDIT_SOLUTION)
            status = take_values(&input, vertices, value, kind, kinds);
        else
            tm_text_format(others, "%s%s", others->size > 0 ? ", " : "", name);
    }
    if (status == TM_OK && !*kind)
        status = tm_medit_fail(&input, "has no values at vertices (SolAtVertices)");
    return status;
}
