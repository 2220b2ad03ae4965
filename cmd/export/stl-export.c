/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stl-export: the boundary of a mesh, or all its faces, as an STL file. */
#include "../common/export/polygon_export.h"

int main(int argc, char **argv)
{
    return polygon_export(
        argc, argv, "stl-export",
        "Writes the boundary of tetrahedra, mixed elements or polyhedra, or a\n"
        "surface, as triangles in an STL file.",
        true, tm_stl_write);
}
