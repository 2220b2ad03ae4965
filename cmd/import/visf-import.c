/* SPDX-License-Identifier: GPL-3.0-or-later */
/* visf-import: a ViSF file as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/visf.h"

static tm_status read_visf(const filter *f, tm_stream *stream, const tm_text *bytes,
                           tm_error *error)
{
    tm_polyhedra_repairs repairs;
    const char *name = filter_input_name(f);
    const tm_status status =
        tm_visf_read(stream, bytes->byte, bytes->size, name, &repairs, error);
    if (status != TM_OK)
        return status;
    if (repairs.dropped > 0)
        filter_leave_out(f, "%zu polygons of no polyhedron", repairs.dropped);
    if (repairs.turned > 0)
        filter_note(f, "%s: %zu polygons of the boundary were inward and are turned",
                    name, repairs.turned);
    filter_verbose(f, "%s: %zu polygons were there before and are joined", name,
                   repairs.joined);
    return status;
}

int main(int argc, char **argv)
{
    return mesh_import(
        argc, argv, "visf-import",
        "Reads a ViSF file, text or binary: points, a surface of triangles or\n"
        "polyhedra.",
        read_visf);
}
