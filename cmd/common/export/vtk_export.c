/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_export.h"

#include "../../../lib/format/tetgen.h"
#include "../../../lib/format/vtk/vtk_piece.h"
#include "../../../lib/ranks/ranks.h"
#include "../input/left_out.h"
#include "../input/mesh_input.h"

#include <stdlib.h>
#include <string.h>

enum { OPTION_NO_BOUNDARY = FILTER_OWN, OPTION_NO_NAMES, OPTION_NO_QUALITY };

static const struct option long_options[] = {
    {"no-boundary", no_argument, NULL, OPTION_NO_BOUNDARY},
    {"no-names", no_argument, NULL, OPTION_NO_NAMES},
    {"no-quality", no_argument, NULL, OPTION_NO_QUALITY},
    FILTER_OPTIONS};

static tm_vtk_options options = {.boundary = true, .quality = true, .names = true};
static const vtk_exporter *exporter;

static tm_status write_grid(tm_text *text, const tm_stream *stream, unsigned threads,
                            tm_error *error)
{
    return exporter->write(text, stream, &options, threads, error);
}

/* In pieces ------------------------------------------------------------------------- */

static const char extension[] = ".pvtu";

static bool is_for_pieces(const filter *f)
{
    const size_t size = f->output ? strlen(f->output) : 0, length = strlen(extension);
    return exporter->ranks && size > length &&
           strcmp(f->output + size - length, extension) == 0;
}

/* What there is in the whole is said by rank 0, of blocks that have all their rows but in
 * name. */
static void say_whole(filter *f, const tm_slices *slices)
{
    tm_stream whole = slices->stream;
    whole.block = malloc((whole.blocks + 1) * sizeof *whole.block);
    if (!whole.block)
        filter_fail_memory(f);
    memcpy(whole.block, slices->stream.block, whole.blocks * sizeof *whole.block);
    for (size_t b = 0; b < whole.blocks; b++)
        whole.block[b].count = slices->slice[b].total;
    if (filter_speaks())
        mesh_leave_out(f, &whole);
    mesh_input_report(f, &whole);
    free(whole.block);
}

/* Left-handed tetrahedra of a piece are turned. */
static void turn(const filter *f, const tm_stream *piece, const tm_slices *slices)
{
    tm_block *ele = tm_stream_find(piece, ".ele");
    tm_slice slice = {0, 0};
    size_t turned = 0;
    tm_slices_find(slices, ".ele", &slice);
    if (ele && ele->count > 0)
        turned = tm_tetgen_orient(tm_stream_find(piece, ".node"), ele).turned;
    tm_ranks_sum(&turned, 1);
    mesh_note_turned(f, turned, slice.total, "are turned");
}

/* This rank's piece; that of polyhedra is rank 0's. */
static void make_piece(const filter *f, tm_slices *slices, tm_stream *piece)
{
    tm_slice cell = {0, 0};
    tm_error error;
    tm_stream_init(piece);
    tm_slices_find(slices, ".cell", &cell);
    if (cell.total == 0) {
        filter_agree(f, tm_vtk_piece_make(piece, slices, &options, &error), &error);
        turn(f, piece, slices);
        return;
    }
    filter_agree(f, tm_slices_gather(slices, &error), &error);
    const tm_stream empty = *piece;
    *piece = slices->stream;
    slices->stream = empty;
}

/* "FILE_7.vtu" of FILE.pvtu; to be freed. */
static char *name_of(const filter *f, size_t piece)
{
    tm_text name = {0};
    tm_text_append(&name, f->output, strlen(f->output) - strlen(extension));
    tm_text_format(&name, "_%zu.vtu", piece);
    if (name.failed)
        filter_fail_memory(f);
    return name.byte;
}

/* FILE.pvtu, beside which the pieces are. */
static void write_list(filter *f, const tm_text *vtu, size_t pieces)
{
    tm_text text = {0};
    tm_error error;
    char **name = malloc((pieces + 1) * sizeof *name);
    const char **source = malloc((pieces + 1) * sizeof *source);
    if (!name || !source)
        filter_fail_memory(f);
    for (size_t i = 0; i < pieces; i++) {
        name[i] = name_of(f, i);
        const char *slash = strrchr(name[i], '/');
        source[i] = slash ? slash + 1 : name[i];
    }
    if (tm_pvtu_write(&text, vtu, source, pieces, &error) != TM_OK)
        filter_fail(f, &error);
    filter_write_text(f, &text);
    for (size_t i = 0; i < pieces; i++)
        free(name[i]);
    free(name);
    free(source);
    tm_text_free(&text);
}

/* Rank 0 always has a piece: it tells what all have. */
static int write_pieces(filter *f)
{
    tm_slices slices;
    tm_stream piece;
    tm_text text = {0};
    tm_error error;
    tm_status status = TM_OK;
    size_t pieces;
    filter_read_slices(f, &slices);
    say_whole(f, &slices);
    make_piece(f, &slices, &piece);
    filter_stage(f, "formatting");
    const bool has = tm_rank() == 0 || tm_content_of(&piece) != TM_CONTENT_NOTHING;
    const size_t number = tm_ranks_before(has, &pieces);
    if (has)
        status = write_grid(&text, &piece, f->threads, &error);
    if (status == TM_ERROR_INPUT)
        snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
    filter_agree(f, status, &error);
    char *name = name_of(f, number);
    if (has)
        status = output_files_write(f->files, name, &text, &error);
    filter_agree(f, status, &error);
    if (tm_rank() == 0)
        write_list(f, &text, pieces);
    free(name);
    tm_text_free(&text);
    tm_stream_free(&piece);
    tm_slices_free(&slices);
    return filter_finish(f, EXIT_SUCCESS);
}

int vtk_export(int argc, char **argv, const vtk_exporter *of)
{
    filter f = {
        .name = of->name,
        .synopsis = "[--no-boundary] [--no-names] [--no-quality] [FILE]",
        .purpose = of->purpose,
        .help = "      --no-boundary   no cells for marked triangles, facets and edges\n"
                "      --no-names      no names of markers and regions\n"
                "      --no-quality    no quality of cells\n",
        .options = long_options,
        .letters = FILTER_LETTERS,
        .binary = of->binary,
        .ranks = of->ranks,
    };
    int c;
    exporter = of;
    filter_start(&f, argc, argv);
    while ((c = filter_option(&f)) != -1) {
        switch (c) {
        case OPTION_NO_BOUNDARY:
            options.boundary = false;
            break;
        case OPTION_NO_NAMES:
            options.names = false;
            break;
        default: /* OPTION_NO_QUALITY */
            options.quality = false;
        }
    }
    filter_operands(&f);
    const bool pieces = is_for_pieces(&f);
    if (exporter->ranks)
        filter_together(&f, pieces);
    return pieces ? write_pieces(&f) : mesh_write(&f, write_grid);
}
