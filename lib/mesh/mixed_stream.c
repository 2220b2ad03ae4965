/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_stream.h"

#include <stdlib.h>

/* Moves an array from one owner to another. */
#define MOVE(to, from) ((to) = (void *)(from), (from) = NULL)

/* No element has a node twice. */
static tm_status check(const tm_mixed_mesh *mesh, unsigned base, tm_error *error)
{
    for (size_t e = 0; e < mesh->elements; e++)
        if (tm_has_node_twice(mesh->item + mesh->start[e],
                              mesh->start[e + 1] - mesh->start[e]))
            return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, ".mix",
                              "element %zu names a node twice", e + base);
    return TM_OK;
}

tm_status tm_mixed_mesh_from_stream(tm_mixed_mesh *mesh, tm_stream *stream,
                                    tm_error *error)
{
    *mesh = (tm_mixed_mesh){0};
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *mix = tm_stream_find(stream, ".mix");
    if (node) {
        MOVE(mesh->xyz, node->real);
        mesh->nodes = node->count;
    }
    if (mix) {
        MOVE(mesh->start, mix->start);
        MOVE(mesh->item, mix->item);
        mesh->elements = mix->count;
    }
    if (!mesh->start) {
        mesh->start = calloc(1, sizeof *mesh->start);
        if (!mesh->start)
            return tm_fail_memory(error);
    }
    return check(mesh, stream->base, error);
}
