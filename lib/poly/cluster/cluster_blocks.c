/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Clusters as blocks of a stream, one level or many. */
#include "clusters.h"

#include "../../base/array.h"
#include "../facets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The facets between clusters by the lesser one: list[] of how many it returns; NULL
 * where memory is out. */
static uint32_t *find_borders(const tm_cell_faces *faces, const uint32_t *label,
                              size_t clusters, size_t *count, size_t *corners)
{
    size_t *end = calloc(clusters + 2, sizeof *end);
    uint32_t *list = tm_new(faces->facets, sizeof *list);
    *count = *corners = 0;
    for (int pass = 0; pass < 2 && end && list; pass++) {
        for (uint32_t f = 0; f < faces->facets; f++) {
            const uint32_t *side = faces->side[f];
            uint32_t a = side[0] == TM_NONE ? TM_NONE : label[side[0]];
            uint32_t b = side[1] == TM_NONE ? TM_NONE : label[side[1]];
            if (a == b)
                continue;
            a = a < b ? a : b;
            if (pass == 0)
                end[a + 2]++;
            else
                list[end[a + 1]++] = f;
            *count += pass == 0;
            *corners += pass == 0 ? faces->start[f + 1] - faces->start[f] : 0;
        }
        for (size_t c = 0; c < clusters && pass == 0; c++)
            end[c + 2] += end[c + 1];
    }
    if (!end) {
        free(list);
        list = NULL;
    }
    free(end);
    return list;
}

static void write_facets(const tm_cell_faces *faces, const uint32_t *label,
                         const uint32_t *list, tm_block *facet)
{
    for (size_t k = 0; k < facet->count; k++) {
        const uint32_t f = list[k];
        const uint32_t *side = faces->side[f];
        const uint32_t a = label[side[0]];
        const uint32_t b = side[1] == TM_NONE ? TM_NONE : label[side[1]];
        const size_t start = facet->start[k], from = faces->start[f];
        const size_t count = faces->start[f + 1] - from;
        facet->integer[2 * k] = a < b ? a : b;
        facet->integer[2 * k + 1] = a < b ? b : a;
        for (size_t i = 0; i < count; i++)
            facet->item[start + i] =
                faces->node[from + (a < b ? i : (count - i) % count)];
        facet->start[k + 1] = start + count;
        if (facet->markers)
            facet->marker[k] = faces->marker[f];
    }
}

/* The attributes of clusters: how many tetrahedra they are of, if cells say it. */
static void sum_attributes(const tm_cluster_mesh *mesh, const uint32_t *label,
                           tm_block *cell)
{
    const size_t from = mesh->attributes, to = cell->attributes;
    for (size_t c = 0; c < mesh->faces->cells; c++) {
        double *row = cell->attribute + label[c] * to;
        const double *own = mesh->attribute + c * from;
        if (row[0] == 0 && from > 1)
            memcpy(row + 1, own + 1, (from - 1) * sizeof *row);
        row[0] += from > 0 && own[0] >= 1 ? own[0] : 1;
    }
}

tm_status tm_cluster_blocks(const tm_cluster_mesh *mesh, const uint32_t *label,
                            size_t clusters, tm_block *facet, tm_block *cell,
                            tm_error *error)
{
    size_t count, corners;
    uint32_t *list = find_borders(mesh->faces, label, clusters, &count, &corners);
    facet->markers = mesh->faces->marker;
    cell->attributes = mesh->attributes > 0 ? mesh->attributes : 1;
    tm_status status =
        list ? tm_block_allocate(facet, count, corners, error) : tm_fail_memory(error);
    if (status == TM_OK) {
        write_facets(mesh->faces, label, list, facet);
        status = tm_cells_from_facets(facet, cell, clusters, error);
    }
    if (status == TM_OK)
        sum_attributes(mesh, label, cell);
    free(list);
    return status;
}

/* One more attribute of cells: their parents' numbers. The second one would be a region:
 * so that is there, too. */
static tm_status add_parents(tm_block *cell, const uint32_t *parent, unsigned base,
                             tm_error *error)
{
    double *number = calloc(cell->count + 1, sizeof *number);
    tm_status status = number ? TM_OK : tm_fail_memory(error);
    while (status == TM_OK && cell->attributes < 2)
        status = tm_block_add_attribute(cell, number, error);
    for (size_t c = 0; c < cell->count && number; c++)
        number[c] = (double)parent[c] + base;
    if (status == TM_OK)
        status = tm_block_add_attribute(cell, number, error);
    free(number);
    return status;
}

/* Fills the block of the nodes that facets have, and renumbers these. */
static tm_status take_nodes(const tm_block *all, tm_block *facet, tm_block *node,
                            tm_error *error)
{
    const size_t corners = facet->start ? facet->start[facet->count] : 0;
    uint32_t *name = tm_new(all->count, sizeof *name);
    size_t count = 0;
    for (size_t v = 0; v < all->count && name; v++)
        name[v] = TM_NONE;
    for (size_t i = 0; i < corners && name; i++)
        name[facet->item[i]] = 0;
    for (size_t v = 0; v < all->count && name; v++)
        if (name[v] != TM_NONE)
            name[v] = (uint32_t)count++;
    tm_status status =
        name ? tm_block_allocate(node, count, 0, error) : tm_fail_memory(error);
    for (size_t v = 0; v < all->count && status == TM_OK; v++)
        if (name[v] != TM_NONE)
            memcpy(node->real + 3 * (size_t)name[v], all->real + 3 * v,
                   3 * sizeof *node->real);
    for (size_t i = 0; i < corners && status == TM_OK; i++)
        facet->item[i] = name[facet->item[i]];
    free(name);
    return status;
}

/* The faces that blocks say; the arrays stay theirs. */
static tm_cell_faces faces_of(const tm_block *facet, const tm_block *cell)
{
    return (tm_cell_faces){.cells = cell->count,
                           .cell_start = cell->start,
                           .cell_facet = cell->item,
                           .facets = facet->count,
                           .side = (uint32_t(*)[2])facet->integer,
                           .start = facet->start,
                           .node = facet->item,
                           .marker = facet->markers ? facet->marker : NULL,
                           .borrowed = true};
}

/* A level: its facets have the nodes of the mesh. */
typedef struct {
    tm_block facet, cell;
} level;

static void free_level(level *l)
{
    tm_block_clear(&l->facet);
    tm_block_clear(&l->cell);
}

/* Puts a level into the stream as a part; what is not put is freed. */
static tm_status put_level(tm_stream *stream, size_t number, level *l, tm_error *error)
{
    tm_block made[3] = {{.kind = TM_NODE}, l->facet, l->cell};
    static const char *const suffix[] = {".node", ".facet", ".cell"};
    tm_status status =
        take_nodes(tm_stream_find(stream, ".node"), &made[1], &made[0], error);
    for (int k = 0; k < 3; k++) {
        snprintf(made[k].name, sizeof made[k].name, "level%zu%s", number, suffix[k]);
        if (status == TM_OK)
            status = tm_stream_put(stream, &made[k], error);
        tm_block_clear(&made[k]);
    }
    return status;
}

/* Joins the cells of one level to the next one; *joined tells whether that has fewer. */
static tm_status make_next(const tm_stream *stream, const level *from, level *to,
                           uint32_t **parent, const tm_poly_options *options,
                           bool ignore_markers, bool *joined, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_cell_faces faces = faces_of(&from->facet, &from->cell);
    const tm_cluster_mesh mesh = {.faces = &faces,
                                  .nodes = node->count,
                                  .xyz = (const double(*)[3])node->real,
                                  .attributes = from->cell.attributes,
                                  .attribute = from->cell.attribute,
                                  .ignore_markers = ignore_markers};
    tm_poly_report report;
    *to = (level){.facet = {.kind = TM_FACET}, .cell = {.kind = TM_CELL}};
    *parent = tm_new(faces.cells, sizeof **parent);
    tm_status status = *parent ? tm_cluster_cells(&mesh, options, *parent, &report, error)
                               : tm_fail_memory(error);
    *joined = status == TM_OK && report.cells < faces.cells;
    if (*joined)
        status =
            tm_cluster_blocks(&mesh, *parent, report.cells, &to->facet, &to->cell, error);
    return status;
}

static bool is_of_level(const tm_block *block, const void *context)
{
    (void)context;
    return strncmp(block->name, "level", strlen("level")) == 0;
}

void tm_cluster_forget_levels(tm_stream *stream)
{
    tm_block *cell = tm_stream_find(stream, ".cell");
    if (cell && cell->attributes > 0 && tm_stream_find(stream, "level1.cell"))
        tm_block_drop_attribute(cell, cell->attributes - 1);
    tm_stream_remove_if(stream, is_of_level, NULL);
}

tm_status tm_cluster_levels(tm_stream *stream, size_t most,
                            const tm_poly_options *options, bool ignore_markers,
                            size_t *levels, tm_error *error)
{
    tm_poly_options own = *options;
    bool joined = true;
    tm_status status = TM_OK;
    tm_cluster_forget_levels(stream);
    level now = {.facet = *tm_stream_find(stream, ".facet"),
                 .cell = *tm_stream_find(stream, ".cell")};
    own.cells = 0;
    own.size = 0;
    for (*levels = 0; *levels < most && status == TM_OK && joined;) {
        uint32_t *parent = NULL;
        level next;
        status =
            make_next(stream, &now, &next, &parent, &own, ignore_markers, &joined, error);
        if (status == TM_OK && joined)
            status = add_parents(&now.cell, parent, stream->base, error);
        free(parent);
        if (*levels == 0)
            *tm_stream_find(stream, ".cell") = now.cell;
        if (status != TM_OK || !joined) {
            free_level(&next);
            break;
        }
        if (*levels > 0)
            status = put_level(stream, *levels, &now, error);
        now = next;
        ++*levels;
    }
    if (*levels == 0)
        return status;
    if (status == TM_OK)
        return put_level(stream, *levels, &now, error);
    free_level(&now);
    return status;
}
