/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formats of meshes that Gmsh's library (4.8) reads. */
#ifndef CMD_COMMON_GMSH_FORMATS_H
#define CMD_COMMON_GMSH_FORMATS_H

#include "../../../lib/base/error.h"
#include "../../../lib/text/text.h"

#include <stdbool.h>

/* By their names, which are their main suffixes, too. */
typedef enum gmsh_input {
    GMSH_MSH,
    GMSH_MEDIT,
    GMSH_UNV,
    GMSH_VTK,
    GMSH_MED,
    GMSH_BDF,
    GMSH_CGNS,
    GMSH_STL,
    GMSH_PLY,
    GMSH_PLY2,
    GMSH_WRL,
    GMSH_INPUTS
} gmsh_input;
extern const char *const gmsh_input_name[GMSH_INPUTS];

/* A file that is open, and what it begins and ends with. */
typedef struct gmsh_file {
    int fd;
    size_t size;
    tm_text head, tail; /* up to GMSH_PEEK bytes */
} gmsh_file;
enum { GMSH_PEEK = 4096 };

/* Looks at a regular file, or one in memory. TM_ERROR_SYSTEM where it cannot be read. */
tm_status gmsh_file_look(gmsh_file *file, int fd, const char *name, tm_error *error);
void gmsh_file_free(gmsh_file *file);

/* The format of a file by its suffix, of NAME.gz that of NAME, or else by its first
 * bytes; GMSH_INPUTS where neither tells. `name` may be NULL. */
gmsh_input gmsh_input_of(const char *name, const gmsh_file *file);

/* Whether the file can be of that format: what Gmsh does not know for a mesh it may run
 * as a script, and part of a file it may take for the whole. TM_ERROR_INPUT says what is
 * wrong. */
tm_status gmsh_input_check(gmsh_input format, const gmsh_file *file, const char *name,
                           tm_error *error);

/* Whether a .msh file is of a version before 4. */
bool gmsh_input_is_old(const gmsh_file *file);

#endif
