/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gmsh-import: a mesh in any format that Gmsh reads as a stream. */
#include "../common/gmsh/gmsh_formats.h"
#include "../common/gmsh/gmsh_stream.h"
#include "../common/input/mesh_input.h"

#include "../../lib/stream/sniff.h"
#include "../../lib/text/file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OPTION_FORMAT = FILTER_OWN };

static const struct option long_options[] = {
    {"format", required_argument, NULL, OPTION_FORMAT}, FILTER_OPTIONS};

static const filter_words words[] = {FILTER_WORDS(OPTION_FORMAT, gmsh_input_name), {0}};

static filter f = {
    .name = "gmsh-import",
    .synopsis = "[--format FORMAT] [FILE]",
    .purpose =
        "Reads a mesh in a format that Gmsh knows, by its library: points, lines,\n"
        "faces and cells, with their physical groups.",
    .help =
        "      --format FORMAT  not by suffix or content, but msh, mesh, unv, vtk, med,\n"
        "                       bdf, cgns, stl, ply, ply2 or wrl\n",
    .options = long_options,
    .letters = FILTER_LETTERS,
    .words = words,
};

static tm_error error;

static gmsh_input read_options(void)
{
    gmsh_input format = GMSH_INPUTS;
    while (filter_option(&f) != -1)
        format = (gmsh_input)filter_word(&f, OPTION_FORMAT, optarg);
    filter_operands(&f);
    return format;
}

/* An error of the file, which may be another one than the user thinks. */
_Noreturn static void fail(const gmsh_file *file)
{
    if (!error.file[0] && error.status == TM_ERROR_INPUT)
        snprintf(error.file, sizeof error.file, "%s", filter_input_name(&f));
    filter_fail_file(&f, &error, &file->head, f.name);
}

static gmsh_input find_format(gmsh_input format, const gmsh_file *file)
{
    if (format == GMSH_INPUTS)
        format = gmsh_input_of(f.input, file);
    if (format == GMSH_INPUTS) {
        tm_fail(&error, TM_ERROR_INPUT,
                "neither its name nor its first bytes say that it is a mesh that Gmsh "
                "reads (--format says it)");
        fail(file);
    }
    if (gmsh_input_check(format, file, filter_input_name(&f), &error) != TM_OK)
        fail(file);
    return format;
}

/* Whether Gmsh can read what is open as it is: a regular file that is not packed and does
 * not begin with a byte order mark. */
static bool is_plain(int fd)
{
    enum { FIRST = 3 };
    static const char gzip[] = "\x1F\x8B";
    char first[FIRST];
    struct stat is;
    return fstat(fd, &is) == 0 && S_ISREG(is.st_mode) &&
           pread(fd, first, sizeof first, 0) == FIRST && lseek(fd, 0, SEEK_CUR) == 0 &&
           memcmp(first, gzip, sizeof gzip - 1) != 0 &&
           tm_byte_order_mark(first, sizeof first) == 0;
}

/* Any other input, in memory. */
static int hold(void)
{
    tm_text bytes = {0};
    filter_read_bytes(&f, &bytes);
    const size_t mark = tm_byte_order_mark(bytes.byte, bytes.size);
    const int fd = memfd_create("input", MFD_CLOEXEC);
    if (fd < 0)
        tm_fail(&error, TM_ERROR_SYSTEM, "cannot hold the input: %s", strerror(errno));
    if (fd < 0 || (bytes.size > 0 && tm_write_all(fd, bytes.byte + mark,
                                                  bytes.size - mark, &error) != TM_OK))
        filter_fail(&f, &error);
    tm_text_free(&bytes);
    return fd;
}

static int open_input(void)
{
    const int fd = f.input ? open(f.input, O_RDONLY | O_CLOEXEC)
                           : fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    if (fd >= 0 && is_plain(fd))
        return fd;
    if (fd >= 0)
        close(fd);
    return hold();
}

/* The most that Gmsh may take: several times what whole files need. */
static gmsh_limits limits_for(size_t size)
{
    enum { BASE = 1 << 30, FACTOR = 100, SECONDS = 60, BYTES_PER_SECOND = 100000 };
    return (gmsh_limits){.memory = BASE + FACTOR * size,
                         .seconds = (unsigned)(SECONDS + size / BYTES_PER_SECOND)};
}

static bool has_several_groups(const gmsh_model *model)
{
    for (size_t i = 0; i < model->entities; i++)
        if (model->entity[i].groups > 1)
            return true;
    return false;
}

/* What Gmsh warns of. */
static void say_warnings(const gmsh_model *model)
{
    enum { MOST = 5 };
    for (size_t i = 0; i < model->warnings && i < MOST; i++)
        filter_note(&f, "%s: Gmsh: %.*s", filter_input_name(&f),
                    (int)model->warning[i].size, model->warning[i].name);
    if (model->warnings > MOST)
        filter_note(&f, "%s: Gmsh: and %zu more warnings", filter_input_name(&f),
                    model->warnings - MOST);
}

/* What of the file is not in the stream, in one line. */
static void leave_out(const gmsh_model *model, const gmsh_done *done)
{
    const struct {
        size_t count;
        const char *what;
    } lost[] = {{done->high_order, "elements' nodes between their corners"},
                {done->loose, "faces that no cell has"},
                {done->degenerate, "elements that have a corner twice"}};
    tm_text text = {0};
    for (size_t i = 0; i < sizeof lost / sizeof *lost; i++)
        if (lost[i].count > 0)
            tm_text_format(&text, "%s%zu %s", text.size > 0 ? ", " : "", lost[i].count,
                           lost[i].what);
    for (size_t i = 0; i < model->others; i++)
        tm_text_format(&text, "%s%d of '%.*s'", text.size > 0 ? ", " : "",
                       model->other[i].tag, (int)model->other[i].size,
                       model->other[i].name);
    if (text.failed)
        filter_fail_memory(&f);
    if (text.size > 0)
        filter_leave_out(&f, "%s", text.byte);
    tm_text_free(&text);
}

static void say_what_was_done(const gmsh_done *done)
{
    const char *name = filter_input_name(&f);
    if (done->turned > 0)
        filter_note(&f, "%s: %zu of %zu cells were left-handed and are turned", name,
                    done->turned, done->cells);
    if (done->flat > 0)
        filter_note(&f, "%s: %zu of %zu cells are flat", name, done->flat, done->cells);
    if (done->halved > 0)
        filter_note(&f, "%s: %zu quadrilaterals are two triangles each now", name,
                    done->halved);
    if (done->several > 0)
        filter_note(&f,
                    "%s: there are elements of several physical groups: %zu markers and "
                    "regions stand for more than one (see .group)",
                    name, done->several);
    if (done->renumbered > 0)
        filter_note(&f,
                    "%s: %zu entities without a physical group have the number of one "
                    "and got another",
                    name, done->renumbered);
    if (done->between > 0)
        filter_verbose(&f, "%s: %zu elements between partitions are passed over", name,
                       done->between);
    if (done->repeated > 0)
        filter_verbose(&f, "%s: %zu elements were there before", name, done->repeated);
}

/* Reads the file, of old .msh files a second time where that tells more. */
static void read_mesh(tm_stream *stream, gmsh_input format, const gmsh_file *file,
                      gmsh_done *done)
{
    gmsh_model model = {0}, swapped = {0};
    gmsh_source source = {.fd = file->fd,
                          .suffix = gmsh_input_name[format],
                          .limits = limits_for(file->size)};
    tm_status status = gmsh_model_read(&model, &source, &error);
    source.swap_tags = format == GMSH_MSH && gmsh_input_is_old(file);
    const bool again = status == TM_OK && source.swap_tags && has_several_groups(&model);
    if (again)
        status = gmsh_model_read(&swapped, &source, &error);
    if (status == TM_OK)
        status = gmsh_to_stream(stream, &model, again ? &swapped : NULL, done, &error);
    if (status == TM_OK && done->nodes == 0)
        status = tm_fail(&error, TM_ERROR_INPUT, "has no nodes that Gmsh keeps");
    if (status != TM_OK)
        fail(file);
    say_warnings(&model);
    leave_out(&model, done);
    say_what_was_done(done);
    gmsh_model_free(&model);
    gmsh_model_free(&swapped);
}

static void write_json(const gmsh_done *done)
{
#define ROW(member) TM_REPORT_ROW(#member, NULL, NULL, gmsh_done, member)
    static const tm_report_row rows[] = {
        ROW(nodes),      ROW(cells),   ROW(faces),   ROW(edges), ROW(names),
        ROW(turned),     ROW(flat),    ROW(halved),  ROW(loose), ROW(repeated),
        ROW(degenerate), ROW(several), ROW(between), {0}};
    filter_write_json(&f, rows, done);
}

int main(int argc, char **argv)
{
    gmsh_file file;
    tm_stream stream;
    gmsh_done done;
    filter_start(&f, argc, argv);
    gmsh_input format = read_options();
    const int fd = open_input();
    if (gmsh_file_look(&file, fd, filter_input_name(&f), &error) != TM_OK)
        filter_fail(&f, &error);
    format = find_format(format, &file);
    filter_stage(&f, "reading by Gmsh");
    tm_stream_init(&stream);
    read_mesh(&stream, format, &file, &done);
    gmsh_file_free(&file);
    close(fd);
    write_json(&done);
    filter_write(&f, &stream, "%zu nodes, %zu cells, %zu faces, %zu edges", done.nodes,
                 done.cells, done.faces, done.edges);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
