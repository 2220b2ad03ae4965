/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "medit_input.h"

#include "../../element/shape.h"
#include "../../stream/sniff.h"
#include "../binary.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Elements of higher order have their corners first. */
static const tm_medit_section sections[] = {
    {TM_MEDIT_VERTICES, "Vertices", NULL, 0, 0},
    {TM_MEDIT_EDGES, "Edges", NULL, 2, TM_VTK_LINE},
    {TM_MEDIT_TRIANGLES, "Triangles", NULL, 3, TM_VTK_TRIANGLE},
    {TM_MEDIT_QUADRILATERALS, "Quadrilaterals", NULL, 4, TM_VTK_QUADRILATERAL},
    {TM_MEDIT_TETRAHEDRA, "Tetrahedra", NULL, TM_TET_NODES, TM_VTK_TETRA},
    {TM_MEDIT_PRISMS, "Prisms", NULL, TM_WEDGE_NODES, TM_VTK_WEDGE},
    {TM_MEDIT_HEXAHEDRA, "Hexahedra", NULL, TM_HEX_NODES, TM_VTK_HEXAHEDRON},
    {TM_MEDIT_HEXAHEDRA, "Hexaedra", NULL, TM_HEX_NODES, TM_VTK_HEXAHEDRON},
    {TM_MEDIT_PYRAMIDS, "Pyramids", NULL, TM_PYRAMID_NODES, TM_VTK_PYRAMID},
    {24, "TrianglesP2", NULL, 6, 22},
    {25, "EdgesP2", NULL, 3, 21},
    {27, "QuadrilateralsQ2", NULL, 9, 28},
    {30, "TetrahedraP2", NULL, 10, 24},
    {33, "HexahedraQ2", NULL, 27, 29},
    {13, "Corners", "corners", 0, 0},
    {14, "Ridges", "ridges", 0, 0},
    {15, "RequiredVertices", "required vertices", 0, 0},
    {16, "RequiredEdges", "required edges", 0, 0},
    {17, "RequiredTriangles", "required triangles", 0, 0},
    {18, "RequiredQuadrilaterals", "required quadrilaterals", 0, 0},
    {TM_MEDIT_SOLUTION, "SolAtVertices", NULL, 0, 0},
    {TM_MEDIT_END, "End", NULL, 0, 0},
};
enum { SECTIONS = sizeof sections / sizeof *sections };

enum { INTEGER = 4, LONG = 8, VERSIONS = 4 };

const tm_medit_section *tm_medit_section_of(int code)
{
    for (size_t s = 0; s < SECTIONS; s++)
        if (sections[s].code == code)
            return &sections[s];
    return NULL;
}

tm_status tm_medit_fail(const tm_medit_input *input, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    tm_fail_at_list(input->error, TM_ERROR_INPUT, input->scan.name,
                    input->binary ? 0 : input->scan.line, NULL, format, arguments);
    va_end(arguments);
    return TM_ERROR_INPUT;
}

/* Numbers --------------------------------------------------------------------------- */

static size_t integer_size(const tm_medit_input *input)
{
    return input->version == VERSIONS ? LONG : INTEGER;
}

static size_t real_size(const tm_medit_input *input)
{
    return input->version == 1 ? sizeof(float) : sizeof(double);
}

/* A signed number of 4 or 8 bytes. */
static tm_status take(tm_medit_input *input, size_t size, const char *what,
                      int64_t *value)
{
    if (size > (size_t)(input->end - input->at))
        return tm_medit_fail(input, "the file ends where %s should be", what);
    const uint64_t bits = tm_binary_unsigned(input->at, size, input->big);
    *value = size == LONG ? (int64_t)bits : (int32_t)(uint32_t)bits;
    input->at += size;
    return TM_OK;
}

tm_status tm_medit_integer(tm_medit_input *input, const char *what, int64_t lo,
                           int64_t hi, int64_t *value)
{
    if (!input->binary)
        return tm_scan_next_integer(&input->scan, what, lo, hi, value, input->error);
    const tm_status status = take(input, integer_size(input), what, value);
    if (status == TM_OK && (*value < lo || *value > hi))
        return tm_medit_fail(input, "%s: %lld is out of range (%lld..%lld)", what,
                             (long long)*value, (long long)lo, (long long)hi);
    return status;
}

tm_status tm_medit_real(tm_medit_input *input, const char *what, double *value)
{
    if (!input->binary)
        return tm_scan_next_double(&input->scan, what, value, input->error);
    const size_t size = real_size(input);
    if (size > (size_t)(input->end - input->at))
        return tm_medit_fail(input, "the file ends where %s should be", what);
    *value = size == sizeof(float) ? (double)tm_binary_float(input->at, input->big)
                                   : tm_binary_double(input->at, input->big);
    input->at += size;
    return isfinite(*value) ? TM_OK
                            : tm_medit_fail(input, "%s is not a finite number", what);
}

tm_status tm_medit_count(tm_medit_input *input, size_t numbers, size_t *count)
{
    int64_t value = 0;
    const tm_status status =
        tm_medit_integer(input, "a number of rows", 0, INT32_MAX, &value);
    *count = (size_t)value;
    input->is_read = true;
    if (status != TM_OK)
        return status;
    const size_t left = input->binary ? (size_t)(input->end - input->at) / INTEGER
                                      : (size_t)(input->scan.end - input->scan.at);
    if (numbers > 0 && *count > left / numbers)
        return tm_medit_fail(input, "the file is too short for %zu rows", *count);
    return TM_OK;
}

/* Sections -------------------------------------------------------------------------- */

/* The number of bytes from the begin of the file, after which there is the next one. */
static tm_status take_next(tm_medit_input *input)
{
    int64_t next = 0;
    const tm_status status = take(input, input->version >= 3 ? LONG : INTEGER,
                                  "the place of the next section", &next);
    if (status != TM_OK)
        return status;
    if (next != 0 &&
        (next < input->at - input->begin || next > input->end - input->begin))
        return tm_medit_fail(input, "the place of the next section is out of range");
    input->next = next == 0 ? NULL : input->begin + next;
    return TM_OK;
}

static tm_status next_binary(tm_medit_input *input, const tm_medit_section **section,
                             char name[TM_MEDIT_NAME])
{
    int64_t code = 0;
    if (!input->next)
        return tm_medit_fail(input, "the file ends without a section End");
    input->at = input->next;
    const tm_status status = take(input, INTEGER, "a section", &code);
    if (status != TM_OK)
        return status;
    *section = tm_medit_section_of((int)code);
    snprintf(name, TM_MEDIT_NAME, "section %d", (int)code);
    return code == TM_MEDIT_END ? TM_OK : take_next(input);
}

/* Numbers of a section that is not read are passed over. */
static tm_status next_text(tm_medit_input *input, const tm_medit_section **section,
                           char name[TM_MEDIT_NAME])
{
    tm_word word;
    bool is_word;
    do {
        if (!tm_scan_seek(&input->scan))
            return tm_medit_fail(input, "the file ends without the word End");
        word = tm_scan_word(&input->scan);
        is_word = isalpha((unsigned char)*word.begin);
        if (!is_word && input->is_read)
            return tm_medit_fail(input, "'%.*s' is where a word such as End should be",
                                 tm_word_shown(word), word.begin);
    } while (!is_word);
    input->is_read = false;
    *section = NULL;
    for (size_t s = 0; s < SECTIONS && !*section; s++)
        if (tm_word_is_like(word, sections[s].word))
            *section = &sections[s];
    snprintf(name, TM_MEDIT_NAME, "%.*s", tm_word_shown(word), word.begin);
    return TM_OK;
}

tm_status tm_medit_next(tm_medit_input *input, const tm_medit_section **section,
                        char name[TM_MEDIT_NAME])
{
    return input->binary ? next_binary(input, section, name)
                         : next_text(input, section, name);
}

/* The head -------------------------------------------------------------------------- */

/* The number 1 in four bytes. */
static bool is_binary(const tm_medit_bytes *bytes, bool *big)
{
    if (bytes->size < INTEGER)
        return false;
    *big = tm_binary_unsigned(bytes->byte, INTEGER, true) == 1;
    return *big || tm_binary_unsigned(bytes->byte, INTEGER, false) == 1;
}

static tm_status take_dimension(tm_medit_input *input)
{
    int64_t value = 0;
    const size_t size = INTEGER;
    const tm_status status = input->binary
                                 ? take(input, size, "the dimension", &value)
                                 : tm_scan_next_integer(&input->scan, "the dimension", 2,
                                                        3, &value, input->error);
    if (status == TM_OK && value != 2 && value != 3)
        return tm_medit_fail(input, "the dimension is %lld (2 or 3 would be right)",
                             (long long)value);
    input->dimension = (int)value;
    input->is_read = true;
    return status;
}

static tm_status begin_binary(tm_medit_input *input)
{
    int64_t value = 0;
    input->at += INTEGER;
    tm_status status = take(input, INTEGER, "the version", &value);
    if (status == TM_OK && (value < 1 || value > VERSIONS))
        return tm_medit_fail(input, "version %lld is not known (1 to 4)",
                             (long long)value);
    input->version = (int)value;
    if (status == TM_OK)
        status = take(input, INTEGER, "the dimension", &value);
    if (status == TM_OK && value != TM_MEDIT_DIMENSION)
        return tm_medit_fail(input, "the first section is no Dimension");
    if (status == TM_OK)
        status = take_next(input);
    return status == TM_OK ? take_dimension(input) : status;
}

static tm_status begin_text(tm_medit_input *input)
{
    int64_t value;
    tm_scan_seek(&input->scan);
    const tm_word word = tm_scan_word(&input->scan);
    if (!tm_word_is_like(word, "MeshVersionFormatted"))
        return tm_medit_fail(input, "does not begin with MeshVersionFormatted");
    const tm_status status = tm_scan_next_integer(&input->scan, "the version", 0,
                                                  VERSIONS, &value, input->error);
    if (status != TM_OK)
        return status;
    tm_scan_seek(&input->scan);
    if (!tm_word_is_like(tm_scan_word(&input->scan), "Dimension"))
        return tm_medit_fail(input, "the word Dimension should be here");
    return take_dimension(input);
}

tm_status tm_medit_begin(tm_medit_input *input, const tm_medit_bytes *bytes,
                         tm_error *error)
{
    *input = (tm_medit_input){.begin = bytes->byte,
                              .at = bytes->byte,
                              .end = bytes->byte + bytes->size,
                              .error = error};
    tm_scan_begin(&input->scan, bytes->byte, bytes->size, bytes->name, '#');
    input->binary = is_binary(bytes, &input->big);
    return input->binary ? begin_binary(input) : begin_text(input);
}
