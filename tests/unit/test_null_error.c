/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whoever wants no tm_error gives NULL. Damaged files and streams once more, with NULL
 * for each function that takes one: null_error.h, which null_error.py makes of all
 * headers, has a macro for each. The headers come before it, and so are not changed. */
#include "../../lib/mesh/cell_faces.h"
#include "../../lib/format/mesh_format.h"
#include "../../lib/format/openfoam/openfoam.h"
#include "../../lib/format/oct.h"
#include "../../lib/surface/polygon_surface.h"
#include "../../lib/format/tetgen.h"
#include "../../lib/format/visf.h"
#include "../../lib/examine/element_examine.h"
#include "../../lib/examine/poly/poly_examine.h"
#include "../../lib/examine/poly/poly_statistics.h"
#include "../../lib/surface/surface.h"
#include "../../lib/tet/improve/improve.h"
#include "../../lib/tet/lepp/lepp.h"
#include "../fuzz/damage.h"
#include "format_samples.h"
#include "random.h"

#include "null_error.h"

#define main main_of_files
#include "test_format_fuzz.c" /* NOLINT(bugprone-suspicious-include) */
#undef main
#define main main_of_streams
#include "../fuzz/fuzz.c" /* NOLINT(bugprone-suspicious-include) */
#undef main

static void test_streams(void **state)
{
    (void)state;
    enum { STREAMS = 300 };
    const uint64_t seed = random_state;
    for (uint64_t i = 0; i < STREAMS; i++) {
        tm_text text = {0};
        make_damaged(&text, seed, i);
        check_bytes(text.byte, text.size);
        tm_text_free(&text);
    }
}

/* The surfaces of damaged files. */
static void test_surfaces(void **state)
{
    (void)state;
    size_t wrong = 0;
    for (int s = 0; s < SAMPLES; s++)
        for (int i = 0; i < CHANGED / 10; i++) {
            char changed[BINARY_MAX];
            tm_polygon_surface polygons;
            tm_surface surface;
            tm_stream stream;
            memcpy(changed, samples[s].bytes, samples[s].size);
            change(changed, samples[s].size);
            tm_stream_init(&stream);
            tm_polygon_surface_init(&polygons);
            if (tm_format_read(&polygons, samples[s].format, changed, samples[s].size,
                               "file", NULL) == TM_OK) {
                assert_int_equal(
                    tm_polygon_surface_to_stream(&polygons, &stream, "surface", NULL),
                    TM_OK);
                wrong += tm_surface_build(&surface, &polygons, &(tm_surface_options){0},
                                          NULL) != TM_OK;
                tm_surface_free(&surface);
            }
            tm_polygon_surface_free(&polygons);
            tm_stream_free(&stream);
        }
    assert_true(wrong > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_beginning),
        cmocka_unit_test(test_wrong_reader),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_visf),
        cmocka_unit_test(test_m3d),
        cmocka_unit_test(test_oct),
        cmocka_unit_test(test_surfaces),
        cmocka_unit_test(test_streams),
    };
    make_samples(samples);
    random_start();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
