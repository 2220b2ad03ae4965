/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_boundary.h"

#include "../../base/array.h"

#include <stdlib.h>

enum { LEAF_FACES = 6, LEAF_EDGES = 12 };

typedef struct {
    const tm_octree *octree;
    const tm_solid *solid;
    tm_skin *skin;
    uint32_t *skin_node; /* [nodes of the octree]: TM_NONE where it is none */
    size_t face_room, leaf_room, piece_room;
} finder;

tm_leaf_state tm_solid_leaf_state(const tm_solid *solid, const tm_octree *octree,
                                  size_t leaf)
{
    tm_leaf_state state = 0;
    for (int i = 0; i < TM_LEAF_STATE_BITS; i++) {
        const uint32_t node = octree->node[leaf][TM_LEAF_EDGE + i];
        if (node != TM_NONE && solid->used[node])
            state |= 1u << i;
    }
    return state;
}

/* The nodes of the mesh whose octants are not all filled. */
static tm_status number_nodes(finder *find, tm_error *error)
{
    const tm_octree *octree = find->octree;
    const tm_solid *solid = find->solid;
    tm_skin *skin = find->skin;
    find->skin_node = tm_new(octree->nodes, sizeof *find->skin_node);
    if (!find->skin_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < octree->nodes; n++) {
        const bool on_skin = solid->used[n] && solid->mask[n] != TM_ALL_OCTANTS;
        find->skin_node[n] = on_skin ? (uint32_t)skin->nodes++ : TM_NONE;
    }
    skin->grid_node = tm_new(skin->nodes, sizeof *skin->grid_node);
    if (!skin->grid_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < octree->nodes; n++)
        if (find->skin_node[n] != TM_NONE)
            skin->grid_node[find->skin_node[n]] = (uint32_t)n;
    return TM_OK;
}

/* Whether nothing is chosen beyond face f of a leaf at its corner `place`. */
static bool is_open(const finder *find, size_t leaf, unsigned f, unsigned place)
{
    const uint32_t node = find->octree->node[leaf][place];
    const unsigned own = tm_place_octants[place];
    const unsigned step = 1u << f / 2;
    const unsigned beyond = f % 2 ? own << step : own >> step;
    return !(find->solid->mask[node] & beyond);
}

/* A corner of the leaf on face f that a piece has, or where it has none, any one: then
 * all of the face has the same beyond it. */
static unsigned corner_of(unsigned f, const tm_piece *piece)
{
    for (unsigned i = 0; i < piece->k; i++)
        if (piece->place[i] < TM_LEAF_EDGE)
            return piece->place[i];
    return f % 2 ? 1u << f / 2 : 0;
}

static tm_status add_face(finder *find, size_t leaf, const tm_piece *piece,
                          unsigned which, tm_error *error)
{
    tm_skin *skin = find->skin;
    void *face =
        tm_grow(skin->face, &find->face_room, skin->faces + 1, sizeof *skin->face);
    if (!face)
        return tm_fail_memory(error);
    skin->face = face;
    void *leaves =
        tm_grow(skin->leaf, &find->leaf_room, skin->faces + 1, sizeof *skin->leaf);
    if (!leaves)
        return tm_fail_memory(error);
    skin->leaf = leaves;
    void *pieces =
        tm_grow(skin->piece, &find->piece_room, skin->faces + 1, sizeof *skin->piece);
    if (!pieces)
        return tm_fail_memory(error);
    skin->piece = pieces;
    skin->piece[skin->faces] = (uint8_t)which;
    uint32_t *corner = skin->face[skin->faces];
    corner[3] = TM_NONE;
    for (unsigned i = 0; i < piece->k; i++)
        corner[i] = find->skin_node[find->octree->node[leaf][piece->place[i]]];
    skin->leaf[skin->faces++] = (uint32_t)leaf;
    return TM_OK;
}

static bool has_skin(const finder *find, size_t leaf)
{
    for (int p = 0; p < TM_LEAF_EDGE; p++)
        if (find->solid->mask[find->octree->node[leaf][p]] != TM_ALL_OCTANTS)
            return true;
    return false;
}

static tm_status add_faces_of(finder *find, size_t leaf, tm_error *error)
{
    if (!has_skin(find, leaf))
        return TM_OK;
    const tm_leaf_state state = tm_solid_leaf_state(find->solid, find->octree, leaf);
    for (unsigned f = 0; f < LEAF_FACES; f++) {
        tm_piece piece[TM_FACE_PIECES];
        const unsigned pieces = tm_face_pieces(state, f, piece);
        for (unsigned i = 0; i < pieces; i++) {
            if (!is_open(find, leaf, f, corner_of(f, &piece[i])))
                continue;
            const tm_status status =
                add_face(find, leaf, &piece[i], TM_FACE_PIECES * f + i, error);
            if (status != TM_OK)
                return status;
        }
    }
    return TM_OK;
}

/* The faces around each node. */
static tm_status find_around(tm_skin *skin, tm_error *error)
{
    skin->around_start = calloc(skin->nodes + 2, sizeof *skin->around_start);
    skin->around = tm_new(4 * skin->faces, sizeof *skin->around);
    skin->cut = calloc(skin->faces + 1, sizeof *skin->cut);
    if (!skin->around_start || !skin->around || !skin->cut)
        return tm_fail_memory(error);
    size_t *end = skin->around_start + 1; /* of the faces of a node, when all are in */
    for (size_t f = 0; f < skin->faces; f++)
        for (unsigned i = 0; i < tm_skin_corners(skin, f); i++)
            end[skin->face[f][i] + 1]++;
    for (size_t n = 0; n < skin->nodes; n++)
        end[n + 1] += end[n];
    for (size_t f = 0; f < skin->faces; f++)
        for (unsigned i = 0; i < tm_skin_corners(skin, f); i++)
            skin->around[end[skin->face[f][i]]++] = (uint32_t)f;
    return TM_OK;
}

tm_status tm_skin_find(tm_skin *skin, const tm_octree *octree, const tm_solid *solid,
                       tm_error *error)
{
    *skin = (tm_skin){0};
    finder find = {.octree = octree, .solid = solid, .skin = skin};
    tm_status status = number_nodes(&find, error);
    for (size_t l = 0; status == TM_OK && l < octree->leaves; l++)
        if (solid->chosen[l])
            status = add_faces_of(&find, l, error);
    if (status == TM_OK)
        status = find_around(skin, error);
    free(find.skin_node);
    return status;
}

void tm_skin_free(tm_skin *skin)
{
    free(skin->grid_node);
    free(skin->face);
    free(skin->leaf);
    free(skin->piece);
    free(skin->cut);
    free(skin->around_start);
    free(skin->around);
    *skin = (tm_skin){0};
}
