/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "coordinates.h"

#include <math.h>

/* Of each row of `width` numbers the first three are a point. */
static tm_status check_rows(const double *real, size_t count, size_t width,
                            const char *block, const char *what, size_t first,
                            double *largest, tm_error *error)
{
    for (size_t row = 0; row < count; row++) {
        const double *p = real + row * width;
        for (size_t i = 0; i < width; i++) {
            if (!(fabs(p[i]) <= TM_COORDINATE_MAX))
                return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, block,
                                  "%s %zu at (%g, %g, %g): beyond %g, where products of "
                                  "coordinates overflow (scale the mesh)",
                                  what, row + first, p[0], p[1], p[2], TM_COORDINATE_MAX);
            *largest = fabs(p[i]) > *largest ? fabs(p[i]) : *largest;
        }
    }
    return TM_OK;
}

tm_status tm_largest_coordinate_check(double largest, const char *block, tm_error *error)
{
    if (largest > 0 && largest < TM_COORDINATE_MIN)
        return tm_fail_at(error, TM_ERROR_INPUT, NULL, 0, block,
                          "the largest coordinate is %g: below %g, where products of "
                          "coordinates underflow (scale the mesh)",
                          largest, TM_COORDINATE_MIN);
    return TM_OK;
}

tm_status tm_coordinates_check(const double (*xyz)[3], size_t count, unsigned base,
                               tm_error *error)
{
    enum { COORDINATES = 3 };
    double largest = 0;
    const tm_status status =
        check_rows(&xyz[0][0], count, COORDINATES, NULL, "node", base, &largest, error);
    return status == TM_OK ? tm_largest_coordinate_check(largest, NULL, error) : status;
}

tm_status tm_block_check_coordinates(const tm_block *block, size_t first, double *largest,
                                     tm_error *error)
{
    return check_rows(block->real, block->count, tm_block_reals(block->kind), block->name,
                      block->kind == TM_NODE ? "node" : "root", first, largest, error);
}

tm_status tm_stream_check_coordinates(const tm_stream *stream, tm_error *error)
{
    tm_status status = TM_OK;
    for (size_t b = 0; b < stream->blocks && status == TM_OK; b++) {
        const tm_block *block = &stream->block[b];
        double largest = 0;
        if (block->kind != TM_NODE && block->kind != TM_ROOT)
            continue;
        status = tm_block_check_coordinates(block, stream->base, &largest, error);
        if (status == TM_OK)
            status = tm_largest_coordinate_check(largest, block->name, error);
    }
    return status;
}
