/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simple.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../tet/operation/ball.h"
#include "shelling.h"

#include <stdlib.h>
#include <string.h>

/* The boundary: faces, and sets of their corners and of themselves that are found by
 * union. Corner 3f + i is node face[f][i]; face f is the set 3F + f. */
typedef struct {
    size_t faces;
    uint32_t (*face)[3];
    uint32_t *set;     /* [4 faces]: the parent in a tree of its set */
    tm_edge_map edges; /* -> 4f + i of the first face at the edge i, i+1; or MATCHED */
    size_t edge_count;
    size_t open_edges; /* with one face */
} boundary;

/* The edge has its two faces. */
#define MATCHED (TM_NONE - 1)

static void join(uint32_t *set, uint32_t x, uint32_t y)
{
    set[tm_set_root(set, x)] = tm_set_root(set, y);
}

static bool collect(boundary *b, const tm_tet_mesh *mesh, const uint32_t *piece,
                    uint32_t id, const uint32_t *tet, size_t count)
{
    b->face = tm_new(4 * count, sizeof *b->face);
    b->set = tm_new(16 * count, sizeof *b->set);
    if (!b->face || !b->set)
        return false;
    for (size_t k = 0; k < count; k++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t across = mesh->neighbour[tet[k]][i];
            if (across & TM_FACE_BIT || tm_piece_of(piece, across / 4) != id)
                tm_tet_face_below(mesh, tet[k], i, b->face[b->faces++]);
        }
    for (uint32_t x = 0; x < 4 * b->faces; x++)
        b->set[x] = x;
    return tm_edge_map_reserve(&b->edges, 3 * b->faces);
}

/* Joins the faces, and their corners, at edge i of face f; false where it has three. */
static bool match(boundary *b, uint32_t f, uint32_t i)
{
    uint32_t j = (i + 1) % 3, set_of_faces = (uint32_t)(3 * b->faces);
    uint32_t v = b->face[f][i], w = b->face[f][j];
    uint32_t *other = tm_edge_map_get(&b->edges, v, w);
    if (!other) {
        tm_edge_map_put(&b->edges, v, w, 4 * f + i);
        b->edge_count++;
        b->open_edges++;
        return true;
    }
    if (*other == MATCHED)
        return false;
    uint32_t g = *other / 4, k = *other % 4, l = (k + 1) % 3;
    uint32_t at_v = b->face[g][k] == v ? k : l, at_w = b->face[g][k] == v ? l : k;
    join(b->set, 3 * f + i, 3 * g + at_v);
    join(b->set, 3 * f + j, 3 * g + at_w);
    join(b->set, set_of_faces + f, set_of_faces + g);
    *other = MATCHED;
    b->open_edges--;
    return true;
}

static int ascending(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* How many nodes the faces have; the faces are gone then. */
static size_t count_nodes(boundary *b)
{
    uint32_t *node = b->face[0];
    size_t count = 0;
    qsort(node, 3 * b->faces, sizeof *node, ascending);
    for (size_t k = 0; k < 3 * b->faces; k++)
        count += k == 0 || node[k] != node[k - 1];
    return count;
}

static bool is_sphere(boundary *b)
{
    size_t fans = 0, parts = 0;
    for (uint32_t f = 0; f < b->faces; f++)
        for (uint32_t i = 0; i < 3; i++)
            if (!match(b, f, i))
                return false;
    for (uint32_t x = 0; x < 4 * b->faces; x++)
        if (b->set[x] == x)
            ++*(x < 3 * b->faces ? &fans : &parts);
    if (b->open_edges > 0 || parts != 1 || fans + b->faces != b->edge_count + 2)
        return false;
    return count_nodes(b) == fans;
}

tm_status tm_tets_are_simple(const tm_tet_mesh *mesh, const uint32_t *piece, uint32_t id,
                             const uint32_t *tet, size_t count, bool *simple,
                             tm_error *error)
{
    boundary b = {0};
    bool done = collect(&b, mesh, piece, id, tet, count);
    *simple = done && is_sphere(&b);
    free(b.face);
    free(b.set);
    tm_edge_map_free(&b.edges);
    return done ? TM_OK : tm_fail_memory(error);
}
