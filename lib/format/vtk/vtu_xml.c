/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Expat reads the elements. It has no handler for external entities, so none is opened,
 * and its own guard against entities that grow without end stays on. What is in an array
 * is not handed over by Expat, but found by the bytes that its tags end and begin at. */
#include "vtu_xml.h"

#include "../../base/array.h"
#include "../../number/number.h"

#include <expat.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 1 << 20 };

typedef struct parser {
    XML_Parser expat;
    tm_vtu_file *file;
    tm_error *error;
    tm_status status;
    bool is_grid;  /* VTKFile of the right type was met */
    bool in_piece; /* field data may also stand in one */
    bool is_over;  /* AppendedData has begun */
    tm_vtu_section section;
    tm_vtu_entry *open; /* the array that is being read */
    size_t depth;       /* elements in it that are open */
} parser;

static void fail(parser *p, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void fail(parser *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    p->status =
        tm_fail_at_list(p->error, TM_ERROR_INPUT, p->file->name,
                        XML_GetCurrentLineNumber(p->expat), NULL, format, arguments);
    va_end(arguments);
    XML_StopParser(p->expat, XML_FALSE);
}

static void fail_memory(parser *p)
{
    p->status = tm_fail_memory(p->error);
    XML_StopParser(p->expat, XML_FALSE);
}

/* The byte that the event ends before, or begins at. */
static const char *end_of_event(const parser *p)
{
    return p->file->bytes + XML_GetCurrentByteIndex(p->expat) +
           XML_GetCurrentByteCount(p->expat);
}

static const char *begin_of_event(const parser *p)
{
    return p->file->bytes + XML_GetCurrentByteIndex(p->expat);
}

/* Attributes ------------------------------------------------------------------------ */

static const char *attribute(const XML_Char **list, const char *name)
{
    for (; *list; list += 2)
        if (strcmp(*list, name) == 0)
            return list[1];
    return NULL;
}

/* A count that may lack where `otherwise` is not SIZE_MAX. */
static size_t count_of(parser *p, const XML_Char **list, const char *name,
                       size_t otherwise)
{
    const char *text = attribute(list, name);
    int64_t value = 0;
    if (!text && otherwise != SIZE_MAX)
        return otherwise;
    if (!text) {
        fail(p, "%s is missing", name);
        return 0;
    }
    text += strspn(text, " \t\r\n");
    const char *end = text + strlen(text);
    while (end > text && strchr(" \t\r\n", end[-1]))
        end--;
    if (tm_read_int64(text, end, &value) != end || value < 0)
        fail(p, "%s=\"%.40s\" is no count", name, text);
    return (size_t)value;
}

static void take_type(parser *p, const char *type, tm_vtu_entry *entry)
{
    static const char *const name[TM_NUMBER_TYPES] = {
        [TM_INT8] = "Int8",      [TM_UINT8] = "UInt8",   [TM_INT16] = "Int16",
        [TM_UINT16] = "UInt16",  [TM_INT32] = "Int32",   [TM_UINT32] = "UInt32",
        [TM_INT64] = "Int64",    [TM_UINT64] = "UInt64", [TM_FLOAT32] = "Float32",
        [TM_FLOAT64] = "Float64"};
    size_t t = 0;
    entry->strings = type && strcmp(type, "String") == 0;
    entry->bits = type && strcmp(type, "Bit") == 0;
    if (entry->strings || entry->bits) {
        entry->type = TM_UINT8;
        return;
    }
    while (type && t < TM_NUMBER_TYPES && strcmp(name[t], type) != 0)
        t++;
    if (type && t < TM_NUMBER_TYPES)
        entry->type = (tm_number_type)t;
    else if (p->section != TM_VTU_FIELD_DATA)
        fail(p,
             "the type of an array is '%.40s' (Bit, Int8 … UInt64, Float32 or Float64)",
             type ? type : "");
}

static void take_form(parser *p, const char *form, tm_vtu_entry *entry)
{
    static const char *const name[] = {[TM_VTU_ASCII] = "ascii",
                                       [TM_VTU_BASE64] = "binary",
                                       [TM_VTU_APPENDED] = "appended"};
    size_t f = 0;
    while (form && f < sizeof name / sizeof *name && strcmp(name[f], form) != 0)
        f++;
    if (form && f == sizeof name / sizeof *name)
        fail(p, "the format of an array is '%.40s' (ascii, binary or appended)", form);
    entry->form = form ? (tm_vtu_form)f : TM_VTU_ASCII;
}

/* Elements -------------------------------------------------------------------------- */

static void begin_file(parser *p, const XML_Char **list)
{
    const char *type = attribute(list, "type"), *order = attribute(list, "byte_order");
    const char *header = attribute(list, "header_type");
    const char *compressor = attribute(list, "compressor");
    p->file->is_list = type && strcmp(type, "PUnstructuredGrid") == 0;
    if (!type || (strcmp(type, "UnstructuredGrid") != 0 && !p->file->is_list))
        fail(p, "is a file of VTK of type '%.40s' (UnstructuredGrid would be right%s)",
             type ? type : "",
             type && strcmp(type, "PolyData") == 0
                 ? "; vtk-import reads polygons of a legacy .vtk"
                 : "");
    else if (order && strcmp(order, "LittleEndian") != 0 &&
             strcmp(order, "BigEndian") != 0)
        fail(p, "byte_order=\"%.40s\" (LittleEndian or BigEndian)", order);
    else if (header && strcmp(header, "UInt32") != 0 && strcmp(header, "UInt64") != 0)
        fail(p, "header_type=\"%.40s\" (UInt32 or UInt64)", header);
    else if (compressor && *compressor &&
             strcmp(compressor, "vtkZLibDataCompressor") != 0)
        fail(p, "its data are compressed by %.60s (vtkZLibDataCompressor can be read)",
             compressor);
    p->is_grid = true;
    p->file->big = order && *order == 'B';
    p->file->header =
        header && strcmp(header, "UInt64") == 0 ? sizeof(uint64_t) : sizeof(uint32_t);
    p->file->packed = compressor && *compressor;
}

/* Appends a name, with 0 behind it. */
static size_t add_name(parser *p, const char *name)
{
    tm_text *names = &p->file->names;
    const size_t at = names->size;
    tm_text_string(names, name ? name : "");
    tm_text_append(names, "", 1);
    if (names->failed)
        fail_memory(p);
    return at;
}

static void begin_piece(parser *p, const XML_Char **list)
{
    tm_vtu_file *file = p->file;
    const char *source = attribute(list, "Source");
    tm_vtu_piece piece = {0};
    void *room =
        tm_grow(file->piece, &file->piece_room, file->pieces + 1, sizeof *file->piece);
    if (!room) {
        fail_memory(p);
        return;
    }
    file->piece = room;
    if (!file->is_list) {
        piece.points = count_of(p, list, "NumberOfPoints", SIZE_MAX);
        piece.cells = count_of(p, list, "NumberOfCells", SIZE_MAX);
    } else if (source && *source) {
        piece.source = add_name(p, source);
    } else {
        fail(p, "a piece has no Source");
    }
    file->piece[file->pieces++] = piece;
    p->in_piece = true;
}

static void begin_array(parser *p, const XML_Char **list)
{
    tm_vtu_file *file = p->file;
    void *room =
        tm_grow(file->entry, &file->entry_room, file->entries + 1, sizeof *file->entry);
    const char *name = attribute(list, "Name");
    if (!room) {
        fail_memory(p);
        return;
    }
    file->entry = room;
    tm_vtu_entry *entry = &file->entry[file->entries++];
    *entry = (tm_vtu_entry){.section = p->section,
                            .piece = file->pieces - p->in_piece,
                            .name = add_name(p, name),
                            .line = XML_GetCurrentLineNumber(p->expat)};
    take_type(p, attribute(list, "type"), entry);
    take_form(p, attribute(list, "format"), entry);
    entry->components = count_of(p, list, "NumberOfComponents", 1);
    if (entry->form == TM_VTU_APPENDED)
        entry->offset = count_of(p, list, "offset", SIZE_MAX);
    p->open = entry;
    p->depth = 0;
    entry->begin = end_of_event(p);
}

static void begin_appended(parser *p, const XML_Char **list)
{
    const char *encoding = attribute(list, "encoding");
    tm_vtu_file *file = p->file;
    if (encoding && strcmp(encoding, "raw") != 0 && strcmp(encoding, "base64") != 0) {
        fail(p, "the encoding of the appended data is '%.40s' (raw or base64)", encoding);
        return;
    }
    file->appended_base64 = !encoding || *encoding == 'b';
    file->appended = end_of_event(p);
    p->is_over = true;
    XML_StopParser(p->expat, XML_FALSE);
}

static tm_vtu_section section_of(const char *name)
{
    static const char *const names[TM_VTU_NO_SECTION] = {
        [TM_VTU_POINT_DATA] = "PointData",
        [TM_VTU_CELL_DATA] = "CellData",
        [TM_VTU_POINTS] = "Points",
        [TM_VTU_CELLS] = "Cells",
        [TM_VTU_FIELD_DATA] = "FieldData"};
    size_t s = 0;
    while (s < TM_VTU_NO_SECTION && strcmp(names[s], name) != 0)
        s++;
    return (tm_vtu_section)s;
}

/* Only blanks between. */
static bool is_blank(const char *begin, const char *end)
{
    while (begin < end && strchr(" \t\r\n", *begin) && *begin)
        begin++;
    return begin >= end;
}

/* What an array holds is what is before the first element in it, or behind that where
 * there is nothing. */
static void begin_in_array(parser *p)
{
    tm_vtu_entry *entry = p->open;
    if (p->depth++ == 0 && !entry->end && !is_blank(entry->begin, begin_of_event(p)))
        entry->end = begin_of_event(p);
}

static void XMLCALL begin_element(void *context, const XML_Char *name,
                                  const XML_Char **list)
{
    parser *p = context;
    if (p->status != TM_OK || p->is_over)
        return;
    if (!p->is_grid && strcmp(name, "VTKFile") != 0)
        fail(p, "is no XML file of VTK (its first element is '%.40s')", name);
    else if (p->open)
        begin_in_array(p);
    else if (!p->is_grid)
        begin_file(p, list);
    else if (strcmp(name, "Piece") == 0)
        begin_piece(p, list);
    else if (strcmp(name, "AppendedData") == 0)
        begin_appended(p, list);
    else if (section_of(name) != TM_VTU_NO_SECTION)
        p->section = section_of(name);
    else if (p->section != TM_VTU_NO_SECTION &&
             (strcmp(name, "DataArray") == 0 || strcmp(name, "Array") == 0))
        begin_array(p, list);
}

static void XMLCALL end_element(void *context, const XML_Char *name)
{
    parser *p = context;
    if (p->status != TM_OK || p->is_over)
        return;
    if (p->open && p->depth > 0) {
        if (--p->depth == 0 && !p->open->end)
            p->open->begin = end_of_event(p);
    } else if (p->open) {
        if (!p->open->end)
            p->open->end = begin_of_event(p);
        if (p->open->end < p->open->begin) /* <DataArray … /> */
            p->open->end = p->open->begin;
        p->open = NULL;
    } else if (strcmp(name, "Piece") == 0) {
        p->in_piece = false;
    } else if (section_of(name) != TM_VTU_NO_SECTION) {
        p->section = TM_VTU_NO_SECTION;
    }
}

/* ----------------------------------------------------------------------------------- */

/* The data are between the first '_' and the last "</AppendedData>", behind which the
 * file ends as it has to. */
static tm_status find_appended(parser *p)
{
    static const char close[] = "</AppendedData>", end[] = "</VTKFile>";
    tm_vtu_file *file = p->file;
    const char *at = file->appended, *last = file->end;
    while (at < file->end && strchr(" \t\r\n", *at) && *at)
        at++;
    while (last > at && strchr(" \t\r\n", last[-1]) && last[-1])
        last--;
    const size_t tail = sizeof end - 1;
    if (at == file->end || *at != '_')
        return tm_fail_at(p->error, TM_ERROR_INPUT, file->name, 0, NULL,
                          "the appended data do not begin with '_'");
    if ((size_t)(last - at) < tail || memcmp(last - tail, end, tail) != 0)
        return tm_fail_at(p->error, TM_ERROR_INPUT, file->name, 0, NULL,
                          "the file ends before %s", end);
    last -= tail;
    for (last -= sizeof close - 1; last > at; last--)
        if (memcmp(last, close, sizeof close - 1) == 0)
            break;
    if (last <= at)
        return tm_fail_at(p->error, TM_ERROR_INPUT, file->name, 0, NULL,
                          "the appended data have no end");
    file->appended = at + 1;
    file->appended_end = last;
    return TM_OK;
}

static void parse(parser *p)
{
    const tm_vtu_file *file = p->file;
    for (const char *at = file->bytes;; at += CHUNK) {
        const size_t left = (size_t)(file->end - at);
        const bool last = left <= CHUNK;
        if (XML_Parse(p->expat, at, last ? (int)left : CHUNK, last) == XML_STATUS_OK) {
            if (last)
                return;
            continue;
        }
        if (p->status == TM_OK && !p->is_over &&
            XML_GetErrorCode(p->expat) == XML_ERROR_NO_MEMORY)
            p->status = tm_fail_memory(p->error);
        else if (p->status == TM_OK && !p->is_over)
            p->status = tm_fail_at(p->error, TM_ERROR_INPUT, file->name,
                                   XML_GetCurrentLineNumber(p->expat), NULL,
                                   "is no XML, or is cut short: %s",
                                   XML_ErrorString(XML_GetErrorCode(p->expat)));
        return;
    }
}

tm_status tm_vtu_file_read(tm_vtu_file *file, const char *bytes, size_t size,
                           const char *name, tm_error *error)
{
    *file = (tm_vtu_file){.bytes = bytes, .end = bytes + size, .name = name};
    parser p = {.file = file, .error = error, .section = TM_VTU_NO_SECTION};
    p.expat = XML_ParserCreate(NULL);
    if (!p.expat)
        return tm_fail_memory(error);
    XML_SetUserData(p.expat, &p);
    XML_SetElementHandler(p.expat, begin_element, end_element);
    parse(&p);
    XML_ParserFree(p.expat);
    return p.status == TM_OK && p.is_over ? find_appended(&p) : p.status;
}

void tm_vtu_file_free(tm_vtu_file *file)
{
    free(file->piece);
    free(file->entry);
    tm_text_free(&file->names);
    *file = (tm_vtu_file){0};
}

/* Arrays come piece by piece. */
size_t tm_vtu_first(const tm_vtu_file *file, size_t piece)
{
    size_t low = 0, high = file->entries;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (file->entry[middle].piece < piece)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

const tm_vtu_entry *tm_vtu_find(const tm_vtu_file *file, size_t piece,
                                tm_vtu_section section, const char *name)
{
    const tm_vtu_entry *entry = file->entry + tm_vtu_first(file, piece);
    for (; entry < file->entry + file->entries && entry->piece == piece; entry++)
        if (entry->section == section &&
            (!name || strcmp(tm_vtu_name(file, entry), name) == 0))
            return entry;
    return NULL;
}

tm_status tm_vtu_fail(const tm_vtu_file *file, const tm_vtu_entry *entry, tm_error *error,
                      const char *format, ...)
{
    char what[sizeof((tm_error *)NULL)->what];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    return tm_fail_at(error, TM_ERROR_INPUT, file->name, entry->line, NULL,
                      "array '%.60s': %s", tm_vtu_name(file, entry), what);
}
