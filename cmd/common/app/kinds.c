/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kinds.h"

#include "../../../lib/text/text.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Kinds as bits. PART is the part `surface` beside any mesh. */
enum {
    NOTHING = 1 << TM_CONTENT_NOTHING,
    POINTS = 1 << TM_CONTENT_POINTS,
    SURFACE = 1 << TM_CONTENT_SURFACE,
    TETRAHEDRA = 1 << TM_CONTENT_TETRAHEDRA,
    MIXED = 1 << TM_CONTENT_MIXED,
    POLYHEDRA = 1 << TM_CONTENT_POLYHEDRA,
    PART = 1 << (TM_CONTENT_POLYHEDRA + 1),
    CELLS = TETRAHEDRA | MIXED | POLYHEDRA,
    ALL = POINTS | SURFACE | CELLS
};

static const struct {
    const char *filter;
    unsigned kinds;
} table[] = {
    {"tetgen-mesh", POINTS | SURFACE | TETRAHEDRA | PART},
    {"surface-import", POINTS | SURFACE | PART},
    {"surface-mend", SURFACE | PART},
    {"octree-mesh", SURFACE | PART},
    {"lepp-improve", TETRAHEDRA},
    {"poly-dual", TETRAHEDRA},
    {"polylla3d", TETRAHEDRA | MIXED | POLYHEDRA},
    {"octree-repair", MIXED},
    {"tet-stats", TETRAHEDRA},
    {"jens-stats", TETRAHEDRA | MIXED},
    {"poly-stats", POLYHEDRA},
    {"mesh-check", SURFACE | CELLS | PART},
    {"mesh-view", ALL},
    {"abaqus-export", POINTS | SURFACE | TETRAHEDRA | MIXED},
    {"getfem-export", SURFACE | TETRAHEDRA | MIXED},
    {"gmsh-export", POINTS | SURFACE | TETRAHEDRA | MIXED},
    {"m3d-export", TETRAHEDRA | MIXED},
    {"medit-export", POINTS | SURFACE | TETRAHEDRA | MIXED},
    {"mvm-export", TETRAHEDRA | MIXED},
    {"obj-export", SURFACE | CELLS},
    {"oct-export", MIXED},
    {"off-export", SURFACE | CELLS},
    {"openfoam-export", CELLS},
    {"ply-export", SURFACE | CELLS},
    {"stl-export", SURFACE | CELLS},
    {"tetgen-export", POINTS | SURFACE | TETRAHEDRA | PART},
    {"visf-export", ALL},
    {"vtk-export", ALL},
    {"vtu-export", ALL},
};
enum { FILTERS = sizeof table / sizeof table[0] };

static const char *const words[] = {
    [TM_CONTENT_NOTHING] = "nothing",
    [TM_CONTENT_POINTS] = "points (.node alone)",
    [TM_CONTENT_SURFACE] = "a surface (.face)",
    [TM_CONTENT_TETRAHEDRA] = "tetrahedra (.ele)",
    [TM_CONTENT_MIXED] = "mixed elements (.mix)",
    [TM_CONTENT_POLYHEDRA] = "polyhedra (.cell)",
    [TM_CONTENT_POLYHEDRA + 1] = "the part 'surface'",
};
enum { KINDS = sizeof words / sizeof words[0] };

/* The kind that there is. A mesh without any cell, but with the block for them, is of
 * theirs. */
static unsigned kinds_of(const tm_stream *stream)
{
    const tm_content content = tm_content_of(stream);
    unsigned kinds = 1u << content;
    for (unsigned above = content + 1u;
         content < TM_CONTENT_TETRAHEDRA && above <= TM_CONTENT_POLYHEDRA; above++)
        if (tm_content_block(stream, (tm_content)above))
            kinds = 1u << above;
    if (tm_stream_find(stream, "surface.node"))
        kinds |= PART;
    return kinds;
}

/* "tetrahedra (.ele) or mixed elements (.mix)" */
static void append_kinds(tm_text *text, unsigned kinds)
{
    for (unsigned k = 0; k < KINDS; k++) {
        if (!(kinds & 1u << k))
            continue;
        kinds ^= 1u << k;
        tm_text_format(text, "%s%s", words[k],
                       !kinds                ? ""
                       : kinds & (kinds - 1) ? ", "
                                             : " or ");
    }
}

static bool is_exporter(const char *filter)
{
    return strstr(filter, "-export") != NULL;
}

/* "tet-stats, jens-stats and exporters": those that take one of the kinds. */
static void append_filters(tm_text *text, unsigned kinds)
{
    bool first = true, exporters = false;
    for (size_t i = 0; i < FILTERS; i++) {
        if (!(table[i].kinds & kinds))
            continue;
        if (is_exporter(table[i].filter)) {
            exporters = true;
            continue;
        }
        tm_text_format(text, "%s%s", first ? "" : ", ", table[i].filter);
        first = false;
    }
    if (exporters)
        tm_text_string(text, first ? "exporters" : " and exporters");
}

static unsigned kinds_taken_by(const char *filter)
{
    for (size_t i = 0; i < FILTERS; i++)
        if (strcmp(table[i].filter, filter) == 0)
            return table[i].kinds;
    return NOTHING | ALL | PART;
}

tm_status kinds_check(const char *filter, const tm_stream *stream, const char *file,
                      tm_error *error)
{
    const unsigned taken = kinds_taken_by(filter);
    const unsigned there = kinds_of(stream);
    if (taken & there)
        return TM_OK;
    unsigned kind = PART; /* the main one: the last that there is */
    while (!(there & kind) || (kind == PART && there != (NOTHING | PART)))
        kind >>= 1;
    tm_text text = {0};
    tm_text_string(&text, "holds ");
    append_kinds(&text, kind);
    tm_text_format(&text, ", but %s takes ", filter);
    append_kinds(&text, taken);
    if (kind != NOTHING) {
        tm_text_string(&text, " (what it holds is for ");
        append_filters(&text, kind);
        tm_text_string(&text, ")");
    }
    const tm_status status =
        text.failed ? tm_fail_memory(error)
                    : tm_fail_at(error, TM_ERROR_INPUT, file, 0, NULL, "%s", text.byte);
    tm_text_free(&text);
    return status;
}
