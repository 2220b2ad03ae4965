/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sniff.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SURFACE  "use tetgen-mesh, octree-mesh or surface-import"
#define NONE     "no filter reads it"
#define NONE_YET "no filter reads it yet"
#define GMSH     "use gmsh-import"

typedef struct row {
    const char *begins;
    tm_look look;
} row;

/* Of these the very first bytes. */
static const row magic[] = {
    {"# vtk DataFile", {"a legacy VTK file", "use vtk-import"}},
    {"\xFF\xFE", {"UTF-16 text", "save it as UTF-8 or ASCII"}},
    {"\xFE\xFF", {"UTF-16 text", "save it as UTF-8 or ASCII"}},
    {"\x1F\x8B", {"gzip data within gzip data", "unpack it with zcat"}},
    {"BZh", {"bzip2 data", "unpack it with bzcat"}},
    {"\xFD"
     "7zXZ",
     {"xz data", "unpack it with xzcat"}},
    {"\x28\xB5\x2F\xFD", {"Zstandard data", "unpack it with zstdcat"}},
    {"PK\x03\x04", {"a zip archive", "unpack it with unzip"}},
    {"7z\xBC\xAF", {"a 7z archive", "unpack it with 7z"}},
    {"version https://git-lfs",
     {"a pointer of Git LFS", "get the file with git lfs pull"}},
    {"%PDF", {"a PDF document", NONE}},
    {"%!PS", {"a PostScript document", NONE}},
    {"\x89PNG", {"a PNG image", NONE}},
    {"\xFF\xD8\xFF", {"a JPEG image", NONE}},
    {"GIF8", {"a GIF image", NONE}},
    {"\x7F"
     "ELF",
     {"a program", NONE}},
    {"\x89HDF",
     {"an HDF5 file (CGNS, MED, Exodus)",
      GMSH " of a file named .cgns or .med, where Gmsh reads these"}},
    {"CDF\x01", {"a netCDF file (Exodus)", NONE_YET}},
    {"CDF\x02", {"a netCDF file (Exodus)", NONE_YET}},
};

/* Of these the first line that has more than blanks and a comment behind '#'. What is a
 * beginning of another one stands behind it. */
static const row words[] = {
    {"termesh 1\n", {"a termesh stream", "it needs no import"}},
    {"termesh", {"a termesh stream of another version than 1", NONE}},
    {"solid", {"an STL surface", SURFACE}},
    {"SOLID", {"an STL surface", SURFACE}},
    {"ply\n", {"a PLY surface", SURFACE}},
    {"ply\r", {"a PLY surface", SURFACE}},
    {"v ", {"an OBJ surface", SURFACE}},
    {"vn ", {"an OBJ surface", SURFACE}},
    {"vt ", {"an OBJ surface", SURFACE}},
    {"f ", {"an OBJ surface", SURFACE}},
    {"g ", {"an OBJ surface", SURFACE}},
    {"o ", {"an OBJ surface", SURFACE}},
    {"mtllib ", {"an OBJ surface", SURFACE}},
    {"usemtl ", {"an OBJ surface", SURFACE}},
    {"n_regions", {"a file of boxes", "use octree-mesh -b"}},
    {"MIXED", {"an .mvm mesh", "use m3d-import"}},
    {"MeshVersionFormatted", {"a Medit mesh", "use medit-import"}},
    {"$MeshFormat", {"a Gmsh mesh", GMSH}},
    {"$Comments", {"a Gmsh mesh", GMSH}},
    {"$NOD", {"a Gmsh mesh of version 1", GMSH}},
    {"ISO-10303-21", {"a STEP file", NONE_YET}},
    {"DBRep_Drawable", {"a BRep file of Open CASCADE", NONE_YET}},
    {"mesh3d", {"a Netgen mesh", NONE_YET}},
    {"BEGIN POINTS LIST", {"a GetFEM mesh", NONE_YET}},
    {"*KEYWORD", {"an LS-DYNA input file", NONE_YET}},
    {"*", {"an Abaqus or CalculiX input file", "use abaqus-import"}},
    {"SOL ", {"a Nastran input file", GMSH " of a file named .bdf"}},
    {"CEND", {"a Nastran input file", GMSH " of a file named .bdf"}},
    {"BEGIN BULK", {"a Nastran input file", GMSH " of a file named .bdf"}},
    {"GRID", {"a Nastran input file", GMSH " of a file named .bdf"}},
    {"/*--", {"an OpenFOAM file", "use openfoam-import with its folder"}},
    {"FoamFile", {"an OpenFOAM file", "use openfoam-import with its folder"}},
    {"{\"", {"JSON", NONE}},
};

static bool begins(const char *at, const char *end, const char *with)
{
    size_t length = strlen(with);
    return (size_t)(end - at) >= length && memcmp(at, with, length) == 0;
}

static bool holds(const char *at, const char *end, const char *word)
{
    return memmem(at, (size_t)(end - at), word, strlen(word)) != NULL;
}

static const tm_look *look_up(const row *table, size_t rows, const char *at,
                              const char *end)
{
    for (size_t r = 0; r < rows; r++)
        if (begins(at, end, table[r].begins))
            return &table[r].look;
    return NULL;
}
#define LOOK_UP(table, at, end) look_up(table, sizeof(table) / sizeof *(table), at, end)

size_t tm_byte_order_mark(const char *bytes, size_t size)
{
    static const char mark[] = "\xEF\xBB\xBF";
    return begins(bytes, bytes + size, mark) ? sizeof mark - 1 : 0;
}

/* Skips lines that are blank or begin with the sign of a comment. */
static const char *first_line(const char *at, const char *end, char comment)
{
    while (at < end) {
        const char *c = at;
        while (c < end && (*c == ' ' || *c == '\t' || *c == '\r'))
            c++;
        if (c < end && *c != '\n' && *c != comment)
            return c;
        while (c < end && *c != '\n')
            c++;
        at = c < end ? c + 1 : end;
    }
    return end;
}

/* Text ----------------------------------------------------------------------------- */

/* OFF, or up to six letters of its variants before it. */
static bool is_off(const char *at, const char *end)
{
    enum { VARIANTS = 6 };
    size_t letters = 0;
    while (letters < VARIANTS && at + letters < end &&
           !begins(at + letters, end, "OFF") && strchr("STCN4n", at[letters]))
        letters++;
    return begins(at + letters, end, "OFF");
}

/* Sections of the mixed-element octree mesher, in any order. */
static tm_look look_at_sections(const char *at, const char *end)
{
    if (holds(at, end, "ARRAY1<POINT3D>]"))
        return (tm_look){"an .mdl surface",
                         "use mdl-import, tetgen-mesh, octree-mesh or surface-import"};
    if (holds(at, end, "[Nodes,") || holds(at, end, "[Elements,"))
        return (tm_look){"an .m3d mesh", "use m3d-import"};
    return (tm_look){"text", NULL};
}

static tm_look look_at_markup(const char *at, const char *end)
{
    if (holds(at, end, "<VTKFile"))
        return (tm_look){"an XML file of VTK (.vtu)", "use vtu-import"};
    if (holds(at, end, "<html") || holds(at, end, "<HTML"))
        return (tm_look){"an HTML page, perhaps of a server that had no file", NONE};
    return (tm_look){"XML", NONE};
}

/* The first line has the letter S in column 73. */
static bool is_iges(const char *at, const char *end)
{
    enum { COLUMN = 72, LINE = 80 };
    return end - at > LINE && at[COLUMN] == 'S' && isspace((unsigned char)at[LINE]) &&
           !memchr(at, '\n', LINE);
}

/* What stands behind comments that begin with another sign, if that is the kind of file
 * that has such comments. */
static const tm_look *look_behind(const char *at, const char *end, char comment,
                                  const char *kind)
{
    const tm_look *look = LOOK_UP(words, first_line(at, end, comment), end);
    return *at == comment && look && strstr(look->what, kind) ? look : NULL;
}

/* Numbers -------------------------------------------------------------------------- */

enum { NUMBERS = 4 };

/* Whole numbers of a header line such as TetGen's files begin with; at most so many are
 * taken. */
static int header(const char *at, const char *end, long number[NUMBERS])
{
    char line[128];
    size_t size = 0;
    while (at < end && *at != '\n' && *at != '#' && size < sizeof line - 1)
        line[size++] = *at++;
    line[size] = '\0';
    int count = 0;
    for (char *c = line, *after; count < NUMBERS; c = after, count++) {
        number[count] = strtol(c, &after, 10);
        if (after == c)
            break;
    }
    return count;
}

/* Counts of points, edges and octants, of which a cube has 8, 12 and 1. */
static bool is_oct(int count, const long number[NUMBERS])
{
    enum { POINTS = 8, EDGES = 12 };
    return count > 2 && number[0] >= POINTS && number[1] >= EDGES && number[2] > 0;
}

static tm_look look_at_numbers(const char *at, const char *end)
{
    enum { CORNERS = 4, NODES = 10 };
    long number[NUMBERS];
    int count = header(at, end, number);
    if (count == 0)
        return (tm_look){"text", NULL};
    if (count > 1 && number[1] == 3)
        return (tm_look){"a TetGen .node, .poly or .smesh file",
                         "use tetgen-mesh, octree-mesh or surface-import, or "
                         "tetgen-import of a .node "
                         "file with its .ele"};
    if (count > 1 && (number[1] == CORNERS || number[1] == NODES))
        return (tm_look){"a TetGen .ele file", "use tetgen-import with its .node"};
    if (count == 2 && (number[1] == 0 || number[1] == 1))
        return (tm_look){"a TetGen .face or .edge file",
                         "use tetgen-import with its .node"};
    if (is_oct(count, number))
        return (tm_look){"an .oct file", "use oct-import"};
    return (tm_look){"a file of numbers", NULL};
}

/* A line of 2 for text and the type, then one with the number of points alone; or a digit
 * for the byte order and the type as four bytes. */
static bool is_visf(const char *bytes, const char *end)
{
    enum { BINARY_HEAD = 5 };
    long number[NUMBERS];
    const char *second = memchr(bytes, '\n', (size_t)(end - bytes));
    if (second && header(bytes, end, number) == 2 && number[0] == 2 && number[1] >= 0 &&
        number[1] <= 2)
        return header(second + 1, end, number) == 1;
    if (end - bytes < BINARY_HEAD || (bytes[0] != '0' && bytes[0] != '1'))
        return false;
    const unsigned char *type = (const unsigned char *)bytes + 1;
    return type[1] == 0 && type[2] == 0 && type[0] + type[3] <= 2;
}

/* Binary --------------------------------------------------------------------------- */

/* The numbers 1, a version from 1 to 4, and 3 for Dimension, of four bytes each. */
static bool is_medit(const char *bytes, size_t size)
{
    enum { HEAD = 12, LAST = 3, VERSION = 4, VERSIONS = 4, CODE = 8, DIMENSION = 3 };
    if (size < HEAD || bytes[1] != 0 || bytes[2] != 0)
        return false;
    const size_t low = bytes[0] == 1 ? 0 : LAST;
    return bytes[low] == 1 && bytes[LAST - low] == 0 && bytes[VERSION + low] >= 1 &&
           bytes[VERSION + low] <= VERSIONS && bytes[CODE + low] == DIMENSION;
}

static bool is_binary(const char *bytes, size_t size)
{
    enum { ENOUGH = 256 };
    for (size_t i = 0; i < size && i < ENOUGH; i++)
        if (bytes[i] == '\0' ||
            (iscntrl((unsigned char)bytes[i]) && !isspace((unsigned char)bytes[i])))
            return true;
    return false;
}

static bool is_tar(const char *bytes, size_t size)
{
    enum { AT = 257 };
    static const char tar[] = "ustar";
    return size > AT + sizeof tar && memcmp(bytes + AT, tar, sizeof tar - 1) == 0;
}

/* ---------------------------------------------------------------------------------- */

tm_look tm_look_at(const char *bytes, size_t size)
{
    if (size == 0)
        return (tm_look){"an empty file", NULL};
    const char *end = bytes + size;
    const tm_look *known = LOOK_UP(magic, bytes, end);
    if (known)
        return *known;
    const char *at = first_line(bytes + tm_byte_order_mark(bytes, size), end, '#');
    known = LOOK_UP(words, at, end);
    if (known)
        return *known;
    if (is_visf(bytes, end))
        return (tm_look){"a ViSF mesh", "use visf-import"};
    if (is_off(at, end))
        return (tm_look){"an OFF surface", SURFACE};
    if (is_medit(bytes, size))
        return (tm_look){"a Medit mesh", "use medit-import"};
    if (is_tar(bytes, size))
        return (tm_look){"a tar archive", "unpack it with tar"};
    if (is_binary(bytes, size))
        return (tm_look){"binary data, perhaps an STL surface", SURFACE};
    if (at == end)
        return (tm_look){"text", NULL};
    if (*at == '[')
        return look_at_sections(at, end);
    if (*at == '<')
        return look_at_markup(at, end);
    known = look_behind(at, end, '$', "Nastran");
    if (!known)
        known = look_behind(at, end, '%', "GetFEM");
    if (known)
        return *known;
    if (is_iges(bytes, end))
        return (tm_look){"an IGES file", NONE_YET};
    return look_at_numbers(at, end);
}
