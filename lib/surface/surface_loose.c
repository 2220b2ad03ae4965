/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_loose.h"

#include "../base/array.h"
#include "../base/disjoint_sets.h"
#include "../geom/vector.h"

#include <math.h>
#include <stdlib.h>

/* How many of the sharp edges that are left are at each node. */
static void count_degrees(const tm_sharp_network *f, uint32_t *degree)
{
    for (size_t e = 0; e < f->edges; e++)
        for (int i = 0; i < 2; i++)
            degree[f->edge[e].node[i]]++;
}

/* Follows sharp edges from a node with one, over nodes with two. Returns the length; the
 * edges are chain[0 … *count). */
static double follow_end(const tm_sharp_network *f, uint32_t v, const uint32_t *degree,
                         const bool *dropped, uint32_t *chain, size_t *count)
{
    const tm_surface *surface = f->surface;
    double length = 0;
    *count = 0;
    for (;;) {
        size_t i = f->start[v];
        while (i < f->start[v + 1] &&
               (dropped[f->at[i]] || (*count > 0 && f->at[i] == chain[*count - 1])))
            i++;
        if (i == f->start[v + 1] || (*count > 0 && degree[v] != 2))
            return length;
        uint32_t e = chain[(*count)++] = f->at[i];
        const uint32_t *n = f->edge[e].node;
        length += sqrt(tm_distance2(surface->xyz[n[0]], surface->xyz[n[1]]));
        if (f->edge[e].triangle[1] == TM_NONE)
            length = HUGE_VAL; /* it is not sharp by its angle */
        v = n[n[0] == v];
    }
}

/* Drops chains of sharp edges that end freely and are shorter than `least`, until there
 * is none. */
static void prune(const tm_sharp_network *f, double least, uint32_t *degree,
                  bool *dropped, uint32_t *chain)
{
    for (bool again = true; again;) {
        again = false;
        for (uint32_t v = 0; v < f->surface->nodes; v++) {
            size_t count;
            if (degree[v] != 1 ||
                !(follow_end(f, v, degree, dropped, chain, &count) < least))
                continue;
            again = true;
            for (size_t k = 0; k < count; k++) {
                dropped[chain[k]] = true;
                for (int i = 0; i < 2; i++)
                    degree[f->edge[chain[k]].node[i]]--;
            }
        }
    }
}

/* Networks of sharp edges: what is connected, by the node that stands for it. */
typedef struct component {
    uint32_t *root;  /* [nodes]: disjoint sets */
    uint32_t *loose; /* [nodes], at roots: chains that end freely and are short */
    uint32_t *arms;  /* curves at nodes that are not just passed: twice their number */
} component;

static void count_network(const tm_sharp_network *f, double least, const uint32_t *degree,
                          const bool *dropped, uint32_t *chain, component *n)
{
    const size_t nodes = f->surface->nodes;
    for (uint32_t v = 0; v < nodes; v++)
        n->root[v] = v;
    for (size_t e = 0; e < f->edges; e++)
        tm_set_unite(n->root, f->edge[e].node[0], f->edge[e].node[1]);
    for (uint32_t v = 0; v < nodes; v++) {
        size_t count;
        uint32_t root = tm_set_root(n->root, v);
        if (degree[v] != 2)
            n->arms[root] += degree[v];
        n->loose[root] +=
            degree[v] == 1 && follow_end(f, v, degree, dropped, chain, &count) < least;
    }
}

/* Drops the networks of which many curves end freely, and all where many of all do: they
 * are no features of a shape, but roughness. */
static bool drop_rough(const tm_sharp_network *f, double least, uint32_t *degree,
                       bool *dropped, uint32_t *chain, bool *rough)
{
    const uint32_t many = 20; /* one of so many */
    const size_t nodes = f->surface->nodes;
    size_t loose = 0, arms = 0;
    component n = {tm_new(nodes, sizeof *n.root), calloc(nodes + 1, sizeof *n.loose),
                   calloc(nodes + 1, sizeof *n.arms)};
    bool done = n.root && n.loose && n.arms;
    if (done)
        count_network(f, least, degree, dropped, chain, &n);
    for (size_t v = 0; v < nodes && done; v++) {
        loose += n.loose[v];
        arms += n.arms[v];
    }
    /* A network without a node that is not just passed is one closed curve. */
    for (size_t e = 0; e < f->edges && done; e++) {
        const uint32_t root = tm_set_root(n.root, f->edge[e].node[0]);
        if (n.arms[root] == 0)
            arms += n.arms[root] = 2;
    }
    *rough |= 2 * many * loose > arms;
    for (size_t e = 0; e < f->edges && done; e++) {
        const uint32_t root = tm_set_root(n.root, f->edge[e].node[0]);
        if (f->edge[e].triangle[1] == TM_NONE ||
            (2 * many * n.loose[root] <= n.arms[root] && 2 * many * loose <= arms))
            continue;
        dropped[e] = true;
        for (int i = 0; i < 2; i++)
            degree[f->edge[e].node[i]]--;
    }
    free(n.root);
    free(n.loose);
    free(n.arms);
    return done;
}

tm_status tm_surface_find_loose(const tm_sharp_network *network, double least,
                                bool *dropped, bool *rough, tm_error *error)
{
    uint32_t *degree = calloc(network->surface->nodes + 1, sizeof *degree);
    uint32_t *chain = tm_new(network->edges, sizeof *chain);
    bool done = degree && chain;
    if (done) {
        count_degrees(network, degree);
        done = drop_rough(network, least, degree, dropped, chain, rough);
    }
    if (done)
        prune(network, least, degree, dropped, chain);
    free(degree);
    free(chain);
    return done ? TM_OK : tm_fail_memory(error);
}

/* One free end for so many edges of a body makes it rough. */
static const size_t many_of_body = 10;

/* The same of edges that hang together: so many are a feature where they have no free end
 * close by, twice as many where they have one, and so on. */
static const size_t many_of_network = 30;

/* What is close by: over so many edges of triangles. */
enum { RINGS = 3 };

/* What is connected, at the node that stands for it. */
typedef struct tally {
    size_t edges, ends; /* sharp edges; their free ends */
} tally;

typedef struct roughness {
    const tm_surface *surface;
    const tm_sharp_edge *edge;
    size_t edges;
    uint32_t *body; /* [nodes]: disjoint sets, joined by triangles; all of a surface that
                       crosses itself */
    uint32_t *network; /* [nodes]: the same, by sharp edges */
    uint8_t *degree;   /* [nodes]: sharp edges there; 2: or more */
    tally *of_body;    /* [nodes], at roots */
    tally *of_network; /* [nodes], at roots; ends are those close by */
    size_t *start; /* [nodes + 1]: the triangles at v are at[start[v] … start[v + 1]) */
    uint32_t *at;
    uint32_t *met;     /* [nodes]: the free end plus 1 from which it was reached last */
    uint32_t *counted; /* [nodes], at roots of networks: the same, where it was counted */
    uint32_t *near;    /* [nodes]: those reached from a free end */
} roughness;

static void unite(roughness *f)
{
    const tm_surface *surface = f->surface;
    for (uint32_t v = 0; v < surface->nodes; v++)
        f->body[v] = f->network[v] = v;
    for (size_t t = 0; t < surface->triangles; t++)
        for (int i = 1; i < 3; i++)
            tm_set_unite(f->body, surface->triangle[t][0], surface->triangle[t][i]);
    for (uint32_t v = 0; v < surface->nodes && surface->crossings > 0; v++)
        tm_set_unite(f->body, 0, v);
    for (size_t e = 0; e < f->edges; e++)
        tm_set_unite(f->network, f->edge[e].node[0], f->edge[e].node[1]);
}

static void count_bodies(roughness *f)
{
    for (size_t e = 0; e < f->edges; e++) {
        const uint32_t *node = f->edge[e].node;
        f->of_body[tm_set_root(f->body, node[0])].edges++;
        f->of_network[tm_set_root(f->network, node[0])].edges++;
        for (int i = 0; i < 2; i++)
            f->degree[node[i]] = f->degree[node[i]] == 0 ? 1 : 2;
    }
    for (uint32_t v = 0; v < f->surface->nodes; v++)
        f->of_body[tm_set_root(f->body, v)].ends += f->degree[v] == 1;
}

/* Of a node that is on no sharp edge: whether its body has many that end freely. */
static bool body_is_rough(roughness *f, uint32_t v)
{
    const tally *of = &f->of_body[tm_set_root(f->body, v)];
    return of->ends > of->edges / many_of_body;
}

static void sort_triangles(roughness *f)
{
    const tm_surface *surface = f->surface;
    for (size_t t = 0; t < surface->triangles; t++)
        for (int i = 0; i < 3; i++)
            f->start[surface->triangle[t][i] + 2]++;
    for (size_t v = 1; v <= surface->nodes; v++)
        f->start[v + 1] += f->start[v];
    for (size_t t = 0; t < surface->triangles; t++)
        for (int i = 0; i < 3; i++)
            f->at[f->start[surface->triangle[t][i] + 1]++] = (uint32_t)t;
}

/* Counts a free end for the network of a node that is close to it, once. */
static void reach(roughness *f, uint32_t end, uint32_t v, size_t *count)
{
    if (f->met[v] == end + 1)
        return;
    f->met[v] = end + 1;
    f->near[(*count)++] = v;
    const uint32_t network = tm_set_root(f->network, v);
    if (f->degree[v] == 0 || f->counted[network] == end + 1)
        return;
    f->counted[network] = end + 1;
    f->of_network[network].ends++;
}

static void count_end(roughness *f, uint32_t end)
{
    size_t first = 0, count = 0;
    reach(f, end, end, &count);
    for (int ring = 0; ring < RINGS; ring++)
        for (const size_t last = count; first < last; first++) {
            const uint32_t v = f->near[first];
            for (size_t i = f->start[v]; i < f->start[v + 1]; i++)
                for (int k = 0; k < 3; k++)
                    reach(f, end, f->surface->triangle[f->at[i]][k], &count);
        }
}

static void find(roughness *f, bool *rough, size_t *rough_edges)
{
    const size_t nodes = f->surface->nodes;
    unite(f);
    count_bodies(f);
    sort_triangles(f);
    for (uint32_t v = 0; v < nodes; v++)
        if (f->degree[v] == 1 && body_is_rough(f, v))
            count_end(f, v);
    for (uint32_t v = 0; v < nodes; v++) {
        const tally *network = &f->of_network[tm_set_root(f->network, v)];
        rough[v] =
            body_is_rough(f, v) && network->edges < many_of_network * (network->ends + 1);
    }
    for (size_t e = 0; e < f->edges; e++)
        *rough_edges += rough[f->edge[e].node[0]];
}

tm_status tm_surface_find_rough(const tm_surface *surface, const tm_sharp_edge *edge,
                                size_t edges, bool *rough, size_t *rough_edges,
                                tm_error *error)
{
    const size_t nodes = surface->nodes;
    roughness f = {.surface = surface,
                   .edge = edge,
                   .edges = edges,
                   .body = tm_new(nodes, sizeof *f.body),
                   .network = tm_new(nodes, sizeof *f.network),
                   .degree = calloc(nodes + 1, sizeof *f.degree),
                   .of_body = calloc(nodes + 1, sizeof *f.of_body),
                   .of_network = calloc(nodes + 1, sizeof *f.of_network),
                   .start = calloc(nodes + 2, sizeof *f.start),
                   .at = tm_new(3 * surface->triangles, sizeof *f.at),
                   .met = calloc(nodes + 1, sizeof *f.met),
                   .counted = calloc(nodes + 1, sizeof *f.counted),
                   .near = tm_new(nodes, sizeof *f.near)};
    *rough_edges = 0;
    const bool done = f.body && f.network && f.degree && f.of_body && f.of_network &&
                      f.start && f.at && f.met && f.counted && f.near;
    if (done)
        find(&f, rough, rough_edges);
    void *const arrays[] = {f.body,  f.network, f.degree, f.of_body, f.of_network,
                            f.start, f.at,      f.met,    f.counted, f.near};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
    return done ? TM_OK : tm_fail_memory(error);
}
