/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A legacy file of VTK while it is read: its words, its arrays, and its data. */
#ifndef TM_FORMAT_VTK_LEGACY_READ_H
#define TM_FORMAT_VTK_LEGACY_READ_H

#include "vtk_cells.h"

/* What an array's type says. */
typedef enum tm_vtk_kind {
    TM_VTK_NUMBERS,
    TM_VTK_BITS,   /* eight in a byte, the highest first */
    TM_VTK_STRINGS /* a line each; in binary files with their length before each */
} tm_vtk_kind;

typedef struct tm_vtk_number {
    tm_vtk_kind kind;
    tm_number_type number;
} tm_vtk_number;

typedef struct tm_vtk_file {
    tm_scan scan;
    bool binary; /* big endian, behind the line that says what they are */
    tm_vtk_mesh *cells;
    tm_error *error;
} tm_vtk_file;

/* The next word of the line as a type of VTK. */
tm_status tm_vtk_take_type(tm_vtk_file *file, tm_vtk_number *type);

/* The next word of the line as a count. */
tm_status tm_vtk_take_count(tm_vtk_file *file, const char *what, size_t *count);

/* `count` numbers behind the line; bits are bytes then. *numbers must be {0}.
 * TM_ERROR_INPUT before memory is taken where the file is too short. */
tm_status tm_vtk_take_numbers(tm_vtk_file *file, const tm_vtk_number *type, size_t count,
                              const char *what, tm_numbers *numbers);

/* Goes behind the lines that follow METADATA, up to an empty one. */
void tm_vtk_skip_metadata(tm_vtk_file *file);

/* vtk_legacy_data.c: what stands behind a word that begins an array, or several, of data
 * of `count` points or cells, where the list is not NULL, else of the whole. *known is
 * false where the word begins none; nothing is read then. */
tm_status tm_vtk_take_data(tm_vtk_file *file, tm_word word, tm_vtk_data_list *list,
                           size_t count, bool *known);

#endif
