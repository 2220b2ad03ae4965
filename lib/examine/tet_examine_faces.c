/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One walk over the nodes v, each with the faces and edges of which v is the smallest
 * node. Every edge is the smallest two nodes, or the smallest and the largest, of one of
 * its faces, but for that between the two largest nodes of a tetrahedron: those, the
 * top edges, are listed beforehand by their smaller node. */
#include "tet_examine_faces.h"

#include "../base/array.h"
#include "../element/shape.h"
#include "../base/disjoint_sets.h"
#include "../mesh/edge_map.h"
#include "../mesh/face_order.h"

#include <stdlib.h>
#include <string.h>

typedef struct walk {
    const tm_tet_arrays *mesh;
    const int8_t *sign;
    tm_examination *found;
    tm_boundary_faces *boundary;
    tm_face_order order;
    uint32_t *top_start; /* [nodes + 1]: the larger nodes of the top edges of v: */
    uint32_t *top;       /* top[top_start[v] … top_start[v + 1]) */
    uint32_t *parent;    /* [tets]: a forest with a tree for each component */
    uint32_t *stamp;     /* [nodes]: the last v that has an edge to the node; TM_NONE */
    tm_edge_map listed;  /* edges of .edge that were not met yet, with their rows */
    size_t tets;         /* that do not name a node twice */
    size_t joints;       /* of two components into one */
    size_t used_nodes;
    size_t edges;
    size_t faces;
} walk;

/* The tetrahedra at a face, and the rows of .face that list it. */
typedef struct face_run {
    size_t tets;
    uint32_t half[2]; /* of the first two tetrahedra */
    uint32_t row;     /* the first; TM_NONE */
} face_run;

static bool is_whole(const walk *w, size_t t)
{
    return w->sign[t] != TM_TET_NODE_TWICE;
}

static void add_defect(walk *w, tm_defect d, uint32_t first, uint32_t second)
{
    tm_defect_add(&w->found->defect[d], (uint32_t[TM_DEFECT_NUMBERS]){first, second});
}

/* The two largest nodes of a tetrahedron, the larger one second. */
static void top_edge(const uint32_t n[4], uint32_t top[2])
{
    const bool i = n[0] < n[1], j = n[2] < n[3];
    const uint32_t large = n[i], small = n[!i];
    const uint32_t other_large = n[2 + j], other_small = n[2 + !j];
    const bool first = large > other_large;
    const uint32_t rest = first ? small : other_small;
    const uint32_t loser = first ? other_large : large;
    top[1] = first ? large : other_large;
    top[0] = rest > loser ? rest : loser;
}

static bool list_top_edges(walk *w)
{
    const tm_tet_arrays *mesh = w->mesh;
    w->top_start = calloc(mesh->nodes + 2, sizeof *w->top_start);
    w->top = tm_new(mesh->tets, sizeof *w->top);
    if (!w->top_start || !w->top)
        return false;
    /* top_start[v + 2] counts, then top_start[v + 1] is where the next edge of v goes. */
    uint32_t *next = w->top_start + 1, top[2];
    for (size_t t = 0; t < mesh->tets; t++)
        if (is_whole(w, t)) {
            top_edge(mesh->tet[t], top);
            next[top[0] + 1]++;
        }
    for (size_t v = 0; v < mesh->nodes; v++)
        next[v + 1] += next[v];
    for (size_t t = 0; t < mesh->tets; t++)
        if (is_whole(w, t)) {
            top_edge(mesh->tet[t], top);
            w->top[next[top[0]]++] = top[1];
        }
    return true;
}

static bool list_edges(walk *w)
{
    const tm_tet_arrays *mesh = w->mesh;
    if (mesh->edges > 0 && !tm_edge_map_reserve(&w->listed, mesh->edges))
        return false;
    for (uint32_t e = 0; e < mesh->edges; e++) {
        const uint32_t a = mesh->edge[e][0], b = mesh->edge[e][1];
        const uint32_t *earlier = tm_edge_map_get(&w->listed, a, b);
        if (a == b)
            add_defect(w, TM_DANGLING_EDGE, e, 0);
        else if (earlier)
            add_defect(w, TM_REPEATED_EDGE, e, *earlier);
        else
            tm_edge_map_put(&w->listed, a, b, e);
    }
    return true;
}

static bool allocate(walk *w)
{
    const tm_tet_arrays *mesh = w->mesh;
    w->parent = tm_new(mesh->tets, sizeof *w->parent);
    w->stamp = tm_new(mesh->nodes, sizeof *w->stamp);
    if (!w->parent || !w->stamp)
        return false;
    memset(w->stamp, UINT8_MAX, mesh->nodes * sizeof *w->stamp);
    for (uint32_t t = 0; t < mesh->tets; t++) {
        w->parent[t] = t;
        w->tets += is_whole(w, t);
    }
    return true;
}

static void join(walk *w, uint32_t t, uint32_t u)
{
    t = tm_set_root(w->parent, t);
    u = tm_set_root(w->parent, u);
    w->joints += t != u;
    if (t < u)
        w->parent[u] = t;
    else
        w->parent[t] = u;
}

static void meet_edge(walk *w, uint32_t v, uint32_t end)
{
    if (w->stamp[end] == v)
        return;
    w->stamp[end] = v;
    w->edges++;
    tm_edge_map_remove(&w->listed, v, end);
}

/* Whether two tetrahedra name the nodes of their common face in the same sense, seen
 * from outside of a positive one. */
static bool same_sense(const tm_tet_arrays *mesh, uint32_t h, uint32_t g)
{
    const uint32_t *p = mesh->tet[h / 4], *q = mesh->tet[g / 4];
    const uint8_t *i = tm_face_corner[h % 4], *j = tm_face_corner[g % 4];
    const int k = p[i[0]] == q[j[0]] ? 0 : p[i[0]] == q[j[1]] ? 1 : 2;
    return p[i[1]] == q[j[(k + 1) % 3]];
}

static void check_sides(walk *w, uint32_t h, uint32_t g)
{
    const int product = w->sign[h / 4] * w->sign[g / 4];
    if (product != 0 && same_sense(w->mesh, h, g) == (product > 0))
        add_defect(w, TM_OVERLAPPING_FACE, h / 4 < g / 4 ? h / 4 : g / 4,
                   h / 4 < g / 4 ? g / 4 : h / 4);
}

static bool add_boundary_face(walk *w, uint32_t half)
{
    tm_boundary_faces *b = w->boundary;
    void *moved = tm_grow(b->node, &b->room, b->count + 1, sizeof *b->node);
    if (!moved)
        return false;
    b->node = moved;
    for (size_t i = 0; i < 3; i++)
        b->node[b->count][i] = w->mesh->tet[half / 4][tm_face_corner[half % 4][i]];
    b->count++;
    return true;
}

/* Takes one entry of a run of equal faces. */
static void take_entry(walk *w, face_run *run, uint32_t half)
{
    if (half & TM_FACE_ORDER_ADDED) {
        const uint32_t row = half & ~TM_FACE_ORDER_ADDED;
        if (run->row != TM_NONE)
            add_defect(w, TM_REPEATED_FACE, row, run->row);
        else
            run->row = row;
    } else if (is_whole(w, half / 4)) {
        if (run->tets < 2)
            run->half[run->tets] = half;
        if (run->tets > 0)
            join(w, run->half[0] / 4, half / 4);
        run->tets++;
    }
}

/* Rows of .face that name a node twice; that tetrahedra do is known. */
static void take_no_triangle(walk *w, const tm_face_entry *entry, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (entry[i].half & TM_FACE_ORDER_ADDED)
            add_defect(w, TM_DANGLING_FACE, entry[i].half & ~TM_FACE_ORDER_ADDED, 0);
}

/* entry[0 … count) is one face; v its smallest node. False where memory is out. */
static bool take_face(walk *w, uint32_t v, const tm_face_entry *entry, size_t count)
{
    const uint32_t middle = (uint32_t)(entry->key >> 32), largest = (uint32_t)entry->key;
    if (v == middle || middle == largest) {
        take_no_triangle(w, entry, count);
        return true;
    }
    face_run run = {.row = TM_NONE};
    for (size_t i = 0; i < count; i++)
        take_entry(w, &run, entry[i].half);
    if (run.tets == 0) {
        if (run.row != TM_NONE)
            add_defect(w, TM_DANGLING_FACE, run.row, 0);
        return true;
    }
    w->faces++;
    meet_edge(w, v, middle);
    meet_edge(w, v, largest);
    if (run.tets == 1)
        return add_boundary_face(w, run.half[0]);
    if (run.tets == 2)
        check_sides(w, run.half[0], run.half[1]);
    else
        tm_defect_add(
            &w->found->defect[TM_UNMATCHED_FACE],
            (uint32_t[TM_DEFECT_NUMBERS]){v, middle, largest, (uint32_t)run.tets});
    return true;
}

static bool take_faces(walk *w, uint32_t v)
{
    const tm_face_entry *entry = w->order.entry;
    for (size_t i = 0, next; i < w->order.entries; i = next) {
        for (next = i + 1; next < w->order.entries; next++)
            if (entry[next].key != entry[i].key)
                break;
        if (!take_face(w, v, entry + i, next - i))
            return false;
    }
    return true;
}

/* Finishes the nodes before `end`, whose faces were taken: a node is used if it has an
 * edge to a smaller one, met before, or to a larger one. */
static void take_top_edges(walk *w, size_t *v, size_t end, size_t *edges_before)
{
    for (; *v < end; ++*v) {
        for (uint32_t i = w->top_start[*v]; i < w->top_start[*v + 1]; i++)
            meet_edge(w, (uint32_t)*v, w->top[i]);
        w->used_nodes += w->stamp[*v] != TM_NONE || w->edges > *edges_before;
        *edges_before = w->edges;
    }
}

static tm_status walk_nodes(walk *w, tm_error *error)
{
    tm_status status = TM_OK;
    size_t v = 0, edges_before = 0;
    while (tm_face_order_next(&w->order, &status, error)) {
        const size_t with_faces = w->order.node - 1;
        take_top_edges(w, &v, with_faces, &edges_before);
        if (!take_faces(w, (uint32_t)with_faces))
            return tm_fail_memory(error);
    }
    if (status == TM_OK)
        take_top_edges(w, &v, w->mesh->nodes, &edges_before);
    return status;
}

/* The rows of .edge that no edge was found for. */
static void report_edges(walk *w)
{
    for (size_t s = 0; s < w->listed.room; s++)
        if (w->listed.slot[s].key != 0)
            add_defect(w, TM_DANGLING_EDGE, w->listed.slot[s].value, 0);
}

static void report(walk *w)
{
    tm_examination *found = w->found;
    found->boundary_faces = w->boundary->count;
    found->components = w->tets - w->joints;
    found->unused_nodes = w->mesh->nodes - w->used_nodes;
    found->euler =
        (int64_t)w->used_nodes - (int64_t)w->edges + (int64_t)w->faces - (int64_t)w->tets;
    report_edges(w);
}

tm_status tm_tet_examine_faces(tm_examination *found, const tm_tet_arrays *mesh,
                               const int8_t *sign, tm_boundary_faces *boundary,
                               tm_error *error)
{
    walk w = {.mesh = mesh, .sign = sign, .found = found, .boundary = boundary};
    tm_status status = tm_face_order_init(&w.order, mesh->tet, mesh->tets, mesh->face,
                                          mesh->faces, mesh->nodes, error);
    if (status == TM_OK && (!list_top_edges(&w) || !list_edges(&w) || !allocate(&w)))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = walk_nodes(&w, error);
    if (status == TM_OK)
        report(&w);
    tm_face_order_free(&w.order);
    tm_edge_map_free(&w.listed);
    free(w.top_start);
    free(w.top);
    free(w.parent);
    free(w.stamp);
    return status;
}
