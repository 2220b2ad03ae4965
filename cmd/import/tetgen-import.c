/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tetgen-import: TetGen's files as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/text/input.h"
#include "../../lib/format/tetgen.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct option options[] = {FILTER_OPTIONS};

static filter f = {
    .name = "tetgen-import",
    .synopsis = "[options] BASE | FILE…",
    .purpose = "Read BASE.node, BASE.ele, BASE.face, BASE.edge and BASE.group, or the "
               "FILEs, of\n"
               "TetGen.",
    .help = "",
    .options = options,
    .letters = FILTER_LETTERS,
};

/* In the order in which a stream has them: the nodes first, others refer to them. */
static const char *const suffixes[] = {".node", ".ele", ".face", ".edge", ".group"};
enum { SUFFIXES = sizeof suffixes / sizeof suffixes[0] };

typedef struct {
    char *path; /* NULL once it is read */
    char *name; /* without .gz at its end */
} tetgen_file;

/* The files that were named. */
typedef struct {
    tetgen_file *file;
    size_t count;
    char *stem; /* the first one's, without its suffix */
} operands;

static tm_error error;

static void succeed(tm_status status)
{
    if (status != TM_OK)
        filter_fail(&f, &error);
}

/* Which suffix the name ends in, or SUFFIXES. */
static size_t suffix_of(const char *name)
{
    size_t s = 0, size = strlen(name);
    while (s < SUFFIXES && (size <= strlen(suffixes[s]) ||
                            strcmp(name + size - strlen(suffixes[s]), suffixes[s]) != 0))
        s++;
    return s;
}

static char *joined(const char *first, size_t size, const char *second)
{
    tm_text text = {0};
    tm_text_append(&text, first, size);
    tm_text_string(&text, second);
    if (text.failed)
        succeed(tm_fail_memory(&error));
    return text.byte;
}

static void add_file(operands *named, const char *path)
{
    named->file[named->count++] = (tetgen_file){joined(path, strlen(path), ""),
                                                joined(path, tm_unpacked_name(path), "")};
}

/* A file of that name that is none of TetGen's, and no .node file beside it. */
static void refuse_other_file(const char *base)
{
    char *node = joined(base, strlen(base), suffixes[0]);
    const bool is_base = access(node, F_OK) == 0 || access(base, R_OK) != 0;
    free(node);
    if (is_base)
        return;
    tm_text bytes = {0};
    filter_read_file(&f, base, &bytes);
    tm_fail_at(
        &error, TM_ERROR_INPUT, base, 0, NULL,
        "the name of a file of TetGen ends in .node, .ele, .face, .edge or .group");
    filter_fail_file(&f, &error, &bytes, f.name);
}

/* BASE stands for those of the four files that are there, or are there with .gz. */
static void expand_base(const char *base, operands *named)
{
    named->stem = joined(base, strlen(base), "");
    for (size_t s = 0; s < SUFFIXES; s++) {
        char *plain = joined(base, strlen(base), suffixes[s]);
        char *packed = joined(plain, strlen(plain), ".gz");
        const bool is_packed = access(plain, F_OK) != 0 && access(packed, F_OK) == 0;
        if (is_packed)
            add_file(named, packed);
        else if (s == 0 || access(plain, F_OK) == 0)
            add_file(named, plain);
        free(plain);
        free(packed);
    }
}

/* Where no .node file is among those that are named, that beside the first one. */
static void find_nodes(operands *named)
{
    for (size_t i = 0; i < named->count; i++)
        if (suffix_of(named->file[i].name) == 0)
            return;
    const char *name = named->file[0].name;
    const size_t size = strlen(name) - strlen(suffixes[suffix_of(name)]);
    char *plain = joined(name, size, suffixes[0]);
    char *packed = joined(plain, strlen(plain), ".gz");
    if (access(plain, F_OK) == 0)
        add_file(named, plain);
    else if (access(packed, F_OK) == 0)
        add_file(named, packed);
    free(plain);
    free(packed);
}

static void read_operands(operands *named)
{
    int c = filter_option(&f);
    if (c != -1)
        filter_usage_error(&f, "option -%c is unknown", c);
    int given = f.argc - optind;
    if (given == 0)
        filter_usage_error(&f, "BASE or FILE is missing");
    f.input = f.argv[optind];
    named->file = calloc((size_t)given + SUFFIXES, sizeof *named->file);
    if (!named->file)
        succeed(tm_fail_memory(&error));
    char *unpacked = joined(f.input, tm_unpacked_name(f.input), "");
    const bool is_base = given == 1 && suffix_of(unpacked) == SUFFIXES;
    free(unpacked);
    if (is_base) {
        refuse_other_file(f.input);
        expand_base(f.input, named);
        return;
    }
    for (int i = optind; i < f.argc; i++) {
        add_file(named, f.argv[i]);
        if (suffix_of(named->file[named->count - 1].name) == SUFFIXES)
            filter_usage_error(&f,
                               "'%s': the name of a FILE ends in .node, .ele, .face, "
                               ".edge or .group, or in one of these and .gz",
                               f.argv[i]);
    }
    find_nodes(named);
    const char *first = named->file[0].name;
    size_t size = strlen(first) - strlen(suffixes[suffix_of(first)]);
    named->stem = joined(f.input, size, "");
}

/* Letters, digits, '-' and '_', of which no digit is the first, then a suffix. */
static bool is_name_of_part(const char *name)
{
    size_t part = strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                               "0123456789-_");
    return part > 0 && (*name < '0' || *name > '9') && suffix_of(name) < SUFFIXES &&
           strcmp(name + part, suffixes[suffix_of(name)]) == 0 &&
           strlen(name) < TM_BLOCK_NAME;
}

/* "surface.node" of STEM.surface.node; the suffix alone for the main mesh, and for files
 * of another stem. */
static const char *block_name(const operands *named, const char *file)
{
    size_t size = strlen(named->stem);
    const char *rest = file + size;
    if (strncmp(file, named->stem, size) == 0 && *rest == '.' &&
        is_name_of_part(rest + 1))
        return rest + 1;
    return suffixes[suffix_of(file)];
}

static void read_block(const char *file, tm_block *block, tm_tetgen_nodes *nodes)
{
    tm_text bytes = {0};
    filter_read_file(&f, file, &bytes);
    if (tm_tetgen_read(block, bytes.byte, bytes.size, file, nodes, &error) != TM_OK)
        filter_fail_file(&f, &error, &bytes, f.name);
    tm_text_free(&bytes);
}

/* Reads a file into a new block; the file is then done with. */
static void read_file(tm_stream *stream, tetgen_file *from, const char *name,
                      tm_tetgen_nodes *nodes)
{
    if (tm_stream_find(stream, name))
        succeed(tm_fail_at(&error, TM_ERROR_INPUT, from->path, 0, name,
                           "there is a second file for this block (one is right)"));
    tm_block *block = tm_stream_add(stream, name);
    if (!block)
        succeed(tm_fail_memory(&error));
    read_block(from->path, block, nodes);
    free(from->path);
    from->path = NULL;
}

/* Of elements of second order the nodes in the middle of edges go, which their corners
 * leave out. */
static void drop_middles(tm_stream *stream, const char *node, int part,
                         tm_tetgen_nodes *nodes)
{
    tm_block *other[3];
    char name[TM_BLOCK_NAME];
    size_t dropped;
    if (!nodes->middle)
        return;
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "%.*s%s", part, node, suffixes[i + 1]);
        other[i] = tm_stream_find(stream, name);
    }
    succeed(tm_tetgen_drop_middles(nodes, tm_stream_find(stream, node), other, &dropped,
                                   &error));
    filter_leave_out(&f,
                     "%zu nodes of tetrahedra of second order (%.*s.ele), of which the "
                     "corners are taken",
                     dropped, part, node);
}

/* Reads a .node file and the other files of its part, which may be numbered from
 * another base than those of other parts. */
static void read_part(tm_stream *stream, operands *named, size_t node_file)
{
    char node[TM_BLOCK_NAME], name[TM_BLOCK_NAME];
    tm_tetgen_nodes nodes = {.base = 1};
    snprintf(node, sizeof node, "%s", block_name(named, named->file[node_file].name));
    read_file(stream, &named->file[node_file], node, &nodes);
    if (node[0] == '.')
        stream->base = nodes.base;
    int part = (int)(strlen(node) - strlen(suffixes[0]));
    for (size_t s = 1; s < SUFFIXES; s++) {
        snprintf(name, sizeof name, "%.*s%s", part, node, suffixes[s]);
        for (size_t i = 0; i < named->count; i++)
            if (named->file[i].path &&
                strcmp(block_name(named, named->file[i].name), name) == 0)
                read_file(stream, &named->file[i], name, &nodes);
    }
    drop_middles(stream, node, part, &nodes);
    tm_tetgen_nodes_free(&nodes);
}

/* The main mesh first, then the parts. */
static void read_files(tm_stream *stream, operands *named)
{
    for (int parts = 0; parts < 2; parts++)
        for (size_t i = 0; i < named->count; i++) {
            const char *name = named->file[i].name;
            if (named->file[i].path && suffix_of(name) == 0 &&
                (block_name(named, name)[0] != '.') == parts)
                read_part(stream, named, i);
        }
    for (size_t i = 0; i < named->count; i++)
        if (named->file[i].path)
            succeed(tm_fail_at(&error, TM_ERROR_INPUT, named->file[i].path, 0, NULL,
                               "its .node file is not among the files"));
}

static void orient(const tm_stream *stream, const char *node, const char *ele,
                   tm_turned *sum)
{
    tm_block *tetrahedra = tm_stream_find(stream, ele);
    if (!tetrahedra)
        return;
    tm_turned result = tm_tetgen_orient(tm_stream_find(stream, node), tetrahedra);
    sum->turned += result.turned;
    sum->flat += result.flat;
    if (result.turned > 0)
        filter_note(&f, "%s: %zu of %zu tetrahedra were turned to be right-hand positive",
                    ele, result.turned, tetrahedra->count);
    if (result.flat > 0)
        filter_note(&f, "%s: %zu of %zu tetrahedra are flat", ele, result.flat,
                    tetrahedra->count);
}

static tm_turned orient_all(const tm_stream *stream)
{
    tm_turned sum = {0};
    for (size_t b = 0; b < stream->blocks; b++) {
        const char *node = stream->block[b].name;
        if (stream->block[b].kind != TM_NODE)
            continue;
        char ele[TM_BLOCK_NAME];
        snprintf(ele, sizeof ele, "%.*s.ele", (int)(strlen(node) - strlen(suffixes[0])),
                 node);
        orient(stream, node, ele, &sum);
    }
    return sum;
}

int main(int argc, char **argv)
{
    operands named = {0};
    tm_stream stream;
    filter_start(&f, argc, argv);
    read_operands(&named);
    tm_stream_init(&stream);
    read_files(&stream, &named);
    tm_turned turned = orient_all(&stream);
    if (f.json) {
        tm_json *json = filter_json_begin(&f);
        mesh_rows_json(json, &stream);
        tm_json_integer(json, "turned", (int64_t)turned.turned);
        tm_json_integer(json, "flat", (int64_t)turned.flat);
        filter_json_end(&f);
    }
    filter_write(&f, &stream, "%zu nodes, %zu tetrahedra", mesh_rows(&stream, ".node"),
                 mesh_rows(&stream, ".ele"));
    tm_stream_free(&stream);
    for (size_t i = 0; i < named.count; i++)
        free(named.file[i].name);
    free(named.file);
    free(named.stem);
    return filter_finish(&f, EXIT_SUCCESS);
}
