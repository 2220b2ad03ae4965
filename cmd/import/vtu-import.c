/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtu-import: an unstructured grid of VTK as a stream. */
#include "../common/input/vtk_import.h"

int main(int argc, char **argv)
{
    return vtk_import(
        argc, argv, "vtu-import",
        "Reads an unstructured grid of VTK (.vtu): points, a surface, elements "
        "or\npolyhedra.",
        tm_vtu_read);
}
