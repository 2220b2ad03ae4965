/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Disjoint sets as trees of parents: parent[x] == x is the root that stands for a set,
 * and two sets are joined by giving one root the other as its parent. */
#ifndef TM_BASE_DISJOINT_SETS_H
#define TM_BASE_DISJOINT_SETS_H

#include <stdbool.h>
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

/* The same by several threads at a time: what they read and write of each other is whole,
 * and a root is given a parent by the one that finds it to be a root still. The sets do
 * not depend on who comes first. */
static inline uint32_t tm_set_root_shared(uint32_t *parent, uint32_t x)
{
    uint32_t up = __atomic_load_n(&parent[x], __ATOMIC_RELAXED);
    while (up != x) {
        const uint32_t above = __atomic_load_n(&parent[up], __ATOMIC_RELAXED);
        if (above != up)
            __atomic_store_n(&parent[x], above, __ATOMIC_RELAXED);
        x = up;
        up = above;
    }
    return x;
}

static inline void tm_set_unite_shared(uint32_t *parent, uint32_t a, uint32_t b)
{
    for (;;) {
        a = tm_set_root_shared(parent, a);
        b = tm_set_root_shared(parent, b);
        if (a == b)
            return;
        const uint32_t larger = a > b ? a : b, smaller = a > b ? b : a;
        uint32_t is_root = larger;
        if (__atomic_compare_exchange_n(&parent[larger], &is_root, smaller, false,
                                        __ATOMIC_RELAXED, __ATOMIC_RELAXED))
            return;
    }
}

/* Makes the root of x its parent, when no sets are joined and no paths halved any more.
 */
static inline void tm_set_put_root_shared(uint32_t *parent, uint32_t x)
{
    uint32_t root = x, up = __atomic_load_n(&parent[x], __ATOMIC_RELAXED);
    while (up != root) {
        root = up;
        up = __atomic_load_n(&parent[root], __ATOMIC_RELAXED);
    }
    __atomic_store_n(&parent[x], root, __ATOMIC_RELAXED);
}

#endif
