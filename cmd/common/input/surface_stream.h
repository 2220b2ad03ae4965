/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A surface of any format as a stream. */
#ifndef CMD_COMMON_SURFACE_STREAM_H
#define CMD_COMMON_SURFACE_STREAM_H

#include "../app/filter.h"

/* Reads FILE or standard input, as surface_input_read(), into .node and .face, with
 * .group where it has names, and the history where it is a stream. Notes what is left
 * out; exits on failure. */
void surface_stream_read(const filter *f, tm_stream *stream);

#endif
