/* SPDX-License-Identifier: GPL-3.0-or-later */
/* examination.h as JSON and as text. */
#include "../text/report.h"
#include "examination.h"

enum { LABEL_WIDTH = 24 };

#define ROW(key, label, format, member)                                                  \
    TM_REPORT_ROW(key, label, format, tm_examination, member)
#define DEFECT(d, key, label) [d] = ROW(key, label, NULL, defect[d].count)

static const tm_report_row defect_row[TM_DEFECTS] = {
    DEFECT(TM_INVERTED, "inverted", "inverted"),
    DEFECT(TM_DEGENERATE, "degenerate", "degenerate"),
    DEFECT(TM_UNMATCHED_FACE, "unmatched_faces", "unmatched faces"),
    DEFECT(TM_OVERLAPPING_FACE, "overlapping_faces", "overlapping faces"),
    DEFECT(TM_OPEN_EDGE, "open_edges", "open edges"),
    DEFECT(TM_NON_MANIFOLD_EDGE, "non_manifold_edges", "non-manifold edges"),
    DEFECT(TM_NON_MANIFOLD_VERTEX, "non_manifold_vertices", "non-manifold vertices"),
    DEFECT(TM_DUPLICATE_NODE, "duplicate_nodes", "duplicate nodes"),
    DEFECT(TM_DANGLING_FACE, "dangling_faces", "dangling faces"),
    DEFECT(TM_REPEATED_FACE, "repeated_faces", "repeated faces"),
    DEFECT(TM_DANGLING_EDGE, "dangling_edges", "dangling edges"),
    DEFECT(TM_REPEATED_EDGE, "repeated_edges", "repeated edges"),
    DEFECT(TM_UNCLOSED_EDGE, "unclosed_edges", "unclosed edges"),
    DEFECT(TM_UNORIENTED_EDGE, "unoriented_edges", "unoriented edges"),
};

static const tm_report_row kinds[] = {
    ROW("tetrahedra", "tetrahedra", NULL, kind[TM_TETRAHEDRON]),
    ROW("pyramids", "pyramids", NULL, kind[TM_PYRAMID]),
    ROW("wedges", "wedges", NULL, kind[TM_WEDGE]),
    ROW("hexahedra", "hexahedra", NULL, kind[TM_HEXAHEDRON]),
    {0}};

void tm_examination_json(tm_json *json, const tm_examination *found)
{
    const tm_report_row rows[] = {ROW("nodes", NULL, NULL, nodes),
                                  ROW("elements", NULL, NULL, element_count),
                                  defect_row[TM_INVERTED],
                                  defect_row[TM_DEGENERATE],
                                  defect_row[TM_UNMATCHED_FACE],
                                  ROW("boundary_faces", NULL, NULL, boundary_faces),
                                  defect_row[TM_OPEN_EDGE],
                                  defect_row[TM_NON_MANIFOLD_EDGE],
                                  defect_row[TM_NON_MANIFOLD_VERTEX],
                                  ROW("components", NULL, NULL, components),
                                  ROW("euler", NULL, NULL, euler),
                                  ROW("volume", NULL, NULL, volume),
                                  ROW("area", NULL, NULL, area),
                                  ROW("unused_nodes", NULL, NULL, unused_nodes),
                                  defect_row[TM_DUPLICATE_NODE],
                                  defect_row[TM_OVERLAPPING_FACE],
                                  defect_row[TM_DANGLING_FACE],
                                  defect_row[TM_REPEATED_FACE],
                                  defect_row[TM_DANGLING_EDGE],
                                  defect_row[TM_REPEATED_EDGE],
                                  {0}};
    const tm_report_row of_polyhedra[] = {
        defect_row[TM_UNCLOSED_EDGE], defect_row[TM_UNORIENTED_EDGE], {0}};
    tm_report_json(json, rows, found);
    if (found->polyhedra)
        tm_report_json(json, of_polyhedra, found);
    if (found->mixed)
        tm_report_json(json, kinds, found);
}

static void table(tm_text *text, const tm_report_row *rows, const tm_examination *found)
{
    tm_report_table(text, rows, (const void *[]){found}, 1, LABEL_WIDTH);
}

static void sizes(tm_text *text, const tm_examination *found)
{
    const tm_report_row first[] = {ROW(NULL, "nodes", NULL, nodes),
                                   ROW(NULL, found->elements, NULL, element_count),
                                   {0}};
    static const tm_report_row rest[] = {
        ROW(NULL, "components", NULL, components),
        ROW(NULL, "Euler number", NULL, euler),
        ROW(NULL, "volume", "%.9g", volume),
        ROW(NULL, "boundary faces", NULL, boundary_faces),
        ROW(NULL, "boundary area", "%.9g", area),
        ROW(NULL, "unused nodes", NULL, unused_nodes),
        {0}};
    table(text, first, found);
    if (found->mixed)
        table(text, kinds, found);
    table(text, rest, found);
}

static void unmatched_text(tm_text *text, const tm_examination *found,
                           const uint32_t place[TM_DEFECT_NUMBERS], unsigned base)
{
    const uint32_t a = place[0] + base, b = place[1] + base, c = place[2] + base;
    if (found->polyhedra)
        tm_text_format(text, "facet %u does not belong to the %s that it names", a,
                       found->elements);
    else if (place[3] == TM_FACE_HALVED)
        tm_text_format(text, "triangle %u %u %u is half of a quadrilateral", a, b, c);
    else if (place[3] == TM_FACE_IN_ANOTHER_ORDER)
        tm_text_format(text, "quadrilateral %u %u %u is there in another order too", a, b,
                       c);
    else
        tm_text_format(text, "face %u %u %u belongs to %u %s", a, b, c, place[3],
                       found->elements);
}

/* Rows of .face, or of .facet. */
static void row_text(tm_text *text, const tm_examination *found, tm_defect d,
                     const uint32_t place[TM_DEFECT_NUMBERS], unsigned base)
{
    const uint32_t a = place[0] + base, b = place[1] + base;
    const bool is_facet = found->polyhedra || place[2] == 1;
    if (d == TM_REPEATED_FACE)
        tm_text_format(text, "row %u of %s repeats row %u", a,
                       is_facet ? ".facet" : ".face", b);
    else if (is_facet)
        tm_text_format(text, "row %u of .facet is no face of the %s that it names", a,
                       found->elements);
    else
        tm_text_format(text, "row %u of .face is no face of any %s", a, found->element);
}

/* One defect in a sentence. */
static void place_text(tm_text *text, const tm_examination *found, tm_defect d,
                       const uint32_t place[TM_DEFECT_NUMBERS], unsigned base)
{
    const char *one = found->element, *many = found->elements;
    const uint32_t a = place[0] + base, b = place[1] + base, c = place[2] + base;
    switch (d) {
    case TM_INVERTED:
        tm_text_format(text, "%s %u is inverted", one, a);
        break;
    case TM_DEGENERATE:
        if (place[1] == TM_NONE)
            tm_text_format(text, "%s %u is flat", one, a);
        else if (place[2] == 1)
            tm_text_format(text, "facet %u names node %u twice", a, b);
        else
            tm_text_format(text, "%s %u names node %u twice", one, a, b);
        break;
    case TM_UNMATCHED_FACE:
        unmatched_text(text, found, place, base);
        break;
    case TM_OVERLAPPING_FACE:
        tm_text_format(text, "%s %u and %u are on the same side of their common face",
                       many, a, b);
        break;
    case TM_OPEN_EDGE:
    case TM_NON_MANIFOLD_EDGE:
        tm_text_format(text, "edge %u %u belongs to %u boundary face%s", a, b, place[2],
                       place[2] == 1 ? "" : "s");
        break;
    case TM_NON_MANIFOLD_VERTEX:
        tm_text_format(text, "node %u joins %u fans of boundary faces", a, place[1]);
        break;
    case TM_DUPLICATE_NODE:
        tm_text_format(text, "node %u is at the place of node %u", a, b);
        break;
    case TM_DANGLING_FACE:
    case TM_REPEATED_FACE:
        row_text(text, found, d, place, base);
        break;
    case TM_DANGLING_EDGE:
        tm_text_format(text, "row %u of .edge is no edge of any %s", a, one);
        break;
    case TM_REPEATED_EDGE:
        tm_text_format(text, "row %u of .edge repeats row %u", a, b);
        break;
    case TM_UNCLOSED_EDGE:
        tm_text_format(text, "edge %u %u of %s %u belongs to %u of its facets", b, c, one,
                       a, place[3]);
        break;
    case TM_UNORIENTED_EDGE:
        tm_text_format(text, "edge %u %u of %s %u: its two facets run alike along it", b,
                       c, one, a);
        break;
    case TM_DEFECTS:
        break;
    }
}

static void defect_text(tm_text *text, const tm_examination *found, tm_defect d,
                        unsigned base)
{
    const tm_defect_list *list = &found->defect[d];
    if (list->count == 0)
        return;
    table(text, (const tm_report_row[]){defect_row[d], {0}}, found);
    for (size_t i = 0; i < list->count && i < TM_DEFECTS_LISTED; i++) {
        tm_text_string(text, "  ");
        place_text(text, found, d, list->place[i], base);
        tm_text_string(text, "\n");
    }
    if (list->count > TM_DEFECTS_LISTED)
        tm_text_format(text, "  and %zu more\n", list->count - TM_DEFECTS_LISTED);
}

void tm_examination_text(tm_text *text, const tm_examination *found, unsigned base)
{
    sizes(text, found);
    tm_text_string(text, "\n");
    if (tm_examination_is_good(found))
        tm_text_string(text, "nothing is wrong\n");
    for (int d = 0; d < TM_DEFECTS; d++)
        defect_text(text, found, (tm_defect)d, base);
}
