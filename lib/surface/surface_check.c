/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../base/array.h"
#include "surface_parts.h"
#include "surface_tree.h"

#include <stdlib.h>
#include <string.h>

static tm_status wrong(tm_error *error, const char *what, size_t where)
{
    return tm_fail(error, TM_ERROR_INTERNAL, "surface: %s, at %zu", what, where);
}

/* The corner of t from which its edge with n goes, as it does in n the other way. */
static bool faces_back(const tm_surface *surface, uint32_t t, unsigned i)
{
    uint32_t n = surface->across[t][i];
    unsigned k = n < surface->triangles ? tm_surface_side(surface, n, t) : 3;
    return k < 3 && surface->triangle[n][k] == surface->triangle[t][(i + 1) % 3] &&
           surface->triangle[n][(k + 1) % 3] == surface->triangle[t][i] &&
           surface->shell[n] == surface->shell[t];
}

static tm_status check_triangles(const tm_surface *surface, tm_error *error)
{
    size_t open = 0;
    for (uint32_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        if (v[0] >= surface->nodes || v[1] >= surface->nodes || v[2] >= surface->nodes ||
            v[0] == v[1] || v[1] == v[2] || v[2] == v[0])
            return wrong(error, "a triangle without three nodes", t);
        if (surface->patch[t] >= surface->patches)
            return wrong(error, "a triangle in no patch", t);
        if (surface->shell[t] >= surface->components)
            return wrong(error, "a triangle in no shell", t);
        for (unsigned i = 0; i < 3; i++) {
            if (surface->across[t][i] == TM_NONE)
                open++;
            else if (!faces_back(surface, t, i))
                return wrong(error, "neighbours that do not know each other", t);
        }
    }
    if (open != surface->open_edges && !surface->walls)
        return wrong(error, "a false number of open edges", open);
    return TM_OK;
}

/* Each wall is between two regions, of which it looks to the smaller one; each region has
 * some. */
static tm_status check_sides(const tm_surface *surface, tm_error *error)
{
    bool *met = calloc(surface->cells + 1, sizeof *met);
    if (!met)
        return tm_fail_memory(error);
    tm_status status = TM_OK;
    for (size_t t = 0; t < surface->triangles && status == TM_OK; t++) {
        const uint32_t *side = surface->side[t];
        if (side[0] >= side[1] || side[1] > surface->cells)
            status = wrong(error, "a wall between no two regions", t);
        else
            met[side[0]] = met[side[1]] = true;
        for (unsigned i = 0; i < 3; i++) {
            const uint32_t n = surface->across[t][i];
            if (status == TM_OK && n != TM_NONE &&
                memcmp(surface->side[n], side, sizeof surface->side[n]) != 0)
                status = wrong(error, "neighbours between different regions", t);
        }
    }
    for (size_t r = 0; r <= surface->cells && status == TM_OK; r++)
        if (!met[r])
            status = wrong(error, "a region without a wall", r);
    free(met);
    return status;
}

static tm_status check_nodes(const tm_surface *surface, tm_error *error)
{
    bool *used = calloc(surface->nodes + 1, sizeof *used);
    if (!used)
        return tm_fail_memory(error);
    for (size_t i = 0; i < 3 * surface->triangles; i++)
        used[surface->triangle[i / 3][i % 3]] = true;
    tm_status status = TM_OK;
    for (size_t v = 0; v < surface->nodes && status == TM_OK; v++) {
        if (!used[v])
            status = wrong(error, "a node that no triangle has", v);
        for (int i = 0; i < 3; i++)
            if (!(surface->low[i] <= surface->xyz[v][i] &&
                  surface->xyz[v][i] <= surface->high[i]))
                status = wrong(error, "a node out of the bounds", v);
    }
    free(used);
    return status;
}

static tm_status check_curve(const tm_surface *surface, size_t c, const bool *corner,
                             tm_error *error)
{
    size_t first = surface->curve_start[c], last = surface->curve_start[c + 1] - 1;
    if (first >= last)
        return wrong(error, "a curve without a segment", c);
    const uint32_t *v = surface->curve_node;
    bool closed = v[first] == v[last] && !corner[v[first]];
    for (size_t i = first; i <= last; i++) {
        if (v[i] >= surface->nodes)
            return wrong(error, "a curve without nodes", c);
        bool end = i == first || i == last;
        if (corner[v[i]] != end && !(end && closed))
            return wrong(error, "a curve that is not from corner to corner", c);
    }
    return TM_OK;
}

static tm_status check_curves(const tm_surface *surface, tm_error *error)
{
    bool *corner = calloc(surface->nodes + 1, sizeof *corner);
    if (!corner)
        return tm_fail_memory(error);
    tm_status status = TM_OK;
    for (size_t i = 0; i < surface->corners && status == TM_OK; i++) {
        if (surface->corner[i] >= surface->nodes || corner[surface->corner[i]])
            status = wrong(error, "a corner that is no node, or twice", i);
        else
            corner[surface->corner[i]] = true;
    }
    for (size_t c = 0; c < surface->curves && status == TM_OK; c++)
        status = check_curve(surface, c, corner, error);
    free(corner);
    return status;
}

/* Counts in met the triangles of the leaves; every one is in all boxes above it. */
static bool check_leaf(const tm_surface *surface, const tm_tree_node *leaf,
                       const double low[3], const double high[3], size_t *met)
{
    const tm_surface_tree *tree = surface->tree;
    for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++) {
        const tm_tree_triangle *triangle = &tree->triangle[i];
        if (i >= surface->triangles || tree->slot[triangle->id] != i ||
            triangle->patch != surface->patch[triangle->id])
            return false;
        for (int k = 0; k < 9; k++) {
            double x = triangle->corner[k / 3][k % 3];
            const uint32_t *v = surface->triangle[triangle->id];
            if (x != surface->xyz[v[k / 3]][k % 3] || x < low[k % 3] || x > high[k % 3])
                return false;
        }
        (*met)++;
    }
    return true;
}

static bool check_node(const tm_surface *surface, uint32_t n, int depth, size_t *met)
{
    const tm_surface_tree *tree = surface->tree;
    const tm_tree_node *node = &tree->node[n];
    if (n >= tree->nodes || depth + 2 > TM_TREE_DEPTH)
        return false;
    if (node->count > 0)
        return check_leaf(surface, node, node->low, node->high, met);
    for (uint32_t child = node->first; child <= node->first + 1; child++) {
        for (int i = 0; i < 3; i++)
            if (tree->node[child].low[i] < node->low[i] ||
                tree->node[child].high[i] > node->high[i])
                return false;
        if ((node->patch != TM_NONE && tree->node[child].patch != node->patch) ||
            !check_node(surface, child, depth + 1, met))
            return false;
    }
    return true;
}

tm_status tm_surface_check(const tm_surface *surface, tm_error *error)
{
    tm_status status = check_triangles(surface, error);
    if (status == TM_OK && surface->walls)
        status = check_sides(surface, error);
    if (status == TM_OK)
        status = check_nodes(surface, error);
    if (status == TM_OK)
        status = check_curves(surface, error);
    size_t met = 0;
    if (status == TM_OK &&
        (!check_node(surface, 0, 0, &met) || met != surface->triangles))
        status = wrong(error, "a tree that is not of its triangles", met);
    return status;
}
