/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A stream that several threads read is what one reads, and so is what is wrong in it. */
#include "../../lib/stream/stream.h"

#include "../../lib/text/file.h"
#include "random.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

enum { NODES = 9000, ROWS = 80000, ROOM = 200 };

static size_t below(size_t n)
{
    return random_below((unsigned)n);
}

static void add_nodes(tm_text *text)
{
    tm_text_format(text, "termesh 1\n.node\n%d 3 1 1\n", NODES);
    for (int i = 0; i < NODES; i++)
        tm_text_format(text, "%d %.17g %d.5 %g %zu %d\n", i,
                       (double)below(1u << 30) / 3e7, i, 1e-9 * (double)i, below(100),
                       (int)below(1000) - 500);
}

/* Rows of `k` nodes, or of lists of them where k is 0, in the form that the writer has or
 * with a blank more here and there. */
static void add_rows(tm_text *text, const char *header, size_t k)
{
    tm_text_format(text, "%s\n", header);
    for (int i = 0; i < ROWS; i++) {
        static const size_t of_element[] = {4, 5, 6, 8};
        const size_t nodes = k > 0 ? k : of_element[below(4)];
        tm_text_format(text, "%d", i);
        if (k == 0)
            tm_text_format(text, " %zu", nodes);
        for (size_t n = 0; n < nodes; n++)
            tm_text_format(text, "%s%zu", below(500) == 0 ? "  " : " ", below(NODES));
        tm_text_format(text, " %zu\n", below(9));
    }
}

/* Polyhedra of four facets, whose lists are longer and shorter. */
static void add_polyhedra(tm_text *text)
{
    tm_text_format(text, ".facet\n%d 1\n", ROWS);
    for (int i = 0; i < ROWS; i++) {
        const size_t nodes = 3 + below(below(50) == 0 ? 60 : 4);
        tm_text_format(text, "%d %d -1 %zu", i, i / 4, nodes);
        for (size_t n = 0; n < nodes; n++)
            tm_text_format(text, " %zu", below(NODES));
        tm_text_format(text, " %d\n", (int)below(3) - 1);
    }
    tm_text_format(text, ".cell\n%d 2\n", ROWS / 4);
    for (int i = 0; i < ROWS / 4; i++)
        tm_text_format(text, "%d 4 %d %d %d %d 1 %zu\n", i, 4 * i, 4 * i + 1, 4 * i + 2,
                       4 * i + 3, below(5));
}

static void make_text(tm_text *text)
{
    add_nodes(text);
    add_rows(text, ".ele\n80000 4 1", 4);
    add_rows(text, ".face\n80000 1", 3);
    add_rows(text, ".mix\n80000 1", 0);
    add_polyhedra(text);
    tm_text_string(text, ".end\n");
    assert_false(text->failed);
}

/* The begin of a line somewhere. */
static size_t some_line(const tm_text *text)
{
    const char *at = text->byte + below(text->size - 1);
    return (size_t)((const char *)memchr(at, '\n', text->size) + 1 - text->byte);
}

static void insert(tm_text *text, size_t at, const char *what)
{
    const size_t size = strlen(what);
    memmove(text->byte + at + size, text->byte + at, text->size - at);
    memcpy(text->byte + at, what, size);
    text->size += size;
}

/* Comments and blank lines, and damage: other bytes, an end too early, a row twice. */
static void change(tm_text *text)
{
    static const char *const harmless[] = {"# a comment\n", "\n", "  \t\n"};
    for (size_t n = below(4); n > 0; n--)
        insert(text, some_line(text), harmless[below(3)]);
    const size_t kind = below(6), at = some_line(text);
    if (kind == 0)
        text->size = below(text->size);
    if (kind == 1)
        text->byte[below(text->size)] = (char)(' ' + below(96));
    if (kind == 2)
        text->byte[at - 1] = ' ';
    if (kind == 3)
        insert(text, at, "17 1 2 3 4 5\n");
}

/* The text behind a descriptor: of a file, or of a pipe that another process fills. */
static int open_text(const tm_text *text, bool piped, pid_t *child)
{
    int end[2];
    *child = 0;
    if (!piped) {
        const int fd = memfd_create("stream", 0);
        assert_int_equal(tm_write_all(fd, text->byte, text->size, NULL), TM_OK);
        assert_int_equal(lseek(fd, 0, SEEK_SET), 0);
        return fd;
    }
    assert_int_equal(pipe(end), 0);
    *child = fork();
    if (*child == 0) {
        close(end[0]);
        _exit(tm_write_all(end[1], text->byte, text->size, NULL) != TM_OK);
    }
    close(end[1]);
    return end[0];
}

/* What comes of a text: the stream as it is written, or what is wrong. */
static void read_text(const tm_text *text, unsigned threads, bool piped, tm_text *result)
{
    pid_t child;
    tm_stream stream;
    tm_error error = {0};
    const int fd = open_text(text, piped, &child);
    tm_stream_init(&stream);
    result->size = 0;
    if (tm_stream_read(&stream, fd, "x", threads, &error) != TM_OK) {
        tm_text_format(result, "%d %zu %s: %s", (int)error.status, error.line,
                       error.block, error.what);
        assert_int_equal(stream.blocks, 0);
    } else {
        const int out = memfd_create("out", 0);
        assert_int_equal(tm_stream_write(&stream, out, 1, NULL), TM_OK);
        assert_int_equal(lseek(out, 0, SEEK_SET), 0);
        assert_int_equal(tm_read_all(out, "out", result, NULL), TM_OK);
        close(out);
    }
    tm_stream_free(&stream);
    close(fd);
    if (child)
        waitpid(child, NULL, 0);
}

static void assert_same_for_threads(const tm_text *text)
{
    tm_text one = {0}, several = {0};
    read_text(text, 1, false, &one);
    for (unsigned threads = 2; threads <= 8; threads += 3) {
        read_text(text, threads, below(2) == 0, &several);
        assert_int_equal(one.size, several.size);
        assert_memory_equal(one.byte, several.byte, one.size);
    }
    tm_text_free(&one);
    tm_text_free(&several);
}

static void test_whole(void **state)
{
    (void)state;
    tm_text text = {0}, read = {0};
    make_text(&text);
    assert_same_for_threads(&text);
    read_text(&text, 3, false, &read);
    assert_memory_equal(read.byte, "termesh 1\n", 10);
    tm_text_free(&read);
    tm_text_free(&text);
}

static void test_changed(void **state)
{
    (void)state;
    tm_text text = {0}, changed = {0};
    make_text(&text);
    for (int n = 0; n < 40; n++) {
        changed.size = 0;
        tm_text_append(&changed, text.byte, text.size);
        tm_text_append(&changed, text.byte, ROOM); /* for what is put in */
        changed.size -= ROOM;
        change(&changed);
        assert_same_for_threads(&changed);
    }
    tm_text_free(&changed);
    tm_text_free(&text);
}

/* More rows than the header says, and fewer, by many. */
static void test_counts(void **state)
{
    (void)state;
    static const char *const header[] = {".ele\n80000 4 1", ".ele\n70000 4 1",
                                         ".ele\n90000 4 1", ".ele\n3 4 1",
                                         ".ele\n4294967294 4 1"};
    for (size_t h = 0; h < sizeof header / sizeof *header; h++) {
        tm_text text = {0};
        add_nodes(&text);
        add_rows(&text, header[h], 4);
        tm_text_string(&text, ".end\n");
        assert_same_for_threads(&text);
        tm_text_free(&text);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_whole),
                                       cmocka_unit_test(test_changed),
                                       cmocka_unit_test(test_counts)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
