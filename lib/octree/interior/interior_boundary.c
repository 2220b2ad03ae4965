/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_boundary.h"

#include "../../base/array.h"
#include "../../base/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { LEAF_FACES = 6, LEAF_EDGES = 12 };

typedef struct {
    const tm_octree *octree;
    const tm_interior *part;
    size_t parts;
    tm_interior_boundary *boundary;
    uint32_t *boundary_node; /* [nodes of the octree]: TM_NONE where it is none */
    uint8_t *count;          /* [leaves]: its faces */
    size_t chunks;           /* of leaves */
    size_t *first;           /* [parts][chunks]: how many faces, then the first of them */
    size_t at;               /* the part whose faces are found */
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
    for (size_t p = 0; p <= find->at; p++)
        if (find->part[p].mask[node] & beyond)
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
static void set_regions(const finder *find, size_t face, size_t leaf, unsigned f,
                        unsigned corner)
{
    const unsigned step = 1u << f / 2, own = 7 - corner;
    find->boundary->region[face][0] = find->part->label[leaf];
    find->boundary->region[face][1] =
        find->part->octant[find->octree->node[leaf][corner]][own ^ step];
}

static void set_face(const finder *find, size_t face, size_t leaf, const tm_piece *piece,
                     unsigned which)
{
    tm_interior_boundary *boundary = find->boundary;
    uint32_t *corner = boundary->face[face];
    corner[3] = TM_NONE;
    for (unsigned i = 0; i < piece->k; i++)
        corner[i] = find->boundary_node[find->octree->node[leaf][piece->point[i]]];
    boundary->piece[face] = (uint8_t)which;
    boundary->leaf[face] = (uint32_t)leaf;
}

static bool has_boundary(const finder *find, size_t leaf)
{
    const tm_octant_mask *mask = find->part[find->at].mask;
    for (int p = 0; p < TM_LEAF_EDGE; p++)
        if (mask[find->octree->node[leaf][p]] != TM_ALL_OCTANTS)
            return true;
    return false;
}

/* The faces of a leaf: how many, and, where they are wanted, what they are. */
static unsigned find_faces_of(const finder *find, size_t leaf, const size_t *first)
{
    unsigned count = 0;
    const tm_leaf_state state =
        tm_interior_leaf_state(&find->part[find->at], find->octree, leaf);
    for (unsigned f = 0; f < LEAF_FACES; f++) {
        tm_piece piece[TM_FACE_PIECES];
        const unsigned pieces = tm_face_pieces(state, f, piece);
        for (unsigned i = 0; i < pieces; i++) {
            const unsigned corner = corner_of(f, &piece[i]);
            if (!is_open(find, leaf, f, corner))
                continue;
            if (first && find->part->label)
                set_regions(find, *first + count, leaf, f, corner);
            if (first)
                set_face(find, *first + count, leaf, &piece[i], TM_FACE_PIECES * f + i);
            count++;
        }
    }
    return count;
}

static void count_chunk(void *context, size_t first, size_t past)
{
    const finder *find = context;
    size_t *faces = &find->first[find->at * find->chunks + first / TM_CHUNK];
    *faces = 0;
    for (size_t l = first; l < past; l++) {
        if (!find->part[find->at].chosen[l])
            continue;
        find->count[l] =
            (uint8_t)(has_boundary(find, l) ? find_faces_of(find, l, NULL) : 0);
        *faces += find->count[l];
    }
}

static void fill_chunk(void *context, size_t first, size_t past)
{
    const finder *find = context;
    size_t face = find->first[find->at * find->chunks + first / TM_CHUNK];
    for (size_t l = first; l < past; l++)
        if (find->part[find->at].chosen[l] && find->count[l] > 0)
            face += find_faces_of(find, l, &face);
}

/* Calls work for the leaves of all parts. */
static void go_over(finder *find, void (*work)(void *context, size_t first, size_t past))
{
    for (find->at = 0; find->at < find->parts; find->at++)
        tm_parallel_runs(find->octree->threads, find->octree->leaves, TM_CHUNK, work,
                         find);
}

static tm_status find_faces(finder *find, tm_error *error)
{
    tm_interior_boundary *boundary = find->boundary;
    find->chunks = tm_parallel_chunks(find->octree->leaves, TM_CHUNK);
    find->count = tm_new(find->octree->leaves, sizeof *find->count);
    find->first = tm_new(find->parts * find->chunks, sizeof *find->first);
    if (!find->count || !find->first)
        return tm_fail_memory(error);
    go_over(find, count_chunk);
    for (size_t i = 0; i < find->parts * find->chunks; i++) {
        const size_t faces = find->first[i];
        find->first[i] = boundary->faces;
        boundary->faces += faces;
    }
    boundary->face = tm_new(boundary->faces, sizeof *boundary->face);
    boundary->leaf = tm_new(boundary->faces, sizeof *boundary->leaf);
    boundary->piece = tm_new(boundary->faces, sizeof *boundary->piece);
    if (find->part->label)
        boundary->region = tm_new(boundary->faces, sizeof *boundary->region);
    boundary->cut = calloc(boundary->faces + 1, sizeof *boundary->cut);
    if (!boundary->face || !boundary->leaf || !boundary->piece || !boundary->cut ||
        (find->part->label && !boundary->region))
        return tm_fail_memory(error);
    go_over(find, fill_chunk);
    return TM_OK;
}

tm_status tm_interior_boundary_find_around(tm_interior_boundary *boundary,
                                           tm_error *error)
{
    boundary->around_start = calloc(boundary->nodes + 2, sizeof *boundary->around_start);
    boundary->around = tm_new(4 * boundary->faces, sizeof *boundary->around);
    if (!boundary->around_start || !boundary->around)
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
    if (status == TM_OK)
        status = find_faces(&find, error);
    if (status == TM_OK)
        status = find_sizes(boundary, octree, error);
    if (status == TM_OK)
        status = tm_interior_boundary_find_around(boundary, error);
    free(find.boundary_node);
    free(find.count);
    free(find.first);
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
