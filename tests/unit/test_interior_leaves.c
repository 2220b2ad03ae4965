/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From leaves to elements on the lattice, on random octrees: octant masks, the interior,
 * its interior boundary, and the elements there. */
#include "../../lib/examine/element_examine.h"
#include "../../lib/examine/mixed_volume.h"
#include "../../lib/octree/layer/octree_mesh_parts.h"
#include "../../lib/element/jens.h"
#include "octree_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { MASKS = 256, OCTANTS = 8, DIRECTIONS = 27, ROUNDS = 40 };

static void direction_of(int d, int direction[3])
{
    direction[0] = d % 3 - 1;
    direction[1] = d / 3 % 3 - 1;
    direction[2] = d / 9 - 1;
}

/* The twelve faces between two of the octants around a node: that between octant o and
 * the one beyond it along an axis; it is on the boundary of a mask where one is filled.
 */
static bool has_face(unsigned mask, unsigned o, int axis)
{
    return (mask >> o & 1) != (mask >> (o ^ 1u << axis) & 1);
}

/* The half axis h, 0 … 5, is an edge of four of these faces: of those that are across the
 * other two axes, on its side. Puts those on the boundary to face[] as 3 * o + axis. */
static unsigned faces_at_half_axis(unsigned mask, int h, int face[4])
{
    const int along = h / 2;
    unsigned count = 0;
    for (int k = 1; k <= 2; k++)
        for (unsigned side = 0; side < 2; side++) {
            const int axis = (along + k) % 3, other = (along + 3 - k) % 3;
            const unsigned o = (unsigned)(h % 2) << along | side << other;
            if (has_face(mask, o, axis))
                face[count++] = 3 * (int)o + axis;
        }
    return count;
}

/* Whether each half axis has two faces of the boundary or none, and one walk from face to
 * face over half axes comes by all. */
static bool is_one_fan(unsigned mask)
{
    int beside[3 * OCTANTS][2], links[3 * OCTANTS] = {0}, faces = 0, first = -1;
    for (int h = 0; h < 6; h++) {
        int face[4];
        const unsigned count = faces_at_half_axis(mask, h, face);
        if (count != 0 && count != 2)
            return false;
        for (unsigned i = 0; i < count; i++) {
            first = face[i];
            faces += links[face[i]] == 0;
            beside[face[i]][links[face[i]]++] = face[1 - i];
        }
    }
    if (faces == 0)
        return true;
    int walked = 1;
    for (int before = first, f = beside[first][0]; f != first; walked++) {
        const int next = beside[f][0] == before ? beside[f][1] : beside[f][0];
        before = f;
        f = next;
    }
    return walked == faces;
}

/* Whether a direction looks away from all faces of the boundary. */
static bool looks_away(unsigned mask, const int direction[3])
{
    for (unsigned o = 0; o < OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++)
            if (!(o >> axis & 1) && has_face(mask, o, axis)) {
                const int outward = mask >> o & 1 ? 1 : -1;
                if (outward * direction[axis] <= 0)
                    return false;
            }
    return true;
}

static void test_masks(void **state)
{
    (void)state;
    unsigned good = 0;
    for (unsigned mask = 0; mask < MASKS; mask++) {
        bool visible = false;
        int direction[3];
        for (int d = 0; d < DIRECTIONS && !visible; d++) {
            direction_of(d, direction);
            visible = looks_away(mask, direction);
        }
        assert_int_equal(tm_octant_mask_is_good((tm_octant_mask)mask),
                         visible && is_one_fan(mask));
        if (!tm_octant_mask_is_good((tm_octant_mask)mask))
            continue;
        good++;
        tm_octant_mask_outward((tm_octant_mask)mask, direction);
        assert_true(looks_away(mask, direction));
    }
    printf("%u good masks\n", good);
    assert_true(good > 2 && good < MASKS);
}

/* A place of a leaf is a corner of the octants of a cube of two by two by two that has
 * the leaf's cells in it. */
static void test_places(void **state)
{
    (void)state;
    for (int p = 0; p < TM_LEAF_NODES; p++)
        for (unsigned o = 0; o < OCTANTS; o++) {
            bool inside = true;
            for (int i = 0; i < 3; i++) {
                const int cell = tm_leaf_point[p][i] - 1 + (int)(o >> i & 1);
                inside &= cell >= 0 && cell < 2;
            }
            assert_int_equal(tm_point_octants[p] >> o & 1, inside);
        }
}

/* What the octree has in each cell of its finest level: whether it is of a chosen leaf.
 */
typedef struct {
    unsigned shift; /* a cell has so many bits of the grid's units */
    size_t cells[3];
    uint8_t *filled;
} cell_map;

static uint8_t *cell_at(const cell_map *map, const int64_t at[3])
{
    for (int i = 0; i < 3; i++)
        if (at[i] < 0 || at[i] >= (int64_t)map->cells[i])
            return NULL;
    return &map->filled[((size_t)at[2] * map->cells[1] + (size_t)at[1]) * map->cells[0] +
                        (size_t)at[0]];
}

static void fill_leaf(const cell_map *map, const tm_octree *octree, size_t l)
{
    const tm_leaf *leaf = &octree->leaf[l];
    const int64_t side = (int64_t)1 << (octree->finest - leaf->level - map->shift);
    int64_t low[3], at[3];
    for (int i = 0; i < 3; i++)
        low[i] = leaf->anchor[i] >> map->shift;
    for (at[2] = low[2]; at[2] < low[2] + side; at[2]++)
        for (at[1] = low[1]; at[1] < low[1] + side; at[1]++)
            for (at[0] = low[0]; at[0] < low[0] + side; at[0]++)
                *cell_at(map, at) = 1;
}

static cell_map map_cells(const tm_octree *octree, const tm_interior *interior)
{
    unsigned deepest = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        if (octree->leaf[l].level > deepest)
            deepest = octree->leaf[l].level;
    cell_map map = {.shift = octree->finest - deepest};
    for (int i = 0; i < 3; i++)
        map.cells[i] = (size_t)octree->roots[i] << deepest;
    map.filled = calloc(map.cells[0] * map.cells[1] * map.cells[2], 1);
    for (size_t l = 0; l < octree->leaves; l++)
        if (interior->chosen[l])
            fill_leaf(&map, octree, l);
    return map;
}

static void check_masks(const tm_octree *octree, const tm_interior *interior)
{
    const cell_map map = map_cells(octree, interior);
    for (size_t n = 0; n < octree->nodes; n++) {
        unsigned mask = 0;
        for (unsigned o = 0; o < OCTANTS; o++) {
            int64_t at[3];
            for (int i = 0; i < 3; i++)
                at[i] = (int64_t)(octree->grid[n][i] >> map.shift) - 1 + (o >> i & 1);
            const uint8_t *cell = cell_at(&map, at);
            mask |= (unsigned)(cell && *cell) << o;
        }
        assert_int_equal(interior->mask[n], mask);
        assert_true(tm_octant_mask_is_good(interior->mask[n]));
    }
    free(map.filled);
}

/* Those that are chosen are those with the centre inside, but for as many as it says. */
static void check_chosen(const tm_octree *octree, const tm_surface *surface,
                         const tm_interior *interior)
{
    size_t count = 0, filled = 0, removed = 0;
    for (size_t l = 0; l < octree->leaves; l++) {
        double centre[3];
        tm_leaf_centre(octree, &octree->leaf[l], centre);
        const bool inside = tm_surface_has_inside(surface, centre);
        count += interior->chosen[l];
        filled += interior->chosen[l] && !inside;
        removed += !interior->chosen[l] && inside;
        for (int c = 0; interior->chosen[l] && c < TM_LEAF_EDGE; c++)
            assert_true(interior->used[octree->node[l][c]]);
    }
    assert_int_equal(count, interior->count);
    assert_true(filled <= interior->filled);
    assert_true(removed <= interior->removed);
}

/* A directed edge of the interior boundary. */
typedef struct {
    uint32_t from, to;
    int turns; /* 1 where from < to, else -1: they sum up to 0 */
} skin_edge;

static int compare_edges(const void *a, const void *b)
{
    const skin_edge *e = a, *f = b;
    if (e->from != f->from)
        return e->from < f->from ? -1 : 1;
    return (e->to > f->to) - (e->to < f->to);
}

/* Every edge is in two faces, in opposite senses; returns the number of edges. */
static size_t check_closed(const tm_interior_boundary *boundary)
{
    size_t sides = 0;
    skin_edge *edge = malloc((4 * boundary->faces + 1) * sizeof *edge);
    for (size_t f = 0; f < boundary->faces; f++) {
        const unsigned k = tm_boundary_face_corners(boundary, f);
        for (unsigned i = 0; i < k; i++) {
            const uint32_t a = boundary->face[f][i], b = boundary->face[f][(i + 1) % k];
            assert_true(a < boundary->nodes && a != b);
            edge[sides++] = a < b ? (skin_edge){a, b, 1} : (skin_edge){b, a, -1};
        }
    }
    qsort(edge, sides, sizeof *edge, compare_edges);
    for (size_t i = 0; i < sides; i += 2) {
        assert_true(i + 1 < sides);
        assert_int_equal(compare_edges(&edge[i], &edge[i + 1]), 0);
        assert_int_equal(edge[i].turns + edge[i + 1].turns, 0);
        assert_true(i + 2 == sides || compare_edges(&edge[i], &edge[i + 2]) != 0);
    }
    free(edge);
    return sides / 2;
}

/* The corner of face f at node s. */
static unsigned corner_at(const tm_interior_boundary *boundary, size_t f, size_t s)
{
    for (unsigned i = 0; i < tm_boundary_face_corners(boundary, f); i++)
        if (boundary->face[f][i] == s)
            return i;
    fail_msg("face %zu is not at node %zu", f, s);
    return 0;
}

/* One walk around the node, from face to face, comes by all of them. */
static void check_fan(const tm_interior_boundary *boundary, size_t s)
{
    const uint32_t *around = boundary->around + boundary->around_start[s];
    const size_t count = boundary->around_start[s + 1] - boundary->around_start[s];
    size_t walked = 0, f = around[0];
    do {
        const unsigned k = tm_boundary_face_corners(boundary, f);
        const uint32_t before =
            boundary->face[f][(corner_at(boundary, f, s) + k - 1) % k];
        size_t next = 0;
        while (next < count) {
            const size_t g = around[next];
            const unsigned i = corner_at(boundary, g, s);
            if (boundary->face[g][(i + 1) % tm_boundary_face_corners(boundary, g)] ==
                before)
                break;
            next++;
        }
        assert_true(next < count);
        f = around[next];
        walked++;
    } while (f != around[0] && walked <= count);
    assert_int_equal(walked, count);
}

static void skin_point(const tm_octree *octree, const tm_interior_boundary *boundary,
                       uint32_t s, double xyz[3])
{
    tm_octree_point(octree, octree->grid[boundary->grid_node[s]], xyz);
}

/* The volume inside the interior boundary, whose faces are plane, seen from outside. */
static double skin_volume(const tm_octree *octree, const tm_interior_boundary *boundary)
{
    double sum = 0;
    for (size_t f = 0; f < boundary->faces; f++)
        for (unsigned i = 1; i + 1 < tm_boundary_face_corners(boundary, f); i++) {
            double a[3], b[3], c[3], normal[3];
            skin_point(octree, boundary, boundary->face[f][0], a);
            skin_point(octree, boundary, boundary->face[f][i], b);
            skin_point(octree, boundary, boundary->face[f][i + 1], c);
            tm_cross(normal, b, c);
            sum += tm_dot(a, normal);
        }
    return sum / 6;
}

static double leaf_volume(const tm_octree *octree, const tm_interior *interior)
{
    double sum = 0;
    for (size_t l = 0; l < octree->leaves; l++)
        if (interior->chosen[l])
            sum += pow(tm_leaf_side(octree, &octree->leaf[l]), 3);
    return sum;
}

static void check_skin(const tm_octree *octree, const tm_interior *interior,
                       const tm_interior_boundary *boundary)
{
    check_closed(boundary);
    for (size_t s = 0; s < boundary->nodes; s++) {
        assert_true(s == 0 || boundary->grid_node[s - 1] < boundary->grid_node[s]);
        assert_true(interior->used[boundary->grid_node[s]]);
        check_fan(boundary, s);
    }
    assert_int_equal(boundary->around_start[0], 0);
    for (size_t f = 0; f < boundary->faces; f++) {
        assert_true(interior->chosen[boundary->leaf[f]]);
        assert_int_equal(boundary->cut[f], TM_UNCUT);
        if (f > 0)
            assert_true(boundary->leaf[f - 1] < boundary->leaf[f] ||
                        (boundary->leaf[f - 1] == boundary->leaf[f] &&
                         boundary->piece[f - 1] < boundary->piece[f]));
    }
    const double volume = leaf_volume(octree, interior);
    assert_true(fabs(skin_volume(octree, boundary) - volume) <= 1e-9 * volume);
}

/* Cuts some quadrilaterals, as the paths of curves do. */
static void cut_some(tm_interior_boundary *boundary)
{
    const unsigned every = 1 + random_below(20);
    for (size_t f = 0; f < boundary->faces; f++)
        if (tm_boundary_face_corners(boundary, f) == 4 && random_below(every) == 0)
            boundary->cut[f] = random_below(2) ? TM_CUT_02 : TM_CUT_13;
}

/* On the lattice all elements are valid, fill the leaves, and fit together. */
static void check_elements(const tm_octree *octree, const tm_interior *interior,
                           const tm_interior_boundary *boundary, const tm_assembly *a)
{
    const tm_mixed_mesh *mesh = &a->mesh;
    tm_error error;
    double(*base)[3] = malloc(mesh->nodes * sizeof *base);
    assert_ok(tm_lattice_points(a, octree, interior, 1, boundary, base, &error), &error);
    const double volume = leaf_volume(octree, interior), clearly = 0.05;
    double sum = 0;
    assert_int_equal(a->first[0], 0);
    for (size_t l = 0; l < octree->leaves; l++) {
        assert_true(a->first[l + 1] >= a->first[l]);
        assert_int_equal(a->first[l + 1] > a->first[l], interior->chosen[l]);
    }
    assert_int_equal(a->first[octree->leaves], mesh->elements);
    for (size_t e = 0; e < mesh->elements; e++) {
        const size_t k = mesh->start[e + 1] - mesh->start[e];
        assert_true(tm_jens(k, (const double(*)[3])base, mesh->item + mesh->start[e]) >
                    clearly);
        sum += tm_mixed_volume((const double(*)[3])base, mesh->item + mesh->start[e], k);
    }
    assert_true(fabs(sum - volume) <= 1e-9 * volume);
    for (uint32_t s = 0; s < boundary->nodes; s++) {
        double at[3];
        skin_point(octree, boundary, s, at);
        assert_memory_equal(base[a->outer + s], at, sizeof at);
    }
    const tm_examination found = assert_elements_fit(mesh, (const double(*)[3])base);
    assert_int_equal(found.unused_nodes, 0);
    free(base);
}

static void test_random(void **state)
{
    (void)state;
    size_t elements = 0, filled = 0, removed = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const uint64_t seed = random_state;
        tm_surface surface;
        tm_octree octree;
        tm_interior interior;
        tm_interior_boundary boundary;
        tm_assembly assembly;
        tm_error error;
        make_random_surface(&surface);
        make_random_octree(&octree, &surface);
        printf("round %d (TM_SEED=%" PRIu64 "): %zu leaves\n", round, seed,
               octree.leaves);
        assert_ok(tm_interior_choose(&interior, &octree, &surface, &error), &error);
        check_chosen(&octree, &surface, &interior);
        check_masks(&octree, &interior);
        assert_ok(tm_interior_boundary_find(&boundary, &octree, &interior, &error),
                  &error);
        check_skin(&octree, &interior, &boundary);
        cut_some(&boundary);
        assert_ok(tm_assemble(&assembly, &octree, &interior, 1, &boundary, &error),
                  &error);
        check_elements(&octree, &interior, &boundary, &assembly);
        elements += assembly.mesh.elements;
        filled += interior.filled;
        removed += interior.removed;
        tm_assembly_free(&assembly);
        tm_interior_boundary_free(&boundary);
        tm_interior_free(&interior);
        tm_octree_free(&octree);
        tm_surface_free(&surface);
    }
    printf("%zu elements; %zu leaves filled, %zu removed\n", elements, filled, removed);
    assert_true(elements > 0 && filled > 0 && removed > 0);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_masks),
        cmocka_unit_test(test_places),
        cmocka_unit_test(test_random),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
