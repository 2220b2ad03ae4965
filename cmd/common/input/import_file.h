/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A foreign file as bytes. */
#ifndef CMD_COMMON_IMPORT_FILE_H
#define CMD_COMMON_IMPORT_FILE_H

#include "../app/filter.h"

/* All bytes of FILE or standard input; exits on failure. */
void import_input(const filter *f, tm_text *bytes);

/* All bytes of another file. */
tm_status import_file(const char *file, tm_text *bytes, tm_error *error);

#endif
