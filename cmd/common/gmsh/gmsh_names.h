/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What Gmsh does to the names of groups in a format that it writes, without a word. */
#ifndef CMD_COMMON_GMSH_NAMES_H
#define CMD_COMMON_GMSH_NAMES_H

#include "gmsh_write.h"

enum { GMSH_NAME_MOST = 128 }; /* bytes of a name in .msh */

/* How many names of the groups that are written come to grief. */
typedef struct gmsh_lost_names {
    size_t cut;     /* are longer than .msh has room for */
    size_t joined;  /* are another group's, too, once they are written */
    size_t swapped; /* .unv: a group of a higher dimension has the number, and Gmsh reads
                       the name of that for both */
} gmsh_lost_names;

/* Counts them; names are those of the dimensions that the format has. TM_ERROR_SYSTEM
 * where memory is out. O(n log n) in the number of groups. */
tm_status gmsh_find_lost_names(gmsh_lost_names *lost, const gmsh_plan *plan,
                               gmsh_output format, tm_error *error);

#endif
