/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen.h"

#include "../../../lib/format/tetgen.h"
#include "private.h"
#include "run_program.h"

#include <string.h>

/* What TetGen says: progress, warnings and complaints, all on stdout ------------------
 */

/* The lines of a text, one after the other; false behind the last. */
static bool next_line(const char **at, const char **line, int *size)
{
    if (!*at || !**at)
        return false;
    *line = *at;
    *size = (int)strcspn(*at, "\r\n");
    *at += *size;
    *at += strspn(*at, "\r\n");
    return true;
}

static bool contains(const char *line, int size, const char *words)
{
    return memmem(line, (size_t)size, words, strlen(words)) != NULL;
}

/* Progress, not a complaint. */
static bool is_progress(const char *line, int size)
{
    static const char *const words[] = {"Opening ",     "Delaunizing", "Creating ",
                                        "Constrained ", "Removing ",   "Refining ",
                                        "Optimizing ",  "Writing ",    "Jettisoning ",
                                        " seconds:",    "Detecting",   "Recovering",
                                        "Statistics"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (contains(line, size, words[i]))
            return true;
    return strspn(line, " ") >= (size_t)size;
}

/* On stderr: the lines that are no progress, some of them at most. */
static void show_complaints(const filter *f, const tm_text *output)
{
    enum { LINES_MAX = 10 };
    const char *at = output->byte, *line;
    int size, shown = 0;
    while (next_line(&at, &line, &size)) {
        if (is_progress(line, size))
            continue;
        if (shown++ < LINES_MAX)
            filter_message(f, "tetgen: %.*s", size, line);
    }
    if (shown > LINES_MAX)
        filter_message(f, "tetgen: … and %d lines more", shown - LINES_MAX);
}

/* With -v all of it. */
static void show_all(const filter *f, const tm_text *output)
{
    const char *at = output->byte, *line;
    int size;
    while (next_line(&at, &line, &size))
        filter_verbose(f, "tetgen: %.*s", size, line);
}

/* How many warnings there are, and the first, unless --quiet. */
static void show_warnings(const filter *f, const tm_text *output)
{
    const char *at = output->byte, *line, *first = NULL;
    int size, first_size = 0;
    size_t warnings = 0;
    while (next_line(&at, &line, &size)) {
        if (!contains(line, size, "Warning"))
            continue;
        if (warnings++ == 0) {
            first = line;
            first_size = size;
        }
    }
    if (warnings > 0)
        filter_note(f, "warnings of TetGen: %zu (-v shows them), the first: %.*s",
                    warnings, first_size, first);
}

static bool said(const tm_text *output, const char *words)
{
    return output->byte && memmem(output->byte, output->size, words, strlen(words));
}

/* The run -------------------------------------------------------------------------- */

enum { ARGUMENTS = 8 };

/* Which files of the folder TetGen reads, and which it makes of them. */
static const char input_poly[] = "surface.poly", input_node[] = "surface.node";
static const char output_stem[] = "surface.1";

/* Passes on what TetGen says that it does. */
static void tell(void *context, const char *words, size_t size)
{
    static const char *const step[] = {"Delaunizing vertices",
                                       "Creating surface mesh",
                                       "Recovering boundaries",
                                       "Removing exterior tetrahedra",
                                       "Suppressing Steiner points",
                                       "Recovering Delaunayness",
                                       "Refining mesh",
                                       "Optimizing mesh"};
    const filter *f = context;
    tm_progress_at at = {.what = "TetGen"};
    const char *last = NULL;
    for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
        const char *said = memmem(words, size, step[i], strlen(step[i]));
        if (!said || (last && said < last))
            continue;
        last = said;
        at.doing = step[i];
    }
    if (last)
        tm_progress_tell(filter_progress(f), &at);
}

/* Runs TetGen on the file, with the request's switches or with `only` instead. */
static tm_status run_tetgen(const filter *f, const private_folder *folder,
                            const tetgen_request *r, const char *file, const char *only,
                            program_end *end, tm_error *error)
{
    char path[sizeof folder->path + sizeof input_poly + 1];
    snprintf(path, sizeof path, "%s/%s", folder->path, file);
    const char *argument[ARGUMENTS] = {r->program};
    int count = 1;
    if (only) {
        argument[count++] = only;
    } else {
        if (file == input_poly)
            argument[count++] = "-p";
        if (*r->quality)
            argument[count++] = r->quality;
        if (*r->volume)
            argument[count++] = r->volume;
        if (r->keep_surface)
            argument[count++] = "-Y";
        if (r->more)
            argument[count++] = r->more;
    }
    argument[count++] = path;
    tm_status status = run_program((char *const *)argument, tell, (void *)f, end, error);
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
static tm_status explain_failure(const filter *f, const private_folder *folder,
                                 const tetgen_request *r, const char *file,
                                 const program_end *end, tm_error *error)
{
    static const char intersecting[] = "pairs of faces are intersecting";
    show_complaints(f, &end->output);
    const int cause = private_folder_full(folder);
    if (cause != 0)
        return fail_full(folder, r, cause, error);
    program_end check = {0};
    bool intersects = said(&end->output, "intersect");
    if (file == input_poly && !private_signals_came() &&
        run_tetgen(f, folder, r, file, "-pd", &check, NULL) == TM_OK &&
        said(&check.output, intersecting)) {
        intersects = true;
        show_complaints(f, &check.output);
    }
    tm_text_free(&check.output);
    if (intersects)
        return tm_fail_at(error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                          "the surface intersects itself: TetGen cannot fill it");
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
    const tm_status status = tm_tetgen_read(block, bytes->byte, bytes->size, file,
                                            &mesh->base, node ? node->count : 0, error);
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
    static const char *const names[] = {".node", ".ele", ".face", ".edge"};
    tm_status status = TM_OK;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && status == TM_OK; i++)
        status = read_block(folder, r, names[i], mesh, error);
    if (status == TM_OK && !tm_stream_find(mesh, names[0]))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "'%s' ended well, but made no %s%s (is it TetGen?)", r->program,
                       output_stem, names[0]);
    return status;
}

static tm_status run_in(const private_folder *folder, const filter *f,
                        const tetgen_request *r, const tm_polygon_surface *surface,
                        tm_stream *mesh, tm_error *error)
{
    const char *file = surface->facets > 0 ? input_poly : input_node;
    tm_text text = {0};
    filter_stage(f, "TetGen");
    if (surface->facets > 0)
        tm_plc_write(&text, surface);
    else
        tm_plc_write_nodes(&text, surface);
    tm_status status = private_folder_write(folder, file, &text, error);
    tm_text_free(&text);
    program_end end = {0};
    if (status == TM_OK)
        status = run_tetgen(f, folder, r, file, NULL, &end, error);
    if (status == TM_OK && end.cannot_start)
        status = fail_start(r, end.cannot_start, error);
    else if (status == TM_OK && !private_signals_came()) {
        show_all(f, &end.output);
        if (end.signal || end.exit_status)
            status = explain_failure(f, folder, r, file, &end, error);
        else
            show_warnings(f, &end.output);
    }
    tm_text_free(&end.output);
    filter_stage(f, "reading what TetGen wrote");
    return status == TM_OK ? read_mesh(folder, r, mesh, error) : status;
}

tm_status tetgen_run(const filter *f, const tetgen_request *r,
                     const tm_polygon_surface *surface, tm_stream *mesh, tm_error *error)
{
    private_folder folder = {.path = ""};
    tm_status status = private_folder_open(&folder, f->name, error);
    if (status != TM_OK)
        return status;
    status = run_in(&folder, f, r, surface, mesh, error);
    private_folder_close(&folder);
    return status;
}
