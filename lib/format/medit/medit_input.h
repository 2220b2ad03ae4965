/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A file of Medit's format, text or binary, as sections of numbers. */
#ifndef TM_FORMAT_MEDIT_MEDIT_INPUT_H
#define TM_FORMAT_MEDIT_MEDIT_INPUT_H

#include "../scan.h"
#include "medit.h"

/* Sections, with their numbers in binary files (libMeshb's GmfKwdCod). */
enum {
    TM_MEDIT_DIMENSION = 3,
    TM_MEDIT_VERTICES = 4,
    TM_MEDIT_EDGES = 5,
    TM_MEDIT_TRIANGLES = 6,
    TM_MEDIT_QUADRILATERALS = 7,
    TM_MEDIT_TETRAHEDRA = 8,
    TM_MEDIT_PRISMS = 9,
    TM_MEDIT_HEXAHEDRA = 10,
    TM_MEDIT_PYRAMIDS = 49,
    TM_MEDIT_END = 54,
    TM_MEDIT_SOLUTION = 62 /* SolAtVertices */
};

typedef struct tm_medit_section {
    int code;
    const char *word;  /* in text */
    const char *marks; /* lists of numbers that a stream has not: "corners"; or NULL */
    unsigned nodes;    /* of an element; 0: it is none */
    unsigned char vtk; /* VTK's number of its type */
} tm_medit_section;

/* The section of a code or NULL. */
const tm_medit_section *tm_medit_section_of(int code);

typedef struct tm_medit_input {
    bool binary, big;
    int version;
    int dimension; /* 2 or 3 */
    bool is_read;  /* of the section that is left: its rows, else they are skipped */
    tm_scan scan;  /* of text */
    const char *begin, *at, *end;
    const char *next; /* binary: the section behind this one, or NULL */
    tm_error *error;
} tm_medit_input;

/* Reads the head, up to the dimension. TM_ERROR_INPUT where it is none. */
tm_status tm_medit_begin(tm_medit_input *input, const tm_medit_bytes *bytes,
                         tm_error *error);

/* Goes to the next section that there is: *section is NULL for one that is not in the
 * table, and *name has its name. What the one before it has is skipped, unless its rows
 * were counted: then TM_ERROR_INPUT where more than those is there, in text. So it is at
 * the end of the file: End is missing. */
enum { TM_MEDIT_NAME = 48 };
tm_status tm_medit_next(tm_medit_input *input, const tm_medit_section **section,
                        char name[TM_MEDIT_NAME]);

/* How many rows a section has; TM_ERROR_INPUT where the file is too short for so many of
 * `numbers` numbers. */
tm_status tm_medit_count(tm_medit_input *input, size_t numbers, size_t *count);

tm_status tm_medit_integer(tm_medit_input *input, const char *what, int64_t lo,
                           int64_t hi, int64_t *value);
tm_status tm_medit_real(tm_medit_input *input, const char *what, double *value);

tm_status tm_medit_fail(const tm_medit_input *input, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* medit_solution.c: reads the values at the vertices of a file, for each vertex all: a
 * new array of count * *numbers, and the kinds, a new array. *others gets the names of
 * sections that are not read. */
tm_status tm_medit_read_solution(const tm_medit_bytes *bytes, size_t vertices,
                                 double **value, tm_medit_kind **kind, size_t *kinds,
                                 int *dimension, tm_text *others, tm_error *error);

/* How many numbers a value of a kind has in 2 or 3 dimensions. */
static inline size_t tm_medit_numbers_of(tm_medit_kind kind, int dimension)
{
    const size_t d = (size_t)dimension;
    return kind == TM_MEDIT_SCALAR ? 1 : kind == TM_MEDIT_VECTOR ? d : d * (d + 1) / 2;
}

#endif
