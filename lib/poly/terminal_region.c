/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions by longest edges. A *fan* is a maximal set of tetrahedra around one edge, each
 * reached from the next through a face, whose longest edge that is. At each of its two
 * ends is a face, and beyond it a tetrahedron that has a longer edge; the one with the
 * longest is the *outlet* of the fan. Edges become longer along outlets, so fans are the
 * nodes of a forest; its trees are the regions. A root is a fan around a terminal edge.
 */
#include "partition.h"

#include "../base/array.h"
#include "../tet/mesh_measure.h"

#include <stdlib.h>

typedef struct {
    const tm_tet_mesh *mesh;
    uint8_t *longest; /* [tetrahedra]: an edge, 0 … 5 */
    uint32_t *fan;    /* [tetrahedra] */
    uint32_t *outlet; /* [fans]: a tetrahedron */
    size_t fans;
    size_t room;
} forest;

/* The nodes of the longest edge of t. */
static uint64_t longest_key(const forest *s, uint32_t t)
{
    const uint32_t *n = s->mesh->tet[t];
    const uint8_t *corner = tm_edge_corner[s->longest[t]];
    return tm_edge_key(n[corner[0]], n[corner[1]]);
}

/* From tetrahedron t, which is in fan f around ab with that key, through the faces that
 * have ab and are opposite corner `behind` first. Returns what is across the fan's end
 * and sets its rank, or TM_NONE at a kept face or where the fan is closed. */
static uint32_t walk_fan(forest *s, uint32_t t, uint32_t behind, uint64_t key, uint32_t f,
                         tm_edge_rank *rank)
{
    const uint32_t corners = 0 + 1 + 2 + 3;
    uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key;
    for (uint32_t first = t;;) {
        uint32_t across = s->mesh->neighbour[t][behind];
        if (across & TM_FACE_BIT || across / 4 == first)
            return TM_NONE;
        t = across / 4;
        if (s->fan[t] != f && longest_key(s, t) != key) {
            tm_longest_edge(s->mesh, t, rank);
            return t;
        }
        s->fan[t] = f;
        behind = corners - across % 4 - tm_tet_corner(s->mesh, t, a) -
                 tm_tet_corner(s->mesh, t, b);
    }
}

static bool find_fan(forest *s, uint32_t t)
{
    uint32_t f = (uint32_t)s->fans, end[2];
    tm_edge_rank rank[2];
    const uint8_t *corner = tm_edge_corner[s->longest[t]];
    uint32_t *outlet = tm_grow(s->outlet, &s->room, s->fans + 1, sizeof *outlet);
    if (!outlet)
        return false;
    s->outlet = outlet;
    s->fans++;
    s->fan[t] = f;
    for (int i = 0; i < 2; i++)
        end[i] = walk_fan(s, t, corner[2 + i], longest_key(s, t), f, &rank[i]);
    outlet[f] = end[0];
    if (end[0] == TM_NONE || (end[1] != TM_NONE && tm_edge_is_longer(&rank[1], &rank[0])))
        outlet[f] = end[1];
    return true;
}

static bool find_fans(forest *s)
{
    tm_edge_rank rank;
    s->longest = tm_new(s->mesh->slots, sizeof *s->longest);
    if (!s->longest)
        return false;
    for (uint32_t t = 0; t < s->mesh->slots; t++) {
        s->longest[t] = (uint8_t)tm_longest_edge(s->mesh, t, &rank);
        s->fan[t] = TM_NONE;
    }
    for (uint32_t t = 0; t < s->mesh->slots; t++)
        if (s->fan[t] == TM_NONE && !find_fan(s, t))
            return false;
    return true;
}

/* The tree of each fan in place of its outlet. Trees that are known have ROOT_BIT. */
static size_t find_trees(forest *s)
{
    const uint32_t root_bit = TM_FACE_BIT; /* fans are as few as tetrahedra */
    size_t trees = 0;
    for (uint32_t f = 0; f < s->fans; f++) {
        uint32_t r = f, tree;
        while (s->outlet[r] != TM_NONE && !(s->outlet[r] & root_bit))
            r = s->fan[s->outlet[r]];
        tree = s->outlet[r] == TM_NONE ? (uint32_t)trees++ | root_bit : s->outlet[r];
        for (uint32_t g = f; s->outlet[g] != tree;) {
            uint32_t next = s->outlet[g];
            s->outlet[g] = tree;
            if (next == TM_NONE)
                break;
            g = s->fan[next];
        }
    }
    return trees;
}

tm_status tm_label_terminal(const tm_tet_mesh *mesh, uint32_t *label, size_t *regions,
                            tm_error *error)
{
    forest s = {.mesh = mesh, .fan = label};
    bool done = find_fans(&s);
    if (done) {
        *regions = find_trees(&s);
        for (uint32_t t = 0; t < mesh->slots; t++)
            label[t] = s.outlet[label[t]] & ~TM_FACE_BIT;
    }
    free(s.longest);
    free(s.outlet);
    return done ? TM_OK : tm_fail_memory(error);
}

static bool is_same_region(const tm_tet_mesh *mesh, uint32_t t, uint32_t u)
{
    for (size_t k = 0; k < mesh->regions; k++)
        if (mesh->region[t * mesh->regions + k] != mesh->region[u * mesh->regions + k])
            return false;
    return true;
}

/* All fans around one edge are one region, as far as the mesh's regions allow. */
tm_status tm_label_longest_edge(const tm_tet_mesh *mesh, uint32_t *label, size_t *regions,
                                tm_error *error)
{
    forest s = {.mesh = mesh, .fan = label};
    tm_edge_map first = {0}; /* the first tetrahedron with this longest edge */
    bool done = find_fans(&s) && tm_edge_map_reserve(&first, s.fans);
    *regions = 0;
    for (size_t f = 0; f < s.fans && done; f++)
        s.outlet[f] = TM_NONE; /* from here on the label of the fan */
    for (uint32_t t = 0; t < mesh->slots && done; t++) {
        uint32_t *name = &s.outlet[label[t]];
        if (*name != TM_NONE)
            continue;
        uint64_t key = longest_key(&s, t);
        uint32_t a = (uint32_t)(key >> 32), b = (uint32_t)key;
        uint32_t *other = tm_edge_map_get(&first, a, b);
        if (other && is_same_region(mesh, *other, t)) {
            *name = s.outlet[label[*other]];
            continue;
        }
        *name = (uint32_t)(*regions)++;
        if (!other)
            tm_edge_map_put(&first, a, b, t);
    }
    for (uint32_t t = 0; t < mesh->slots && done; t++)
        label[t] = s.outlet[label[t]];
    tm_edge_map_free(&first);
    free(s.longest);
    free(s.outlet);
    return done ? TM_OK : tm_fail_memory(error);
}
