/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen.h"

#include "../../../lib/format/tetgen.h"
#include "../process/private.h"
#include "../process/run_program.h"
#include "tetgen_words.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

/* The run -------------------------------------------------------------------------- */

enum { ARGUMENTS = 12 };

/* One run, and what it is on: a surface, or else tetrahedra. */
typedef struct task {
    const filter *f;
    const tetgen_request *r;
    const tm_polygon_surface *surface;
    const tm_stream *tets;
    private_folder folder;
} task;

/* Which files of the folder TetGen reads, and which it makes of them. */
static const char input_poly[] = "surface.poly", input_node[] = "surface.node";
static const char input_size[] = "surface.mtr";
static const char output_stem[] = "surface.1";

/* The blocks that TetGen makes are those that it refines. */
static const char *const blocks[] = {".node", ".ele", ".face", ".edge"};
enum { BLOCKS = sizeof blocks / sizeof *blocks };

static bool is_plc(const task *t)
{
    return t->surface && t->surface->facets > 0;
}

static void listen(void *context, const char *bytes, size_t size)
{
    tetgen_tell(context, bytes, size);
}

/* Some inputs make TetGen go on for ever. */
static const double silence = 30; /* seconds */

static void say_silent(void *context)
{
    const filter *f = context;
    filter_note(f,
                "TetGen has said nothing for %g s; it goes on (--timeout S would end it)",
                silence);
}

/* Runs TetGen, with the request's switches or with `only` instead. */
static tm_status run_tetgen(const task *t, const char *only, program_end *end,
                            tm_error *error)
{
    const tetgen_request *r = t->r;
    const program_watch watch = {listen, say_silent, (void *)t->f, silence, r->timeout};
    char path[sizeof t->folder.path + sizeof input_poly + 1];
    snprintf(path, sizeof path, "%s/%s", t->folder.path,
             is_plc(t) ? input_poly : input_node);
    const char *argument[ARGUMENTS] = {r->program};
    int count = 1;
    if (only) {
        argument[count++] = only;
    } else {
        if (t->tets || is_plc(t))
            argument[count++] = t->tets ? "-r" : "-p";
        if (*r->quality)
            argument[count++] = r->quality;
        if (*r->volume)
            argument[count++] = r->volume;
        if (r->keep_surface)
            argument[count++] = "-Y";
        if (r->regions)
            argument[count++] = "-A";
        if (r->size)
            argument[count++] = "-m";
        if (r->more)
            argument[count++] = r->more;
    }
    argument[count++] = path;
    tm_status status = run_program((char *const *)argument, &watch, end, error);
    if (status == TM_OK && end->output.failed)
        status = tm_fail_memory(error);
    return status;
}

static tm_status fail_start(const tetgen_request *r, int cause, tm_error *error)
{
    return tm_fail(error, TM_ERROR_SYSTEM,
                   "cannot run '%s': %s (needs tetgen, Debian package tetgen; --tetgen "
                   "PROG names another one)",
                   r->program, strerror(cause));
}

/* What TetGen made is not whole, or it failed, as there was no room for it. */
static tm_status fail_full(const private_folder *folder, const tetgen_request *r,
                           int cause, tm_error *error)
{
    return tm_fail(error, TM_ERROR_SYSTEM,
                   "'%s' cannot write in %s: %s (TMPDIR says where)", r->program,
                   folder->path, strerror(cause));
}

/* Of a run that failed: where the surface intersects itself that is said, whatever
 * TetGen died of. */
static tm_status explain_failure(const task *t, const program_end *end, tm_error *error)
{
    const filter *f = t->f;
    const tetgen_request *r = t->r;
    tetgen_show_complaints(f, &end->output);
    const int cause = private_folder_full(&t->folder);
    if (cause != 0)
        return fail_full(&t->folder, r, cause, error);
    program_end check = {0};
    size_t pairs = 0;
    if (is_plc(t) && !private_signals_came() &&
        run_tetgen(t, "-pd", &check, NULL) == TM_OK)
        pairs = tetgen_show_pairs(f, &check.output, t->surface);
    tm_text_free(&check.output);
    if (pairs > 0)
        return tm_fail_at(error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                          "the surface intersects itself: TetGen cannot fill it "
                          "(surface-mend mends what is only doubled or nearly one; "
                          "octree-mesh --lenient fills it as it is)");
    if (end->timed_out)
        return tm_fail(error, TM_ERROR_SYSTEM, "'%s' was ended after %g s (--timeout)",
                       r->program, r->timeout);
    if (end->signal)
        return tm_fail(error, TM_ERROR_SYSTEM, "'%s' was ended by signal %d (%s)",
                       r->program, end->signal, strsignal(end->signal));
    return tm_fail(error, TM_ERROR_SYSTEM, "'%s' failed with exit status %d", r->program,
                   end->exit_status);
}

/* A file that is not what TetGen writes: another program made it, or it was cut off. */
static tm_status fail_block(const private_folder *folder, const tetgen_request *r,
                            const tm_error *cause, tm_error *error)
{
    const int full = private_folder_full(folder);
    if (full != 0)
        return fail_full(folder, r, full, error);
    return tm_fail(error, TM_ERROR_SYSTEM,
                   "'%s' made a file that is not TetGen's: %s:%zu: %s", r->program,
                   cause->file, cause->line, cause->what);
}

/* A text that ends within a line was cut off there, maybe within a number. */
static tm_status check_last_line(const tm_text *bytes, const char *file, tm_error *error)
{
    if (bytes->size == 0 || bytes->byte[bytes->size - 1] == '\n')
        return TM_OK;
    size_t line = 1;
    for (size_t i = 0; i < bytes->size; i++)
        line += bytes->byte[i] == '\n';
    return tm_fail_at(error, TM_ERROR_INPUT, file, line, NULL,
                      "the file ends within a line");
}

/* A file's bytes as a block of the stream. */
static tm_status parse(const tm_text *bytes, const char *file, const char *name,
                       tm_stream *mesh, tm_error *error)
{
    tm_block *block = tm_stream_add(mesh, name);
    if (!block)
        return tm_fail_memory(error);
    const tm_block *node = tm_stream_find(mesh, ".node");
    tm_tetgen_nodes nodes = {mesh->base, node ? node->count : 0, NULL};
    const tm_status status =
        tm_tetgen_read(block, bytes->byte, bytes->size, file, &nodes, error);
    mesh->base = nodes.base;
    tm_tetgen_nodes_free(&nodes);
    return status == TM_OK ? check_last_line(bytes, file, error) : status;
}

/* Reads one of TetGen's files into a block of the stream; nothing where there is no such
 * file. */
static tm_status read_block(const private_folder *folder, const tetgen_request *r,
                            const char *name, tm_stream *mesh, tm_error *error)
{
    char file[sizeof output_stem + TM_BLOCK_NAME];
    snprintf(file, sizeof file, "%s%s", output_stem, name);
    tm_text bytes = {0};
    bool exists = false;
    tm_error cause;
    tm_status status = private_folder_read(folder, file, &bytes, &exists, &cause);
    if (status == TM_OK && exists)
        status = parse(&bytes, file, name, mesh, &cause);
    tm_text_free(&bytes);
    if (status == TM_ERROR_INPUT)
        return fail_block(folder, r, &cause, error);
    return status == TM_OK ? TM_OK : tm_fail_as(error, &cause);
}

static tm_status read_mesh(const private_folder *folder, const tetgen_request *r,
                           tm_stream *mesh, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < BLOCKS && status == TM_OK; i++)
        status = read_block(folder, r, blocks[i], mesh, error);
    if (status == TM_OK && !tm_stream_find(mesh, blocks[0]))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "'%s' ended well, but made no %s%s (is it TetGen?)", r->program,
                       output_stem, blocks[0]);
    return status;
}

/* What TetGen reads ------------------------------------------------------------------ */

static tm_status write_sizes(const task *t, size_t nodes, tm_error *error)
{
    tm_text text = {0};
    tm_text_format(&text, "%zu 1\n", nodes);
    for (size_t v = 0; v < nodes; v++) {
        tm_text_double(&text, t->r->size[v]);
        tm_text_append(&text, "\n", 1);
    }
    const tm_status status = private_folder_write(&t->folder, input_size, &text, error);
    tm_text_free(&text);
    return status;
}

static tm_status write_block(const task *t, const char *name, tm_error *error)
{
    char file[sizeof input_node + TM_BLOCK_NAME];
    const tm_block *block = tm_stream_find(t->tets, name);
    if (!block)
        return TM_OK;
    snprintf(file, sizeof file, "surface%s", name);
    const int fd = private_folder_create(&t->folder, file);
    tm_status status = TM_OK;
    if (fd >= 0)
        status = tm_block_write(block, t->tets->base, fd, t->f->threads, error);
    if (fd < 0 || (close(fd) != 0 && status == TM_OK))
        status = tm_fail(error, TM_ERROR_SYSTEM, "cannot write %s/%s: %s", t->folder.path,
                         file, strerror(errno));
    return status;
}

static tm_status write_tets(const task *t, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t i = 0; i < BLOCKS && status == TM_OK; i++)
        status = write_block(t, blocks[i], error);
    return status;
}

static tm_status write_surface(const task *t, tm_error *error)
{
    tm_text text = {0};
    if (is_plc(t))
        tm_plc_write(&text, t->surface);
    else
        tm_plc_write_nodes(&text, t->surface);
    const tm_status status = private_folder_write(
        &t->folder, is_plc(t) ? input_poly : input_node, &text, error);
    tm_text_free(&text);
    return status;
}

static tm_status run_in(const task *t, tm_stream *mesh, tm_error *error)
{
    const filter *f = t->f;
    filter_stage(f, "TetGen");
    tm_status status = t->tets ? write_tets(t, error) : write_surface(t, error);
    if (status == TM_OK && t->r->size)
        status = write_sizes(
            t, t->tets ? tm_stream_find(t->tets, blocks[0])->count : t->surface->nodes,
            error);
    program_end end = {0};
    if (status == TM_OK)
        status = run_tetgen(t, NULL, &end, error);
    if (status == TM_OK && end.cannot_start)
        status = fail_start(t->r, end.cannot_start, error);
    else if (status == TM_OK && !private_signals_came()) {
        tetgen_show_all(f, &end.output);
        if (end.signal || end.exit_status)
            status = explain_failure(t, &end, error);
        else
            tetgen_show_warnings(f, &end.output);
    }
    tm_text_free(&end.output);
    filter_stage(f, "reading what TetGen wrote");
    return status == TM_OK ? read_mesh(&t->folder, t->r, mesh, error) : status;
}

static tm_status run_once(task *t, tm_stream *mesh, tm_error *error)
{
    tm_status status = private_folder_open(&t->folder, t->f->name, error);
    if (status != TM_OK)
        return status;
    status = run_in(t, mesh, error);
    private_folder_close(&t->folder);
    return status;
}

tm_status tetgen_run(const filter *f, const tetgen_request *r,
                     const tm_polygon_surface *surface, tm_stream *mesh, tm_error *error)
{
    task t = {.f = f, .r = r, .surface = surface};
    return run_once(&t, mesh, error);
}

tm_status tetgen_refine(const filter *f, const tetgen_request *r, const tm_stream *tets,
                        tm_stream *mesh, tm_error *error)
{
    task t = {.f = f, .r = r, .tets = tets};
    return run_once(&t, mesh, error);
}
