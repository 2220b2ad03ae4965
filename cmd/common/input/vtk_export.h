/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What vtk-export and vtu-export do alike: all but the writer. */
#ifndef CMD_COMMON_VTK_EXPORT_H
#define CMD_COMMON_VTK_EXPORT_H

#include "../../../lib/format/vtk/vtk.h"

typedef tm_status vtk_writer(tm_text *text, const tm_stream *stream,
                             const tm_vtk_options *options, unsigned threads,
                             tm_error *error);

/* For main() to return; `binary`: the file is no text. */
int vtk_export(int argc, char **argv, const char *name, const char *purpose, bool binary,
               vtk_writer *write);

#endif
