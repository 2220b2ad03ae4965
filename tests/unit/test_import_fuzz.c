/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No input makes the readers of VTK's, OpenFOAM's, Abaqus' and Medit's files crash, or
 * return a mesh whose blocks contradict each other: every beginning of a good file, and
 * good files with bytes changed, TM_CASES of each. */
#include "../../lib/format/abaqus/abaqus.h"
#include "../../lib/format/medit/medit.h"
#include "../../lib/format/mesh_format.h"
#include "../../lib/format/openfoam/openfoam.h"
#include "../../lib/format/visf.h"
#include "../../lib/format/vtk/vtk.h"
#include "../../lib/format/vtk/vtk_read.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

enum { CHANGED = 2000, CHANGES_MAX = 4 };

static int changed_files = CHANGED;

/* Two tetrahedra as polyhedra, and a cube, a pyramid and a wedge. */
static const char polyhedra_text[] = "2 2\n5\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n7\n"
                                     "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 1 4 3\n"
                                     "3 2 4 1\n3 3 4 2\n0\n2\n4 0 1 2 3\n4 3 4 5 6\n";
static const char mixed_text[] =
    "MIXED\n11 3\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n.5 .5 2\n"
    "2 0 0\n2 0 1\nH 0 1 2 3 4 5 6 7\nP 4 5 6 7 8\nR 1 9 2 5 10 6\n";

/* All that text can hold, and two pieces. */
static const char vtu_text[] =
    "<VTKFile type=\"UnstructuredGrid\" header_type=\"UInt32\"><UnstructuredGrid>"
    "<FieldData><Array type=\"String\" Name=\"group_names\" format=\"ascii\">50 32 49 32 "
    "97 0</Array></FieldData><Piece NumberOfPoints=\"4\" NumberOfCells=\"3\"><CellData>"
    "<DataArray type=\"Int8\" Name=\"marker\">0 1 2</DataArray><DataArray "
    "type=\"Float32\" Name=\"v\" NumberOfComponents=\"2\">1 2 3 4 5 6</DataArray>"
    "</CellData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 "
    "0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int32\" "
    "Name=\"connectivity\">0 1 2 3 0 2 1 0 1</DataArray><DataArray type=\"Int64\" "
    "Name=\"offsets\" format=\"binary\">GAAAAAQAAAAAAAAABwAAAAAAAAAJAAAAAAAAAA=="
    "</DataArray><DataArray type=\"UInt8\" Name=\"types\">42 5 3</DataArray><DataArray "
    "type=\"Int64\" Name=\"faces\">4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3</DataArray>"
    "<DataArray type=\"Int64\" Name=\"faceoffsets\">17 -1 -1</DataArray></Cells></Piece>"
    "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/></UnstructuredGrid></VTKFile>";

static const char vtk_text[] =
    "# vtk DataFile Version 5.1\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nFIELD f 2\n"
    "group_names 1 1 string\n2%201%20a\nt 1 2 bit\n0 1\nPOINTS 5 float\n0 0 0 1 0 0\n"
    "0 1 0 0 0 1\n1 1 1\nMETADATA\nINFORMATION 0\n\nCELLS 4 24\nOFFSETS vtktypeint64\n"
    "0 4 21 24\nCONNECTIVITY vtktypeint64\n1 2 3 4 4 3 0 2 1 3 0 1 3 3 1 2 3 3 2 0 3 0 2 "
    "1\n"
    "CELL_TYPES 3\n10 42 5\nCELL_DATA 3\nSCALARS region int 1\nLOOKUP_TABLE d\n1 2 3\n"
    "LOOKUP_TABLE d 1\n0 0 0 1\nPOINT_DATA 5\nTENSORS6 t float\n"
    "0 1 2 3 4 5 0 1 2 3 4 5 0 1 2 3 4 5 0 1 2 3 4 5 0 1 2 3 4 5\nNORMALS n double\n"
    "0 0 1 0 0 1 0 0 1 0 0 1 0 0 1\n";

typedef tm_status grid_reader(tm_stream *stream, const char *bytes, size_t size,
                              const char *name, const tm_vtk_read_options *options,
                              tm_vtk_read_report *report, tm_error *error);

/* What is read is written as a stream that is read. */
static void check_stream(const tm_stream *stream)
{
    tm_stream again;
    tm_error error;
    char path[] = "/tmp/termesh-import.XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    unlink(path);
    assert_int_equal(tm_stream_write(stream, fd, 1, &error), TM_OK);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    tm_stream_init(&again);
    const tm_status status = tm_stream_read(&again, fd, "again", 1, &error);
    if (status != TM_OK)
        print_error("%s: %s\n", error.block, error.what);
    assert_int_equal(status, TM_OK);
    tm_stream_free(&again);
    close(fd);
}

/* The bytes are read where reading one more is an error that a sanitizer sees. */
static tm_status read_grid(grid_reader *read, const char *bytes, size_t size)
{
    static const tm_vtk_read_options options = {.threads = 1};
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    tm_stream stream;
    tm_vtk_read_report report;
    tm_error error = {.status = TM_OK};
    tm_stream_init(&stream);
    if (read(&stream, copy, size, "file", &options, &report, &error) == TM_OK) {
        check_stream(&stream);
    } else {
        assert_int_equal(error.status, TM_ERROR_INPUT);
        assert_true(error.what[0] != '\0');
        assert_int_equal(stream.blocks, 0);
    }
    tm_vtk_read_report_free(&report);
    tm_stream_free(&stream);
    free(copy);
    return error.status;
}

/* Bytes that mean something in these formats are likelier than others. */
static void change(char *bytes, size_t size)
{
    static const char likely[] = "0123456789-.eE \n<>\"/=(){};ACgx";
    for (unsigned n = 1 + random_below(CHANGES_MAX); n > 0 && size > 0; n--)
        bytes[random_below((unsigned)size)] =
            random_below(4) ? likely[random_below(sizeof likely - 1)]
                            : (char)random_below(256);
}

static void read_damaged(grid_reader *read, const char *bytes, size_t size)
{
    for (size_t cut = 0; cut < size; cut++)
        read_grid(read, bytes, cut);
    assert_int_equal(read_grid(read, bytes, size), TM_OK);
    for (int i = 0; i < changed_files; i++) {
        char *changed = malloc(size);
        assert_non_null(changed);
        memcpy(changed, bytes, size);
        change(changed, size);
        read_grid(read, changed, size);
        free(changed);
    }
}

/* The streams that the samples are written of. */
static void make_streams(tm_stream stream[2])
{
    tm_polyhedra_repairs repairs;
    size_t materials;
    tm_error error;
    tm_stream_init(&stream[0]);
    tm_stream_init(&stream[1]);
    assert_int_equal(tm_visf_read(&stream[0], polyhedra_text, sizeof polyhedra_text - 1,
                                  "file", &repairs, &error),
                     TM_OK);
    assert_int_equal(tm_m3d_read(&stream[1], mixed_text, sizeof mixed_text - 1, "file",
                                 &materials, &error),
                     TM_OK);
}

static void test_vtu(void **state)
{
    static const tm_vtk_options options = {true, true, true};
    tm_stream stream[2];
    tm_error error;
    (void)state;
    make_streams(stream);
    read_damaged(tm_vtu_read, vtu_text, sizeof vtu_text - 1);
    for (size_t s = 0; s < 2; s++) {
        tm_text text = {0};
        assert_int_equal(tm_vtu_write(&text, &stream[s], &options, 1, &error), TM_OK);
        read_damaged(tm_vtu_read, text.byte, text.size);
        tm_text_free(&text);
        tm_stream_free(&stream[s]);
    }
}

static void test_vtk(void **state)
{
    static const tm_vtk_options options = {true, false, true};
    tm_stream stream[2];
    tm_error error;
    (void)state;
    make_streams(stream);
    read_damaged(tm_vtk_read, vtk_text, sizeof vtk_text - 1);
    for (size_t s = 0; s < 2; s++) {
        tm_text text = {0};
        assert_int_equal(tm_vtk_write(&text, &stream[s], &options, 1, &error), TM_OK);
        read_damaged(tm_vtk_read, text.byte, text.size);
        tm_text_free(&text);
        tm_stream_free(&stream[s]);
    }
}

/* All that an input file can hold that is read. */
static const char inp_text[] =
    "*PART, NAME=P\n*NODE, NSET=N\n4, 0, 0, 0\n2, 1, 0\n3, 0, 1D0, 0\n1, 0, 0, 1\n"
    "5, .5, 0, 0\n*ELEMENT, TYPE=C3D4, ELSET=A\n7, 4, 2,\n3, 1\n*ELEMENT, TYPE=S3\n"
    "8, 4, 2, 3\n*ELEMENT, TYPE=B32\n9, 4, 5, 2\n*ELEMENT, TYPE=MASS\n3, 1\n*ELSET, "
    "ELSET=B, GENERATE\n1, 9, 2\n*ELSET, ELSET=C\nA, 8, B\n*NSET, NSET=M, ELSET=B\n"
    "*SOLID SECTION, ELSET=B\n1\n*END PART\n*ASSEMBLY\n*INSTANCE, NAME=I, PART=P\n"
    "1, 2, 3\n0, 0, 0, 0, 0, 1, 30\n*END INSTANCE\n*INSTANCE, NAME=J, PART=P\n*END "
    "INSTANCE\n*NSET, NSET=X, INSTANCE=I\nN, 3\n*SURFACE, NAME=S\nI.B, S2\nJ.7, S1\n"
    "*SURFACE, NAME=T, TYPE=NODE\nX, 1.\n*END ASSEMBLY\n";

static tm_status read_abaqus(tm_stream *stream, const char *bytes, size_t size,
                             const char *name, const tm_vtk_read_options *options,
                             tm_vtk_read_report *report, tm_error *error)
{
    tm_abaqus_report said;
    (void)options;
    *report = (tm_vtk_read_report){0};
    const tm_status status = tm_abaqus_read(stream, bytes, size, name, &said, error);
    tm_abaqus_report_free(&said);
    return status;
}

static const char mesh_text[] =
    "MeshVersionFormatted 2\nDimension 3\n# termesh 3 5 a\n# termesh 2 6 b\nVertices\n6\n"
    "0 0 0 1\n1 0 0 2\n0 1 0 0\n0 0 1 -1\n.5 0 0 0\n9 9 9 9\nTetrahedra\n1\n1 2 3 4 5\n"
    "TrianglesP2\n1\n1 3 2 5 5 5 6\nEdges\n1\n1 2 7\nCorners\n1\n1\nNormals\n1\n0 0 1\n"
    "End\n";

/* The mesh itself, and as the solution of one. */
static tm_status read_medit(tm_stream *stream, const char *bytes, size_t size,
                            const char *name, const tm_vtk_read_options *options,
                            tm_vtk_read_report *report, tm_error *error)
{
    const tm_medit_bytes mesh = {name, bytes, size};
    tm_medit_report said;
    (void)options;
    *report = (tm_vtk_read_report){0};
    const tm_status status = tm_medit_read(stream, &mesh, NULL, &said, error);
    tm_medit_report_free(&said);
    return status;
}

static tm_status read_solution(tm_stream *stream, const char *bytes, size_t size,
                               const char *name, const tm_vtk_read_options *options,
                               tm_vtk_read_report *report, tm_error *error)
{
    static const char two[] =
        "MeshVersionFormatted 2 Dimension 3 Vertices 2 0 0 0 0 1 1 1 "
        "0 End";
    const tm_medit_bytes mesh = {"mesh", two, sizeof two - 1};
    const tm_medit_bytes solution = {name, bytes, size};
    tm_medit_report said;
    (void)options;
    *report = (tm_vtk_read_report){0};
    const tm_status status = tm_medit_read(stream, &mesh, &solution, &said, error);
    tm_medit_report_free(&said);
    return status;
}

static void test_abaqus(void **state)
{
    tm_stream stream[2];
    tm_text text = {0};
    tm_error error;
    size_t loose;
    (void)state;
    make_streams(stream);
    for (size_t cut = 0; cut < sizeof inp_text; cut++)
        read_grid(read_abaqus, inp_text, cut);
    read_damaged(read_abaqus, inp_text, sizeof inp_text - 1);
    assert_int_equal(tm_abaqus_write(&text, &stream[1], 1, &loose, &error), TM_OK);
    read_damaged(read_abaqus, text.byte, text.size);
    tm_text_free(&text);
    tm_stream_free(&stream[0]);
    tm_stream_free(&stream[1]);
}

static void test_medit(void **state)
{
    static const char points[] =
        "termesh 1\n.node\n2 3 10 0\n1 0 0 0 1 2 3 4 5 6 7 8 9 10\n"
        "2 1 1 1 1 2 3 4 5 6 7 8 9 10\n.end\n";
    static const tm_medit_kind kinds[] = {TM_MEDIT_VECTOR, TM_MEDIT_SCALAR,
                                          TM_MEDIT_TENSOR};
    tm_stream stream[2], with_attributes;
    tm_error error;
    (void)state;
    make_streams(stream);
    const int fd = memfd_create("points", MFD_CLOEXEC);
    assert_int_equal(write(fd, points, sizeof points - 1), sizeof points - 1);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    tm_stream_init(&with_attributes);
    assert_int_equal(tm_stream_read(&with_attributes, fd, "points", 1, &error), TM_OK);
    close(fd);
    read_damaged(read_medit, mesh_text, sizeof mesh_text - 1);
    for (int binary = 0; binary < 2; binary++) {
        tm_text text = {0}, values = {0};
        size_t polygons;
        assert_int_equal(tm_medit_write(&text, &stream[1], binary, 1, &polygons, &error),
                         TM_OK);
        read_damaged(read_medit, text.byte, text.size);
        assert_int_equal(tm_medit_write_solution(&values, &with_attributes, kinds, 3,
                                                 binary, 1, &error),
                         TM_OK);
        read_damaged(read_solution, values.byte, values.size);
        tm_text_free(&text);
        tm_text_free(&values);
    }
    tm_stream_free(&with_attributes);
    tm_stream_free(&stream[0]);
    tm_stream_free(&stream[1]);
}

/* OpenFOAM, of which one file is damaged. */
static void read_foam(const tm_text whole[TM_OPENFOAM_FILES], int damaged,
                      const char *bytes, size_t size)
{
    tm_openfoam_file file[TM_OPENFOAM_FILES] = {0};
    char *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    for (int i = 0; i < TM_OPENFOAM_FILES; i++) {
        file[i].path = tm_openfoam_name[i];
        file[i].bytes = whole[i];
    }
    file[damaged].bytes = (tm_text){.byte = copy, .size = size};
    for (int elements = 0; elements < 2; elements++) {
        tm_stream stream;
        tm_openfoam_report report;
        tm_error error = {.status = TM_OK};
        tm_stream_init(&stream);
        if (tm_openfoam_read(&stream, file, elements, &report, &error) == TM_OK) {
            check_stream(&stream);
        } else {
            assert_int_equal(error.status, TM_ERROR_INPUT);
            assert_int_equal(stream.blocks, 0);
        }
        tm_openfoam_report_free(&report);
        tm_stream_free(&stream);
    }
    free(copy);
}

static void test_openfoam(void **state)
{
    tm_stream stream[2];
    tm_error error;
    (void)state;
    make_streams(stream);
    for (size_t s = 0; s < 2; s++) {
        tm_text file[TM_OPENFOAM_FILES] = {0};
        tm_openfoam_counts counts;
        assert_int_equal(
            tm_openfoam_write(file, &stream[s], &counts, NULL, false, &error), TM_OK);
        for (int f = 0; f < TM_OPENFOAM_FILES; f++) {
            for (size_t cut = 0; cut <= file[f].size; cut++)
                read_foam(file, f, file[f].byte, cut);
            for (int i = 0; i < changed_files / TM_OPENFOAM_FILES; i++) {
                char *changed = malloc(file[f].size + 1);
                assert_non_null(changed);
                memcpy(changed, file[f].byte, file[f].size);
                change(changed, file[f].size);
                read_foam(file, f, changed, file[f].size);
                free(changed);
            }
        }
        for (int f = 0; f < TM_OPENFOAM_FILES; f++)
            tm_text_free(&file[f]);
        tm_stream_free(&stream[s]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vtu),      cmocka_unit_test(test_vtk),
        cmocka_unit_test(test_abaqus),   cmocka_unit_test(test_medit),
        cmocka_unit_test(test_openfoam),
    };
    const char *cases = getenv("TM_CASES");
    changed_files = cases ? atoi(cases) : CHANGED;
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
