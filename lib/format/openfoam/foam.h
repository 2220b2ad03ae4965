/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of OpenFOAM as tokens and lists, of text or binary (OpenFOAM User Guide, section
 * Basic input/output file format). */
#ifndef TM_FORMAT_OPENFOAM_FOAM_H
#define TM_FORMAT_OPENFOAM_FOAM_H

#include "../numbers.h"

/* A place in a file. */
typedef struct tm_foam {
    tm_scan scan;
    bool binary;
    bool big;
    tm_number_type label, scalar;
    bool compact; /* its class is faceCompactList */
} tm_foam;

/* A token: one of ( ) { } ; [ ], or a word, a number or a string. A string is without its
 * quotes. Empty at the end. */
typedef struct tm_foam_token {
    tm_word word;
    bool string;
} tm_foam_token;

/* Goes behind the head of a file, if it has one: which says whether the lists are binary,
 * and of what numbers. TM_ERROR_INPUT where the head is damaged. */
tm_status tm_foam_begin(tm_foam *foam, const char *bytes, size_t size, const char *name,
                        tm_error *error);

/* The next token, behind blanks and comments. TM_ERROR_INPUT where a comment or a string
 * has no end, and for a directive (#include). */
tm_status tm_foam_next(tm_foam *foam, tm_foam_token *token, tm_error *error);

/* The next token, which has to be that character, or a number of at least 0 and at most
 * `most`; `what` is for messages. */
tm_status tm_foam_expect(tm_foam *foam, char c, tm_error *error);
tm_status tm_foam_count(tm_foam *foam, const char *what, size_t most, size_t *count,
                        tm_error *error);

/* Whether the next token is that character: then it is behind it. */
bool tm_foam_is(tm_foam *foam, char c);

/* Goes behind the value of an entry of a dictionary: to ';', or behind { … }. */
tm_status tm_foam_skip_value(tm_foam *foam, tm_error *error);

/* A list of labels, of points (three scalars each), or of 0 and 1, of not more than
 * `most`, as N(a b …), or N{a} where all are alike. TM_ERROR_INPUT where it is damaged;
 * before memory is taken where the file is too short. *numbers must be {0}. */
tm_status tm_foam_labels(tm_foam *foam, const char *what, size_t most,
                         tm_numbers *numbers, tm_error *error);
tm_status tm_foam_points(tm_foam *foam, tm_numbers *numbers, tm_error *error);
tm_status tm_foam_bits(tm_foam *foam, const char *what, size_t most, tm_numbers *numbers,
                       tm_error *error);

/* TM_ERROR_INPUT where more than blanks and comments follows. */
tm_status tm_foam_end(tm_foam *foam, tm_error *error);

#endif
