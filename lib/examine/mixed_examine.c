/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mixed_examine.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../base/sum.h"
#include "examination_boundary.h"
#include "mixed_examine_faces.h"
#include "../mesh/mixed_face_order.h"
#include "../element/shape.h"
#include "mixed_volume.h"

#include <stdlib.h>

/* Elements that one thread measures at a time. */
enum { CHUNK = 8192 };

/* Half faces and rows share 32 bits in mixed_face_order.h. */
static const size_t most_elements = TM_MIXED_ROW / 8;
static const size_t most_rows = TM_MIXED_ROW;

/* What a chunk of elements adds to the examination. */
typedef struct measured {
    size_t kind[TM_ELEMENT_KINDS];
    tm_sum volume;
    tm_defect_list inverted;
    tm_defect_list degenerate;
} measured;

typedef struct measuring {
    const tm_mixed_arrays *mesh;
    int8_t *sign;    /* [elements]: see mixed_face_order.h */
    measured *chunk; /* one for each CHUNK of elements */
} measuring;

/* The first node that an element names twice, or TM_NONE. */
static uint32_t node_twice(const uint32_t *n, size_t k)
{
    for (size_t i = 1; i < k; i++)
        for (size_t j = 0; j < i; j++)
            if (n[i] == n[j])
                return n[i];
    return TM_NONE;
}

static int8_t measure(measured *m, const tm_mixed_arrays *mesh, uint32_t e)
{
    const size_t k = mesh->start[e + 1] - mesh->start[e];
    const uint32_t *n = mesh->item + mesh->start[e], twice = node_twice(n, k);
    m->kind[tm_element_shapes[k].kind]++;
    if (twice != TM_NONE) {
        tm_defect_add(&m->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){e, twice});
        return TM_MIXED_NODE_TWICE;
    }
    tm_sum_add(&m->volume, tm_mixed_volume(mesh->xyz, n, k));
    const tm_mixed_corners corner = tm_mixed_corners_of(mesh->xyz, n, k);
    if (corner.negative > 0)
        tm_defect_add(&m->inverted, (uint32_t[TM_DEFECT_NUMBERS]){e});
    else if (corner.zero > 0)
        tm_defect_add(&m->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){e, TM_NONE});
    return (int8_t)((corner.negative == 0 && corner.positive > 0) -
                    (corner.positive == 0 && corner.negative > 0));
}

static void measure_chunk(void *context, size_t chunk)
{
    const measuring *m = context;
    const size_t first = chunk * CHUNK, left = m->mesh->elements - first;
    const size_t end = first + (left < CHUNK ? left : CHUNK);
    measured sum = {.volume = {0}};
    for (size_t e = first; e < end; e++)
        m->sign[e] = measure(&sum, m->mesh, (uint32_t)e);
    m->chunk[chunk] = sum;
}

/* Kinds, volumes and corners. */
static tm_status examine_elements(tm_examination *found, const tm_mixed_arrays *mesh,
                                  int8_t *sign, unsigned threads, tm_error *error)
{
    const size_t chunks = mesh->elements / CHUNK + (mesh->elements % CHUNK != 0);
    measuring m = {mesh, sign, tm_new(chunks, sizeof *m.chunk)};
    if (!m.chunk)
        return tm_fail_memory(error);
    tm_parallel(threads, chunks, measure_chunk, &m);
    tm_sum volume = {0};
    for (size_t i = 0; i < chunks; i++) {
        for (size_t k = 0; k < TM_ELEMENT_KINDS; k++)
            found->kind[k] += m.chunk[i].kind[k];
        tm_sum_add(&volume, m.chunk[i].volume.high);
        tm_sum_add(&volume, m.chunk[i].volume.low);
        tm_defect_add_list(&found->defect[TM_INVERTED], &m.chunk[i].inverted);
        tm_defect_add_list(&found->defect[TM_DEGENERATE], &m.chunk[i].degenerate);
    }
    found->volume = tm_sum_value(volume);
    free(m.chunk);
    return TM_OK;
}

static tm_status check_size(const tm_mixed_arrays *mesh, tm_error *error)
{
    if (mesh->elements >= most_elements)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".mix",
                          "more than %zu elements", most_elements - 1);
    if (mesh->faces + mesh->facets >= most_rows)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".facet",
                          "more than %zu rows, with those of .face", most_rows - 1);
    return TM_OK;
}

tm_mixed_arrays tm_mixed_arrays_of(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *mix = tm_stream_find(stream, ".mix");
    const tm_block *face = tm_stream_find(stream, ".face");
    const tm_block *edge = tm_stream_find(stream, ".edge");
    const tm_block *facet = tm_stream_find(stream, ".facet");
    tm_mixed_arrays mesh = {0};
    if (node) {
        mesh.nodes = node->count;
        mesh.xyz = (const double(*)[3])node->real;
    }
    if (mix) {
        mesh.elements = mix->count;
        mesh.start = mix->start;
        mesh.item = mix->item;
    }
    if (face) {
        mesh.faces = face->count;
        mesh.face = (const uint32_t(*)[3])face->integer;
    }
    if (edge) {
        mesh.edges = edge->count;
        mesh.edge = (const uint32_t(*)[2])edge->integer;
    }
    if (facet) {
        mesh.facets = facet->count;
        mesh.side = (const uint32_t(*)[2])facet->integer;
        mesh.facet_start = facet->start;
        mesh.facet_node = facet->item;
    }
    return mesh;
}

tm_status tm_mixed_examine(tm_examination *found, const tm_mixed_arrays *mesh,
                           unsigned threads, tm_error *error)
{
    *found = (tm_examination){.element = "element",
                              .elements = "elements",
                              .mixed = true,
                              .nodes = mesh->nodes,
                              .element_count = mesh->elements};
    tm_status status = check_size(mesh, error);
    if (status != TM_OK)
        return status;
    int8_t *sign = tm_new(mesh->elements, sizeof *sign);
    if (!sign)
        return tm_fail_memory(error);
    tm_mixed_boundary boundary = {0};
    status = examine_elements(found, mesh, sign, threads, error);
    if (status == TM_OK)
        status = tm_mixed_examine_faces(found, mesh, sign, &boundary, error);
    free(sign);
    if (status == TM_OK)
        status = tm_mixed_examine_nonconforming(found, &boundary, error);
    if (status == TM_OK)
        status = tm_examine_boundary(found, mesh->xyz, mesh->nodes,
                                     (const uint32_t *)boundary.node, 4, boundary.count,
                                     error);
    free(boundary.node);
    if (status == TM_OK)
        status = tm_examine_nodes(found, mesh->xyz, mesh->nodes, error);
    return status;
}
