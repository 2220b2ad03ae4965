/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a .vtu file says of its arrays: the elements of its XML, without the numbers. */
#ifndef TM_FORMAT_VTK_VTU_XML_H
#define TM_FORMAT_VTK_VTU_XML_H

#include "../../base/error.h"
#include "../../text/text.h"
#include "../numbers.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum tm_vtu_section {
    TM_VTU_POINT_DATA,
    TM_VTU_CELL_DATA,
    TM_VTU_POINTS,
    TM_VTU_CELLS,
    TM_VTU_FIELD_DATA,
    TM_VTU_NO_SECTION
} tm_vtu_section;

typedef enum tm_vtu_form { TM_VTU_ASCII, TM_VTU_BASE64, TM_VTU_APPENDED } tm_vtu_form;

/* A DataArray. */
typedef struct tm_vtu_entry {
    tm_vtu_section section;
    tm_vtu_form form;
    tm_number_type type;
    bool strings;      /* their bytes, each string with 0 behind it */
    bool bits;         /* eight in a byte, but in text */
    size_t piece;      /* of PointData, CellData, Points and Cells */
    size_t name;       /* names.byte + name */
    size_t components; /* 1 where it does not say */
    size_t line;
    const char *begin, *end; /* what is in the element; begin is NULL: nothing */
    size_t offset;           /* in the appended data */
} tm_vtu_entry;

/* A Piece: what it says that it has, or in a list of pieces (.pvtu) its file, a name as
 * that of an array. */
typedef struct tm_vtu_piece {
    size_t points, cells;
    size_t source;
} tm_vtu_piece;

/* Bytes are those that were given. */
typedef struct tm_vtu_file {
    const char *bytes, *end;
    const char *name;
    bool big;
    size_t header; /* bytes of a number before data */
    bool packed;   /* by zlib */
    bool is_list;  /* of pieces, each a file of its own */
    size_t pieces;
    tm_vtu_piece *piece;
    size_t entries;
    tm_vtu_entry *entry;
    tm_text names;                       /* with 0 behind each */
    const char *appended, *appended_end; /* behind the '_'; NULL: there are none */
    bool appended_base64;
    size_t entry_room, piece_room;
} tm_vtu_file;

/* Reads the XML up to data that are appended. TM_ERROR_INPUT, with the line, where it is
 * no XML, or none of an unstructured grid, or ends early, or a word in it is unknown.
 * tm_vtu_file_free() also after an error. O(size). */
tm_status tm_vtu_file_read(tm_vtu_file *file, const char *bytes, size_t size,
                           const char *name, tm_error *error);
void tm_vtu_file_free(tm_vtu_file *file);

static inline const char *tm_vtu_name(const tm_vtu_file *file, const tm_vtu_entry *entry)
{
    return file->names.byte + entry->name;
}

/* The first array of a piece, or of the pieces behind it. O(log arrays). */
size_t tm_vtu_first(const tm_vtu_file *file, size_t piece);

/* The array of that name in a section of a piece, of NULL the first; or NULL. O(arrays of
 * the piece). */
const tm_vtu_entry *tm_vtu_find(const tm_vtu_file *file, size_t piece,
                                tm_vtu_section section, const char *name);

/* vtu_unpack.c ---------------------------------------------------------------------- */

/* The numbers of an array: of the text, of the file's own bytes, or of what was unpacked
 * from them, which numbers->own keeps. TM_ERROR_INPUT where they are not `count`, or the
 * array is damaged; nothing is unpacked that is not `count` numbers. `threads` unpack.
 * O(size). */
tm_status tm_vtu_numbers(const tm_vtu_file *file, const tm_vtu_entry *entry, size_t count,
                         unsigned threads, tm_numbers *numbers, tm_error *error);

/* The same of as many numbers as there are, but not more than `most`. */
tm_status tm_vtu_all(const tm_vtu_file *file, const tm_vtu_entry *entry, size_t most,
                     tm_numbers *numbers, tm_error *error);

/* TM_ERROR_INPUT at an array: "FILE:LINE: array 'NAME': what". */
tm_status tm_vtu_fail(const tm_vtu_file *file, const tm_vtu_entry *entry, tm_error *error,
                      const char *format, ...) __attribute__((format(printf, 4, 5)));

#endif
