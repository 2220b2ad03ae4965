/* SPDX-License-Identifier: GPL-3.0-or-later */
/* getfem-export: a stream as a mesh file of the finite element library GetFEM. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"

int main(int argc, char **argv)
{
    return mesh_export(
        argc, argv, "getfem-export",
        "Writes mixed elements, tetrahedra or triangles as a mesh file of the finite\n"
        "element library GetFEM.",
        tm_getfem_write);
}
