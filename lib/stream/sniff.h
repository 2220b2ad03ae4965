/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one table of what files look like and which filter reads them; a filter that reads
 * a new format gets its row in sniff.c. */
#ifndef TM_STREAM_SNIFF_H
#define TM_STREAM_SNIFF_H

#include "../base/extern_c.h"

#include <stddef.h>

TM_EXTERN_C_BEGIN

typedef struct tm_look {
    const char *what;   /* "an OFF surface"; never NULL */
    const char *advice; /* "use visf-import", "no filter reads it yet";
                         * NULL where it could be anything */
} tm_look;

/* What a file looks like by its first bytes, which need not be all. */
tm_look tm_look_at(const char *bytes, size_t size);

/* The size of the byte order mark of UTF-8 that the bytes begin with, or 0. */
size_t tm_byte_order_mark(const char *bytes, size_t size);

TM_EXTERN_C_END

#endif
