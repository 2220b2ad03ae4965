/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which kinds of mesh each filter takes: the one table of them. */
#ifndef CMD_COMMON_KINDS_H
#define CMD_COMMON_KINDS_H

#include "../../../lib/base/error.h"
#include "../../../lib/mesh/cell_faces.h"

/* Whether the filter takes what the stream holds; else TM_ERROR_INPUT says what that is
 * and which filters take it. A filter that is not in the table takes anything. */
tm_status kinds_check(const char *filter, const tm_stream *stream, const char *file,
                      tm_error *error);

#endif
