/* SPDX-License-Identifier: GPL-3.0-or-later */
/* openfoam-import: the polyMesh folder of an OpenFOAM case as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/openfoam/openfoam.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

enum { OPTION_ELEMENTS = FILTER_OWN };

static const struct option options[] = {{"elements", no_argument, NULL, OPTION_ELEMENTS},
                                        FILTER_OPTIONS};

static filter f = {
    .name = "openfoam-import",
    .synopsis = "[--elements] CASE",
    .purpose = "Reads the mesh of an OpenFOAM case, or a polyMesh folder, as polyhedra.",
    .help = "      --elements      cells as tetrahedra, or mixed elements, if they are "
            "such\n",
    .options = options,
    .letters = FILTER_LETTERS,
};

static tm_error error;

static char *joined(const char *folder, const char *name, const char *suffix)
{
    tm_text text = {0};
    tm_text_format(&text, "%s%s%s%s", folder, *name ? "/" : "", name, suffix);
    if (text.failed)
        filter_fail_memory(&f);
    return text.byte;
}

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* The folder of the mesh: a case's constant/polyMesh, or the operand itself. */
static char *find_folder(const char *operand)
{
    char *of_case = joined(operand, "constant/polyMesh", "");
    if (is_folder(of_case))
        return of_case;
    free(of_case);
    return joined(operand, "", "");
}

/* A file is read to say what it looks like. */
_Noreturn static void refuse_file(const char *path)
{
    tm_text bytes = {0};
    filter_read_file(&f, path, &bytes);
    tm_fail_at(&error, TM_ERROR_INPUT, path, 0, NULL,
               "is no folder (a case of OpenFOAM, or its polyMesh, would be right)");
    filter_fail_file(&f, &error, &bytes, "openfoam-import");
}

/* Reads NAME or NAME.gz, if it is there. */
static void read_file(const char *folder, const char *name, tm_openfoam_file *file)
{
    static const char *const suffix[] = {"", ".gz"};
    for (size_t i = 0; i < 2; i++) {
        char *path = joined(folder, name, suffix[i]);
        if (access(path, F_OK) == 0) {
            file->path = path;
            filter_read_file(&f, path, &file->bytes);
            return;
        }
        free(path);
    }
}

static void say(const tm_openfoam_report *report)
{
    if (report->types > 0)
        filter_leave_out(&f, "the types of %zu patches (%s)", report->types,
                         report->type_names.byte);
    if (report->cells_of_two > 0)
        filter_leave_out(&f, "%zu cells of zones that are in another one before",
                         report->cells_of_two);
    if (report->faces_of_two > 0)
        filter_leave_out(&f, "%zu faces of zones that have a patch or a zone before",
                         report->faces_of_two);
    if (report->flipped > 0)
        filter_leave_out(&f, "the turns of %zu faces of zones (flipMap)",
                         report->flipped);
    if (report->not_elements > 0)
        filter_note(&f,
                    "%s: %zu cells are no tetrahedra, pyramids, wedges or hexahedra: all "
                    "stay polyhedra",
                    filter_input_name(&f), report->not_elements);
}

/* No stream has a place for zones of points. */
static void say_point_zones(const char *folder)
{
    tm_openfoam_file file = {0};
    size_t zones = 0;
    read_file(folder, "pointZones", &file);
    if (file.path && tm_openfoam_count_zones(&file, &zones, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    if (zones > 0)
        filter_leave_out(&f, "%zu zones of points (pointZones)", zones);
    free((char *)file.path);
    tm_text_free(&file.bytes);
}

static void read_folder(const char *folder, bool elements, tm_stream *stream)
{
    tm_openfoam_file file[TM_OPENFOAM_FILES] = {0};
    tm_openfoam_report report;
    for (int i = 0; i < TM_OPENFOAM_FILES; i++)
        read_file(folder, tm_openfoam_name[i], &file[i]);
    if (tm_openfoam_read(stream, (const tm_openfoam_file *)file, elements, &report,
                         &error) != TM_OK)
        mesh_input_fail(&f, &error);
    say(&report);
    say_point_zones(folder);
    tm_openfoam_report_free(&report);
    for (int i = 0; i < TM_OPENFOAM_FILES; i++) {
        free((char *)file[i].path);
        tm_text_free(&file[i].bytes);
    }
}

int main(int argc, char **argv)
{
    bool elements = false;
    tm_stream stream;
    filter_start(&f, argc, argv);
    while (filter_option(&f) != -1)
        elements = true; /* OPTION_ELEMENTS */
    if (optind >= f.argc)
        filter_usage_error(&f, "CASE is missing, the folder of the mesh");
    filter_operands(&f);
    if (!f.input)
        filter_usage_error(&f, "CASE is a folder, not standard input");
    if (!is_folder(f.input))
        refuse_file(f.input);
    char *folder = find_folder(f.input);
    tm_stream_init(&stream);
    read_folder(folder, elements, &stream);
    free(folder);
    return mesh_write_stream(&f, &stream);
}
