/* SPDX-License-Identifier: GPL-3.0-or-later */
/* off-export: the boundary of a mesh, or all its faces, as an OFF file. */
#include "../common/export/polygon_export.h"

int main(int argc, char **argv)
{
    return polygon_export(
        argc, argv, "off-export",
        "Writes the boundary of tetrahedra, mixed elements or polyhedra, or a\n"
        "surface, as polygons in an OFF file.",
        false, tm_off_write);
}
