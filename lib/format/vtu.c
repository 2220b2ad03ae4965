/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_format.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../element/shape.h"
#include "../element/tet_quality.h"
#include "binary.h"
#include "text_rows.h"
#include "../mesh/cell_faces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { BLOCK_BYTES = 1 << 17, HEADER_BYTES = 8, TETRAHEDRON = 4 };

typedef enum { FLOAT64, INT32, INT64, UINT8 } number_type;

static const struct {
    const char *name;
    size_t size;
} types[] = {[FLOAT64] = {"Float64", 8},
             [INT32] = {"Int32", 4},
             [INT64] = {"Int64", 8},
             [UINT8] = {"UInt8", 1}};

typedef struct writer {
    const tm_stream *stream;
    const tm_block *node;
    const tm_block *cell; /* the block of the content; .node for points */
    tm_content content;
    tm_cell_faces faces; /* of polyhedra */
    unsigned threads;
    tm_text *xml;
    tm_text data; /* what is appended */
    tm_error *error;
} writer;

/* Compressed blocks ---------------------------------------------------------------- */

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
    static const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    if (first == 1 || number_size == 1) {
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
static tm_status pack(writer *w, const void *bytes, size_t size, size_t number_size)
{
    size_t blocks = (size + BLOCK_BYTES - 1) / BLOCK_BYTES;
    packing p = {bytes, size, number_size, calloc(blocks + 1, sizeof *p.block)};
    if (!p.block)
        return tm_fail_memory(w->error);
    tm_parallel(w->threads, blocks, pack_block, &p);
    append_header(&w->data, blocks);
    append_header(&w->data, BLOCK_BYTES);
    append_header(&w->data, size % BLOCK_BYTES);
    bool failed = false;
    for (size_t b = 0; b < blocks; b++) {
        append_header(&w->data, p.block[b].size);
        failed |= p.block[b].failed;
    }
    for (size_t b = 0; b < blocks; b++) {
        if (!failed)
            tm_text_append(&w->data, p.block[b].byte, p.block[b].size);
        tm_text_free(&p.block[b]);
    }
    free(p.block);
    return failed || w->data.failed ? tm_fail_memory(w->error) : TM_OK;
}

/* Appends an array of `count` numbers to the data and its element to the XML. */
static tm_status write_array(writer *w, const char *name, number_type type,
                             size_t components, const void *numbers, size_t count)
{
    tm_text_format(w->xml,
                   "        <DataArray type=\"%s\" Name=\"%s\" "
                   "NumberOfComponents=\"%zu\" format=\"appended\" offset=\"%zu\"/>\n",
                   types[type].name, name, components, w->data.size);
    return pack(w, numbers, count * types[type].size, types[type].size);
}

/* Data of points and cells --------------------------------------------------------- */

/* Column i of the attributes. */
static tm_status write_attribute(writer *w, const tm_block *block, size_t i,
                                 const char *first_name)
{
    enum { NAME = 32 };
    char name[NAME];
    double *column = tm_new(block->count, sizeof *column);
    if (!column)
        return tm_fail_memory(w->error);
    for (size_t row = 0; row < block->count; row++)
        column[row] = block->attribute[row * block->attributes + i];
    snprintf(name, sizeof name, "attribute_%zu", i + 1);
    tm_status status =
        write_array(w, i == 0 ? first_name : name, FLOAT64, 1, column, block->count);
    free(column);
    return status;
}

static tm_status write_attributes(writer *w, const tm_block *block,
                                  const char *first_name)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < block->attributes && status == TM_OK; i++)
        status = write_attribute(w, block, i, first_name);
    if (status == TM_OK && block->marker)
        status = write_array(w, "marker", INT32, 1, block->marker, block->count);
    return status;
}

static tm_status write_quality(writer *w)
{
    const double(*xyz)[3] = (const double(*)[3])w->node->real;
    double *quality = tm_new(w->cell->count, sizeof *quality);
    if (!quality)
        return tm_fail_memory(w->error);
    for (size_t t = 0; t < w->cell->count; t++) {
        const uint32_t *v = w->cell->integer + TM_TET_NODES * t;
        quality[t] =
            tm_sine2_to_degrees(tm_tet_sine2(xyz[v[0]], xyz[v[1]], xyz[v[2]], xyz[v[3]]));
    }
    tm_status status =
        write_array(w, "dihedral_quality", FLOAT64, 1, quality, w->cell->count);
    free(quality);
    return status;
}

static tm_status write_cell_data(writer *w)
{
    tm_status status = TM_OK;
    if (w->content != TM_CONTENT_POINTS)
        status = write_attributes(
            w, w->cell, w->content == TM_CONTENT_POLYHEDRA ? "tetrahedra" : "region");
    if (status == TM_OK && w->content == TM_CONTENT_TETRAHEDRA)
        status = write_quality(w);
    return status;
}

/* Cells ---------------------------------------------------------------------------- */

/* Whole numbers, of 64 bits only where 32 are too few. */
typedef struct integers {
    bool wide;
    void *number;
    size_t count;
} integers;

static bool integers_new(integers *array, size_t count, bool wide)
{
    *array = (integers){wide, tm_new(count, wide ? sizeof(int64_t) : sizeof(int32_t)), 0};
    return array->number != NULL;
}

static void append(integers *array, size_t value)
{
    if (array->wide)
        ((int64_t *)array->number)[array->count++] = (int64_t)value;
    else
        ((int32_t *)array->number)[array->count++] = (int32_t)value;
}

typedef struct cell_arrays {
    integers connectivity, offsets, faces, face_offsets;
    unsigned char *type;
} cell_arrays;

static void append_cell(cell_arrays *a, const uint32_t *node, size_t k, size_t c)
{
    for (size_t i = 0; i < k; i++)
        append(&a->connectivity, node[i]);
    append(&a->offsets, a->connectivity.count);
    a->type[c] = tm_vtk_cell_type(k);
}

static void append_points(const writer *w, cell_arrays *a)
{
    for (uint32_t v = 0; v < w->node->count; v++)
        append_cell(a, &v, 1, v);
}

/* The rows of .face, .ele or .mix. */
static void append_elements(const writer *w, cell_arrays *a)
{
    for (size_t c = 0; c < w->cell->count; c++) {
        size_t k;
        const uint32_t *node = tm_row_nodes(w->cell, c, &k);
        append_cell(a, node, k, c);
    }
}

/* The faces of polyhedron c, all outward: how many, then each with its size before it.
 * Its nodes, each once: seen[v] is c + 1 for those that were there. */
static void append_polyhedron(const writer *w, cell_arrays *a, size_t c, uint32_t *seen)
{
    const tm_cell_faces *faces = &w->faces;
    size_t begin = faces->cell_start[c], end = faces->cell_start[c + 1];
    append(&a->faces, end - begin);
    for (size_t i = begin; i < end; i++) {
        size_t f = faces->cell_facet[i], k = faces->start[f + 1] - faces->start[f];
        const uint32_t *node = faces->node + faces->start[f];
        bool outward = tm_facet_is_outward(faces, f, c);
        append(&a->faces, k);
        for (size_t j = 0; j < k; j++) {
            uint32_t v = node[outward ? j : k - 1 - j];
            append(&a->faces, v);
            if (seen[v] != c + 1)
                append(&a->connectivity, v);
            seen[v] = (uint32_t)(c + 1);
        }
    }
    append(&a->face_offsets, a->faces.count);
    append(&a->offsets, a->connectivity.count);
    a->type[c] = TM_VTK_POLYHEDRON;
}

static tm_status append_polyhedra(const writer *w, cell_arrays *a)
{
    uint32_t *seen = calloc(w->node->count, sizeof *seen);
    if (!seen)
        return tm_fail_memory(w->error);
    for (size_t c = 0; c < w->faces.cells; c++)
        append_polyhedron(w, a, c, seen);
    free(seen);
    return TM_OK;
}

static tm_status append_cells(const writer *w, cell_arrays *a)
{
    if (w->content == TM_CONTENT_POLYHEDRA)
        return append_polyhedra(w, a);
    if (w->content == TM_CONTENT_POINTS)
        append_points(w, a);
    else
        append_elements(w, a);
    return TM_OK;
}

/* How many numbers the connectivity holds at most, and the faces of polyhedra. */
static void count_numbers(const writer *w, size_t *connectivity, size_t *faces)
{
    const tm_cell_faces *cf = &w->faces;
    *faces = 0;
    if (w->content == TM_CONTENT_POINTS) {
        *connectivity = w->node->count;
    } else if (w->content == TM_CONTENT_POLYHEDRA) {
        *faces = cf->cells;
        *connectivity = 0;
        for (size_t i = 0; i < cf->cell_start[cf->cells]; i++) {
            size_t f = cf->cell_facet[i], k = cf->start[f + 1] - cf->start[f];
            *faces += k + 1;
            *connectivity += k;
        }
    } else {
        *connectivity = w->cell->start
                            ? w->cell->start[w->cell->count]
                            : w->cell->count * tm_block_integers(w->cell->kind);
    }
}

static tm_status write_integers(writer *w, const char *name, const integers *array)
{
    return write_array(w, name, array->wide ? INT64 : INT32, 1, array->number,
                       array->count);
}

static tm_status write_cell_arrays(writer *w, const cell_arrays *a)
{
    tm_status status = write_integers(w, "connectivity", &a->connectivity);
    if (status == TM_OK)
        status = write_integers(w, "offsets", &a->offsets);
    if (status == TM_OK)
        status = write_array(w, "types", UINT8, 1, a->type, w->cell->count);
    if (w->content != TM_CONTENT_POLYHEDRA || status != TM_OK)
        return status;
    status = write_integers(w, "faces", &a->faces);
    return status == TM_OK ? write_integers(w, "faceoffsets", &a->face_offsets) : status;
}

static tm_status write_cells(writer *w)
{
    size_t connectivity, faces, cells = w->cell->count;
    count_numbers(w, &connectivity, &faces);
    bool wide = w->node->count > INT32_MAX || connectivity + faces > INT32_MAX;
    cell_arrays a = {.type = tm_new(cells, sizeof *a.type)};
    bool made = integers_new(&a.connectivity, connectivity, wide);
    made &= integers_new(&a.offsets, cells, wide);
    made &= integers_new(&a.faces, faces, wide);
    made &= integers_new(&a.face_offsets, faces > 0 ? cells : 0, wide);
    tm_status status = made && a.type ? append_cells(w, &a) : tm_fail_memory(w->error);
    if (status == TM_OK)
        status = write_cell_arrays(w, &a);
    free(a.connectivity.number);
    free(a.offsets.number);
    free(a.faces.number);
    free(a.face_offsets.number);
    free(a.type);
    return status;
}

/* ---------------------------------------------------------------------------------- */

static tm_status write_section(writer *w, const char *name, tm_status (*write)(writer *w))
{
    tm_text_format(w->xml, "      <%s>\n", name);
    tm_status status = write(w);
    tm_text_format(w->xml, "      </%s>\n", name);
    return status;
}

static tm_status write_point_data(writer *w)
{
    return write_attributes(w, w->node, "attribute_1");
}

static tm_status write_points(writer *w)
{
    return write_array(w, "Points", FLOAT64, 3, w->node->real, 3 * w->node->count);
}

static tm_status write_piece(writer *w)
{
    tm_text_format(w->xml,
                   "<?xml version=\"1.0\"?>\n"
                   "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                   "byte_order=\"LittleEndian\" header_type=\"UInt64\" "
                   "compressor=\"vtkZLibDataCompressor\">\n"
                   "  <UnstructuredGrid>\n"
                   "    <Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">\n",
                   w->node->count, w->cell->count);
    tm_status status = write_section(w, "PointData", write_point_data);
    if (status == TM_OK)
        status = write_section(w, "CellData", write_cell_data);
    if (status == TM_OK)
        status = write_section(w, "Points", write_points);
    if (status == TM_OK)
        status = write_section(w, "Cells", write_cells);
    tm_text_string(w->xml, "    </Piece>\n"
                           "  </UnstructuredGrid>\n"
                           "  <AppendedData encoding=\"raw\">\n"
                           "   _");
    tm_text_append(w->xml, w->data.byte ? w->data.byte : "", w->data.size);
    tm_text_string(w->xml, "\n  </AppendedData>\n</VTKFile>\n");
    if (status == TM_OK && w->xml->failed)
        status = tm_fail_memory(w->error);
    return status;
}

tm_status tm_vtu_write(tm_text *text, const tm_stream *stream, unsigned threads,
                       tm_error *error)
{
    writer w = {.stream = stream,
                .node = tm_stream_find(stream, ".node"),
                .content = tm_content_of(stream),
                .threads = threads,
                .xml = text,
                .error = error};
    w.cell = tm_content_block(stream, w.content);
    if (w.content == TM_CONTENT_NOTHING)
        return tm_fail(error, TM_ERROR_INPUT, "has no nodes (.node)");
    tm_status status = TM_OK;
    if (w.content == TM_CONTENT_POLYHEDRA)
        status = tm_cell_faces_find(&w.faces, stream, error);
    if (status == TM_OK)
        status = write_piece(&w);
    if (w.content == TM_CONTENT_POLYHEDRA)
        tm_cell_faces_free(&w.faces);
    tm_text_free(&w.data);
    return status;
}
