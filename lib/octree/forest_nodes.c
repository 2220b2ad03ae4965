/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes of an octree that is balanced over faces and edges. p4est visits each corner that
 * is one of all leaves around it, each edge that is one of all leaves around it (or a
 * pair's that is half as large), each face likewise. A node is such a corner, the middle
 * of such an edge where there are pairs, the middle of such a face where there are four;
 * and the leaves that are visited are all that touch it. */
#include "forest.h"

#include "../base/array.h"

#include <p8est_iterate.h>
#include <stdlib.h>

typedef struct numbering {
    uint32_t (*node)[TM_LEAF_NODES];
    size_t *first; /* [roots]: its first leaf */
    size_t nodes;
} numbering;

static void number_corner(p8est_iter_corner_info_t *info, void *user)
{
    numbering *n = user;
    const uint32_t id = (uint32_t)n->nodes++;
    for (size_t i = 0; i < info->sides.elem_count; i++) {
        const p8est_iter_corner_side_t *side =
            p8est_iter_cside_array_index(&info->sides, i);
        n->node[n->first[side->treeid] + (size_t)side->quadid][side->corner] = id;
    }
}

static void number_edge_side(numbering *n, const p8est_iter_edge_side_t *side,
                             uint32_t id)
{
    const size_t first = n->first[side->treeid];
    if (!side->is_hanging) {
        n->node[first + (size_t)side->is.full.quadid][TM_LEAF_EDGE + side->edge] = id;
        return;
    }
    /* Of the lower of the pair it is the upper end. */
    for (int i = 0; i < 2; i++)
        n->node[first + (size_t)side->is.hanging.quadid[i]]
               [p8est_edge_corners[side->edge][1 - i]] = id;
}

static void number_edge(p8est_iter_edge_info_t *info, void *user)
{
    bool split = false;
    for (size_t i = 0; i < info->sides.elem_count; i++)
        split |= p8est_iter_eside_array_index(&info->sides, i)->is_hanging != 0;
    if (!split)
        return;
    numbering *n = user;
    const uint32_t id = (uint32_t)n->nodes++;
    for (size_t i = 0; i < info->sides.elem_count; i++)
        number_edge_side(n, p8est_iter_eside_array_index(&info->sides, i), id);
}

static void number_face(p8est_iter_face_info_t *info, void *user)
{
    if (info->sides.elem_count < 2)
        return;
    const p8est_iter_face_side_t *side[2] = {
        p8est_iter_fside_array_index(&info->sides, 0),
        p8est_iter_fside_array_index(&info->sides, 1)};
    if (side[0]->is_hanging == side[1]->is_hanging)
        return;
    const p8est_iter_face_side_t *four = side[side[1]->is_hanging ? 1 : 0];
    const p8est_iter_face_side_t *one = side[side[1]->is_hanging ? 0 : 1];
    numbering *n = user;
    const uint32_t id = (uint32_t)n->nodes++;
    n->node[n->first[one->treeid] + (size_t)one->is.full.quadid]
           [TM_LEAF_FACE + one->face] = id;
    for (int i = 0; i < P8EST_HALF; i++)
        n->node[n->first[four->treeid] + (size_t)four->is.hanging.quadid[i]]
               [p8est_face_corners[four->face][P8EST_HALF - 1 - i]] = id;
}

/* Numbers the nodes anew in the order in which the leaves have them, and says where each
 * is. */
static void order_nodes(tm_octree *octree, uint32_t *number)
{
    uint32_t next = 0;
    for (size_t i = 0; i < octree->leaves; i++) {
        const tm_leaf *leaf = &octree->leaf[i];
        const unsigned half = TM_OCTREE_LEVEL_MAX - leaf->level;
        for (int place = 0; place < TM_LEAF_NODES; place++) {
            uint32_t *v = &octree->node[i][place];
            if (*v == TM_NONE)
                continue;
            if (number[*v] == TM_NONE) {
                for (int k = 0; k < 3; k++)
                    octree->grid[next][k] =
                        leaf->anchor[k] + ((uint32_t)tm_leaf_place[place][k] << half);
                number[*v] = next++;
            }
            *v = number[*v];
        }
    }
}

static tm_status place_nodes(tm_octree *octree, tm_error *error)
{
    uint32_t *number = tm_new(octree->nodes, sizeof *number);
    octree->grid = tm_new(octree->nodes, sizeof *octree->grid);
    if (!number || !octree->grid) {
        free(number);
        return tm_fail_memory(error);
    }
    for (size_t v = 0; v < octree->nodes; v++)
        number[v] = TM_NONE;
    order_nodes(octree, number);
    free(number);
    return TM_OK;
}

static void iterate(numbering *n, p8est_t *forest)
{
    const size_t trees = forest->trees->elem_count;
    for (size_t t = 0; t < trees; t++)
        n->first[t] = (size_t)p8est_tree_array_index(forest->trees, (p4est_topidx_t)t)
                          ->quadrants_offset;
    p8est_iterate(forest, NULL, n, NULL, number_face, number_edge, number_corner);
}

tm_status tm_forest_nodes(tm_octree *octree, p8est_t *forest, tm_error *error)
{
    numbering n = {.node = tm_new(octree->leaves, sizeof *octree->node),
                   .first = tm_new(forest->trees->elem_count, sizeof *n.first)};
    octree->node = n.node;
    if (!n.node || !n.first) {
        free(n.first);
        return tm_fail_memory(error);
    }
    for (size_t i = 0; i < octree->leaves; i++)
        for (int place = TM_LEAF_EDGE; place < TM_LEAF_NODES; place++)
            n.node[i][place] = TM_NONE;
    iterate(&n, forest);
    free(n.first);
    octree->nodes = n.nodes;
    if (n.nodes >= TM_NONE)
        return tm_fail(error, TM_ERROR_INPUT, "the octree has more than %u nodes",
                       TM_NONE);
    return place_nodes(octree, error);
}
