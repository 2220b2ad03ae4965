/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles of a changed surface that meet others. Inside the mesh tetrahedra see to it,
 * on both sides of a face; on the outside there are none. The faces are found by the tree
 * of the reference, whose boxes reach to all faces above. */
#include "envelope_parts.h"

#include "../../geom/vector.h"
#include "../../surface/surface_crossings.h"
#include "../../surface/surface_tree.h"

typedef struct box {
    double low[3], high[3];
} box;

static box box_of(const tm_tet_mesh *mesh, const uint32_t node[3])
{
    box b;
    for (int x = 0; x < 3; x++) {
        double p = mesh->xyz[node[0]][x], q = mesh->xyz[node[1]][x];
        double r = mesh->xyz[node[2]][x];
        double low = p < q ? p : q, high = p < q ? q : p;
        b.low[x] = low < r ? low : r;
        b.high[x] = high > r ? high : r;
    }
    return b;
}

static bool boxes_meet(const box *a, const box *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] &&
           a->low[1] <= b->high[1] && b->low[1] <= a->high[1] &&
           a->low[2] <= b->high[2] && b->low[2] <= a->high[2];
}

/* A quick look: whether the nodes are all beyond the same side of a box. */
static bool is_beyond(const tm_tet_mesh *mesh, const uint32_t node[3], const box *b)
{
    const double *p = mesh->xyz[node[0]], *q = mesh->xyz[node[1]];
    const double *r = mesh->xyz[node[2]];
    for (int x = 0; x < 3; x++)
        if ((p[x] > b->high[x] && q[x] > b->high[x] && r[x] > b->high[x]) ||
            (p[x] < b->low[x] && q[x] < b->low[x] && r[x] < b->low[x]))
            return true;
    return false;
}

/* Whether the face has a side without a tetrahedron, and is a face still. */
static bool is_outside(const tm_constrained_face *face)
{
    return (face->side[0] == TM_NONE) != (face->side[1] == TM_NONE);
}

/* Whether the triangle meets one of the faces that are above triangle t of the
 * reference. */
static bool meets_above(tm_envelope *e, const tm_tet_mesh *mesh,
                        const tm_surface_change *change, size_t k, const box *around,
                        uint32_t t)
{
    for (uint32_t l = e->first_link[t]; l != TM_NONE; l = e->link[l].next) {
        const uint32_t f = e->link[l].face;
        if (f >= mesh->faces) /* made by what was undone */
            continue;
        const tm_constrained_face *face = &mesh->face[f];
        if (!tm_tet_mark(&e->seen, f) || !is_outside(face) ||
            tm_surface_change_takes(change, f))
            continue;
        if (!is_beyond(mesh, face->node, around) &&
            tm_triangles_meet((const double(*)[3])mesh->xyz, change->node[k], face->node))
            return true;
    }
    return false;
}

static bool meets_new(const tm_tet_mesh *mesh, const tm_surface_change *change, size_t k,
                      const box *around)
{
    for (size_t i = 0; i < k; i++) {
        box other = box_of(mesh, change->node[i]);
        if (boxes_meet(around, &other) &&
            tm_triangles_meet((const double(*)[3])mesh->xyz, change->node[k],
                              change->node[i]))
            return true;
    }
    return false;
}

bool tm_envelope_crosses(tm_envelope *e, const tm_tet_mesh *mesh,
                         const tm_surface_change *change, size_t k)
{
    const tm_surface_tree *tree = e->reference->tree;
    uint32_t stack[TM_TREE_DEPTH], height = 0;
    if (!is_outside(&mesh->face[change->from[k]]))
        return false;
    box own = box_of(mesh, change->node[k]);
    if (meets_new(mesh, change, k, &own) || !tm_tet_marks_clear(&e->seen, mesh->faces))
        return true;
    stack[height++] = 0;
    while (height > 0) {
        const uint32_t at = stack[--height];
        const tm_tree_node *node = &tree->node[at];
        const double *reach = e->reach[at];
        if (!(own.low[0] <= reach[3] && reach[0] <= own.high[0] &&
              own.low[1] <= reach[4] && reach[1] <= own.high[1] &&
              own.low[2] <= reach[5] && reach[2] <= own.high[2]))
            continue;
        if (node->count == 0) {
            stack[height++] = node->first + 1;
            stack[height++] = node->first;
        }
        for (uint32_t i = 0; i < node->count; i++)
            if (meets_above(e, mesh, change, k, &own, tree->triangle[node->first + i].id))
                return true;
    }
    return false;
}
