/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base64.h"
#include "view_parts.h"

#include "../base/array.h"
#include "../base/parallel.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { CHUNK = 1 << 18, RAW_WINDOW = -15, MEMORY_LEVEL = 8, PLANES = 4 };

typedef struct packing {
    const uint32_t *number; /* or NULL: */
    const uint8_t *byte;
    size_t count;
    size_t size; /* of the bytes that are deflated */
    tm_text *chunk;
} packing;

/* Bytes from … from + size - 1: all lowest bytes first. */
static void take_bytes(const packing *p, size_t from, size_t size, unsigned char *to)
{
    if (p->byte) {
        memcpy(to, p->byte + from, size);
        return;
    }
    for (size_t i = 0; i < size;) {
        const size_t plane = (from + i) / p->count, first = (from + i) % p->count;
        const size_t left = p->count - first, run = left < size - i ? left : size - i;
        for (size_t k = 0; k < run; k++)
            to[i + k] = (unsigned char)(p->number[first + k] >> (8 * plane));
        i += run;
    }
}

/* Deflates a chunk, which refers to no other one and ends with whole bytes. */
static void pack_chunk(void *context, size_t c)
{
    const packing *p = context;
    const size_t from = c * CHUNK;
    const size_t size = p->size - from < CHUNK ? p->size - from : CHUNK;
    tm_text *chunk = &p->chunk[c];
    unsigned char *bytes = malloc(size + 1);
    z_stream z = {0};
    chunk->failed = true;
    if (bytes && deflateInit2(&z, Z_BEST_SPEED, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL,
                              Z_DEFAULT_STRATEGY) == Z_OK) {
        const bool last = from + size == p->size;
        const size_t flush = 16;
        const size_t room = deflateBound(&z, (uLong)size) + flush;
        chunk->byte = malloc(room);
        take_bytes(p, from, size, bytes);
        z.next_in = bytes;
        z.avail_in = (uInt)size;
        z.next_out = (unsigned char *)chunk->byte;
        z.avail_out = (uInt)room;
        const int done =
            chunk->byte ? deflate(&z, last ? Z_FINISH : Z_SYNC_FLUSH) : Z_MEM_ERROR;
        chunk->failed = done != (last ? Z_STREAM_END : Z_OK) || z.avail_in > 0;
        chunk->size = room - z.avail_out;
        deflateEnd(&z);
    }
    free(bytes);
}

static void append_base64(tm_text *text, const char *bytes, size_t size)
{
    char *room = malloc(tm_base64_size(size) + 1);
    if (!room) {
        text->failed = true;
        return;
    }
    tm_base64((const unsigned char *)bytes, size, room);
    tm_text_append(text, room, tm_base64_size(size));
    free(room);
}

static void pack(view_writer *w, packing *p)
{
    const size_t chunks = p->size > 0 ? (p->size + CHUNK - 1) / CHUNK : 1;
    tm_text all = {0};
    p->chunk = calloc(chunks, sizeof *p->chunk);
    if (!p->chunk) {
        w->data->failed = true;
        return;
    }
    tm_parallel(w->threads, chunks, pack_chunk, p);
    for (size_t c = 0; c < chunks; c++) {
        all.failed |= p->chunk[c].failed;
        if (!all.failed)
            tm_text_append(&all, p->chunk[c].byte, p->chunk[c].size);
        tm_text_free(&p->chunk[c]);
    }
    free(p->chunk);
    tm_text_format(w->data, "<script type=\"text/plain\" id=\"array-%zu\">", w->arrays++);
    if (!all.failed)
        append_base64(w->data, all.byte, all.size);
    tm_text_string(w->data, "</script>\n");
    w->data->failed |= all.failed;
    tm_text_free(&all);
}

static void describe(view_writer *w, const char *key, const char *type, size_t count)
{
    tm_json_open(&w->json, key, '{');
    tm_json_integer(&w->json, "array", (int64_t)w->arrays);
    tm_json_string(&w->json, "type", type);
    tm_json_integer(&w->json, "count", (int64_t)count);
    tm_json_close(&w->json, '}');
}

void tm_view_numbers(view_writer *w, const char *key, const char *type,
                     const uint32_t *number, size_t count)
{
    describe(w, key, type, count);
    pack(w, &(packing){.number = number, .count = count, .size = PLANES * count});
}

void tm_view_bytes(view_writer *w, const char *key, const uint8_t *byte, size_t count)
{
    describe(w, key, "u8", count);
    pack(w, &(packing){.byte = byte, .count = count, .size = count});
}

uint32_t tm_view_float(double value)
{
    const float nearest = value > FLT_MAX    ? FLT_MAX
                          : value < -FLT_MAX ? -FLT_MAX
                                             : (float)value;
    uint32_t bits;
    memcpy(&bits, &nearest, sizeof bits);
    return bits;
}

uint32_t tm_view_float_rounded(double value)
{
    const uint32_t dropped = 0xff, half = 0x80, infinite = 0x7f800000;
    const uint32_t bits = tm_view_float(value), rounded = (bits + half) & ~dropped;
    return (rounded & infinite) == infinite ? bits & ~dropped : rounded;
}
