/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "assemble.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { CUT_ITEMS = 5 * 5 + 2 * 4, LEAF_CORNERS = 8 };

const tm_cut_face tm_cut_faces[3] = {[TM_CUT_02] = {{{0, 1, 2}, {2, 3, 0}}},
                                     [TM_CUT_13] = {{{1, 2, 3}, {3, 0, 1}}}};

typedef struct {
    const tm_octree *octree;
    const tm_solid *solid;
    const tm_skin *skin;
    tm_assembly *assembly;
    uint32_t *core_node; /* [nodes of the octree]: of the mesh */
    size_t next_face, next_middle, elements, items;
} assembler;

/* How large the mesh will be. */
typedef struct {
    size_t elements, items, middles;
} sizes;

static sizes count(const assembler *a)
{
    sizes s = {0};
    for (size_t l = 0; l < a->octree->leaves; l++) {
        if (!a->solid->chosen[l])
            continue;
        const tm_transition t =
            tm_transition_of(tm_solid_leaf_state(a->solid, a->octree, l));
        s.elements += t.pieces;
        s.middles += t.centre;
        for (unsigned i = 0; i < t.pieces; i++)
            s.items += t.piece[i].k;
    }
    for (size_t f = 0; f < a->skin->faces; f++) {
        const bool cut = a->skin->cut[f] != TM_UNCUT;
        s.elements += cut ? TM_CUT_ELEMENTS : 1;
        s.items += cut ? CUT_ITEMS : 2 * tm_skin_corners(a->skin, f);
        s.middles += cut;
    }
    return s;
}

static tm_status number_core(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    a->core_node = tm_new(a->octree->nodes, sizeof *a->core_node);
    to->inner = tm_new(a->skin->nodes, sizeof *to->inner);
    if (!a->core_node || !to->inner)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++)
        a->core_node[n] = a->solid->used[n] ? (uint32_t)to->core++ : TM_NONE;
    to->grid_node = tm_new(to->core, sizeof *to->grid_node);
    if (!to->grid_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < a->octree->nodes; n++)
        if (a->core_node[n] != TM_NONE)
            to->grid_node[a->core_node[n]] = (uint32_t)n;
    for (size_t s = 0; s < a->skin->nodes; s++)
        to->inner[s] = a->core_node[a->skin->grid_node[s]];
    to->outer = (uint32_t)to->core;
    return TM_OK;
}

static tm_status allocate(assembler *a, const sizes *s, tm_error *error)
{
    tm_assembly *to = a->assembly;
    tm_mixed_mesh *mesh = &to->mesh;
    mesh->nodes = to->core + a->skin->nodes + s->middles;
    mesh->elements = s->elements;
    if (mesh->nodes >= TM_NONE || mesh->elements >= TM_NONE)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "the mesh would have %zu nodes and %zu elements, more than 32 "
                       "bits can number",
                       mesh->nodes, mesh->elements);
    mesh->xyz = tm_new(mesh->nodes, sizeof *mesh->xyz);
    mesh->start = tm_new(mesh->elements + 1, sizeof *mesh->start);
    mesh->item = tm_new(s->items, sizeof *mesh->item);
    to->first = tm_new(a->octree->leaves + 1, sizeof *to->first);
    to->layer = tm_new(a->skin->faces, sizeof *to->layer);
    if (!mesh->xyz || !mesh->start || !mesh->item || !to->first || !to->layer)
        return tm_fail_memory(error);
    return TM_OK;
}

static void add_element(assembler *a, unsigned k, const uint32_t *node)
{
    tm_mixed_mesh *mesh = &a->assembly->mesh;
    mesh->start[a->elements++] = a->items;
    memcpy(mesh->item + a->items, node, k * sizeof *node);
    a->items += k;
}

static uint32_t new_middle(assembler *a, const double xyz[3])
{
    const size_t node = a->assembly->core + a->skin->nodes + a->next_middle++;
    memcpy(a->assembly->mesh.xyz[node], xyz, 3 * sizeof *xyz);
    return (uint32_t)node;
}

static void mean_of(const tm_mixed_mesh *mesh, const uint32_t *node, unsigned k,
                    double mean[3])
{
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (unsigned c = 0; c < k; c++)
            sum += mesh->xyz[node[c]][i];
        mean[i] = sum / k;
    }
}

static void add_leaf(assembler *a, size_t l)
{
    const tm_transition t = tm_transition_of(tm_solid_leaf_state(a->solid, a->octree, l));
    uint32_t at[TM_LEAF_CENTRE + 1];
    for (int p = 0; p < TM_LEAF_NODES; p++) {
        const uint32_t node = a->octree->node[l][p];
        at[p] = node == TM_NONE ? TM_NONE : a->core_node[node];
    }
    at[TM_LEAF_CENTRE] = TM_NONE;
    if (t.centre) {
        double centre[3];
        mean_of(&a->assembly->mesh, at, LEAF_CORNERS, centre);
        at[TM_LEAF_CENTRE] = new_middle(a, centre);
    }
    for (unsigned i = 0; i < t.pieces; i++) {
        uint32_t node[LEAF_CORNERS];
        for (unsigned c = 0; c < t.piece[i].k; c++)
            node[c] = at[t.piece[i].place[c]];
        add_element(a, t.piece[i].k, node);
    }
}

/* Under a face that is cut: a pyramid on each side and on the bottom, tetrahedra on top,
 * all with the node in the middle. in[] and out[] are the bottom's and the top's nodes. */
static void add_cut(assembler *a, tm_cut cut, const uint32_t in[4], const uint32_t out[4])
{
    double middle[3];
    uint32_t all[LEAF_CORNERS];
    memcpy(all, in, 4 * sizeof *in);
    memcpy(all + 4, out, 4 * sizeof *out);
    mean_of(&a->assembly->mesh, all, LEAF_CORNERS, middle);
    const uint32_t m = new_middle(a, middle);
    add_element(a, 5, (uint32_t[]){in[0], in[1], in[2], in[3], m});
    for (unsigned i = 0; i < 4; i++) {
        const unsigned j = (i + 1) % 4;
        add_element(a, 5, (uint32_t[]){in[i], out[i], out[j], in[j], m});
    }
    for (unsigned t = 0; t < 2; t++) {
        const uint8_t *corner = tm_cut_faces[cut].triangle[t];
        add_element(a, 4, (uint32_t[]){out[corner[0]], out[corner[2]], out[corner[1]], m});
    }
}

/* The layer's elements under the faces of leaf l. */
static void add_layer(assembler *a, size_t l)
{
    const tm_skin *skin = a->skin;
    for (; a->next_face < skin->faces && skin->leaf[a->next_face] == l; a->next_face++) {
        const size_t f = a->next_face;
        uint32_t in[4];
        uint32_t out[4];
        const unsigned k = tm_skin_corners(skin, f);
        a->assembly->layer[f] = (uint32_t)a->elements;
        for (unsigned i = 0; i < k; i++) {
            in[i] = a->assembly->inner[skin->face[f][i]];
            out[i] = a->assembly->outer + skin->face[f][i];
        }
        if (k == 3)
            add_element(a, 6, (uint32_t[]){out[0], out[1], out[2], in[0], in[1], in[2]});
        else if (skin->cut[f] == TM_UNCUT)
            add_element(a, LEAF_CORNERS,
                        (uint32_t[]){in[0], in[1], in[2], in[3], out[0], out[1], out[2],
                                     out[3]});
        else
            add_cut(a, skin->cut[f], in, out);
    }
}

/* Puts all nodes but the middles where they are to begin. */
static tm_status place_nodes(assembler *a, tm_error *error)
{
    tm_assembly *to = a->assembly;
    double(*xyz)[3] = to->mesh.xyz;
    for (size_t n = 0; n < to->core; n++)
        tm_octree_point(a->octree, a->octree->grid[to->grid_node[n]], xyz[n]);
    for (size_t s = 0; s < a->skin->nodes; s++)
        memcpy(xyz[to->outer + s], xyz[to->inner[s]], sizeof *xyz);
    /* The finest leaf at each node of the skin. */
    uint8_t *level = calloc(a->skin->nodes + 1, 1);
    if (!level)
        return tm_fail_memory(error);
    for (size_t f = 0; f < a->skin->faces; f++)
        for (unsigned i = 0; i < tm_skin_corners(a->skin, f); i++) {
            const uint32_t s = a->skin->face[f][i];
            const uint8_t here = a->octree->leaf[a->skin->leaf[f]].level;
            level[s] = here > level[s] ? here : level[s];
        }
    const double share = 0.3;
    for (size_t s = 0; s < a->skin->nodes; s++) {
        int outward[3];
        tm_octant_mask_outward(a->solid->mask[a->skin->grid_node[s]], outward);
        const double step = share * a->octree->side / (double)((uint32_t)1 << level[s]);
        for (int i = 0; i < 3; i++)
            xyz[to->inner[s]][i] -= step * outward[i];
    }
    free(level);
    return TM_OK;
}

tm_status tm_assemble(tm_assembly *assembly, const tm_octree *octree,
                      const tm_solid *solid, const tm_skin *skin, tm_error *error)
{
    *assembly = (tm_assembly){0};
    assembler a = {.octree = octree, .solid = solid, .skin = skin, .assembly = assembly};
    tm_status status = number_core(&a, error);
    if (status == TM_OK) {
        const sizes s = count(&a);
        status = allocate(&a, &s, error);
    }
    if (status == TM_OK)
        status = place_nodes(&a, error);
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++) {
        assembly->first[l] = a.elements;
        if (solid->chosen[l]) {
            add_leaf(&a, l);
            add_layer(&a, l);
        }
    }
    if (status == TM_OK) {
        assembly->first[octree->leaves] = a.elements;
        assembly->mesh.start[a.elements] = a.items;
    }
    free(a.core_node);
    return status;
}

void tm_assembly_free(tm_assembly *assembly)
{
    free(assembly->mesh.xyz);
    free(assembly->mesh.start);
    free(assembly->mesh.item);
    free(assembly->first);
    free(assembly->layer);
    free(assembly->inner);
    free(assembly->grid_node);
    *assembly = (tm_assembly){0};
}
