/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Legacy files of VTK. */
#include "target.h"

#include "../../../lib/format/vtk/vtk_read.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    static const tm_vtk_read_options options = {.threads = 1};
    tm_vtk_read_report report;
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_status status = tm_vtk_read(&stream, (const char *)bytes, size, "file",
                                         &options, &report, &error);
    check_read(&stream, status, &error);
    tm_vtk_read_report_free(&report);
    return 0;
}
