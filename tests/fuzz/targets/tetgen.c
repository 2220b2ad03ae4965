/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The .node, .ele, .face and .edge files of TetGen. */
#include "target.h"

#include "../../../lib/format/tetgen.h"

static tm_status read_files(tm_stream *stream, const uint8_t *bytes, size_t size,
                            tm_error *error)
{
    static const char *const names[] = {".node", ".ele", ".face", ".edge"};
    tm_tetgen_nodes nodes = {.base = 1};
    tm_status status = TM_OK;
    for (size_t i = 0; status == TM_OK && (i == 0 || size > 0) && i < 4; i++) {
        const tm_text file = next_file(&bytes, &size);
        tm_block *block = tm_stream_add(stream, names[i]);
        status = tm_tetgen_read(block, file.byte, file.size, names[i], &nodes, error);
    }
    tm_block *other[3] = {tm_stream_find(stream, ".ele"), tm_stream_find(stream, ".face"),
                          tm_stream_find(stream, ".edge")};
    size_t dropped;
    if (status == TM_OK && nodes.middle)
        status = tm_tetgen_drop_middles(&nodes, tm_stream_find(stream, ".node"), other,
                                        &dropped, error);
    if (status == TM_OK && other[0])
        tm_tetgen_orient(tm_stream_find(stream, ".node"), other[0]);
    stream->base = nodes.base;
    tm_tetgen_nodes_free(&nodes);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_status status = read_files(&stream, bytes, size, &error);
    if (status != TM_OK)
        tm_stream_free(&stream);
    check_read(&stream, status, &error);
    return 0;
}
