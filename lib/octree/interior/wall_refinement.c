/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "wall_refinement.h"
#include "node_lattice.h"
#include "wall_sectors.h"

#include "../../base/array.h"
#include "../../geom/vector.h"
#include "../forest/octree_build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OCTANTS = 8, RINGS = 2 };

typedef struct {
    const tm_octree *octree;
    tm_node_lattice lattice;
    uint8_t *split; /* [leaves] */
    size_t count;   /* of those to be split */
} marker;

/* Marks what is larger among the leaves around a leaf, and around those. */
static void mark_around(marker *m, uint32_t leaf, unsigned level, int rings)
{
    for (int c = 0; c < OCTANTS; c++)
        for (int o = 0; o < OCTANTS; o++) {
            const uint32_t near = m->lattice.leaf[m->octree->node[leaf][c]][o];
            if (near == TM_NONE)
                continue;
            if (m->octree->leaf[near].level < level && !m->split[near]) {
                m->split[near] = 1;
                m->count++;
            }
            if (rings > 1 && near != leaf)
                mark_around(m, near, level, rings - 1);
        }
}

/* Marks around the leaves that a segment runs through. */
static void mark_along(marker *m, const double a[3], const double b[3])
{
    const double close = 0.5; /* sides of the leaf */
    const double length = sqrt(tm_distance2(a, b));
    uint32_t last = TM_NONE;
    for (double at = 0; at <= length;) {
        double point[3];
        for (int i = 0; i < 3; i++)
            point[i] = length > 0 ? a[i] + at / length * (b[i] - a[i]) : a[i];
        const uint32_t leaf = tm_node_lattice_leaf_at(&m->lattice, point);
        if (leaf == TM_NONE)
            return;
        if (leaf != last)
            mark_around(m, leaf, m->octree->leaf[leaf].level, RINGS);
        last = leaf;
        at += close * tm_leaf_side(m->octree, &m->octree->leaf[leaf]);
    }
}

static tm_status mark(marker *m, const tm_surface *s, const tm_wall_sectors *sectors,
                      tm_error *error)
{
    const tm_status status = tm_node_lattice_make(&m->lattice, m->octree, error);
    m->split = calloc(m->octree->leaves + 1, 1);
    m->count = 0;
    if (status != TM_OK)
        return status;
    if (!m->split)
        return tm_fail_memory(error);
    for (size_t c = 0; c < s->curves; c++)
        for (size_t i = s->curve_start[c];
             sectors->sharp[c] && i + 1 < s->curve_start[c + 1]; i++)
            mark_along(m, s->xyz[s->curve_node[i]], s->xyz[s->curve_node[i + 1]]);
    return TM_OK;
}

tm_status tm_octree_refine_walls(tm_octree *octree, const tm_surface *surface,
                                 tm_error *error)
{
    tm_wall_sectors sectors;
    tm_status status = tm_wall_sectors_find(&sectors, surface, error);
    for (bool more = true; status == TM_OK && more;) {
        marker m = {.octree = octree};
        status = mark(&m, surface, &sectors, error);
        more = m.count > 0;
        if (status == TM_OK && more)
            status = tm_octree_refine(octree, surface, m.split, error);
        tm_node_lattice_free(&m.lattice);
        free(m.split);
    }
    tm_wall_sectors_free(&sectors);
    return status;
}
