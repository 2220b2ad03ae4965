/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assemble.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_CORNERS = 8, LEAF_FACES = 6, MOST_NODES = 8 };

const uint8_t tm_cut_triangles[3][2][3] = {
    [TM_CUT_02] = {{0, 1, 2}, {2, 3, 0}}, [TM_CUT_13] = {{1, 2, 3}, {3, 0, 1}}};

typedef struct {
    const tm_octree *octree;
    const tm_interior *interior;
    const tm_interior_boundary *boundary;
    tm_assembly *assembly;
    bool counting;                         /* nothing is written yet */
    size_t face, middles, elements, items; /* so far */
} assembler;

static tm_status number_core(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    a->assembly->core_node = tm_new(a->octree->nodes, sizeof *a->assembly->core_node);
    to->inner = tm_new(a->boundary->nodes, sizeof *to->inner);
    if (!a->assembly->core_node || !to->inner)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++)
        a->assembly->core_node[n] = a->interior->used[n] ? (uint32_t)to->core++ : TM_NONE;
    to->grid_node = tm_new(to->core, sizeof *to->grid_node);
    if (!to->grid_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++)
        if (a->assembly->core_node[n] != TM_NONE)
            to->grid_node[a->assembly->core_node[n]] = (uint32_t)n;
    for (size_t s = 0; s < a->boundary->nodes; s++)
        to->inner[s] = a->assembly->core_node[a->boundary->grid_node[s]];
    to->outer = (uint32_t)to->core;
    return TM_OK;
}

static tm_status allocate(const assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_mixed_mesh *mesh = &to->mesh;
    mesh->nodes = to->core + a->boundary->nodes + a->middles;
    mesh->elements = a->elements;
    if (mesh->nodes >= TM_NONE || mesh->elements >= TM_NONE)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "the mesh would have %zu nodes and %zu elements, more than 32 "
                       "bits can number",
                       mesh->nodes, mesh->elements);
    mesh->xyz = tm_new(mesh->nodes, sizeof *mesh->xyz);
    mesh->start = tm_new(mesh->elements + 1, sizeof *mesh->start);
    mesh->item = tm_new(a->items, sizeof *mesh->item);
    to->first = tm_new(a->octree->leaves + 1, sizeof *to->first);
    to->middles = a->middles;
    to->middle_leaf = tm_new(a->middles, sizeof *to->middle_leaf);
    to->layer = tm_new(a->boundary->faces, sizeof *to->layer);
    if (!mesh->xyz || !mesh->start || !mesh->item || !to->first || !to->layer ||
        !to->middle_leaf)
        return tm_fail_memory(error);
    return TM_OK;
}

static void add_element(assembler *a, unsigned k, const uint32_t *node)
{
    tm_mixed_mesh *mesh = &a->assembly->mesh;
    if (!a->counting) {
        mesh->start[a->elements] = a->items;
        memcpy(mesh->item + a->items, node, k * sizeof *node);
    }
    a->elements++;
    a->items += k;
}

/* A node in the middle of leaf l. */
static uint32_t new_middle(assembler *a, size_t l)
{
    if (!a->counting)
        a->assembly->middle_leaf[a->middles] = (uint32_t)l;
    return (uint32_t)(a->assembly->core + a->boundary->nodes + a->middles++);
}

/* The element between a face of a leaf, whose k nodes turn counter-clockwise seen from
 * outside, and the node in the middle of the leaf. */
static void add_to_middle(assembler *a, unsigned k, const uint32_t *face, uint32_t middle)
{
    uint32_t node[MOST_NODES];
    for (unsigned i = 0; i < k; i++)
        node[i] = face[k - 1 - i]; /* counter-clockwise seen from the middle */
    node[k] = middle;
    add_element(a, k + 1, node);
}

/* Whether the face of the interior boundary that comes next is that piece of leaf l. */
static bool is_next(const assembler *a, size_t face, size_t l, unsigned piece)
{
    return face < a->boundary->faces && a->boundary->leaf[face] == l &&
           a->boundary->piece[face] == piece;
}

/* Divides a leaf from its centre, with the pieces of its faces that are cut as triangles.
 */
static void add_star(assembler *a, size_t l, const uint32_t at[TM_LEAF_NODES])
{
    const tm_leaf_state state = tm_interior_leaf_state(a->interior, a->octree, l);
    const uint32_t middle = new_middle(a, l);
    size_t next = a->face;
    for (unsigned f = 0; f < LEAF_FACES; f++) {
        tm_piece piece[TM_FACE_PIECES];
        const unsigned pieces = tm_face_pieces(state, f, piece);
        for (unsigned i = 0; i < pieces; i++) {
            uint32_t node[4];
            for (unsigned c = 0; c < piece[i].k; c++)
                node[c] = at[piece[i].point[c]];
            unsigned cut = TM_UNCUT;
            if (is_next(a, next, l, TM_FACE_PIECES * f + i))
                cut = a->boundary->cut[next++];
            if (cut == TM_UNCUT) {
                add_to_middle(a, piece[i].k, node, middle);
                continue;
            }
            for (unsigned t = 0; t < 2; t++) {
                const uint8_t *c = tm_cut_triangles[cut][t];
                add_to_middle(a, 3, (uint32_t[]){node[c[0]], node[c[1]], node[c[2]]},
                              middle);
            }
        }
    }
}

static bool has_cut(const assembler *a, size_t l)
{
    for (size_t f = a->face; f < a->boundary->faces && a->boundary->leaf[f] == l; f++)
        if (a->boundary->cut[f] != TM_UNCUT)
            return true;
    return false;
}

static void add_leaf(assembler *a, size_t l)
{
    uint32_t at[TM_LEAF_CENTRE + 1];
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = a->octree->node[l][p];
        at[p] = node == TM_NONE ? TM_NONE : a->assembly->core_node[node];
    }
    if (has_cut(a, l)) {
        add_star(a, l, at);
        return;
    }
    const tm_transition t =
        tm_transition_of(tm_interior_leaf_state(a->interior, a->octree, l));
    at[TM_LEAF_CENTRE] = t.centre ? new_middle(a, l) : TM_NONE;
    for (unsigned i = 0; i < t.pieces; i++) {
        uint32_t node[MOST_NODES];
        for (unsigned c = 0; c < t.piece[i].k; c++)
            node[c] = at[t.piece[i].point[c]];
        add_element(a, t.piece[i].k, node);
    }
}

/* The wedge between the triangle of corners c of the interior boundary's face and its
 * copy. */
static void add_wedge(assembler *a, const uint32_t *in, const uint32_t *out,
                      const uint8_t c[3])
{
    add_element(
        a, 6,
        (uint32_t[]){out[c[0]], out[c[1]], out[c[2]], in[c[0]], in[c[1]], in[c[2]]});
}

/* The layer's elements under the faces of leaf l. */
static void add_layer(assembler *a, size_t l)
{
    const tm_interior_boundary *boundary = a->boundary;
    for (; a->face < boundary->faces && boundary->leaf[a->face] == l; a->face++) {
        const size_t f = a->face;
        uint32_t in[4];
        uint32_t out[4];
        const unsigned k = tm_boundary_face_corners(boundary, f);
        if (!a->counting)
            a->assembly->layer[f] = (uint32_t)a->elements;
        for (unsigned i = 0; i < k; i++) {
            in[i] = a->assembly->inner[boundary->face[f][i]];
            out[i] = a->assembly->outer + boundary->face[f][i];
        }
        if (k == 3)
            add_wedge(a, in, out, (const uint8_t[]){0, 1, 2});
        else if (boundary->cut[f] == TM_UNCUT)
            add_element(
                a, MOST_NODES,
                (uint32_t[]){in[0], in[1], in[2], in[3], out[0], out[1], out[2], out[3]});
        else
            for (unsigned t = 0; t < 2; t++)
                add_wedge(a, in, out, tm_cut_triangles[boundary->cut[f]][t]);
    }
}

/* All elements, leaf by leaf: counted, or written. */
static void add_all(assembler *a, bool counting)
{
    a->counting = counting;
    a->face = a->middles = a->elements = a->items = 0;
    for (size_t l = 0; l < a->octree->leaves; l++) {
        if (!counting)
            a->assembly->first[l] = (uint32_t)a->elements;
        if (a->interior->chosen[l]) {
            add_leaf(a, l);
            add_layer(a, l);
        }
    }
}

/* All nodes on the lattice. */
static void set_points(const assembler *a)
{
    const tm_assembly *to = a->assembly;
    double(*xyz)[3] = to->mesh.xyz;
    for (size_t n = 0; n < to->core; n++)
        tm_octree_point(a->octree, a->octree->grid[to->grid_node[n]], xyz[n]);
    for (size_t s = 0; s < a->boundary->nodes; s++)
        memcpy(xyz[to->outer + s], xyz[to->inner[s]], sizeof *xyz);
    for (size_t m = 0; m < to->middles; m++)
        tm_leaf_centre(a->octree, &a->octree->leaf[to->middle_leaf[m]],
                       xyz[to->core + a->boundary->nodes + m]);
}

tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_interior *interior, const tm_interior_boundary *boundary,
                      tm_error *error)
{
    *assembly = (tm_assembly){0};
    assembler a = {.octree = octree,
                   .interior = interior,
                   .boundary = boundary,
                   .assembly = assembly};
    tm_status status = number_core(&a, error);
    if (status == TM_OK) {
        add_all(&a, true);
        status = allocate(&a, error);
    }
    if (status == TM_OK) {
        add_all(&a, false);
        assembly->first[octree->leaves] = (uint32_t)a.elements;
        assembly->mesh.start[a.elements] = a.items;
        set_points(&a);
    }
    return status;
}

void tm_assembly_free(tm_assembly *assembly)
{
    free(assembly->mesh.xyz);
    free(assembly->mesh.start);
    free(assembly->mesh.item);
    free(assembly->middle_leaf);
    free(assembly->first);
    free(assembly->layer);
    free(assembly->inner);
    free(assembly->core_node);
    free(assembly->grid_node);
    *assembly = (tm_assembly){0};
}
