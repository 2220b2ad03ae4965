/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What long operations say of where they are, and the line that a filter draws of it. */
#include "../../cmd/common/app/progress.h"
#include "../../lib/poly/partition.h"
#include "../../lib/tet/improve/improve.h"
#include "../../lib/tet/lepp/lepp.h"
#include "tet_fixture.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

/* The line ------------------------------------------------------------------------- */

static void assert_line(const tm_progress_at *at, double seconds, size_t columns,
                        const char *right)
{
    char line[PROGRESS_LINE];
    progress_line(line, "filter", at, seconds, columns);
    assert_string_equal(line, right);
}

static void test_line(void **state)
{
    (void)state;
    const tm_progress_at stage = {.what = "sorting"};
    assert_line(&stage, 0.9, 80, "filter: sorting, 0 s");
    assert_line(&stage, 59.9, 80, "filter: sorting, 59 s");
    assert_line(&stage, 65, 80, "filter: sorting, 1:05");
    assert_line(&stage, 3605, 80, "filter: sorting, 1:00:05");
    const tm_progress_at share = {.what = "writing", .done = 999, .of = 1000};
    assert_line(&share, 1, 80, "filter: writing, 100 %, 1 s");
    const tm_progress_at grown = {.what = "reading", .done = 9, .of = 4, .bytes = true};
    assert_line(&grown, 1, 80, "filter: reading, 100 %, 1 s");
    const tm_progress_at pipe = {.what = "reading", .done = 1234567890, .bytes = true};
    assert_line(&pipe, 1, 80, "filter: reading, 1 234 567 kB, 1 s");
    const tm_progress_at steps = {.what = "trying", .done = 1000};
    assert_line(&steps, 1, 80, "filter: trying, 1 000, 1 s");
    const tm_progress_at other = {.what = "TetGen", .doing = "Refining mesh"};
    assert_line(&other, 1, 80, "filter: TetGen: Refining mesh, 1 s");
    const tm_progress_at pass = {.what = "improving",
                                 .pass = 7,
                                 .done = 1,
                                 .of = 4,
                                 .bad = 1240,
                                 .all_bad = 65300};
    assert_line(&pass, 12, 80,
                "filter: improving, pass 7: 1 240 of 65 300 bad left, 25 %, 12 s");
    /* It never reaches the last column; one that is wider than all is cut as well. */
    assert_line(&pass, 12, 20, "filter: improving, ");
    assert_line(&pass, 12, 1, "");
    char words[2 * PROGRESS_LINE], line[PROGRESS_LINE];
    memset(words, 'x', sizeof words);
    words[sizeof words - 1] = '\0';
    const tm_progress_at wide = {.what = words};
    progress_line(line, "filter", &wide, 1, 0);
    assert_int_equal(strlen(line), PROGRESS_LINE - 1);
}

static void test_stage_line(void **state)
{
    (void)state;
    char line[PROGRESS_LINE];
    const progress_clock from = {1, 0.5, 0}, to = {3.25, 1, 0};
    progress_stage_line(line, "filter", "sorting", &from, &to, 3 * 512);
    assert_string_equal(line, "filter: sorting: 2.25 s, 0.50 s of CPU, 1.5 MB at most\n");
    const progress_clock sent = {2, 1, 250000}, more = {3, 2, 1500000};
    progress_stage_line(line, "filter", "dealing", &sent, &more, 1024);
    assert_string_equal(
        line, "filter: dealing: 1.00 s, 1.00 s of CPU, 1.0 MB at most, 1.2 MB sent\n");
}

/* What has been drawn since the last time. */
static void assert_drawn(int fd, const char *right)
{
    char text[4 * PROGRESS_LINE];
    const ptrdiff_t size = read(fd, text, sizeof text - 1);
    text[size < 0 ? 0 : size] = '\0';
    assert_string_equal(text, right);
}

static void test_drawing(void **state)
{
    (void)state;
    int ends[2];
    progress p;
    assert_int_equal(pipe2(ends, O_NONBLOCK), 0);
    progress_start(&p, "filter", true, true); /* quiet: without the thread */
    p.fd = ends[1];
    const tm_progress *told = progress_context(&p);
    assert_non_null(told);
    progress_draw(&p, 1);
    assert_drawn(ends[0], "");
    tm_progress_at at = {.what = "reading", .bytes = true};
    tm_progress_tell(told, &at);
    progress_draw(&p, 2); /* nothing has come yet: another program works */
    assert_drawn(ends[0], "");
    at.done = 5000;
    tm_progress_tell(told, &at);
    progress_draw(&p, 3);
    assert_drawn(ends[0], "\rfilter: reading, 5 kB, 3 s\033[K");
    progress_hold(&p);
    assert_drawn(ends[0], "\r\033[K");
    progress_release(&p);
    progress_hold(&p); /* there is nothing to erase */
    progress_release(&p);
    assert_drawn(ends[0], "");
    p.verbose = false;
    tm_progress_stage(told, "sorting");
    progress_draw(&p, 4);
    assert_drawn(ends[0], "\rfilter: sorting, 4 s\033[K");
    progress_end(&p);
    assert_drawn(ends[0], "\r\033[K");
    progress_draw(&p, 5);
    assert_drawn(ends[0], "");
    assert_null(progress_context(&p));
    close(ends[0]);
    close(ends[1]);
}

static void test_stages(void **state)
{
    (void)state;
    int ends[2];
    char text[PROGRESS_LINE];
    progress p;
    assert_int_equal(pipe2(ends, O_NONBLOCK), 0);
    progress_start(&p, "filter", true, true);
    p.fd = ends[1];
    tm_progress_stage(&p.to, "one");
    tm_progress_at at = {.what = "two"};
    for (at.pass = 1; at.pass < 4; at.pass++)
        tm_progress_tell(&p.to, &at);
    progress_end(&p);
    progress_end(&p); /* as where a filter fails at its end */
    const ptrdiff_t size = read(ends[0], text, sizeof text - 1);
    assert_true(size > 0);
    text[size] = '\0';
    assert_memory_equal(text, "filter: one: ", 13);
    const char *second = strchr(text, '\n') + 1;
    assert_memory_equal(second, "filter: two: ", 13);
    assert_string_equal(strchr(second, '\n'), "\n");
    close(ends[0]);
    close(ends[1]);
}

/* What is said --------------------------------------------------------------------- */

typedef struct {
    size_t times, stages, passes;
    tm_progress_at last;
} record;

static void listen_to(void *context, const tm_progress_at *at)
{
    record *r = context;
    const bool same = r->last.what && strcmp(r->last.what, at->what) == 0;
    assert_true(at->done <= at->of || at->of == 0);
    assert_true(at->bad <= at->all_bad || at->all_bad == 0);
    assert_true(!same || at->pass >= r->last.pass);
    assert_true(!same || at->pass > r->last.pass || at->done >= r->last.done);
    r->times++;
    r->stages += !same;
    r->passes = at->pass;
    r->last = *at;
}

static void test_improvement(void **state)
{
    (void)state;
    for (int k = 0; k < 16; k++) {
        const uint64_t seed = random_bits();
        size_t tets[2];
        for (int told = 0; told < 2; told++) {
            tm_stream stream;
            tm_tet_mesh mesh;
            record r = {0};
            const tm_progress teller = {listen_to, &r};
            random_state = seed;
            make_mesh(&mesh, &stream, 4, 0.8, false);
            if (k % 2) {
                const tm_improve_options o = {.angle = 30,
                                              .ops = TM_IMPROVE_ALL_OPS,
                                              .progress = told ? &teller : NULL};
                tm_improve_report report;
                assert_int_equal(tm_improve(&mesh, &o, &report, NULL), TM_OK);
                assert_true(!told || r.passes <= report.passes);
            } else {
                const tm_lepp_options o = {.algorithm = TM_LEPP_SELECTIVE,
                                           .stop = TM_LEPP_CONVERGED,
                                           .factor = 1.1,
                                           .angle = 30,
                                           .sweeps = random_below(4),
                                           .progress = told ? &teller : NULL};
                tm_lepp_report report;
                assert_int_equal(tm_lepp_improve(&mesh, &o, &report, NULL), TM_OK);
                assert_true(!told || r.passes <= report.passes);
            }
            assert_true(!told || r.times > 1);
            tets[told] = mesh.tets;
            tm_tet_mesh_free(&mesh);
            tm_stream_free(&stream);
        }
        assert_int_equal(tets[0], tets[1]);
    }
}

static void test_partition(void **state)
{
    (void)state;
    tm_stream stream;
    tm_tet_mesh mesh;
    record r = {0};
    const tm_progress teller = {listen_to, &r};
    make_mesh(&mesh, &stream, 4, 0.8, false);
    const tm_poly_options o = {.repair = true, .absorb = true, .progress = &teller};
    tm_poly_report report;
    tm_partition partition;
    assert_int_equal(tm_partition_make(&partition, &mesh, &o, &report, NULL), TM_OK);
    assert_int_equal(r.stages, 3);
    tm_partition_free(&partition);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
}

static void test_within(void **state)
{
    (void)state;
    record r = {0};
    const tm_progress outer = {listen_to, &r};
    tm_progress_within within;
    const tm_progress *inner = tm_progress_begin_within(&within, &outer, "whole");
    tm_progress_at at = {.what = "part", .pass = 2, .of = 1000};
    for (size_t i = 0; i < at.of; i++)
        tm_progress_step(inner, &at, i);
    assert_int_equal(r.stages, 1);
    assert_int_equal(r.times, 1 + 16); /* each 64th step */
    assert_string_equal(r.last.what, "whole");
    assert_string_equal(r.last.doing, "part");
    assert_int_equal(r.last.pass, 2);
    assert_null(tm_progress_begin_within(&within, NULL, "whole"));
    tm_progress_step(NULL, &at, 0);
}

/* All rows are written and all bytes are read. */
static void test_stream(void **state)
{
    (void)state;
    record written = {0}, read = {0};
    const tm_progress writes = {listen_to, &written}, reads = {listen_to, &read};
    tm_stream stream;
    make_grid(&stream, 4, 0.5, false);
    size_t rows = 0;
    for (size_t b = 0; b < stream.blocks; b++)
        rows += stream.block[b].count;
    FILE *file = tmpfile();
    assert_non_null(file);
    const int fd = fileno(file);
    stream.progress = &writes;
    assert_int_equal(tm_stream_write(&stream, fd, 2, NULL), TM_OK);
    assert_int_equal(written.last.of, rows);
    assert_int_equal(written.stages, 1);
    tm_stream_free(&stream);
    const off_t size = lseek(fd, 0, SEEK_CUR);
    lseek(fd, 0, SEEK_SET);
    stream.progress = &reads;
    assert_int_equal(tm_stream_read(&stream, fd, "file", 1, NULL), TM_OK);
    assert_true(read.last.bytes);
    assert_int_equal(read.last.done, size);
    assert_int_equal(read.last.of, size);
    tm_stream_free(&stream);
    fclose(file);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_line),        cmocka_unit_test(test_stage_line),
        cmocka_unit_test(test_drawing),     cmocka_unit_test(test_stages),
        cmocka_unit_test(test_improvement), cmocka_unit_test(test_partition),
        cmocka_unit_test(test_within),      cmocka_unit_test(test_stream),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
