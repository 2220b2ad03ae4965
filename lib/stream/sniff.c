/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sniff.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *begins;
    const char *what;
} known[] = {
    {"termesh", "a termesh stream of another version than 1"},
    {"\xEF\xBB\xBF", "text that begins with a byte-order mark"},
    {"OFF", "an OFF surface: use tetgen-mesh"},
    {"COFF", "an OFF surface: use tetgen-mesh"},
    {"NOFF", "an OFF surface: use tetgen-mesh"},
    {"STOFF", "an OFF surface: use tetgen-mesh"},
    {"solid", "an STL surface: use tetgen-mesh"},
    {"ply", "a PLY surface: use tetgen-mesh"},
    {"v ", "an OBJ surface: use tetgen-mesh"},
    {"[Nodes,", "an .m3d mesh: use m3d-import"},
    {"[Elements,", "an .m3d mesh: use m3d-import"},
    {"MIXED", "an .mvm mesh: use m3d-import"},
    {"[", "an .mdl surface: use mdl-import, or tetgen-mesh"},
    {"MeshVersionFormatted", "a Medit mesh, which no filter reads"},
    {"$MeshFormat", "a Gmsh mesh, which no filter reads"},
    {"# vtk", "a VTK file, which no filter reads"},
    {"<", "XML, which no filter reads"},
};

/* Skips lines that are blank or begin with '#'. */
static const char *first_line(const char *at, const char *end)
{
    while (at < end) {
        const char *c = at;
        while (c < end && (*c == ' ' || *c == '\t' || *c == '\r'))
            c++;
        if (c < end && *c != '\n' && *c != '#')
            return c;
        while (c < end && *c != '\n')
            c++;
        at = c < end ? c + 1 : end;
    }
    return end;
}

/* Numbers of a header line such as TetGen's files begin with; at most 4 are taken. */
static int header(const char *at, const char *end, long number[4])
{
    char line[128];
    size_t size = 0;
    while (at < end && *at != '\n' && *at != '#' && size < sizeof line - 1)
        line[size++] = *at++;
    line[size] = '\0';
    int count = 0;
    for (char *c = line, *after; count < 4; c = after, count++) {
        number[count] = strtol(c, &after, 10);
        if (after == c)
            break;
    }
    return count;
}

static const char *looks_like_tetgen(const char *at, const char *end)
{
    long number[4];
    int count = header(at, end, number);
    if (count >= 2 && number[1] == 3)
        return "a TetGen .node file: use tetgen-import (with its .ele), or tetgen-mesh";
    if (count >= 2 && (number[1] == 4 || number[1] == 10))
        return "a TetGen .ele file: use tetgen-import (with its .node)";
    if (count >= 1)
        return "a file of numbers, perhaps TetGen's: use tetgen-import";
    return "text";
}

/* A line of 2 for text and the type, then one with the number of points alone; or a digit
 * for the byte order and the type as four bytes. */
static bool looks_like_visf(const char *bytes, const char *end)
{
    enum { BINARY_HEAD = 5 };
    long number[4];
    const char *second = memchr(bytes, '\n', (size_t)(end - bytes));
    if (second && header(bytes, end, number) == 2 && number[0] == 2 && number[1] >= 0 &&
        number[1] <= 2)
        return header(second + 1, end, number) == 1;
    if (end - bytes < BINARY_HEAD || (bytes[0] != '0' && bytes[0] != '1'))
        return false;
    const unsigned char *type = (const unsigned char *)bytes + 1;
    return type[1] == 0 && type[2] == 0 && type[0] + type[3] <= 2;
}

static bool is_binary(const char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (bytes[i] == '\0' ||
            (iscntrl((unsigned char)bytes[i]) && !isspace((unsigned char)bytes[i])))
            return true;
    return false;
}

const char *tm_looks_like(const char *bytes, size_t size)
{
    const char *end = bytes + size;
    if (size == 0)
        return "an empty file";
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        size_t length = strlen(known[k].begins);
        if (size >= length && memcmp(bytes, known[k].begins, length) == 0)
            return known[k].what;
    }
    if (looks_like_visf(bytes, end))
        return "a ViSF mesh: use visf-import";
    if (is_binary(bytes, size < 256 ? size : 256))
        return "binary data, perhaps an STL surface: use tetgen-mesh";
    const char *line = first_line(bytes, end);
    if (end - line >= 2 && memcmp(line, "v ", 2) == 0)
        return "an OBJ surface: use tetgen-mesh";
    return looks_like_tetgen(line, end);
}
