/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stream. */
#include "target.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    bytes_start(bytes, size);
    check_bytes((const char *)bytes, size);
    return 0;
}
