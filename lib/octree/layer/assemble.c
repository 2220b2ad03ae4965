/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assemble.h"

#include "../../base/array.h"
#include "../../base/ids.h"
#include "../../base/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_CORNERS = 8, LEAF_FACES = 6, MOST_NODES = 8 };

const uint8_t tm_cut_triangles[3][2][3] = {
    [TM_CUT_02] = {{0, 1, 2}, {2, 3, 0}}, [TM_CUT_13] = {{1, 2, 3}, {3, 0, 1}}};

/* The leaves of a part. */
typedef struct {
    const tm_interior *interior;
    const tm_interior_boundary *boundary; /* `own`, or of the only part all of it */
    tm_interior_boundary own;
    uint32_t *core_node; /* [nodes of the octree]: of the mesh, or TM_NONE */
    uint32_t *inner;     /* [nodes of its boundary] */
    uint32_t *outer;     /* [nodes of its boundary]: of the interior boundary; NULL: the
                            same */
    uint32_t *layer;     /* [faces of its boundary] */
} side;

typedef struct {
    const tm_octree *octree;
    const tm_interior_boundary *boundary;
    tm_assembly *assembly;
    size_t sides;
    side *side;
    size_t middles, elements, items; /* of all leaves */
    struct filler *chunk;            /* [chunks of leaves] */
    size_t *face;                    /* [chunks][sides]: where a chunk is */
} assembler;

/* The elements of a chunk of leaves: counted, or written behind those before it. */
typedef struct filler {
    const assembler *all;
    bool counting;                   /* nothing is written yet */
    size_t middles, elements, items; /* so far */
    const side *at;                  /* that of the leaf */
    size_t *face;                    /* the face of its boundary that comes next */
} filler;

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
    tm_status status = TM_OK;
    for (size_t p = 0; p < a->sides && status == TM_OK; p++)
        status = number_side(a, &a->side[p], error);
    if (status != TM_OK)
        return status;
    to->grid_node = tm_new(to->core, sizeof *to->grid_node);
    if (!to->grid_node)
        return tm_fail_memory(error);
    for (size_t p = 0; p < a->sides; p++)
        for (size_t n = 0; n < a->octree->nodes; n++)
            if (a->side[p].core_node[n] != TM_NONE)
                to->grid_node[a->side[p].core_node[n]] = (uint32_t)n;
    to->outer = (uint32_t)to->core;
    return TM_OK;
}

static tm_status allocate(const assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_mixed_mesh *mesh = &to->mesh;
    mesh->nodes = to->core + a->boundary->nodes + a->middles;
    mesh->elements = a->elements;
    mesh->threads = a->octree->threads;
    if (mesh->nodes >= TM_IDS || mesh->elements >= TM_IDS)
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

static void add_element(filler *a, unsigned k, const uint32_t *node)
{
    tm_mixed_mesh *mesh = &a->all->assembly->mesh;
    if (!a->counting) {
        mesh->start[a->elements] = a->items;
        memcpy(mesh->item + a->items, node, k * sizeof *node);
    }
    a->elements++;
    a->items += k;
}

/* A node in the middle of leaf l. */
static uint32_t new_middle(filler *a, size_t l)
{
    if (!a->counting)
        a->all->assembly->middle_leaf[a->middles] = (uint32_t)l;
    return (uint32_t)(a->all->assembly->core + a->all->boundary->nodes + a->middles++);
}

/* The element between a face of a leaf, whose k nodes turn counter-clockwise seen from
 * outside, and the node in the middle of the leaf. */
static void add_to_middle(filler *a, unsigned k, const uint32_t *face, uint32_t middle)
{
    uint32_t node[MOST_NODES];
    for (unsigned i = 0; i < k; i++)
        node[i] = face[k - 1 - i]; /* counter-clockwise seen from the middle */
    node[k] = middle;
    add_element(a, k + 1, node);
}

/* Whether the face of the interior boundary that comes next is that piece of leaf l. */
static bool is_next(const filler *a, size_t face, size_t l, unsigned piece)
{
    const tm_interior_boundary *boundary = a->at->boundary;
    return face < boundary->faces && boundary->leaf[face] == l &&
           boundary->piece[face] == piece;
}

/* Divides a leaf from its centre, with the pieces of its faces that are cut as triangles.
 */
static void add_star(filler *a, size_t l, const uint32_t at[TM_LEAF_NODES])
{
    const tm_leaf_state state =
        tm_interior_leaf_state(a->at->interior, a->all->octree, l);
    const uint32_t middle = new_middle(a, l);
    size_t next = *a->face;
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

static bool has_cut(const filler *a, size_t l)
{
    const tm_interior_boundary *boundary = a->at->boundary;
    for (size_t f = *a->face; f < boundary->faces && boundary->leaf[f] == l; f++)
        if (boundary->cut[f] != TM_UNCUT)
            return true;
    return false;
}

static void add_leaf(filler *a, size_t l)
{
    uint32_t at[TM_LEAF_CENTRE + 1];
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = a->all->octree->node[l][p];
        at[p] = node == TM_NONE ? TM_NONE : a->at->core_node[node];
    }
    if (has_cut(a, l)) {
        add_star(a, l, at);
        return;
    }
    const tm_transition t =
        tm_transition_of(tm_interior_leaf_state(a->at->interior, a->all->octree, l));
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
static void add_wedge(filler *a, const uint32_t *in, const uint32_t *out,
                      const uint8_t c[3])
{
    add_element(
        a, 6,
        (uint32_t[]){out[c[0]], out[c[1]], out[c[2]], in[c[0]], in[c[1]], in[c[2]]});
}

/* The layer's elements under the faces of leaf l. */
static void add_layer(filler *a, size_t l)
{
    const side *s = a->at;
    const tm_interior_boundary *boundary = s->boundary;
    for (; *a->face < boundary->faces && boundary->leaf[*a->face] == l; ++*a->face) {
        const size_t f = *a->face;
        uint32_t in[4];
        uint32_t out[4];
        const unsigned k = tm_boundary_face_corners(boundary, f);
        if (!a->counting)
            s->layer[f] = (uint32_t)a->elements;
        for (unsigned i = 0; i < k; i++) {
            const uint32_t node = boundary->face[f][i];
            in[i] = s->inner[node];
            out[i] = a->all->assembly->outer + (s->outer ? s->outer[node] : node);
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

/* The elements of a chunk, leaf by leaf. */
static void fill_chunk(void *context, size_t first, size_t past)
{
    const assembler *a = context;
    filler *f = &a->chunk[first / TM_CHUNK];
    size_t *face = a->face + first / TM_CHUNK * a->sides;
    for (size_t p = 0; p < a->sides; p++) {
        const tm_interior_boundary *boundary = a->side[p].boundary;
        face[p] = tm_first_not_below(boundary->leaf, boundary->faces, (uint32_t)first);
    }
    for (size_t l = first; l < past; l++) {
        if (!f->counting)
            a->assembly->first[l] = (uint32_t)f->elements;
        size_t p = 0;
        while (p < a->sides && !a->side[p].interior->chosen[l])
            p++;
        if (p == a->sides)
            continue;
        f->at = &a->side[p];
        f->face = &face[p];
        add_leaf(f, l);
        add_layer(f, l);
    }
}

/* Counts what all leaves have, and where that of each chunk begins. */
static tm_status count_all(assembler *a, tm_error *error)
{
    const size_t leaves = a->octree->leaves;
    const size_t chunks = tm_parallel_chunks(leaves, TM_CHUNK);
    a->chunk = tm_new(chunks, sizeof *a->chunk);
    a->face = tm_new(chunks * a->sides, sizeof *a->face);
    if (!a->chunk || !a->face)
        return tm_fail_memory(error);
    for (size_t c = 0; c < chunks; c++)
        a->chunk[c] = (filler){.all = a, .counting = true};
    tm_parallel_runs(a->octree->threads, leaves, TM_CHUNK, fill_chunk, a);
    for (size_t c = 0; c < chunks; c++) {
        const filler counted = a->chunk[c];
        a->chunk[c] = (filler){
            .all = a, .middles = a->middles, .elements = a->elements, .items = a->items};
        a->middles += counted.middles;
        a->elements += counted.elements;
        a->items += counted.items;
    }
    return TM_OK;
}

static void set_core_points(void *context, size_t first, size_t past)
{
    const assembler *a = context;
    const tm_assembly *to = a->assembly;
    for (size_t n = first; n < past; n++)
        tm_octree_point(a->octree, a->octree->grid[to->grid_node[n]], to->mesh.xyz[n]);
}

static void set_middle_points(void *context, size_t first, size_t past)
{
    const assembler *a = context;
    const tm_assembly *to = a->assembly;
    double(*xyz)[3] = to->mesh.xyz + to->core + a->boundary->nodes;
    for (size_t m = first; m < past; m++)
        tm_leaf_centre(a->octree, &a->octree->leaf[to->middle_leaf[m]], xyz[m]);
}

/* All nodes on the lattice. */
static void set_points(assembler *a)
{
    const tm_assembly *to = a->assembly;
    const unsigned threads = a->octree->threads;
    tm_parallel_runs(threads, to->core, TM_CHUNK, set_core_points, a);
    for (size_t s = 0; s < a->boundary->nodes; s++)
        tm_boundary_node_point(a->boundary, s, to->mesh.xyz[to->outer + s]);
    tm_parallel_runs(threads, to->middles, TM_CHUNK, set_middle_points, a);
}

/* The face of the interior boundary that a face of a part's is. */
static size_t same_face(const assembler *a, const side *s, size_t f)
{
    const tm_interior_boundary *boundary = a->boundary;
    const uint32_t *given = s->boundary->face[f];
    const unsigned k = tm_boundary_face_corners(s->boundary, f);
    const uint32_t first = s->outer[given[0]];
    for (size_t i = boundary->around_start[first]; i < boundary->around_start[first + 1];
         i++) {
        const size_t here = boundary->around[i];
        unsigned common = 0;
        for (unsigned c = 0; c < k; c++)
            for (unsigned d = 0; d < tm_boundary_face_corners(boundary, here); d++)
                common += s->outer[given[c]] == boundary->face[here][d];
        if (common == k && tm_boundary_face_corners(boundary, here) == k)
            return here;
    }
    return TM_NONE;
}

/* Both sides cut a face by the same diagonal. */
static void share_cut(const assembler *a, side *s, size_t f)
{
    const size_t here = same_face(a, s, f);
    if (a->boundary->cut[here] == TM_UNCUT)
        return;
    const uint32_t *face = a->boundary->face[here];
    const uint32_t first = s->outer[s->own.face[f][0]];
    const bool by_even = first == face[0] || first == face[2];
    s->own.cut[f] =
        by_even == (a->boundary->cut[here] == TM_CUT_02) ? TM_CUT_02 : TM_CUT_13;
}

/* What a part has of the interior boundary. */
static tm_status find_own(const assembler *a, side *s, tm_error *error)
{
    tm_status status = tm_interior_boundary_find(&s->own, a->octree, s->interior, error);
    if (status != TM_OK)
        return status;
    uint32_t *number = tm_new(a->octree->nodes, sizeof *number);
    s->outer = tm_new(s->own.nodes, sizeof *s->outer);
    if (!number || !s->outer)
        status = tm_fail_memory(error);
    for (size_t i = 0; i < a->boundary->nodes && status == TM_OK; i++)
        number[a->boundary->grid_node[i]] = (uint32_t)i;
    for (size_t i = 0; i < s->own.nodes && status == TM_OK; i++)
        s->outer[i] = number[s->own.grid_node[i]];
    for (size_t f = 0; f < s->own.faces && status == TM_OK; f++)
        share_cut(a, s, f);
    free(number);
    return status;
}

static uint32_t *all_none(size_t count)
{
    uint32_t *array = tm_new(count, sizeof *array);
    for (size_t i = 0; array && i < count; i++)
        array[i] = TM_NONE;
    return array;
}

/* What the assembly has of the parts, by the interior boundary's nodes and faces. */
static tm_status give_sides(const assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    to->layer = all_none(a->boundary->faces);
    to->layer_across = all_none(a->boundary->faces);
    if (!to->layer || !to->layer_across)
        return tm_fail_memory(error);
    for (size_t p = 0; p < a->sides; p++) {
        const side *s = &a->side[p];
        to->inner[p] = all_none(a->boundary->nodes);
        if (!to->inner[p])
            return tm_fail_memory(error);
        for (size_t i = 0; i < s->own.nodes; i++)
            to->inner[p][s->outer[i]] = s->inner[i];
        for (size_t f = 0; f < s->own.faces; f++) {
            const size_t here = same_face(a, s, f);
            const bool across = a->boundary->leaf[here] != s->own.leaf[f];
            (across ? to->layer_across : to->layer)[here] = s->layer[f];
        }
    }
    return TM_OK;
}

static tm_status assemble(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_status status = number_core(a, error);
    if (status == TM_OK)
        status = count_all(a, error);
    if (status == TM_OK)
        status = allocate(a, error);
    if (status != TM_OK)
        return status;
    tm_parallel_runs(a->octree->threads, a->octree->leaves, TM_CHUNK, fill_chunk, a);
    to->first[a->octree->leaves] = (uint32_t)a->elements;
    to->mesh.start[a->elements] = a->items;
    set_points(a);
    if (a->sides > 1)
        return give_sides(a, error);
    to->inner[0] = a->side->inner;
    to->layer = a->side->layer;
    a->side->inner = a->side->layer = NULL;
    return TM_OK;
}

static tm_status start_sides(assembler *a, const tm_interior *part, tm_error *error)
{
    tm_assembly *to = a->assembly;
    a->side = calloc(a->sides, sizeof *a->side);
    to->core_node = calloc(a->sides, sizeof *to->core_node);
    to->inner = calloc(a->sides, sizeof *to->inner);
    if (!a->side || !to->core_node || !to->inner)
        return tm_fail_memory(error);
    to->parts = a->sides;
    tm_status status = TM_OK;
    for (size_t p = 0; p < a->sides && status == TM_OK; p++) {
        side *s = &a->side[p];
        *s = (side){.interior = &part[p], .boundary = a->boundary};
        if (a->sides == 1)
            break;
        s->boundary = &s->own;
        status = find_own(a, s, error);
    }
    return status;
}

static void end_sides(assembler *a)
{
    for (size_t p = 0; a->side && p < a->sides; p++) {
        side *s = &a->side[p];
        if (p < a->assembly->parts)
            a->assembly->core_node[p] = s->core_node;
        free(s->inner);
        free(s->outer);
        free(s->layer);
        tm_interior_boundary_free(&s->own);
    }
    free(a->side);
}

tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_interior *part, size_t parts,
                      const tm_interior_boundary *boundary, tm_error *error)
{
    *assembly = (tm_assembly){0};
    assembler a = {
        .octree = octree, .boundary = boundary, .assembly = assembly, .sides = parts};
    tm_status status = start_sides(&a, part, error);
    if (status == TM_OK)
        status = assemble(&a, error);
    end_sides(&a);
    free(a.chunk);
    free(a.face);
    return status;
}

void tm_assembly_free(tm_assembly *assembly)
{
    for (size_t p = 0; p < assembly->parts; p++) {
        free(assembly->core_node[p]);
        free(assembly->inner[p]);
    }
    free(assembly->mesh.xyz);
    free(assembly->mesh.start);
    free(assembly->mesh.item);
    free(assembly->middle_leaf);
    free(assembly->first);
    free(assembly->layer);
    free(assembly->layer_across);
    free(assembly->inner);
    free(assembly->core_node);
    free(assembly->grid_node);
    *assembly = (tm_assembly){0};
}
