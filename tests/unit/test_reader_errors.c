/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What readers refuse, and in which words: the rarer cases. What is refused leaves
 * nothing behind. */
#include "../../lib/format/abaqus/abaqus.h"
#include "../../lib/format/medit/medit.h"
#include "../../lib/format/openfoam/openfoam.h"
#include "../../lib/format/surface/surface_format.h"
#include "../../lib/format/vtk/vtk_read.h"
#include "../../lib/stream/group.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void assert_refused(tm_status status, const tm_error *error, size_t left,
                           const char *what)
{
    assert_int_equal(status, TM_ERROR_INPUT);
    if (!strstr(error->what, what))
        fail_msg("'%s' has no '%s'", error->what, what);
    assert_int_equal(left, 0);
}

#define PLY_POINTS                                                                       \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"      \
    "property float z\n"
#define PLY_END                                                                          \
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"        \
    "1 0 0\n0 1 0\n3 0 1 2\n"
#define PLY_BIG                                                                          \
    "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\n"            \
    "property float y\nproperty float z\nelement face 0\n"                               \
    "property list uchar int vertex_indices\nend_header\n"

static void test_surfaces(void **state)
{
    (void)state;
    static const struct {
        tm_format format;
        const char *text, *what;
    } files[] = {
        {TM_FORMAT_PLY, PLY_POINTS "element vertex 3\nproperty float x\n" PLY_END,
         "a second element vertex"},
        {TM_FORMAT_PLY, PLY_POINTS "property double x\n" PLY_END,
         "the property is there twice"},
        {TM_FORMAT_PLY, "ply\nformat ascii 1.0\nproperty float x\n" PLY_END,
         "a property before the first element"},
        {TM_FORMAT_PLY,
         PLY_POINTS "element face 1\nproperty list uchar float vertex_indices\n"
                    "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
         "vertex_indices are real numbers"},
        {TM_FORMAT_PLY, PLY_BIG "\x7f\x80\x80\x01\x01\x01\x01\x01\x01\x01\x01\x01",
         "vertex 0: a coordinate is not a finite number"},
        {TM_FORMAT_MDL,
         "[Vertices, ARRAY1<POINT3D>]\n1\n0 0 0\n[Vertices, ARRAY1<POINT3D>]\n1\n0 0 0\n",
         "a second section of type ARRAY1<POINT3D>"},
        {TM_FORMAT_MDL,
         "[Triangles, ARRAY1<STRING>]\n0\n[Triangles, ARRAY1<STRING>]\n0\n",
         "a second section of type ARRAY1<STRING>"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        tm_polygon_surface surface;
        tm_error error;
        tm_polygon_surface_init(&surface);
        const tm_status status = tm_format_read(&surface, files[i].format, files[i].text,
                                                strlen(files[i].text), "file", &error);
        assert_refused(status, &error, surface.nodes + surface.corners, files[i].what);
    }
}

static void test_abaqus(void **state)
{
    (void)state;
    static const struct {
        const char *text, *what;
    } files[] = {
        {"*PART, NAME=P\n*PART, NAME=Q\n", "stands in another part or instance"},
        {"*NODE\n1, 1e400, 0, 0\n", "'1e400' is too large"},
        {"*NODE\n1, 1D400, 0, 0\n", "'1D400' is too large"},
        {"*NODE\n1, one, 0, 0\n", "'one' is not a number"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        tm_stream stream;
        tm_abaqus_report report;
        tm_error error;
        tm_stream_init(&stream);
        const tm_status status = tm_abaqus_read(
            &stream, files[i].text, strlen(files[i].text), "file", &report, &error);
        assert_refused(status, &error, stream.blocks, files[i].what);
        tm_abaqus_report_free(&report);
    }
}

/* A name between quotation marks may have commas; what is outside of them is another
 * field. */
static void test_abaqus_quotes(void **state)
{
    (void)state;
    static const char text[] =
        "*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n4, 0, 0, 1\n*ELEMENT, TYPE=C3D4, "
        "ELSET=\"a, b\"\n1, 1, 2, 3, 4\n*ELSET, ELSET=C\n\"a, b\"\n";
    tm_stream stream;
    tm_abaqus_report report;
    tm_error error;
    tm_stream_init(&stream);
    assert_int_equal(
        tm_abaqus_read(&stream, text, sizeof text - 1, "file", &report, &error), TM_OK);
    assert_int_equal(tm_stream_find(&stream, ".ele")->count, 1);
    assert_int_equal(report.no_members, 0);
    tm_abaqus_report_free(&report);
    tm_stream_free(&stream);
}

/* Binary files that end anywhere, but in the last number, which stands behind End. */
static void test_medit_cut(void **state)
{
    (void)state;
    static const char text[] =
        "MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 0\nEnd\n";
    const tm_medit_bytes mesh = {"mesh", text, sizeof text - 1};
    tm_stream stream;
    tm_medit_report report;
    tm_text binary = {0};
    tm_error error;
    size_t polygons;
    tm_stream_init(&stream);
    assert_int_equal(tm_medit_read(&stream, &mesh, NULL, &report, &error), TM_OK);
    tm_medit_report_free(&report);
    assert_int_equal(tm_medit_write(&binary, &stream, true, 1, &polygons, &error), TM_OK);
    tm_stream_free(&stream);
    for (size_t size = 1; size < binary.size - 4; size++) {
        const tm_medit_bytes cut = {"mesh", binary.byte, size};
        const tm_status status = tm_medit_read(&stream, &cut, NULL, &report, &error);
        assert_refused(status, &error, stream.blocks, "");
        assert_true(error.what[0] != '\0');
        tm_medit_report_free(&report);
    }
    tm_text_free(&binary);
}

static tm_status read_points(tm_stream *stream, const char *text, size_t size,
                             tm_error *error)
{
    tm_openfoam_report report;
    tm_openfoam_file file[TM_OPENFOAM_FILES] = {0};
    for (int i = 0; i < TM_OPENFOAM_FILES; i++) {
        file[i].path = tm_openfoam_name[i];
        file[i].bytes = (tm_text){.byte = (char *)(uintptr_t)text, .size = size};
    }
    tm_stream_init(stream);
    const tm_status status = tm_openfoam_read(stream, file, false, &report, error);
    tm_openfoam_report_free(&report);
    return status;
}

static void test_openfoam(void **state)
{
    (void)state;
    static const char head[] = "FoamFile { format binary; class vectorField; arch "
                               "\"MSB;label=64;scalar=32\"; }\n";
    static const struct {
        const char *text, *what;
    } files[] = {
        {"9(", "the file ends in a list of 9 "},
        {"1(\x7f\xc0\x01\x01\x01\x01\x01\x01\x01\x01\x01\x01)",
         "point 0: a coordinate is no finite number"},
        {"/* no end", "comment"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        tm_text text = {0};
        tm_stream stream;
        tm_error error;
        tm_text_string(&text, head);
        tm_text_string(&text, files[i].text);
        const tm_status status = read_points(&stream, text.byte, text.size, &error);
        assert_refused(status, &error, stream.blocks, files[i].what);
        tm_text_free(&text);
    }
}

/* The bytes of names are numbers in a .vtu file: UTF-8 as char has it, signed or not. */
static void test_vtu_strings(void **state)
{
    (void)state;
    static const struct {
        const char *bytes, *name, *what; /* no name: refused */
    } files[] = {{"50 32 49 32 195 188 0", "\xc3\xbc", NULL},
                 {"50 32 49 32 -61 -68 0", "\xc3\xbc", NULL},
                 {"50 32 49 32 9770 0", NULL, "number 4 of a string is 9770"},
                 {"50 32 49 32 -129 0", NULL, "number 4 of a string is -129"},
                 {"50 32 49 32 97.5 0", NULL, "'97.5' is not a whole number"}};
    static const tm_vtk_read_options options = {.threads = 1};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        tm_text text = {0};
        tm_stream stream;
        tm_vtk_read_report report;
        tm_error error;
        tm_text_format(
            &text,
            "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><FieldData><Array "
            "type=\"String\" Name=\"group_names\" format=\"ascii\">%s</Array>"
            "</FieldData><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><CellData>"
            "<DataArray type=\"Int32\" Name=\"marker\">1</DataArray></CellData><Points>"
            "<DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0"
            "</DataArray></Points><Cells><DataArray type=\"Int32\" "
            "Name=\"connectivity\">0 1 2</DataArray><DataArray type=\"Int32\" "
            "Name=\"offsets\">3</DataArray><DataArray type=\"UInt8\" Name=\"types\">5"
            "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>",
            files[i].bytes);
        tm_stream_init(&stream);
        const tm_status status =
            tm_vtu_read(&stream, text.byte, text.size, "file", &options, &report, &error);
        if (files[i].name) {
            assert_int_equal(status, TM_OK);
            assert_string_equal(
                tm_group_find(tm_stream_find(&stream, ".group"), TM_GROUP_FACES, 1),
                files[i].name);
        } else {
            assert_refused(status, &error, stream.blocks, files[i].what);
        }
        tm_vtk_read_report_free(&report);
        tm_stream_free(&stream);
        tm_text_free(&text);
    }
}

/* An error without a line gets none. */
static void test_lines(void **state)
{
    (void)state;
    tm_error error;
    tm_fail_at(&error, TM_ERROR_INPUT, "file", 3, NULL, "wrong");
    tm_error_add_lines(4, &error);
    assert_int_equal(error.line, 7);
    tm_fail_at(&error, TM_ERROR_INPUT, "file", 0, NULL, "wrong");
    tm_error_add_lines(4, &error);
    assert_int_equal(error.line, 0);
    tm_error_add_lines(4, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_surfaces),      cmocka_unit_test(test_abaqus),
        cmocka_unit_test(test_abaqus_quotes), cmocka_unit_test(test_medit_cut),
        cmocka_unit_test(test_openfoam),      cmocka_unit_test(test_vtu_strings),
        cmocka_unit_test(test_lines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
