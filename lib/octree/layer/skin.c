/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "skin.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <stdlib.h>
#include <string.h>

/* The numbers of the faces of ghosts: each leaf knows its first. */
static tm_status number_faces(tm_boundary_share *s, const tm_octree_share *of,
                              const tm_interior_boundary *boundary, uint32_t *first,
                              tm_error *error)
{
    for (size_t f = boundary->faces; f-- > 0;)
        first[boundary->leaf[f]] = (uint32_t)(s->faces.number + f - s->faces.first);
    const tm_status status = tm_share_fill_leaves(of, first, sizeof *first, error);
    for (size_t f = 0, i = 0; status == TM_OK && f < boundary->faces; f++) {
        i = f > 0 && boundary->leaf[f] == boundary->leaf[f - 1] ? i + 1 : 0;
        s->face_number[f] = first[boundary->leaf[f]] + (uint32_t)i;
    }
    return status;
}

static tm_status number_nodes(tm_boundary_share *s, const tm_octree_share *of,
                              const tm_interior_boundary *boundary, uint32_t *here,
                              tm_error *error)
{
    for (size_t n = 0; n < of->octree.nodes; n++)
        here[n] = TM_NONE;
    for (size_t i = 0; i < boundary->nodes; i++)
        here[boundary->grid_node[i]] = (uint32_t)i;
    for (size_t i = s->nodes.first; i < s->nodes.past; i++)
        s->number[i] = (uint32_t)(s->nodes.number + i - s->nodes.first);
    const uint32_t *const of_node[] = {here};
    const tm_status status = tm_mesh_ghosts_find(&s->ghosts, of, of_node, 1, NULL, error);
    if (status == TM_OK)
        tm_mesh_ghosts_fill(&s->ghosts, s->number, sizeof *s->number);
    return status;
}

tm_status tm_boundary_share_find(tm_boundary_share *s, const tm_octree_share *of,
                                 const tm_interior_boundary *boundary, tm_error *error)
{
    uint32_t *first = tm_new(of->octree.leaves, sizeof *first);
    uint32_t *here = tm_new(of->octree.nodes, sizeof *here);
    *s = (tm_boundary_share){
        .nodes = tm_own_range_of(boundary->grid_node, boundary->nodes, of->own_node_first,
                                 of->own_node_past),
        .faces =
            tm_own_range_of(boundary->leaf, boundary->faces, of->own_first, of->own_past),
        .number = tm_new(boundary->nodes, sizeof *s->number),
        .face_number = tm_new(boundary->faces, sizeof *s->face_number)};
    tm_status status =
        first && here && s->number && s->face_number ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = number_nodes(s, of, boundary, here, error);
    if (status == TM_OK)
        status = number_faces(s, of, boundary, first, error);
    free(first);
    free(here);
    return status;
}

void tm_boundary_share_free(tm_boundary_share *s)
{
    free(s->number);
    free(s->face_number);
    tm_mesh_ghosts_free(&s->ghosts);
    *s = (tm_boundary_share){0};
}

tm_status tm_own_share(tm_own_range own, const void *items, size_t size, void **all,
                       tm_error *error)
{
    const char *from = (const char *)items + own.first * size;
    return tm_ranks_share(from, own.past - own.first, size, all, NULL, error);
}

/* The faces by the numbers of their nodes. */
static tm_status share_faces(tm_interior_boundary *skin, const tm_boundary_share *s,
                             const tm_interior_boundary *boundary, tm_error *error)
{
    const size_t count = s->faces.past - s->faces.first;
    uint32_t(*face)[4] = tm_new(count, sizeof *face);
    void *faces = NULL, *cut = NULL;
    tm_status status = tm_ranks_enough(face, error);
    for (size_t f = 0; status == TM_OK && f < count; f++)
        for (int i = 0; i < 4; i++) {
            const uint32_t n = boundary->face[s->faces.first + f][i];
            face[f][i] = n == TM_NONE ? n : s->number[n];
        }
    if (status == TM_OK)
        status = tm_own_share((tm_own_range){.past = count}, face, sizeof *face, &faces,
                              error);
    if (status == TM_OK)
        status =
            tm_own_share(s->faces, boundary->cut, sizeof *boundary->cut, &cut, error);
    free(face);
    skin->face = faces;
    skin->cut = cut;
    return status;
}

tm_status tm_skin_share(tm_interior_boundary *skin, const tm_boundary_share *s,
                        const tm_interior_boundary *boundary, tm_error *error)
{
    double coarsest = boundary->faces > 0 ? boundary->coarsest : boundary->finest;
    void *grid = NULL, *size = NULL;
    tm_ranks_least(&coarsest, 1);
    *skin = (tm_interior_boundary){.side = boundary->side,
                                   .finest = boundary->finest,
                                   .coarsest = (unsigned)coarsest};
    memcpy(skin->low, boundary->low, sizeof skin->low);
    tm_status status =
        tm_own_share(s->nodes, boundary->grid, sizeof *boundary->grid, &grid, error);
    if (status == TM_OK)
        status =
            tm_own_share(s->nodes, boundary->size, sizeof *boundary->size, &size, error);
    if (status == TM_OK)
        status = share_faces(skin, s, boundary, error);
    skin->grid = grid;
    skin->size = size;
    skin->nodes = s->nodes.all;
    skin->faces = s->faces.all;
    if (status == TM_OK)
        status = tm_interior_boundary_find_around(skin, error);
    return tm_ranks_agree(status, error);
}
