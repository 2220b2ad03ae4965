/* SPDX-License-Identifier: GPL-3.0-or-later */
/* examination.h as JSON and as text. */
#include "examination.h"

#include <inttypes.h>

enum { LABEL_WIDTH = 24, NUMBER_WIDTH = 14 };

typedef struct defect_name {
    const char *key; /* in JSON */
    const char *label;
} defect_name;

static const defect_name name[TM_DEFECTS] = {
    [TM_INVERTED] = {"inverted", "inverted"},
    [TM_DEGENERATE] = {"degenerate", "degenerate"},
    [TM_UNMATCHED_FACE] = {"unmatched_faces", "unmatched faces"},
    [TM_OVERLAPPING_FACE] = {"overlapping_faces", "overlapping faces"},
    [TM_OPEN_EDGE] = {"open_edges", "open edges"},
    [TM_NON_MANIFOLD_EDGE] = {"non_manifold_edges", "non-manifold edges"},
    [TM_NON_MANIFOLD_VERTEX] = {"non_manifold_vertices", "non-manifold vertices"},
    [TM_DUPLICATE_NODE] = {"duplicate_nodes", "duplicate nodes"},
    [TM_DANGLING_FACE] = {"dangling_faces", "dangling faces"},
    [TM_REPEATED_FACE] = {"repeated_faces", "repeated faces"},
    [TM_DANGLING_EDGE] = {"dangling_edges", "dangling edges"},
    [TM_REPEATED_EDGE] = {"repeated_edges", "repeated edges"},
    [TM_UNCLOSED_EDGE] = {"unclosed_edges", "unclosed edges"},
    [TM_UNORIENTED_EDGE] = {"unoriented_edges", "unoriented edges"},
};

static const char *kind_name(size_t kind)
{
    return tm_element_shapes[tm_element_kind_nodes[kind]].plural;
}

static void defect_json(tm_json *json, const tm_examination *found, tm_defect d)
{
    tm_json_integer(json, name[d].key, (int64_t)found->defect[d].count);
}

void tm_examination_json(tm_json *json, const tm_examination *found)
{
    tm_json_integer(json, "nodes", (int64_t)found->nodes);
    tm_json_integer(json, "elements", (int64_t)found->element_count);
    defect_json(json, found, TM_INVERTED);
    defect_json(json, found, TM_DEGENERATE);
    defect_json(json, found, TM_UNMATCHED_FACE);
    tm_json_integer(json, "boundary_faces", (int64_t)found->boundary_faces);
    defect_json(json, found, TM_OPEN_EDGE);
    defect_json(json, found, TM_NON_MANIFOLD_EDGE);
    defect_json(json, found, TM_NON_MANIFOLD_VERTEX);
    tm_json_integer(json, "components", (int64_t)found->components);
    tm_json_integer(json, "euler", found->euler);
    tm_json_double(json, "volume", found->volume);
    tm_json_double(json, "area", found->area);
    tm_json_integer(json, "unused_nodes", (int64_t)found->unused_nodes);
    defect_json(json, found, TM_DUPLICATE_NODE);
    defect_json(json, found, TM_OVERLAPPING_FACE);
    defect_json(json, found, TM_DANGLING_FACE);
    defect_json(json, found, TM_REPEATED_FACE);
    defect_json(json, found, TM_DANGLING_EDGE);
    defect_json(json, found, TM_REPEATED_EDGE);
    if (found->polyhedra) {
        defect_json(json, found, TM_UNCLOSED_EDGE);
        defect_json(json, found, TM_UNORIENTED_EDGE);
    }
    for (size_t k = 0; found->mixed && k < TM_ELEMENT_KINDS; k++)
        tm_json_integer(json, kind_name(k), (int64_t)found->kind[k]);
}

static void integer_row(tm_text *text, const char *label, int64_t value)
{
    tm_text_format(text, "%-*s%*" PRId64 "\n", LABEL_WIDTH, label, NUMBER_WIDTH, value);
}

static void real_row(tm_text *text, const char *label, double value)
{
    tm_text_format(text, "%-*s%*.9g\n", LABEL_WIDTH, label, NUMBER_WIDTH, value);
}

static void sizes(tm_text *text, const tm_examination *found)
{
    integer_row(text, "nodes", (int64_t)found->nodes);
    integer_row(text, found->elements, (int64_t)found->element_count);
    for (size_t k = 0; found->mixed && k < TM_ELEMENT_KINDS; k++)
        integer_row(text, kind_name(k), (int64_t)found->kind[k]);
    integer_row(text, "components", (int64_t)found->components);
    integer_row(text, "Euler number", found->euler);
    real_row(text, "volume", found->volume);
    integer_row(text, "boundary faces", (int64_t)found->boundary_faces);
    real_row(text, "boundary area", found->area);
    integer_row(text, "unused nodes", (int64_t)found->unused_nodes);
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
    integer_row(text, name[d].label, (int64_t)list->count);
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
