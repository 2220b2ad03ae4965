/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts in files are claims: whichever number of a small file is made a billion, it is
 * read or refused in little memory. */
#include "format_samples.h"
#include "reader_samples.h"

#include <ctype.h>
#include <sys/resource.h>

static const char claim[] = "1000000000";

static void check(reader *read, const char *name, const char *bytes, size_t size)
{
    tm_text meaning = {0};
    const tm_status status = read_copy(read, bytes, size, &meaning);
    if (status != TM_OK && status != TM_ERROR_INPUT)
        fail_msg("%s: status %d for:\n%.*s", name, status, (int)size, bytes);
    tm_text_free(&meaning);
}

/* Each number that has no fraction, and each of two neighbours. */
static void test_numbers_of_text(void **state)
{
    (void)state;
    for (size_t i = 0; i < READER_SAMPLES; i++) {
        char bytes[READER_SAMPLE_MAX], claimed[READER_SAMPLE_MAX + sizeof claim];
        bool unseen[READER_SAMPLE_MAX];
        const size_t size = take_braces(reader_samples[i].text, bytes, unseen);
        for (size_t begin = 0, end; begin < size; begin = end + 1) {
            for (end = begin; end < size && isdigit((unsigned char)bytes[end]);)
                end++;
            if (end == begin)
                continue;
            memcpy(claimed, bytes, begin);
            memcpy(claimed + begin, claim, strlen(claim));
            memcpy(claimed + begin + strlen(claim), bytes + end, size - end);
            check(reader_samples[i].read, reader_samples[i].name, claimed,
                  begin + strlen(claim) + size - end);
        }
    }
}

/* Attributes of no rows at all, and a wrong number of them. */
static void test_attributes_of_nothing(void **state)
{
    (void)state;
    static const char *const files[] = {"0 3 1000000000 0\n", "0 3 2147483647 1\n",
                                        "1 3 -7 0\n1 0 0 0\n"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        tm_text meaning = {0};
        assert_int_equal(read_copy(read_node, files[i], strlen(files[i]), &meaning),
                         TM_ERROR_INPUT);
        tm_text_free(&meaning);
    }
}

/* At each byte, as a 32-bit number of both byte orders. */
static void check_binary(reader *read, const char *name, const char *bytes, size_t size)
{
    char *claimed = malloc(size);
    assert_non_null(claimed);
    for (size_t at = 0; at + 4 <= size; at++)
        for (int big = 0; big < 2; big++) {
            memcpy(claimed, bytes, size);
            memcpy(claimed + at, big ? "\x3b\x9a\xca\x00" : "\x00\xca\x9a\x3b", 4);
            check(read, name, claimed, size);
        }
    free(claimed);
}

static void test_words_of_binary(void **state)
{
    static const char text[] = "2 2\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4\n3 0 2 1\n"
                               "3 0 1 3\n3 0 3 2\n3 1 2 3\n0\n1\n4 0 1 2 3\n";
    static const tm_visf_options forms[] = {{TM_VISF_LITTLE, true, false},
                                            {TM_VISF_BIG, false, true}};
    (void)state;
    sample samples[SAMPLES];
    make_samples(samples);
    check_binary(read_stl, "STL", stl_binary.bytes, stl_binary.size);
    check_binary(read_ply, "PLY, little", ply_little.bytes, ply_little.size);
    check_binary(read_ply, "PLY, big", ply_big.bytes, ply_big.size);
    for (size_t f = 0; f < sizeof forms / sizeof *forms; f++) {
        tm_stream stream;
        tm_polyhedra_repairs repairs;
        tm_error error;
        tm_text visf = {0};
        tm_stream_init(&stream);
        assert_int_equal(
            tm_visf_read(&stream, text, sizeof text - 1, "file", &repairs, &error),
            TM_OK);
        assert_int_equal(tm_visf_write(&visf, &stream, &forms[f], &error), TM_OK);
        tm_stream_free(&stream);
        check_binary(read_visf, "ViSF", visf.byte, visf.size);
        tm_text_free(&visf);
    }
}

/* Far less than a billion of anything; the sanitizers need more address space. */
static void limit_memory(void)
{
#if !defined(__SANITIZE_ADDRESS__)
    const struct rlimit limit = {.rlim_cur = 300 << 20, .rlim_max = RLIM_INFINITY};
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers_of_text),
        cmocka_unit_test(test_attributes_of_nothing),
        cmocka_unit_test(test_words_of_binary),
    };
    limit_memory();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
