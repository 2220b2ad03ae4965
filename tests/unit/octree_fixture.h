/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random solids, and random octrees over them. */
#ifndef TESTS_UNIT_OCTREE_FIXTURE_H
#define TESTS_UNIT_OCTREE_FIXTURE_H

#include "../../lib/examine/element_examine.h"
#include "../../lib/mesh/mixed_mesh.h"
#include "../../lib/octree/forest/octree_build.h"
#include "random.h"
#include "surface_shapes.h"

static inline void assert_ok(tm_status status, const tm_error *error)
{
    if (status != TM_OK)
        fail_msg("%s", error->what);
}

/* The elements, with these coordinates, fit together and none is wrong. */
static inline tm_examination assert_elements_fit(const tm_mixed_mesh *mesh,
                                                 const double (*xyz)[3])
{
    tm_examination found;
    tm_error error;
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .xyz = xyz,
                               .elements = mesh->elements,
                               .start = mesh->start,
                               .item = mesh->item};
    assert_ok(tm_element_examine(&found, &view, 1, &error), &error);
    assert_true(tm_examination_is_good(&found));
    return found;
}

static inline double random_between(double low, double high)
{
    return low + (high - low) * random_unit();
}

/* Cubes of a block, each there or not: they touch in faces, edges and corners. */
static inline void add_random_cubes(tm_polygon_surface *p)
{
    enum { SIDE = 3, CUBES = SIDE * SIDE * SIDE };
    static const unsigned char ring[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    bool there[CUBES];
    for (int i = 0; i < CUBES; i++)
        there[i] = random_below(2);
    there[random_below(CUBES)] = true;
    for (int i = 0; i < CUBES; i++)
        for (int side = 0; side < 6; side++) {
            const int cube[3] = {i % SIDE, i / SIDE % SIDE, i / (SIDE * SIDE)};
            static const int step[3] = {1, SIDE, SIDE * SIDE};
            const int axis = side / 2, high = side % 2;
            const int next = cube[axis] + (high ? 1 : -1);
            if (!there[i] ||
                (next >= 0 && next < SIDE && there[i + (high ? 1 : -1) * step[axis]]))
                continue;
            uint32_t node[4];
            for (int c = 0; c < 4; c++) {
                const unsigned char *corner = ring[high ? c : 3 - c];
                int at[3] = {cube[0], cube[1], cube[2]};
                at[axis] += high;
                at[(axis + 1) % 3] += corner[0];
                at[(axis + 2) % 3] += corner[1];
                node[c] = add_node(p, at[0], at[1], at[2]);
            }
            add_polygon(p, node, 4);
        }
}

static inline void add_random_star(tm_polygon_surface *p)
{
    enum { MOST = 12 };
    double outline[MOST][2];
    const uint32_t k = 2 * (3 + random_below(MOST / 2 - 2));
    make_star(outline, k, 1, random_between(0.4, 1));
    if (random_below(2)) {
        add_prism(p, (const double(*)[2])outline, k, random_between(0.3, 2));
    } else {
        const double top = random_between(0.4, 2);
        add_bipyramid(p, (const double(*)[2])outline, k, top, -random_between(0.4, 2));
    }
}

/* A box with a hollow in it, and a ball beside it. */
static inline void add_random_bodies(tm_polygon_surface *p)
{
    const double low[3] = {0, 0, 0};
    const double width = random_between(1, 2), height = random_between(1, 2);
    const double high[3] = {1, width, height};
    const double hollow[3] = {0.5, 0.5, 0.5}, beside[3] = {1.7, 0.5, 0.5};
    add_box(p, low, high, false);
    if (random_below(2))
        add_sphere(p, hollow, random_between(0.2, 0.4), 4, true);
    if (random_below(2))
        add_sphere(p, beside, random_between(0.2, 0.6), 6, false);
}

/* A solid at an odd angle, or not. */
static inline void make_random_surface(tm_surface *surface)
{
    enum { KINDS = 5 };
    tm_error error;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    double centre[3];
    for (int i = 0; i < 3; i++)
        centre[i] = random_unit();
    switch (random_below(KINDS)) {
    case 0:
        add_random_cubes(&p);
        break;
    case 1:
        add_random_star(&p);
        break;
    case 2:
        add_random_bodies(&p);
        break;
    case 3:
        add_torus(&p, 1, random_between(0.3, 0.7), 16, 10);
        break;
    default:
        add_sphere(&p, centre, random_between(0.5, 2), 6, false);
        break;
    }
    if (random_below(4) > 0)
        turn_nodes(&p, random_between(0, 2));
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE,
                                        .unless_rough = true};
    assert_ok(tm_surface_build(surface, &p, &options, &error), &error);
    tm_polygon_surface_free(&p);
}

/* Levels of 2 to 4 at the surface, more in a box, and some leaves split once more. */
static inline void make_random_octree(tm_octree *octree, const tm_surface *surface)
{
    enum { RULES = 3, SPLIT_EVERY = 30 };
    tm_error error;
    tm_octree_rule rule[RULES] = {
        {.kind = TM_RULE_SURFACE}, {.kind = TM_RULE_EVERYTHING}, {.kind = TM_RULE_BOX}};
    rule[0].level = 2 + random_below(3);
    rule[1].level = random_below(4);
    rule[2].level = random_below(6);
    for (int i = 0; i < 3; i++) {
        const double a = random_between(surface->low[i], surface->high[i]);
        rule[2].low[i] = a;
        rule[2].high[i] = random_between(a, surface->high[i]);
    }
    assert_ok(tm_octree_build(octree, surface, rule, RULES, &error), &error);
    if (random_below(2)) {
        uint8_t *split = malloc(octree->leaves);
        for (size_t l = 0; l < octree->leaves; l++)
            split[l] = random_below(SPLIT_EVERY) == 0;
        assert_ok(tm_octree_refine(octree, surface, split, &error), &error);
        free(split);
    }
}

#endif
