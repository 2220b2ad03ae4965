/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the tetrahedra in memory. */
#include "mesh.h"

#include "../base/array.h"
#include "../geom/place_order.h"
#include "../geom/space_order.h"

#include <stdlib.h>
#include <string.h>

bool tm_tet_mesh_rank_nodes(const tm_tet_mesh *mesh, uint32_t *rank)
{
    tm_placed *placed = tm_new(mesh->nodes, sizeof *placed);
    for (uint32_t v = 0; v < mesh->nodes && placed; v++) {
        memcpy(placed[v].xyz, mesh->xyz[v], sizeof placed[v].xyz);
        placed[v].item = v;
    }
    if (placed)
        tm_place_sort(placed, mesh->nodes);
    for (uint32_t k = 0; k < mesh->nodes && placed; k++)
        rank[placed[k].item] = k;
    free(placed);
    return placed;
}

/* The even permutation of the corners that sorts them by rank, or all but the last two.
 */
static void sort_corners(const uint32_t rank[4], uint8_t corner[4])
{
    int inversions = 0;
    for (uint8_t i = 0; i < 4; i++) {
        int before = 0;
        for (int j = 0; j < 4; j++) {
            before += rank[j] < rank[i];
            inversions += j < i && rank[j] > rank[i];
        }
        corner[before] = i;
    }
    if (inversions % 2) {
        uint8_t last = corner[3];
        corner[3] = corner[2];
        corner[2] = last;
    }
}

/* Where what is comes from, and where what was goes to. */
typedef struct {
    uint32_t *rank;       /* [nodes] */
    uint8_t (*corner)[4]; /* [slots]: by the old tetrahedron, its corners in order */
    uint32_t *order;      /* [slots]: the old tetrahedron */
    uint32_t (*half)[4];  /* [slots]: by the old tetrahedron, its half faces */
} sorting;

typedef struct {
    uint32_t rank[4], item;
} ranked_tet;

static int compare_ranks(const void *a, const void *b)
{
    const ranked_tet *p = a, *q = b;
    for (int i = 0; i < 4; i++)
        if (p->rank[i] != q->rank[i])
            return p->rank[i] < q->rank[i] ? -1 : 1;
    return (p->item > q->item) - (p->item < q->item);
}

/* Sorts tetrahedra at one position of the curve. */
static bool sort_run(const sorting *s, const tm_tet_mesh *mesh, tm_curve_point *placed,
                     size_t count)
{
    ranked_tet *run = tm_new(count, sizeof *run);
    for (size_t k = 0; k < count && run; k++) {
        uint32_t t = placed[k].item;
        run[k].item = t;
        for (int i = 0; i < 4; i++)
            run[k].rank[i] = s->rank[mesh->tet[t][s->corner[t][i]]];
    }
    if (run)
        qsort(run, count, sizeof *run, compare_ranks);
    for (size_t k = 0; k < count && run; k++)
        placed[k].item = run[k].item;
    free(run);
    return run;
}

static bool sort_runs(const sorting *s, const tm_tet_mesh *mesh, tm_curve_point *placed)
{
    bool done = true;
    for (size_t from = 0, to; from < mesh->slots && done; from = to) {
        for (to = from + 1; to < mesh->slots; to++)
            if (placed[to].position != placed[from].position)
                break;
        done = to == from + 1 || sort_run(s, mesh, placed + from, to - from);
    }
    return done;
}

/* The tetrahedra along the curve, by their corners that come first. */
static bool find_order(const sorting *s, const tm_tet_mesh *mesh)
{
    tm_space space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    tm_curve_point *placed = tm_new(mesh->slots, sizeof *placed);
    for (uint32_t t = 0; t < mesh->slots && placed; t++) {
        const uint32_t *n = mesh->tet[t];
        uint32_t rank[4] = {s->rank[n[0]], s->rank[n[1]], s->rank[n[2]], s->rank[n[3]]};
        sort_corners(rank, s->corner[t]);
        placed[t] =
            (tm_curve_point){tm_space_position(&space, mesh->xyz[n[s->corner[t][0]]]), t};
    }
    bool done =
        placed && tm_space_sort(placed, mesh->slots) && sort_runs(s, mesh, placed);
    for (uint32_t k = 0; k < mesh->slots && done; k++) {
        uint32_t t = s->order[k] = placed[k].item;
        for (uint32_t i = 0; i < 4; i++)
            s->half[t][s->corner[t][i]] = 4 * k + i;
    }
    free(placed);
    return done;
}

static bool reorder_tets(const sorting *s, tm_tet_mesh *mesh)
{
    uint32_t(*tet)[4] = tm_new(mesh->slots, sizeof *tet);
    if (!tet)
        return false;
    for (size_t k = 0; k < mesh->slots; k++)
        for (int i = 0; i < 4; i++)
            tet[k][i] = mesh->tet[s->order[k]][s->corner[s->order[k]][i]];
    /* The old list becomes that of the neighbours. */
    uint32_t(*neighbour)[4] = mesh->tet;
    for (size_t k = 0; k < mesh->slots; k++)
        for (int i = 0; i < 4; i++) {
            uint32_t t = s->order[k], h = mesh->neighbour[t][s->corner[t][i]];
            neighbour[k][i] = h & TM_FACE_BIT ? h : s->half[h / 4][h % 4];
        }
    free(mesh->neighbour);
    mesh->tet = tet;
    mesh->neighbour = neighbour;
    mesh->slot_room = mesh->slots;
    return true;
}

static bool reorder_regions(const sorting *s, tm_tet_mesh *mesh)
{
    size_t width = mesh->regions;
    if (width == 0)
        return true;
    double *region = tm_new(mesh->slots * width, sizeof *region);
    for (size_t k = 0; k < mesh->slots && region; k++)
        memcpy(region + k * width, mesh->region + s->order[k] * width,
               width * sizeof *region);
    if (region) {
        free(mesh->region);
        mesh->region = region;
    }
    return region;
}

tm_status tm_tet_mesh_sort(tm_tet_mesh *mesh, uint32_t *order, tm_error *error)
{
    sorting s = {.rank = tm_new(mesh->nodes, sizeof *s.rank),
                 .corner = tm_new(mesh->slots, sizeof *s.corner),
                 .order = tm_new(mesh->slots, sizeof *s.order),
                 .half = tm_new(mesh->slots, sizeof *s.half)};
    bool done = s.rank && s.corner && s.order && s.half &&
                tm_tet_mesh_rank_nodes(mesh, s.rank) && find_order(&s, mesh) &&
                reorder_regions(&s, mesh) && reorder_tets(&s, mesh);
    for (size_t f = 0; f < mesh->faces && done; f++)
        for (int k = 0; k < 2; k++) {
            uint32_t *h = &mesh->face[f].side[k];
            *h = *h == TM_NONE ? TM_NONE : s.half[*h / 4][*h % 4];
        }
    if (done && order)
        memcpy(order, s.order, mesh->slots * sizeof *order);
    free(s.rank);
    free(s.corner);
    free(s.order);
    free(s.half);
    return done ? TM_OK : tm_fail_memory(error);
}
