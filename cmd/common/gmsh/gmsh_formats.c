/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_formats.h"

#include "../../../lib/text/input.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

const char *const gmsh_input_name[GMSH_INPUTS] = {
    "msh", "mesh", "unv", "vtk", "med", "bdf", "cgns", "stl", "ply", "ply2", "wrl"};

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

static gmsh_input by_content(const gmsh_file *file)
{
    const tm_text *bytes = &file->head;
    const char *end = bytes->byte + bytes->size;
    for (size_t i = 0; bytes->size > 0 && i < HEADS; i++)
        if (begins(heads[i].format == GMSH_MSH ? bytes->byte
                                               : first_word(bytes->byte, end),
                   end, heads[i].begins))
            return heads[i].format;
    return GMSH_INPUTS;
}

gmsh_input gmsh_input_of(const char *name, const gmsh_file *file)
{
    const gmsh_input format = name ? by_suffix(name) : GMSH_INPUTS;
    return format == GMSH_INPUTS ? by_content(file) : format;
}

/* The last line that is not blank: where it begins; *size without its line feed. */
static const char *last_line(const tm_text *tail, size_t *size)
{
    size_t end = tail->size;
    while (end > 0 && strchr(" \t\r\n", tail->byte[end - 1]))
        end--;
    const char *feed = end > 0 ? memrchr(tail->byte, '\n', end) : NULL;
    const char *line = feed ? feed + 1 : tail->byte;
    *size = end > 0 ? (size_t)(tail->byte + end - line) : 0;
    return line;
}

/* Whether a word is the end of a section, and not of one of Gmsh's own that is cut. */
static bool is_end(const char *word, size_t size)
{
    static const char *const ends[] = {"$EndMeshFormat",
                                       "$EndPhysicalNames",
                                       "$EndEntities",
                                       "$EndPartitionedEntities",
                                       "$EndNodes",
                                       "$EndElements",
                                       "$EndPeriodic",
                                       "$EndGhostElements",
                                       "$EndParametrizations",
                                       "$EndNodeData",
                                       "$EndElementData",
                                       "$EndElementNodeData",
                                       "$EndInterpolationScheme",
                                       "$EndComments",
                                       "$ENDNOD",
                                       "$ENDELM"};
    enum { MARK = 4 };
    bool is_cut = size <= MARK;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        const size_t length = strlen(ends[i]);
        if (size == length && memcmp(word, ends[i], size) == 0)
            return true;
        is_cut |= size < length && memcmp(word, ends[i], size) == 0;
    }
    return !is_cut && strncasecmp(word, "$End", MARK) == 0;
}

static tm_status check_msh(const gmsh_file *file, const char *name, tm_error *error)
{
    size_t size;
    if (by_content(file) != GMSH_MSH)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "does not begin as a .msh file ($MeshFormat, or $NOD of "
                          "version 1, would be right)");
    const char *line = last_line(&file->tail, &size);
    if (!is_end(line, size))
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is cut short: it does not end with the end of a section "
                          "($EndElements in most files)");
    return TM_OK;
}

static tm_status check_medit(const gmsh_file *file, const char *name, tm_error *error)
{
    static const char end[] = "end";
    size_t size;
    if (file->size > 0 && (file->head.byte[0] == '\0' || file->head.byte[0] == '\1'))
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is a binary file of Medit (.meshb), which Gmsh does not read "
                          "(text, .mesh, would be right)");
    if (by_content(file) != GMSH_MEDIT)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "does not begin as a .mesh file of Medit "
                          "(MeshVersionFormatted would be right)");
    const char *line = last_line(&file->tail, &size);
    while (size > 0 && strchr(" \t", *line)) {
        line++;
        size--;
    }
    if (size != sizeof end - 1 || strncasecmp(line, end, size) != 0)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL,
                          "is cut short: it does not end with End");
    return TM_OK;
}

tm_status gmsh_input_check(gmsh_input format, const gmsh_file *file, const char *name,
                           tm_error *error)
{
    switch (format) {
    case GMSH_MSH:
        return check_msh(file, name, error);
    case GMSH_MEDIT:
        return check_medit(file, name, error);
    default:
        if (file->size > 0)
            return TM_OK;
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL, "is empty");
    }
}

bool gmsh_input_is_old(const gmsh_file *file)
{
    static const char word[] = "$MeshFormat";
    const char *at = file->size > 0
                         ? memmem(file->head.byte, file->head.size, word, sizeof word - 1)
                         : NULL;
    return !at || strtod(at + sizeof word - 1, NULL) < 4;
}

/* The file ------------------------------------------------------------------------- */

/* Some bytes from `at` on, which are there. */
static tm_status peek(tm_text *text, int fd, size_t at, size_t size, const char *name,
                      tm_error *error)
{
    if (!tm_text_room(text, size + 1))
        return tm_fail_memory(error);
    const ptrdiff_t got = pread(fd, text->byte, size, (off_t)at);
    if (got != (ptrdiff_t)size)
        return tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL, "cannot read: %s",
                          got < 0 ? strerror(errno) : "it became shorter");
    text->size = size;
    text->byte[size] = '\0';
    return TM_OK;
}

tm_status gmsh_file_look(gmsh_file *file, int fd, const char *name, tm_error *error)
{
    struct stat is;
    *file = (gmsh_file){.fd = fd};
    if (fstat(fd, &is) != 0)
        return tm_fail_at(error, TM_ERROR_SYSTEM, name, 0, NULL, "cannot read: %s",
                          strerror(errno));
    file->size = (size_t)is.st_size;
    const size_t size = file->size < GMSH_PEEK ? file->size : GMSH_PEEK;
    const tm_status status = peek(&file->head, fd, 0, size, name, error);
    return status == TM_OK ? peek(&file->tail, fd, file->size - size, size, name, error)
                           : status;
}

void gmsh_file_free(gmsh_file *file)
{
    tm_text_free(&file->head);
    tm_text_free(&file->tail);
}
