/* SPDX-License-Identifier: GPL-3.0-or-later */
/* At each node v, its boundary faces sorted by their edges at v: a run of k is an edge
 * with k boundary faces, and joins them into one fan. */
#include "examination_boundary.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../geom/vector.h"

#include <stdlib.h>

/* A face at v, with one of its two edges there. */
typedef struct spoke {
    uint32_t end;  /* the edge goes from v to it */
    uint32_t face; /* as counted at v */
} spoke;

typedef struct surface {
    const uint32_t (*face)[4];
    size_t faces;
    size_t *start;     /* [nodes + 1]: the faces at v are */
    uint32_t *face_at; /* face_at[start[v] … start[v + 1]) */
    spoke *spoke;      /* those of one node */
    size_t spoke_room;
    uint32_t *parent; /* a tree for each fan of that node */
    size_t parent_room;
} surface;

static void surface_free(surface *s)
{
    free(s->start);
    free(s->face_at);
    free(s->spoke);
    free(s->parent);
}

/* How many nodes a face has. */
static size_t corners_of(const uint32_t *face)
{
    return face[3] == TM_NONE ? 3 : 4;
}

static bool list_faces(surface *s, size_t nodes)
{
    s->start = calloc(nodes + 2, sizeof *s->start);
    s->face_at = tm_new(s->faces, 4 * sizeof *s->face_at);
    if (!s->start || !s->face_at)
        return false;
    /* start[v + 2] counts, then start[v + 1] is where the next face of v goes. */
    size_t *next = s->start + 1;
    for (size_t f = 0; f < s->faces; f++) {
        const uint32_t *n = s->face[f];
        for (size_t i = 0; i < corners_of(n); i++)
            next[n[i] + 1]++;
    }
    for (size_t v = 0; v < nodes; v++)
        next[v + 1] += next[v];
    for (size_t f = 0; f < s->faces; f++) {
        const uint32_t *n = s->face[f];
        for (size_t i = 0; i < corners_of(n); i++)
            s->face_at[next[n[i]]++] = (uint32_t)f;
    }
    return true;
}

static int compare(const void *a, const void *b)
{
    const spoke *p = a, *q = b;
    return (p->end > q->end) - (p->end < q->end);
}

/* Insertion sort is the fastest for the dozen spokes that a node has. */
static void sort(spoke *spoke_, size_t count)
{
    enum { FEW = 48 };
    if (count > FEW) {
        qsort(spoke_, count, sizeof *spoke_, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const spoke s = spoke_[i];
        size_t j = i;
        for (; j > 0 && spoke_[j - 1].end > s.end; j--)
            spoke_[j] = spoke_[j - 1];
        spoke_[j] = s;
    }
}

/* Fills s->spoke and s->parent for the `count` faces at v. */
static bool find_spokes(surface *s, uint32_t v, size_t count)
{
    void *spokes = tm_grow(s->spoke, &s->spoke_room, 2 * count, sizeof *s->spoke);
    s->spoke = spokes ? spokes : s->spoke;
    void *parents = tm_grow(s->parent, &s->parent_room, count, sizeof *s->parent);
    s->parent = parents ? parents : s->parent;
    if (!spokes || !parents)
        return false;
    size_t found = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t *n = s->face[s->face_at[s->start[v] + i]];
        const size_t k = corners_of(n);
        size_t at = 0;
        while (n[at] != v)
            at++;
        s->parent[i] = i;
        s->spoke[found++] = (spoke){n[at + 1 < k ? at + 1 : 0], i};
        s->spoke[found++] = (spoke){n[at > 0 ? at - 1 : k - 1], i};
    }
    sort(s->spoke, found);
    return true;
}

/* Each edge is counted at its smaller node. */
static void check_edge(tm_examination *found, uint32_t v, uint32_t end, size_t faces)
{
    const uint32_t place[TM_DEFECT_NUMBERS] = {v, end, (uint32_t)faces};
    if (v < end && faces % 2 == 1)
        tm_defect_add(&found->defect[TM_OPEN_EDGE], place);
    if (v < end && faces > 2)
        tm_defect_add(&found->defect[TM_NON_MANIFOLD_EDGE], place);
}

static bool check_node(tm_examination *found, surface *s, uint32_t v)
{
    const size_t faces = s->start[v + 1] - s->start[v];
    if (faces == 0)
        return true;
    if (!find_spokes(s, v, faces))
        return false;
    size_t fans = faces;
    for (size_t i = 0, next; i < 2 * faces; i = next) {
        const uint32_t first = tm_set_root(s->parent, s->spoke[i].face);
        for (next = i + 1; next < 2 * faces && s->spoke[next].end == s->spoke[i].end;
             next++) {
            const uint32_t other = tm_set_root(s->parent, s->spoke[next].face);
            fans -= other != first;
            s->parent[other] = first;
        }
        check_edge(found, v, s->spoke[i].end, next - i);
    }
    if (fans > 1)
        tm_defect_add(&found->defect[TM_NON_MANIFOLD_VERTEX],
                      (uint32_t[TM_DEFECT_NUMBERS]){v, (uint32_t)fans});
    return true;
}

void tm_add_boundary_area(tm_sum *sum, const double (*xyz)[3], const uint32_t (*face)[4],
                          size_t faces)
{
    for (size_t f = 0; f < faces; f++) {
        const uint32_t *n = face[f];
        const double *a = xyz[n[0]], *b = xyz[n[1]], *c = xyz[n[2]];
        tm_sum_add(sum, corners_of(n) == 3 ? tm_triangle_area(a, b, c)
                                           : tm_bilinear_area(a, b, c, xyz[n[3]]));
    }
}

tm_status tm_examine_boundary(tm_examination *found, size_t nodes, uint32_t first,
                              uint32_t past, const uint32_t (*face)[4], size_t faces,
                              tm_error *error)
{
    surface s = {.face = face, .faces = faces};
    bool enough = list_faces(&s, nodes);
    for (uint32_t v = first; enough && v < past; v++)
        enough = check_node(found, &s, v);
    surface_free(&s);
    return enough ? TM_OK : tm_fail_memory(error);
}
