/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The stream: what is read is written again; everything that can be wrong is said with
 * file, line and block. */
#include "../../lib/stream/stream.h"

#include "../../lib/text/file.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

/* All blocks of version 1, a part, an unknown block, history. */
static const char all[] = "termesh 1\n"
                          "# a history line\n"
                          "# another\n"
                          ".node\n5 3 2 1\n"
                          "1 0 0 0 0.5 1e30 -5\n"
                          "2 1 0 0 1 2 0\n"
                          "3 0 1 0 -0 3 7\n"
                          "4 0 0 1 1e-9 4 2147483647\n"
                          "5 1 1 1 0.1 5 -2147483648\n"
                          ".ele\n2 4 1\n1 1 2 3 4 7\n2 2 3 4 5 8.5\n"
                          ".face\n1 1\n1 1 3 2 5\n"
                          ".edge\n1 0\n1 4 5\n"
                          ".mix\n1 1\n1 4 1 2 3 4 0.25\n"
                          ".octant\n1 0\n1 3 0 4 2 1 2\n"
                          ".root\n1 0\n1 -1 -1 -1 2 5\n"
                          ".facet\n4 1\n"
                          "1 1 -1 3 1 2 3 0\n2 1 -1 3 1 2 4 0\n"
                          "3 1 -1 3 2 3 4 1\n4 1 -1 3 1 3 4 1\n"
                          ".cell\n1 2\n1 4 1 2 3 4 1 2\n"
                          ".group\n4 0\n1 2 5 inlet port\n2 3 7 5 steel #1\n"
                          "3 0 -2147483648 gr\xc3\xb6\xc3\x9f"
                          "er\n4 1 5 inlet port\n"
                          "surface.node\n1 3 0 0\n1 0.25 0.25 0.25\n"
                          "surface.odd\nwhatever 1 2 3\n# kept\n.5 is a row, too\n"
                          ".end\n";

/* A file in memory with that text. */
static int file_of(const char *text, size_t size)
{
    int fd = memfd_create("stream", 0);
    assert_true(fd >= 0);
    assert_int_equal(tm_write_all(fd, text, size, NULL), TM_OK);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    return fd;
}

static tm_status read_text(tm_stream *stream, const char *text, size_t size,
                           tm_error *error)
{
    int fd = file_of(text, size);
    tm_stream_init(stream);
    tm_status status = tm_stream_read(stream, fd, "x.tm", 1, error);
    close(fd);
    return status;
}

static void assert_written(const tm_stream *stream, unsigned threads,
                           const char *expected)
{
    tm_text text = {0};
    int fd = memfd_create("stream", 0);
    assert_int_equal(tm_stream_write(stream, fd, threads, NULL), TM_OK);
    assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
    assert_int_equal(tm_read_all(fd, "x", &text, NULL), TM_OK);
    assert_string_equal(text.byte, expected);
    tm_text_free(&text);
    close(fd);
}

static void test_round_trip(void **state)
{
    (void)state;
    tm_stream stream;
    tm_error error = {0};
    if (read_text(&stream, all, sizeof all - 1, &error) != TM_OK)
        fail_msg("%zu: %s: %s", error.line, error.block, error.what);
    assert_int_equal(stream.base, 1);
    assert_int_equal(stream.blocks, 12);
    const tm_block *node = tm_stream_find(&stream, ".node");
    assert_int_equal(node->count, 5);
    assert_int_equal(node->attributes, 2);
    assert_int_equal(node->marker[4], INT32_MIN);
    const tm_block *facet = tm_stream_find(&stream, ".facet");
    assert_int_equal(facet->integer[1], TM_NONE);
    assert_int_equal(facet->start[4], 12);
    assert_int_equal(tm_stream_find(&stream, ".octant")->integer[4], 0);
    assert_int_equal(tm_stream_find(&stream, ".octant")->integer[5], 1);
    assert_null(tm_stream_find(&stream, ".odd"));
    assert_written(&stream, 1, all);
    assert_written(&stream, 3, all);
    tm_stream_free(&stream);
}

/* What may differ in the text and means the same. */
static void test_free_forms(void **state)
{
    (void)state;
    static const char loose[] =
        "termesh 1\n# h\n\n# no history\n  \n.node  \n"
        "  3   3 0 0  \n#c\n0 0 0 0\n\n 1\t+1.0 0e5 000 \n"
        "  2  0 100e-2 -0.0\n.face\n1 1\n0 0 1 2 +4\n.end\n\n# x\n";
    static const char tight[] = "termesh 1\n# h\n.node\n3 3 0 0\n0 0 0 0\n1 1 0 0\n"
                                "2 0 1 -0\n.face\n1 1\n0 0 1 2 4\n.end\n";
    tm_stream stream;
    tm_error error = {0};
    if (read_text(&stream, loose, sizeof loose - 1, &error) != TM_OK)
        fail_msg("%zu: %s: %s", error.line, error.block, error.what);
    assert_int_equal(stream.base, 0);
    assert_written(&stream, 2, tight);
    tm_stream_free(&stream);
    assert_int_equal(read_text(&stream, "termesh 1\n.end", 14, NULL), TM_OK);
    assert_written(&stream, 1, "termesh 1\n.end\n");
    tm_stream_free(&stream);
    static const char short_name[] =
        "termesh 1\n.node\n1 3 0 0\n0 0 0 0\n.x\n1\n0 7\n.end\n";
    assert_int_equal(read_text(&stream, short_name, sizeof short_name - 1, &error),
                     TM_OK);
    assert_written(&stream, 2, short_name);
    tm_stream_free(&stream);
}

/* Every proper beginning of a stream is an error, but for the last line feed. */
static void test_truncated(void **state)
{
    (void)state;
    for (size_t size = 0; size < sizeof all - 2; size++) {
        tm_stream stream;
        tm_error error = {0};
        assert_int_equal(read_text(&stream, all, size, &error), TM_ERROR_INPUT);
        assert_string_equal(error.file, "x.tm");
        assert_true(error.what[0] != '\0');
        assert_int_equal(stream.blocks, 0);
    }
}

typedef struct {
    const char *text;
    size_t line;
    const char *block;
    const char *what;
} wrong;

#define HEAD  "termesh 1\n"
#define NODES HEAD ".node\n2 3 0 1\n1 0 0 0 1\n2 1 0 0 1\n"

static const wrong wrongs[] = {
    {"", 1, "", "looks like an empty file"},
    {"OFF\n1 2 3\n", 1, "",
     "an OFF surface: use tetgen-mesh, octree-mesh or surface-import"},
    {"solid x\n", 1, "", "an STL surface: use tetgen-mesh"},
    {"ply\n", 1, "", "a PLY surface: use tetgen-mesh"},
    {"# blender\nv 1 2 3\n", 1, "", "an OBJ surface: use tetgen-mesh"},
    {"# c\n 5 3 0 0\n", 1, "", "a TetGen .node, .poly or .smesh file: use tetgen-mesh"},
    {"5 4 0\n", 1, "", "a TetGen .ele file: use tetgen-import"},
    {"12 1\n", 1, "", "a TetGen .face or .edge file: use tetgen-import"},
    {"2 1\n1 1 2 3\n", 1, "", "a TetGen .face or .edge file: use tetgen-import"},
    {"12 7\n", 1, "", "looks like a file of numbers"},
    {"2 2\n8\n0 0 0\n", 1, "", "a ViSF mesh: use visf-import"},
    {"$MeshFormat\n", 1, "", "Gmsh"},
    {"MeshVersionFormatted 2\n", 1, "", "Medit"},
    {"\x7f\x45LF\x02\x01", 1, "", "looks like a program: no filter reads it"},
    {"\x01\x02", 1, "", "binary data, perhaps an STL surface: use tetgen-mesh"},
    {"\xEF\xBB\xBFtermesh 1\n.end\n", 1, "", "begins with a byte order mark"},
    {"\xEF\xBB\xBFOFF\n", 1, "", "an OFF surface: use tetgen-mesh"},
    {"\xFF\xFEO", 1, "", "UTF-16 text"},
    {"termesh 2\n.end\n", 1, "", "another version"},
    {"termesh 1 \n.end\n", 1, "", "another version"},
    {"termesh 1\r\n.end\r\n", 1, "", "CR LF"},
    {"hello\n", 1, "", "looks like text"},
    {HEAD ".node\n1 3 0 0\r\n1 0 0 0\n.end\n", 3, ".node", "not 4 whole numbers"},
    {NODES ".ele\r\n0 4 0\n.end\n", 6, "", "not the name of a block"},
    {HEAD ".node\n1 3 0 0\n1 0 0 0\r\n.end\n", 4, ".node", "CR LF"},
    {HEAD ".node\n1 3 0 0\n1 0 0 0 # c\n.end\n", 4, ".node", "line of its own"},
    {HEAD ".node\n-1 3 0 0\n.end\n", 3, ".node", "a count of -1"},
    {HEAD ".node\n99999999999 3 0 0\n.end\n", 3, ".node",
     "a count of 99999999999 (0…4294967294)"},
    {HEAD ".node\n99999999999999999999 3 0 0\n.end\n", 3, ".node", "whole numbers"},
    {HEAD ".node\n1 2 0 0\n1 0 0\n.end\n", 3, ".node", "says 2 (3)"},
    {HEAD ".node\n1 3 0 2\n1 0 0 0 0\n.end\n", 3, ".node", "says 2 for markers"},
    {HEAD ".node\n1 3 1001 0\n.end\n", 3, ".node", "1001 attributes"},
    {HEAD ".node\n1 3 0\n1 0 0 0\n.end\n", 3, ".node", "not 4 whole"},
    {HEAD ".node\n1 3 0 0 0\n1 0 0 0\n.end\n", 3, ".node", "after the header"},
    {HEAD ".node\n2 3 0 0\n1 0 0 0\n.end\n", 5, ".node", "row 2 of 2 is missing"},
    {HEAD ".node\n1 3 0 0\n1 0 0 0\n2 1 0 0\n.end\n", 5, ".node", "more rows than the 1"},
    {HEAD ".node\n1 3 0 0\n2 0 0 0\n.end\n", 4, ".node", "'2 0 0 0' (0 or 1)"},
    {HEAD ".node\n2 3 0 0\n1 0 0 0\n3 0 0 0\n.end\n", 5, ".node", "is numbered 3"},
    {HEAD ".node\n1 3 0 0\n1 0 nan 0\n.end\n", 4, ".node", "'nan' is not a finite"},
    {HEAD ".node\n1 3 0 0\n1 0 -inf 0\n.end\n", 4, ".node", "'-inf' is not a finite"},
    {HEAD ".node\n1 3 0 0\n1 0 1e999 0\n.end\n", 4, ".node", "too large"},
    {HEAD ".node\n1 3 0 0\n1 0 0,5 0\n.end\n", 4, ".node", "'0,5' is not a finite"},
    {HEAD ".node\n1 3 0 0\n1 0 0\n.end\n", 4, ".node", "row 1 ends before"},
    {HEAD ".node\n1 3 0 0\n1 0 0 0 9\n.end\n", 4, ".node", "'9' after the last"},
    {HEAD ".node\n1 3 0 1\n1 0 0 0 1.5\n.end\n", 4, ".node", "'1.5' is not a marker"},
    {HEAD ".node\n1 3 0 1\n1 0 0 0 3000000000\n.end\n", 4, ".node", "32 bits"},
    {NODES ".face\n1 1\n1 1 2 3 0\n.end\n", 8, ".face", "node 3 is out of range (1..2)"},
    {NODES ".face\n1 1\n1 1 2 0 0\n.end\n", 8, ".face", "node 0 is out of range (1..2)"},
    {NODES ".face\n1 1\n1 1 2 -1 0\n.end\n", 8, ".face", "out of range (1..2)"},
    {NODES ".edge\n1 0\n1 1 4294967297\n.end\n", 8, ".edge", "out of range"},
    {NODES ".ele\n1 4 0\n1 1 2 3 1\n.end\n", 8, ".ele", "node 3 is out of range (1..2)"},
    {NODES ".ele\n1 4 0\n1 1 2 1 0\n.end\n", 8, ".ele", "node 0 is out of range (1..2)"},
    {NODES ".ele\n1 4 0\n1 1 2 1\n.end\n", 8, ".ele", "row 1 ends before"},
    {NODES ".ele\n1 4 0\n1 1 2 1 2 1\n.end\n", 8, ".ele", "'1' after the last"},
    {NODES ".ele\n1 4 0\n1 1 2 100000001 2\n.end\n", 8, ".ele", "out of range"},
    {NODES ".ele\n1 4 0\n1 1 2 99999999 2\n.end\n", 8, ".ele", "out of range"},
    {NODES ".ele\n1 4 0\n1 1 2 x 2\n.end\n", 8, ".ele", "'x' is not a node number"},
    {NODES ".ele\n1 4 0\n2 1 2 1 2\n.end\n", 8, ".ele", "is numbered 2"},
    {HEAD ".face\n0 0\n.end\n", 2, ".face", "comes before .node"},
    {NODES "a.face\n0 0\n.end\n", 6, "a.face", "comes before a.node"},
    {NODES ".node\n0 3 0 0\n.end\n", 6, ".node", "second block of that name"},
    {NODES "garbage here\n.end\n", 6, "", "'garbage here' is not the name"},
    {NODES ".end\n.more\n", 7, ".end", "'.more' follows"},
    {NODES ".end\n7\n", 7, ".end", "'7' follows"},
    {NODES ".mix\n1 0\n1 7 1 1 1 1 1 1 1\n.end\n", 8, ".mix", "element of 7 nodes"},
    {NODES ".mix\n1 0\n1 4 1 1 1\n.end\n", 8, ".mix", "ends before"},
    {NODES ".facet\n1 0\n1 1 -1 2 1 2\n.end\n", 8, ".facet", "a list of 2"},
    {NODES ".facet\n1 0\n1 -1 1 3 1 2 1\n.end\n", 8, ".facet", "-1 is out of range"},
    {NODES ".cell\n1 0\n1 4 1 1 1 1\n.end\n", 0, ".cell", "facet 1 is out of range"},
    {NODES ".facet\n1 0\n1 2 -1 3 1 2 1\n.cell\n1 0\n1 4 1 1 1 1\n.end\n", 0, ".facet",
     "cell 2 is out of range"},
    {NODES ".facet\n1 0\n1 2 -1 3 1 2 1\n.mix\n1 0\n1 4 1 1 1 1\n.end\n", 0, ".facet",
     "element 2 is out of range"},
    {NODES ".mix\n1 0\n1 4 1 1 1 1\n.facet\n1 0\n1 1 2 3 1 2 1\n.end\n", 0, ".facet",
     "element 2 is out of range"},
    {NODES ".octant\n1 0\n1 0 0 0 0 1 2\n.end\n", 0, ".octant", "(of 0 in .mix)"},
};

static void test_wrong(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrongs / sizeof wrongs[0]; i++) {
        const wrong *w = &wrongs[i];
        tm_stream stream;
        tm_error error = {0};
        tm_status status = read_text(&stream, w->text, strlen(w->text), &error);
        if (status != TM_ERROR_INPUT || error.line != w->line ||
            strcmp(error.block, w->block) != 0 || !strstr(error.what, w->what) ||
            strcmp(error.file, "x.tm") != 0)
            fail_msg("'%s': %d %s:%zu: %s: %s", w->text, status, error.file, error.line,
                     error.block, error.what);
        assert_int_equal(stream.blocks, 0);
    }
}

/* Random changes of a good stream are read or refused, never more. */
static void test_mutations(void **state)
{
    (void)state;
    enum { TIMES = 20000 };
    static const char bytes[] = "0123456789-+.eE# \t\n\r,xn";
    char text[sizeof all];
    size_t good = 0;
    for (int k = 0; k < TIMES; k++) {
        memcpy(text, all, sizeof all);
        for (unsigned n = 1 + random_below(3); n > 0; n--)
            text[random_below(sizeof all - 1)] = bytes[random_below(sizeof bytes - 1)];
        tm_stream stream;
        tm_error error = {0};
        tm_status status = read_text(&stream, text, sizeof all - 1, &error);
        assert_true(status == TM_OK || status == TM_ERROR_INPUT);
        good += status == TM_OK;
        tm_stream_free(&stream);
    }
    assert_true(good > 0 && good < TIMES);
}

/* A file of 40 bytes that claims four thousand million nodes costs next to nothing. */
static void test_claims(void **state)
{
    (void)state;
    static const char claims[] = HEAD ".node\n4000000000 3 1000 1\n1 0 0 0\n";
    const long most = 2048; /* kilobytes */
    struct rusage before, after;
    tm_stream stream;
    tm_error error = {0};
    getrusage(RUSAGE_SELF, &before);
    assert_int_equal(read_text(&stream, claims, sizeof claims - 1, &error),
                     TM_ERROR_INPUT);
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < most);
}

/* Many rows, several chunks of the writer, any number of threads. */
static void test_large(void **state)
{
    (void)state;
    enum { ROWS = 20000 };
    tm_text text = {0};
    tm_text_format(&text, HEAD ".node\n%d 3 0 0\n", ROWS);
    for (int i = 0; i < ROWS; i++) {
        tm_text_format(&text, "%d ", i);
        tm_text_double(&text, random_unit());
        tm_text_string(&text, " ");
        tm_text_double(&text, random_unit() * 1e-20);
        tm_text_string(&text, " ");
        tm_text_double(&text, (double)random_below(1000));
        tm_text_string(&text, "\n");
    }
    tm_text_format(&text, ".ele\n%d 4 0\n", ROWS);
    for (int i = 0; i < ROWS; i++)
        tm_text_format(&text, "%d %u %u %u %u\n", i, random_below(ROWS),
                       random_below(ROWS), random_below(ROWS), random_below(ROWS));
    tm_text_string(&text, ".end\n");
    tm_stream stream;
    tm_error error = {0};
    if (read_text(&stream, text.byte, text.size, &error) != TM_OK)
        fail_msg("%zu: %s", error.line, error.what);
    for (unsigned threads = 1; threads <= 5; threads++)
        assert_written(&stream, threads, text.byte);
    tm_stream_free(&stream);
    tm_text_free(&text);
}

/* Pieces of any size from a pipe are one stream. */
static void test_pipe(void **state)
{
    (void)state;
    int end[2];
    assert_int_equal(pipe(end), 0);
    pid_t child = fork();
    if (child == 0) {
        for (size_t at = 0; at < sizeof all - 1;) {
            size_t size = 1 + random_below(7);
            if (size > sizeof all - 1 - at)
                size = sizeof all - 1 - at;
            (void)!write(end[1], all + at, size);
            at += size;
        }
        _exit(0);
    }
    close(end[1]);
    tm_stream stream;
    tm_stream_init(&stream);
    assert_int_equal(tm_stream_read(&stream, end[0], "<stdin>", 1, NULL), TM_OK);
    assert_written(&stream, 1, all);
    tm_stream_free(&stream);
    close(end[0]);
    waitpid(child, NULL, 0);
}

static void test_write_errors(void **state)
{
    (void)state;
    tm_stream stream;
    tm_error error = {0};
    assert_int_equal(read_text(&stream, all, sizeof all - 1, &error), TM_OK);
    assert_int_equal(tm_stream_write(&stream, -1, 1, &error), TM_ERROR_SYSTEM);
    assert_non_null(strstr(error.what, "cannot write"));
    tm_stream_free(&stream);
    assert_int_equal(tm_stream_read(&stream, -1, "x", 1, &error), TM_ERROR_SYSTEM);
    assert_non_null(strstr(error.what, "cannot read"));
}

static void test_edit(void **state)
{
    (void)state;
    tm_stream stream;
    assert_int_equal(read_text(&stream, NODES ".end\n", sizeof NODES + 4, NULL), TM_OK);
    assert_int_equal(tm_stream_add_history(&stream, "one\nline", NULL), TM_OK);
    tm_block *cell = tm_stream_add(&stream, ".cell");
    assert_int_equal(cell->kind, TM_CELL);
    assert_int_equal(tm_block_allocate(cell, 1, 4, NULL), TM_OK);
    cell->start[1] = 4;
    tm_stream_remove(&stream, tm_stream_find(&stream, ".node"));
    assert_written(&stream, 1, HEAD "# one line\n.cell\n1 0\n1 4 1 1 1 1\n.end\n");
    tm_stream_free(&stream);
}

static bool is_cell(const tm_block *block, const void *context)
{
    (void)context;
    return block->kind == TM_CELL;
}

/* Very many blocks: the time for each does not grow with their number, which would make
 * this test one of minutes. */
static void test_many_blocks(void **state)
{
    (void)state;
    enum { BLOCKS = 150000 };
    tm_text text = {0};
    tm_text_string(&text, NODES);
    for (int b = 0; b < BLOCKS; b++)
        tm_text_format(&text, "p%d.node\n0 3 0 0\np%d.cell\n0 0\n", b, b);
    const size_t size = text.size;
    tm_text_string(&text, ".end\n");
    tm_stream stream;
    tm_error error = {0};
    int fd = file_of(text.byte, text.size);
    tm_stream_init(&stream);
    assert_int_equal(tm_stream_read(&stream, fd, "many", 1, &error), TM_OK);
    close(fd);
    assert_int_equal(stream.blocks, 1 + 2 * BLOCKS);
    assert_string_equal(stream.block[2 * BLOCKS].name, "p149999.cell");
    tm_stream_remove_if(&stream, is_cell, NULL);
    assert_int_equal(stream.blocks, 1 + BLOCKS);
    assert_string_equal(stream.block[BLOCKS].name, "p149999.node");
    assert_non_null(tm_stream_add(&stream, ".face"));
    tm_stream_free(&stream);
    text.size = size;
    tm_text_string(&text, "p77777.cell\n0 0\n.end\n");
    fd = file_of(text.byte, text.size);
    assert_int_equal(tm_stream_read(&stream, fd, "many", 1, &error), TM_ERROR_INPUT);
    close(fd);
    assert_string_equal(error.block, "p77777.cell");
    assert_string_equal(error.what, "a second block of that name");
    tm_text_free(&text);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_claims),       cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_free_forms),   cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_wrong),        cmocka_unit_test(test_mutations),
        cmocka_unit_test(test_large),        cmocka_unit_test(test_pipe),
        cmocka_unit_test(test_write_errors), cmocka_unit_test(test_edit),
        cmocka_unit_test(test_many_blocks)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
