/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files that octree-repair --trace leaves of each iteration. */
#ifndef CMD_COMMON_REPAIR_FILES_H
#define CMD_COMMON_REPAIR_FILES_H

#include "../../../lib/surface/surface.h"
#include "../../../lib/octree/repair/repair_state.h"

/* Writes BASE_i.histo, .m3d, .vtk, and, where there are octants, .oct; BASE_i.ref, with
 * the numbers of `count` octants from 0, a line each, where there are some. Each is whole
 * or not there. */
tm_status repair_files_write(const char *base, unsigned iteration,
                             const tm_repair_state *state, const tm_surface *surface,
                             const uint32_t *octant, size_t count, unsigned threads,
                             tm_error *error);

#endif
