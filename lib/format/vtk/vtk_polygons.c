/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "vtk_maker.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../mesh/face_table.h"
#include "../../mesh/polygon_table.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLE = 3, LINE = 2 };

static size_t nodes_of(const tm_vtk_mesh *cells, size_t c)
{
    return cells->nodes.start[c + 1] - cells->nodes.start[c];
}

/* A block of so many rows and items, with markers where cells have them. */
static tm_status add_block(tm_vtk_maker *m, const char *name, size_t rows, size_t items,
                           tm_block **block)
{
    *block = tm_stream_add(m->stream, name);
    if (!*block)
        return tm_fail_memory(m->error);
    (*block)->markers = m->roles.marker != TM_VTK_NO_ARRAY;
    return tm_block_allocate(*block, rows, items, m->error);
}

/* Triangles ------------------------------------------------------------------------- */

/* How many rows of .face a polygon is: beside tetrahedra only a triangle is one; a strip
 * is its triangles, alternately turned. */
static size_t rows_of(const tm_vtk_maker *m, size_t c)
{
    const size_t k = nodes_of(m->cells, c);
    if (m->content == TM_CONTENT_SURFACE || m->cells->type[c] == TM_VTK_STRIP)
        return k - 2;
    return k == TRIANGLE;
}

/* Row `row` of .face is triangle i of polygon c. */
static void set_triangle(const tm_vtk_maker *m, tm_block *face, size_t row, size_t c,
                         size_t i)
{
    const uint32_t *v = m->cells->nodes.item + m->cells->nodes.start[c];
    uint32_t *to = face->integer + TRIANGLE * row;
    const bool strip = m->cells->type[c] == TM_VTK_STRIP;
    const size_t odd = strip ? i % 2 : 0;
    to[0] = v[strip ? i : 0];
    to[1] = v[i + 1 + odd];
    to[2] = v[i + 2 - odd];
    if (face->marker)
        face->marker[row] = tm_vtk_marker(m, c);
}

static tm_status make_triangles(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *face;
    size_t rows = 0, row = 0;
    for (size_t c = 0; c < cells->cells; c++) {
        if (tm_vtk_kept(m, c) != 2)
            continue;
        const size_t of_cell = rows_of(m, c);
        rows += of_cell;
        m->report->loose += of_cell == 0;
        m->report->cut += of_cell > 1;
    }
    const tm_status status = add_block(m, ".face", rows, 0, &face);
    for (size_t c = 0; c < cells->cells && status == TM_OK; c++)
        for (size_t i = 0; tm_vtk_kept(m, c) == 2 && i < rows_of(m, c); i++)
            set_triangle(m, face, row++, c, i);
    return status;
}

/* Faces of mixed elements ------------------------------------------------------------ */

static tm_status copy_polygons(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    size_t items = 0, row = 0;
    tm_block *facet;
    for (size_t c = 0; c < cells->cells; c++)
        items += tm_vtk_kept(m, c) == 2 ? nodes_of(cells, c) : 0;
    const tm_status status = add_block(m, ".facet", m->others, items, &facet);
    for (size_t c = 0; c < cells->cells && status == TM_OK; c++) {
        if (tm_vtk_kept(m, c) != 2)
            continue;
        const size_t k = nodes_of(cells, c), at = facet->start[row];
        memcpy(facet->item + at, cells->nodes.item + cells->nodes.start[c],
               k * sizeof *facet->item);
        if (facet->marker)
            facet->marker[row] = tm_vtk_marker(m, c);
        facet->start[++row] = at + k;
    }
    return status;
}

/* The sides of a row that is the face of half and of its mate: the first is that which
 * the row is outward for, or on the boundary the row is turned. */
static void set_sides(const tm_mesh_view *view, tm_block *facet, size_t row,
                      uint32_t half, uint32_t mate)
{
    uint32_t face[4], *side = facet->integer + 2 * row;
    const size_t k = tm_half_face_nodes(view, half, face);
    const uint32_t e = half / TM_ELEMENT_NODES;
    side[0] = e;
    side[1] = mate == half || mate == TM_NONE ? TM_NONE : mate / TM_ELEMENT_NODES;
    if (tm_polygon_compare(facet->item + facet->start[row], face, k) >= 0)
        return;
    if (side[1] == TM_NONE) {
        tm_polygon_turn(facet->item + facet->start[row], k);
        return;
    }
    side[0] = side[1];
    side[1] = e;
}

/* Keeps the rows that are a face of an element. */
static void drop_loose(tm_vtk_maker *m, tm_block *facet, const uint32_t *half_of)
{
    size_t kept = 0, end = 0;
    for (size_t row = 0; row < facet->count; row++) {
        const size_t begin = facet->start[row], k = facet->start[row + 1] - begin;
        if (half_of[row] == TM_NONE) {
            m->report->loose++;
            continue;
        }
        memmove(facet->item + end, facet->item + begin, k * sizeof *facet->item);
        memcpy(facet->integer + 2 * kept, facet->integer + 2 * row,
               2 * sizeof *facet->integer);
        if (facet->marker)
            facet->marker[kept] = facet->marker[row];
        facet->start[kept++] = end;
        end += k;
    }
    facet->start[kept] = end;
    facet->count = kept;
}

static tm_status make_facets(tm_vtk_maker *m)
{
    tm_status status = copy_polygons(m);
    if (status != TM_OK)
        return status;
    const tm_mesh_view view = tm_mesh_view_of_mixed(m->stream);
    tm_block *facet = tm_stream_find(m->stream, ".facet");
    const size_t halves = tm_half_faces(&view);
    uint32_t *mate = NULL;
    status = tm_face_mates(&mate, &view, m->error);
    for (size_t row = 0; status == TM_OK && row < facet->count; row++) {
        const uint32_t half = mate[halves + row];
        if (half != TM_NONE)
            set_sides(&view, facet, row, half, mate[half]);
    }
    if (status == TM_OK)
        drop_loose(m, facet, mate + halves);
    free(mate);
    return status;
}

/* Facets of polyhedra -----------------------------------------------------------------
 */

static tm_status mark_facets(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *facet = tm_stream_find(m->stream, ".facet");
    tm_polygon_table table = {0};
    uint32_t first;
    bool done = true;
    if (m->roles.marker != TM_VTK_NO_ARRAY)
        facet->marker = calloc(facet->count + 1, sizeof *facet->marker);
    facet->markers = facet->marker != NULL;
    if (m->roles.marker != TM_VTK_NO_ARRAY && !facet->marker)
        return tm_fail_memory(m->error);
    for (uint32_t f = 0; f < facet->count && done; f++)
        done = tm_polygon_table_join(&table, facet->start, facet->item, f, &first);
    for (size_t c = 0; c < cells->cells && done; c++) {
        if (tm_vtk_kept(m, c) != 2)
            continue;
        const uint32_t f = tm_polygon_table_find(
            &table, facet->start, facet->item, cells->nodes.item + cells->nodes.start[c],
            nodes_of(cells, c));
        m->report->loose += f == UINT32_MAX;
        if (f != UINT32_MAX && facet->marker)
            facet->marker[f] = tm_vtk_marker(m, c);
    }
    tm_polygon_table_free(&table);
    return done ? TM_OK : tm_fail_memory(m->error);
}

tm_status tm_vtk_make_polygons(tm_vtk_maker *m)
{
    if (m->others == 0)
        return TM_OK;
    if (m->content == TM_CONTENT_MIXED)
        return make_facets(m);
    return m->content == TM_CONTENT_POLYHEDRA ? mark_facets(m) : make_triangles(m);
}

/* Lines -------------------------------------------------------------------------------
 */

tm_status tm_vtk_make_lines(tm_vtk_maker *m)
{
    const tm_vtk_mesh *cells = m->cells;
    tm_block *edge;
    size_t rows = 0, row = 0;
    for (size_t c = 0; c < cells->cells; c++)
        rows += tm_vtk_kept(m, c) == 1 ? nodes_of(cells, c) - 1 : 0;
    if (rows == 0)
        return TM_OK;
    const tm_status status = add_block(m, ".edge", rows, 0, &edge);
    for (size_t c = 0; c < cells->cells && status == TM_OK; c++)
        for (size_t i = 1; tm_vtk_kept(m, c) == 1 && i < nodes_of(cells, c); i++, row++) {
            const uint32_t *v = cells->nodes.item + cells->nodes.start[c] + i - 1;
            memcpy(edge->integer + LINE * row, v, LINE * sizeof *v);
            if (edge->marker)
                edge->marker[row] = tm_vtk_marker(m, c);
        }
    return status;
}
