/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Restart files of the mixed-element octree mesher, read and written again. */
#include "target.h"

#include "../../../lib/format/oct.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_oct oct;
    tm_stream stream;
    tm_text text = {0};
    tm_error error = {.status = TM_OK};
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    tm_status status = tm_oct_read(&oct, (const char *)bytes, size, "file", &error);
    if (status == TM_OK)
        status = tm_oct_to_stream(&oct, &stream, "file", &error);
    if (status == TM_OK) {
        const tm_block *octant = tm_stream_find(&stream, ".octant");
        status = tm_oct_write(&text, &stream, octant->attributes > 0, 1, &error);
        require(status == TM_OK || status == TM_ERROR_INPUT, "not written");
        tm_text_free(&text);
        check_stream(&stream);
    } else {
        require(status == TM_ERROR_INPUT && error.what[0], "not read, but no reason");
    }
    tm_stream_free(&stream);
    tm_oct_free(&oct);
    return 0;
}
