/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "inp_types.h"

#include "../../element/shape.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

/* What stands before the number of nodes; the longest that fits counts. */
static const struct {
    const char *prefix;
    uint8_t dimension;
} families[] = {
    {"C3D", 3},    {"DC3D", 3},  {"DCC3D", 3}, {"AC3D", 3}, {"F3D", 3},  {"SC", 3},
    {"CSS", 3},    {"S", 2},     {"STRI", 2},  {"DS", 2},   {"M3D", 2},  {"R3D", 2},
    {"SFM3D", 2},  {"CPS", 2},   {"CPE", 2},   {"CPEG", 2}, {"CAX", 2},  {"CGAX", 2},
    {"DC2D", 2},   {"DCC2D", 2}, {"DCAX", 2},  {"AC2D", 2}, {"ACAX", 2}, {"F2D", 2},
    {"ACIN3D", 2}, {"T2D", 1},   {"T3D", 1},   {"R2D", 1},  {"RB2D", 1}, {"RB3D", 1},
    {"RAX", 1},    {"DC1D", 1},  {"AC1D", 1},
};

/* VTK's numbers of cells of first and second order. */
static const tm_inp_type types[] = {
    {3, 4, 4, TM_VTK_TETRA},
    {3, 10, 4, 24},
    {3, 5, 5, TM_VTK_PYRAMID},
    {3, 13, 5, 27},
    {3, 6, 6, TM_VTK_WEDGE},
    {3, 15, 6, 26},
    {3, 8, 8, TM_VTK_HEXAHEDRON},
    {3, 20, 8, 25},
    {3, 27, 8, 29},
    {2, 3, 3, TM_VTK_TRIANGLE},
    {2, 6, 3, 22},
    {2, 4, 4, TM_VTK_QUADRILATERAL},
    {2, 8, 4, 23},
    {2, 9, 4, 28},
    {1, 2, 2, TM_VTK_LINE},
    {1, 3, 2, 21},
};

static tm_inp_type find(unsigned dimension, unsigned nodes)
{
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        if (types[t].dimension == dimension && types[t].nodes == nodes)
            return types[t];
    return (tm_inp_type){0};
}

/* The number at the begin of a text, of at most two digits. */
static unsigned number_at(const char *at, const char *end)
{
    enum { DIGITS = 2, TEN = 10 };
    unsigned number = 0;
    for (size_t i = 0; i < DIGITS && at < end && isdigit((unsigned char)*at); i++, at++)
        number = TEN * number + (unsigned)(*at - '0');
    return number;
}

/* B31 … B33, B31OS, PIPE31: the second digit is the order, of which 3 has two nodes. */
static tm_inp_type beam_of(tm_word name)
{
    static const char *const beam[] = {"B2", "B3", "PIPE2", "PIPE3", "ELBOW3"};
    for (size_t b = 0; b < sizeof beam / sizeof *beam; b++) {
        const size_t size = strlen(beam[b]);
        if (name.size <= size || strncasecmp(name.begin, beam[b], size) != 0)
            continue;
        if (name.begin[size] >= '1' && name.begin[size] <= '3')
            return find(1, name.begin[size] == '2' ? 3 : 2);
    }
    return (tm_inp_type){0};
}

tm_inp_type tm_inp_type_of(tm_word name)
{
    static const char thin_shell[] = "STRI65"; /* six nodes, of five freedoms each */
    size_t longest = 0;
    tm_inp_type type = beam_of(name);
    if (tm_word_is_like(name, thin_shell))
        return find(2, 6);
    for (size_t f = 0; f < sizeof families / sizeof *families; f++) {
        const size_t size = strlen(families[f].prefix);
        if (size <= longest || name.size <= size ||
            strncasecmp(name.begin, families[f].prefix, size) != 0 ||
            !isdigit((unsigned char)name.begin[size]))
            continue;
        longest = size;
        type = find(families[f].dimension,
                    number_at(name.begin + size, name.begin + name.size));
    }
    return type;
}

void tm_inp_reorder(const tm_inp_type *type, uint32_t *node)
{
    if (type->dimension == 3 && type->corners == TM_WEDGE_NODES)
        tm_mixed_mirror(node, TM_WEDGE_NODES);
    if (type->dimension == 1 && type->nodes == 3) {
        const uint32_t middle = node[1];
        node[1] = node[2];
        node[2] = middle;
    }
}

/* Faces ----------------------------------------------------------------------------- */

int tm_inp_face_label(tm_word label)
{
    if (label.size == 0 || tm_word_is_like(label, "SPOS") ||
        tm_word_is_like(label, "SNEG"))
        return 0;
    if (label.size != 2 || (label.begin[0] != 'S' && label.begin[0] != 's') ||
        label.begin[1] < '1' || label.begin[1] > '0' + TM_ELEMENT_FACES)
        return -1;
    return label.begin[1] - '0';
}

/* The nodes of faces S1 … as bits, in the order of .mix (Abaqus Elements Guide, "Three-
 * dimensional solid element library"; Abaqus' wedges have 0 2 1 3 5 4 there). */
#define BITS3(a, b, c)    (1 << (a) | 1 << (b) | 1 << (c))
#define BITS4(a, b, c, d) (BITS3(a, b, c) | 1 << (d))
static const uint8_t faces[TM_ELEMENT_NODES + 1][TM_ELEMENT_FACES] = {
    [TM_TET_NODES] = {BITS3(0, 1, 2), BITS3(0, 1, 3), BITS3(1, 2, 3), BITS3(0, 2, 3)},
    [TM_PYRAMID_NODES] = {BITS4(0, 1, 2, 3), BITS3(0, 1, 4), BITS3(1, 2, 4),
                          BITS3(2, 3, 4), BITS3(0, 3, 4)},
    [TM_WEDGE_NODES] = {BITS3(0, 1, 2), BITS3(3, 4, 5), BITS4(0, 2, 3, 5),
                        BITS4(1, 2, 4, 5), BITS4(0, 1, 3, 4)},
    [TM_HEX_NODES] = {BITS4(0, 1, 2, 3), BITS4(4, 5, 6, 7), BITS4(0, 1, 4, 5),
                      BITS4(1, 2, 5, 6), BITS4(2, 3, 6, 7), BITS4(0, 3, 4, 7)},
};

static uint8_t bits_of(size_t corners, size_t face)
{
    uint8_t bits = 0;
    for (size_t i = 0; i < 4; i++)
        bits |= (uint8_t)(1 << tm_element_shapes[corners].face[face][i]);
    return bits;
}

int tm_inp_face(size_t corners, int number)
{
    const size_t count = tm_element_shapes[corners].faces;
    for (size_t f = 0; number >= 1 && (size_t)number <= count && f < count; f++)
        if (bits_of(corners, f) == faces[corners][number - 1])
            return (int)f;
    return -1;
}

int tm_inp_face_number(size_t corners, size_t face)
{
    int number = 1;
    while (tm_inp_face(corners, number) != (int)face)
        number++;
    return number;
}
