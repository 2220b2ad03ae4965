/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_view.h"

/* All but the elements. */
static tm_mesh_view without_elements(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *face = tm_stream_find(stream, ".face");
    const tm_block *edge = tm_stream_find(stream, ".edge");
    tm_mesh_view mesh = {0};
    if (node) {
        mesh.nodes = node->count;
        mesh.xyz = (const double(*)[3])node->real;
    }
    if (face) {
        mesh.faces = face->count;
        mesh.face = (const uint32_t(*)[3])face->integer;
    }
    if (edge) {
        mesh.edges = edge->count;
        mesh.edge = (const uint32_t(*)[2])edge->integer;
    }
    return mesh;
}

tm_mesh_view tm_mesh_view_of_tets(const tm_stream *stream)
{
    const tm_block *ele = tm_stream_find(stream, ".ele");
    tm_mesh_view mesh = without_elements(stream);
    if (ele) {
        mesh.elements = ele->count;
        mesh.item = ele->integer;
    }
    return mesh;
}

tm_mesh_view tm_mesh_view_of_mixed(const tm_stream *stream)
{
    static const size_t none = 0;
    const tm_block *mix = tm_stream_find(stream, ".mix");
    const tm_block *facet = tm_stream_find(stream, ".facet");
    tm_mesh_view mesh = without_elements(stream);
    mesh.start = &none;
    if (mix && mix->count > 0) {
        mesh.elements = mix->count;
        mesh.start = mix->start;
        mesh.item = mix->item;
    }
    if (facet) {
        mesh.facets = facet->count;
        mesh.side = (const uint32_t(*)[2])facet->integer;
        mesh.facet_start = facet->start;
        mesh.facet_node = facet->item;
    }
    return mesh;
}
