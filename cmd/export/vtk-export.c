/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtk-export: a stream as an unstructured grid in a legacy text file of VTK. */
#include "../common/export/vtk_export.h"

int main(int argc, char **argv)
{
    const vtk_exporter exporter = {
        .name = "vtk-export",
        .purpose =
            "Writes points, triangles, tetrahedra, mixed elements or polyhedra as an\n"
            "unstructured grid in a legacy text file of VTK (.vtk).",
        .write = tm_vtk_write};
    return vtk_export(argc, argv, &exporter);
}
