/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polygon_export.h"

#include "../input/left_out.h"
#include "../input/mesh_input.h"

#include "../../../lib/stream/group.h"

#include <string.h>

enum { OPTION_ALL = FILTER_OWN, OPTION_REGIONS, OPTION_PART, OPTION_BINARY };

/* Formats that have no binary files begin with the second one. */
static const struct option long_options[] = {
    {"binary", no_argument, NULL, OPTION_BINARY},
    {"all", no_argument, NULL, OPTION_ALL},
    {"regions", no_argument, NULL, OPTION_REGIONS},
    {"part", required_argument, NULL, OPTION_PART},
    FILTER_OPTIONS};

#define HELP                                                                             \
    "      --all           write the faces inside, too\n"                                \
    "      --regions       write the closed boundary of each region, faces between "     \
    "two\n"                                                                              \
    "                      regions twice\n"                                              \
    "      --part NAME     write a part of the stream: surface\n"

typedef struct {
    tm_surface_file file;
    const char *part;
} options;

static void read_options(filter *f, options *o)
{
    const char *which = NULL;
    for (int c; (c = filter_option(f)) != -1;) {
        if (c == OPTION_PART) {
            o->part = optarg;
        } else if (c == OPTION_BINARY) {
            o->file.binary = f->binary = true;
        } else {
            const char *option = c == OPTION_ALL ? "--all" : "--regions";
            if (which && which != option)
                filter_usage_error(f, "either --all or --regions");
            which = option;
            o->file.of = c == OPTION_ALL ? TM_POLYGONS_ALL : TM_POLYGONS_REGIONS;
        }
    }
    if (o->part && o->file.of == TM_POLYGONS_REGIONS)
        filter_usage_error(f, "--regions: the part '%s' has none", o->part);
    filter_operands(f);
}

/* Whether a block is not of the part. */
static bool is_other(const tm_block *block, const void *part)
{
    const size_t size = strlen(part);
    return strncmp(block->name, part, size) != 0 || block->name[size] != '.' ||
           strchr(block->name + size + 1, '.');
}

/* Makes the part the main mesh, and all there is; the markers of a part without names are
 * those of the mesh. */
static void take_part(const filter *f, tm_stream *stream, const char *part)
{
    tm_block names = {0}, *group = tm_stream_find(stream, ".group");
    tm_error error;
    if (group) {
        names = *group;
        *group = (tm_block){.kind = TM_UNKNOWN};
    }
    tm_stream_remove_if(stream, is_other, part);
    for (size_t b = 0; b < stream->blocks; b++) {
        char *name = stream->block[b].name;
        memmove(name, name + strlen(part), strlen(name + strlen(part)) + 1);
    }
    tm_status status = TM_OK;
    if (group && !tm_stream_find(stream, ".group"))
        status = tm_stream_put(stream, &names, &error);
    tm_group_free(&names);
    if (status == TM_OK && !tm_stream_find(stream, ".face"))
        status = tm_fail(&error, TM_ERROR_INPUT, "there is no block %s.face", part);
    if (status != TM_OK)
        mesh_input_fail(f, &error);
}

/* Of binary files those of STL have no groups. */
static void leave_out(const filter *f, const tm_stream *stream, const options *o,
                      bool is_stl)
{
    tm_text format = {0};
    tm_text_format(&format, "%s%s%s", f->name,
                   o->file.binary && is_stl ? " --binary" : "",
                   o->file.of == TM_POLYGONS_REGIONS ? " --regions" : "");
    if (format.failed)
        filter_fail_memory(f);
    mesh_leave_out_of(f, stream, format.byte);
    tm_text_free(&format);
}

static void note_flat(const filter *f, const tm_surface_written *written)
{
    if (written->flat > 0)
        filter_note(f,
                    "%s: %zu of %zu triangles have two corners that are one as 32-bit "
                    "floats (text keeps them)",
                    filter_input_name(f), written->flat, written->polygons);
}

int polygon_export(int argc, char **argv, const char *name, const char *purpose,
                   bool binary, tm_surface_writer *write)
{
    filter f = {
        .name = name,
        .synopsis = binary ? "[--all | --regions] [--part NAME] [--binary] [FILE]"
                           : "[--all | --regions] [--part NAME] [FILE]",
        .purpose = purpose,
        .help =
            binary ? HELP "      --binary        a binary file, little endian\n" : HELP,
        .options = binary ? long_options : long_options + 1,
        .letters = FILTER_LETTERS,
    };
    options o = {0};
    tm_stream stream;
    tm_text text = {0};
    tm_surface_written written = {0};
    tm_error error;
    filter_start(&f, argc, argv);
    read_options(&f, &o);
    mesh_input_read(&f, &stream);
    if (o.part)
        take_part(&f, &stream, o.part);
    filter_stage(&f, "formatting");
    if (write(&text, &stream, &o.file, &written, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    leave_out(&f, &stream, &o, write == tm_stl_write);
    note_flat(&f, &written);
    mesh_input_report(&f, &stream);
    filter_write_text(&f, &text);
    tm_text_free(&text);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
