/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_share.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>

tm_own_range tm_own_range_of(const uint32_t *place, size_t count, size_t first,
                             size_t past)
{
    tm_own_range own = {.first = tm_first_not_below(place, count, (uint32_t)first),
                        .past = tm_first_not_below(place, count, (uint32_t)past)};
    own.number = tm_ranks_before(own.past - own.first, &own.all);
    return own;
}

/* Numbers own nodes: those of a range, whose first one is node `at` here, and `before`
 * ranges of whole meshes. */
static void number_own(uint32_t *number, tm_own_range own, size_t at, size_t before)
{
    for (size_t i = own.first; i < own.past; i++)
        number[at + i] = (uint32_t)(before + own.number + i - own.first);
}

static tm_status find_ghosts(tm_mesh_share *s, const tm_assembly *a,
                             const tm_interior_boundary *boundary, tm_error *error)
{
    const tm_octree *octree = &s->of->octree;
    uint32_t *outer = tm_new(octree->nodes, sizeof *outer);
    uint32_t *middle = tm_new(octree->leaves, sizeof *middle);
    tm_status status = tm_ranks_enough(outer && middle, error);
    for (size_t n = 0; status == TM_OK && n < octree->nodes; n++)
        outer[n] = TM_NONE;
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++)
        middle[l] = TM_NONE;
    for (size_t i = 0; status == TM_OK && i < boundary->nodes; i++)
        outer[boundary->grid_node[i]] = (uint32_t)(a->outer + i);
    for (size_t m = 0; status == TM_OK && m < a->middles; m++)
        middle[a->middle_leaf[m]] = (uint32_t)(a->core + boundary->nodes + m);
    const uint32_t *of_node[] = {a->core_node[0], outer};
    if (status == TM_OK)
        status = tm_mesh_ghosts_find(&s->ghosts, s->of, of_node, 2, middle, error);
    free(outer);
    free(middle);
    return status;
}

tm_status tm_mesh_share_find(tm_mesh_share *s, const tm_octree_share *of,
                             const tm_assembly *a, const tm_interior_boundary *boundary,
                             tm_error *error)
{
    *s = (tm_mesh_share){.of = of, .number = tm_new(a->mesh.nodes, sizeof *s->number)};
    s->core =
        tm_own_range_of(a->grid_node, a->core, of->own_node_first, of->own_node_past);
    s->outer = tm_own_range_of(boundary->grid_node, boundary->nodes, of->own_node_first,
                               of->own_node_past);
    s->middles = tm_own_range_of(a->middle_leaf, a->middles, of->own_first, of->own_past);
    s->faces =
        tm_own_range_of(boundary->leaf, boundary->faces, of->own_first, of->own_past);
    s->elements.first = a->first[of->own_first];
    s->elements.past = a->first[of->own_past];
    s->elements.number =
        tm_ranks_before(s->elements.past - s->elements.first, &s->elements.all);
    s->nodes = s->core.all + s->outer.all + s->middles.all;
    if (s->nodes >= TM_NONE || s->elements.all >= TM_NONE)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "the mesh would have %zu nodes and %zu elements, more than 32 "
                       "bits can number",
                       s->nodes, s->elements.all);
    tm_status status = tm_ranks_enough(s->number, error);
    if (status == TM_OK)
        status = find_ghosts(s, a, boundary, error);
    if (status != TM_OK)
        return status;
    number_own(s->number, s->core, 0, 0);
    number_own(s->number, s->outer, a->outer, s->core.all);
    number_own(s->number, s->middles, a->core + boundary->nodes,
               s->core.all + s->outer.all);
    tm_mesh_ghosts_fill(&s->ghosts, s->number, sizeof *s->number);
    return TM_OK;
}

void tm_mesh_share_free(tm_mesh_share *s)
{
    free(s->number);
    tm_mesh_ghosts_free(&s->ghosts);
    *s = (tm_mesh_share){0};
}

uint32_t tm_mesh_share_node(const tm_mesh_share *s, const tm_assembly *a, uint32_t number)
{
    const size_t nodes = a->mesh.nodes, middle = nodes - a->middles;
    size_t first = 0, past = a->core;
    if (number >= s->core.all) {
        first = number < s->core.all + s->outer.all ? a->outer : middle;
        past = first == middle ? nodes : middle;
    }
    const size_t n = first + tm_first_not_below(s->number + first, past - first, number);
    return n < past && s->number[n] == number ? (uint32_t)n : TM_NONE;
}
