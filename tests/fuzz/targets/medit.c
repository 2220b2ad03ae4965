/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of Medit, and their solutions. */
#include "target.h"

#include "../../../lib/format/medit/medit.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_medit_report report;
    tm_error error = {.status = TM_OK};
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_text file = next_file(&bytes, &size);
    const tm_medit_bytes mesh = {"mesh", file.byte, file.size};
    const tm_medit_bytes solution = {"solution", (const char *)bytes, size};
    const tm_status status =
        tm_medit_read(&stream, &mesh, size > 0 ? &solution : NULL, &report, &error);
    check_read(&stream, status, &error);
    tm_medit_report_free(&report);
    return 0;
}
