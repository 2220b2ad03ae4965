/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Searches in the tree of a surface against what looks at every triangle. */
#include "../../lib/geom/predicates.h"
#include "../../lib/surface/surface.h"
#include "../../lib/surface/surface_apart.h"
#include "../../lib/surface/surface_crossings.h"
#include "../../lib/surface/surface_seeds.h"
#include "random.h"
#include "surface_shapes.h"

#include <string.h>

enum { POINTS = 2000 };

static double between(double low, double high)
{
    return low + (high - low) * random_unit();
}

/* A torus, a box, a sphere of many triangles and a needle apart from each other, moved
 * far from the origin on odd runs. */
static void make_surface(tm_surface *surface, bool far, bool lenient)
{
    tm_error error = {0};
    tm_polygon_surface p;
    const double centre[3] = {0, 0, 4}, low[3] = {-1, -2, -7}, high[3] = {1, 0, -5};
    const double needle[4][2] = {{5, 0}, {5.001, 0}, {6, 1e-9}, {5.0005, 1e-7}};
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE,
                                        .lenient = lenient};
    tm_polygon_surface_init(&p);
    add_torus(&p, 3, 1, 48, 24);
    add_box(&p, low, high, false);
    add_sphere(&p, centre, 1.5, 12, false);
    add_prism(&p, needle, 4, 2);
    turn_nodes(&p, between(0, 3));
    for (size_t v = 0; v < p.nodes && far; v++)
        p.xyz[v][0] += 1e6;
    if (lenient) { /* a face of the box goes */
        p.item[p.start[48 * 24 + 3]] = p.item[p.start[48 * 24 + 3] + 1];
        p.item[p.start[48 * 24 + 3] + 2] = p.item[p.start[48 * 24 + 3] + 1];
    }
    if (tm_surface_build(surface, &p, &options, &error) != TM_OK ||
        tm_surface_check(surface, &error) != TM_OK)
        fail_msg("%s", error.what);
    tm_polygon_surface_free(&p);
}

static void random_point(const tm_surface *s, double p[3])
{
    for (int i = 0; i < 3; i++)
        p[i] = between(s->low[i] - 1, s->high[i] + 1);
}

/* Points near a random node. */
static void near_point(const tm_surface *s, double p[3])
{
    const double *q = s->xyz[random_below((unsigned)s->nodes)];
    for (int i = 0; i < 3; i++)
        p[i] = q[i] + between(-0.1, 0.1) * (double)random_below(2);
}

static double segment_distance(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], q[3];
    tm_subtract(ab, b, a);
    tm_subtract(ap, p, a);
    double s = fmin(fmax(tm_dot(ab, ap) / tm_norm2(ab), 0), 1);
    for (int i = 0; i < 3; i++)
        q[i] = a[i] + s * ab[i];
    return sqrt(tm_distance2(p, q));
}

/* To the plane where the foot is within, else to the edges. */
static double triangle_distance(const tm_surface *s, uint32_t t, const double p[3])
{
    const double *a = s->xyz[s->triangle[t][0]], *b = s->xyz[s->triangle[t][1]];
    const double *c = s->xyz[s->triangle[t][2]];
    double best = fmin(segment_distance(p, a, b),
                       fmin(segment_distance(p, b, c), segment_distance(p, c, a)));
    double normal[3], ap[3] = {0}, side[3], edge[3];
    const double *corner[4] = {a, b, c, a};
    tm_triangle_normal(normal, a, b, c);
    for (int i = 0; i < 3; i++) {
        tm_subtract(edge, corner[i + 1], corner[i]);
        tm_subtract(ap, p, corner[i]);
        tm_cross(side, edge, ap);
        if (tm_dot(side, normal) < 0)
            return best;
    }
    return fmin(best, fabs(tm_dot(normal, ap)) / tm_norm(normal));
}

static double brute_distance(const tm_surface *s, const double p[3], uint32_t patch)
{
    double best = HUGE_VAL;
    for (uint32_t t = 0; t < s->triangles; t++)
        if (patch == TM_NONE || s->patch[t] == patch)
            best = fmin(best, triangle_distance(s, t, p));
    return best;
}

static double brute_winding(const tm_surface *s, const double p[3])
{
    double sum = 0;
    for (size_t t = 0; t < s->triangles; t++) {
        double v[3][3], length[3], cross[3];
        for (int i = 0; i < 3; i++) {
            tm_subtract(v[i], s->xyz[s->triangle[t][i]], p);
            length[i] = tm_norm(v[i]);
        }
        tm_cross(cross, v[1], v[2]);
        sum += 2 *
               atan2(tm_dot(v[0], cross),
                     length[0] * length[1] * length[2] + tm_dot(v[0], v[1]) * length[2] +
                         tm_dot(v[1], v[2]) * length[0] + tm_dot(v[2], v[0]) * length[1]);
    }
    return sum / (4 * shapes_pi);
}

static void test_closest(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        tm_surface s;
        make_surface(&s, far, false);
        const double tolerance = far ? 1e-8 : 1e-12;
        tm_surface_point at = {.triangle = TM_NONE};
        for (int i = 0; i < POINTS; i++) {
            double p[3];
            (i % 2 ? random_point : near_point)(&s, p);
            uint32_t patch = i % 3 ? TM_NONE : random_below((unsigned)s.patches);
            if (i % 5 == 0)
                at.triangle = TM_NONE;
            tm_surface_closest(&s, p, patch, &at);
            double distance = brute_distance(&s, p, patch);
            assert_true(fabs(sqrt(at.distance2) - distance) <= tolerance);
            assert_true(fabs(sqrt(tm_distance2(p, at.xyz)) - distance) <= tolerance);
            assert_true(triangle_distance(&s, at.triangle, at.xyz) <= tolerance);
            assert_true(patch == TM_NONE || s.patch[at.triangle] == patch);
        }
        tm_surface_free(&s);
    }
}

static void test_closest_on_curve(void **state)
{
    (void)state;
    double xy[200][2];
    tm_error error = {0};
    tm_polygon_surface p;
    tm_surface s;
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    make_star(xy, 200, 1, 1);
    tm_polygon_surface_init(&p);
    add_prism(&p, (const double(*)[2])xy, 200, 1);
    add_cube(&p, 5, 5, 5, 1);
    assert_int_equal(tm_surface_build(&s, &p, &options, &error), TM_OK);
    tm_polygon_surface_free(&p);
    assert_int_equal(s.curves, 14);
    for (int i = 0; i < POINTS; i++) {
        double q[3], closest[3], best = HUGE_VAL;
        random_point(&s, q);
        uint32_t c = random_below((unsigned)s.curves);
        size_t segment, first = s.curve_start[c];
        tm_surface_closest_on_curve(&s, c, q, closest, &segment);
        for (size_t k = first; k + 1 < s.curve_start[c + 1]; k++)
            best = fmin(best, segment_distance(q, s.xyz[s.curve_node[k]],
                                               s.xyz[s.curve_node[k + 1]]));
        assert_true(fabs(sqrt(tm_distance2(q, closest)) - best) < 1e-12);
        assert_true(first + segment + 1 < s.curve_start[c + 1]);
        assert_true(segment_distance(closest, s.xyz[s.curve_node[first + segment]],
                                     s.xyz[s.curve_node[first + segment + 1]]) < 1e-12);
    }
    tm_surface_free(&s);
}

static void test_inside(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        tm_surface s;
        make_surface(&s, far, false);
        assert_false(s.by_winding);
        for (int i = 0; i < POINTS; i++) {
            double p[3];
            (i % 2 ? random_point : near_point)(&s, p);
            for (int k = 0; k < 3 && i % 4 == 0; k++) /* in line with some nodes */
                p[k] = random_below(2) ? s.xyz[random_below((unsigned)s.nodes)][k] : p[k];
            if (brute_distance(&s, p, TM_NONE) > (far ? 1e-6 : 1e-9))
                assert_int_equal(tm_surface_has_inside(&s, p),
                                 brute_winding(&s, p) > 0.5);
        }
        tm_surface_free(&s);
    }
}

static void test_winding(void **state)
{
    (void)state;
    tm_surface s;
    make_surface(&s, false, true);
    assert_true(s.by_winding && s.open_edges == 4);
    double sum = 0;
    for (int i = 0; i < POINTS; i++) {
        double p[3];
        random_point(&s, p);
        double wrong = fabs(tm_surface_winding_number(&s, p) - brute_winding(&s, p));
        assert_true(wrong < 0.2);
        sum += wrong;
    }
    assert_true(sum / POINTS < 0.01);
    tm_surface_free(&s);
}

/* What of a polygon is on one side of a plane through a coordinate (Sutherland and
 * Hodgman, 1974). */
static int clip(double (*polygon)[3], int k, int axis, double at, double sign)
{
    double kept[12][3];
    int count = 0;
    for (int i = 0; i < k; i++) {
        const double *a = polygon[i], *b = polygon[(i + 1) % k];
        double da = sign * (a[axis] - at), db = sign * (b[axis] - at);
        if (da >= 0)
            memcpy(kept[count++], a, sizeof kept[0]);
        if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
            for (int c = 0; c < 3; c++)
                kept[count][c] = a[c] + da / (da - db) * (b[c] - a[c]);
            kept[count++][axis] = at;
        }
    }
    memcpy(polygon, kept, (size_t)count * sizeof kept[0]);
    return count;
}

static bool brute_meets(const tm_surface *s, uint32_t t, const double low[3],
                        const double high[3])
{
    double polygon[12][3];
    int k = 3;
    for (int i = 0; i < 3; i++)
        memcpy(polygon[i], s->xyz[s->triangle[t][i]], sizeof polygon[i]);
    for (int axis = 0; axis < 3 && k > 0; axis++) {
        k = clip(polygon, k, axis, low[axis], 1);
        k = clip(polygon, k, axis, high[axis], -1);
    }
    return k > 0;
}

static void test_boxes(void **state)
{
    (void)state;
    tm_surface s;
    make_surface(&s, false, false);
    uint32_t *list = calloc(s.triangles, sizeof *list);
    size_t met = 0;
    assert_non_null(list);
    for (int i = 0; i < POINTS; i++) {
        double low[3], high[3], size = exp(between(-6, 1));
        (i % 2 ? random_point : near_point)(&s, low);
        for (int k = 0; k < 3; k++) {
            low[k] -= size * random_unit();
            high[k] = low[k] + size;
        }
        for (uint32_t t = 0; t < s.triangles; t++)
            list[t] = t;
        size_t count = tm_surface_cull(&s, list, s.triangles, low, high, list), next = 0;
        for (uint32_t t = 0; t < s.triangles; t++) {
            bool kept = next < count && list[next] == t;
            assert_int_equal(kept, brute_meets(&s, t, low, high));
            next += kept;
        }
        assert_int_equal(next, count);
        assert_int_equal(tm_surface_meets_box(&s, low, high), count > 0);
        met += count > 0;
    }
    assert_true(met > POINTS / 10 && met < POINTS - POINTS / 10);
    free(list);
    tm_surface_free(&s);
}

/* A box that only touches a face, an edge or a node meets it. */
static void test_touching_boxes(void **state)
{
    (void)state;
    tm_error error = {0};
    tm_polygon_surface p;
    tm_surface s;
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE};
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 3);
    assert_int_equal(tm_surface_build(&s, &p, &options, &error), TM_OK);
    tm_polygon_surface_free(&p);
    for (int i = 0; i < 343; i++) {
        const int column = i % 7, row = i / 7 % 7, layer = i / 49;
        const double low[3] = {column - 2, row - 2, layer - 2};
        const double high[3] = {low[0] + 1, low[1] + 1, low[2] + 1};
        bool apart = false, within = true;
        for (int k = 0; k < 3; k++) {
            apart |= high[k] < 0 || low[k] > 3;
            within &= low[k] > 0 && high[k] < 3;
        }
        assert_int_equal(tm_surface_meets_box(&s, low, high), !apart && !within);
    }
    tm_surface_free(&s);
}

/* Polygons between points of a small lattice: flat, folded, crossing, several at an edge.
 * With lenient only those are refused that have no triangle; searches find what there
 * is. */
static void test_soup(void **state)
{
    (void)state;
    const tm_surface_options options = {.feature_angle = TM_FEATURE_ANGLE,
                                        .lenient = true};
    size_t taken = 0;
    for (int round = 0; round < POINTS; round++) {
        tm_error error = {0};
        tm_polygon_surface p;
        tm_surface s;
        uint32_t node[6];
        tm_polygon_surface_init(&p);
        const unsigned nodes = 3 + random_below(12), side = 2 + random_below(3);
        for (unsigned v = 0; v < nodes; v++)
            add_node(&p, random_below(side), random_below(side), random_below(side));
        for (unsigned f = 1 + random_below(20); f > 0; f--) {
            const unsigned k = 3 + random_below(4);
            for (unsigned i = 0; i < k; i++)
                node[i] = random_below(nodes);
            add_polygon(&p, node, k);
        }
        if (tm_surface_build(&s, &p, &options, &error) == TM_OK) {
            taken++;
            if (tm_surface_check(&s, &error) != TM_OK)
                fail_msg("%s", error.what);
            tm_surface_point at = {.triangle = TM_NONE};
            const double q[3] = {random_unit(), random_unit(), random_unit()};
            tm_surface_closest(&s, q, TM_NONE, &at);
            assert_true(at.triangle < s.triangles);
            assert_true(isfinite(at.distance2));
            if (s.by_winding)
                assert_true(isfinite(tm_surface_winding_number(&s, q)));
        } else if (!strstr(error.what, "no triangle is left")) {
            fail_msg("%s", error.what);
        }
        tm_surface_free(&s);
        tm_polygon_surface_free(&p);
    }
    assert_true(taken > POINTS / 2);
}

/* Whether all have areas and no two meet, pair by pair. */
static bool are_apart(const double (*xyz)[3], const uint32_t (*triangle)[3], size_t count)
{
    for (size_t t = 0; t < count; t++)
        for (size_t k = 0; k < t; k++)
            if (tm_triangles_meet(xyz, triangle[k], triangle[t]))
                return false;
    return true;
}

/* Small triangles in a large box: about half of the soups are apart. */
static void test_apart(void **state)
{
    (void)state;
    enum { SOUPS = 400, MOST = 60 };
    size_t apart_count = 0;
    for (int soup = 0; soup < SOUPS; soup++) {
        const size_t count = random_below(MOST);
        const double size = 0.5 * random_unit() * random_unit();
        double xyz[3 * MOST][3] = {{0}};
        uint32_t triangle[MOST][3];
        for (size_t t = 0; t < count; t++) {
            const double at[3] = {random_unit(), random_unit(), random_unit()};
            for (uint32_t i = 0; i < 3; i++) {
                const uint32_t v = 3 * (uint32_t)t + i;
                triangle[t][i] = v > 3 && random_below(8) == 0 ? v - 3 : v;
                for (int x = 0; x < 3; x++)
                    xyz[v][x] = at[x] + size * random_unit();
            }
        }
        tm_error error;
        bool apart = false;
        assert_int_equal(tm_triangles_are_apart((const double(*)[3])xyz, 3 * count,
                                                (const uint32_t(*)[3])triangle, count,
                                                &apart, &error),
                         TM_OK);
        assert_int_equal(apart, are_apart((const double(*)[3])xyz,
                                          (const uint32_t(*)[3])triangle, count));
        apart_count += apart;
    }
    assert_in_range(apart_count, SOUPS / 8, SOUPS - SOUPS / 8);
    const double line[3][3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
    const uint32_t flat[1][3] = {{0, 1, 2}};
    bool apart = true;
    assert_int_equal(tm_triangles_are_apart(line, 3, flat, 1, &apart, NULL), TM_OK);
    assert_false(apart);
}

/* Boxes within boxes, beside others, turned any way: each seed is in its own box and in
 * none that this has in it. */
static void test_seeds(void **state)
{
    (void)state;
    const double side[4][2] = {{0, 10}, {1, 9}, {2, 4}, {5, 8}};
    const bool turned[4] = {false, true, false, true};
    const tm_surface_options options = {
        .feature_angle = TM_FEATURE_ANGLE, .regions = true, .walls = true};
    tm_polygon_surface p;
    tm_surface surface;
    tm_surface_seed seed[4];
    tm_error error = {0};
    tm_polygon_surface_init(&p);
    for (int b = 0; b < 4; b++) {
        const double low[3] = {side[b][0], side[b][0], side[b][0]};
        const double high[3] = {side[b][1], side[b][1], side[b][1]};
        add_box(&p, low, high, turned[b]);
    }
    assert_int_equal(tm_surface_build(&surface, &p, &options, &error), TM_OK);
    assert_int_equal(tm_surface_seeds(&surface), 4);
    assert_int_equal(tm_surface_find_seeds(&surface, &p, seed, &error), TM_OK);
    for (int b = 0; b < 4; b++) {
        assert_int_equal(seed[b].nested, b > 0);
        assert_int_equal(seed[b].inward, b > 0 && turned[b]);
        assert_true(seed[b].clearance > 0.1);
        for (int k = 0; k < 4; k++) {
            bool within = true;
            for (int x = 0; x < 3; x++)
                within = within && seed[b].point[x] > side[k][0] &&
                         seed[b].point[x] < side[k][1];
            assert_int_equal(within, k == b || k == 0 || (k == 1 && b > 1));
        }
    }
    tm_surface_free(&surface);
    tm_polygon_surface_free(&p);
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closest), cmocka_unit_test(test_closest_on_curve),
        cmocka_unit_test(test_inside),  cmocka_unit_test(test_winding),
        cmocka_unit_test(test_boxes),   cmocka_unit_test(test_touching_boxes),
        cmocka_unit_test(test_soup),    cmocka_unit_test(test_apart),
        cmocka_unit_test(test_seeds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
