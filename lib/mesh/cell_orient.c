/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cell_orient.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../geom/vector.h"
#include "polygon_edges.h"

#include <stdlib.h>
#include <string.h>

#define FAIL(...) tm_fail(error, TM_ERROR_INPUT, __VA_ARGS__)

/* Entry i of cell_polygon is a face here: a polygon as one cell has it. */
typedef struct orienter {
    const tm_polygon_cells *mesh;
    size_t faces;
    size_t *start;  /* [faces + 1] */
    uint32_t *node; /* all corners of all faces */
    uint32_t *cell; /* [faces] */
    size_t *other;  /* [faces]: the same polygon in another cell; SIZE_MAX for none */
    tm_polygon_edges edges; /* of faces, those of each cell by themselves */
    size_t shells;
    size_t *shell;       /* [faces]; SIZE_MAX while none is known */
    size_t *shell_start; /* [shells + 1]: its faces are queue[shell_start[s]] … */
    uint32_t *queue;     /* [faces] */
    double *volume;      /* [shells]: six times it, for the turns in `inward` */
    bool *decided;       /* [shells] */
    bool *inward;        /* [faces] */
} orienter;

static void orienter_free(orienter *o)
{
    free(o->start);
    free(o->node);
    free(o->cell);
    free(o->other);
    free(o->shell);
    free(o->shell_start);
    free(o->queue);
    free(o->volume);
    free(o->decided);
    tm_polygon_edges_free(&o->edges);
}

static bool orienter_new(orienter *o)
{
    const tm_polygon_cells *mesh = o->mesh;
    size_t corners = 0;
    for (size_t i = 0; i < o->faces; i++) {
        uint32_t p = mesh->cell_polygon[i];
        corners += mesh->start[p + 1] - mesh->start[p];
    }
    o->start = tm_new(o->faces + 1, sizeof *o->start);
    o->node = tm_new(corners, sizeof *o->node);
    o->cell = tm_new(o->faces, sizeof *o->cell);
    o->other = tm_new(o->faces, sizeof *o->other);
    o->shell = tm_new(o->faces, sizeof *o->shell);
    o->shell_start = tm_new(o->faces + 1, sizeof *o->shell_start);
    o->queue = tm_new(o->faces, sizeof *o->queue);
    o->volume = tm_new(o->faces, sizeof *o->volume);
    o->decided = tm_new(o->faces, sizeof *o->decided);
    return o->start && o->node && o->cell && o->other && o->shell && o->shell_start &&
           o->queue && o->volume && o->decided;
}

static tm_status make_faces(orienter *o, tm_error *error)
{
    const tm_polygon_cells *mesh = o->mesh;
    size_t *first = tm_new(mesh->polygons, sizeof *first);
    if (!first)
        return tm_fail_memory(error);
    memset(first, UINT8_MAX, mesh->polygons * sizeof *first);
    size_t at = 0;
    for (size_t c = 0; c < mesh->cells; c++)
        for (size_t i = mesh->cell_start[c]; i < mesh->cell_start[c + 1]; i++) {
            uint32_t p = mesh->cell_polygon[i];
            size_t k = mesh->start[p + 1] - mesh->start[p];
            o->start[i] = at;
            memcpy(o->node + at, mesh->node + mesh->start[p], k * sizeof *o->node);
            at += k;
            o->cell[i] = (uint32_t)c;
            o->shell[i] = SIZE_MAX;
            o->other[i] = first[p];
            if (first[p] != SIZE_MAX)
                o->other[first[p]] = i;
            first[p] = i;
        }
    o->start[o->faces] = at;
    free(first);
    return tm_polygon_edges_find(&o->edges, o->faces, o->start, o->node, mesh->nodes,
                                 o->cell, mesh->cells, error);
}

/* Shells --------------------------------------------------------------------------- */

/* Joins face `to` to the shell of face `from`, which has the edge too. */
static tm_status reach(orienter *o, size_t from, size_t to, bool alike, size_t *end,
                       tm_error *error)
{
    bool inward = o->inward[from] ^ alike;
    if (o->shell[to] != SIZE_MAX)
        return o->inward[to] == inward || from == to
                   ? TM_OK
                   : FAIL("polyhedron %u has no inside: its polygons cannot be turned so "
                          "that all are outward",
                          o->cell[to]);
    o->shell[to] = o->shell[from];
    o->inward[to] = inward;
    o->queue[(*end)++] = (uint32_t)to;
    return TM_OK;
}

static tm_status cross(orienter *o, size_t face, size_t corner, size_t *end,
                       tm_error *error)
{
    const tm_polygon_edges *edges = &o->edges;
    size_t e = edges->edge_of[corner], begin = edges->start[e];
    size_t sides = edges->start[e + 1] - begin;
    if (sides % 2 == 1)
        return FAIL("polyhedron %u is not closed: %zu of its polygons meet at one of "
                    "their edges",
                    o->cell[face], sides);
    if (sides != 2)
        return TM_OK;
    bool alike = edges->ascending[begin] == edges->ascending[begin + 1];
    size_t other = edges->polygon[begin + (edges->polygon[begin] == face)];
    return reach(o, face, other, alike, end, error);
}

/* Finds the shell of a face, breadth first; faces queue[*end …] are free. */
static tm_status find_shell(orienter *o, size_t first, size_t *end, tm_error *error)
{
    size_t begin = *end;
    tm_status status = TM_OK;
    o->shell_start[o->shells] = begin;
    o->shell[first] = o->shells++;
    o->inward[first] = false;
    o->queue[(*end)++] = (uint32_t)first;
    for (size_t at = begin; at < *end; at++) {
        size_t face = o->queue[at];
        for (size_t i = o->start[face]; i < o->start[face + 1] && status == TM_OK; i++)
            status = cross(o, face, i, end, error);
    }
    return status;
}

static tm_status find_shells(orienter *o, tm_error *error)
{
    size_t end = 0;
    tm_status status = TM_OK;
    for (size_t i = 0; i < o->faces && status == TM_OK; i++)
        if (o->shell[i] == SIZE_MAX)
            status = find_shell(o, i, &end, error);
    o->shell_start[o->shells] = end;
    return status;
}

/* Signs ---------------------------------------------------------------------------- */

/* Six times the volume between a face and a point, as it turns. */
static double volume6(const orienter *o, size_t face, const double origin[3])
{
    const double(*xyz)[3] = o->mesh->xyz;
    const uint32_t *v = o->node + o->start[face];
    size_t k = o->start[face + 1] - o->start[face];
    double volume = 0, a[3], b[3], c[3], normal[3];
    tm_subtract(a, xyz[v[0]], origin);
    for (size_t j = 2; j < k; j++) {
        tm_subtract(b, xyz[v[j - 1]], origin);
        tm_subtract(c, xyz[v[j]], origin);
        tm_cross(normal, a, b);
        volume += tm_dot(normal, c);
    }
    return volume;
}

static void turn(orienter *o, size_t s)
{
    for (size_t at = o->shell_start[s]; at < o->shell_start[s + 1]; at++)
        o->inward[o->queue[at]] ^= true;
}

static void measure(orienter *o, size_t s)
{
    double volume = 0;
    const double *origin = o->mesh->xyz[o->node[o->start[o->queue[o->shell_start[s]]]]];
    for (size_t at = o->shell_start[s]; at < o->shell_start[s + 1]; at++) {
        size_t face = o->queue[at];
        double part = volume6(o, face, origin);
        volume += o->inward[face] ? -part : part;
    }
    o->volume[s] = volume;
}

static void decide_by_volume(orienter *o, size_t s)
{
    if (o->volume[s] < 0)
        turn(o, s);
    o->decided[s] = true;
}

/* Shells come cell by cell. */
static bool is_only_shell(const orienter *o, size_t s)
{
    uint32_t cell = o->cell[o->queue[o->shell_start[s]]];
    return (s == 0 || o->cell[o->queue[o->shell_start[s - 1]]] != cell) &&
           (s + 1 == o->shells || o->cell[o->queue[o->shell_start[s + 1]]] != cell);
}

static void decide_by_neighbour(orienter *o, size_t s)
{
    for (size_t at = o->shell_start[s]; at < o->shell_start[s + 1]; at++) {
        size_t face = o->queue[at], other = o->other[face];
        if (other == SIZE_MAX || !o->decided[o->shell[other]])
            continue;
        if (o->inward[face] == o->inward[other])
            turn(o, s);
        o->decided[s] = true;
        return;
    }
    decide_by_volume(o, s);
}

static void decide(orienter *o)
{
    for (size_t s = 0; s < o->shells; s++) {
        measure(o, s);
        o->decided[s] = false;
        if (is_only_shell(o, s) && o->volume[s] != 0)
            decide_by_volume(o, s);
    }
    for (size_t s = 0; s < o->shells; s++)
        if (!o->decided[s])
            decide_by_neighbour(o, s);
}

static tm_status check_sides(const orienter *o, tm_error *error)
{
    for (size_t i = 0; i < o->faces; i++) {
        size_t other = o->other[i];
        if (other != SIZE_MAX && o->inward[i] == o->inward[other])
            return FAIL("polyhedra %u and %u are on the same side of polygon %u",
                        o->cell[i], o->cell[other], o->mesh->cell_polygon[i]);
    }
    return TM_OK;
}

tm_status tm_cells_orient(const tm_polygon_cells *mesh, bool *inward, tm_error *error)
{
    orienter o = {.mesh = mesh, .faces = mesh->cell_start[mesh->cells], .inward = inward};
    if (o.faces >= TM_IDS)
        return tm_fail(error, TM_ERROR_SYSTEM, "more faces than 32 bits can number");
    tm_status status = orienter_new(&o) ? make_faces(&o, error) : tm_fail_memory(error);
    if (status == TM_OK)
        status = find_shells(&o, error);
    if (status == TM_OK) {
        decide(&o);
        status = check_sides(&o, error);
    }
    orienter_free(&o);
    return status;
}
