/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef TM_STREAM_SNIFF_H
#define TM_STREAM_SNIFF_H

#include <stddef.h>

/* What a file that is no termesh stream looks like, by its first bytes, and what reads
 * it: "a TetGen .node file: use tetgen-import". Never NULL. */
const char *tm_looks_like(const char *bytes, size_t size);

#endif
