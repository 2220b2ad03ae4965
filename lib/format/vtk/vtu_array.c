/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtu_array.h"

#include "../../base/parallel.h"
#include "../binary.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { BLOCK_BYTES = 1 << 17, HEADER_BYTES = 8 };

static const struct {
    const char *name;
    size_t size;
} types[] = {[TM_VTU_FLOAT64] = {"Float64", 8},
             [TM_VTU_INT32] = {"Int32", 4},
             [TM_VTU_INT64] = {"Int64", 8},
             [TM_VTU_UINT8] = {"UInt8", 1}};

typedef struct packing {
    const char *bytes; /* of this machine */
    size_t size;
    size_t number_size;
    tm_text *block; /* [blocks] */
} packing;

/* Numbers of a block as little endian. */
static void to_little_endian(unsigned char *to, const char *from, size_t size,
                             size_t number_size)
{
    if (!tm_binary_is_big() || number_size == 1) {
        memcpy(to, from, size);
        return;
    }
    for (size_t i = 0; i < size; i++)
        to[i] =
            (unsigned char)from[i - i % number_size + number_size - 1 - i % number_size];
}

static void pack_block(void *context, size_t b)
{
    const packing *p = context;
    size_t from = b * BLOCK_BYTES, size = p->size - from;
    if (size > BLOCK_BYTES)
        size = BLOCK_BYTES;
    uLongf packed = compressBound((uLong)size);
    unsigned char *little = malloc(size);
    tm_text *block = &p->block[b];
    block->byte = malloc(packed);
    block->failed = true;
    if (little && block->byte) {
        to_little_endian(little, p->bytes + from, size, p->number_size);
        block->failed = compress2((unsigned char *)block->byte, &packed, little,
                                  (uLong)size, Z_BEST_SPEED) != Z_OK;
        block->size = packed;
    }
    free(little);
}

static void append_header(tm_text *text, size_t number)
{
    char bytes[HEADER_BYTES];
    tm_binary_put_unsigned(bytes, number, HEADER_BYTES, false);
    tm_text_append(text, bytes, HEADER_BYTES);
}

/* Appends an array: how many blocks there are, the size of each, that of the last one if
 * it is smaller, else 0, the compressed sizes, the blocks. */
static tm_status pack(tm_vtu_arrays *a, const void *bytes, size_t size,
                      size_t number_size)
{
    size_t blocks = (size + BLOCK_BYTES - 1) / BLOCK_BYTES;
    packing p = {bytes, size, number_size, calloc(blocks + 1, sizeof *p.block)};
    if (!p.block)
        return tm_fail_memory(a->error);
    tm_parallel(a->threads, blocks, pack_block, &p);
    append_header(&a->data, blocks);
    append_header(&a->data, BLOCK_BYTES);
    append_header(&a->data, size % BLOCK_BYTES);
    bool failed = false;
    for (size_t b = 0; b < blocks; b++) {
        append_header(&a->data, p.block[b].size);
        failed |= p.block[b].failed;
    }
    for (size_t b = 0; b < blocks; b++) {
        if (!failed)
            tm_text_append(&a->data, p.block[b].byte, p.block[b].size);
        tm_text_free(&p.block[b]);
    }
    free(p.block);
    return failed || a->data.failed ? tm_fail_memory(a->error) : TM_OK;
}

tm_status tm_vtu_write_array(tm_vtu_arrays *a, const char *name, tm_vtu_type type,
                             size_t components, const void *numbers, size_t count)
{
    tm_text_format(a->xml, "        <DataArray type=\"%s\" Name=\"%s\" ",
                   types[type].name, name);
    if (components != 1) /* meshio makes columns of a list that has one */
        tm_text_format(a->xml, "NumberOfComponents=\"%zu\" ", components);
    tm_text_format(a->xml, "format=\"appended\" offset=\"%zu\"/>\n", a->data.size);
    return pack(a, numbers, count * types[type].size, types[type].size);
}
