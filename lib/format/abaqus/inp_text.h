/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of an input file: keyword lines, which begin with '*', and lines of data,
 * both of fields with commas between; comments, which begin with "**". */
#ifndef TM_FORMAT_ABAQUS_INP_TEXT_H
#define TM_FORMAT_ABAQUS_INP_TEXT_H

#include "../scan.h"

/* What a comment of abaqus-export begins with. */
#define TM_INP_OWN "** termesh"

typedef enum tm_inp_kind {
    TM_INP_END,     /* of the text */
    TM_INP_KEYWORD, /* "*ELEMENT, TYPE=C3D4" */
    TM_INP_DATA,    /* "1, 2, 3" */
    TM_INP_COMMENT  /* one of abaqus-export: others are skipped */
} tm_inp_kind;

typedef struct tm_inp_text {
    const char *at, *end; /* what was not read yet */
    const char *name;     /* the file's, for messages */
    size_t line;          /* the number of the line, from 1 */
    tm_inp_kind kind;     /* of the line */
    tm_word row;          /* the line, without blanks around it */
    const char *field;    /* of the row: what was not taken yet */
    tm_error *error;
} tm_inp_text;

void tm_inp_begin(tm_inp_text *text, const char *bytes, size_t size, const char *name,
                  tm_error *error);

/* Goes to the next line that is not blank. */
void tm_inp_next(tm_inp_text *text);

/* Takes the next field of the row, without blanks around it and without quotes; false at
 * the end: nothing behind a last comma is no field. A field may be empty. */
bool tm_inp_field(tm_inp_text *text, tm_word *field);

/* Whether the row ends in a comma. */
bool tm_inp_goes_on(const tm_inp_text *text);

/* TM_ERROR_INPUT at the line. */
tm_status tm_inp_fail(const tm_inp_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Numbers. An id is 1 … 2^31 - 1. A real is one of Fortran, too: 1.5D-3; it is finite; an
 * empty one is 0. `what` is for messages. */
bool tm_inp_is_number(tm_word word);
tm_status tm_inp_id(const tm_inp_text *text, tm_word word, const char *what, int32_t *id);
tm_status tm_inp_real(const tm_inp_text *text, tm_word word, const char *what,
                      double *real);

enum { TM_INP_KEY = 32, TM_INP_PARAMETERS = 16 };

/* A keyword line: "*SOLID SECTION" is SOLIDSECTION here; keys are in capitals. Parameters
 * behind the first sixteen are not kept. */
typedef struct tm_inp_keyword {
    size_t line;
    char name[TM_INP_KEY];
    size_t parameters;
    char key[TM_INP_PARAMETERS][TM_INP_KEY];
    tm_word value[TM_INP_PARAMETERS]; /* empty without '=' */
} tm_inp_keyword;

/* Takes the keyword line that the text is at, with the lines on which it goes on, and
 * goes to the line behind. */
void tm_inp_keyword_take(tm_inp_text *text, tm_inp_keyword *keyword);

/* The value of a parameter, or NULL where it is not there. */
const tm_word *tm_inp_parameter(const tm_inp_keyword *keyword, const char *key);

#endif
