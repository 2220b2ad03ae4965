/* SPDX-License-Identifier: GPL-3.0-or-later */
/* m3d-import: a mesh of the mixed-element octree mesher as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"

static tm_status read_m3d(const filter *f, tm_stream *stream, const tm_text *bytes,
                          tm_error *error)
{
    size_t materials = 0;
    const tm_status status = tm_m3d_read(stream, bytes->byte, bytes->size,
                                         filter_input_name(f), &materials, error);
    if (status == TM_OK)
        mesh_leave_out_materials(f, materials);
    return status;
}

int main(int argc, char **argv)
{
    return mesh_import(argc, argv, "m3d-import",
                       "Reads an .m3d or .mvm mesh of the mixed-element octree mesher.",
                       read_m3d);
}
