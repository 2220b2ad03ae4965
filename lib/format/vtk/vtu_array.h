/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays of a .vtu file: elements in the XML that say where in the data, which come after
 * it, their numbers are, compressed. */
#ifndef TM_FORMAT_VTU_ARRAY_H
#define TM_FORMAT_VTU_ARRAY_H

#include "../../base/error.h"
#include "../../text/text.h"

typedef enum tm_vtu_type {
    TM_VTU_FLOAT64,
    TM_VTU_INT32,
    TM_VTU_INT64,
    TM_VTU_UINT8
} tm_vtu_type;

typedef struct tm_vtu_arrays {
    unsigned threads;
    tm_text *xml;
    tm_text data; /* what is appended */
    tm_error *error;
} tm_vtu_arrays;

/* Appends an array of `count` numbers to the data and its element to the XML. The bytes
 * are the same for any number of threads. TM_ERROR_SYSTEM where memory is out. */
tm_status tm_vtu_write_array(tm_vtu_arrays *arrays, const char *name, tm_vtu_type type,
                             size_t components, const void *numbers, size_t count);

#endif
