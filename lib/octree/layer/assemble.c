/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assemble.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_CORNERS = 8, LEAF_FACES = 6, MOST_NODES = 8 };

const uint8_t tm_cut_triangles[3][2][3] = {
    [TM_CUT_02] = {{0, 1, 2}, {2, 3, 0}}, [TM_CUT_13] = {{1, 2, 3}, {3, 0, 1}}};

/* The leaves on one side of their boundary: those inside, or those that they enclose. */
typedef struct {
    const tm_interior *interior;
    const tm_interior_boundary *boundary;
    uint32_t *core_node; /* [nodes of the octree]: of the mesh, or TM_NONE */
    uint32_t *inner;     /* [nodes of its boundary] */
    uint32_t *outer;     /* [nodes of its boundary]: of the interior boundary */
    uint32_t *layer;     /* [faces of its boundary] */
    size_t face;         /* so far */
} side;

typedef struct {
    const tm_octree *octree;
    const tm_interior_boundary *boundary;
    tm_assembly *assembly;
    side inside, across;
    side *at;                        /* that of the leaf */
    bool counting;                   /* nothing is written yet */
    size_t middles, elements, items; /* so far */
} assembler;

/* The nodes that leaves of a side have, and its copies of boundary nodes. */
static tm_status number_side(assembler *a, side *s, tm_error *error)
{
    tm_assembly *to = a->assembly;
    s->core_node = tm_new(a->octree->nodes, sizeof *s->core_node);
    s->inner = tm_new(s->boundary->nodes, sizeof *s->inner);
    s->layer = tm_new(s->boundary->faces, sizeof *s->layer);
    if (!s->core_node || !s->inner || !s->layer)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++)
        s->core_node[n] = s->interior->used[n] && s->interior->mask[n] != 0
                              ? (uint32_t)to->core++
                              : TM_NONE;
    for (size_t i = 0; i < s->boundary->nodes; i++)
        s->inner[i] = s->core_node[s->boundary->grid_node[i]];
    return TM_OK;
}

static tm_status number_core(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_status status = number_side(a, &a->inside, error);
    if (status == TM_OK && a->across.interior)
        status = number_side(a, &a->across, error);
    if (status != TM_OK)
        return status;
    to->grid_node = tm_new(to->core, sizeof *to->grid_node);
    if (!to->grid_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++) {
        if (a->inside.core_node[n] != TM_NONE)
            to->grid_node[a->inside.core_node[n]] = (uint32_t)n;
        if (a->across.core_node && a->across.core_node[n] != TM_NONE)
            to->grid_node[a->across.core_node[n]] = (uint32_t)n;
    }
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
    if (!mesh->xyz || !mesh->start || !mesh->item || !to->first || !to->middle_leaf)
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
    const tm_interior_boundary *boundary = a->at->boundary;
    return face < boundary->faces && boundary->leaf[face] == l &&
           boundary->piece[face] == piece;
}

/* Divides a leaf from its centre, with the pieces of its faces that are cut as triangles.
 */
static void add_star(assembler *a, size_t l, const uint32_t at[TM_LEAF_NODES])
{
    const tm_leaf_state state = tm_interior_leaf_state(a->at->interior, a->octree, l);
    const uint32_t middle = new_middle(a, l);
    size_t next = a->at->face;
    for (unsigned f = 0; f < LEAF_FACES; f++) {
        tm_piece piece[TM_FACE_PIECES];
        const unsigned pieces = tm_face_pieces(state, f, piece);
        for (unsigned i = 0; i < pieces; i++) {
            uint32_t node[4];
            for (unsigned c = 0; c < piece[i].k; c++)
                node[c] = at[piece[i].point[c]];
            unsigned cut = TM_UNCUT;
            if (is_next(a, next, l, TM_FACE_PIECES * f + i))
                cut = a->at->boundary->cut[next++];
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
    const tm_interior_boundary *boundary = a->at->boundary;
    for (size_t f = a->at->face; f < boundary->faces && boundary->leaf[f] == l; f++)
        if (boundary->cut[f] != TM_UNCUT)
            return true;
    return false;
}

static void add_leaf(assembler *a, size_t l)
{
    uint32_t at[TM_LEAF_CENTRE + 1];
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = a->octree->node[l][p];
        at[p] = node == TM_NONE ? TM_NONE : a->at->core_node[node];
    }
    if (has_cut(a, l)) {
        add_star(a, l, at);
        return;
    }
    const tm_transition t =
        tm_transition_of(tm_interior_leaf_state(a->at->interior, a->octree, l));
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
    side *s = a->at;
    const tm_interior_boundary *boundary = s->boundary;
    for (; s->face < boundary->faces && boundary->leaf[s->face] == l; s->face++) {
        const size_t f = s->face;
        uint32_t in[4];
        uint32_t out[4];
        const unsigned k = tm_boundary_face_corners(boundary, f);
        if (!a->counting)
            s->layer[f] = (uint32_t)a->elements;
        for (unsigned i = 0; i < k; i++) {
            const uint32_t node = boundary->face[f][i];
            in[i] = s->inner[node];
            out[i] = a->assembly->outer + (s->outer ? s->outer[node] : node);
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
    a->inside.face = a->across.face = a->middles = a->elements = a->items = 0;
    for (size_t l = 0; l < a->octree->leaves; l++) {
        if (!counting)
            a->assembly->first[l] = (uint32_t)a->elements;
        a->at = a->inside.interior->chosen[l] ? &a->inside : &a->across;
        if (a->at->interior && a->at->interior->chosen[l]) {
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
        memcpy(xyz[to->outer + s], xyz[a->inside.inner[s]], sizeof *xyz);
    for (size_t m = 0; m < to->middles; m++)
        tm_leaf_centre(a->octree, &a->octree->leaf[to->middle_leaf[m]],
                       xyz[to->core + a->boundary->nodes + m]);
}

/* The face of the interior boundary with the same nodes as one from across. */
static size_t same_face(const assembler *a, size_t f)
{
    const tm_interior_boundary *boundary = a->boundary;
    const uint32_t *given = a->across.boundary->face[f];
    const unsigned k = tm_boundary_face_corners(a->across.boundary, f);
    const uint32_t first = a->across.outer[given[0]];
    for (size_t i = boundary->around_start[first]; i < boundary->around_start[first + 1];
         i++) {
        const size_t here = boundary->around[i];
        unsigned common = 0;
        for (unsigned c = 0; c < k; c++)
            for (unsigned d = 0; d < tm_boundary_face_corners(boundary, here); d++)
                common += a->across.outer[given[c]] == boundary->face[here][d];
        if (common == k && tm_boundary_face_corners(boundary, here) == k)
            return here;
    }
    return TM_NONE;
}

/* Both sides cut a face by the same diagonal. */
static void share_cut(const assembler *a, size_t f, tm_interior_boundary *across)
{
    const size_t here = same_face(a, f);
    if (a->boundary->cut[here] == TM_UNCUT)
        return;
    const uint32_t *face = a->boundary->face[here];
    const uint32_t first = a->across.outer[across->face[f][0]];
    const bool by_even = first == face[0] || first == face[2];
    across->cut[f] =
        by_even == (a->boundary->cut[here] == TM_CUT_02) ? TM_CUT_02 : TM_CUT_13;
}

/* What the enclosed leaves see of the interior boundary. */
static tm_status find_across(assembler *a, const tm_interior *enclosed,
                             tm_interior_boundary *across, tm_error *error)
{
    tm_status status = tm_interior_boundary_find(across, a->octree, enclosed, error);
    if (status != TM_OK)
        return status;
    uint32_t *number = tm_new(a->octree->nodes, sizeof *number);
    a->across = (side){.interior = enclosed,
                       .boundary = across,
                       .outer = tm_new(across->nodes, sizeof *a->across.outer)};
    if (!number || !a->across.outer)
        status = tm_fail_memory(error);
    for (size_t s = 0; s < a->boundary->nodes && status == TM_OK; s++)
        number[a->boundary->grid_node[s]] = (uint32_t)s;
    for (size_t s = 0; s < across->nodes && status == TM_OK; s++)
        a->across.outer[s] = number[across->grid_node[s]];
    for (size_t f = 0; f < across->faces && status == TM_OK; f++)
        share_cut(a, f, across);
    free(number);
    return status;
}

/* What the assembly has of the other side, by the interior boundary's nodes and faces. */
static tm_status give_across(const assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    const side *s = &a->across;
    to->across = tm_new(a->boundary->nodes, sizeof *to->across);
    to->layer_across = tm_new(a->boundary->faces, sizeof *to->layer_across);
    if (!to->across || !to->layer_across)
        return tm_fail_memory(error);
    for (size_t i = 0; i < a->boundary->nodes; i++)
        to->across[i] = TM_NONE;
    for (size_t f = 0; f < a->boundary->faces; f++)
        to->layer_across[f] = TM_NONE;
    for (size_t i = 0; i < s->boundary->nodes; i++)
        to->across[s->outer[i]] = s->inner[i];
    for (size_t f = 0; f < s->boundary->faces; f++)
        to->layer_across[same_face(a, f)] = s->layer[f];
    return TM_OK;
}

static tm_status assemble(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_status status = number_core(a, error);
    if (status == TM_OK) {
        add_all(a, true);
        status = allocate(a, error);
    }
    if (status != TM_OK)
        return status;
    add_all(a, false);
    to->first[a->octree->leaves] = (uint32_t)a->elements;
    to->mesh.start[a->elements] = a->items;
    set_points(a);
    return a->across.interior ? give_across(a, error) : TM_OK;
}

tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_interior *interior, const tm_interior *enclosed,
                      const tm_interior_boundary *boundary, tm_error *error)
{
    *assembly = (tm_assembly){0};
    assembler a = {.octree = octree,
                   .boundary = boundary,
                   .assembly = assembly,
                   .inside = {.interior = interior, .boundary = boundary}};
    tm_interior_boundary across = {0};
    tm_status status = TM_OK;
    if (enclosed && enclosed->count > 0)
        status = find_across(&a, enclosed, &across, error);
    if (status == TM_OK)
        status = assemble(&a, error);
    assembly->core_node = a.inside.core_node;
    assembly->core_across = a.across.core_node;
    assembly->inner = a.inside.inner;
    assembly->layer = a.inside.layer;
    free(a.across.inner);
    free(a.across.outer);
    free(a.across.layer);
    tm_interior_boundary_free(&across);
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
    free(assembly->layer_across);
    free(assembly->inner);
    free(assembly->across);
    free(assembly->core_node);
    free(assembly->core_across);
    free(assembly->grid_node);
    *assembly = (tm_assembly){0};
}
