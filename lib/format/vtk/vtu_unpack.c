/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes of arrays: of base64 (RFC 4648), and of blocks that zlib has compressed.
 *
 * Before the bytes stands how many they are; or, of compressed ones, how many blocks
 * there are, how large each is, and the last if it is smaller, else 0, then the
 * compressed size of each. In base64 these numbers may be a text of their own, padded, or
 * the beginning of that of the bytes: quadruples are decoded one by one, so that either
 * is the same. */
#include "vtu_xml.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../binary.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* The most that a byte of deflate (RFC 1951) can stand for is 258 bytes in 2 bits. */
enum { MOST_PER_BYTE = 1032 + 8, QUADRUPLE = 4, TRIPLE = 3 };

/* Where the next bytes are. */
typedef struct source {
    const tm_vtu_file *file;
    const tm_vtu_entry *entry;
    tm_error *error;
    size_t least, most; /* numbers there are to be */
    const char *at, *end;
    bool base64;
    char left[TRIPLE]; /* decoded already */
    size_t lefts;
} source;

typedef struct blocks {
    size_t count, size, last;
    const char *packed;
    size_t *begin; /* [count + 1]: in packed */
    char *to;
    int *done; /* [count]: what zlib says of each */
} blocks;

static tm_status fail(const source *s, const char *what)
{
    return tm_vtu_fail(s->file, s->entry, s->error, "%s", what);
}

/* Base64 ---------------------------------------------------------------------------- */

/* The value of a letter, -1 of others. */
static int value_of(char letter)
{
    if (letter >= 'A' && letter <= 'Z')
        return letter - 'A';
    if (letter >= 'a' && letter <= 'z')
        return letter - 'a' + 26;
    if (letter >= '0' && letter <= '9')
        return letter - '0' + 52;
    return letter == '+' ? 62 : letter == '/' ? 63 : -1;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static void skip_blanks(source *s)
{
    while (s->at < s->end && is_blank(*s->at))
        s->at++;
}

/* The next quadruple into `left`; false where there is none, or it is wrong. */
static bool decode(source *s)
{
    unsigned bits = 0;
    size_t letters = 0, pads = 0;
    for (size_t i = 0; i < QUADRUPLE; i++) {
        skip_blanks(s);
        if (s->at == s->end)
            return false;
        const int value = value_of(*s->at);
        if (value < 0 && (*s->at != '=' || letters < 2))
            return false;
        if (value >= 0 && pads > 0)
            return false;
        pads += value < 0;
        letters += value >= 0;
        bits = bits << 6 | (unsigned)(value < 0 ? 0 : value);
        s->at++;
    }
    s->left[0] = (char)(bits >> 16);
    s->left[1] = (char)(bits >> 8 & UCHAR_MAX);
    s->left[2] = (char)(bits & UCHAR_MAX);
    s->lefts = TRIPLE - pads;
    return true;
}

static tm_status decode_all(source *s, char *to, size_t size)
{
    size_t done = 0;
    for (;;) {
        const size_t take = s->lefts < size - done ? s->lefts : size - done;
        memcpy(to + done, s->left, take);
        memmove(s->left, s->left + take, s->lefts - take);
        s->lefts -= take;
        done += take;
        if (done == size)
            return TM_OK;
        if (!decode(s))
            return fail(s, s->at == s->end ? "is cut short" : "is no base64");
    }
}

/* Bytes ----------------------------------------------------------------------------- */

/* Whether there may be so many more: before memory is taken for them. */
static bool may_hold(const source *s, size_t size)
{
    const size_t left = (size_t)(s->end - s->at);
    return size <= (s->base64 ? left / QUADRUPLE * TRIPLE + TRIPLE + s->lefts : left);
}

/* The next bytes: the file's own, or decoded into room. */
static tm_status take(source *s, size_t size, tm_text *room, const char **bytes)
{
    if (!may_hold(s, size))
        return fail(s, "is cut short, or what it says of its size is wrong");
    if (!s->base64) {
        *bytes = s->at;
        s->at += size;
        return TM_OK;
    }
    if (!tm_text_room(room, size + 1))
        return tm_fail_memory(s->error);
    *bytes = room->byte;
    return decode_all(s, room->byte, size);
}

static tm_status take_number(source *s, size_t *number)
{
    char room[sizeof(uint64_t)] = {0};
    const char *bytes = s->at;
    const size_t size = s->file->header;
    tm_status status = TM_OK;
    if (!may_hold(s, size))
        return fail(s, "is cut short");
    if (s->base64) {
        status = decode_all(s, room, size);
        bytes = room;
    } else {
        s->at += size;
    }
    if (status == TM_OK)
        *number = (size_t)tm_binary_unsigned(bytes, size, s->file->big);
    return status;
}

static tm_status find_source(source *s)
{
    const tm_vtu_file *file = s->file;
    const tm_vtu_entry *entry = s->entry;
    s->at = entry->begin;
    s->end = entry->end;
    s->base64 = entry->form != TM_VTU_APPENDED || file->appended_base64;
    if (entry->form != TM_VTU_APPENDED)
        return TM_OK;
    if (!file->appended)
        return fail(s, "is in the appended data, but there are none");
    const size_t size = (size_t)(file->appended_end - file->appended);
    if (entry->offset > size)
        return fail(s, "its offset is behind the end of the appended data");
    s->at = file->appended + entry->offset;
    s->end = file->appended_end;
    return TM_OK;
}

/* zlib ------------------------------------------------------------------------------ */

static size_t size_of_block(const blocks *b, size_t i)
{
    return i + 1 == b->count && b->last > 0 ? b->last : b->size;
}

static void inflate_block(void *context, size_t i)
{
    const blocks *b = context;
    const size_t size = size_of_block(b, i);
    uLongf got = (uLongf)size;
    const int done = uncompress((unsigned char *)b->to + i * b->size, &got,
                                (const unsigned char *)b->packed + b->begin[i],
                                (uLong)(b->begin[i + 1] - b->begin[i]));
    b->done[i] = done == Z_OK && got != size ? Z_DATA_ERROR : done;
}

/* How many blocks there are, of what sizes; *total is what they unpack to. */
static tm_status take_sizes(source *s, blocks *b, size_t *total)
{
    tm_status status = take_number(s, &b->count);
    *total = 0;
    if (status != TM_OK || b->count == 0)
        return status;
    status = take_number(s, &b->size);
    if (status == TM_OK)
        status = take_number(s, &b->last);
    if (status != TM_OK)
        return status;
    const bool is_wrong = !may_hold(s, b->count) || b->last > b->size ||
                          __builtin_mul_overflow(b->count, b->size, total);
    if (is_wrong)
        return fail(s, "what it says of its blocks is wrong");
    if (b->last > 0)
        *total -= b->size - b->last;
    b->begin = tm_new(b->count + 1, sizeof *b->begin);
    b->done = tm_new(b->count, sizeof *b->done);
    if (!b->begin || !b->done)
        return tm_fail_memory(s->error);
    b->begin[0] = 0;
    for (size_t i = 0; i < b->count && status == TM_OK; i++) {
        size_t size = 0;
        status = take_number(s, &size);
        if (status == TM_OK &&
            __builtin_add_overflow(b->begin[i], size, &b->begin[i + 1]))
            status = fail(s, "what it says of its blocks is wrong");
    }
    return status;
}

static tm_status inflate_all(source *s, blocks *b, size_t total, unsigned threads,
                             tm_numbers *numbers)
{
    tm_text packed = {0};
    const size_t size = b->begin[b->count];
    if (total / MOST_PER_BYTE > size)
        return fail(s, "its blocks are too small for what they should hold");
    tm_status status = take(s, size, &packed, &b->packed);
    if (status == TM_OK && !tm_text_room(&numbers->own, total))
        status = tm_fail_memory(s->error);
    if (status == TM_OK) {
        b->to = numbers->own.byte;
        tm_parallel(threads, b->count, inflate_block, b);
        for (size_t i = 0; i < b->count && status == TM_OK; i++)
            if (b->done[i] != Z_OK)
                status = b->done[i] == Z_MEM_ERROR
                             ? tm_fail_memory(s->error)
                             : fail(s, "a compressed block is damaged");
    }
    numbers->own.size = total;
    numbers->bytes = numbers->own.byte;
    tm_text_free(&packed);
    return status;
}

/* Not fewer than `least` numbers and not more than `most`. */
static tm_status check_size(const source *s, size_t size)
{
    const size_t number = tm_number_size(s->entry->type), count = size / number;
    if (size % number == 0 && count >= s->least && count <= s->most)
        return TM_OK;
    return tm_vtu_fail(s->file, s->entry, s->error,
                       "holds %zu numbers (%zu would be right; or is the file's "
                       "header_type or byte_order another one than it says?)",
                       count, s->most);
}

static tm_status unpack(source *s, unsigned threads, tm_numbers *numbers, size_t *size)
{
    blocks b = {0};
    tm_status status;
    if (!s->file->packed) {
        status = take_number(s, size);
        if (status == TM_OK)
            status = check_size(s, *size);
        return status == TM_OK ? take(s, *size, &numbers->own, &numbers->bytes) : status;
    }
    status = take_sizes(s, &b, size);
    if (status == TM_OK)
        status = check_size(s, *size);
    if (status == TM_OK && b.count > 0)
        status = inflate_all(s, &b, *size, threads, numbers);
    free(b.begin);
    free(b.done);
    return status;
}

/* Of an array within the XML nothing is left. */
static tm_status check_end(source *s)
{
    skip_blanks(s);
    if (s->entry->form == TM_VTU_APPENDED || (s->at == s->end && s->lefts == 0))
        return TM_OK;
    return fail(s, "has more bytes than it says");
}

/* Text ------------------------------------------------------------------------------ */

static tm_status scan_text(source *s, tm_numbers *numbers)
{
    tm_scan scan = {s->entry->begin, s->entry->end, s->file->name, s->entry->line, '\0'};
    size_t count = s->most;
    if (s->least < s->most) {
        tm_scan counter = scan;
        for (count = 0; tm_scan_seek(&counter); count++)
            tm_scan_word(&counter);
    }
    char what[sizeof((tm_error *)NULL)->block];
    snprintf(what, sizeof what, "a number of '%.40s'", tm_vtu_name(s->file, s->entry));
    tm_status status =
        tm_numbers_scan(numbers, &scan, s->entry->type, count, what, s->error);
    if (status == TM_OK && tm_scan_seek(&scan))
        status = tm_scan_fail(&scan, s->error, "array '%.60s' has more than %zu numbers",
                              tm_vtu_name(s->file, s->entry), count);
    return status;
}

/* ------------------------------------------------------------------------------------ */

static tm_status read_numbers(source *s, unsigned threads, tm_numbers *numbers)
{
    const size_t number = tm_number_size(s->entry->type);
    size_t size = 0;
    *numbers = (tm_numbers){0};
    if (s->most == 0)
        return TM_OK;
    if (s->entry->form == TM_VTU_ASCII)
        return scan_text(s, numbers);
    if (s->most > SIZE_MAX / number)
        return fail(s, "has more numbers than memory can hold");
    tm_status status = find_source(s);
    if (status == TM_OK)
        status = unpack(s, threads, numbers, &size);
    if (status == TM_OK)
        status = check_end(s);
    numbers->count = size / number;
    numbers->type = s->entry->type;
    numbers->big = s->file->big;
    return status;
}

tm_status tm_vtu_numbers(const tm_vtu_file *file, const tm_vtu_entry *entry, size_t count,
                         unsigned threads, tm_numbers *numbers, tm_error *error)
{
    enum { BITS = 8 };
    const bool bits = entry->bits && entry->form != TM_VTU_ASCII;
    const size_t items = bits ? count / BITS + (count % BITS != 0) : count;
    source s = {
        .file = file, .entry = entry, .error = error, .least = items, .most = items};
    const tm_status status = read_numbers(&s, threads, numbers);
    return status == TM_OK && bits
               ? tm_numbers_of_bits(numbers, numbers->bytes, count, error)
               : status;
}

tm_status tm_vtu_all(const tm_vtu_file *file, const tm_vtu_entry *entry, size_t most,
                     tm_numbers *numbers, tm_error *error)
{
    source s = {.file = file, .entry = entry, .error = error, .most = most};
    return read_numbers(&s, 1, numbers);
}
