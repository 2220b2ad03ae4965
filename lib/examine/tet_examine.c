/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_examine.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../base/sum.h"
#include "../geom/predicates.h"
#include "../geom/vector.h"
#include "examination_boundary.h"
#include "tet_examine_faces.h"
#include "../mesh/face_order.h"

#include <stdlib.h>

/* Tetrahedra that one thread measures at a time. */
enum { CHUNK = 8192 };

/* Half faces and rows of .face share 32 bits in face_order.h. */
static const size_t most_tets = TM_FACE_ORDER_ADDED / 4;
static const size_t most_faces = TM_FACE_ORDER_ADDED - 1;

/* What a chunk of tetrahedra adds to the examination. */
typedef struct measured {
    tm_sum volume;
    tm_defect_list inverted;
    tm_defect_list degenerate;
} measured;

typedef struct measuring {
    const tm_tet_arrays *mesh;
    int8_t *sign;    /* [tets]: see tet_examine_faces.h */
    measured *chunk; /* one for each CHUNK of tetrahedra */
} measuring;

/* The node that a tetrahedron names twice, or TM_NONE. */
static uint32_t node_twice(const uint32_t n[4])
{
    if (n[0] == n[1] || n[0] == n[2] || n[0] == n[3])
        return n[0];
    if (n[1] == n[2] || n[1] == n[3])
        return n[1];
    return n[2] == n[3] ? n[2] : TM_NONE;
}

static int8_t measure(measured *m, const tm_tet_arrays *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t], twice = node_twice(n);
    if (twice != TM_NONE) {
        tm_defect_add(&m->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){t, twice});
        return TM_TET_NODE_TWICE;
    }
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]];
    const double *c = mesh->xyz[n[2]], *d = mesh->xyz[n[3]];
    tm_sum_add(&m->volume, tm_tet_volume(a, b, c, d));
    const int sign = tm_orient3d(a, b, c, d);
    if (sign < 0)
        tm_defect_add(&m->inverted, (uint32_t[TM_DEFECT_NUMBERS]){t});
    else if (sign == 0)
        tm_defect_add(&m->degenerate, (uint32_t[TM_DEFECT_NUMBERS]){t, TM_NONE});
    return (int8_t)sign;
}

static void measure_chunk(void *context, size_t chunk)
{
    const measuring *m = context;
    const size_t first = chunk * CHUNK, left = m->mesh->tets - first;
    const size_t end = first + (left < CHUNK ? left : CHUNK);
    measured sum = {.volume = {0}};
    for (size_t t = first; t < end; t++)
        m->sign[t] = measure(&sum, m->mesh, (uint32_t)t);
    m->chunk[chunk] = sum;
}

/* Volumes and their signs. */
static tm_status examine_volumes(tm_examination *found, const tm_tet_arrays *mesh,
                                 int8_t *sign, unsigned threads, tm_error *error)
{
    const size_t chunks = mesh->tets / CHUNK + (mesh->tets % CHUNK != 0);
    measuring m = {mesh, sign, tm_new(chunks, sizeof *m.chunk)};
    if (!m.chunk)
        return tm_fail_memory(error);
    tm_parallel(threads, chunks, measure_chunk, &m);
    tm_sum volume = {0};
    for (size_t i = 0; i < chunks; i++) {
        tm_sum_add(&volume, m.chunk[i].volume.high);
        tm_sum_add(&volume, m.chunk[i].volume.low);
        tm_defect_add_list(&found->defect[TM_INVERTED], &m.chunk[i].inverted);
        tm_defect_add_list(&found->defect[TM_DEGENERATE], &m.chunk[i].degenerate);
    }
    found->volume = tm_sum_value(volume);
    free(m.chunk);
    return TM_OK;
}

static tm_status check_size(const tm_tet_arrays *mesh, tm_error *error)
{
    if (mesh->tets >= most_tets)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".ele",
                          "more than %zu tetrahedra", most_tets - 1);
    if (mesh->faces >= most_faces)
        return tm_fail_at(error, TM_ERROR_SYSTEM, NULL, 0, ".face",
                          "more than %zu triangles", most_faces - 1);
    return TM_OK;
}

tm_tet_arrays tm_tet_arrays_of(const tm_stream *stream)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    const tm_block *face = tm_stream_find(stream, ".face");
    const tm_block *edge = tm_stream_find(stream, ".edge");
    tm_tet_arrays mesh = {0};
    if (node) {
        mesh.nodes = node->count;
        mesh.xyz = (const double(*)[3])node->real;
    }
    if (ele) {
        mesh.tets = ele->count;
        mesh.tet = (const uint32_t(*)[4])ele->integer;
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

tm_status tm_tet_examine(tm_examination *found, const tm_tet_arrays *mesh,
                         unsigned threads, tm_error *error)
{
    *found = (tm_examination){.element = "tetrahedron",
                              .elements = "tetrahedra",
                              .nodes = mesh->nodes,
                              .element_count = mesh->tets};
    tm_status status = check_size(mesh, error);
    if (status != TM_OK)
        return status;
    int8_t *sign = tm_new(mesh->tets, sizeof *sign);
    if (!sign)
        return tm_fail_memory(error);
    tm_boundary_faces boundary = {0};
    status = examine_volumes(found, mesh, sign, threads, error);
    if (status == TM_OK)
        status = tm_tet_examine_faces(found, mesh, sign, &boundary, error);
    free(sign);
    if (status == TM_OK)
        status = tm_examine_boundary(found, mesh->xyz, mesh->nodes,
                                     (const uint32_t *)boundary.node, 3, boundary.count,
                                     error);
    free(boundary.node);
    if (status == TM_OK)
        status = tm_examine_nodes(found, mesh->xyz, mesh->nodes, error);
    return status;
}
