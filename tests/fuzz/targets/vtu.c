/* SPDX-License-Identifier: GPL-3.0-or-later */
/* XML files of VTK: one, or a list of pieces and their files, between form feeds. */
#include "target.h"

#include "../../../lib/format/vtk/vtk_read.h"

typedef struct rest {
    const uint8_t *bytes;
    size_t size;
} rest;

static tm_status load_next(void *context, const char *source, tm_text *name,
                           tm_text *bytes, tm_error *error)
{
    rest *left = context;
    const tm_text file = next_file(&left->bytes, &left->size);
    tm_text_string(name, source);
    tm_text_append(bytes, file.byte, file.size);
    return name->failed || bytes->failed ? tm_fail_memory(error) : TM_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_error error = {.status = TM_OK};
    rest left = {bytes, size};
    const tm_vtk_read_options options = {
        .threads = 1, .load = load_next, .context = &left};
    tm_vtk_read_report report;
    bytes_start(bytes, size);
    tm_stream_init(&stream);
    tm_text file = {.byte = (char *)(uintptr_t)bytes, .size = size};
    if (size > 0 && memmem(bytes, size, "PUnstructuredGrid", 17))
        file = next_file(&left.bytes, &left.size);
    const tm_status status =
        tm_vtu_read(&stream, file.byte, file.size, "file", &options, &report, &error);
    check_read(&stream, status, &error);
    tm_vtk_read_report_free(&report);
    return 0;
}
