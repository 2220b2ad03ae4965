/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two forms of meshes of the mixed-element octree mesher. */
#include "target.h"

#include "../../../lib/format/mesh_format.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    size_t materials;
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    const tm_status status =
        tm_m3d_read(&stream, (const char *)bytes, size, "file", &materials, &error);
    check_read(&stream, status, &error);
    return 0;
}
