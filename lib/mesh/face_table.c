/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Half faces and rows are listed at the smallest of their nodes. Of a tetrahedron three
 * faces have its smallest node, corner i, and the other one is face i: 4t + i is listed
 * at both of their smallest nodes. The faces at a node are matched as they come, by hash.
 */
#include "face_table.h"

#include "../base/array.h"
#include "../base/ids.h"
#include "../base/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { TRIANGLE = 3, QUADRILATERAL = 4, TET_SHIFT = 2, MIXED_SHIFT = 3 };

#define ROW          ((uint32_t)1 << 31)
#define MOST_MEMBERS TM_IDS_HALF

static inline uint32_t lesser(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline uint32_t greater(uint32_t a, uint32_t b)
{
    return a < b ? b : a;
}

size_t tm_half_face_nodes(const tm_mesh_view *mesh, uint32_t half, uint32_t node[4])
{
    if (!mesh->start) {
        for (size_t i = 0; i < TRIANGLE; i++)
            node[i] = mesh->item[(half & ~3u) + tm_face_corner[half & 3][i]];
        return TRIANGLE;
    }
    size_t k;
    const uint32_t *n = tm_mesh_view_nodes(mesh, half >> MIXED_SHIFT, &k);
    const uint8_t *face = tm_element_shapes[k].face[half & ((1u << MIXED_SHIFT) - 1)];
    for (size_t i = 0; i < QUADRILATERAL; i++)
        node[i] = n[face[i]];
    return tm_mixed_face_nodes(face);
}

/* tm_has_node_twice(), soon said where no two are the same modulo 64. */
static bool may_have_node_twice(const uint32_t *n, size_t k)
{
    enum { BITS = 64 };
    uint64_t seen = 0, again = 0;
    for (size_t i = 0; i < k; i++) {
        const uint64_t bit = (uint64_t)1 << n[i] % BITS;
        again |= seen & bit;
        seen |= bit;
    }
    return again != 0 && tm_has_node_twice(n, k);
}

/* The nodes of a row, counted through .face and .facet; how many. */
static size_t row_nodes(const tm_mesh_view *mesh, size_t row, const uint32_t **node)
{
    if (row < mesh->faces) {
        *node = mesh->face[row];
        return TRIANGLE;
    }
    const size_t f = row - mesh->faces;
    *node = mesh->facet_node + mesh->facet_start[f];
    return mesh->facet_start[f + 1] - mesh->facet_start[f];
}

bool tm_row_is_face(const tm_mesh_view *mesh, size_t row)
{
    const uint32_t *n;
    const size_t k = row_nodes(mesh, row, &n);
    return (k == TRIANGLE || k == QUADRILATERAL) && !tm_has_node_twice(n, k);
}

/* Lists --------------------------------------------------------------------------- */

/* Where element e, which names no node twice, is listed; how often. The item at node[i]
 * is *first + i of a mixed element, *first of a tetrahedron. */
static inline size_t list_element(const tm_mesh_view *mesh, size_t e, const uint32_t *n,
                                  size_t k, uint32_t node[TM_ELEMENT_FACES],
                                  uint32_t *first)
{
    if (!mesh->start) {
        const uint32_t i = n[1] < n[0], j = 2 + (n[3] < n[2]);
        const uint32_t low = n[i], other_low = n[j];
        node[0] = lesser(low, other_low);
        node[1] = low < other_low ? lesser(n[i ^ 1], other_low) : lesser(low, n[j ^ 1]);
        *first = (uint32_t)(TM_TET_NODES * e) + (low < other_low ? i : j);
        return 2;
    }
    tm_mixed_least(&tm_element_shapes[k], n, node);
    *first = (uint32_t)(e << MIXED_SHIFT);
    return tm_element_shapes[k].faces;
}

/* Each thread looks at all elements: more of them would only look. */
enum { MOST_PARTS = 8 };

/* A thread's part of the lists: those of some nodes. */
typedef struct part {
    uint32_t first, past; /* nodes */
    bool twice;           /* an element names a node twice */
} part;

static inline bool has(const part *p, uint32_t node)
{
    return node - p->first < p->past - p->first;
}

typedef struct listing {
    const tm_mesh_view *mesh;
    size_t *next;
    uint32_t *item;
    part *part;
} listing;

/* next[v + 1] counts what will be listed at v. */
static void count_elements(void *context, size_t i)
{
    const listing *l = context;
    part *p = &l->part[i];
    uint32_t node[TM_ELEMENT_FACES], first;
    for (size_t e = 0; e < l->mesh->elements; e++) {
        size_t k;
        const uint32_t *n = tm_mesh_view_nodes(l->mesh, e, &k);
        if (may_have_node_twice(n, k)) {
            p->twice = true;
            continue;
        }
        for (size_t f = list_element(l->mesh, e, n, k, node, &first); f-- > 0;)
            if (has(p, node[f]))
                l->next[node[f] + 1]++;
    }
}

/* next[v] is where the next one of v goes. */
static void list_elements(void *context, size_t i)
{
    const listing *l = context;
    const part *p = &l->part[i];
    uint32_t node[TM_ELEMENT_FACES], first;
    const uint32_t step = l->mesh->start ? 1 : 0;
    for (size_t e = 0; e < l->mesh->elements; e++) {
        size_t k;
        const uint32_t *n = tm_mesh_view_nodes(l->mesh, e, &k);
        if (p->twice && tm_has_node_twice(n, k))
            continue;
        for (size_t f = list_element(l->mesh, e, n, k, node, &first); f-- > 0;)
            if (has(p, node[f]))
                l->item[l->next[node[f]]++] = first + (uint32_t)f * step;
    }
}

/* The smallest node of a row; TM_NONE where the row shares no face with anything. */
static uint32_t corner_of_row(const tm_mesh_view *mesh, size_t row)
{
    const uint32_t *n;
    const size_t k = row_nodes(mesh, row, &n);
    if (k == TRIANGLE)
        return lesser(n[0], lesser(n[1], n[2]));
    return tm_row_is_face(mesh, row) ? lesser(lesser(n[0], n[1]), lesser(n[2], n[3]))
                                     : TM_NONE;
}

/* start[v + 2] counts, then start[v + 1] is where the next item of v goes. */
static bool make_lists(tm_face_table *table, part *parts, unsigned threads)
{
    const tm_mesh_view *mesh = table->mesh;
    const size_t rows = mesh->faces + mesh->facets;
    table->start = calloc(mesh->nodes + 2, sizeof *table->start);
    if (!table->start)
        return false;
    listing l = {.mesh = mesh, .next = table->start + 1, .part = parts};
    size_t *next = l.next;
    tm_parallel(threads, threads, count_elements, &l);
    for (size_t row = 0; row < rows; row++)
        if (corner_of_row(mesh, row) != TM_NONE)
            next[corner_of_row(mesh, row) + 1]++;
    for (size_t v = 0; v < mesh->nodes; v++)
        next[v + 1] += next[v];
    table->item = l.item = tm_new(next[mesh->nodes], sizeof *table->item);
    if (!table->item)
        return false;
    tm_parallel(threads, threads, list_elements, &l);
    for (size_t row = 0; row < rows; row++)
        if (corner_of_row(mesh, row) != TM_NONE)
            table->item[next[corner_of_row(mesh, row)]++] = (uint32_t)row | ROW;
    return true;
}

/* The nodes cut into parts of as many nodes each. */
static part *cut_nodes(size_t nodes, unsigned threads)
{
    part *parts = calloc(threads, sizeof *parts);
    for (unsigned t = 0; parts && t < threads; t++) {
        parts[t].first = (uint32_t)(nodes * t / threads);
        parts[t].past = (uint32_t)(nodes * (t + 1) / threads);
    }
    return parts;
}

tm_status tm_face_table_make(tm_face_table *table, const tm_mesh_view *mesh,
                             unsigned threads, tm_error *error)
{
    const unsigned shift = mesh->start ? MIXED_SHIFT : TET_SHIFT;
    *table = (tm_face_table){
        .mesh = mesh, .shift = shift, .first_row = (uint32_t)(mesh->elements << shift)};
    if (mesh->elements >= MOST_MEMBERS >> shift ||
        mesh->faces + mesh->facets >= MOST_MEMBERS - (mesh->elements << shift))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "%zu elements have more faces than 31 bits can number",
                       mesh->elements);
    threads = tm_threads_for(threads, MOST_PARTS, mesh->elements);
    part *parts = cut_nodes(mesh->nodes, threads);
    const bool done = parts && make_lists(table, parts, threads);
    free(parts);
    return done ? TM_OK : tm_fail_memory(error);
}

void tm_face_table_share(tm_face_table *table, const tm_face_table *other)
{
    *table = (tm_face_table){.mesh = other->mesh,
                             .shift = other->shift,
                             .first_row = other->first_row,
                             .start = other->start,
                             .item = other->item,
                             .shared = true};
}

void tm_face_table_cut(const tm_face_table *table, size_t runs, uint32_t *cut)
{
    const size_t nodes = table->mesh->nodes, items = table->start[nodes];
    for (size_t run = 0; run <= runs; run++) {
        /* the first node behind so many items */
        size_t low = 0, high = run < runs ? nodes : 0;
        const size_t before = (size_t)((double)items * (double)run / (double)runs);
        while (low < high) {
            const size_t middle = low + (high - low) / 2;
            if (table->start[middle] < before)
                low = middle + 1;
            else
                high = middle;
        }
        cut[run] = (uint32_t)(run < runs ? low : nodes);
    }
}

void tm_face_table_free(tm_face_table *table)
{
    if (!table->shared) {
        free(table->start);
        free(table->item);
    }
    free(table->face);
    free(table->member);
    free(table->hash.slot);
    *table = (tm_face_table){0};
}

/* The faces at a node -------------------------------------------------------------- */

/* Puts a member last in the list of its face. There is room. */
static inline void add(tm_face_table *table, uint64_t beside, uint32_t opposite,
                       uint32_t id, bool turned)
{
    const uint32_t member = (uint32_t)table->members++, faces = (uint32_t)table->faces;
    const bool is_element = id < table->first_row;
    tm_face *const face = table->face;
    uint32_t *slot = tm_hash_slot(&table->hash, tm_hash(opposite, beside));
    table->member[member] = (tm_face_member){id, TM_FACE_END, turned};
    while (*slot != TM_HASH_FREE &&
           (face[*slot].beside != beside || face[*slot].opposite != opposite))
        slot = tm_hash_next(&table->hash, slot);
    if (*slot == TM_HASH_FREE) {
        *slot = faces;
        face[faces] = (tm_face){beside, opposite, member, member, is_element};
        table->faces++;
        return;
    }
    tm_face *f = &face[*slot];
    table->member[f->last].next = member;
    f->last = member;
    f->elements += is_element;
}

/* A face with the smallest node v, the next one and the one before, seen from outside. */
static inline void add_at(tm_face_table *table, uint32_t next, uint32_t before,
                          uint32_t opposite, uint32_t id)
{
    add(table, (uint64_t)lesser(next, before) << 32 | greater(next, before), opposite, id,
        next > before);
}

static inline void add_triangle(tm_face_table *table, uint32_t v, uint32_t a, uint32_t b,
                                uint32_t c, uint32_t id)
{
    add_at(table, a == v ? b : b == v ? c : a, a == v ? c : b == v ? a : b, TM_NONE, id);
}

static inline void add_polygon(tm_face_table *table, uint32_t v, const uint32_t *n,
                               size_t k, uint32_t id)
{
    if (k == TRIANGLE) {
        add_triangle(table, v, n[0], n[1], n[2], id);
        return;
    }
    const size_t i = n[0] == v ? 0 : n[1] == v ? 1 : n[2] == v ? 2 : 3;
    add_at(table, n[(i + 1) % QUADRILATERAL], n[(i + 3) % QUADRILATERAL],
           n[(i + 2) % QUADRILATERAL], id);
}

/* What 4t + i stands for at v. */
static inline void add_tet(tm_face_table *table, uint32_t v, uint32_t item)
{
    const uint32_t i = item % TM_TET_NODES, half = item - i;
    const uint32_t *n = table->mesh->item + half;
    const bool is_corner = n[i] == v;
    for (uint32_t j = is_corner ? 0 : i; j < (is_corner ? TM_TET_NODES : i + 1); j++) {
        const uint8_t *corner = tm_face_corner[j];
        if (j != i || !is_corner)
            add_triangle(table, v, n[corner[0]], n[corner[1]], n[corner[2]], half + j);
    }
}

static inline void add_half(tm_face_table *table, uint32_t v, uint32_t half)
{
    uint32_t node[QUADRILATERAL];
    const size_t k = tm_half_face_nodes(table->mesh, half, node);
    add_polygon(table, v, node, k, half);
}

/* Room for the faces of so many items, and an empty table of them. */
static bool make_room(tm_face_table *table, size_t items)
{
    const size_t most = table->mesh->start ? items : TRIANGLE * items;
    const size_t slots = tm_hash_slots(most - most / 4); /* at most two thirds used */
    void *face = tm_grow(table->face, &table->face_room, most, sizeof *table->face);
    table->face = face ? face : table->face;
    void *member =
        tm_grow(table->member, &table->member_room, most, sizeof *table->member);
    table->member = member ? member : table->member;
    uint32_t *slot = tm_grow(table->hash.slot, &table->slot_room, slots, sizeof *slot);
    table->hash = (tm_hash_table){slots - 1, slot ? slot : table->hash.slot};
    if (!face || !member || !slot)
        return false;
    memset(slot, UINT8_MAX, slots * sizeof *slot);
    table->faces = table->members = 0;
    return true;
}

tm_status tm_face_table_at(tm_face_table *table, uint32_t v, tm_error *error)
{
    const tm_mesh_view *mesh = table->mesh;
    const uint32_t *item = table->item + table->start[v];
    const size_t items = table->start[v + 1] - table->start[v];
    if (!make_room(table, items))
        return tm_fail_memory(error);
    for (size_t i = 0; i < items; i++) {
        if (item[i] & ROW) {
            const uint32_t row = item[i] & ~ROW, *n;
            const size_t k = row_nodes(mesh, row, &n);
            add_polygon(table, v, n, k, table->first_row + row);
        } else if (mesh->start) {
            add_half(table, v, item[i]);
        } else {
            add_tet(table, v, item[i]);
        }
    }
    return TM_OK;
}

/* Notes who shares a face. */
static void note_mates(uint32_t *mate, const tm_face_table *table, const tm_face *face)
{
    const tm_face_member *member = &table->member[face->first];
    const uint32_t first = member->id;
    if (face->elements > 0)
        mate[first] = first;
    for (uint32_t i = 1; member->next != TM_FACE_END && face->elements > 0; i++) {
        member = &table->member[member->next];
        if (i == 1 && face->elements > 1)
            mate[first] = member->id;
        if (i == 1 || i >= face->elements)
            mate[member->id] = first;
    }
}

/* Nodes cut into runs, each with a table of its own for the lists of all. */
typedef struct matching {
    const tm_face_table *table;
    uint32_t *mate;
    uint32_t *cut; /* [runs + 1] */
    bool *failed;  /* [runs] */
} matching;

static void match_run(void *context, size_t run)
{
    const matching *m = context;
    tm_face_table table;
    tm_error error;
    tm_status status = TM_OK;
    tm_face_table_share(&table, m->table);
    for (uint32_t v = m->cut[run]; v < m->cut[run + 1] && status == TM_OK; v++) {
        status = tm_face_table_at(&table, v, &error);
        for (size_t f = 0; f < table.faces && status == TM_OK; f++)
            note_mates(m->mate, &table, &table.face[f]);
    }
    m->failed[run] = status != TM_OK;
    tm_face_table_free(&table);
}

static bool match_all(const tm_face_table *table, uint32_t *mate)
{
    enum { RUNS_PER_THREAD = 4 };
    const unsigned threads = table->mesh->threads;
    const size_t runs = threads > 1 ? (size_t)threads * RUNS_PER_THREAD : 1;
    matching m = {table, mate, tm_new(runs + 1, sizeof *m.cut),
                  calloc(runs, sizeof *m.failed)};
    bool done = m.cut && m.failed;
    if (done) {
        tm_face_table_cut(table, runs, m.cut);
        tm_parallel(threads, runs, match_run, &m);
    }
    for (size_t run = 0; run < runs && done; run++)
        done = !m.failed[run];
    free(m.cut);
    free(m.failed);
    return done;
}

tm_status tm_face_mates(uint32_t **mate, const tm_mesh_view *mesh, tm_error *error)
{
    tm_face_table table;
    *mate = NULL;
    const unsigned threads = mesh->threads > 0 ? mesh->threads : 1;
    tm_status status = tm_face_table_make(&table, mesh, threads, error);
    const size_t members = table.first_row + mesh->faces + mesh->facets;
    if (status == TM_OK) {
        *mate = tm_new(members, sizeof **mate);
        if (*mate)
            memset(*mate, UINT8_MAX, members * sizeof **mate);
        if (!*mate || !match_all(&table, *mate))
            status = tm_fail_memory(error);
    }
    tm_face_table_free(&table);
    return status;
}

/* Order ----------------------------------------------------------------------------- */

/* By the second, the third and the largest node, and which of them is the opposite one.
 */
static bool quadrilateral_before(const tm_face *f, const tm_face *g)
{
    uint32_t n[3], m[3];
    tm_face_others(f, n);
    tm_face_others(g, m);
    for (size_t i = 0; i < 3; i++)
        if (n[i] != m[i])
            return n[i] < m[i];
    return f->opposite < g->opposite;
}

static inline bool comes_before(const tm_face *f, const tm_face *g)
{
    if (f->opposite == TM_NONE && g->opposite == TM_NONE)
        return f->beside < g->beside;
    return quadrilateral_before(f, g);
}

static int compare(const void *a, const void *b)
{
    return comes_before(a, b) ? -1 : comes_before(b, a);
}

/* Insertion sort is the fastest for the few faces that a node has. */
void tm_face_table_sort(tm_face_table *table)
{
    enum { FEW = 48 };
    tm_face *face = table->face;
    if (table->faces > FEW) {
        qsort(face, table->faces, sizeof *face, compare);
        return;
    }
    for (size_t i = 1; i < table->faces; i++) {
        const tm_face f = face[i];
        size_t j = i;
        for (; j > 0 && comes_before(&f, &face[j - 1]); j--)
            face[j] = face[j - 1];
        face[j] = f;
    }
}
