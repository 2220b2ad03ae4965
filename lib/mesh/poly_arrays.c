/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "poly_arrays.h"

tm_poly_arrays tm_poly_arrays_of(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *facet = tm_stream_find(stream, ".facet");
    const tm_block *cell = tm_stream_find(stream, ".cell");
    tm_poly_arrays mesh = {0};
    if (node) {
        mesh.nodes = node->count;
        mesh.xyz = (const double(*)[3])node->real;
    }
    if (facet) {
        mesh.facets = facet->count;
        mesh.side = (const uint32_t(*)[2])facet->integer;
        mesh.facet_start = facet->start;
        mesh.facet_node = facet->item;
    }
    if (cell) {
        mesh.cells = cell->count;
        mesh.cell_start = cell->start;
        mesh.cell_facet = cell->item;
        mesh.attributes = cell->attributes;
        mesh.attribute = cell->attribute;
    }
    return mesh;
}
