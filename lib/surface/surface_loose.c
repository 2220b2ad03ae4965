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
