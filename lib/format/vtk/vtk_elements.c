/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_maker.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../examine/mixed_volume.h"
#include "../../mesh/polyhedra.h"
#include "../tetgen.h"

#include <string.h>

/* Which of .cell, .mix and .ele. */
static tm_content find_content(const tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_content content = TM_CONTENT_TETRAHEDRA;
    if (m->volumes == 0)
        return m->others > 0 ? TM_CONTENT_SURFACE : TM_CONTENT_POINTS;
    for (size_t c = 0; c < cells->cells; c++) {
        if (tm_vtk_kept(m, c) != 3 || cells->type[c] == TM_VTK_TETRA)
            continue;
        content = TM_CONTENT_MIXED;
        if (cells->type[c] == TM_VTK_POLYHEDRON ||
            cells->type[c] == TM_VTK_PENTAGONAL_PRISM ||
            cells->type[c] == TM_VTK_HEXAGONAL_PRISM)
            return TM_CONTENT_POLYHEDRA;
    }
    return content;
}

/* Elements -------------------------------------------------------------------------- */

/* A tetrahedron as tm_tetgen_orient() turns it. */
static void turn(uint32_t *node, size_t k)
{
    if (k != TM_TET_NODES) {
        tm_mixed_mirror(node, k);
        return;
    }
    const uint32_t third = node[2];
    node[2] = node[3];
    node[3] = third;
}

static void copy_elements(const tm_vtk_maker *m, uint32_t *to, size_t *start)
{
    const tm_vtk_mesh *cells = m->cells;
    size_t at = 0, e = 0;
    for (size_t c = 0; c < cells->cells; c++) {
        if (tm_vtk_kept(m, c) != 3)
            continue;
        const size_t k = cells->nodes.start[c + 1] - cells->nodes.start[c];
        memcpy(to + at, cells->nodes.item + cells->nodes.start[c], k * sizeof *to);
        at += k;
        if (start)
            start[++e] = at;
    }
}

static tm_status make_tetrahedra(tm_vtk_maker *m)
{
    tm_block *ele = tm_stream_add(m->stream, ".ele");
    if (!ele)
        return tm_fail_memory(m->error);
    const tm_status status = tm_block_allocate(ele, m->volumes, 0, m->error);
    if (status != TM_OK)
        return status;
    copy_elements(m, ele->integer, NULL);
    m->report->turned = tm_tetgen_orient(tm_stream_find(m->stream, ".node"), ele).turned;
    return TM_OK;
}

/* Those of which no corner is right-handed, but one is left-handed: others are bad, not
 * turned. */
static void turn_elements(tm_vtk_maker *m, tm_block *mix)
{
    const tm_block *node = tm_stream_find(m->stream, ".node");
    for (size_t e = 0; e < mix->count; e++) {
        uint32_t *v = mix->item + mix->start[e];
        const size_t k = mix->start[e + 1] - mix->start[e];
        const tm_mixed_corners corners =
            tm_mixed_corners_of((const double(*)[3])node->real, v, k);
        if (corners.negative == 0 || corners.positive > 0)
            continue;
        turn(v, k);
        m->report->turned++;
    }
}

static tm_status make_mixed(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    size_t items = 0;
    for (size_t c = 0; c < cells->cells; c++)
        if (tm_vtk_kept(m, c) == 3)
            items += cells->nodes.start[c + 1] - cells->nodes.start[c];
    tm_block *mix = tm_stream_add(m->stream, ".mix");
    if (!mix)
        return tm_fail_memory(m->error);
    const tm_status status = tm_block_allocate(mix, m->volumes, items, m->error);
    if (status != TM_OK)
        return status;
    copy_elements(m, mix->item, mix->start);
    turn_elements(m, mix);
    return TM_OK;
}

/* Polyhedra ------------------------------------------------------------------------- */

typedef struct polyhedra {
    tm_lists polygons, cells;
} polyhedra;

/* Appends a polygon to the cell that is being made of k so far. */
static bool add_polygon(polyhedra *p, const uint32_t *node, size_t nodes, size_t *k)
{
    uint32_t *to = tm_lists_room(&p->polygons, nodes);
    if (!to)
        return false;
    memcpy(to, node, nodes * sizeof *to);
    uint32_t *face = tm_lists_room(&p->cells, *k + 1);
    if (!face)
        return false;
    face[(*k)++] = (uint32_t)p->polygons.count;
    return tm_lists_end(&p->polygons, nodes);
}

static bool add_element(polyhedra *p, const uint32_t *v, size_t nodes, size_t *k)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    bool done = true;
    for (size_t i = 0; i < shape->faces && done; i++) {
        uint32_t face[4];
        for (size_t j = 0; j < 4; j++)
            face[j] = v[shape->face[i][j]];
        done = add_polygon(p, face, tm_mixed_face_nodes(shape->face[i]), k);
    }
    return done;
}

/* The base, the top, and a quadrilateral at each edge of them. */
static bool add_prism(polyhedra *p, const uint32_t *v, size_t nodes, size_t *k)
{
    const size_t sides = nodes / 2;
    bool done = add_polygon(p, v, sides, k) && add_polygon(p, v + sides, sides, k);
    for (size_t i = 0; i < sides && done; i++) {
        const size_t next = (i + 1) % sides;
        const uint32_t face[] = {v[i], v[next], v[sides + next], v[sides + i]};
        done = add_polygon(p, face, sizeof face / sizeof *face, k);
    }
    return done;
}

static bool add_cell(polyhedra *p, const tm_vtk_mesh *cells, size_t c)
{
    const uint32_t *v = cells->nodes.item + cells->nodes.start[c];
    const size_t nodes = cells->nodes.start[c + 1] - cells->nodes.start[c];
    size_t k = 0;
    bool done = true;
    if (cells->type[c] == TM_VTK_PENTAGONAL_PRISM ||
        cells->type[c] == TM_VTK_HEXAGONAL_PRISM)
        done = add_prism(p, v, nodes, &k);
    else if (cells->type[c] != TM_VTK_POLYHEDRON)
        done = add_element(p, v, nodes, &k);
    for (size_t i = cells->faces.start[c]; i < cells->faces.start[c + 1] && done;
         i += 1 + cells->faces.item[i])
        done = add_polygon(p, cells->faces.item + i + 1, cells->faces.item[i], &k);
    return done && tm_lists_end(&p->cells, k);
}

static tm_status check_polyhedron(const tm_vtk_maker *m, size_t c)
{
    const tm_vtk_mesh *cells = m->cells;
    if (cells->type[c] == TM_VTK_POLYHEDRON &&
        cells->faces.start[c] == cells->faces.start[c + 1])
        return tm_fail_at(m->error, TM_ERROR_INPUT, cells->name, 0, NULL,
                          "cell %zu is a polyhedron without faces", c);
    return TM_OK;
}

static tm_status make_polyhedra(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    polyhedra p = {0};
    tm_polyhedra_repairs repairs = {0};
    tm_status status = tm_lists_begin(&p.polygons) && tm_lists_begin(&p.cells)
                           ? TM_OK
                           : tm_fail_memory(m->error);
    for (size_t c = 0; c < cells->cells && status == TM_OK; c++) {
        if (tm_vtk_kept(m, c) != 3)
            continue;
        status = check_polyhedron(m, c);
        if (status == TM_OK && p.polygons.count >= INT32_MAX)
            status = tm_fail(m->error, TM_ERROR_SYSTEM, "more faces than 31 bits number");
        if (status == TM_OK && !add_cell(&p, cells, c))
            status = tm_fail_memory(m->error);
    }
    if (status == TM_OK)
        status = tm_polyhedra_to_stream(m->stream, &p.polygons, &p.cells, cells->name,
                                        &repairs, m->error);
    m->report->polygons_joined = repairs.joined;
    tm_lists_free(&p.polygons);
    tm_lists_free(&p.cells);
    return status;
}

tm_status tm_vtk_make_elements(tm_vtk_maker *m)
{
    m->content = find_content(m);
    switch (m->content) {
    case TM_CONTENT_TETRAHEDRA:
        return make_tetrahedra(m);
    case TM_CONTENT_MIXED:
        return make_mixed(m);
    case TM_CONTENT_POLYHEDRA:
        return make_polyhedra(m);
    default:
        return TM_OK;
    }
}
