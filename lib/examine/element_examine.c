/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "element_examine.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../base/sum.h"
#include "examination_boundary.h"
#include "element_examine_faces.h"
#include "mixed_volume.h"

#include <stdlib.h>

/* Elements that one thread measures at a time. */
enum { CHUNK = TM_CHUNK };

/* What a chunk of elements adds to the examination. */
typedef struct measured {
    size_t kind[TM_ELEMENT_KINDS];
    tm_sum volume;
    tm_defect_list inverted;
    tm_defect_list degenerate;
} measured;

typedef struct measuring {
    const tm_mesh_view *mesh;
    int8_t *sign;    /* [elements]: see element_examine_faces.h */
    measured *chunk; /* one for each CHUNK of elements */
} measuring;

/* The first node that an element names again, or TM_NONE; of a tetrahedron its first one
 * before the others. */
static uint32_t node_twice(const uint32_t *n, size_t k)
{
    if (k == TM_TET_NODES && n[0] == n[3])
        return n[0];
    for (size_t i = 1; i < k; i++)
        for (size_t j = 0; j < i; j++)
            if (n[i] == n[j])
                return n[i];
    return TM_NONE;
}

static int8_t measure(measured *m, const tm_mesh_view *mesh, uint32_t e)
{
    size_t k;
    const uint32_t *n = tm_mesh_view_nodes(mesh, e, &k), twice = node_twice(n, k);
    m->kind[tm_element_shapes[k].kind]++;
    if (twice != TM_NONE) {
        tm_defect_add(&m->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){e, twice});
        return TM_NODE_TWICE;
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

void tm_element_measures_free(tm_element_measures *measures)
{
    free(measures->sign);
    free(measures->volume);
}

tm_status tm_element_measure(tm_examination *found, const tm_mesh_view *mesh,
                             tm_element_measures *measures, unsigned threads,
                             tm_error *error)
{
    const size_t chunks = tm_parallel_chunks(mesh->elements, CHUNK);
    *measures =
        (tm_element_measures){.chunks = chunks,
                              .sign = tm_new(mesh->elements, sizeof *measures->sign),
                              .volume = tm_new(chunks, sizeof *measures->volume)};
    measuring m = {mesh, measures->sign, tm_new(chunks, sizeof *m.chunk)};
    if (!measures->sign || !measures->volume || !m.chunk) {
        free(m.chunk);
        return tm_fail_memory(error);
    }
    tm_parallel(threads, chunks, measure_chunk, &m);
    for (size_t i = 0; i < chunks; i++) {
        for (size_t k = 0; k < TM_ELEMENT_KINDS; k++)
            found->kind[k] += m.chunk[i].kind[k];
        measures->volume[i] = m.chunk[i].volume;
        tm_defect_add_list(&found->defect[TM_INVERTED], &m.chunk[i].inverted);
        tm_defect_add_list(&found->defect[TM_DEGENERATE], &m.chunk[i].degenerate);
    }
    free(m.chunk);
    return TM_OK;
}

tm_examination tm_element_examination(bool mixed, size_t nodes, size_t elements)
{
    return (tm_examination){.element = mixed ? "element" : "tetrahedron",
                            .elements = mixed ? "elements" : "tetrahedra",
                            .mixed = mixed,
                            .nodes = nodes,
                            .element_count = elements};
}

/* What is looked at once the boundary is known, each on a thread. */
typedef struct rest {
    tm_examination *found;
    const tm_mesh_view *mesh;
    const tm_walked *walked;
    struct looked_at {
        tm_status status;
        tm_error error;
    } part[3];
} rest;

static void examine_part(void *context, size_t i)
{
    rest *r = context;
    struct looked_at *part = &r->part[i];
    const tm_walked *w = r->walked;
    const size_t nodes = r->mesh->nodes;
    if (i == 0)
        part->status = tm_examine_nodes(r->found, r->mesh->xyz, nodes, &part->error);
    else if (i == 1)
        part->status = tm_examine_boundary(r->found, nodes, w->first, w->past,
                                           (const uint32_t(*)[4])w->boundary.node,
                                           w->boundary.count, &part->error);
    else
        part->status = tm_element_examine_nonconforming(r->found, &w->boundary, w->first,
                                                        w->past, &part->error);
}

static tm_status examine_rest(rest *r, unsigned threads, tm_error *error)
{
    const size_t parts = sizeof r->part / sizeof *r->part;
    threads = tm_threads_for(threads, threads, r->mesh->elements);
    tm_parallel(threads, parts, examine_part, r);
    for (size_t i = 0; i < parts; i++)
        if (r->part[i].status != TM_OK)
            return tm_fail_as(error, &r->part[i].error);
    return TM_OK;
}

/* Components, nodes in use, the area. */
static void count(tm_examination *found, const tm_mesh_view *mesh, const int8_t *sign,
                  const tm_walked *walked)
{
    tm_sum area = {0};
    for (size_t v = 0; v < mesh->nodes; v++)
        found->unused_nodes += !walked->used[v];
    found->euler += (int64_t)(mesh->nodes - found->unused_nodes);
    for (uint32_t e = 0; e < mesh->elements; e++) {
        found->components += sign[e] != TM_NODE_TWICE && walked->parent[e] == e;
        found->euler -= sign[e] != TM_NODE_TWICE;
    }
    tm_add_boundary_area(&area, mesh->xyz, (const uint32_t(*)[4])walked->boundary.node,
                         walked->boundary.count);
    found->area = tm_sum_value(area);
}

tm_status tm_element_examine(tm_examination *found, const tm_mesh_view *mesh,
                             unsigned threads, tm_error *error)
{
    *found = tm_element_examination(mesh->start, mesh->nodes, mesh->elements);
    tm_element_measures measures;
    tm_walked walked = {.past = (uint32_t)mesh->nodes};
    tm_status status = tm_element_measure(found, mesh, &measures, threads, error);
    if (status == TM_OK) {
        found->volume = tm_sum_all(measures.volume, measures.chunks);
        status =
            tm_element_examine_faces(found, mesh, measures.sign, &walked, threads, error);
    }
    if (status == TM_OK)
        count(found, mesh, measures.sign, &walked);
    tm_element_measures_free(&measures);
    rest r = {.found = found, .mesh = mesh, .walked = &walked};
    if (status == TM_OK)
        status = examine_rest(&r, threads, error);
    tm_walked_free(&walked);
    return status;
}
