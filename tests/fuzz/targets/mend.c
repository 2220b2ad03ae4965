/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles at will, or cubes with some corners changed, made a closed surface: what is
 * reported is so. */
#include "target.h"

#include "../../unit/mend_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_polygon_surface p;
    tm_stream stream;
    tm_mend_report report;
    tm_error error;
    bytes_start(bytes, size);
    tm_polygon_surface_init(&p);
    if (random_below(2))
        make_soup(&p);
    else
        add_random_cubes(&p);
    if (take_triangles(&stream, &p)) {
        change_corners(&stream);
        const tm_mend_options options = random_mend_options();
        assert_ok(tm_mend(&stream, &options, &report, &error), &error);
        check_mended(&stream, &report);
        check_round_trip(&stream);
    }
    tm_stream_free(&stream);
    return 0;
}
