/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "feature_parts.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"

#include <stdlib.h>

/* A vote of a node: its region and the patch that it is closest to. */
typedef struct {
    uint32_t region, patch;
} vote;

typedef struct {
    const tm_interior_boundary *boundary;
    const uint8_t *on_path;
    uint32_t *parent; /* [2 * faces]: halves of faces as sets; half 1 only where cut */
} regions;

/* The half of face f at its edge from corner i. */
static uint32_t half_at(const regions *r, size_t f, unsigned i)
{
    const unsigned cut = r->boundary->cut[f];
    if (cut == TM_UNCUT)
        return (uint32_t)(2 * f);
    const unsigned turned = cut == TM_CUT_02 ? i : (i + 3) % 4;
    return (uint32_t)(2 * f + (turned >= 2));
}

/* Whether faces are between the same regions. */
static bool is_same_wall(const tm_interior_boundary *boundary, size_t f, size_t g)
{
    return !boundary->region || (boundary->region[f][0] == boundary->region[g][0] &&
                                 boundary->region[f][1] == boundary->region[g][1]);
}

/* Joins the halves on both sides of each edge that is on no path. */
static void join_edge(regions *r, size_t f, unsigned i)
{
    const tm_interior_boundary *boundary = r->boundary;
    const unsigned k = tm_boundary_face_corners(boundary, f);
    const uint32_t a = boundary->face[f][i], b = boundary->face[f][(i + 1) % k];
    for (size_t j = boundary->around_start[a]; j < boundary->around_start[a + 1]; j++) {
        const uint32_t g = boundary->around[j];
        const unsigned n = tm_boundary_face_corners(boundary, g);
        for (unsigned c = 0; g != f && is_same_wall(boundary, f, g) && c < n; c++)
            if (boundary->face[g][c] == b && boundary->face[g][(c + 1) % n] == a)
                tm_set_unite(r->parent, half_at(r, f, i), half_at(r, g, c));
    }
}

static int compare_votes(const void *a, const void *b)
{
    const vote *va = a;
    const vote *vb = b;
    if (va->region != vb->region)
        return va->region < vb->region ? -1 : 1;
    return (va->patch > vb->patch) - (va->patch < vb->patch);
}

/* Leaves in winner[region] the patch with a clear majority, or TM_NONE. */
static void count_votes(const vote *votes, size_t count, uint32_t *winner)
{
    const size_t share = 3; /* of four */
    for (size_t begin = 0, end; begin < count; begin = end) {
        const uint32_t region = votes[begin].region;
        size_t most = 0;
        uint32_t best = TM_NONE;
        for (end = begin; end < count && votes[end].region == region;) {
            const size_t first = end;
            while (end < count && votes[end].region == region &&
                   votes[end].patch == votes[first].patch)
                end++;
            if (end - first > most) {
                most = end - first;
                best = votes[first].patch;
            }
        }
        winner[region] = 4 * most >= share * (end - begin) ? best : TM_NONE;
    }
}

/* A region of a node that is on no path: all its faces are in it. */
static uint32_t region_of(const regions *r, uint32_t s)
{
    const uint32_t f = r->boundary->around[r->boundary->around_start[s]];
    return tm_set_root(r->parent,
                       half_at(r, f, tm_boundary_face_corner(r->boundary, f, s)));
}

static void vote_all(const regions *r, tm_feature *feature, const tm_surface *surface,
                     const tm_surface_point *at, vote *votes, uint32_t *winner)
{
    size_t count = 0;
    for (uint32_t s = 0; s < r->boundary->nodes; s++)
        if (feature->kind[s] == TM_ON_PATCH)
            votes[count++] = (vote){region_of(r, s), surface->patch[at[s].triangle]};
    if (count > 0)
        qsort(votes, count, sizeof *votes, compare_votes);
    count_votes(votes, count, winner);
    for (uint32_t s = 0; s < r->boundary->nodes; s++)
        if (feature->kind[s] == TM_ON_PATCH)
            feature->of[s] = winner[region_of(r, s)];
}

tm_status tm_feature_regions(tm_feature *feature, const tm_interior_boundary *boundary,
                             const tm_surface *surface, const uint8_t *on_path,
                             const tm_surface_point *at, tm_error *error)
{
    const size_t halves = 2 * boundary->faces;
    regions r = {boundary, on_path, tm_new(halves, sizeof *r.parent)};
    vote *votes = tm_new(boundary->nodes, sizeof *votes);
    uint32_t *winner = tm_new(halves, sizeof *winner);
    if (!r.parent || !votes || !winner) {
        free(r.parent);
        free(votes);
        free(winner);
        return tm_fail_memory(error);
    }
    for (size_t h = 0; h < halves; h++)
        r.parent[h] = (uint32_t)h;
    for (size_t f = 0; f < boundary->faces; f++)
        for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
            if (!(on_path[f] & 1u << i))
                join_edge(&r, f, i);
    vote_all(&r, feature, surface, at, votes, winner);
    free(r.parent);
    free(votes);
    free(winner);
    return TM_OK;
}
