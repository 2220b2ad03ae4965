/* SPDX-License-Identifier: GPL-3.0-or-later */
/* m3d-export: a stream as a mesh of the mixed-element octree mesher (.m3d). */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"

int main(int argc, char **argv)
{
    return mesh_export(
        argc, argv, "m3d-export",
        "Writes mixed elements or tetrahedra as an .m3d mesh of the mixed-element\n"
        "octree mesher.",
        tm_m3d_write);
}
