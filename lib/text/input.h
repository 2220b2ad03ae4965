/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is to be read of a file descriptor: its bytes or, where they are gzip data (RFC
 * 1952: they begin with 1f 8b), what is packed in them, as zcat prints it. */
#ifndef TM_TEXT_INPUT_H
#define TM_TEXT_INPUT_H

#include "../base/error.h"
#include "../base/extern_c.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef struct tm_input {
    int fd;
    const char *name;
    struct tm_gzip *gzip; /* NULL where the bytes are as they are */
    bool begun;
    size_t taken; /* bytes of the descriptor, so far */
    size_t most;  /* so many are taken at most */
    ptrdiff_t (*pull)(void *from, char *bytes, size_t size);
    void *from;
} tm_input;

/* Reads at most size bytes, again after an interrupt. Returns how many, 0 at the end;
 * on failure -1 with errno. */
ptrdiff_t tm_read_some(int fd, char *bytes, size_t size);

/* Nothing is read yet. The descriptor stays the caller's, and so does the name, which is
 * for messages. */
void tm_input_open(tm_input *input, int fd, const char *name);
void tm_input_close(tm_input *input);

/* The same of the next `most` bytes of the descriptor as they are; and of what a function
 * gives, as tm_read_some() does. */
void tm_input_open_part(tm_input *input, int fd, size_t most, const char *name);
void tm_input_open_pull(tm_input *input,
                        ptrdiff_t (*pull)(void *from, char *bytes, size_t size),
                        void *from, const char *name);

/* The length of a file's name, without .gz at its end. */
size_t tm_unpacked_name(const char *name);

/* Reads at most `size` bytes, 2 or more, to `bytes`; bytes that are not packed go there
 * from the descriptor. *got is how many, 0 at the end. TM_ERROR_INPUT where gzip data are
 * damaged or cut short, or something else follows them; TM_ERROR_SYSTEM where the
 * descriptor cannot be read. */
tm_status tm_input_read(tm_input *input, char *bytes, size_t size, size_t *got,
                        tm_error *error);

TM_EXTERN_C_END

#endif
