/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sharp edges that end freely: a lattice of them with spurs. */
#include "../../lib/surface/surface_loose.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

/* A lattice of SIDE x SIDE nodes, and two spurs of SPUR edges of unit length at its
 * middle and at a node beside it. */
enum {
    SIDE = 6,
    SPUR = 3,
    LATTICE_NODES = SIDE * SIDE,
    LATTICE_EDGES = 2 * SIDE * (SIDE - 1),
    NODES = LATTICE_NODES + 2 * SPUR,
    EDGES = LATTICE_EDGES + 2 * SPUR,
    MIDDLE = SIDE / 2 * (SIDE + 1)
};

typedef struct {
    double xyz[NODES][3];
    tm_sharp_edge edge[EDGES];
    size_t edges, start[NODES + 1];
    uint32_t at[2 * EDGES];
} lattice;

static void add_edge(lattice *l, uint32_t a, uint32_t b)
{
    l->edge[l->edges++] = (tm_sharp_edge){{a, b}, {0, 1}};
}

static void add_spur(lattice *l, uint32_t from, uint32_t node, double height)
{
    for (uint32_t k = 0; k < SPUR; k++) {
        const uint32_t v = node + k;
        l->xyz[v][0] = l->xyz[from][0];
        l->xyz[v][1] = l->xyz[from][1];
        l->xyz[v][2] = height * (k + 1);
        add_edge(l, k == 0 ? from : v - 1, v);
    }
}

static void make_lattice(lattice *l)
{
    *l = (lattice){.edges = 0};
    for (uint32_t v = 0; v < LATTICE_NODES; v++) {
        l->xyz[v][0] = v % SIDE;
        l->xyz[v][1] = v / SIDE;
        if (v % SIDE + 1 < SIDE)
            add_edge(l, v, v + 1);
        if (v + SIDE < LATTICE_NODES)
            add_edge(l, v, v + SIDE);
    }
    add_spur(l, MIDDLE, LATTICE_NODES, 1);
    add_spur(l, MIDDLE + 1, LATTICE_NODES + SPUR, -1);
    assert_int_equal(l->edges, EDGES);
    for (uint32_t v = 0, n = 0; v < NODES; v++) {
        l->start[v] = n;
        for (uint32_t e = 0; e < EDGES; e++)
            if (l->edge[e].node[0] == v || l->edge[e].node[1] == v)
                l->at[n++] = e;
        l->start[v + 1] = n;
    }
}

/* How many of the lattice's edges, and of the spurs', are dropped. */
static void find(const lattice *l, double least, size_t *of_lattice, size_t *of_spurs,
                 bool *rough)
{
    tm_error error;
    bool dropped[EDGES] = {false};
    const tm_surface surface = {.nodes = NODES, .xyz = (double(*)[3])l->xyz};
    const tm_sharp_network network = {&surface, EDGES, l->edge, l->start, l->at};
    *rough = false;
    *of_lattice = *of_spurs = 0;
    assert_int_equal(tm_surface_find_loose(&network, least, dropped, rough, &error),
                     TM_OK);
    for (size_t e = 0; e < EDGES; e++)
        *(e < LATTICE_EDGES ? of_lattice : of_spurs) += dropped[e];
}

static void test_spurs(void **state)
{
    (void)state;
    lattice l;
    size_t of_lattice, of_spurs;
    bool rough;
    make_lattice(&l);
    find(&l, SPUR, &of_lattice, &of_spurs, &rough); /* they are not shorter */
    assert_int_equal(of_lattice + of_spurs, 0);
    find(&l, SPUR + 0.5, &of_lattice, &of_spurs, &rough);
    assert_int_equal(of_lattice, 0);
    assert_int_equal(of_spurs, 2 * SPUR);
    assert_false(rough);
    l.edge[EDGES - 1].triangle[1] = TM_NONE; /* no angle made it sharp */
    find(&l, SPUR + 0.5, &of_lattice, &of_spurs, &rough);
    assert_int_equal(of_lattice, 0);
    assert_int_equal(of_spurs, SPUR);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_spurs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
