/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of the tetrahedra in memory. */
#include "mesh.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../geom/place_order.h"
#include "../geom/space_order.h"

#include <stdlib.h>
#include <string.h>

/* So many tetrahedra are a thread's work at a time. */
enum { CHUNK = 8192 };

bool tm_tet_mesh_rank_nodes(const tm_tet_mesh *mesh, uint32_t *rank, unsigned threads)
{
    return tm_place_rank((const double(*)[3])mesh->xyz, mesh->nodes, threads, rank);
}

void tm_tet_sort_corners(const uint32_t rank[4], uint8_t corner[4])
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
    tm_tet_mesh *mesh;
    unsigned threads;
    uint32_t *rank;         /* [nodes] */
    uint8_t (*corner)[4];   /* [slots]: by the old tetrahedron, its corners in order */
    uint32_t *order;        /* [slots]: the old tetrahedron */
    uint32_t (*half)[4];    /* [slots]: by the old tetrahedron, its half faces */
    tm_space space;         /* of the curve */
    tm_curve_point *placed; /* [slots]: old tetrahedra along it */
    bool *failed;           /* [chunks]: memory was out */
    uint32_t (*tet)[4];     /* [slots] */
    double *region;         /* [slots][regions] */
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
static bool sort_run(const sorting *s, tm_curve_point *placed, size_t count)
{
    ranked_tet *run = tm_new(count, sizeof *run);
    for (size_t k = 0; k < count && run; k++) {
        uint32_t t = placed[k].item;
        run[k].item = t;
        for (int i = 0; i < 4; i++)
            run[k].rank[i] = s->rank[s->mesh->tet[t][s->corner[t][i]]];
    }
    if (run)
        qsort(run, count, sizeof *run, compare_ranks);
    for (size_t k = 0; k < count && run; k++)
        placed[k].item = run[k].item;
    free(run);
    return run;
}

/* Sorts the runs that begin in a chunk. */
static void sort_runs(void *context, size_t first, size_t past)
{
    const sorting *s = context;
    tm_curve_point *placed = s->placed;
    const size_t slots = s->mesh->slots;
    size_t from = first;
    bool done = true;
    while (from > 0 && from < past && placed[from].position == placed[from - 1].position)
        from++;
    for (size_t to; from < past && done; from = to) {
        for (to = from + 1; to < slots; to++)
            if (placed[to].position != placed[from].position)
                break;
        done = to == from + 1 || sort_run(s, placed + from, to - from);
    }
    s->failed[first / CHUNK] = !done;
}

/* Sorts the corners of tetrahedra, and places them by those that come first. */
static void place_tets(void *context, size_t from, size_t to)
{
    const sorting *s = context;
    for (size_t t = from; t < to; t++) {
        const uint32_t *n = s->mesh->tet[t];
        uint32_t rank[4] = {s->rank[n[0]], s->rank[n[1]], s->rank[n[2]], s->rank[n[3]]};
        tm_tet_sort_corners(rank, s->corner[t]);
        const double *first = s->mesh->xyz[n[s->corner[t][0]]];
        s->placed[t] = (tm_curve_point){tm_space_position(&s->space, first), (uint32_t)t};
    }
}

static void number_halves(void *context, size_t from, size_t to)
{
    const sorting *s = context;
    for (size_t k = from; k < to; k++) {
        uint32_t t = s->order[k] = s->placed[k].item;
        for (uint32_t i = 0; i < 4; i++)
            s->half[t][s->corner[t][i]] = 4 * (uint32_t)k + i;
    }
}

/* The tetrahedra along the curve, by their corners that come first. */
static bool find_order(sorting *s)
{
    const tm_tet_mesh *mesh = s->mesh;
    const size_t chunks = tm_parallel_chunks(mesh->slots, CHUNK);
    s->space = tm_space_around((const double(*)[3])mesh->xyz, mesh->nodes);
    s->placed = tm_new(mesh->slots, sizeof *s->placed);
    s->failed = calloc(chunks + 1, sizeof *s->failed);
    bool done = s->placed && s->failed;
    if (done)
        tm_parallel_runs(s->threads, mesh->slots, CHUNK, place_tets, s);
    done = done && tm_space_sort(s->placed, mesh->slots, s->threads);
    if (done)
        tm_parallel_runs(s->threads, mesh->slots, CHUNK, sort_runs, s);
    for (size_t c = 0; c < chunks && done; c++)
        done = !s->failed[c];
    if (done)
        tm_parallel_runs(s->threads, mesh->slots, CHUNK, number_halves, s);
    free(s->placed);
    free(s->failed);
    return done;
}

static void copy_tets(void *context, size_t from, size_t to)
{
    const sorting *s = context;
    const tm_tet_mesh *mesh = s->mesh;
    const size_t width = mesh->regions;
    for (size_t k = from; k < to; k++)
        for (int i = 0; i < 4; i++)
            s->tet[k][i] = mesh->tet[s->order[k]][s->corner[s->order[k]][i]];
    for (size_t k = from; k < to && width > 0; k++)
        memcpy(s->region + k * width, mesh->region + s->order[k] * width,
               width * sizeof *s->region);
}

/* The old list of tetrahedra becomes that of the neighbours. */
static void copy_neighbours(void *context, size_t from, size_t to)
{
    const sorting *s = context;
    const tm_tet_mesh *mesh = s->mesh;
    for (size_t k = from; k < to; k++)
        for (int i = 0; i < 4; i++) {
            uint32_t t = s->order[k], h = mesh->neighbour[t][s->corner[t][i]];
            mesh->tet[k][i] = h & TM_FACE_BIT ? h : s->half[h / 4][h % 4];
        }
}

static bool reorder(sorting *s)
{
    tm_tet_mesh *mesh = s->mesh;
    s->tet = tm_new(mesh->slots, sizeof *s->tet);
    s->region =
        mesh->regions > 0 ? tm_new(mesh->slots * mesh->regions, sizeof *s->region) : NULL;
    if (!s->tet || (mesh->regions > 0 && !s->region)) {
        free(s->tet);
        free(s->region);
        return false;
    }
    tm_parallel_runs(s->threads, mesh->slots, CHUNK, copy_tets, s);
    tm_parallel_runs(s->threads, mesh->slots, CHUNK, copy_neighbours, s);
    free(mesh->neighbour);
    free(mesh->region);
    mesh->neighbour = mesh->tet;
    mesh->tet = s->tet;
    mesh->region = s->region;
    mesh->slot_room = mesh->slots;
    return true;
}

tm_status tm_tet_mesh_sort(tm_tet_mesh *mesh, uint32_t *order, unsigned threads,
                           tm_error *error)
{
    sorting s = {.mesh = mesh,
                 .threads = threads,
                 .rank = tm_new(mesh->nodes, sizeof *s.rank),
                 .corner = tm_new(mesh->slots, sizeof *s.corner),
                 .order = order ? order : tm_new(mesh->slots, sizeof *s.order),
                 .half = tm_new(mesh->slots, sizeof *s.half)};
    bool done = s.rank && s.corner && s.order && s.half &&
                tm_tet_mesh_rank_nodes(mesh, s.rank, threads) && find_order(&s) &&
                reorder(&s);
    for (size_t f = 0; f < mesh->faces && done; f++)
        for (int k = 0; k < 2; k++) {
            uint32_t *h = &mesh->face[f].side[k];
            *h = *h == TM_NONE ? TM_NONE : s.half[*h / 4][*h % 4];
        }
    if (!order)
        free(s.order);
    free(s.rank);
    free(s.corner);
    free(s.half);
    return done ? TM_OK : tm_fail_memory(error);
}
