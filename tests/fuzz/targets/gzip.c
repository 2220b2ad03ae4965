/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packed input, read in pieces of many sizes: always the same bytes. */
#include "target.h"

#include "../../../lib/text/file.h"
#include "../../../lib/text/input.h"

static tm_status read_pieces(int fd, tm_text *text, size_t piece, tm_error *error)
{
    enum { MOST = 64 };
    tm_input input;
    char bytes[MOST];
    size_t got = 1;
    tm_status status = TM_OK;
    tm_input_open(&input, fd, "file");
    while (status == TM_OK && got > 0) {
        status = tm_input_read(&input, bytes, piece, &got, error);
        if (status == TM_OK)
            tm_text_append(text, bytes, got);
    }
    tm_input_close(&input);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_text whole = {0}, pieces = {0};
    tm_error error;
    if (size < 1)
        return 0;
    const int fd = memfd_create("fuzz", MFD_CLOEXEC);
    if (fd < 0 || write(fd, bytes + 1, size - 1) != (ssize_t)size - 1)
        give_up("memfd_create");
    lseek(fd, 0, SEEK_SET);
    const tm_status status = tm_read_all(fd, "file", &whole, &error);
    require(status == TM_OK || (status == TM_ERROR_INPUT && error.what[0]),
            "not read, but no reason");
    lseek(fd, 0, SEEK_SET);
    require(read_pieces(fd, &pieces, 2 + bytes[0] % 60, &error) == status,
            "in pieces it is read otherwise");
    if (status == TM_OK)
        require(whole.size == pieces.size &&
                    (whole.size == 0 || memcmp(whole.byte, pieces.byte, whole.size) == 0),
                "in pieces it is other bytes");
    tm_text_free(&whole);
    tm_text_free(&pieces);
    close(fd);
    return 0;
}
