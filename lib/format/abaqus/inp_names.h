/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names that sets may have: letters, digits, '_' and '-', a letter first, at most 80, and
 * the same in capitals or not. */
#ifndef TM_FORMAT_ABAQUS_INP_NAMES_H
#define TM_FORMAT_ABAQUS_INP_NAMES_H

#include "../../stream/group.h"

enum { TM_INP_NAME = 81 };

typedef struct tm_inp_name {
    int32_t value;
    bool has_value; /* behind the name */
    char name[TM_INP_NAME];
} tm_inp_name;

/* Those of one dimension; {0} has none. */
typedef struct tm_inp_names {
    size_t count, room;
    tm_inp_name *list; /* by ascending values */
} tm_inp_names;

/* Adds a value, above those that are there, that users call so, or NULL: it is their name
 * where that is a set's, else with '_' for other letters and the value behind; without
 * one "Region_7", "Face_7", "Node_7". */
tm_status tm_inp_names_add(tm_inp_names *names, tm_group_dimension dimension,
                           int32_t value, const char *name, tm_error *error);

/* Makes those differ that would be the same in capitals. O(n log n), as often as what is
 * changed for that has the name of another one. */
void tm_inp_names_end(tm_inp_names *names);

/* The name of a value that is there. O(log n). */
const char *tm_inp_name_of(const tm_inp_names *names, int32_t value);

void tm_inp_names_free(tm_inp_names *names);

#endif
