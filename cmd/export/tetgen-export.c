/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tetgen-export: a stream as TetGen's files. */
#include "../common/app/filter.h"
#include "../common/app/output_files.h"
#include "../common/input/left_out.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct option options[] = {FILTER_OPTIONS};

static filter f = {
    .name = "tetgen-export",
    .synopsis = "[options] BASE [FILE]",
    .purpose = "Write the blocks of a stream as the TetGen files BASE.node, BASE.ele, …",
    .help = "",
    .options = options,
    .letters = FILTER_LETTERS,
};

static const char *const suffixes[] = {".node", ".ele", ".face", ".edge", ".group"};
enum { SUFFIXES = sizeof suffixes / sizeof *suffixes };

/* A name with the suffix of one of the files stands for all of them. */
static void drop_suffix(char *base)
{
    const size_t size = strlen(base);
    for (size_t i = 0; i < SUFFIXES; i++) {
        const size_t length = strlen(suffixes[i]);
        if (size > length && base[size - length - 1] != '/' &&
            strcmp(base + size - length, suffixes[i]) == 0) {
            base[size - length] = '\0';
            return;
        }
    }
}

static const char *read_operands(void)
{
    int c = filter_option(&f);
    if (c != -1)
        filter_usage_error(&f, "option -%c is unknown", c);
    if (f.output)
        filter_usage_error(&f, "-o: the output is the files BASE.node, BASE.ele, …");
    if (optind >= f.argc)
        filter_usage_error(&f, "BASE is missing, the name of the files without suffix");
    char *base = f.argv[optind++];
    drop_suffix(base);
    if (!*base)
        filter_usage_error(&f, "BASE is empty");
    filter_operands(&f);
    return base;
}

/* TetGen does not look at a .group file, but tetgen-import does. */
static bool is_written(const tm_block *block)
{
    return block->kind == TM_NODE || block->kind == TM_ELE || block->kind == TM_FACE ||
           block->kind == TM_EDGE || block->kind == TM_GROUP;
}

/* BASE.ele, or BASE.surface.face of a part. */
static tm_status write_block(const tm_stream *stream, const tm_block *block,
                             const char *base, tm_error *error)
{
    tm_text name = {0};
    int fd;
    tm_text_format(&name, "%s%s%s", base, block->name[0] == '.' ? "" : ".", block->name);
    if (name.failed)
        return tm_fail_memory(error);
    tm_status status = output_files_open(f.files, name.byte, &fd, error);
    if (status == TM_OK) {
        status = tm_block_write(block, stream->base, fd, f.threads, error);
        if (status != TM_OK)
            snprintf(error->file, sizeof error->file, "%s", name.byte);
    }
    tm_text_free(&name);
    return status;
}

/* A file that is there, plain or packed, and would be read with those that are written,
 * but is of another mesh. */
static tm_status refuse_other_file(const char *base, const char *suffix, tm_error *error)
{
    static const char *const packed[] = {"", ".gz"};
    tm_status status = TM_OK;
    for (size_t i = 0; i < sizeof packed / sizeof *packed && status == TM_OK; i++) {
        tm_text name = {0};
        tm_text_format(&name, "%s%s%s", base, suffix, packed[i]);
        if (name.failed)
            status = tm_fail_memory(error);
        else if (access(name.byte, F_OK) == 0)
            status = tm_fail_at(error, TM_ERROR_SYSTEM, name.byte, 0, NULL,
                                "is there, of another mesh: tetgen-import would read it "
                                "with this one (remove it, or take another BASE)");
        tm_text_free(&name);
    }
    return status;
}

/* All but their names: filter_finish() gives them. */
static void write_files(const tm_stream *stream, const char *base)
{
    tm_error error;
    filter_stage(&f, "writing");
    tm_status status = TM_OK;
    for (size_t b = 0; b < stream->blocks && status == TM_OK; b++)
        if (is_written(&stream->block[b]))
            status = write_block(stream, &stream->block[b], base, &error);
    for (size_t i = 0; i < SUFFIXES && status == TM_OK; i++)
        if (tm_stream_find(stream, ".node") && !tm_stream_find(stream, suffixes[i]))
            status = refuse_other_file(base, suffixes[i], &error);
    if (status != TM_OK)
        filter_fail(&f, &error);
}

int main(int argc, char **argv)
{
    filter_start(&f, argc, argv);
    const char *base = read_operands();
    tm_stream stream;
    filter_read(&f, &stream);
    mesh_leave_out(&f, &stream);
    write_files(&stream, base);
    tm_json *json = filter_json_begin(&f);
    tm_json_open(json, "files", '[');
    for (size_t i = 0; i < f.files->count; i++)
        tm_json_string(json, NULL, f.files->file[i].name);
    tm_json_close(json, ']');
    filter_json_end(&f);
    tm_stream_free(&stream);
    return filter_finish(&f, EXIT_SUCCESS);
}
