/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading an input file: what its keywords have in common. */
#ifndef TM_FORMAT_ABAQUS_INP_READER_H
#define TM_FORMAT_ABAQUS_INP_READER_H

#include "inp_model.h"

/* A comment of abaqus-export that is for the next set. */
typedef struct tm_inp_own {
    bool is_there;
    int dimension;
    int32_t value;
} tm_inp_own;

typedef struct tm_inp_reader {
    tm_inp_model *model;
    tm_inp_text *text;
    tm_inp_keyword keyword;
    size_t scope;    /* that lines belong to */
    size_t instance; /* that is open; 0: none */
    tm_inp_own own;
    bool is_own, has_end; /* the file is of abaqus-export, and complete */
} tm_inp_reader;

/* The value of a parameter of the keyword; empty where it is not there. */
static inline tm_word tm_inp_value(const tm_inp_reader *r, const char *key)
{
    const tm_word *value = tm_inp_parameter(&r->keyword, key);
    return value ? *value : (tm_word){"", 0};
}

/* Goes behind the data of the keyword. */
void tm_inp_skip_data(tm_inp_reader *r);

/* TM_ERROR_INPUT at the keyword's line: "*NODE: what'word'". */
tm_status tm_inp_fail_keyword(const tm_inp_reader *r, const char *what, tm_word word);

/* An error where the data of the keyword are in another file. */
tm_status tm_inp_check_input(const tm_inp_reader *r);

/* inp_members.c: *NSET and *ELSET, of which `key` names the set, and *SURFACE. */
tm_status tm_inp_take_set(tm_inp_reader *r, tm_inp_set_kind kind, const char *key);
tm_status tm_inp_take_surface(tm_inp_reader *r);

#endif
