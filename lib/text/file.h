/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes from and to file descriptors, complete and checked. */
#ifndef TM_TEXT_FILE_H
#define TM_TEXT_FILE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "text.h"

TM_EXTERN_C_BEGIN

/* Appends all that is left to read to *text, of gzip data what is in them (input.h).
 * `name` is for the message. TM_ERROR_SYSTEM where reading fails or memory is out,
 * TM_ERROR_INPUT where gzip data is damaged. */
tm_status tm_read_all(int fd, const char *name, tm_text *text, tm_error *error);

/* Writes all bytes. TM_ERROR_SYSTEM with errno's message where that fails. */
tm_status tm_write_all(int fd, const char *bytes, size_t size, tm_error *error);

/* The same of a text; where that has failed, as for memory that is out. */
tm_status tm_write_text(int fd, const tm_text *text, tm_error *error);

TM_EXTERN_C_END

#endif
