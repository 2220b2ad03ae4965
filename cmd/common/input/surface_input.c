/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_input.h"

#include "../../../lib/text/file.h"
#include "../../../lib/text/input.h"
#include "../../../lib/mesh/cell_faces.h"
#include "../app/kinds.h"
#include "../../../lib/surface/surface_defects.h"
#include "../../../lib/format/tetgen.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* The name with .node for its suffix, or where there is no such file with .node.gz. */
static void node_file(const char *name, tm_text *file)
{
    const char *end = name + tm_unpacked_name(name);
    const char *dot = memrchr(name, '.', (size_t)(end - name));
    tm_text_append(file, name, (size_t)((dot ? dot : end) - name));
    tm_text_string(file, ".node");
    if (file->failed || access(file->byte, F_OK) == 0)
        return;
    tm_text_string(file, ".gz");
    if (!file->failed && access(file->byte, F_OK) != 0)
        file->byte[file->size -= strlen(".gz")] = '\0';
}

/* The nodes of a .poly or .smesh file that has none itself. */
static tm_status read_nodes_beside(const filter *f, tm_polygon_surface *surface,
                                   tm_error *error)
{
    if (!f->input)
        return tm_fail_at(error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                          "has no nodes: they are in a .node file beside it, which is "
                          "looked for when the file is named as an operand");
    tm_text file = {0}, bytes = {0};
    node_file(f->input, &file);
    if (file.failed)
        return tm_fail_memory(error);
    if (access(file.byte, F_OK) != 0) {
        const tm_status missing =
            tm_fail_at(error, TM_ERROR_INPUT, f->input, 0, NULL,
                       "has no nodes, and there is no file %s with them", file.byte);
        tm_text_free(&file);
        return missing;
    }
    filter_read_file(f, file.byte, &bytes);
    const tm_status status =
        tm_plc_read(surface, TM_PLC_NODE, bytes.byte, bytes.size, file.byte, error);
    if (status != TM_OK)
        filter_fail_file(f, error, &bytes, "tetgen-import");
    tm_text_free(&file);
    tm_text_free(&bytes);
    return status;
}

/* The stream in these bytes: they are put where tm_stream_read() can read them. */
static tm_status read_stream(const tm_text *bytes, const char *name, unsigned threads,
                             tm_stream *stream, tm_error *error)
{
    int fd = memfd_create("stream", MFD_CLOEXEC);
    if (fd < 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the input: %s",
                       strerror(errno));
    tm_status status = tm_write_text(fd, bytes, error);
    if (status == TM_OK && lseek(fd, 0, SEEK_SET) != 0)
        status =
            tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the input: %s", strerror(errno));
    if (status == TM_OK)
        status = tm_stream_read(stream, fd, name, threads, error);
    close(fd);
    return status;
}

static tm_status copy_nodes(const tm_block *node, tm_polygon_surface *surface,
                            tm_error *error)
{
    tm_stream copy;
    tm_stream_init(&copy);
    tm_block *block = tm_stream_add(&copy, node->name);
    if (!block)
        return tm_fail_memory(error);
    block->attributes = node->attributes;
    block->markers = node->markers;
    tm_status status = tm_block_allocate(block, node->count, 0, error);
    if (status == TM_OK) {
        memcpy(block->real, node->real, node->count * 3 * sizeof *node->real);
        if (node->attribute)
            memcpy(block->attribute, node->attribute,
                   node->count * node->attributes * sizeof *node->attribute);
        if (node->marker)
            memcpy(block->marker, node->marker, node->count * sizeof *node->marker);
        status = tm_polygon_surface_nodes_from_stream(surface, block, error);
    }
    tm_stream_free(&copy);
    return status;
}

/* A main mesh that is triangles or points alone becomes the part `surface`, unless there
 * is one. */
static void rename_surface(tm_stream *stream)
{
    if (tm_stream_find(stream, "surface.node") ||
        tm_stream_find(stream, "surface.face") ||
        tm_content_of(stream) > TM_CONTENT_SURFACE || !tm_stream_find(stream, ".node"))
        return;
    strcpy(tm_stream_find(stream, ".node")->name, "surface.node");
    tm_block *face = tm_stream_find(stream, ".face");
    if (face)
        strcpy(face->name, "surface.face");
    tm_block *group = tm_stream_find(stream, ".group");
    if (group)
        strcpy(group->name, "surface.group");
}

tm_status surface_input_of_blocks(const tm_block *node, const tm_block *face,
                                  unsigned base, tm_polygon_surface *surface,
                                  tm_error *error)
{
    surface->base = base;
    const tm_status status = copy_nodes(node, surface, error);
    return status == TM_OK && face ? tm_polygon_surface_add_faces(surface, face, error)
                                   : status;
}

tm_status surface_input_of_stream(const tm_stream *stream, const char *name,
                                  tm_polygon_surface *surface, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, "surface.node");
    const tm_block *face = tm_stream_find(stream, "surface.face");
    if (!node)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, "surface.node",
                          "the stream has no such block (the surface would be in it and "
                          "surface.face, or in .node and .face alone)");
    tm_status status = surface_input_of_blocks(node, face, stream->base, surface, error);
    const tm_block *group = tm_stream_find(stream, "surface.group");
    if (!group) /* the markers of a mesh are those of its surface */
        group = tm_stream_find(stream, ".group");
    if (status == TM_OK && group)
        status = tm_group_append(&surface->group, group, TM_GROUP_DIMENSIONS, error);
    return status;
}

static tm_format read_surface(const filter *f, tm_polygon_surface *surface,
                              tm_stream *stream, bool mesh_too)
{
    tm_error error;
    tm_text bytes = {0};
    const char *name = filter_input_name(f);
    tm_polygon_surface_init(surface);
    tm_stream_init(stream);
    filter_read_bytes(f, &bytes);
    tm_status status = TM_OK;
    const tm_format format = tm_format_of(bytes.byte, bytes.size, name);
    if (format == TM_FORMAT_STREAM) {
        status = read_stream(&bytes, name, f->threads, stream, &error);
        if (status == TM_OK && !mesh_too) /* else what f itself takes */
            status = kinds_check(f->name, stream, name, &error);
        if (status == TM_OK) {
            rename_surface(stream);
            if (tm_stream_find(stream, "surface.node") ||
                tm_content_of(stream) <= TM_CONTENT_SURFACE)
                status = surface_input_of_stream(stream, name, surface, &error);
        }
    } else {
        if ((format == TM_FORMAT_POLY || format == TM_FORMAT_SMESH) &&
            tm_plc_lacks_nodes(bytes.byte, bytes.size))
            status = read_nodes_beside(f, surface, &error);
        if (status == TM_OK)
            status =
                tm_format_read(surface, format, bytes.byte, bytes.size, name, &error);
    }
    if (status != TM_OK && format > TM_FORMAT_STREAM)
        filter_fail_file(f, &error, &bytes, "tetgen-mesh");
    if (status != TM_OK)
        filter_fail(f, &error);
    tm_text_free(&bytes);
    if (surface->left_bytes > 0)
        filter_note(f, "%s: %zu bytes behind the last triangle are skipped", name,
                    surface->left_bytes);
    filter_verbose(f, "%s: %s, %zu nodes, %zu faces", name, tm_format_name(format),
                   surface->nodes, surface->facets);
    return format;
}

tm_format surface_input_read(const filter *f, tm_polygon_surface *surface,
                             tm_stream *stream)
{
    return read_surface(f, surface, stream, false);
}

tm_format surface_input_read_any(const filter *f, tm_polygon_surface *surface,
                                 tm_stream *stream)
{
    return read_surface(f, surface, stream, true);
}

static void note_rough(const filter *f, const tm_surface *s, const char *name)
{
    if (!s->rough)
        return;
    if (s->curves == 0)
        filter_note(
            f, "%s: the surface is rough all over: no edge of it is kept as sharp", name);
    else
        filter_note(f,
                    "%s: %zu sharp edges are in rough parts of the surface and not kept "
                    "(--feature-angle takes all)",
                    name, s->rough_edges);
}

/* What was found and mended in the surface. */
static void note_mending(const filter *f, const tm_surface *s)
{
    const char *name = filter_input_name(f);
    if (s->turned)
        filter_note(f,
                    s->components > 1 && !s->walls
                        ? "%s: triangles were turned, so that shells look outward, those "
                          "within an odd number of others inward"
                        : "%s: triangles were turned, so that all look outward",
                    name);
    if (s->duplicates)
        filter_note(f,
                    s->walls ? "%s: %zu triangles are walls that both regions give; the "
                               "first of each stays"
                             : "%s: %zu triangles were there twice and are dropped",
                    name, s->duplicates);
    if (s->flat)
        filter_note(f, "%s: %zu triangles without area are dropped", name, s->flat);
    if (s->open_edges)
        filter_note(f, "%s: the surface is open at %zu edges", name, s->open_edges);
    if (s->touching)
        filter_note(
            f,
            "%s: parts of the surface touch at %zu nodes, and along edges between "
            "these: they count as apart there, and each has nodes of its own",
            name, s->touching);
    note_rough(f, s, name);
    if (s->crossings)
        filter_note(f, "%s: the surface crosses itself at %zu pairs of triangles", name,
                    s->crossings);
}

/* For messages: what to do with several regions. */
static const char one_solid[] =
    "one solid is filled; 'tetgen-mesh FILE | off-export' makes its outer surface";

/* Walls inside: no edge is open, but some have an odd number of faces, so that both sides
 * of one of these are in the solid. */
static void refuse_walls(const filter *f, tm_polygon_surface *polygons)
{
    tm_error error;
    tm_surface_defects defects;
    size_t dropped;
    if (tm_surface_drop_duplicates(polygons, &dropped, &error) != TM_OK ||
        tm_surface_find_defects(polygons, &defects, &error) != TM_OK)
        filter_fail(f, &error);
    if (defects.open_edges > 0 || defects.odd_edges == 0)
        return;
    tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
               "the surface has walls inside, between several regions: %zu edges have "
               "three faces, or another odd number, and none is open (%s)",
               defects.odd_edges, one_solid);
    filter_fail(f, &error);
}

/* Where shells in others bound holes: no region can be in one. */
static void check_regions(const filter *f, const tm_polygon_surface *polygons,
                          const tm_surface *surface)
{
    tm_error error;
    for (size_t r = 0; r < polygons->regions; r++) {
        const double *p = polygons->region[r].point;
        if (tm_surface_has_inside(surface, p))
            continue;
        tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                   "region %zu, at (%g, %g, %g), is outside, or in a cavity that is left "
                   "empty",
                   r + 1, p[0], p[1], p[2]);
        filter_fail(f, &error);
    }
    if (polygons->regions > 0)
        filter_leave_out(f, "%zu regions", polygons->regions);
}

bool surface_input_takes(const tm_stream *stream, const tm_block *block)
{
    static const char *const names[] = {"surface.node", "surface.face", "surface.group"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(block->name, names[i]) == 0)
            return true;
    if (block->kind != TM_EDGE)
        return strcmp(block->name, ".group") == 0 &&
               !tm_stream_find(stream, "surface.group");
    for (size_t r = 0; r < block->count && block->marker; r++)
        if (block->marker[r] != 0)
            return false;
    return true;
}

void surface_input_leave_out_blocks(const filter *f, const tm_stream *stream)
{
    for (size_t b = 0; b < stream->blocks; b++)
        if (!surface_input_takes(stream, &stream->block[b]))
            filter_leave_out(f, "the block %s", stream->block[b].name);
}

/* What of the surface and its stream an octree's mesh has no place for. */
static void leave_out(const filter *f, const tm_polygon_surface *polygons,
                      const tm_stream *stream)
{
    size_t markers = 0, names = 0;
    for (size_t v = 0; v < polygons->nodes && polygons->node_marker; v++)
        markers += polygons->node_marker[v] != 0;
    for (size_t g = 0; g < polygons->group.count; g++)
        names += tm_group_dimension_of(&polygons->group, g) != TM_GROUP_FACES;
    if (polygons->attributes > 0)
        filter_leave_out(f, "%zu attributes of the surface's nodes",
                         polygons->attributes);
    if (markers > 0)
        filter_leave_out(f, "%zu markers of the surface's nodes", markers);
    if (names > 0)
        filter_leave_out(f, "%zu names of other than faces (.group)", names);
    surface_input_leave_out_blocks(f, stream);
}

void surface_input_add_help(tm_error *error, const tm_polygon_surface *polygons,
                            const tm_surface_options *options, const char *help)
{
    const tm_surface_options lenient = {
        .feature_angle = options->feature_angle,
        .lenient = true,
        .regions = options->regions,
    };
    const size_t size = strlen(error->what);
    tm_surface taken;
    tm_surface_defects defects;
    if (error->status != TM_ERROR_INPUT || options->lenient ||
        tm_surface_find_defects(polygons, &defects, NULL) != TM_OK)
        return;
    const bool walls = defects.open_edges == 0 && defects.odd_edges > 0;
    if (tm_surface_build(&taken, polygons, &lenient, NULL) == TM_OK && !walls)
        snprintf(error->what + size, sizeof error->what - size, "%s", help);
    tm_surface_free(&taken);
}

void surface_input_build(const filter *f, const tm_surface_options *options,
                         tm_surface *surface, tm_stream *history)
{
    tm_polygon_surface polygons;
    tm_stream stream;
    tm_error error;
    surface_input_read(f, &polygons, &stream);
    filter_stage(f, "building the surface");
    const tm_status status = tm_surface_build(surface, &polygons, options, &error);
    if ((status == TM_ERROR_INPUT && !options->walls) ||
        (status == TM_OK && surface->open_edges > 0))
        refuse_walls(f, &polygons);
    if (status != TM_OK) {
        surface_input_add_help(
            &error, &polygons, options,
            " (surface-mend may mend it; --lenient takes it as it is)");
        if (!error.file[0])
            snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
        filter_fail(f, &error);
    }
    if (!surface->regions)
        check_regions(f, &polygons, surface);
    else if (surface->repeated_regions > 0)
        filter_leave_out(f, "%zu regions that are in one with another before",
                         surface->repeated_regions);
    if (history)
        leave_out(f, &polygons, &stream);
    tm_polygon_surface_free(&polygons);
    if (history) {
        tm_stream_init(history);
        history->base = stream.base;
        history->history = stream.history;
        stream.history = (tm_text){0};
    }
    tm_stream_free(&stream);
    note_mending(f, surface);
}
