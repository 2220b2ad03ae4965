/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles at will, and what is wrong with them by other means than the library's. */
#ifndef TESTS_UNIT_MEND_FIXTURE_H
#define TESTS_UNIT_MEND_FIXTURE_H

#include "../../lib/surface/mend/mend.h"
#include "octree_fixture.h"

enum { SOUP_NODES = 16, SOUP_TRIANGLES = 40 };

static inline void make_soup(tm_polygon_surface *p)
{
    const unsigned nodes = 1 + random_below(SOUP_NODES), grid = 1 + random_below(8);
    for (unsigned v = 0; v < nodes; v++) {
        const unsigned x = random_below(grid), y = random_below(grid);
        const unsigned z = random_below(grid);
        add_node(p, x, y, z + (random_below(8) == 0 ? 1e-9 : 0));
    }
    for (unsigned t = random_below(SOUP_TRIANGLES); t > 0; t--) {
        const uint32_t a = random_below(nodes), b = random_below(nodes);
        add_triangle(p, a, b, random_below(nodes));
    }
}

/* Corners of some triangles go elsewhere, or are apart by a little. */
static inline void change_corners(tm_stream *stream)
{
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *face = tm_stream_find(stream, ".face");
    for (unsigned n = random_below(8); n > 0 && face->count > 0 && node->count > 0; n--) {
        uint32_t *corner = &face->integer[random_below(3 * (unsigned)face->count)];
        if (random_below(2))
            *corner = random_below((unsigned)node->count);
        else
            node->real[3 * *corner] += random_unit() / 64;
    }
}

typedef struct edges {
    size_t open, crowded, other_way;
} edges;

/* By all pairs of edges. */
static inline edges count_edges(const tm_block *face)
{
    edges count = {0};
    const size_t halves = 3 * face->count;
    for (size_t h = 0; h < halves; h++) {
        const uint32_t *t = face->integer + h / 3 * 3;
        const uint32_t a = t[h % 3], b = t[(h + 1) % 3];
        size_t same = 0, against = 0;
        for (size_t g = 0; g < halves; g++) {
            const uint32_t *u = face->integer + g / 3 * 3;
            same += u[g % 3] == a && u[(g + 1) % 3] == b;
            against += u[g % 3] == b && u[(g + 1) % 3] == a;
        }
        count.open += same + against == 1;
        count.crowded += same + against > 2;
        count.other_way += same + against == 2 && same == 2;
    }
    return count;
}

/* What was reported is so. */
static inline void check_mended(const tm_stream *stream, const tm_mend_report *report)
{
    const edges found = count_edges(tm_stream_find(stream, ".face"));
    assert_int_equal(report->open_edges, found.open);
    assert_int_equal(report->manifold, found.open + found.crowded + found.other_way == 0);
}

/* The polygons as a stream; false where there is no triangle. */
static inline bool take_triangles(tm_stream *stream, tm_polygon_surface *p)
{
    tm_error error;
    tm_stream_init(stream);
    assert_ok(tm_polygon_surface_to_stream(p, stream, "", &error), &error);
    tm_polygon_surface_free(p);
    return tm_stream_find(stream, ".face") != NULL;
}

static inline tm_mend_options random_mend_options(void)
{
    tm_mend_options options = {.weld = random_below(2) ? -1 : random_unit() / 4};
    options.weld_auto = random_below(4) == 0;
    options.fill = random_below(2) * 8;
    options.fill *= random_unit();
    options.islands = random_below(2) * 2;
    options.islands *= random_unit();
    options.all_doubles = random_below(2);
    return options;
}

#endif
