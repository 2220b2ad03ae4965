/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One walk over the nodes v, each with the faces and edges of which v is the smallest
 * node. Of an element's edges most begin at the smallest node of one of its two faces
 * there; the others, the far edges, are listed beforehand by their smaller node, as are
 * the rows of .edge. */
#include "element_examine_faces.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../base/parallel.h"
#include "../mesh/face_table.h"
#include "element_edges.h"

#include <stdlib.h>
#include <string.h>

/* What all walkers have in common. */
typedef struct walk {
    const tm_mesh_view *mesh;
    const int8_t *sign;
    tm_face_table table;
    tm_at_nodes far;    /* the larger nodes of far edges */
    tm_at_nodes listed; /* rows of .edge; no arrays where there are none */
    tm_walked *walked;
    uint32_t *cut; /* walker i has the nodes from cut[i] up to cut[i + 1] */
    struct walker *walker;
} walk;

/* Who walks over some of the nodes. */
typedef struct walker {
    const walk *w;
    tm_face_table table;
    tm_defect_list defect[TM_DEFECTS];
    tm_boundary_faces boundary;
    uint32_t *row_to; /* [nodes]: the last row of .edge from a smaller node; TM_NONE */
    uint32_t *stamp;  /* [nodes]: the last v that has an edge to the node; TM_NONE */
    size_t edges, faces;
    tm_status status;
    tm_error error;
} walker;

/* The members of a face. */
typedef struct members {
    tm_face_member element[2]; /* the first two */
    size_t elements;
    uint32_t face_row, facet_row; /* names of the first of .face, .facet; TM_NONE */
} members;

static void add_defect(walker *w, tm_defect d, uint32_t first, uint32_t second,
                       uint32_t third)
{
    tm_defect_add(&w->defect[d], (uint32_t[TM_DEFECT_NUMBERS]){first, second, third});
}

static uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Edges ---------------------------------------------------------------------------- */

static void set_used(const walker *w, uint32_t v)
{
    __atomic_store_n(&w->w->walked->used[v], 1, __ATOMIC_RELAXED);
}

static void meet_edge(walker *w, uint32_t v, uint32_t end)
{
    if (w->stamp[end] == v)
        return;
    w->stamp[end] = v;
    w->edges++;
    set_used(w, end);
}

/* The rows of .edge from v, where all edges to larger nodes were met. */
static void take_rows(walker *w, uint32_t v)
{
    const tm_at_nodes *listed = &w->w->listed;
    const uint32_t(*edge)[2] = w->w->mesh->edge;
    for (size_t i = listed->start[v]; i < listed->start[v + 1]; i++) {
        const uint32_t row = listed->item[i], *n = edge[row];
        const uint32_t end = n[0] == v ? n[1] : n[0];
        const uint32_t earlier = w->row_to[end];
        const bool repeats =
            earlier != TM_NONE && lesser(edge[earlier][0], edge[earlier][1]) == v;
        if (repeats && end != v) {
            add_defect(w, TM_REPEATED_EDGE, row, earlier, 0);
            continue;
        }
        w->row_to[end] = row;
        if (end == v || w->stamp[end] != v)
            add_defect(w, TM_DANGLING_EDGE, row, 0, 0);
    }
}

/* The edges that begin at v, whose faces were taken. */
static void take_edges(walker *w, uint32_t v, size_t edges_before)
{
    const tm_at_nodes *far = &w->w->far;
    for (size_t i = far->start[v]; i < far->start[v + 1]; i++)
        meet_edge(w, v, far->item[i]);
    if (w->w->listed.start)
        take_rows(w, v);
    if (w->edges > edges_before)
        set_used(w, v);
}

/* Faces ---------------------------------------------------------------------------- */

static uint32_t element_of(const walker *w, uint32_t half)
{
    return half >> w->table.shift;
}

static void check_sides(walker *w, const members *at)
{
    const uint32_t e = element_of(w, at->element[0].id);
    const uint32_t g = element_of(w, at->element[1].id);
    const int product = w->w->sign[e] * w->w->sign[g];
    const bool alike = at->element[0].turned == at->element[1].turned;
    if (product != 0 && alike == (product > 0))
        add_defect(w, TM_OVERLAPPING_FACE, lesser(e, g), e < g ? g : e, 0);
}

static bool add_boundary_face(walker *w, uint32_t half)
{
    tm_boundary_faces *b = &w->boundary;
    void *moved = tm_grow(b->node, &b->room, b->count + 1, sizeof *b->node);
    if (!moved)
        return false;
    b->node = moved;
    if (tm_half_face_nodes(w->w->mesh, half, b->node[b->count]) == 3)
        b->node[b->count][3] = TM_NONE;
    b->count++;
    return true;
}

/* Whether row f of .facet says which elements are at its face, and turns as it should. */
static bool is_right(const walker *w, const members *at, uint32_t f, bool turned)
{
    const uint32_t *side = w->w->mesh->side[f];
    if (at->elements != (side[1] == TM_NONE ? 1 : 2))
        return false;
    const bool second = element_of(w, at->element[0].id) != side[0];
    if (second && (at->elements == 1 || element_of(w, at->element[1].id) != side[0]))
        return false;
    if (at->elements == 2 && element_of(w, at->element[!second].id) != side[1])
        return false;
    const int8_t sign = w->w->sign[side[0]];
    return sign == 0 || (turned == at->element[second].turned) == (sign > 0);
}

static uint32_t name_of_row(const tm_walked *walked, uint32_t row, bool is_facet)
{
    const uint32_t *name = is_facet ? walked->facet_row : walked->face_row;
    return name ? name[row] : row;
}

/* A row of .face or .facet, of which this face is; the elements at it were taken. */
static void take_row(walker *w, members *at, const tm_face_member *member)
{
    const uint32_t faces = (uint32_t)w->w->mesh->faces;
    uint32_t row = member->id - w->table.first_row;
    const bool is_facet = row >= faces;
    uint32_t *first = is_facet ? &at->facet_row : &at->face_row;
    row -= is_facet ? faces : 0;
    const uint32_t name = name_of_row(w->w->walked, row, is_facet);
    if (*first != TM_NONE) {
        add_defect(w, TM_REPEATED_FACE, name, *first, is_facet);
        return;
    }
    *first = name;
    if (is_facet ? !is_right(w, at, row, member->turned) : at->elements == 0)
        add_defect(w, TM_DANGLING_FACE, name, 0, is_facet);
}

static members take_members(walker *w, const tm_face *face)
{
    members at = {.face_row = TM_NONE, .facet_row = TM_NONE};
    for (uint32_t m = face->first; m != TM_FACE_END; m = w->table.member[m].next) {
        const tm_face_member *member = &w->table.member[m];
        if (member->id >= w->table.first_row) {
            take_row(w, &at, member);
            continue;
        }
        if (at.elements < 2)
            at.element[at.elements] = *member;
        if (at.elements > 0)
            tm_set_unite_shared(w->w->walked->parent, element_of(w, at.element[0].id),
                                element_of(w, member->id));
        at.elements++;
    }
    return at;
}

static void add_unmatched(walker *w, uint32_t v, const tm_face *face, uint32_t how)
{
    uint32_t n[3];
    tm_face_others(face, n);
    tm_defect_add(&w->defect[TM_UNMATCHED_FACE],
                  (uint32_t[TM_DEFECT_NUMBERS]){v, n[0], n[1], how});
}

/* Returns the number of elements at a face; v is its smallest node. *enough is false
 * where memory is out. */
static size_t take_face(walker *w, uint32_t v, const tm_face *face, bool *enough)
{
    const uint32_t p = (uint32_t)(face->beside >> 32), q = (uint32_t)face->beside;
    if (v == p || p == q) /* a row that is no triangle */
        return 0;
    const members at = take_members(w, face);
    if (at.elements == 0)
        return 0;
    w->faces++;
    meet_edge(w, v, p);
    meet_edge(w, v, q);
    if (at.elements == 1)
        *enough = add_boundary_face(w, at.element[0].id);
    else if (at.elements == 2)
        check_sides(w, &at);
    else
        add_unmatched(w, v, face, (uint32_t)at.elements);
    return at.elements;
}

static bool have_same_nodes(const tm_face *f, const tm_face *g)
{
    uint32_t n[3], m[3];
    tm_face_others(f, n);
    tm_face_others(g, m);
    return n[0] == m[0] && n[1] == m[1] && n[2] == m[2];
}

/* Whether all faces are triangles of two elements, and no row names one. */
static bool is_plain(const tm_face_table *table)
{
    if (2 * table->faces != table->members)
        return false;
    for (size_t f = 0; f < table->faces; f++)
        if (table->face[f].elements != 2 || table->face[f].opposite != TM_NONE)
            return false;
    return true;
}

/* Faces of the same nodes follow each other, whatever their cyclic order. */
static bool take_faces(walker *w, uint32_t v)
{
    const tm_face *before = NULL;
    bool enough = true;
    if (!is_plain(&w->table))
        tm_face_table_sort(&w->table);
    for (size_t f = 0; f < w->table.faces && enough; f++) {
        const tm_face *face = &w->table.face[f];
        if (take_face(w, v, face, &enough) == 0)
            continue;
        if (before && have_same_nodes(before, face))
            add_unmatched(w, v, face, TM_FACE_IN_ANOTHER_ORDER);
        before = face;
    }
    return enough;
}

/* Each walker has arrays over all nodes. */
enum { MOST_WALKERS = 16 };

/* The walk ------------------------------------------------------------------------- */

static bool begin_walker(walker *w, const walk *all)
{
    const size_t nodes = all->mesh->nodes;
    w->w = all;
    tm_face_table_share(&w->table, &all->table);
    w->stamp = tm_new(nodes, sizeof *w->stamp);
    if (!w->stamp)
        return false;
    memset(w->stamp, UINT8_MAX, nodes * sizeof *w->stamp);
    if (!all->listed.start)
        return true;
    w->row_to = tm_new(nodes, sizeof *w->row_to);
    if (!w->row_to)
        return false;
    memset(w->row_to, UINT8_MAX, nodes * sizeof *w->row_to);
    return true;
}

static void walk_nodes(void *context, size_t i)
{
    const walk *all = context;
    walker *w = &all->walker[i];
    if (!begin_walker(w, all))
        w->status = tm_fail_memory(&w->error);
    for (uint32_t v = all->cut[i]; v < all->cut[i + 1] && w->status == TM_OK; v++) {
        const size_t edges_before = w->edges;
        w->status = tm_face_table_at(&w->table, v, &w->error);
        if (w->status == TM_OK && !take_faces(w, v))
            w->status = tm_fail_memory(&w->error);
        if (w->status == TM_OK)
            take_edges(w, v, edges_before);
    }
    tm_face_table_free(&w->table);
    free(w->stamp);
    free(w->row_to);
}

/* Rows that cannot be a face of any element. */
static void take_no_faces(const walk *w, tm_examination *found)
{
    const uint32_t faces = (uint32_t)w->mesh->faces;
    const uint32_t rows = faces + (uint32_t)w->mesh->facets;
    for (uint32_t row = 0; row < rows; row++) {
        const bool is_facet = row >= faces;
        const uint32_t name =
            name_of_row(w->walked, is_facet ? row - faces : row, is_facet);
        if (!tm_row_is_face(w->mesh, row))
            tm_defect_add(&found->defect[TM_DANGLING_FACE],
                          (uint32_t[TM_DEFECT_NUMBERS]){name, 0, is_facet});
    }
}

static bool allocate(walk *w, unsigned threads)
{
    const tm_mesh_view *mesh = w->mesh;
    tm_walked *walked = w->walked;
    walked->parent = tm_new(mesh->elements, sizeof *walked->parent);
    walked->used = calloc(mesh->nodes + 1, sizeof *walked->used);
    w->cut = tm_new((size_t)threads + 1, sizeof *w->cut);
    w->walker = calloc(threads, sizeof *w->walker);
    if (!walked->parent || !walked->used || !w->cut || !w->walker)
        return false;
    for (uint32_t e = 0; e < mesh->elements; e++)
        walked->parent[e] = e;
    return true;
}

static bool append_boundary(tm_boundary_faces *to, const tm_boundary_faces *more)
{
    const size_t all = to->count + more->count;
    void *moved = tm_grow(to->node, &to->room, all, sizeof *to->node);
    if (!moved)
        return false;
    to->node = moved;
    if (more->count > 0)
        memcpy(to->node + to->count, more->node, more->count * sizeof *to->node);
    to->count = all;
    return true;
}

/* What the walkers found, in the order of the nodes. */
static tm_status collect(const walk *w, unsigned threads, tm_examination *found,
                         tm_error *error)
{
    tm_boundary_faces *boundary = &w->walked->boundary;
    for (unsigned t = 0; t < threads; t++) {
        const walker *one = &w->walker[t];
        if (one->status != TM_OK)
            return tm_fail_as(error, &one->error);
        for (size_t d = 0; d < TM_DEFECTS; d++)
            tm_defect_add_list(&found->defect[d], &one->defect[d]);
        if (!append_boundary(boundary, &one->boundary))
            return tm_fail_memory(error);
        found->euler += (int64_t)one->faces - (int64_t)one->edges;
    }
    found->boundary_faces = boundary->count;
    return TM_OK;
}

static void free_walk(walk *w, unsigned threads)
{
    for (unsigned t = 0; w->walker && t < threads; t++)
        free(w->walker[t].boundary.node);
    free(w->walker);
    tm_face_table_free(&w->table);
    tm_at_nodes_free(&w->far);
    tm_at_nodes_free(&w->listed);
    free(w->cut);
}

/* What lists the members cuts the nodes of all. */
static void cut_nodes(const walk *w, unsigned threads)
{
    tm_face_table_cut(&w->table, threads, w->cut);
    for (unsigned t = 0; t <= threads; t++) {
        const uint32_t v = w->cut[t] < w->walked->past ? w->cut[t] : w->walked->past;
        w->cut[t] = v > w->walked->first ? v : w->walked->first;
    }
}

void tm_walked_free(tm_walked *walked)
{
    free(walked->parent);
    free(walked->used);
    free(walked->boundary.node);
}

tm_status tm_element_examine_faces(tm_examination *found, const tm_mesh_view *mesh,
                                   const int8_t *sign, tm_walked *walked,
                                   unsigned threads, tm_error *error)
{
    walk w = {.mesh = mesh, .sign = sign, .walked = walked};
    tm_status status = tm_face_table_make(&w.table, mesh, threads, error);
    threads = tm_threads_for(threads, MOST_WALKERS, mesh->elements);
    if (status == TM_OK &&
        (!tm_list_far_edges(&w.far, mesh, sign, threads) ||
         !tm_list_edge_rows(&w.listed, mesh) || !allocate(&w, threads)))
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        take_no_faces(&w, found);
        cut_nodes(&w, threads);
        tm_parallel(threads, threads, walk_nodes, &w);
        status = collect(&w, threads, found, error);
    }
    free_walk(&w, threads);
    return status;
}
