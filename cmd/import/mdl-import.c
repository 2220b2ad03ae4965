/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mdl-import: an .mdl surface as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/surface/surface_format.h"
#include "../../lib/surface/polygon_surface.h"

static tm_status read_mdl(const filter *f, tm_stream *stream, const tm_text *bytes,
                          tm_error *error)
{
    tm_polygon_surface surface;
    tm_polygon_surface_init(&surface);
    tm_status status =
        tm_mdl_read(&surface, bytes->byte, bytes->size, filter_input_name(f), error);
    if (status == TM_OK)
        status = tm_polygon_surface_to_stream(&surface, stream, "", error);
    stream->base = 0;
    tm_polygon_surface_free(&surface);
    return status;
}

int main(int argc, char **argv)
{
    return mesh_import(argc, argv, "mdl-import",
                       "Reads an .mdl surface of the mixed-element octree mesher.",
                       read_mdl);
}
