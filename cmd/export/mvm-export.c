/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mvm-export: a stream as a mixed volume mesh (.mvm). */
#include "../common/input/mesh_input.h"

#include "../../lib/format/mesh_format.h"

int main(int argc, char **argv)
{
    return mesh_export(
        argc, argv, "mvm-export",
        "Writes mixed elements or tetrahedra as an .mvm mesh of the mixed-element\n"
        "octree mesher.",
        tm_mvm_write);
}
