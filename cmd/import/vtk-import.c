/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtk-import: a legacy file of VTK as a stream. */
#include "../common/input/vtk_import.h"

int main(int argc, char **argv)
{
    return vtk_import(
        argc, argv, "vtk-import",
        "Reads a legacy file of VTK (.vtk), text or binary: points, a surface,\n"
        "elements or polyhedra.",
        tm_vtk_read);
}
