/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "input.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { MAGIC = 2, PACKED = 1 << 16 };

static const unsigned char magic[MAGIC] = {0x1f, 0x8b};

/* Members, of which a file may have several one behind the other. */
typedef struct tm_gzip {
    z_stream z;
    bool between; /* a member has ended, and no other has begun */
    unsigned char packed[PACKED];
} gzip;

void tm_input_open(tm_input *input, int fd, const char *name)
{
    *input = (tm_input){.fd = fd, .name = name, .most = SIZE_MAX};
}

void tm_input_open_part(tm_input *input, int fd, size_t most, const char *name)
{
    *input = (tm_input){.fd = fd, .name = name, .most = most, .begun = true};
}

void tm_input_open_pull(tm_input *input,
                        ptrdiff_t (*pull)(void *from, char *bytes, size_t size),
                        void *from, const char *name)
{
    *input = (tm_input){.fd = -1,
                        .name = name,
                        .most = SIZE_MAX,
                        .begun = true,
                        .pull = pull,
                        .from = from};
}

void tm_input_close(tm_input *input)
{
    if (input->gzip)
        inflateEnd(&input->gzip->z);
    free(input->gzip);
    input->gzip = NULL;
}

size_t tm_unpacked_name(const char *name)
{
    static const char suffix[] = ".gz";
    const size_t size = strlen(name), length = sizeof suffix - 1;
    return size > length && strcmp(name + size - length, suffix) == 0 ? size - length
                                                                      : size;
}

ptrdiff_t tm_read_some(int fd, char *bytes, size_t size)
{
    ssize_t got;
    do
        got = read(fd, bytes, size);
    while (got < 0 && errno == EINTR);
    return got;
}

static tm_status read_plain(tm_input *input, char *bytes, size_t size, size_t *got,
                            tm_error *error)
{
    const size_t left = input->most - input->taken;
    const size_t most = size < left ? size : left;
    const ptrdiff_t read = input->pull ? input->pull(input->from, bytes, most)
                                       : tm_read_some(input->fd, bytes, most);
    *got = read > 0 ? (size_t)read : 0;
    input->taken += *got;
    if (read >= 0)
        return TM_OK;
    return tm_fail_at(error, TM_ERROR_SYSTEM, input->name, 0, NULL, "cannot read: %s",
                      strerror(errno));
}

static tm_status fail_data(const tm_input *input, const char *what, tm_error *error)
{
    return tm_fail_at(error, TM_ERROR_INPUT, input->name, 0, NULL, "gzip data %s", what);
}

static tm_status begin_gzip(tm_input *input, const char *bytes, size_t size,
                            tm_error *error)
{
    enum { WINDOW_BITS = 15, GZIP_HEADER = 16 };
    gzip *g = calloc(1, sizeof *g);
    if (!g)
        return tm_fail_memory(error);
    if (inflateInit2(&g->z, WINDOW_BITS + GZIP_HEADER) != Z_OK) {
        free(g);
        return tm_fail_memory(error);
    }
    input->gzip = g;
    memcpy(g->packed, bytes, size);
    g->z.next_in = g->packed;
    g->z.avail_in = (uInt)size;
    return TM_OK;
}

/* Makes avail_in > 0; it stays 0 at the end of the file. */
static tm_status refill(tm_input *input, tm_error *error)
{
    size_t got;
    gzip *g = input->gzip;
    if (g->z.avail_in > 0)
        return TM_OK;
    tm_status status = read_plain(input, (char *)g->packed, PACKED, &got, error);
    g->z.next_in = g->packed;
    g->z.avail_in = (uInt)got;
    if (status == TM_OK && got == 0 && !g->between)
        status = fail_data(input, "is cut short", error);
    return status;
}

/* Behind a member there may be another one, or zeros (of a tape) up to the end. */
static tm_status next_member(tm_input *input, tm_error *error)
{
    gzip *g = input->gzip;
    bool zeros = false;
    tm_status status = refill(input, error);
    while (status == TM_OK && g->z.avail_in > 0 && *g->z.next_in == 0) {
        zeros = true;
        g->z.next_in++;
        g->z.avail_in--;
        status = refill(input, error);
    }
    if (status != TM_OK || g->z.avail_in == 0)
        return status;
    if (zeros || *g->z.next_in != magic[0])
        return fail_data(input, "ends, and something else follows", error);
    g->between = false;
    inflateReset(&g->z);
    return TM_OK;
}

static tm_status inflate_some(tm_input *input, tm_error *error)
{
    gzip *g = input->gzip;
    switch (inflate(&g->z, Z_NO_FLUSH)) {
    case Z_STREAM_END:
        g->between = true;
        return TM_OK;
    case Z_OK:
    case Z_BUF_ERROR: /* nothing could be done: more is read */
        return TM_OK;
    case Z_MEM_ERROR:
        return tm_fail_memory(error);
    default:
        return tm_fail_at(error, TM_ERROR_INPUT, input->name, 0, NULL,
                          "gzip data is damaged: %s",
                          g->z.msg ? g->z.msg : "it needs a dictionary");
    }
}

static tm_status read_gzip(tm_input *input, char *bytes, size_t size, size_t *got,
                           tm_error *error)
{
    gzip *g = input->gzip;
    const uInt room = size < PACKED ? (uInt)size : PACKED;
    tm_status status = TM_OK;
    g->z.next_out = (unsigned char *)bytes;
    g->z.avail_out = room;
    while (status == TM_OK && g->z.avail_out == room) {
        status = g->between ? next_member(input, error) : refill(input, error);
        if (status == TM_OK && g->between)
            break;
        if (status == TM_OK)
            status = inflate_some(input, error);
    }
    *got = room - g->z.avail_out;
    return status;
}

tm_status tm_input_read(tm_input *input, char *bytes, size_t size, size_t *got,
                        tm_error *error)
{
    *got = 0;
    if (input->gzip)
        return read_gzip(input, bytes, size, got, error);
    if (input->begun)
        return read_plain(input, bytes, size, got, error);
    input->begun = true;
    if (size > PACKED)
        size = PACKED; /* what is gzip data is held there */
    tm_status status = read_plain(input, bytes, size, got, error);
    for (size_t more = 1; status == TM_OK && *got < MAGIC && more > 0; *got += more)
        status = read_plain(input, bytes + *got, size - *got, &more, error);
    if (status != TM_OK || *got < MAGIC || memcmp(bytes, magic, MAGIC) != 0)
        return status;
    status = begin_gzip(input, bytes, *got, error);
    return status == TM_OK ? read_gzip(input, bytes, size, got, error) : status;
}
