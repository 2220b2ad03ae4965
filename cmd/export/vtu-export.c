/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtu-export: a stream as an unstructured grid of VTK. */
#include "../common/input/vtk_export.h"

int main(int argc, char **argv)
{
    return vtk_export(
        argc, argv, "vtu-export",
        "Writes points, triangles, tetrahedra, mixed elements or polyhedra as\n"
        "an unstructured grid of VTK (.vtu), which ParaView shows.",
        true, tm_vtu_write);
}
