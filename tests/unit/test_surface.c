/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is made of surfaces that are known: counts, inside, features, errors. */
#include "../../lib/surface/surface.h"
#include "../../lib/surface/measure/surface_curvature.h"
#include "../../lib/surface/surface_defects.h"
#include "random.h"
#include "surface_shapes.h"

#include <string.h>

static const tm_surface_options strict = {.feature_angle = TM_FEATURE_ANGLE};
static const tm_surface_options lenient = {.feature_angle = TM_FEATURE_ANGLE,
                                           .lenient = true};
static const double origin[3] = {0, 0, 0};

/* Builds, checks, and frees the polygons. */
static void build(tm_surface *surface, tm_polygon_surface *p,
                  const tm_surface_options *options)
{
    tm_error error = {0};
    if (tm_surface_build(surface, p, options, &error) != TM_OK)
        fail_msg("%s", error.what);
    if (tm_surface_check(surface, &error) != TM_OK)
        fail_msg("%s", error.what);
    tm_polygon_surface_free(p);
}

/* The build fails, and says `what`. */
static void refuse(tm_polygon_surface *p, const char *what)
{
    tm_error error = {0};
    tm_surface surface;
    assert_int_equal(tm_surface_build(&surface, p, &strict, &error), TM_ERROR_INPUT);
    if (!strstr(error.what, what))
        fail_msg("'%s' does not say '%s'", error.what, what);
    tm_surface_free(&surface);
}

static double volume(const tm_surface *surface)
{
    double sum = 0;
    for (size_t t = 0; t < surface->triangles; t++) {
        const uint32_t *v = surface->triangle[t];
        sum += tm_tet_volume(origin, surface->xyz[v[0]], surface->xyz[v[1]],
                             surface->xyz[v[2]]);
    }
    return sum;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.17g is not %.17g within %g", value, expected, tolerance);
}

static void assert_topology(const tm_surface *surface, size_t components, int64_t euler)
{
    assert_int_equal(surface->components, components);
    assert_int_equal(surface->euler, euler);
}

static void assert_features(const tm_surface *surface, size_t curves, size_t corners,
                            size_t patches)
{
    assert_int_equal(surface->curves, curves);
    assert_int_equal(surface->corners, corners);
    assert_int_equal(surface->patches, patches);
}

static bool has(const tm_surface *surface, double x, double y, double z)
{
    const double point[3] = {x, y, z};
    return tm_surface_has_inside(surface, point);
}

static void test_box(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        tm_polygon_surface p;
        tm_surface s;
        tm_polygon_surface_init(&p);
        const double low[3] = {1, 2, 3}, high[3] = {2, 4, 6};
        add_box(&p, low, high, false);
        if (turned)
            turn_nodes(&p, 0.6);
        build(&s, &p, &strict);
        assert_int_equal(s.nodes, 8);
        assert_int_equal(s.triangles, 12);
        assert_topology(&s, 1, 2);
        assert_features(&s, 12, 8, 6);
        assert_false(s.turned);
        assert_near(volume(&s), 6, 1e-13);
        for (size_t c = 0; c < s.curves; c++) {
            assert_int_equal(s.curve_start[c + 1] - s.curve_start[c], 2);
            assert_int_not_equal(s.curve_patch[c][0], s.curve_patch[c][1]);
        }
        tm_surface_free(&s);
    }
}

/* Every ray from a grid of the box's own coordinates runs through edges and nodes. */
static void test_inside_on_lattice(void **state)
{
    (void)state;
    for (int diagonal = 0; diagonal < 2; diagonal++) {
        tm_polygon_surface p;
        tm_surface s;
        tm_polygon_surface_init(&p);
        add_cube(&p, 0, 0, 0, 4);
        add_cube(&p, 1, 1, 1, 1);
        add_cube(&p, 2, 2, 2, 1);
        if (diagonal)
            for (size_t v = 0; v < 8; v++) /* the corner 4 4 4 moves out, 0 0 0 too */
                for (int i = 0; i < 3; i++)
                    p.xyz[v][i] += v == 7 ? 2 : v == 0 ? -2 : 0;
        build(&s, &p, &strict);
        assert_topology(&s, 3, 6);
        for (int i = 0; i < 13 * 13 * 13; i++) {
            const int column = i % 13, row = i / 13 % 13, layer = i / 169;
            const double x = column * 0.5 - 1, y = row * 0.5 - 1, z = layer * 0.5 - 1;
            const double least = fmin(x, fmin(y, z)), most = fmax(x, fmax(y, z));
            bool on = false, inside = least > 0 && most < 4;
            for (int hole = 1; hole <= 2; hole++) {
                const double far = fmax(most - hole - 1, hole - least);
                on |= far == 0;
                inside &= far > 0;
            }
            if (on || (least <= 0 && diagonal) || (most >= 4 && diagonal) || least == 0 ||
                most == 4)
                continue;
            assert_int_equal(has(&s, x, y, z), inside);
        }
        tm_surface_free(&s);
    }
}

static void test_inverted(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_sphere(&p, origin, 1, 8, true);
    size_t copies = p.nodes;
    build(&s, &p, &strict);
    assert_true(s.turned);
    assert_int_equal(s.triangles, 512);
    assert_int_equal(s.nodes, 258);
    assert_int_equal(s.welded, copies - 258);
    assert_topology(&s, 1, 2);
    assert_features(&s, 0, 0, 1);
    assert_near(volume(&s), 4.0 / 3 * shapes_pi, 0.15);
    tm_surface_free(&s);
}

/* Some triangles turned at random. */
static void test_disoriented(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_torus(&p, 3, 1, 24, 16);
    for (size_t f = 0; f < p.polygons; f++)
        if (random_below(2)) {
            uint32_t *v = p.item + p.start[f], swap = v[0];
            v[0] = v[2];
            v[2] = swap;
        }
    build(&s, &p, &strict);
    assert_topology(&s, 1, 0);
    assert_features(&s, 0, 0, 1);
    assert_near(volume(&s), 2 * shapes_pi * shapes_pi * 3, 3);
    for (int i = 0; i < 1000; i++) {
        const double x = 8 * random_unit() - 4, y = 8 * random_unit() - 4;
        const double z = 2 * random_unit() - 1;
        const double r = hypot(hypot(x, y) - 3, z);
        if (r < 0.9 || r > 1.05) /* chords are on both sides */
            assert_int_equal(has(&s, x, y, z), r < 1);
    }
    tm_surface_free(&s);
}

/* Three spheres, one in the other; all turn the same way in the file. */
static void test_nested(void **state)
{
    (void)state;
    for (int inward = 0; inward < 2; inward++) {
        tm_polygon_surface p;
        tm_surface s;
        tm_polygon_surface_init(&p);
        for (int r = 1; r <= 3; r++)
            add_sphere(&p, origin, r, 6, inward);
        build(&s, &p, &strict);
        assert_topology(&s, 3, 6);
        assert_true(s.turned);
        assert_true(has(&s, 0, 0.1, 0));
        assert_false(has(&s, 0, 1.4, 0.2));
        assert_true(has(&s, 0, 2.5, 0));
        const double shells = 4.0 / 3 * shapes_pi * (27 - 8 + 1);
        assert_near(volume(&s), shells, 0.1 * shells);
        assert_true(volume(&s) < shells);
        tm_surface_free(&s);
    }
}

static void test_open(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_sphere(&p, origin, 1, 8, false);
    p.facets -= 3;
    p.polygons -= 3;
    refuse(&p, "the surface is open: edges with one triangle: 5");
    build(&s, &p, &lenient);
    assert_int_equal(s.open_edges, 5);
    assert_true(s.by_winding);
    assert_int_equal(s.components, 1);
    assert_int_equal(s.euler, 1);
    assert_features(&s, 4, 4, 1); /* around the hole */
    for (int i = 0; i < 1000; i++) {
        double q[3], r = 0;
        for (int k = 0; k < 3; k++) {
            q[k] = 2 * random_unit() - 1;
            r += q[k] * q[k];
        }
        if (r < 0.8 || r > 1)
            assert_int_equal(tm_surface_has_inside(&s, q), r < 1);
    }
    tm_surface_free(&s);
}

static void test_crossing(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 2);
    add_cube(&p, 1, 1, 1, 2);
    refuse(&p, "two pieces of the surface cross: faces ");
    build(&s, &p, &lenient);
    assert_true(s.crossings > 0 && s.by_winding);
    assert_true(has(&s, 0.5, 0.5, 0.5) && has(&s, 1.5, 1.5, 1.5) &&
                has(&s, 2.5, 2.5, 2.5));
    assert_false(has(&s, 0.5, 2.5, 0.5));
    tm_surface_free(&s);

    /* One that crosses itself: a corner pulled through the opposite side. */
    tm_polygon_surface_init(&p);
    add_sphere(&p, origin, 1, 4, false);
    for (size_t v = 0; v < p.nodes; v++)
        if (p.xyz[v][2] == 1)
            p.xyz[v][2] = -3;
    refuse(&p, "the surface crosses itself: faces ");
    tm_polygon_surface_free(&p);

    /* One that touches itself in a node only: it stands on a face of the other. */
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 4);
    const double square[4][2] = {{2, 1}, {3, 2}, {2, 3}, {1, 2}};
    add_bipyramid(&p, square, 4, 1, -1);
    for (size_t v = 8; v < p.nodes; v++) {
        p.xyz[v][2] += 5;
        if (v < 10) {
            p.xyz[v][0] = 2;
            p.xyz[v][1] = 2;
        }
    }
    refuse(&p, "two pieces of the surface cross");
    tm_polygon_surface_free(&p);
}

static void test_duplicates(void **state)
{
    (void)state;
    const size_t copies = 100000;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    for (size_t i = 0; i < copies; i++) {
        const uint32_t node[4] = {0, 1, 2, 3};
        if (i == 0) {
            add_node(&p, 0, 0, 0);
            add_node(&p, 1, 0, 0);
            add_node(&p, 0, 1, 0);
            add_node(&p, 0, 0, 1);
        }
        for (int f = 0; f < 4; f++)
            add_triangle(&p, node[(f + 1) % 4], node[(f + 2) % 4], node[(f + 3) % 4]);
    }
    build(&s, &p, &strict);
    assert_int_equal(s.triangles, 4);
    assert_int_equal(s.duplicates, 4 * (copies - 1));
    assert_topology(&s, 1, 2);
    tm_surface_free(&s);
}

/* A node in the middle of an edge, which only one side has, and a triangle in between. */
static void test_flat(void **state)
{
    (void)state;
    for (int between = 0; between < 3; between++) {
        tm_polygon_surface p;
        tm_surface s;
        tm_polygon_surface_init(&p);
        const double xy[4][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
        add_bipyramid(&p, xy, 4, 1, -1);
        /* The first triangle is 2 3 0. */
        uint32_t m = add_node(&p, 1, 0, 0), far = add_node(&p, 9, 9, 9);
        add_triangle(&p, 2, m, 0);
        p.item[0] = m;
        if (between > 0)
            add_triangle(&p, 3, m, 2);
        if (between == 2) { /* and some that nobody needs */
            add_triangle(&p, 0, 0, far);
            uint32_t n = add_node(&p, 9, 9, 10), o = add_node(&p, 9, 9, 11);
            add_triangle(&p, far, n, o);
            add_triangle(&p, o, n, far);
        }
        if (between == 0) {
            refuse(&p, "the surface is open: edges with one triangle: 3");
            tm_polygon_surface_free(&p);
            continue;
        }
        build(&s, &p, &strict);
        assert_int_equal(s.nodes, 7);
        assert_int_equal(s.triangles, 10);
        assert_int_equal(s.flat, between == 1 ? 1 : 3);
        assert_int_equal(s.duplicates, between == 1 ? 0 : 1);
        assert_topology(&s, 1, 2);
        for (size_t t = 0; t < s.triangles; t++) {
            const uint32_t *v = s.triangle[t];
            assert_true(tm_triangle_area(s.xyz[v[0]], s.xyz[v[1]], s.xyz[v[2]]) > 0.1);
        }
        tm_surface_free(&s);
    }
}

/* Solids that touch in an edge, and in a node. */
static void test_touching(void **state)
{
    (void)state;
    for (int node = 0; node < 2; node++) {
        tm_polygon_surface p;
        tm_surface s;
        tm_polygon_surface_init(&p);
        add_cube(&p, 0, 0, 0, 1);
        add_cube(&p, 1, 1, node, 1);
        build(&s, &p, &strict);
        assert_int_equal(s.nodes, node ? 15 : 14);
        assert_topology(&s, 2, 4);
        assert_features(&s, node ? 24 : 23, node ? 15 : 14, 12);
        assert_near(volume(&s), 2, 1e-14);
        tm_surface_free(&s);
    }
}

/* Two cubes with a common side, that both have. */
static void test_not_manifold(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 1);
    add_cube(&p, 1, 0, 0, 1);
    refuse(&p, "the surface is not manifold: edges with one triangle: 0, with more than "
               "two that do not pair: 4");
    tm_polygon_surface_free(&p);
}

/* The projective plane of six nodes: half an icosahedron. */
static void test_one_sided(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    for (int i = 0; i < 6; i++)
        add_node(&p, random_unit(), random_unit(), random_unit());
    for (uint32_t i = 0; i < 5; i++) {
        add_triangle(&p, 5, i, (i + 1) % 5);
        add_triangle(&p, i, (i + 1) % 5, (i + 3) % 5);
    }
    refuse(&p, "the surface has one side only");
    tm_surface s;
    build(&s, &p, &lenient);
    assert_true(s.open_edges > 0);
    tm_surface_free(&s);
}

static void test_nothing(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_polygon_surface_init(&p);
    refuse(&p, "the surface is empty");
    for (int i = 0; i < 4; i++)
        add_node(&p, i, i, i);
    refuse(&p, "the surface is empty");
    add_triangle(&p, 0, 1, 1);
    refuse(&p, "no triangle is left");
    add_triangle(&p, 0, 1, 2);
    add_triangle(&p, 1, 3, 2);
    refuse(&p, "no triangle is left");
    p.xyz[3][1] = NAN;
    refuse(&p, "node 4 at (3, nan, 3): beyond 1e+45");
    p.xyz[3][1] = 2e45;
    refuse(&p, "node 4 at (3, 2e+45, 3): beyond 1e+45");
    tm_polygon_surface_free(&p);
}

static void test_polygons(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    /* A U with corners in its straight edges. */
    const double u[11][2] = {{0, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 2},
                             {2, 1}, {1, 1}, {1, 3}, {0, 3}, {0, 1}};
    add_prism(&p, u, 11, 1);
    build(&s, &p, &strict);
    assert_near(volume(&s), 7, 1e-13);
    assert_topology(&s, 1, 2);
    assert_features(&s, 24, 16, 10);
    assert_int_equal(s.triangles, 2 * 9 + 2 * 11);
    assert_true(has(&s, 0.5, 2.5, 0.5) && has(&s, 2.5, 2.5, 0.5));
    assert_false(has(&s, 1.5, 2.5, 0.5));
    tm_surface_free(&s);
}

static void test_curves(void **state)
{
    (void)state;
    double xy[64][2];
    const uint32_t k = 64;
    tm_polygon_surface p;
    tm_surface s;

    make_star(xy, k, 1, 1);
    tm_polygon_surface_init(&p);
    add_prism(&p, (const double(*)[2])xy, k, 3);
    build(&s, &p, &strict);
    assert_features(&s, 2, 0, 3);
    for (size_t c = 0; c < 2; c++) {
        assert_int_equal(s.curve_start[c + 1] - s.curve_start[c], k + 1);
        assert_int_equal(s.curve_node[s.curve_start[c]],
                         s.curve_node[s.curve_start[c + 1] - 1]);
        assert_near(s.curve_length[c], 2 * k * sin(shapes_pi / k), 1e-12);
    }
    tm_surface_free(&s);

    /* A cone: its tip is a corner without a curve. */
    tm_polygon_surface_init(&p);
    add_bipyramid(&p, (const double(*)[2])xy, k, 3, 0);
    build(&s, &p, &strict);
    assert_features(&s, 1, 1, 2);
    assert_near(s.xyz[s.corner[0]][2], 3, 0);
    tm_surface_free(&s);

    /* A flat one with four corners in its outline. */
    tm_polygon_surface_init(&p);
    const double square[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                 {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    add_bipyramid(&p, square, 8, 0.1, -0.1);
    build(&s, &p, &strict);
    assert_features(&s, 4, 4, 2);
    tm_surface_free(&s);

    /* An outline that goes to and fro by 50° at every node has none. */
    tm_polygon_surface_init(&p);
    make_star(xy, k, 1, 1.02);
    add_bipyramid(&p, (const double(*)[2])xy, k, 0.1, -0.1);
    build(&s, &p, &strict);
    assert_features(&s, 1, 0, 2);
    tm_surface_free(&s);
}

/* Triangles that are thinner than the digits of their coordinates make no features: a
 * long cylinder, turned, in 32 bits. */
static void test_needles(void **state)
{
    (void)state;
    double xy[250][2];
    const uint32_t k = 250;
    tm_polygon_surface p;
    tm_surface s;
    make_star(xy, k, 1, 1);
    tm_polygon_surface_init(&p);
    add_prism(&p, (const double(*)[2])xy, k, 10000);
    turn_nodes(&p, 0.7);
    for (size_t v = 0; v < p.nodes; v++)
        for (int i = 0; i < 3; i++)
            p.xyz[v][i] = (double)(float)p.xyz[v][i];
    build(&s, &p, &lenient);
    assert_features(&s, 2, 0, 3);
    tm_surface_free(&s);
}

/* The feature angle decides: the edges of a prism with eight sides turn by 45°. */
static void test_feature_angle(void **state)
{
    (void)state;
    for (int angle = 44; angle <= 46; angle += 2) {
        const tm_surface_options options = {.feature_angle = angle};
        double xy[8][2];
        tm_polygon_surface p;
        tm_surface s;
        make_star(xy, 8, 1, 1);
        tm_polygon_surface_init(&p);
        add_prism(&p, (const double(*)[2])xy, 8, 3);
        build(&s, &p, &options);
        if (angle < 45)
            assert_features(&s, 24, 16, 10);
        else
            assert_features(&s, 2, 0, 3);
        tm_surface_free(&s);
    }
}

static void test_markers(void **state)
{
    (void)state;
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_cube(&p, 0, 0, 0, 1);
    for (int32_t f = 0; f < 6; f++)
        p.facet_marker[f] = 10 + f;
    p.has_facet_markers = true;
    build(&s, &p, &strict);
    for (size_t t = 0; t < s.triangles; t++) {
        assert_int_equal(s.facet[t], t / 2);
        assert_int_equal(s.marker[t], 10 + t / 2);
    }
    tm_surface_free(&s);
}

/* A tube of 40 rings with flat ends; all rings but the first `smooth` are rough, so that
 * sharp edges there come singly. */
static void add_rough_tube(tm_polygon_surface *p, double x, unsigned smooth)
{
    enum { AROUND = 64, RINGS = 40 };
    const double step = 2 * shapes_pi / AROUND, roughness = 0.045;
    uint32_t ring[RINGS][AROUND];
    for (unsigned j = 0; j < RINGS; j++)
        for (unsigned i = 0; i < AROUND; i++) {
            const double r = j < smooth ? 1 : 1 + roughness * (2 * random_unit() - 1);
            ring[j][i] =
                add_node(p, x + r * cos(i * step), r * sin(i * step), (double)j * -step);
        }
    for (unsigned i = 0; i < AROUND; i++)
        for (unsigned j = 1; j < RINGS; j++) {
            const unsigned next = (i + 1) % AROUND;
            add_triangle(p, ring[j][i], ring[j][next], ring[j - 1][next]);
            add_triangle(p, ring[j][i], ring[j - 1][next], ring[j - 1][i]);
        }
    const uint32_t top = add_node(p, x, 0, 0);
    const uint32_t bottom = add_node(p, x, 0, (RINGS - 1) * -step - 0.5);
    for (unsigned i = 0; i < AROUND; i++) {
        add_triangle(p, top, ring[0][i], ring[0][(i + 1) % AROUND]);
        add_triangle(p, bottom, ring[RINGS - 1][(i + 1) % AROUND], ring[RINGS - 1][i]);
    }
}

/* What is rough: not the body beside it, nor a long edge of it with nothing rough around;
 * but all of it where the angle is to be taken as it is. */
static void test_rough(void **state)
{
    (void)state;
    const tm_surface_options unless_rough = {.feature_angle = TM_FEATURE_ANGLE,
                                             .unless_rough = true};
    for (int with_cube = 0; with_cube < 2; with_cube++)
        for (unsigned smooth = 1; smooth <= 8; smooth += 7)
            for (int all = 0; all < 2; all++) {
                tm_polygon_surface p;
                tm_surface s;
                tm_polygon_surface_init(&p);
                add_rough_tube(&p, 0, smooth);
                if (with_cube)
                    add_cube(&p, 2, 2, 0, 1);
                build(&s, &p, all ? &strict : &unless_rough);
                assert_int_equal(s.rough, !all);
                const size_t rim = smooth > 1, cube = with_cube ? 1 : 0;
                if (all)
                    assert_true(s.curves > 100);
                else
                    assert_features(&s, rim + 12 * cube, 8 * cube, 1 + rim + 6 * cube);
                tm_surface_free(&s);
            }
}

/* Bodies that cross are one: what a scan is made of. */
static void test_rough_crossing(void **state)
{
    (void)state;
    const tm_surface_options rough = {
        .feature_angle = TM_FEATURE_ANGLE, .unless_rough = true, .lenient = true};
    tm_polygon_surface p;
    tm_surface s;
    tm_polygon_surface_init(&p);
    add_rough_tube(&p, 0, 1);
    add_cube(&p, 0.5, 0, -2, 1);
    build(&s, &p, &rough);
    assert_true(s.crossings > 0 && s.rough);
    assert_features(&s, 0, 0, 2);
    tm_surface_free(&s);
}

/* The least and the largest curvature of the surface of polygons, which are freed. */
static void find_curvature(tm_polygon_surface *p, double range[2])
{
    tm_surface s;
    build(&s, p, &strict);
    double *curvature = malloc(s.triangles * sizeof *curvature);
    assert_non_null(curvature);
    tm_surface_find_curvature(&s, curvature);
    range[0] = range[1] = curvature[0];
    for (size_t t = 1; t < s.triangles; t++) {
        range[0] = fmin(range[0], curvature[t]);
        range[1] = fmax(range[1], curvature[t]);
    }
    free(curvature);
    tm_surface_free(&s);
}

static void test_curvature(void **state)
{
    (void)state;
    double xy[64][2], range[2];
    tm_polygon_surface p;
    /* Sharp edges count nothing. */
    tm_polygon_surface_init(&p);
    add_cube(&p, 1, 2, 3, 4);
    find_curvature(&p, range);
    assert_near(range[1], 0, 1e-12);
    /* A cylinder of radius 2, of long triangles, turned; its ends are flat. */
    make_star(xy, 64, 2, 2);
    tm_polygon_surface_init(&p);
    add_prism(&p, (const double(*)[2])xy, 64, 3);
    turn_nodes(&p, 0.4);
    find_curvature(&p, range);
    assert_near(range[0], 0, 1e-12);
    assert_near(range[1], 1.0 / 2, 0.001);
    const double centre[3] = {1, 1, 1};
    tm_polygon_surface_init(&p);
    add_sphere(&p, centre, 4, 24, false);
    find_curvature(&p, range);
    assert_true(range[0] > 0.7 / 4 && range[1] < 2.0 / 4);
}

static double between(double low, double high)
{
    return low + random_unit() * (high - low);
}

/* A square with holes above each other, which is slit open from a side to each, in turned
 * order; `own`: the slits have nodes of their own on each side. Returns its area. */
static double add_slit(tm_polygon_surface *p, unsigned holes, bool own, unsigned begin)
{
    uint32_t node[4 + 7 * 8], turned[4 + 7 * 8];
    size_t k = 0;
    double area = 1;
    node[k++] = add_node(p, 0, 0, 0);
    node[k++] = add_node(p, 1, 0, 0);
    node[k++] = add_node(p, 1, 1, 0);
    node[k++] = add_node(p, 0, 1, 0);
    for (unsigned h = 0; h < holes; h++) {
        const double step = 1.0 / holes, y = 1 - (h + 1) * step;
        const double low = y + between(0.1, 0.4) * step;
        const double high = y + between(0.6, 0.9) * step;
        const double left = between(0.1, 0.4), right = between(0.6, 0.9);
        const uint32_t rim = node[k++] = add_node(p, 0, low, 0);
        const uint32_t first = node[k++] = add_node(p, left, low, 0);
        node[k++] = add_node(p, left, high, 0);
        node[k++] = add_node(p, right, high, 0);
        node[k++] = add_node(p, right, low, 0);
        node[k++] = own ? add_node(p, left, low, 0) : first;
        node[k++] = own ? add_node(p, 0, low, 0) : rim;
        area -= (right - left) * (high - low);
    }
    for (size_t i = 0; i < k; i++)
        turned[i] = node[(i + begin) % k];
    add_polygon(p, turned, k);
    return area;
}

/* Of triangles that all look up. */
static double area_of(const double (*xyz)[3], const uint32_t *corner, size_t triangles)
{
    double sum = 0;
    for (size_t t = 0; t < triangles; t++, corner += 3) {
        const double *a = xyz[corner[0]], *b = xyz[corner[1]], *c = xyz[corner[2]];
        const double area =
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
        assert_true(area >= 0);
        sum += area;
    }
    return sum;
}

/* What other filters are given. */
static double area_of_faces(const tm_polygon_surface *p)
{
    tm_stream stream;
    tm_error error;
    tm_stream_init(&stream);
    assert_int_equal(tm_polygon_surface_to_stream(p, &stream, "", &error), TM_OK);
    const tm_block *face = tm_stream_find(&stream, ".face");
    const double area =
        area_of((const double(*)[3])p->xyz, face->integer + 3 * 12, face->count - 12);
    tm_stream_free(&stream);
    return area;
}

/* Slit polygons become triangles, and others stay as they are. */
static void test_slit(void **state)
{
    (void)state;
    for (unsigned round = 0; round < 200; round++) {
        const unsigned holes = 1 + round % 8;
        tm_polygon_surface p;
        tm_error error;
        size_t cut = 1;
        tm_polygon_surface_init(&p);
        add_cube(&p, 2, 2, 2, 1);
        assert_int_equal(tm_surface_cut_slit(&p, &cut, &error), TM_OK);
        assert_int_equal(cut, 0);
        p.has_facet_markers = true;
        p.next_marker = 7;
        const double area = add_slit(&p, holes, round % 3 == 0, random_below(60));
        assert_near(area_of_faces(&p), area, 1e-12);
        assert_int_equal(tm_surface_cut_slit(&p, &cut, &error), TM_OK);
        assert_int_equal(cut, 1);
        assert_int_equal(p.start[6], 24);
        assert_int_equal(p.corners, p.start[6] + 3 * (p.facets - 6));
        assert_int_equal(p.facet_marker[6], 7);
        assert_int_equal(p.facet_marker[p.facets - 1], 7);
        assert_near(area_of((const double(*)[3])p.xyz, p.item + p.start[6], p.facets - 6),
                    area, 1e-12);
        tm_polygon_surface_free(&p);
    }
}

int main(void)
{
    random_start();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_box),          cmocka_unit_test(test_inside_on_lattice),
        cmocka_unit_test(test_inverted),     cmocka_unit_test(test_disoriented),
        cmocka_unit_test(test_nested),       cmocka_unit_test(test_open),
        cmocka_unit_test(test_crossing),     cmocka_unit_test(test_duplicates),
        cmocka_unit_test(test_flat),         cmocka_unit_test(test_touching),
        cmocka_unit_test(test_not_manifold), cmocka_unit_test(test_one_sided),
        cmocka_unit_test(test_nothing),      cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_curves),       cmocka_unit_test(test_feature_angle),
        cmocka_unit_test(test_markers),      cmocka_unit_test(test_needles),
        cmocka_unit_test(test_rough),        cmocka_unit_test(test_rough_crossing),
        cmocka_unit_test(test_curvature),    cmocka_unit_test(test_slit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
