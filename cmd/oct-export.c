/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oct-export: the octants of a stream as a restart file of the octree mesher. */
#include "common/input/mesh_input.h"

#include "../lib/format/oct.h"

int main(int argc, char **argv)
{
    return mesh_export(
        argc, argv, "oct-export",
        "Writes the octants of a stream as an .oct restart file of the mixed-element\n"
        "octree mesher.",
        tm_oct_write);
}
