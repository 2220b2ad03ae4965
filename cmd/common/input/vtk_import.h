/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What vtk-import and vtu-import do alike: all but the reader. */
#ifndef CMD_COMMON_VTK_IMPORT_H
#define CMD_COMMON_VTK_IMPORT_H

#include "../../../lib/format/vtk/vtk_read.h"

typedef tm_status vtk_reader(tm_stream *stream, const char *bytes, size_t size,
                             const char *name, const tm_vtk_read_options *options,
                             tm_vtk_read_report *report, tm_error *error);

/* For main() to return. */
int vtk_import(int argc, char **argv, const char *name, const char *purpose,
               vtk_reader *read);

#endif
