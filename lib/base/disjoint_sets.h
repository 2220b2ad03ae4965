/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disjoint sets as trees of parents: parent[x] == x is the root that stands for a set,
 * and two sets are joined by giving one root the other as its parent. */
#ifndef TM_BASE_DISJOINT_SETS_H
#define TM_BASE_DISJOINT_SETS_H

#include <stdint.h>

/* The root of the set of x. Halves the path on the way (R. E. Tarjan and J. van Leeuwen,
 * Worst-case analysis of set union algorithms, Journal of the ACM 31, 1984). */
static inline uint32_t tm_set_root(uint32_t *parent, uint32_t x)
{
    while (parent[x] != x)
        x = parent[x] = parent[parent[x]];
    return x;
}

/* Makes one set of those of a and b; its root is the smaller one. */
static inline void tm_set_unite(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = tm_set_root(parent, a);
    b = tm_set_root(parent, b);
    parent[a > b ? a : b] = a > b ? b : a;
}

#endif
