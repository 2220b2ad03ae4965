/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "slices.h"

#include <string.h>

void tm_slices_remove(tm_slices *slices, tm_block *block)
{
    tm_stream *stream = &slices->stream;
    const size_t b = (size_t)(block - stream->block);
    memmove(slices->slice + b, slices->slice + b + 1,
            (stream->blocks - b - 1) * sizeof *slices->slice);
    tm_stream_remove(stream, block);
}
