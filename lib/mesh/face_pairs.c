/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "face_pairs.h"

#include "../base/array.h"
#include "../base/hash.h"

#include <stdlib.h>

/* A face of some bucket. The high bit of `middle` says in which sense the nodes turn in
 * ascending order, seen from its first tetrahedron; that of `half`, that a row of .face
 * names it. */
typedef struct {
    uint32_t middle, largest;
    uint32_t half; /* of its first tetrahedron */
} face;

#define HIGH_BIT ((uint32_t)1 << 31)

/* A bucket with room for more faces is not searched from its begin. */
enum { LARGE = 64 };

typedef struct {
    tm_tet_mesh *mesh;
    tm_face_pairs *pairs;
    uint32_t *start; /* [nodes + 1] */
    uint32_t *past;  /* [nodes]: the faces of bucket v are start[v] … past[v] */
    face *face;
    tm_hash_table large; /* the faces of large buckets, all in one table */
    size_t unpaired;     /* half faces without partner that no row names */
} buckets;

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    return a < b ? b : a;
}

/* Puts two in ascending order; 1 if they were not. */
static inline unsigned order(uint64_t *a, uint64_t *b)
{
    uint64_t p = *a, q = *b;
    *a = p < q ? p : q;
    *b = p < q ? q : p;
    return p > q;
}

/* The buckets' sizes: of the four faces of a tetrahedron three have its smallest node,
 * and the other one the second. */
static bool count_faces(buckets *b, const uint32_t (*listed)[3], size_t listed_count)
{
    const tm_tet_mesh *mesh = b->mesh;
    uint32_t *count = b->past;
    for (size_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        uint32_t low = lesser(n[0], n[1]), high = greater(n[0], n[1]);
        uint32_t other_low = lesser(n[2], n[3]), other_high = greater(n[2], n[3]);
        count[lesser(low, other_low)] += 3;
        count[low < other_low ? lesser(high, other_low) : lesser(low, other_high)]++;
    }
    for (size_t f = 0; f < listed_count; f++)
        count[lesser(listed[f][0], lesser(listed[f][1], listed[f][2]))]++;
    uint32_t sum = 0;
    size_t in_large = 0;
    for (size_t v = 0; v < mesh->nodes; v++) {
        b->start[v] = sum;
        sum += count[v];
        in_large += count[v] > LARGE ? count[v] : 0;
        b->past[v] = b->start[v];
    }
    b->start[mesh->nodes] = sum;
    return in_large == 0 || tm_hash_make(&b->large, in_large);
}

static inline bool is_large(const buckets *b, uint32_t v)
{
    return b->start[v + 1] - b->start[v] > LARGE;
}

/* The slot of a face of a large bucket, or the free one where it belongs. */
static uint32_t *slot_of(const buckets *b, uint32_t v, uint32_t middle, uint32_t largest)
{
    const uint64_t h = tm_hash(tm_hash(tm_hash(0, v), middle & ~HIGH_BIT), largest);
    uint32_t *slot = tm_hash_slot(&b->large, h);
    for (; *slot != TM_HASH_FREE; slot = tm_hash_next(&b->large, slot)) {
        const face *f = &b->face[*slot];
        if (*slot >= b->start[v] && *slot < b->past[v] && f->largest == largest &&
            (f->middle ^ middle) << 1 == 0)
            break;
    }
    return slot;
}

/* A face of the bucket of v; NULL if there is none. */
static inline face *find(const buckets *b, bool large, uint32_t v, uint32_t middle,
                         uint32_t largest)
{
    if (large) {
        const uint32_t at = *slot_of(b, v, middle, largest);
        return at == TM_HASH_FREE ? NULL : &b->face[at];
    }
    face *past = b->face + b->past[v];
    for (face *f = b->face + b->start[v]; f < past; f++)
        if (f->largest == largest && (f->middle ^ middle) << 1 == 0)
            return f;
    return NULL;
}

static inline void append(buckets *b, bool large, uint32_t v, uint32_t middle,
                          uint32_t largest, uint32_t half)
{
    if (large)
        *slot_of(b, v, middle, largest) = b->past[v];
    b->face[b->past[v]++] = (face){middle, largest, half};
}

/* Joins a half face to that which is there, or puts it there; false at a third one. */
static inline bool add_half(buckets *b, uint32_t v, uint64_t middle, uint64_t largest,
                            unsigned sense, uint32_t half)
{
    uint32_t *neighbour = b->mesh->neighbour[0];
    uint32_t m = (uint32_t)(middle >> 2) | sense << 31, l = (uint32_t)(largest >> 2);
    const bool large = is_large(b, v);
    const face *f = find(b, large, v, m, l);
    if (!f) {
        append(b, large, v, m, l, half);
        neighbour[half] = TM_NONE;
        b->unpaired++;
        return true;
    }
    if (neighbour[f->half] != TM_NONE)
        return false;
    neighbour[f->half] = half;
    neighbour[half] = f->half;
    b->pairs->folded |= f->middle == m;
    b->unpaired--;
    return true;
}

/* The faces of tetrahedra. With its nodes n0 < n1 < n2 < n3 in a positive order, the face
 * without n_k turns as (-1)^k says. */
static bool add_tets(buckets *b)
{
    const tm_tet_mesh *mesh = b->mesh;
    bool good = true;
    for (uint32_t t = 0; t < mesh->slots && good; t++) {
        uint64_t n[4]; /* the corner below the node */
        for (unsigned i = 0; i < 4; i++)
            n[i] = (uint64_t)mesh->tet[t][i] << 2 | i;
        unsigned odd = order(&n[0], &n[1]);
        odd ^= order(&n[2], &n[3]);
        odd ^= order(&n[0], &n[2]);
        odd ^= order(&n[1], &n[3]);
        odd ^= order(&n[1], &n[2]);
        uint32_t v = (uint32_t)(n[0] >> 2), h = 4 * t;
        good = add_half(b, (uint32_t)(n[1] >> 2), n[2], n[3], odd, h + (n[0] & 3)) &&
               add_half(b, v, n[2], n[3], odd ^ 1, h + (uint32_t)(n[1] & 3)) &&
               add_half(b, v, n[1], n[3], odd, h + (uint32_t)(n[2] & 3)) &&
               add_half(b, v, n[1], n[2], odd ^ 1, h + (uint32_t)(n[3] & 3));
    }
    return good;
}

static bool same_region(const tm_tet_mesh *mesh, uint32_t t, uint32_t u)
{
    for (size_t r = 0; r < mesh->regions; r++)
        if (mesh->region[t * mesh->regions + r] != mesh->region[u * mesh->regions + r])
            return false;
    return true;
}

/* Whether a face stays by what is on its two sides. */
static bool is_open(const tm_tet_mesh *mesh, uint32_t half)
{
    uint32_t across = mesh->neighbour[half / 4][half % 4];
    return across == TM_NONE || !same_region(mesh, half / 4, across / 4);
}

/* A row of .face that is a face of tetrahedra: puts it between them, or drops it. */
static void keep_row(tm_tet_mesh *mesh, uint32_t row, uint32_t h)
{
    tm_constrained_face *kept = &mesh->face[row];
    uint32_t g = mesh->neighbour[h / 4][h % 4];
    if (!is_open(mesh, h) && kept->marker == 0) {
        kept->listed = false;
        mesh->dropped_faces++;
        return;
    }
    kept->side[0] = h;
    kept->side[1] = g;
    mesh->neighbour[h / 4][h % 4] = row | TM_FACE_BIT;
    if (g != TM_NONE)
        mesh->neighbour[g / 4][g % 4] = row | TM_FACE_BIT;
}

/* The rows of .face; false where two are the same. */
static bool add_rows(buckets *b, const uint32_t (*listed)[3], size_t listed_count)
{
    for (uint32_t row = 0; row < listed_count; row++) {
        const uint32_t *n = listed[row];
        uint32_t low = lesser(n[0], n[1]), high = greater(n[0], n[1]);
        uint32_t v = lesser(low, n[2]), largest = greater(high, n[2]);
        uint32_t middle = greater(low, lesser(high, n[2]));
        const bool large = is_large(b, v);
        face *f = find(b, large, v, middle, largest);
        if (!f) {
            append(b, large, v, middle, largest, HIGH_BIT);
            b->mesh->dangling++;
            continue;
        }
        if (f->half & HIGH_BIT)
            return false;
        b->unpaired -= b->mesh->neighbour[f->half / 4][f->half % 4] == TM_NONE;
        keep_row(b->mesh, row, f->half);
        f->half |= HIGH_BIT;
    }
    return true;
}

static int compare(const void *a, const void *b)
{
    const face *f = a;
    const face *g = b;
    const uint32_t middle = f->middle & ~HIGH_BIT, other = g->middle & ~HIGH_BIT;
    if (middle != other)
        return middle < other ? -1 : 1;
    return (f->largest > g->largest) - (f->largest < g->largest);
}

/* Orders the faces of a bucket. */
static void sort(face *f, size_t count)
{
    if (count > LARGE) {
        qsort(f, count, sizeof *f, compare);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        face moved = f[i];
        uint64_t key = (uint64_t)(moved.middle & ~HIGH_BIT) << 32 | moved.largest;
        size_t j = i;
        for (; j > 0 &&
               ((uint64_t)(f[j - 1].middle & ~HIGH_BIT) << 32 | f[j - 1].largest) > key;
             j--)
            f[j] = f[j - 1];
        f[j] = moved;
    }
}

/* The faces that stay and have no row. */
static bool list_open(buckets *b)
{
    tm_face_pairs *pairs = b->pairs;
    if (b->unpaired == 0 && b->mesh->regions == 0)
        return true;
    for (size_t v = 0; v < b->mesh->nodes; v++) {
        face *first = b->face + b->start[v];
        size_t opens = 0, faces = b->past[v] - b->start[v];
        for (size_t i = 0; i < faces; i++)
            if (!(first[i].half & HIGH_BIT) && is_open(b->mesh, first[i].half))
                first[opens++] = first[i];
        sort(first, opens);
        uint32_t *open =
            tm_grow(pairs->open, &pairs->room, pairs->opens + opens, sizeof *open);
        if (!open)
            return false;
        pairs->open = open;
        for (size_t i = 0; i < opens; i++)
            open[pairs->opens++] = first[i].half;
    }
    return true;
}

/* As they were before. */
static void forget_rows(tm_tet_mesh *mesh, size_t listed_count)
{
    mesh->dangling = mesh->dropped_faces = 0;
    for (size_t f = 0; f < listed_count; f++) {
        mesh->face[f].listed = true;
        mesh->face[f].side[0] = mesh->face[f].side[1] = TM_NONE;
    }
}

tm_status tm_face_pairs_find(tm_face_pairs *pairs, tm_tet_mesh *mesh,
                             const uint32_t (*listed)[3], size_t listed_count,
                             tm_error *error)
{
    *pairs = (tm_face_pairs){0};
    size_t faces = 4 * mesh->slots + listed_count;
    if (mesh->nodes >= HIGH_BIT || faces > UINT32_MAX)
        return TM_OK;
    buckets b = {.mesh = mesh,
                 .pairs = pairs,
                 .start = tm_new(mesh->nodes + 1, sizeof *b.start),
                 .past = calloc(mesh->nodes + 1, sizeof *b.past),
                 .face = tm_new(faces, sizeof *b.face)};
    tm_status status = TM_OK;
    if (!b.start || !b.past || !b.face || !count_faces(&b, listed, listed_count))
        status = tm_fail_memory(error);
    if (status == TM_OK) {
        pairs->whole = add_tets(&b) && add_rows(&b, listed, listed_count);
        if (!pairs->whole)
            forget_rows(mesh, listed_count);
        else if (!list_open(&b))
            status = tm_fail_memory(error);
    }
    tm_hash_free(&b.large);
    free(b.start);
    free(b.past);
    free(b.face);
    return status;
}

void tm_face_pairs_free(tm_face_pairs *pairs)
{
    free(pairs->open);
    *pairs = (tm_face_pairs){0};
}
