/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What targets have in common. A target is given bytes by a fuzzer, LLVM's libFuzzer, and
 * ends with abort() where something is not as it should be. */
#ifndef TESTS_FUZZ_TARGET_H
#define TESTS_FUZZ_TARGET_H

#include "bytes.h"

#include "../stream_checks.h"

#include <stdbool.h>

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

/* A reader either says what is wrong, and leaves the stream empty, or makes one that is
 * sound. */
static inline void check_read(tm_stream *stream, tm_status status, const tm_error *error)
{
    if (status == TM_OK) {
        check_stream(stream);
        return;
    }
    require(status == TM_ERROR_INPUT && error->status == status && error->what[0],
            "not read, but no reason");
    require(stream->blocks == 0, "not read, but something is left");
    tm_stream_free(stream);
}

/* Several files in one input stand between form feeds: cuts the next one off. */
static inline tm_text next_file(const uint8_t **bytes, size_t *size)
{
    tm_text file = {.byte = (char *)(uintptr_t)*bytes};
    while (file.size < *size && file.byte[file.size] != '\f')
        file.size++;
    const size_t taken = file.size + (file.size < *size);
    *bytes += taken;
    *size -= taken;
    return file;
}

#endif
