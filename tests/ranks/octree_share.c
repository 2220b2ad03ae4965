/* SPDX-License-Identifier: GPL-3.0-or-later */
/* octree_share RANKS: shares of octrees: cut from a whole one against what touches what;
 * and those that ranks make together, as many as a launcher starts, against the cut. */
#include "../../lib/base/disjoint_sets.h"
#include "../../lib/octree/interior/interior_share.h"
#include "../../lib/ranks/ranks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../unit/octree_fixture.h"

enum { SURFACES = 40, RULES = 3, RINGS = 3, SPLIT_EVERY = 30 };

static bool touch(const tm_leaf *a, const tm_leaf *b)
{
    for (int i = 0; i < 3; i++) {
        const uint32_t ends_a = a->anchor[i] + (1U << (TM_OCTREE_FINEST - a->level));
        const uint32_t ends_b = b->anchor[i] + (1U << (TM_OCTREE_FINEST - b->level));
        if (a->anchor[i] > ends_b || b->anchor[i] > ends_a)
            return false;
    }
    return true;
}

/* The ghosts of a share, by the places of leaves alone: level[leaf] is the ring that a
 * leaf is in, RINGS + 1 beyond. */
static void find_rings(unsigned *ring, const tm_octree *whole, size_t first, size_t past)
{
    for (size_t l = 0; l < whole->leaves; l++)
        ring[l] = l >= first && l < past ? 0 : RINGS + 1;
    for (unsigned r = 0; r < RINGS; r++)
        for (size_t a = 0; a < whole->leaves; a++)
            for (size_t b = 0; ring[a] == r && b < whole->leaves; b++)
                if (ring[b] > r + 1 && touch(&whole->leaf[a], &whole->leaf[b]))
                    ring[b] = r + 1;
}

static void assert_sent(const tm_octree_share *s, const tm_octree_share *other,
                        const tm_share_list *list, const uint32_t *own_number,
                        const uint32_t *number, size_t count, size_t first, size_t past)
{
    size_t at = list->start[other->rank];
    for (size_t i = 0; i < count; i++)
        if (number[i] >= first && number[i] < past) {
            assert_true(at < list->start[other->rank + 1]);
            assert_int_equal(own_number[list->item[at++]], number[i]);
        }
    assert_int_equal(at, list->start[other->rank + 1]);
    (void)s;
}

/* What each share of so many is, and that they send what the others lack. */
static void check_cut(const tm_octree *whole, unsigned ranks, unsigned rings)
{
    tm_error error;
    tm_octree_share *share = calloc(ranks, sizeof *share);
    unsigned *ring = malloc((whole->leaves + 1) * sizeof *ring);
    for (unsigned r = 0; r < ranks; r++) {
        tm_octree_share *s = &share[r];
        assert_ok(tm_octree_share_cut(s, whole, r, ranks, rings, &error), &error);
        size_t l = 0;
        find_rings(ring, whole, s->first[r], s->first[r + 1]);
        for (size_t i = 0; i < whole->leaves; i++) {
            if (ring[i] > rings)
                continue;
            assert_true(l < s->octree.leaves);
            assert_int_equal(s->leaf_number[l], i);
            assert_int_equal(l >= s->own_first && l < s->own_past, ring[i] == 0);
            for (int p = 0; p < TM_LEAF_NODES; p++) {
                const uint32_t v = s->octree.node[l][p];
                assert_int_equal(v == TM_NONE ? v : s->node_number[v], whole->node[i][p]);
            }
            l++;
        }
        assert_int_equal(l, s->octree.leaves);
        for (size_t n = 0; n < s->octree.nodes; n++)
            assert_memory_equal(s->octree.grid[n], whole->grid[s->node_number[n]],
                                sizeof *whole->grid);
    }
    for (unsigned r = 0; r < ranks; r++)
        for (unsigned q = 0; q < ranks; q++) {
            const tm_octree_share *s = &share[r], *o = &share[q];
            if (q == r)
                continue;
            assert_sent(s, o, &s->leaves_sent, s->leaf_number, o->leaf_number,
                        o->octree.leaves, s->first[r], s->first[r + 1]);
            assert_sent(s, o, &s->nodes_sent, s->node_number, o->node_number,
                        o->octree.nodes, s->first_node[r], s->first_node[r + 1]);
        }
    for (unsigned r = 0; r < ranks; r++)
        tm_octree_share_free(&share[r]);
    free(share);
    free(ring);
}

static void test_cut(void **state)
{
    (void)state;
    enum { SMALL = 8, LEAVES_MAX = 4000 };
    static const unsigned ranks[] = {1, 2, 3, 7};
    for (int i = 0; i < SMALL; i++) {
        tm_surface surface;
        tm_octree whole;
        make_random_surface(&surface);
        make_random_octree(&whole, &surface);
        for (size_t k = 0; whole.leaves < LEAVES_MAX && k < sizeof ranks / sizeof *ranks;
             k++)
            check_cut(&whole, ranks[k], 1 + random_below(RINGS));
        tm_octree_free(&whole);
        tm_surface_free(&surface);
    }
}

static void assert_same_list(const tm_share_list *a, const tm_share_list *b,
                             unsigned ranks)
{
    assert_memory_equal(a->start, b->start, (ranks + 1) * sizeof *a->start);
    assert_memory_equal(a->item, b->item, a->start[ranks] * sizeof *a->item);
}

static void assert_same_share(const tm_octree_share *a, const tm_octree_share *b)
{
    const tm_octree *o = &a->octree, *p = &b->octree;
    assert_memory_equal(o->low, p->low, sizeof o->low);
    assert_true(o->side == p->side);
    assert_memory_equal(o->roots, p->roots, sizeof o->roots);
    assert_int_equal(a->all_leaves, b->all_leaves);
    assert_int_equal(a->all_nodes, b->all_nodes);
    assert_memory_equal(a->first, b->first, (a->ranks + 1) * sizeof *a->first);
    assert_memory_equal(a->first_node, b->first_node, (a->ranks + 1) * sizeof *a->first);
    assert_int_equal(o->leaves, p->leaves);
    assert_int_equal(a->own_first, b->own_first);
    assert_int_equal(a->own_past, b->own_past);
    assert_memory_equal(a->leaf_number, b->leaf_number,
                        o->leaves * sizeof *a->leaf_number);
    for (size_t l = 0; l < o->leaves; l++) {
        assert_memory_equal(o->leaf[l].anchor, p->leaf[l].anchor, sizeof p->leaf->anchor);
        assert_int_equal(o->leaf[l].level, p->leaf[l].level);
        assert_int_equal(o->leaf[l].crossed, p->leaf[l].crossed);
    }
    assert_int_equal(o->nodes, p->nodes);
    assert_int_equal(a->own_node_first, b->own_node_first);
    assert_int_equal(a->own_node_past, b->own_node_past);
    assert_memory_equal(a->node_number, b->node_number,
                        o->nodes * sizeof *a->node_number);
    assert_memory_equal(o->node, p->node, o->leaves * sizeof *o->node);
    assert_memory_equal(o->grid, p->grid, o->nodes * sizeof *o->grid);
    assert_same_list(&a->leaves_sent, &b->leaves_sent, a->ranks);
    assert_same_list(&a->nodes_sent, &b->nodes_sent, a->ranks);
}

/* Values of ghosts are those of their ranks. */
static void check_fill(const tm_octree_share *s)
{
    tm_error error;
    uint32_t *leaf = calloc(s->octree.leaves + 1, sizeof *leaf);
    uint32_t *node = calloc(s->octree.nodes + 1, sizeof *node);
    memcpy(leaf + s->own_first, s->leaf_number + s->own_first,
           (s->own_past - s->own_first) * sizeof *leaf);
    memcpy(node + s->own_node_first, s->node_number + s->own_node_first,
           (s->own_node_past - s->own_node_first) * sizeof *node);
    assert_ok(tm_share_fill_leaves(s, leaf, sizeof *leaf, &error), &error);
    assert_ok(tm_share_fill_nodes(s, node, sizeof *node, &error), &error);
    assert_memory_equal(leaf, s->leaf_number, s->octree.leaves * sizeof *leaf);
    assert_memory_equal(node, s->node_number, s->octree.nodes * sizeof *node);
    free(leaf);
    free(node);
}

static void check_share(const tm_octree_share *share, const tm_octree *whole,
                        unsigned rings)
{
    tm_error error;
    tm_octree_share cut;
    assert_ok(
        tm_octree_share_cut(&cut, whole, tm_rank(), tm_ranks_count(), rings, &error),
        &error);
    assert_same_share(share, &cut);
    check_fill(share);
    tm_octree_share_free(&cut);
}

/* Levels of up to 5 at the surface, more in a box, less or more everywhere. */
static void choose_rules(tm_octree_rule rule[RULES], const tm_surface *surface)
{
    rule[0] = (tm_octree_rule){.kind = TM_RULE_SURFACE, .level = random_below(6)};
    rule[1] = (tm_octree_rule){.kind = TM_RULE_EVERYTHING, .level = random_below(4)};
    rule[2] = (tm_octree_rule){.kind = TM_RULE_BOX, .level = random_below(7)};
    for (int i = 0; i < 3; i++) {
        const double a = random_between(surface->low[i], surface->high[i]);
        rule[2].low[i] = a;
        rule[2].high[i] = random_between(a, surface->high[i]);
    }
}

static void split_some(tm_octree_share *share, tm_octree *whole,
                       const tm_surface *surface, unsigned rings)
{
    tm_error error;
    uint8_t *split = malloc(whole->leaves + 1);
    uint8_t *own = malloc(share->octree.leaves + 1);
    for (size_t l = 0; l < whole->leaves; l++)
        split[l] = random_below(SPLIT_EVERY) == 0;
    for (size_t l = 0; l < share->octree.leaves; l++)
        own[l] =
            l < share->own_first || l >= share->own_past || split[share->leaf_number[l]];
    assert_ok(tm_octree_refine(whole, surface, split, &error), &error);
    assert_ok(tm_octree_share_refine(share, surface, own, rings, &error), &error);
    free(split);
    free(own);
}

static void test_together(void **state)
{
    (void)state;
    for (int i = 0; i < SURFACES; i++) {
        tm_error error;
        tm_surface surface;
        tm_octree whole;
        tm_octree_share share;
        tm_octree_rule rule[RULES];
        const unsigned rings = 1 + random_below(RINGS);
        make_random_surface(&surface);
        choose_rules(rule, &surface);
        surface.threads = 1 + random_below(2);
        assert_ok(tm_octree_build(&whole, &surface, rule, RULES, &error), &error);
        assert_ok(tm_octree_share_build(&share, &surface, rule, RULES, rings, &error),
                  &error);
        check_share(&share, &whole, rings);
        for (unsigned times = random_below(3); times > 0; times--) {
            split_some(&share, &whole, &surface, rings);
            check_share(&share, &whole, rings);
        }
        tm_octree_share_free(&share);
        tm_octree_free(&whole);
        tm_surface_free(&surface);
    }
}

static void assert_same_interior(const tm_interior *here, const tm_interior *whole,
                                 const tm_octree_share *s)
{
    assert_int_equal(here->chosen != NULL, whole->chosen != NULL);
    assert_int_equal(here->count, whole->count);
    assert_int_equal(here->filled, whole->filled);
    assert_int_equal(here->removed, whole->removed);
    for (size_t l = 0; whole->chosen && l < s->octree.leaves; l++)
        assert_int_equal(here->chosen[l], whole->chosen[s->leaf_number[l]]);
    for (size_t n = 0; whole->chosen && n < s->octree.nodes; n++) {
        assert_int_equal(here->mask[n], whole->mask[s->node_number[n]]);
        assert_int_equal(here->used[n], whole->used[s->node_number[n]]);
    }
}

static void check_interior(const tm_octree_share *share, const tm_octree *octree,
                           const tm_surface *surface)
{
    tm_error error;
    tm_interior here, whole, enclosed_here, enclosed;
    assert_ok(tm_interior_choose(&whole, octree, surface, &error), &error);
    assert_ok(tm_interior_choose_on_ranks(&here, share, surface, &error), &error);
    assert_same_interior(&here, &whole, share);
    assert_ok(tm_interior_find_enclosed(&enclosed, &whole, octree, surface, &error),
              &error);
    assert_ok(
        tm_interior_find_enclosed_on_ranks(&enclosed_here, &here, share, surface, &error),
        &error);
    assert_same_interior(&enclosed_here, &enclosed, share);
    assert_same_interior(&here, &whole, share);
    tm_interior_free(&here);
    tm_interior_free(&whole);
    tm_interior_free(&enclosed_here);
    tm_interior_free(&enclosed);
}

/* Opposite corners of some leaves are joined. */
static void check_sets(const tm_octree_share *s, const tm_octree *whole)
{
    tm_error error;
    uint32_t *all = malloc((whole->nodes + 1) * sizeof *all);
    uint32_t *here = malloc((s->octree.nodes + 1) * sizeof *here);
    for (size_t n = 0; n < whole->nodes; n++)
        all[n] = (uint32_t)n;
    for (size_t n = 0; n < s->octree.nodes; n++)
        here[n] = (uint32_t)n;
    for (size_t l = 0; l < whole->leaves; l++) {
        const size_t at = l - s->first[s->rank] + s->own_first;
        const bool own = l >= s->first[s->rank] && l < s->first[s->rank + 1];
        if (random_below(3) > 0)
            continue;
        tm_set_unite(all, whole->node[l][0], whole->node[l][7]);
        if (own)
            tm_set_unite(here, s->octree.node[at][0], s->octree.node[at][7]);
    }
    assert_ok(tm_share_join_sets(s, here, &error), &error);
    for (size_t n = 0; n < s->octree.nodes; n++)
        assert_int_equal(here[n], tm_set_root(all, s->node_number[n]));
    free(all);
    free(here);
}

static void test_interior(void **state)
{
    (void)state;
    for (int i = 0; i < SURFACES; i++) {
        tm_error error;
        tm_surface surface;
        tm_octree whole;
        tm_octree_share share;
        tm_octree_rule rule[RULES];
        const unsigned rings = 1 + random_below(2);
        make_random_surface(&surface);
        choose_rules(rule, &surface);
        assert_ok(tm_octree_build(&whole, &surface, rule, RULES, &error), &error);
        assert_ok(tm_octree_share_build(&share, &surface, rule, RULES, rings, &error),
                  &error);
        check_interior(&share, &whole, &surface);
        check_sets(&share, &whole);
        tm_octree_share_free(&share);
        tm_octree_free(&whole);
        tm_surface_free(&surface);
    }
}

/* What one rank finds wrong all say. */
static void test_refused(void **state)
{
    (void)state;
    tm_error error;
    tm_surface surface;
    tm_octree_share share;
    make_random_surface(&surface);
    const tm_octree_rule rule = {.kind = TM_RULE_EVERYTHING,
                                 .level = TM_OCTREE_LEVEL_MAX + 1};
    assert_int_equal(tm_octree_share_build(&share, &surface, &rule, 1, 1, &error),
                     TM_ERROR_INPUT);
    assert_null(share.octree.leaf);
    tm_surface_free(&surface);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cut),
        cmocka_unit_test(test_together),
        cmocka_unit_test(test_interior),
        cmocka_unit_test(test_refused),
    };
    tm_error error;
    if (argc != 2 || tm_ranks_start(&error) != TM_OK ||
        tm_ranks_count() != strtoul(argv[1], NULL, 10))
        return EXIT_FAILURE;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
