/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vtu-import: an unstructured grid of VTK as a stream. */
#include "../common/input/vtk_import.h"

int main(int argc, char **argv)
{
    return vtk_import(
        argc, argv, "vtu-import",
        "Reads an unstructured grid of VTK (.vtu, .pvtu): points, a surface,\nelements "
        "or polyhedra.",
        tm_vtu_read);
}
