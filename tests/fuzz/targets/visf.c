/* SPDX-License-Identifier: GPL-3.0-or-later */
/* ViSF, text and binary. */
#include "target.h"

#include "../../../lib/format/visf.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    tm_polyhedra_repairs repairs;
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_status status =
        tm_visf_read(&stream, (const char *)bytes, size, "file", &repairs, &error);
    check_read(&stream, status, &error);
    return 0;
}
