/* SPDX-License-Identifier: GPL-3.0-or-later */
/* abaqus-import: the mesh of an input file of Abaqus or CalculiX as a stream. */
#include "../common/input/mesh_input.h"

#include "../../lib/format/abaqus/abaqus.h"

static void say(const filter *f, const tm_abaqus_report *r)
{
    if (r->instances > 1)
        mesh_note_count(f, r->instances, "instances are one mesh");
    mesh_note_count(f, r->turned, "elements were left-handed and are turned");
    mesh_note_count(f, r->cut,
                    "quadrilaterals of the surface are two triangles each now");
    mesh_note_count(
        f, r->several,
        "markers and regions stand for more than one set, which has such members");
    mesh_leave_out_middles(f, r->middle_nodes, r->higher_order);
    if (r->others > 0)
        filter_leave_out(f, "%zu elements of other types (%s)", r->others, r->types.byte);
    mesh_leave_out_count(f, r->loose, "faces that no element has");
    mesh_leave_out_count(f, r->no_members, "members of sets that are not there");
    mesh_leave_out_count(f, r->no_faces,
                         "rows of surfaces that name no face of an element");
    mesh_leave_out_count(f, r->surfaces, "surfaces that are not of elements or nodes");
}

static tm_status read_abaqus(const filter *f, tm_stream *stream, const tm_text *bytes,
                             tm_error *error)
{
    tm_abaqus_report report;
    const tm_status status = tm_abaqus_read(stream, bytes->byte, bytes->size,
                                            filter_input_name(f), &report, error);
    if (status == TM_OK)
        say(f, &report);
    tm_abaqus_report_free(&report);
    return status;
}

int main(int argc, char **argv)
{
    return mesh_import(
        argc, argv, "abaqus-import",
        "Reads the mesh of an input file of Abaqus or CalculiX (.inp): nodes,\n"
        "elements, sets and surfaces.",
        read_abaqus);
}
