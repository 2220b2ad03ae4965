/* SPDX-License-Identifier: GPL-3.0-or-later */
/* obj-export: the boundary of a mesh, or all its faces, as an OBJ file. */
#include "../common/export/polygon_export.h"

int main(int argc, char **argv)
{
    return polygon_export(
        argc, argv, "obj-export",
        "Writes the boundary of tetrahedra, mixed elements or polyhedra, or a\n"
        "surface, as polygons in an OBJ file.",
        false, tm_obj_write);
}
