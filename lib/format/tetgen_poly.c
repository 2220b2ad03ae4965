/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen.h"

#include "scan.h"

typedef struct {
    tm_polygon_surface *surface;
    tm_scan scan;
    bool markers; /* the facets have them */
    tm_error *error;
} reader;

/* Reads part 1. Without nodes there those of the surface stay. */
static tm_status read_nodes(reader *r)
{
    tm_stream rows;
    tm_stream_init(&rows);
    tm_block *node = tm_stream_add(&rows, ".node");
    if (!node)
        return tm_fail_memory(r->error);
    tm_polygon_surface *surface = r->surface;
    tm_tetgen_nodes nodes = {.base = surface->base};
    tm_status status = tm_tetgen_read_rows(node, &r->scan, &nodes, r->error);
    surface->base = nodes.base;
    if (status == TM_OK && node->count > 0)
        status = tm_polygon_surface_nodes_from_stream(surface, node, r->error);
    tm_stream_free(&rows);
    return status;
}

static tm_status read_polygon(reader *r, int64_t corners)
{
    int64_t base = r->surface->base, last = (int64_t)r->surface->nodes - 1 + base;
    tm_status status = TM_OK;
    for (int64_t i = 0; i < corners && status == TM_OK; i++) {
        int64_t node = base;
        status = tm_scan_next_integer(&r->scan, "node", base, last, &node, r->error);
        if (status == TM_OK)
            status = tm_polygon_surface_add_corner(r->surface, (uint32_t)(node - base),
                                                   r->error);
    }
    if (status == TM_OK)
        status = tm_polygon_surface_end_polygon(r->surface, r->error);
    return status;
}

/* A marker that the header announces may lack and is then 0, as TetGen takes it. */
static tm_status read_marker(reader *r, int64_t *marker)
{
    if (!r->markers || !tm_scan_more(&r->scan))
        return TM_OK;
    return tm_scan_whole(&r->scan, "the marker", INT32_MIN, INT32_MAX, marker, r->error);
}

static tm_status end_row(reader *r, const char *what)
{
    tm_status status = tm_scan_no_more(&r->scan, what, r->error);
    tm_scan_end_line(&r->scan);
    return status;
}

/* k n1 … nk [marker] */
static tm_status read_smesh_facet(reader *r, int64_t *marker)
{
    int64_t corners = 0;
    tm_status status = tm_scan_next_integer(&r->scan, "the number of corners", 1,
                                            INT32_MAX, &corners, r->error);
    if (status == TM_OK)
        status = read_polygon(r, corners);
    if (status == TM_OK)
        status = read_marker(r, marker);
    return status == TM_OK ? end_row(r, "the facet") : status;
}

/* number x y z */
static tm_status read_hole(reader *r, double xyz[3])
{
    int64_t number;
    tm_status status = tm_scan_next_integer(&r->scan, "the number of the hole", INT64_MIN,
                                            INT64_MAX, &number, r->error);
    if (status == TM_OK)
        status = tm_scan_point(&r->scan, xyz, r->error);
    return status;
}

/* polygons [holes [marker]], then the polygons and the holes, a line each. */
static tm_status read_poly_facet(reader *r, int64_t *marker)
{
    int64_t polygons = 0, holes = 0;
    tm_status status = tm_scan_next_integer(&r->scan, "the number of polygons", 1,
                                            INT32_MAX, &polygons, r->error);
    if (status == TM_OK && tm_scan_more(&r->scan))
        status = tm_scan_integer(&r->scan, "the number of holes", 0, INT32_MAX, &holes,
                                 r->error);
    if (status == TM_OK)
        status = read_marker(r, marker);
    if (status == TM_OK)
        status = end_row(r, "the first line of the facet");
    for (int64_t p = 0; p < polygons && status == TM_OK; p++) {
        int64_t corners = 0;
        status = tm_scan_next_integer(&r->scan, "the number of corners", 1, INT32_MAX,
                                      &corners, r->error);
        if (status == TM_OK)
            status = read_polygon(r, corners);
        if (status == TM_OK)
            status = end_row(r, "the polygon");
    }
    for (int64_t h = 0; h < holes && status == TM_OK; h++) {
        double xyz[3];
        status = read_hole(r, xyz);
        if (status == TM_OK)
            status = tm_polygon_surface_add_facet_hole(r->surface, xyz, r->error);
        if (status == TM_OK)
            status = end_row(r, "the hole");
    }
    return status;
}

static tm_status read_facets(reader *r, tm_plc_kind kind)
{
    int64_t count = 0, markers = 0;
    tm_status status = tm_scan_next_integer(&r->scan, "the number of facets", 0,
                                            INT64_MAX, &count, r->error);
    if (status == TM_OK && tm_scan_more(&r->scan))
        status = tm_scan_integer(&r->scan, "whether facets have markers", 0, 1, &markers,
                                 r->error);
    if (status == TM_OK)
        status = end_row(r, "the number of facets");
    r->markers = r->surface->has_facet_markers = markers != 0;
    for (int64_t f = 0; f < count && status == TM_OK; f++) {
        int64_t marker = 0;
        status = kind == TM_PLC_SMESH ? read_smesh_facet(r, &marker)
                                      : read_poly_facet(r, &marker);
        if (status == TM_OK)
            status = tm_polygon_surface_end_facet(r->surface, (int32_t)marker, r->error);
    }
    return status;
}

/* The header of parts 3 and 4. */
static tm_status read_count(reader *r, const char *what, int64_t *count)
{
    tm_status status =
        tm_scan_next_integer(&r->scan, what, 0, INT64_MAX, count, r->error);
    return status == TM_OK ? end_row(r, what) : status;
}

static tm_status read_holes(reader *r)
{
    int64_t count = 0;
    tm_status status =
        read_count(r, "the number of holes (0 where there is none)", &count);
    for (int64_t h = 0; h < count && status == TM_OK; h++) {
        double xyz[3];
        status = read_hole(r, xyz);
        if (status == TM_OK)
            status = tm_polygon_surface_add_hole(r->surface, xyz, r->error);
        if (status == TM_OK)
            status = end_row(r, "the hole");
    }
    return status;
}

/* number x y z attribute [volume] */
static tm_status read_region(reader *r)
{
    tm_region region = {.max_volume = -1};
    int64_t number;
    tm_status status = tm_scan_next_integer(&r->scan, "the number of the region",
                                            INT64_MIN, INT64_MAX, &number, r->error);
    if (status == TM_OK)
        status = tm_scan_point(&r->scan, region.point, r->error);
    if (status == TM_OK)
        status = tm_scan_double(&r->scan, "the region's attribute", &region.attribute,
                                r->error);
    if (status == TM_OK && tm_scan_more(&r->scan))
        status = tm_scan_double(&r->scan, "the region's largest volume",
                                &region.max_volume, r->error);
    if (status == TM_OK)
        status = tm_polygon_surface_add_region(r->surface, &region, r->error);
    return status == TM_OK ? end_row(r, "the region") : status;
}

/* Part 4 may lack. */
static tm_status read_regions(reader *r)
{
    int64_t count = 0;
    if (!tm_scan_seek(&r->scan))
        return TM_OK;
    tm_status status = read_count(r, "the number of regions", &count);
    for (int64_t i = 0; i < count && status == TM_OK; i++)
        status = read_region(r);
    return status;
}

tm_status tm_plc_read(tm_polygon_surface *surface, tm_plc_kind kind, const char *bytes,
                      size_t size, const char *name, tm_error *error)
{
    reader r = {.surface = surface, .error = error};
    tm_scan_begin(&r.scan, bytes, size, name, '#');
    tm_status status = read_nodes(&r);
    if (kind != TM_PLC_NODE) {
        if (status == TM_OK)
            status = read_facets(&r, kind);
        if (status == TM_OK)
            status = read_holes(&r);
        if (status == TM_OK)
            status = read_regions(&r);
    }
    if (status == TM_OK && tm_scan_seek(&r.scan))
        status = tm_scan_no_more(&r.scan, "the last row", error);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}

/* Which of the three --------------------------------------------------------------- */

static bool peek_integer(tm_scan *scan, int64_t *value)
{
    return tm_scan_integer(scan, "", 0, INT64_MAX, value, NULL) == TM_OK;
}

bool tm_plc_lacks_nodes(const char *bytes, size_t size)
{
    tm_scan scan;
    int64_t nodes;
    tm_scan_begin(&scan, bytes, size, "", '#');
    return tm_scan_seek(&scan) && peek_integer(&scan, &nodes) && nodes == 0;
}

static size_t words_in_line(tm_scan *scan)
{
    size_t words = 0;
    while (tm_scan_word(scan).size > 0)
        words++;
    tm_scan_end_line(scan);
    return words;
}

/* The first line of a facet of .poly has at most three numbers, and the polygon behind it
 * k + 1; that of .smesh has k + 1 itself, 4 or more. */
tm_plc_kind tm_plc_kind_of(const char *bytes, size_t size)
{
    enum { POLY_FACET_WORDS = 3 };
    tm_scan scan;
    int64_t nodes = 0;
    tm_scan_begin(&scan, bytes, size, "", '#');
    tm_scan_seek(&scan);
    if (!peek_integer(&scan, &nodes))
        return TM_PLC_NODE;
    tm_scan_end_line(&scan);
    for (int64_t v = 0; v < nodes && tm_scan_seek(&scan); v++)
        tm_scan_end_line(&scan);
    if (!tm_scan_seek(&scan))
        return TM_PLC_NODE;
    tm_scan_end_line(&scan);
    if (!tm_scan_seek(&scan))
        return TM_PLC_POLY;
    return words_in_line(&scan) <= POLY_FACET_WORDS ? TM_PLC_POLY : TM_PLC_SMESH;
}

/* Writing -------------------------------------------------------------------------- */

static void write_point(tm_text *text, const double xyz[3])
{
    for (int i = 0; i < 3; i++) {
        tm_text_append(text, " ", 1);
        tm_text_double(text, xyz[i]);
    }
}

void tm_plc_write_nodes(tm_text *text, const tm_polygon_surface *surface)
{
    tm_text_format(text, "%zu 3 %zu %d\n", surface->nodes, surface->attributes,
                   surface->node_marker != NULL);
    for (size_t v = 0; v < surface->nodes; v++) {
        tm_text_format(text, "%zu", v + surface->base);
        write_point(text, surface->xyz[v]);
        for (size_t i = 0; i < surface->attributes; i++) {
            tm_text_append(text, " ", 1);
            tm_text_double(text, surface->attribute[v * surface->attributes + i]);
        }
        if (surface->node_marker)
            tm_text_format(text, " %d", surface->node_marker[v]);
        tm_text_append(text, "\n", 1);
    }
}

static void write_facet(tm_text *text, const tm_polygon_surface *surface, size_t f)
{
    size_t first = surface->facet_start[f], last = surface->facet_start[f + 1];
    size_t first_hole = surface->facet_hole_start[f];
    size_t last_hole = surface->facet_hole_start[f + 1];
    tm_text_format(text, "%zu %zu", last - first, last_hole - first_hole);
    if (surface->has_facet_markers)
        tm_text_format(text, " %d", surface->facet_marker[f]);
    tm_text_append(text, "\n", 1);
    for (size_t p = first; p < last; p++) {
        tm_text_format(text, "%zu", surface->start[p + 1] - surface->start[p]);
        for (size_t i = surface->start[p]; i < surface->start[p + 1]; i++)
            tm_text_format(text, " %zu", (size_t)surface->item[i] + surface->base);
        tm_text_append(text, "\n", 1);
    }
    for (size_t h = first_hole; h < last_hole; h++) {
        tm_text_format(text, "%zu", h - first_hole + 1);
        write_point(text, surface->facet_hole[h]);
        tm_text_append(text, "\n", 1);
    }
}

void tm_plc_write(tm_text *text, const tm_polygon_surface *surface)
{
    tm_plc_write_nodes(text, surface);
    tm_text_format(text, "%zu %d\n", surface->facets, surface->has_facet_markers);
    for (size_t f = 0; f < surface->facets; f++)
        write_facet(text, surface, f);
    tm_text_format(text, "%zu\n", surface->holes);
    for (size_t h = 0; h < surface->holes; h++) {
        tm_text_format(text, "%zu", h + 1);
        write_point(text, surface->hole[h]);
        tm_text_append(text, "\n", 1);
    }
    tm_text_format(text, "%zu\n", surface->regions);
    for (size_t i = 0; i < surface->regions; i++) {
        const tm_region *region = &surface->region[i];
        tm_text_format(text, "%zu", i + 1);
        write_point(text, region->point);
        tm_text_append(text, " ", 1);
        tm_text_double(text, region->attribute);
        tm_text_append(text, " ", 1);
        tm_text_double(text, region->max_volume);
        tm_text_append(text, "\n", 1);
    }
}
