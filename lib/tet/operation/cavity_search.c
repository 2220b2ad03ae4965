/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cavity_search.h"

#include "../../geom/predicates.h"

#include <string.h>

/* A face belongs to one tetrahedron, a tetrahedron has so many. */
enum { FACES_OF_TET = 4 };

static const uint32_t is_known = (uint32_t)1 << TM_SEARCH_NODES;

/* What is not filled yet, and what is. */
typedef struct {
    size_t faces;
    uint8_t face[TM_SEARCH_FACES][3];
} front;

typedef struct {
    tm_cavity_search *s;
    const tm_cost *cost;
    double least, most; /* as above; most falls to the cost of the best one */
    size_t steps_most;
    size_t tets;
    uint8_t tet[TM_SEARCH_TETS][4];
    bool found;
} search;

static uint32_t bit(unsigned v)
{
    return (uint32_t)1 << v;
}

/* The lowest node of a set that is not empty. */
static unsigned first_of(uint32_t set)
{
    return (unsigned)__builtin_ctz(set);
}

static void order(unsigned *a, unsigned *b)
{
    unsigned low = *a < *b ? *a : *b, high = *a < *b ? *b : *a;
    *a = low;
    *b = high;
}

/* The number of the set of four nodes: its place when sets are sorted by their largest
 * nodes. */
static size_t quad_of(unsigned a, unsigned b, unsigned c, unsigned d)
{
    enum { FACTORIAL_3 = 6, FACTORIAL_4 = 24 };
    order(&a, &b);
    order(&c, &d);
    order(&a, &c);
    order(&b, &d);
    order(&b, &c);
    return (size_t)d * (d - 1) * (d - 2) * (d - 3) / FACTORIAL_4 +
           (size_t)c * (c - 1) * (c - 2) / FACTORIAL_3 + (size_t)b * (b - 1) / 2 + a;
}

static void set_above(tm_cavity_search *s, unsigned a, unsigned b, unsigned c, unsigned d)
{
    s->above[a][b][c] |= bit(d);
    s->above[b][c][a] |= bit(d);
    s->above[c][a][b] |= bit(d);
}

/* Finds out which four nodes are a positive tetrahedron in which order. */
static void orient_all(tm_cavity_search *s)
{
    unsigned n = (unsigned)s->nodes;
    for (unsigned a = 0; a < n; a++)
        for (unsigned b = 0; b < n; b++)
            memset(s->above[a][b], 0, n * sizeof s->above[a][b][0]);
    for (unsigned d = 0; d < n; d++)
        for (unsigned c = 0; c < d; c++)
            for (unsigned b = 0; b < c; b++)
                for (unsigned a = 0; a < b; a++) {
                    int sign = tm_orient3d(s->xyz[a], s->xyz[b], s->xyz[c], s->xyz[d]);
                    if (sign == 0)
                        continue;
                    unsigned x = sign > 0 ? a : b, y = sign > 0 ? b : a;
                    set_above(s, x, y, c, d);
                    set_above(s, y, x, d, c);
                    set_above(s, c, d, x, y);
                    set_above(s, d, c, y, x);
                }
}

/* Whether edge uv goes through the inside of triangle abc, with no node in common. */
static bool crosses(const tm_cavity_search *s, unsigned u, unsigned v, unsigned a,
                    unsigned b, unsigned c)
{
    uint32_t over = s->above[a][b][c], under = s->above[b][a][c];
    if (over & bit(u) && under & bit(v))
        return s->above[u][v][b] & bit(a) && s->above[u][v][c] & bit(b) &&
               s->above[u][v][a] & bit(c);
    if (over & bit(v) && under & bit(u))
        return s->above[v][u][b] & bit(a) && s->above[v][u][c] & bit(b) &&
               s->above[v][u][a] & bit(c);
    return false;
}

/* Whether an edge goes through one of the faces. */
static bool crosses_any(const tm_cavity_search *s, unsigned u, unsigned v,
                        const uint8_t (*face)[3], size_t faces)
{
    for (size_t f = 0; f < faces; f++)
        if (crosses(s, u, v, face[f][0], face[f][1], face[f][2]))
            return true;
    return false;
}

static void find_visible(tm_cavity_search *s)
{
    memset(s->visible, 0, sizeof s->visible);
    for (unsigned u = 0; u < s->nodes; u++)
        for (unsigned v = 0; v < u; v++)
            if (!crosses_any(s, u, v, (const uint8_t(*)[3])s->face, s->faces)) {
                s->visible[u] |= bit(v);
                s->visible[v] |= bit(u);
            }
}

/* What the tetrahedron abcd, which is positive, costs; HUGE_VAL: not allowed. */
static double cost_of(const search *h, unsigned a, unsigned b, unsigned c, unsigned d)
{
    tm_cavity_search *s = h->s;
    double *known = &s->cost_of[quad_of(a, b, c, d)];
    if (!isnan(*known))
        return *known;
    double quality =
        tm_cost_quality(h->cost, h->least, s->xyz[a], s->xyz[b], s->xyz[c], s->xyz[d]);
    *known = quality > 0 && quality >= h->least ? tm_cost_of(h->cost, quality) : HUGE_VAL;
    return *known;
}

/* The nodes that face abc may be joined to. */
static uint32_t candidates_of(const search *h, const uint8_t n[3])
{
    tm_cavity_search *s = h->s;
    unsigned a = n[0], b = n[1], c = n[2];
    uint32_t *known = &s->candidates[a][b][c];
    if (*known & is_known)
        return *known & ~is_known;
    uint32_t left = s->above[a][b][c] & s->visible[a] & s->visible[b] & s->visible[c];
    uint32_t allowed = 0;
    double cheapest = HUGE_VAL;
    for (; left != 0; left &= left - 1) {
        unsigned v = first_of(left);
        double cost = cost_of(h, a, b, c, v);
        if (!(cost < HUGE_VAL))
            continue;
        cheapest = fmin(cheapest, cost);
        allowed |= bit(v);
    }
    s->cheapest[a][b][c] = cheapest;
    *known = allowed | is_known;
    return allowed;
}

/* The place of a face, in any rotation, in the front; its number of faces: not there. */
static size_t find_face(const front *f, unsigned a, unsigned b, unsigned c)
{
    for (size_t i = 0; i < f->faces; i++) {
        const uint8_t *n = f->face[i];
        if ((n[0] == a && n[1] == b && n[2] == c) ||
            (n[1] == a && n[2] == b && n[0] == c) ||
            (n[2] == a && n[0] == b && n[1] == c))
            return i;
    }
    return f->faces;
}

/* linked[a]: the nodes that have an edge of the front to node a. */
static void find_links(const front *f, uint32_t linked[TM_SEARCH_NODES])
{
    memset(linked, 0, TM_SEARCH_NODES * sizeof *linked);
    for (size_t i = 0; i < f->faces; i++) {
        const uint8_t *n = f->face[i];
        linked[n[0]] |= bit(n[1]) | bit(n[2]);
        linked[n[1]] |= bit(n[2]) | bit(n[0]);
        linked[n[2]] |= bit(n[0]) | bit(n[1]);
    }
}

/* Whether an edge of the front goes through triangle abc. */
static bool is_crossed(const tm_cavity_search *s, const uint32_t linked[TM_SEARCH_NODES],
                       unsigned a, unsigned b, unsigned c)
{
    uint32_t over = s->above[a][b][c], under = s->above[b][a][c];
    for (; over != 0; over &= over - 1) {
        unsigned u = first_of(over);
        for (uint32_t left = linked[u] & under; left != 0; left &= left - 1)
            if (crosses(s, u, first_of(left), a, b, c))
                return true;
    }
    return false;
}

/* Whether a node of the front is inside the tetrahedron of face n and node v. */
static bool holds_node(const tm_cavity_search *s, const uint32_t linked[TM_SEARCH_NODES],
                       const uint8_t n[3], unsigned v)
{
    uint32_t inside = s->above[n[0]][n[1]][n[2]] & s->above[n[1]][n[0]][v] &
                      s->above[n[2]][n[1]][v] & s->above[n[0]][n[2]][v];
    for (; inside != 0; inside &= inside - 1)
        if (linked[first_of(inside)] != 0)
            return true;
    return false;
}

/* Takes the tetrahedron of front face `place` and node v out of what is to be filled;
 * false where it is seen to overlap what is there. */
static bool fill_with(const tm_cavity_search *s, const front *from,
                      const uint32_t linked[TM_SEARCH_NODES], size_t place, unsigned v,
                      front *to)
{
    const uint8_t *n = from->face[place];
    if (holds_node(s, linked, n, v))
        return false;
    for (int k = 0; k < 3; k++)
        if (!(linked[v] & bit(n[k])) &&
            crosses_any(s, n[k], v, (const uint8_t(*)[3])from->face, from->faces))
            return false;
    *to = *from;
    memcpy(to->face[place], to->face[--to->faces], sizeof to->face[0]);
    for (int k = 0; k < 3; k++) {
        unsigned x = n[k], y = n[(k + 1) % 3];
        bool is_linked = (linked[v] & bit(x)) && (linked[v] & bit(y));
        size_t other = is_linked ? find_face(to, y, x, v) : to->faces;
        if (other < to->faces) {
            memcpy(to->face[other], to->face[--to->faces], sizeof to->face[0]);
            continue;
        }
        if (to->faces == TM_SEARCH_FACES ||
            (is_linked && find_face(to, x, y, v) < to->faces) ||
            is_crossed(s, linked, x, y, v))
            return false;
        memcpy(to->face[to->faces++], (uint8_t[3]){(uint8_t)x, (uint8_t)y, (uint8_t)v},
               sizeof to->face[0]);
    }
    return true;
}

/* The face of the front that the fewest nodes can be joined to; its number of faces where
 * the front cannot be filled for less than the best, which costs `more` beyond what is
 * filled. */
static size_t choose_face(const search *h, const front *f, double more)
{
    size_t best = f->faces;
    int fewest = TM_SEARCH_NODES + 1;
    double sum = 0; /* of the least that each face costs */
    for (size_t i = 0; i < f->faces; i++) {
        const uint8_t *n = f->face[i];
        int count = __builtin_popcount(candidates_of(h, n));
        sum += h->s->cheapest[n[0]][n[1]][n[2]];
        if (count >= fewest)
            continue;
        fewest = count;
        best = i;
    }
    return fewest > 0 && sum < FACES_OF_TET * more ? best : f->faces;
}

/* The candidates of a face, the cheapest first. Returns how many. */
static size_t sort_candidates(const search *h, const uint8_t n[3],
                              uint8_t node[TM_SEARCH_NODES], double cost[TM_SEARCH_NODES])
{
    size_t count = 0;
    for (uint32_t left = candidates_of(h, n); left != 0; left &= left - 1) {
        unsigned v = first_of(left);
        double of_v = cost_of(h, n[0], n[1], n[2], v);
        size_t i = count++;
        for (; i > 0 && cost[i - 1] > of_v; i--) {
            cost[i] = cost[i - 1];
            node[i] = node[i - 1];
        }
        cost[i] = of_v;
        node[i] = (uint8_t)v;
    }
    return count;
}

static void keep_found(search *h, double sum)
{
    tm_cavity_search *s = h->s;
    memcpy(s->tet, h->tet, h->tets * sizeof s->tet[0]);
    s->tets = h->tets;
    s->cost = h->most = sum;
    h->found = true;
}

/* Fills the front in every way that may be the best one; what is filled costs `sum`. */
static void fill(search *h, const front *f, double sum)
{
    if (f->faces == 0) {
        keep_found(h, sum);
        return;
    }
    if (h->tets == TM_SEARCH_TETS || h->s->steps >= h->steps_most)
        return;
    h->s->steps++;
    size_t place = choose_face(h, f, h->most - sum);
    if (place == f->faces)
        return;
    const uint8_t *n = f->face[place];
    uint8_t node[TM_SEARCH_NODES];
    double cost[TM_SEARCH_NODES];
    uint32_t linked[TM_SEARCH_NODES];
    size_t count = sort_candidates(h, n, node, cost);
    find_links(f, linked);
    for (size_t i = 0; i < count && sum + cost[i] < h->most; i++) {
        front next;
        if (!fill_with(h->s, f, linked, place, node[i], &next))
            continue;
        memcpy(h->tet[h->tets++], (uint8_t[4]){n[0], n[1], n[2], node[i]},
               sizeof h->tet[0]);
        fill(h, &next, sum + cost[i]);
        h->tets--;
    }
}

/* The node's number in the search, a new one if need be; TM_SEARCH_NODES: too many. */
static unsigned number_of(tm_cavity_search *s, const tm_tet_mesh *mesh, uint32_t v)
{
    unsigned i = 0;
    while (i < s->nodes && s->label[i] != v)
        i++;
    if (i < s->nodes || i == TM_SEARCH_NODES)
        return i;
    s->label[i] = v;
    memcpy(s->xyz[i], mesh->xyz[v], sizeof s->xyz[i]);
    s->nodes++;
    return i;
}

/* Whether every edge is of exactly two faces, which differ by more than their side. */
static bool is_simple(const tm_cavity_search *s)
{
    uint8_t third[TM_SEARCH_NODES][TM_SEARCH_NODES];
    memset(third, TM_SEARCH_NODES, sizeof third);
    for (size_t f = 0; f < s->faces; f++)
        for (int k = 0; k < 3; k++) {
            uint8_t *other = &third[s->face[f][k]][s->face[f][(k + 1) % 3]];
            if (*other != TM_SEARCH_NODES)
                return false;
            *other = s->face[f][(k + 2) % 3];
        }
    for (size_t a = 0; a < s->nodes; a++)
        for (size_t b = 0; b < a; b++)
            if ((third[a][b] == TM_SEARCH_NODES) != (third[b][a] == TM_SEARCH_NODES) ||
                (third[a][b] != TM_SEARCH_NODES && third[a][b] == third[b][a]))
                return false;
    return true;
}

bool tm_cavity_search_load(tm_cavity_search *s, const tm_tet_mesh *mesh,
                           const tm_cavity *cavity)
{
    s->nodes = 0;
    s->faces = cavity->faces;
    if (s->faces > TM_SEARCH_FACES)
        return false;
    for (size_t f = 0; f < s->faces; f++)
        for (int k = 0; k < 3; k++) {
            unsigned i = number_of(s, mesh, cavity->face[f][k]);
            if (i == TM_SEARCH_NODES)
                return false;
            s->face[f][k] = (uint8_t)i;
        }
    s->outer_nodes = s->nodes;
    for (size_t t = 0; t < cavity->size; t++)
        for (int k = 0; k < 4; k++)
            if (number_of(s, mesh, mesh->tet[cavity->tet[t]][k]) == TM_SEARCH_NODES)
                return false;
    return is_simple(s);
}

/* Forgets what was known of another cavity. */
static void forget(tm_cavity_search *s)
{
    size_t n = s->nodes;
    size_t quads = n < 4 ? 0
                         : quad_of((unsigned)n - 4, (unsigned)n - 3, (unsigned)n - 2,
                                   (unsigned)n - 1) +
                               1;
    for (size_t a = 0; a < n; a++)
        for (size_t b = 0; b < n; b++)
            memset(s->candidates[a][b], 0, n * sizeof s->candidates[a][b][0]);
    for (size_t q = 0; q < quads; q++)
        s->cost_of[q] = NAN;
}

bool tm_cavity_search_run(tm_cavity_search *s, const tm_cost *cost, double least,
                          double most, size_t steps_most)
{
    search h = {
        .s = s, .cost = cost, .least = least, .most = most, .steps_most = steps_most};
    front whole = {.faces = s->faces};
    memcpy(whole.face, s->face, s->faces * sizeof s->face[0]);
    s->steps = s->tets = 0;
    forget(s);
    orient_all(s);
    find_visible(s);
    fill(&h, &whole, 0);
    return h.found;
}
