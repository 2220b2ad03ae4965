/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the exporters of surfaces do alike: all but the writer. */
#ifndef CMD_COMMON_POLYGON_EXPORT_H
#define CMD_COMMON_POLYGON_EXPORT_H

#include "../../../lib/format/surface/surface_write.h"

/* For main() to return; `binary`: the format has files that are, for --binary. */
int polygon_export(int argc, char **argv, const char *name, const char *purpose,
                   bool binary, tm_surface_writer *write);

#endif
