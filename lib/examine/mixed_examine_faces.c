/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One walk over the nodes v, each with the faces and edges of which v is the smallest
 * node. Of an element's edges most begin at the smallest node of one of its two faces
 * there; the others, the far edges, are listed beforehand by their smaller node, as are
 * the rows of .edge. */
#include "mixed_examine_faces.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../mesh/mixed_face_order.h"
#include "../element/shape.h"

#include <stdlib.h>
#include <string.h>

/* What begins at the nodes: of v it is item[start[v]] … item[start[v + 1] - 1]. */
typedef struct list {
    size_t *start;
    uint32_t *item;
} list;

typedef struct walk {
    const tm_mixed_arrays *mesh;
    const int8_t *sign;
    tm_examination *found;
    tm_mixed_boundary *boundary;
    tm_mixed_face_order order;
    list far;         /* the larger nodes of far edges */
    list listed;      /* rows of .edge; no arrays where there are none */
    uint32_t *row_to; /* [nodes]: the last row of .edge from a smaller node; TM_NONE */
    uint32_t *parent; /* [elements]: a forest with a tree for each component */
    uint32_t *stamp;  /* [nodes]: the last v that has an edge to the node; TM_NONE */
    size_t elements;  /* that do not name a node twice */
    size_t joints;    /* of two components into one */
    size_t used_nodes;
    size_t edges;
    size_t faces;
} walk;

/* The elements at a face, and the rows that list it. */
typedef struct face_run {
    size_t elements;
    const tm_mixed_face *first[2];
    uint32_t face_row, facet_row; /* the first of .face, of .facet; TM_NONE */
} face_run;

enum { HALVES = 8 };

static bool is_whole(const walk *w, size_t e)
{
    return w->sign[e] != TM_MIXED_NODE_TWICE;
}

static void add_defect(walk *w, tm_defect d, uint32_t first, uint32_t second,
                       uint32_t third)
{
    tm_defect_add(&w->found->defect[d],
                  (uint32_t[TM_DEFECT_NUMBERS]){first, second, third});
}

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Edges ---------------------------------------------------------------------------- */

/* The far edges of element e as bits. */
static uint16_t far_edges(const uint32_t *n, const tm_element_shape *shape)
{
    uint32_t least[TM_ELEMENT_FACES];
    uint32_t far = 0;
    tm_mixed_least(shape, n, least);
    for (size_t i = 0; i < shape->edges; i++) {
        const uint32_t small = lesser(n[shape->edge[i][0]], n[shape->edge[i][1]]);
        const bool is_far = (small != least[shape->edge_face[i][0]]) &
                            (small != least[shape->edge_face[i][1]]);
        far |= (uint32_t)is_far << i;
    }
    return (uint16_t)far;
}

/* start[v + 2] counts; the number of all. */
static size_t count_far_edges(walk *w, uint16_t *far)
{
    const tm_mixed_arrays *mesh = w->mesh;
    size_t *count = w->far.start + 2, all = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        const uint32_t *n = mesh->item + mesh->start[e];
        const tm_element_shape *shape =
            &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
        far[e] = is_whole(w, e) ? far_edges(n, shape) : 0;
        for (uint32_t left = far[e]; left != 0; left &= left - 1, all++) {
            const uint8_t *edge = shape->edge[__builtin_ctz(left)];
            count[lesser(n[edge[0]], n[edge[1]])]++;
        }
    }
    return all;
}

static bool list_far_edges(walk *w)
{
    const tm_mixed_arrays *mesh = w->mesh;
    uint16_t *far = tm_new(mesh->elements, sizeof *far);
    w->far.start = calloc(mesh->nodes + 2, sizeof *w->far.start);
    if (far && w->far.start)
        w->far.item = tm_new(count_far_edges(w, far), sizeof *w->far.item);
    if (!w->far.item) {
        free(far);
        return false;
    }
    /* start[v + 1] is where the next edge of v goes. */
    size_t *next = w->far.start + 1;
    for (size_t v = 0; v < mesh->nodes; v++)
        next[v + 1] += next[v];
    for (size_t e = 0; e < mesh->elements; e++) {
        const uint32_t *n = mesh->item + mesh->start[e];
        const tm_element_shape *shape =
            &tm_element_shapes[mesh->start[e + 1] - mesh->start[e]];
        for (uint32_t left = far[e]; left != 0; left &= left - 1) {
            const uint8_t *edge = shape->edge[__builtin_ctz(left)];
            const uint32_t a = n[edge[0]], b = n[edge[1]], small = lesser(a, b);
            w->far.item[next[small]++] = small == a ? b : a;
        }
    }
    free(far);
    return true;
}

static bool list_rows(walk *w)
{
    const tm_mixed_arrays *mesh = w->mesh;
    if (mesh->edges == 0)
        return true;
    w->listed.start = calloc(mesh->nodes + 2, sizeof *w->listed.start);
    w->listed.item = tm_new(mesh->edges, sizeof *w->listed.item);
    w->row_to = tm_new(mesh->nodes, sizeof *w->row_to);
    if (!w->listed.start || !w->listed.item || !w->row_to)
        return false;
    memset(w->row_to, UINT8_MAX, mesh->nodes * sizeof *w->row_to);
    size_t *next = w->listed.start + 1;
    for (size_t r = 0; r < mesh->edges; r++)
        next[lesser(mesh->edge[r][0], mesh->edge[r][1]) + 1]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        next[v + 1] += next[v];
    for (size_t r = 0; r < mesh->edges; r++)
        w->listed.item[next[lesser(mesh->edge[r][0], mesh->edge[r][1])]++] = (uint32_t)r;
    return true;
}

static void meet_edge(walk *w, uint32_t v, uint32_t end)
{
    w->edges += w->stamp[end] != v;
    w->stamp[end] = v;
}

/* The rows of .edge from v, where all edges to larger nodes were met. */
static void take_rows(walk *w, uint32_t v)
{
    for (size_t i = w->listed.start[v]; i < w->listed.start[v + 1]; i++) {
        const uint32_t row = w->listed.item[i], *n = w->mesh->edge[row];
        const uint32_t end = n[0] == v ? n[1] : n[0];
        const uint32_t earlier = w->row_to[end];
        const bool repeats = earlier != TM_NONE && lesser(w->mesh->edge[earlier][0],
                                                          w->mesh->edge[earlier][1]) == v;
        if (repeats && end != v) {
            add_defect(w, TM_REPEATED_EDGE, row, earlier, 0);
            continue;
        }
        w->row_to[end] = row;
        if (end == v || w->stamp[end] != v)
            add_defect(w, TM_DANGLING_EDGE, row, 0, 0);
    }
}

/* Finishes the nodes before `end`, whose faces were taken: a node is used if it has an
 * edge to a smaller one, met before, or to a larger one. */
static void take_edges(walk *w, size_t *v, size_t end, size_t *edges_before)
{
    for (; *v < end; ++*v) {
        const uint32_t node = (uint32_t)*v;
        for (size_t i = w->far.start[node]; i < w->far.start[node + 1]; i++)
            meet_edge(w, node, w->far.item[i]);
        if (w->listed.start)
            take_rows(w, node);
        w->used_nodes += w->stamp[node] != TM_NONE || w->edges > *edges_before;
        *edges_before = w->edges;
    }
}

/* Faces ---------------------------------------------------------------------------- */

static void join(walk *w, uint32_t e, uint32_t g)
{
    e = tm_set_root(w->parent, e);
    g = tm_set_root(w->parent, g);
    w->joints += e != g;
    if (e < g)
        w->parent[g] = e;
    else
        w->parent[e] = g;
}

static void check_sides(walk *w, const face_run *run)
{
    const uint32_t e = run->first[0]->half / HALVES, g = run->first[1]->half / HALVES;
    const int product = w->sign[e] * w->sign[g];
    const bool alike = run->first[0]->turned == run->first[1]->turned;
    if (product != 0 && alike == (product > 0))
        add_defect(w, TM_OVERLAPPING_FACE, lesser(e, g), e < g ? g : e, 0);
}

static bool add_boundary_face(walk *w, uint32_t half)
{
    tm_mixed_boundary *b = w->boundary;
    void *moved = tm_grow(b->node, &b->room, b->count + 1, sizeof *b->node);
    if (!moved)
        return false;
    b->node = moved;
    if (tm_mixed_face_of(w->mesh, half, b->node[b->count]) == 3)
        b->node[b->count][3] = TM_NONE;
    b->count++;
    return true;
}

/* Whether a row of .facet says which elements are at its face, and turns as it should. */
static bool is_right(const walk *w, const face_run *run, const tm_mixed_face *row)
{
    const uint32_t *side =
        w->mesh->side[(row->half & ~TM_MIXED_ROW) - (uint32_t)w->mesh->faces];
    if (run->elements != (side[1] == TM_NONE ? 1 : 2))
        return false;
    const bool second = run->first[0]->half / HALVES != side[0];
    if (second && (run->elements == 1 || run->first[1]->half / HALVES != side[0]))
        return false;
    if (run->elements == 2 && run->first[!second]->half / HALVES != side[1])
        return false;
    const int8_t sign = w->sign[side[0]];
    const bool alike = row->turned == run->first[second]->turned;
    return sign == 0 || alike == (sign > 0);
}

/* A row of .face or .facet that is this face; the elements of the run were taken. */
static void take_row(walk *w, face_run *run, const tm_mixed_face *entry)
{
    const uint32_t faces = (uint32_t)w->mesh->faces;
    uint32_t row = entry->half & ~TM_MIXED_ROW;
    const bool is_facet = row >= faces;
    uint32_t *first = is_facet ? &run->facet_row : &run->face_row;
    row -= is_facet ? faces : 0;
    if (*first != TM_NONE) {
        add_defect(w, TM_REPEATED_FACE, row, *first, is_facet);
        return;
    }
    *first = row;
    if (is_facet ? !is_right(w, run, entry) : run->elements == 0)
        add_defect(w, TM_DANGLING_FACE, row, 0, is_facet);
}

/* Takes what is at one face: elements first, as their numbers are the smaller ones. */
static face_run take_entries(walk *w, const tm_mixed_face *entry, size_t count)
{
    face_run run = {.face_row = TM_NONE, .facet_row = TM_NONE};
    for (size_t i = 0; i < count; i++) {
        if (entry[i].half & TM_MIXED_ROW) {
            take_row(w, &run, &entry[i]);
            continue;
        }
        if (run.elements < 2)
            run.first[run.elements] = &entry[i];
        if (run.elements > 0)
            join(w, run.first[0]->half / HALVES, entry[i].half / HALVES);
        run.elements++;
    }
    return run;
}

/* The edges of a face that begin at its smallest node. */
static void meet_edges(walk *w, uint32_t v, const tm_mixed_face *entry)
{
    const uint32_t node[] = {0, (uint32_t)(entry->key >> 32), (uint32_t)entry->key,
                             (uint32_t)(entry->shape >> 2)};
    const size_t opposite = entry->shape & 3, last = opposite == 0 ? 2 : 3;
    for (size_t i = 1; i <= last; i++)
        if (i != opposite)
            meet_edge(w, v, node[i]);
}

/* entry[0 … count) is one face; v its smallest node. Returns the number of elements
 * there; *enough is false where memory is out. */
static size_t take_face(walk *w, uint32_t v, const tm_mixed_face *entry, size_t count,
                        bool *enough)
{
    const face_run run = take_entries(w, entry, count);
    if (run.elements == 0)
        return 0;
    w->faces++;
    meet_edges(w, v, entry);
    if (run.elements == 1)
        *enough = add_boundary_face(w, run.first[0]->half);
    else if (run.elements == 2)
        check_sides(w, &run);
    else
        tm_defect_add(&w->found->defect[TM_UNMATCHED_FACE],
                      (uint32_t[TM_DEFECT_NUMBERS]){v, (uint32_t)(entry->key >> 32),
                                                    (uint32_t)entry->key,
                                                    (uint32_t)run.elements});
    return run.elements;
}

/* Faces of the same nodes follow each other, whatever their cyclic order. */
static bool take_faces(walk *w, uint32_t v)
{
    const tm_mixed_face *entry = w->order.entry, *before = NULL;
    bool enough = true;
    for (size_t i = 0, next; i < w->order.entries && enough; i = next) {
        for (next = i + 1; next < w->order.entries; next++)
            if (entry[next].key != entry[i].key || entry[next].shape != entry[i].shape)
                break;
        if (take_face(w, v, &entry[i], next - i, &enough) == 0)
            continue;
        if (before && before->key == entry[i].key &&
            before->shape >> 2 == entry[i].shape >> 2)
            tm_defect_add(&w->found->defect[TM_UNMATCHED_FACE],
                          (uint32_t[TM_DEFECT_NUMBERS]){v, (uint32_t)(entry[i].key >> 32),
                                                        (uint32_t)entry[i].key,
                                                        TM_FACE_IN_ANOTHER_ORDER});
        before = &entry[i];
    }
    return enough;
}

/* The walk ------------------------------------------------------------------------- */

static tm_status walk_nodes(walk *w, tm_error *error)
{
    tm_status status = TM_OK;
    size_t v = 0, edges_before = 0;
    while (tm_mixed_face_order_next(&w->order, &status, error)) {
        const size_t with_faces = w->order.node - 1;
        take_edges(w, &v, with_faces, &edges_before);
        if (!take_faces(w, (uint32_t)with_faces))
            return tm_fail_memory(error);
    }
    if (status == TM_OK)
        take_edges(w, &v, w->mesh->nodes, &edges_before);
    return status;
}

/* Rows that are no face of any element, whatever the elements are. */
static void take_no_faces(walk *w)
{
    const tm_mixed_arrays *mesh = w->mesh;
    for (size_t f = 0; f < mesh->faces; f++)
        if (!tm_mixed_row_is_face(mesh->face[f], 3))
            add_defect(w, TM_DANGLING_FACE, (uint32_t)f, 0, false);
    for (size_t f = 0; f < mesh->facets; f++)
        if (!tm_mixed_row_is_face(mesh->facet_node + mesh->facet_start[f],
                                  mesh->facet_start[f + 1] - mesh->facet_start[f]))
            add_defect(w, TM_DANGLING_FACE, (uint32_t)f, 0, true);
}

static bool allocate(walk *w)
{
    const tm_mixed_arrays *mesh = w->mesh;
    w->parent = tm_new(mesh->elements, sizeof *w->parent);
    w->stamp = tm_new(mesh->nodes, sizeof *w->stamp);
    if (!w->parent || !w->stamp)
        return false;
    memset(w->stamp, UINT8_MAX, mesh->nodes * sizeof *w->stamp);
    for (uint32_t e = 0; e < mesh->elements; e++) {
        w->parent[e] = e;
        w->elements += is_whole(w, e);
    }
    return true;
}

static void report(const walk *w)
{
    tm_examination *found = w->found;
    found->boundary_faces = w->boundary->count;
    found->components = w->elements - w->joints;
    found->unused_nodes = w->mesh->nodes - w->used_nodes;
    found->euler = (int64_t)w->used_nodes - (int64_t)w->edges + (int64_t)w->faces -
                   (int64_t)w->elements;
}

tm_status tm_mixed_examine_faces(tm_examination *found, const tm_mixed_arrays *mesh,
                                 const int8_t *sign, tm_mixed_boundary *boundary,
                                 tm_error *error)
{
    walk w = {.mesh = mesh, .sign = sign, .found = found, .boundary = boundary};
    tm_status status = tm_mixed_face_order_init(&w.order, mesh, sign, error);
    if (status == TM_OK && (!list_far_edges(&w) || !list_rows(&w) || !allocate(&w)))
        status = tm_fail_memory(error);
    take_no_faces(&w);
    if (status == TM_OK)
        status = walk_nodes(&w, error);
    if (status == TM_OK)
        report(&w);
    tm_mixed_face_order_free(&w.order);
    free(w.far.start);
    free(w.far.item);
    free(w.listed.start);
    free(w.listed.item);
    free(w.row_to);
    free(w.parent);
    free(w.stamp);
    return status;
}
