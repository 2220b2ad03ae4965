/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of octree-repair --trace. */
#ifndef CMD_COMMON_REPAIR_TRACE_FILES_H
#define CMD_COMMON_REPAIR_TRACE_FILES_H

#include "../../../lib/octree/repair/repair_state.h"
#include "../../../lib/surface/surface.h"

typedef struct repair_trace {
    const char *base;
    unsigned iteration, threads;
} repair_trace;

/* Writes BASE_i.histo, .m3d, .vtk, and, where there are octants, .oct; BASE_i.ref, with
 * the ids of `count` octants, a line each, where there are some. The surface may be NULL.
 * Each file is whole or not there. */
tm_status repair_trace_write(const repair_trace *to, const tm_repair_state *state,
                             const tm_surface *surface, const uint32_t *octant,
                             size_t count, tm_error *error);

#endif
