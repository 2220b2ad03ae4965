/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What vtk-export and vtu-export do alike: all but the writer. */
#ifndef CMD_COMMON_VTK_EXPORT_H
#define CMD_COMMON_VTK_EXPORT_H

#include "../../../lib/format/vtk/vtk.h"

#include <stdbool.h>

typedef struct vtk_exporter {
    const char *name, *purpose;
    bool binary; /* the file is no text */
    bool ranks;  /* FILE.pvtu is a file of pieces, one for each rank */
    tm_status (*write)(tm_text *text, const tm_stream *stream,
                       const tm_vtk_options *options, unsigned threads, tm_error *error);
} vtk_exporter;

/* For main() to return. */
int vtk_export(int argc, char **argv, const vtk_exporter *of);

#endif
