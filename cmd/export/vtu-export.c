/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtu-export: a stream as an unstructured grid of VTK. */
#include "../common/export/vtk_export.h"

int main(int argc, char **argv)
{
    const vtk_exporter exporter = {
        .name = "vtu-export",
        .purpose =
            "Writes points, triangles, tetrahedra, mixed elements or polyhedra as\n"
            "an unstructured grid of VTK (.vtu), which ParaView shows; to FILE.pvtu\n"
            "in pieces, one for each rank of a launcher.",
        .binary = true,
        .ranks = true,
        .write = tm_vtu_write};
    return vtk_export(argc, argv, &exporter);
}
