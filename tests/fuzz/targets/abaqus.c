/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Input files of Abaqus and CalculiX. */
#include "target.h"

#include "../../../lib/format/abaqus/abaqus.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    tm_abaqus_report report;
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_status status =
        tm_abaqus_read(&stream, (const char *)bytes, size, "file", &report, &error);
    check_read(&stream, status, &error);
    tm_abaqus_report_free(&report);
    return 0;
}
