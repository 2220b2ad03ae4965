/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octree_mesh_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"

#include <stdlib.h>

/* A connected piece of the interior boundary, at the number of its root node. */
typedef struct {
    size_t faces;
    double volume;  /* six times that which it encloses; negative: a hollow */
    uint32_t shell; /* of the surface: that of most nodes */
    size_t votes;   /* by which it leads (R. Boyer and J Moore's count, 1981) */
    bool stays;
} piece;

typedef struct {
    tm_interior *interior;
    const tm_octree *octree;
    const tm_interior_boundary *boundary;
    uint32_t *parent;      /* [nodes of the interior boundary] */
    piece *pieces;         /* [nodes of the interior boundary]: at roots */
    uint32_t *leaf_parent; /* [nodes of the octree]: those joined by leaves of a kind */
    uint8_t *leaf_mark;    /* [nodes of the octree], at roots: see mark_leaves() */
} finder;

enum { TO_CHANGE = 1, TO_KEEP = 2 };

/* Six times the volume between the origin and triangle abc of interior boundary nodes. */
static double cone(const finder *f, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t *p = f->octree->grid[f->boundary->grid_node[a]];
    const uint32_t *q = f->octree->grid[f->boundary->grid_node[b]];
    const uint32_t *r = f->octree->grid[f->boundary->grid_node[c]];
    const double px = p[0], py = p[1], pz = p[2];
    return px * ((double)q[1] * r[2] - (double)q[2] * r[1]) +
           py * ((double)q[2] * r[0] - (double)q[0] * r[2]) +
           pz * ((double)q[0] * r[1] - (double)q[1] * r[0]);
}

static void find_pieces(finder *f, const tm_surface *surface, const tm_surface_point *at)
{
    const tm_interior_boundary *boundary = f->boundary;
    for (uint32_t s = 0; s < boundary->nodes; s++)
        f->parent[s] = s;
    for (size_t i = 0; i < boundary->faces; i++)
        for (unsigned c = 1; c < tm_boundary_face_corners(boundary, i); c++)
            tm_set_unite(f->parent, boundary->face[i][0], boundary->face[i][c]);
    for (size_t i = 0; i < boundary->faces; i++) {
        const uint32_t *face = boundary->face[i];
        piece *p = &f->pieces[tm_set_root(f->parent, face[0])];
        p->faces++;
        p->volume += cone(f, face[0], face[1], face[2]);
        if (tm_boundary_face_corners(boundary, i) == 4)
            p->volume += cone(f, face[0], face[2], face[3]);
    }
    for (uint32_t s = 0; s < boundary->nodes; s++) {
        piece *p = &f->pieces[tm_set_root(f->parent, s)];
        const uint32_t shell = surface->shell[at[s].triangle];
        if (p->votes == 0)
            p->shell = shell;
        if (p->shell == shell)
            p->votes++;
        else
            p->votes--;
    }
}

/* Of each shell the piece with most faces stays. */
static tm_status choose(finder *f, const tm_surface *surface, tm_error *error)
{
    uint32_t *largest = tm_new(surface->components, sizeof *largest);
    if (!largest)
        return tm_fail_memory(error);
    for (size_t i = 0; i < surface->components; i++)
        largest[i] = TM_NONE;
    for (uint32_t s = 0; s < f->boundary->nodes; s++) {
        const piece *p = &f->pieces[s];
        if (p->faces == 0)
            continue;
        uint32_t *best = &largest[p->shell];
        if (*best == TM_NONE || p->faces > f->pieces[*best].faces)
            *best = s;
    }
    for (size_t i = 0; i < surface->components; i++)
        if (largest[i] != TM_NONE)
            f->pieces[largest[i]].stays = true;
    free(largest);
    return TM_OK;
}

/* Joins the nodes of the chosen leaves, or of the others, to connected parts, and marks
 * those of pieces that go: interior ones, or hollows. */
static void mark_leaves(finder *f, bool chosen)
{
    const tm_octree *octree = f->octree;
    for (size_t n = 0; n < octree->nodes; n++) {
        f->leaf_parent[n] = (uint32_t)n;
        f->leaf_mark[n] = 0;
    }
    for (size_t l = 0; l < octree->leaves; l++)
        for (int p = 1; f->interior->chosen[l] == chosen && p < TM_LEAF_NODES; p++)
            if (octree->node[l][p] != TM_NONE)
                tm_set_unite(f->leaf_parent, octree->node[l][0], octree->node[l][p]);
    for (uint32_t s = 0; s < f->boundary->nodes; s++) {
        const piece *p = &f->pieces[tm_set_root(f->parent, s)];
        const bool goes = !p->stays && (p->volume > 0) == chosen;
        f->leaf_mark[tm_set_root(f->leaf_parent, f->boundary->grid_node[s])] |=
            goes ? TO_CHANGE : TO_KEEP;
    }
}

static bool change_leaves(finder *f, bool chosen)
{
    const tm_octree *octree = f->octree;
    bool any = false;
    mark_leaves(f, chosen);
    for (size_t l = 0; l < octree->leaves; l++)
        if (f->interior->chosen[l] == chosen &&
            f->leaf_mark[tm_set_root(f->leaf_parent, octree->node[l][0])] == TO_CHANGE) {
            tm_interior_flip(f->interior, octree, l);
            any = true;
        }
    return any;
}

tm_status tm_spurious_components_remove(tm_interior *interior, const tm_octree *octree,
                                        const tm_interior_boundary *boundary,
                                        const tm_surface *surface,
                                        const tm_surface_point *at, bool *changed,
                                        tm_error *error)
{
    finder f = {.interior = interior,
                .octree = octree,
                .boundary = boundary,
                .parent = tm_new(boundary->nodes, sizeof *f.parent),
                .pieces = calloc(boundary->nodes + 1, sizeof *f.pieces),
                .leaf_parent = tm_new(octree->nodes, sizeof *f.leaf_parent),
                .leaf_mark = tm_new(octree->nodes, sizeof *f.leaf_mark)};
    tm_status status = TM_OK;
    *changed = false;
    if (!f.parent || !f.pieces || !f.leaf_parent || !f.leaf_mark)
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        find_pieces(&f, surface, at);
        status = choose(&f, surface, error);
    }
    if (status == TM_OK) {
        *changed = change_leaves(&f, true);
        *changed |= change_leaves(&f, false);
        if (*changed)
            tm_interior_find_used(interior, octree);
    }
    free(f.parent);
    free(f.pieces);
    free(f.leaf_parent);
    free(f.leaf_mark);
    return status;
}
