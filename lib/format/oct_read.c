/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading .oct files. */
#include "oct.h"

#include "../base/array.h"
#include "scan.h"

#include <stdlib.h>

enum { COORDINATES = 3, EDGE_NUMBERS = 3, COUNTS_MAX = 4, LEVEL_MAX = 30 };
enum { POINTS, EDGES, OCTANTS, ELEMENTS };

typedef struct reader {
    tm_scan scan;
    tm_oct *oct;
    int64_t count[COUNTS_MAX];
    size_t counts; /* 3, or 4: the other version */
    size_t room[4];
    tm_error *error;
} reader;

static tm_status read_id(reader *r, const char *what, int64_t below, int64_t *value)
{
    return tm_scan_next_integer(&r->scan, what, 0, below - 1, value, r->error);
}

static tm_status read_head(reader *r)
{
    if (!tm_scan_seek(&r->scan))
        return tm_scan_fail(&r->scan, r->error, "is empty");
    for (; r->counts < COUNTS_MAX && tm_scan_more(&r->scan); r->counts++) {
        tm_status status =
            tm_scan_integer(&r->scan, "a count of the first line", 0, UINT32_MAX - 1,
                            &r->count[r->counts], r->error);
        if (status != TM_OK)
            return status;
    }
    if (r->counts <= OCTANTS)
        return tm_scan_fail(&r->scan, r->error,
                            "the first line has %zu numbers (points, edges, octants)",
                            r->counts);
    return tm_scan_no_more(&r->scan, "the counts of the first line", r->error);
}

static tm_status read_points(reader *r)
{
    tm_oct *oct = r->oct;
    tm_status status = TM_OK;
    for (int64_t p = 0; p < r->count[POINTS] && status == TM_OK; p++) {
        void *grown = tm_grow(oct->xyz, &r->room[0], oct->points + 1, sizeof *oct->xyz);
        if (!grown)
            return tm_fail_memory(r->error);
        oct->xyz = grown;
        for (int i = 0; i < COORDINATES && status == TM_OK; i++)
            status = tm_scan_next_double(&r->scan, "a coordinate",
                                         &oct->xyz[oct->points][i], r->error);
        oct->points++;
    }
    return status;
}

static tm_status skip_edges(reader *r)
{
    int64_t id;
    tm_status status = TM_OK;
    for (int64_t e = 0; e < r->count[EDGES] && status == TM_OK; e++)
        for (int i = 0; i < EDGE_NUMBERS && status == TM_OK; i++)
            status = read_id(r, "a point of an edge", r->count[POINTS], &id);
    return status;
}

/* What may follow the level: all octants have an id, or none. */
static tm_status read_octant_id(reader *r, size_t o)
{
    const bool has_id = tm_scan_more(&r->scan);
    if (o > 0 && has_id != (r->oct->id != NULL))
        return tm_scan_fail(&r->scan, r->error,
                            "octant %zu has %s, but those before it have %s", o,
                            has_id ? "an id" : "no id", has_id ? "none" : "one");
    if (!has_id)
        return TM_OK;
    uint32_t *grown = tm_grow(r->oct->id, &r->room[3], o + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(r->error);
    r->oct->id = grown;
    int64_t number = 0;
    const tm_status status = tm_scan_integer(&r->scan, "the id of an octant", 0,
                                             UINT32_MAX - 1, &number, r->error);
    grown[o] = (uint32_t)number;
    return status == TM_OK ? tm_scan_no_more(&r->scan, "the id of the octant", r->error)
                           : status;
}

static tm_status skip_triangles(reader *r)
{
    int64_t triangles = 0, number;
    tm_status status =
        read_id(r, "the number of triangles in an octant", UINT32_MAX, &triangles);
    for (int64_t t = 0; t < triangles && status == TM_OK; t++)
        status = read_id(r, "a triangle in an octant", UINT32_MAX, &number);
    return status;
}

static tm_status read_octant(reader *r)
{
    tm_oct *oct = r->oct;
    size_t o = oct->octants;
    int64_t number = 0;
    void *corner = tm_grow(oct->corner, &r->room[1], o + 1, sizeof *oct->corner);
    oct->corner = corner ? corner : oct->corner;
    void *level = tm_grow(oct->level, &r->room[2], o + 1, sizeof *oct->level);
    oct->level = level ? level : oct->level;
    if (!corner || !level)
        return tm_fail_memory(r->error);
    tm_status status =
        tm_scan_next_integer(&r->scan, "the number of an octant's corners",
                             TM_OCT_CORNERS, TM_OCT_CORNERS, &number, r->error);
    for (int i = 0; i < TM_OCT_CORNERS && status == TM_OK; i++) {
        status = read_id(r, "a corner of an octant", r->count[POINTS], &number);
        oct->corner[o][i] = (uint32_t)number;
    }
    if (status == TM_OK)
        status = read_id(r, "the level of an octant", LEVEL_MAX + 1, &number);
    oct->level[o] = (unsigned char)number;
    if (status == TM_OK)
        status = read_octant_id(r, o);
    oct->octants++;
    return status == TM_OK ? skip_triangles(r) : status;
}

static tm_status read_octants(reader *r)
{
    tm_status status = TM_OK;
    for (int64_t o = 0; o < r->count[OCTANTS] && status == TM_OK; o++)
        status = read_octant(r);
    return status;
}

static tm_status read_elements(reader *r)
{
    size_t room = 0;
    tm_status status = TM_OK;
    for (size_t o = 0; o < (size_t)r->count[OCTANTS] && status == TM_OK; o++) {
        int64_t count = 0;
        uint32_t *grown = tm_grow(r->oct->elements, &room, o + 1, sizeof *grown);
        if (!grown)
            return tm_fail_memory(r->error);
        r->oct->elements = grown;
        status = read_id(r, "the number of elements in an octant", UINT32_MAX, &count);
        grown[o] = (uint32_t)count;
    }
    return status;
}

/* Two words, a point and three angles. */
static tm_status read_transform(reader *r)
{
    tm_scan_seek(&r->scan);
    if (!tm_word_is(tm_scan_word(&r->scan), "Geometric"))
        return tm_scan_fail(&r->scan, r->error,
                            "'Geometric Transform' should follow the last octant");
    tm_scan_end_line(&r->scan);
    for (int i = 0; i < 2 * COORDINATES; i++) {
        double value;
        tm_status status =
            tm_scan_next_double(&r->scan, "a number of the transform", &value, r->error);
        if (status != TM_OK)
            return status;
        if (i >= COORDINATES && value != 0)
            return tm_scan_fail(&r->scan, r->error,
                                "the octree is turned by %g (octants of a stream are "
                                "along the axes)",
                                value);
    }
    return TM_OK;
}

tm_status tm_oct_read(tm_oct *oct, const char *bytes, size_t size, const char *name,
                      tm_error *error)
{
    *oct = (tm_oct){0};
    reader r = {.oct = oct, .error = error};
    tm_scan_begin(&r.scan, bytes, size, name, '\0');
    tm_status status = read_head(&r);
    if (status == TM_OK)
        status = read_points(&r);
    if (status == TM_OK)
        status = skip_edges(&r);
    if (status == TM_OK && r.counts == COUNTS_MAX)
        status = read_elements(&r);
    if (status == TM_OK)
        status = read_octants(&r);
    if (status == TM_OK)
        status = read_transform(&r);
    if (status == TM_OK && r.counts < COUNTS_MAX)
        status = read_elements(&r);
    if (status == TM_OK && tm_scan_seek(&r.scan))
        status = tm_scan_no_more(&r.scan, "the last number", error);
    return status;
}

void tm_oct_free(tm_oct *oct)
{
    free(oct->xyz);
    free(oct->corner);
    free(oct->level);
    free(oct->elements);
    free(oct->id);
    *oct = (tm_oct){0};
}
