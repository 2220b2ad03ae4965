/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surface_examine.h as JSON and as text. */
#include "../text/report.h"
#include "surface_examine.h"

enum { LABEL_WIDTH = 29, LISTED = 5 };

#define ROW(key, label, member)                                                          \
    TM_REPORT_ROW(key, label, NULL, tm_surface_examination, member)

static const tm_report_row sizes[] = {
    ROW("nodes", "nodes", nodes),
    ROW("triangles", "triangles", triangles),
    ROW("components", "shells", components),
    ROW("nested", "shells within others", nested),
    ROW("regions", "regions", regions),
    ROW("euler", "Euler number", euler),
    ROW("volume", "volume", volume),
    ROW("area", "area", area),
    ROW("unused_nodes", "unused nodes", defects.unused_nodes),
    ROW("non_manifold_edges", "edges of 3 triangles or more", defects.crowded_edges),
    {0}};

static const tm_report_row wrong[] = {
    ROW("open_edges", "open edges", defects.open_edges),
    ROW("duplicate_nodes", "duplicate nodes", defects.duplicate_nodes),
    ROW("degenerate", "degenerate triangles", degenerate),
    ROW("repeated_faces", "repeated triangles", repeated_faces),
    ROW("turned_faces", "turned triangles", turned_faces),
    ROW("turned_shells", "shells that look inward", turned_shells),
    ROW("crossings", "crossings", crossings),
    {0}};

static void json_point(tm_json *json, const double p[3])
{
    for (int i = 0; i < 3; i++)
        tm_json_double(json, NULL, p[i]);
}

void tm_surface_examination_json(tm_json *json, const tm_surface_examination *found,
                                 const tm_polygon_surface *surface)
{
    tm_report_json(json, sizes, found);
    tm_report_json(json, wrong, found);
    tm_json_open(json, "crossing_pairs", '[');
    for (size_t c = 0; c < found->crossings; c++) {
        tm_json_open(json, NULL, '[');
        for (int i = 0; i < 2; i++)
            tm_json_integer(json, NULL,
                            (int64_t)found->crossing[c].triangle[i] + surface->base);
        json_point(json, found->crossing[c].point);
        tm_json_close(json, ']');
    }
    tm_json_close(json, ']');
    tm_json_string(json, "problem", found->problem);
    tm_json_bool(json, "good", tm_surface_examination_is_good(found));
}

static void text_point(tm_text *text, const double p[3])
{
    tm_text_format(text, " (%g, %g, %g)", p[0], p[1], p[2]);
}

/* "repeated triangles: 3, the first is 7, at (0, 0, 1)" */
static void text_face(tm_text *text, const char *what, size_t count, uint32_t row,
                      const tm_polygon_surface *surface)
{
    if (count == 0)
        return;
    tm_text_format(text, "%s: %zu, the first is %zu, at", what, count,
                   (size_t)row + surface->base);
    text_point(text, surface->xyz[surface->item[3 * (size_t)row]]);
    tm_text_string(text, "\n");
}

static void text_edges(tm_text *text, const tm_surface_defects *defects,
                       const tm_polygon_surface *surface)
{
    if (defects->open_edges == 0)
        return;
    tm_text_format(text, "open edges: %zu\n", defects->open_edges);
    for (size_t e = 0; e < defects->open_edges && e < TM_EDGES_LISTED; e++) {
        const uint32_t *v = defects->open_edge[e];
        tm_text_format(text, "    nodes %zu and %zu, from", (size_t)v[0] + surface->base,
                       (size_t)v[1] + surface->base);
        text_point(text, surface->xyz[v[0]]);
        tm_text_string(text, " to");
        text_point(text, surface->xyz[v[1]]);
        tm_text_string(text, "\n");
    }
    if (defects->open_edges > TM_EDGES_LISTED)
        tm_text_format(text, "    … and %zu more\n",
                       defects->open_edges - TM_EDGES_LISTED);
}

static void text_crossings(tm_text *text, const tm_surface_examination *found,
                           const tm_polygon_surface *surface)
{
    if (found->crossings == 0)
        return;
    tm_text_format(text, "crossings: %zu\n", found->crossings);
    for (size_t c = 0; c < found->crossings && c < LISTED; c++) {
        const tm_crossing *crossing = &found->crossing[c];
        tm_text_format(text, "    triangles %zu and %zu meet near",
                       (size_t)crossing->triangle[0] + surface->base,
                       (size_t)crossing->triangle[1] + surface->base);
        text_point(text, crossing->point);
        tm_text_string(text, "\n");
    }
    if (found->crossings > LISTED)
        tm_text_format(text, "    … and %zu more (--json has them)\n",
                       found->crossings - LISTED);
}

void tm_surface_examination_text(tm_text *text, const tm_surface_examination *found,
                                 const tm_polygon_surface *surface)
{
    tm_report_table(text, sizes, (const void *[]){found}, 1, LABEL_WIDTH);
    tm_text_string(text, "\n");
    text_edges(text, &found->defects, surface);
    if (found->defects.duplicate_nodes > 0)
        tm_text_format(text, "nodes in the place of an earlier one: %zu\n",
                       found->defects.duplicate_nodes);
    text_face(text, "degenerate triangles", found->degenerate, found->first.degenerate,
              surface);
    text_face(text, "repeated triangles", found->repeated_faces, found->first.repeated,
              surface);
    text_face(text, "triangles turned against most of their shell", found->turned_faces,
              found->first.turned_face, surface);
    text_face(text, "outermost shells that look inward", found->turned_shells,
              found->first.turned_shell, surface);
    text_crossings(text, found, surface);
    if (found->problem[0])
        tm_text_format(text, "no mesher takes it: %s\n", found->problem);
    tm_text_string(text, tm_surface_examination_is_good(found)
                             ? "nothing is wrong\n"
                             : "(surface-mend mends what can be)\n");
}
