/* SPDX-License-Identifier: GPL-3.0-or-later */
/* openfoam-export: the cells of a stream as a polyMesh folder of OpenFOAM. */
#include "../common/input/left_out.h"
#include "../common/input/mesh_input.h"
#include "../common/app/output_files.h"

#include "../../lib/format/openfoam/openfoam.h"
#include "../../lib/stream/coordinates.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const struct option long_options[] = {FILTER_OPTIONS};

static const char *read_operands(filter *f)
{
    while (filter_option(f) != -1)
        ;
    if (f->output)
        filter_usage_error(f, "-o: the output is the files in FOLDER");
    if (optind >= f->argc)
        filter_usage_error(f, "FOLDER is missing, in which the files will be");
    const char *folder = f->argv[optind++];
    filter_operands(f);
    return folder;
}

/* Whether a file of that name will be written, if it is there. */
static bool is_ours(const char *name)
{
    for (int i = 0; i < TM_OPENFOAM_FILES; i++)
        if (strcmp(name, tm_openfoam_name[i]) == 0)
            return true;
    return strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
}

/* OpenFOAM reads sets and whatever else is in the folder: what is of another mesh must
 * not be there. */
static tm_status refuse_other_files(const char *folder, tm_error *error)
{
    tm_status status = TM_OK;
    DIR *entries = opendir(folder);
    const struct dirent *entry;
    while (entries && status == TM_OK && (entry = readdir(entries)))
        if (!is_ours(entry->d_name))
            status = tm_fail_at(error, TM_ERROR_SYSTEM, folder, 0, NULL,
                                "there is also '%s' in the folder, which may be of "
                                "another mesh (a new folder would be right)",
                                entry->d_name);
    if (entries)
        closedir(entries);
    return status;
}

/* A file that is not needed is written in the place of one of another mesh only. */
static tm_status write_file(output_files *files, const char *folder, const char *name,
                            const tm_text *text, bool is_needed, tm_error *error)
{
    tm_text path = {0};
    tm_text_format(&path, "%s/%s", folder, name);
    if (path.failed)
        return tm_fail_memory(error);
    const bool is_written = is_needed || access(path.byte, F_OK) == 0;
    const tm_status status =
        is_written ? output_files_write(files, path.byte, text, error) : TM_OK;
    tm_text_free(&path);
    return status;
}

/* All files but their names: filter_finish() gives them. */
static void write_folder(const filter *f, const char *folder, const tm_text *file,
                         const tm_openfoam_counts *counts)
{
    const bool is_needed[TM_OPENFOAM_FILES] = {
        true, true, true, true, true, counts->cell_zones > 0, counts->face_zones > 0};
    tm_error error;
    tm_status status = refuse_other_files(folder, &error);
    if (status == TM_OK)
        status = output_files_make_folder(f->files, folder, &error);
    for (int i = 0; i < TM_OPENFOAM_FILES && status == TM_OK; i++)
        status = write_file(f->files, folder, tm_openfoam_name[i], &file[i], is_needed[i],
                            &error);
    if (status != TM_OK)
        filter_fail(f, &error);
}

static void write_json(filter *f, const tm_openfoam_counts *counts)
{
#define ROW(key, member) TM_REPORT_ROW(key, NULL, NULL, tm_openfoam_counts, member)
    static const tm_report_row rows[] = {ROW("points", points),
                                         ROW("faces", faces),
                                         ROW("cells", cells),
                                         ROW("patches", patches),
                                         ROW("cell_zones", cell_zones),
                                         ROW("face_zones", face_zones),
                                         {0}};
    filter_write_json(f, rows, counts);
}

/* One line of what checkMesh finds. */
typedef struct {
    size_t count;
    const char *what;
    double worst;
} finding;

/* Says the findings of which there are any; returns whether there was one. */
static bool say(const filter *f, const char *check, const finding *found, size_t count)
{
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        if (found[i].count > 0)
            filter_note(f, "%s would fail: %zu %s, the worst %.3g", check, found[i].count,
                        found[i].what, found[i].worst);
        any |= found[i].count > 0;
    }
    return any;
}

/* Whether the last line of the history that is of a filter which makes polyhedra is of
 * this one. */
static bool is_made_by(const tm_stream *stream, const char *name)
{
    static const char *const makers[] = {"# polylla3d ", "# poly-dual ",
                                         "# octree-mesh "};
    const char *last = "";
    const char *line = stream->history.byte ? stream->history.byte : "";
    for (; *line; line += strcspn(line, "\n") + 1)
        for (size_t i = 0; i < sizeof makers / sizeof *makers; i++)
            if (strncmp(line, makers[i], strlen(makers[i])) == 0)
                last = line;
    return strncmp(last, name, strlen(name)) == 0;
}

/* What makes a better mesh of what this one was made of. */
static const char *help_for(const tm_stream *stream, tm_content content)
{
    switch (content) {
    case TM_CONTENT_TETRAHEDRA:
        return "lepp-improve, or poly-dual --convex, which makes polyhedra of them";
    case TM_CONTENT_MIXED:
        return tm_stream_find(stream, ".octant")
                   ? "polylla3d, which makes a polyhedron of each octant"
                   : "octree-mesh --polyhedra of its surface (off-export)";
    default:
        break;
    }
    if (is_made_by(stream, "# octree-mesh "))
        return "octree-mesh --polyhedra with another -s";
    if (is_made_by(stream, "# poly-dual "))
        return "poly-dual --feature-angle 30 --convex, or lepp-improve before it";
    if (is_made_by(stream, "# polylla3d "))
        return "of what it was joined from polylla3d --star=centroid, or poly-dual "
               "--convex";
    return "octree-mesh --polyhedra of its surface (off-export)";
}

/* Whether checkMesh would take the mesh, and what may help; with -v also what it looks at
 * with -allGeometry only. */
static void say_what_fails(const filter *f, const tm_poly_finite_volume *m,
                           const char *help)
{
    const finding always[] = {
        {m->wrong_pyramids, "pyramids of a face and a cell's centroid without volume",
         m->min_pyramid},
        {m->reversed, "faces with a non-orthogonality of 90 degrees and more",
         m->max_non_orthogonality},
        {m->skew, "faces with a skewness above 4", m->max_skewness}};
    const finding all[] = {
        {m->small_weights, "faces with a weight below 0.05", m->min_weight},
        {m->small_volume_ratios, "faces between volumes with a ratio below 0.01",
         m->min_volume_ratio},
        {m->small_determinants, "cells with a determinant below 0.001",
         m->min_determinant}};
    bool fails = say(f, "checkMesh", always, sizeof always / sizeof *always);
    if (f->verbosity > 0) {
        fails |= say(f, "checkMesh -allGeometry", all, sizeof all / sizeof *all);
        if (m->concave > 0)
            filter_note(f, "checkMesh -allGeometry would fail: %zu concave cells",
                        m->concave);
        const size_t faces = m->no_fan > m->unseen ? m->no_fan : m->unseen;
        if (faces > 0)
            filter_note(f,
                        "checkMesh -allGeometry would fail: %zu faces whose tetrahedra "
                        "are not all positive",
                        faces);
        fails |= m->concave + faces > 0;
    }
    if (fails)
        filter_note(f, "what may help: %s", help);
}

/* Not where that is not asked for, or coordinates are too large or too small. */
static bool can_be_measured(const filter *f, const tm_stream *stream)
{
    tm_error error;
    if (f->verbosity < 0)
        return false;
    if (tm_stream_check_coordinates(stream, &error) == TM_OK)
        return true;
    filter_note(f, "not measured for checkMesh: %s", error.what);
    return false;
}

int main(int argc, char **argv)
{
    filter f = {
        .name = "openfoam-export",
        .synopsis = "[options] FOLDER [FILE]",
        .purpose = "Writes tetrahedra, mixed elements or polyhedra as the files of an\n"
                   "OpenFOAM mesh in FOLDER, a case's constant/polyMesh.",
        .help = "",
        .options = long_options,
        .letters = FILTER_LETTERS,
    };
    filter_start(&f, argc, argv);
    const char *folder = read_operands(&f);

    tm_stream stream;
    tm_text file[TM_OPENFOAM_FILES] = {0};
    tm_openfoam_counts counts;
    tm_poly_finite_volume measures;
    tm_error error;
    const tm_content content = mesh_input_read(&f, &stream);
    const bool wanted = can_be_measured(&f, &stream);
    if (tm_openfoam_write(file, &stream, &counts, wanted ? &measures : NULL,
                          f.verbosity > 0, &error) != TM_OK)
        mesh_input_fail(&f, &error);
    mesh_leave_out(&f, &stream);
    write_folder(&f, folder, file, &counts);
    if (wanted)
        say_what_fails(&f, &measures, help_for(&stream, content));
    write_json(&f, &counts);
    for (int i = 0; i < TM_OPENFOAM_FILES; i++)
        tm_text_free(&file[i]);
    tm_stream_free(&stream);
    return filter_finish(&f, 0);
}
