/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ply-export: the boundary of a mesh, or all its faces, as a PLY file. */
#include "../common/export/polygon_export.h"

int main(int argc, char **argv)
{
    return polygon_export(
        argc, argv, "ply-export",
        "Writes the boundary of tetrahedra, mixed elements or polyhedra, or a\n"
        "surface, as polygons in a PLY file.",
        true, tm_ply_write);
}
