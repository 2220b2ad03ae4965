/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_boundary.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_FACES = 6, LEAF_EDGES = 12 };

typedef struct {
    const tm_octree *octree;
    const tm_interior *part;
    size_t parts;
    const tm_interior *interior; /* the part whose faces are found */
    tm_interior_boundary *boundary;
    uint32_t *boundary_node; /* [nodes of the octree]: TM_NONE where it is none */
    size_t face_room, leaf_room, piece_room, region_room;
} finder;

tm_leaf_state tm_interior_leaf_state(const tm_interior *interior, const tm_octree *octree,
                                     size_t leaf)
{
    tm_leaf_state state = 0;
    for (int i = 0; i < TM_LEAF_STATE_BITS; i++) {
        const uint32_t node = octree->node[leaf][TM_LEAF_EDGE + i];
        if (node != TM_NONE && interior->used[node])
            state |= 1u << i;
    }
    return state;
}

/* The nodes of the mesh whose octants are filled in part. */
static tm_status number_nodes(finder *find, tm_error *error)
{
    const tm_octree *octree = find->octree;
    tm_interior_boundary *boundary = find->boundary;
    find->boundary_node = tm_new(octree->nodes, sizeof *find->boundary_node);
    if (!find->boundary_node)
        return tm_fail_memory(error);
    for (size_t n = 0; n < octree->nodes; n++) {
        bool on_boundary = false;
        for (size_t p = 0; p < find->parts; p++)
            on_boundary |= find->part[p].used[n] && find->part[p].mask[n] != 0 &&
                           find->part[p].mask[n] != TM_ALL_OCTANTS;
        find->boundary_node[n] = on_boundary ? (uint32_t)boundary->nodes++ : TM_NONE;
    }
    boundary->grid_node = tm_new(boundary->nodes, sizeof *boundary->grid_node);
    boundary->grid = tm_new(boundary->nodes, sizeof *boundary->grid);
    if (!boundary->grid_node || !boundary->grid)
        return tm_fail_memory(error);
    for (size_t n = 0; n < octree->nodes; n++) {
        const uint32_t s = find->boundary_node[n];
        if (s == TM_NONE)
            continue;
        boundary->grid_node[s] = (uint32_t)n;
        memcpy(boundary->grid[s], octree->grid[n], sizeof boundary->grid[s]);
    }
    return TM_OK;
}

/* The sides of the leaves that the faces are of. */
static tm_status find_sizes(tm_interior_boundary *boundary, const tm_octree *octree,
                            tm_error *error)
{
    boundary->size = tm_new(boundary->nodes, sizeof *boundary->size);
    if (!boundary->size)
        return tm_fail_memory(error);
    for (size_t s = 0; s < boundary->nodes; s++)
        boundary->size[s] = octree->side;
    boundary->coarsest = octree->finest;
    for (size_t f = 0; f < boundary->faces; f++) {
        const tm_leaf *leaf = &octree->leaf[boundary->leaf[f]];
        const double side = tm_leaf_side(octree, leaf);
        if (leaf->level < boundary->coarsest)
            boundary->coarsest = leaf->level;
        for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
            if (side < boundary->size[boundary->face[f][i]])
                boundary->size[boundary->face[f][i]] = side;
    }
    return TM_OK;
}

/* Whether nothing of the same part, nor of one before, is beyond face f of a leaf at its
 * corner. */
static bool is_open(const finder *find, size_t leaf, unsigned f, unsigned corner)
{
    const uint32_t node = find->octree->node[leaf][corner];
    const unsigned own = tm_point_octants[corner];
    const unsigned step = 1u << f / 2;
    const unsigned beyond = f % 2 ? own << step : own >> step;
    for (const tm_interior *p = find->part; p <= find->interior; p++)
        if (p->mask[node] & beyond)
            return false;
    return true;
}

/* A corner of the leaf on face f that a piece has, or where it has none, any one: then
 * all of the face has the same beyond it. */
static unsigned corner_of(unsigned f, const tm_piece *piece)
{
    for (unsigned i = 0; i < piece->k; i++)
        if (piece->point[i] < TM_LEAF_EDGE)
            return piece->point[i];
    return f % 2 ? 1u << f / 2 : 0;
}

/* The regions on both sides of a piece of face f of a leaf, which has that corner. */
static tm_status add_regions(finder *find, size_t leaf, unsigned f, unsigned corner,
                             tm_error *error)
{
    tm_interior_boundary *boundary = find->boundary;
    if (!find->part->label)
        return TM_OK;
    void *region = tm_grow(boundary->region, &find->region_room, boundary->faces + 1,
                           sizeof *boundary->region);
    if (!region)
        return tm_fail_memory(error);
    boundary->region = region;
    const unsigned step = 1u << f / 2, own = 7 - corner;
    boundary->region[boundary->faces][0] = find->part->label[leaf];
    boundary->region[boundary->faces][1] =
        find->part->octant[find->octree->node[leaf][corner]][own ^ step];
    return TM_OK;
}

static tm_status add_face(finder *find, size_t leaf, const tm_piece *piece,
                          unsigned which, tm_error *error)
{
    tm_interior_boundary *boundary = find->boundary;
    void *face = tm_grow(boundary->face, &find->face_room, boundary->faces + 1,
                         sizeof *boundary->face);
    if (!face)
        return tm_fail_memory(error);
    boundary->face = face;
    void *leaves = tm_grow(boundary->leaf, &find->leaf_room, boundary->faces + 1,
                           sizeof *boundary->leaf);
    if (!leaves)
        return tm_fail_memory(error);
    boundary->leaf = leaves;
    void *pieces = tm_grow(boundary->piece, &find->piece_room, boundary->faces + 1,
                           sizeof *boundary->piece);
    if (!pieces)
        return tm_fail_memory(error);
    boundary->piece = pieces;
    boundary->piece[boundary->faces] = (uint8_t)which;
    uint32_t *corner = boundary->face[boundary->faces];
    corner[3] = TM_NONE;
    for (unsigned i = 0; i < piece->k; i++)
        corner[i] = find->boundary_node[find->octree->node[leaf][piece->point[i]]];
    boundary->leaf[boundary->faces++] = (uint32_t)leaf;
    return TM_OK;
}

static bool has_boundary(const finder *find, size_t leaf)
{
    for (int p = 0; p < TM_LEAF_EDGE; p++)
        if (find->interior->mask[find->octree->node[leaf][p]] != TM_ALL_OCTANTS)
            return true;
    return false;
}

static tm_status add_faces_of(finder *find, size_t leaf, tm_error *error)
{
    if (!has_boundary(find, leaf))
        return TM_OK;
    const tm_leaf_state state =
        tm_interior_leaf_state(find->interior, find->octree, leaf);
    for (unsigned f = 0; f < LEAF_FACES; f++) {
        tm_piece piece[TM_FACE_PIECES];
        const unsigned pieces = tm_face_pieces(state, f, piece);
        for (unsigned i = 0; i < pieces; i++) {
            const unsigned corner = corner_of(f, &piece[i]);
            if (!is_open(find, leaf, f, corner))
                continue;
            tm_status status = add_regions(find, leaf, f, corner, error);
            if (status == TM_OK)
                status = add_face(find, leaf, &piece[i], TM_FACE_PIECES * f + i, error);
            if (status != TM_OK)
                return status;
        }
    }
    return TM_OK;
}

/* The faces around each node. */
static tm_status find_around(tm_interior_boundary *boundary, tm_error *error)
{
    boundary->around_start = calloc(boundary->nodes + 2, sizeof *boundary->around_start);
    boundary->around = tm_new(4 * boundary->faces, sizeof *boundary->around);
    boundary->cut = calloc(boundary->faces + 1, sizeof *boundary->cut);
    if (!boundary->around_start || !boundary->around || !boundary->cut)
        return tm_fail_memory(error);
    size_t *end =
        boundary->around_start + 1; /* of the faces of a node, when all are in */
    for (size_t f = 0; f < boundary->faces; f++)
        for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
            end[boundary->face[f][i] + 1]++;
    for (size_t n = 0; n < boundary->nodes; n++)
        end[n + 1] += end[n];
    for (size_t f = 0; f < boundary->faces; f++)
        for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
            boundary->around[end[boundary->face[f][i]]++] = (uint32_t)f;
    return TM_OK;
}

tm_status tm_interior_boundary_of_parts(tm_interior_boundary *boundary,
                                        const tm_octree *octree, const tm_interior *part,
                                        size_t parts, tm_error *error)
{
    *boundary = (tm_interior_boundary){.side = octree->side, .finest = octree->finest};
    memcpy(boundary->low, octree->low, sizeof boundary->low);
    finder find = {.octree = octree, .part = part, .parts = parts, .boundary = boundary};
    tm_status status = number_nodes(&find, error);
    for (size_t p = 0; status == TM_OK && p < parts; p++) {
        find.interior = &part[p];
        for (size_t l = 0; status == TM_OK && l < octree->leaves; l++)
            if (part[p].chosen[l])
                status = add_faces_of(&find, l, error);
    }
    if (status == TM_OK)
        status = find_sizes(boundary, octree, error);
    if (status == TM_OK)
        status = find_around(boundary, error);
    free(find.boundary_node);
    return status;
}

tm_status tm_interior_boundary_find(tm_interior_boundary *boundary,
                                    const tm_octree *octree, const tm_interior *interior,
                                    tm_error *error)
{
    return tm_interior_boundary_of_parts(boundary, octree, interior, 1, error);
}

void tm_interior_boundary_free(tm_interior_boundary *boundary)
{
    free(boundary->grid_node);
    free(boundary->grid);
    free(boundary->size);
    free(boundary->face);
    free(boundary->leaf);
    free(boundary->piece);
    free(boundary->region);
    free(boundary->cut);
    free(boundary->around_start);
    free(boundary->around);
    *boundary = (tm_interior_boundary){0};
}
