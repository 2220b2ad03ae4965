/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_formats.h"

#include "../../../lib/stream/sniff.h"
#include "../../../lib/text/input.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *const gmsh_input_name[GMSH_INPUTS] = {"msh", "mesh", "unv",  "vtk",
                                                  "med", "bdf",  "cgns", "stl",
                                                  "ply", "ply2", "wrl",  "diff"};

/* Beside those names. */
static const struct {
    const char *suffix;
    gmsh_input format;
} others[] = {{"msh1", GMSH_MSH},  {"msh2", GMSH_MSH},    {"msh22", GMSH_MSH},
              {"msh3", GMSH_MSH},  {"msh4", GMSH_MSH},    {"msh40", GMSH_MSH},
              {"msh41", GMSH_MSH}, {"meshb", GMSH_MEDIT}, {"nas", GMSH_BDF},
              {"mmed", GMSH_MED},  {"rmed", GMSH_MED},    {"vrml", GMSH_WRL}};

/* What the formats begin with that can be told by that alone. Of others a suffix or an
 * option has to say it: another filter may read them. */
static const struct {
    const char *begins;
    gmsh_input format;
} heads[] = {{"$MeshFormat", GMSH_MSH}, {"$NO", GMSH_MSH},
             {"$ELM", GMSH_MSH},        {"$PARA", GMSH_MSH},
             {"$Comments", GMSH_MSH},   {"MeshVersionFormatted", GMSH_MEDIT}};

enum { HEADS = sizeof heads / sizeof *heads, OTHERS = sizeof others / sizeof *others };

static gmsh_input by_suffix(const char *name)
{
    const size_t size = tm_unpacked_name(name);
    const char *dot = memrchr(name, '.', size);
    if (!dot)
        return GMSH_INPUTS;
    const char *suffix = dot + 1;
    const size_t length = (size_t)(name + size - suffix);
    for (gmsh_input i = 0; i < GMSH_INPUTS; i++)
        if (strlen(gmsh_input_name[i]) == length &&
            strncasecmp(gmsh_input_name[i], suffix, length) == 0)
            return i;
    for (size_t i = 0; i < OTHERS; i++)
        if (strlen(others[i].suffix) == length &&
            strncasecmp(others[i].suffix, suffix, length) == 0)
            return others[i].format;
    return GMSH_INPUTS;
}

static bool begins(const char *at, const char *end, const char *with)
{
    const size_t size = strlen(with);
    return (size_t)(end - at) >= size && memcmp(at, with, size) == 0;
}

/* Behind blank lines, and comments of Medit. */
static const char *first_word(const char *at, const char *end)
{
    while (at < end && (strchr(" \t\r\n", *at) || *at == '#')) {
        const char *feed = memchr(at, '\n', (size_t)(end - at));
        if (*at == '#')
            at = feed ? feed : end;
        else
            at++;
    }
    return at;
}

static gmsh_input by_content(const tm_text *bytes)
{
    const char *end = bytes->byte + bytes->size;
    for (size_t i = 0; bytes->size > 0 && i < HEADS; i++)
        if (begins(heads[i].format == GMSH_MSH ? bytes->byte
                                               : first_word(bytes->byte, end),
                   end, heads[i].begins))
            return heads[i].format;
    return GMSH_INPUTS;
}

gmsh_input gmsh_input_of(const char *name, const tm_text *bytes)
{
    const gmsh_input format = name ? by_suffix(name) : GMSH_INPUTS;
    return format == GMSH_INPUTS ? by_content(bytes) : format;
}

/* The last line that is not blank: where it begins; *size without its line feed. */
static const char *last_line(const tm_text *bytes, size_t *size)
{
    size_t end = bytes->size;
    while (end > 0 && strchr(" \t\r\n", bytes->byte[end - 1]))
        end--;
    const char *feed = end > 0 ? memrchr(bytes->byte, '\n', end) : NULL;
    const char *line = feed ? feed + 1 : bytes->byte;
    *size = (size_t)(bytes->byte + end - line);
    return line;
}

/* Whether there is a line of these words before `end`. */
static bool has_line(const tm_text *bytes, const char *end, const char *words,
                     size_t size)
{
    for (const char *at = bytes->byte; at < end; at++) {
        at = memmem(at, (size_t)(end - at), words, size);
        if (!at)
            return false;
        if ((at == bytes->byte || at[-1] == '\n') && strchr(" \r\n", at[size]))
            return true;
    }
    return false;
}

/* Whether the file ends with the end of a section that is in it. */
static bool has_end(const tm_text *bytes)
{
    static const char *const marks[] = {"$End", "$END"};
    size_t size;
    const char *line = last_line(bytes, &size);
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        const size_t length = strlen(marks[i]);
        if (size <= length || memcmp(line, marks[i], length) != 0)
            continue;
        tm_text begin = {0};
        tm_text_string(&begin, "$");
        tm_text_append(&begin, line + length, size - length);
        const bool is_there =
            begin.failed || has_line(bytes, line, begin.byte, begin.size);
        tm_text_free(&begin);
        return is_there;
    }
    return false;
}

static tm_status check_msh(const tm_text *bytes, const char *name, tm_error *error)
{
    if (by_content(bytes) != GMSH_MSH)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "does not begin as a .msh file ($MeshFormat, or $NOD of "
                          "version 1, would be right)");
    if (!has_end(bytes))
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is cut short: it does not end with the end of a section, "
                          "$End… ($EndElements, in most files)");
    return TM_OK;
}

static tm_status check_medit(const tm_text *bytes, const char *name, tm_error *error)
{
    if (bytes->size > 0 && (bytes->byte[0] == '\0' || bytes->byte[0] == '\1'))
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is a binary file of Medit (.meshb), which Gmsh does not read "
                          "(text, .mesh, would be right)");
    if (by_content(bytes) != GMSH_MEDIT)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "does not begin as a .mesh file of Medit "
                          "(MeshVersionFormatted would be right)");
    return TM_OK;
}

tm_status gmsh_input_check(gmsh_input format, const tm_text *bytes, const char *name,
                           tm_error *error)
{
    switch (format) {
    case GMSH_MSH:
        return check_msh(bytes, name, error);
    case GMSH_MEDIT:
        return check_medit(bytes, name, error);
    default:
        if (bytes->size > 0)
            return TM_OK;
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL, "is empty");
    }
}

bool gmsh_input_is_old(const tm_text *bytes)
{
    static const char word[] = "$MeshFormat";
    const char *at = memmem(bytes->byte, bytes->size, word, sizeof word - 1);
    return !at || strtod(at + sizeof word - 1, NULL) < 4;
}
