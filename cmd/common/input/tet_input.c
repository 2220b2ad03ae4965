/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_input.h"

void tet_mesh_note(const filter *f, const tm_tet_mesh *mesh)
{
    if (mesh->turned)
        filter_note(f, "%zu tetrahedra were left-handed and are turned", mesh->turned);
    if (mesh->flat)
        filter_note(f, "%zu tetrahedra are flat", mesh->flat);
    if (mesh->dropped_faces)
        filter_note(f, "%zu inner faces without marker are dropped from .face",
                    mesh->dropped_faces);
    if (mesh->dangling)
        filter_note(f, "%zu rows of .face are no face of a tetrahedron; they stay",
                    mesh->dangling);
    if (mesh->locked.count)
        filter_note(f, "%zu edges where the mesh only touches itself are left alone",
                    mesh->locked.count);
}

void tet_mesh_from_stream(const filter *f, tm_stream *stream, tm_tet_mesh *mesh)
{
    tm_error error;
    filter_stage(f, "finding neighbours");
    if (tm_tet_mesh_from_stream(mesh, stream, f->threads, &error) != TM_OK) {
        snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
        filter_fail(f, &error);
    }
    tet_mesh_note(f, mesh);
}

static bool is_unknown(const tm_block *block, const void *context)
{
    (void)context;
    return block->kind == TM_UNKNOWN && block->name[0] == '.';
}

void drop_unknown_blocks(const filter *f, tm_stream *stream, const char *why)
{
    for (size_t b = stream->blocks; b > 0; b--)
        if (is_unknown(&stream->block[b - 1], NULL))
            filter_leave_out(f, "the block %s, as %s", stream->block[b - 1].name, why);
    tm_stream_remove_if(stream, is_unknown, NULL);
}
