/* SPDX-License-Identifier: GPL-3.0-or-later */
/* shapes: prints the names of the shapes.
 * shapes NAME [N]: prints a closed surface of some thousand triangles as OFF; N is how
 *     fine it is: the cells of its grid along an axis.
 * Most are the surface of blocks of cells, with the nodes moved to where they belong;
 * some are where a function vanishes, the last ones a few polygons. None crosses itself.
 * The last four have walls between regions.
 */
#include "blocks.h"
#include "marching.h"
#include "solids.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Turns about the axes by odd angles, so that nothing is along an axis. */
static void tilt(double at[3])
{
    static const double angle[3] = {0.37, 0.23, 0.61};
    for (int i = 0; i < 3; i++) {
        double *y = &at[(i + 1) % 3], *z = &at[(i + 2) % 3];
        const double c = cos(angle[i]), s = sin(angle[i]), was = *y;
        *y = c * was - s * *z;
        *z = s * was + c * *z;
    }
}

static double between(double low, double high, double t)
{
    return low + (high - low) * t;
}

static void scale(double at[3], double x, double y, double z)
{
    at[0] *= x;
    at[1] *= y;
    at[2] *= z;
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* From the cube [0, 1]^3 to the ball: its surface is spread evenly. */
static void to_ball(double at[3])
{
    for (int i = 0; i < 3; i++)
        at[i] = tan(pi / 4 * (2 * at[i] - 1));
    const double length = length_of(at);
    scale(at, 1 / length, 1 / length, 1 / length);
}

/* Below: where a node of the grid, in [0, 1]^3, goes, and which cells there are. */

static void place_sphere(const grid *g, double at[3])
{
    (void)g;
    to_ball(at);
}

static void place_torus(const grid *g, double at[3])
{
    (void)g;
    const double turn = -2 * pi * at[0], small = 0.4;
    double y = 2 * at[1] - 1, z = 2 * at[2] - 1;
    const double large = fmax(fabs(y), fabs(z));
    y = tan(pi / 4 * y / large);
    z = tan(pi / 4 * z / large);
    const double length = sqrt(y * y + z * z);
    const double r = 1 + small * y / length;
    at[0] = r * cos(turn);
    at[1] = r * sin(turn);
    at[2] = small * z / length;
}

/* Narrow valleys along the lines on the sphere where a sum of waves vanishes. */
static void place_cortex(const grid *g, double at[3])
{
    (void)g;
    to_ball(at);
    const double pitch = 3.2, width = 0.5, depth = 0.32, swell = 0.05;
    const double x = pitch * at[0] + 0.5, y = pitch * at[1] + 1.1, z = pitch * at[2];
    const double wave = sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
    const double r = 1 - depth * exp(-(wave / width) * (wave / width)) +
                     swell * cos(1.9 * x) * cos(1.3 * z);
    scale(at, r, r, 0.8 * r);
}

/* The larger of two, rounded where they differ by less than a width. */
static double rounded_max(double a, double b, double width)
{
    const double h = fmax(0, 1 - fabs(a - b) / width);
    return fmax(a, b) + h * h * width / 4;
}

/* Cones from the ball of radius 1 to tips over the corners and sides of the cube. */
static void place_spikes(const grid *g, double at[3])
{
    (void)g;
    to_ball(at);
    const double slope = 0.35; /* tangent of half the angle of a tip */
    double r = 1;
    for (int corner = 0; corner < 27; corner++) {
        const int along[3] = {corner % 3 - 1, corner / 3 % 3 - 1, corner / 9 - 1};
        const int ones = abs(along[0]) + abs(along[1]) + abs(along[2]);
        if (ones % 2 == 0)
            continue;
        const double height = ones == 1 ? 2.2 : 1.8;
        double product = 0;
        for (int i = 0; i < 3; i++)
            product += at[i] * along[i];
        const double c = fmin(1, product / sqrt(ones));
        if (c > 0.5) /* where the ray is on the cone: r sin = slope (height - r cos) */
            r = rounded_max(r, slope * height / (sqrt(1 - c * c) + slope * c), 0.2);
    }
    scale(at, r, r, r);
}

static void place_plate(const grid *g, double at[3])
{
    (void)g;
    scale(at, 1, 1, 0.025);
}

static void place_sheets(const grid *g, double at[3])
{
    (void)g;
    const double angle = 0.3;
    scale(at, 1, 1, 0.12);
    const double x = at[0];
    at[0] = cos(angle) * x - sin(angle) * at[2];
    at[2] = sin(angle) * x + cos(angle) * at[2];
}

static unsigned has_sheets(const grid *g, const size_t cell[3])
{
    (void)g;
    return cell[2] != 1;
}

static void place_stairs(const grid *g, double at[3])
{
    (void)g;
    scale(at, 1, 0.6, 1);
}

static unsigned has_stairs(const grid *g, const size_t cell[3])
{
    const size_t steps = 6;
    return steps * cell[2] / g->cells[2] <= steps * cell[0] / g->cells[0];
}

static void place_turned(const grid *g, double at[3])
{
    (void)g;
    scale(at, 1, 0.7, 0.5);
}

enum { TEETH = 16, TOOTH = 8 }; /* so many cells along a tooth and its gap */

static void place_gear(const grid *g, double at[3])
{
    (void)g;
    static const double share[TOOTH] = {0, 0.13, 0.26, 0.4, 0.5, 0.63, 0.77, 0.9};
    const unsigned line = (unsigned)lround(at[0] * TEETH * TOOTH);
    const unsigned tooth = line / TOOTH;
    const double turn = -2 * pi * (tooth + share[line % TOOTH]) / TEETH;
    const double outer = line % TOOTH < TOOTH / 2 ? 1 : 0.84;
    const double r = between(0.35, outer, at[1]);
    at[2] = 0.5 * at[2];
    at[0] = r * cos(turn);
    at[1] = r * sin(turn);
}

/* A thin sheet along a curve of which the direction swings like a pendulum, by more than
 * a right angle, so that folds hang over; turned more and more along the other axis. */
static void place_folded(const grid *g, double at[3])
{
    const double swing = 1.85, folds = 3, thick = 0.012;
    const size_t fine = 64, at_line = (size_t)lround(at[0] * (double)g->cells[0]);
    const double step = 1 / (double)(g->cells[0] * fine);
    double x = 0, z = 0;
    for (size_t i = 0; i < at_line * fine; i++) {
        const double angle = swing * sin(2 * pi * folds * ((double)i + 0.5) * step);
        x += step * cos(angle);
        z += step * sin(angle);
    }
    const double angle = swing * sin(2 * pi * folds * at[0]);
    const double up = thick * (at[2] - 0.5);
    x += -up * sin(angle);
    z += up * cos(angle);
    const double twist = 0.8 * at[1];
    at[0] = cos(twist) * x - sin(twist) * z;
    at[2] = sin(twist) * x + cos(twist) * z;
    at[1] = 0.3 * at[1];
}

/* Below: regions that touch. */

/* A box, and a slanted plane through it. */
static void place_halved(const grid *g, double at[3])
{
    (void)g;
    const double slant = 0.3, bulge = fmin(at[0], 1 - at[0]);
    at[0] = 1.5 * at[0] + slant * bulge * (2 * at[2] - 1) - 0.5 * slant * bulge * at[1];
}

static unsigned halves(const grid *g, const size_t cell[3])
{
    return 2 * cell[0] < g->cells[0] ? 1 : 2;
}

static void place_as_it_is(const grid *g, double at[3])
{
    (void)g;
    (void)at;
}

/* A block of 3 by 3 by 3 but for the middle of a side. */
static unsigned blocks_but_one(const grid *g, const size_t cell[3])
{
    unsigned at[3];
    for (int i = 0; i < 3; i++)
        at[i] = (unsigned)(3 * cell[i] / g->cells[i]);
    return at[0] == 2 && at[1] == 1 && at[2] == 1 ? 0 : 1 + at[0] + 3 * at[1] + 9 * at[2];
}

static double largest_of(const double v[3])
{
    return fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
}

/* The cubes around the middle become balls. */
static void place_segments(const grid *g, double at[3])
{
    (void)g;
    const double centred[3] = {2 * at[0] - 1, 2 * at[1] - 1, 2 * at[2] - 1};
    const double r = largest_of(centred);
    for (int i = 0; i < 3; i++)
        at[i] = tan(pi / 4 * centred[i]);
    const double length = length_of(at);
    if (length > 0)
        scale(at, r / length, r / length, r / length);
}

/* A half of a ball in a box, its flat side in that of the box. */
static void place_inlay(const grid *g, double at[3])
{
    (void)g;
    at[0] = 2 * at[0] - 1;
    at[1] = 2 * at[1] - 1;
    const double size = largest_of(at), length = length_of(at);
    const double flat = size < 0.5 ? 0 : 2 * size - 1; /* 1: a cube as it was */
    const double factor = length > 0 ? flat + (1 - flat) * fmin(size, 0.5) / length : 1;
    scale(at, factor, factor, factor);
}

static unsigned inlay(const grid *g, const size_t cell[3])
{
    const double at[3] = {2 * ((double)cell[0] + 0.5) / (double)g->cells[0] - 1,
                          2 * ((double)cell[1] + 0.5) / (double)g->cells[1] - 1,
                          ((double)cell[2] + 0.5) / (double)g->cells[2]};
    return largest_of(at) < 0.5 ? 2 : 1;
}

/* Below: functions that are negative inside a shape. */

static double ball(const double at[3], double radius)
{
    return length_of(at) - radius;
}

/* One side of a gyroid, cut by a ball. */
static double gyroid(const double at[3])
{
    const double pitch = 5.2, level = 0.2, rounding = 0.3;
    const double x = pitch * at[0], y = pitch * at[1], z = pitch * at[2];
    const double wave = sin(x) * cos(y) + sin(y) * cos(z) + sin(z) * cos(x);
    return rounded_max((wave - level) / pitch, ball(at, 1), rounding);
}

/* The distance to the points within a radius of a line. */
static double capsule(const double at[3], const double from[3], const double to[3],
                      double radius)
{
    double along[3], v[3], product = 0, square = 0;
    for (int i = 0; i < 3; i++) {
        along[i] = to[i] - from[i];
        v[i] = at[i] - from[i];
        product += along[i] * v[i];
        square += along[i] * along[i];
    }
    const double t = fmin(1, fmax(0, product / square));
    for (int i = 0; i < 3; i++)
        v[i] -= t * along[i];
    return ball(v, radius);
}

/* A flat palm with five thin fingers close to each other. */
static double hand(const double at[3])
{
    static const double finger[5][2][3] = {{{-0.36, -0.1, 0.02}, {-0.45, 0.6, 0.1}},
                                           {{-0.12, 0, 0}, {-0.15, 0.9, 0.03}},
                                           {{0.12, 0, 0}, {0.14, 0.95, -0.02}},
                                           {{0.36, -0.1, 0}, {0.41, 0.75, 0.05}},
                                           {{0.3, -0.6, 0.05}, {0.85, -0.05, 0.25}}};
    double palm[3] = {at[0], at[1] + 0.4, at[2]};
    scale(palm, 1 / 0.5, 1 / 0.5, 1 / 0.16);
    double least = ball(palm, 1) * 0.16;
    for (int i = 0; i < 5; i++)
        least =
            -rounded_max(-least, -capsule(at, finger[i][0], finger[i][1], 0.075), 0.08);
    return least;
}

/* A shape of cells, which are `fine` along an axis where `cells` is 0 there; or of a
 * function, in the cube from -side / 2 to side / 2. */
typedef struct shape {
    const char *name;
    size_t fine;
    size_t cells[3];
    bool wrapped;
    place_function *place;
    region_function *region;
    shape_function *function;
    double side;
    bool tilted;
    void (*make)(surface *s); /* a solid that is what it is */
} shape;

static const shape shapes[] = {
    {.name = "sphere", .fine = 20, .place = place_sphere},
    {.name = "torus",
     .fine = 96,
     .cells = {0, 10, 10},
     .wrapped = true,
     .place = place_torus,
     .tilted = true},
    {.name = "gyroid", .fine = 22, .function = gyroid, .side = 2.1},
    {.name = "cortex", .fine = 44, .place = place_cortex},
    {.name = "plate",
     .fine = 40,
     .cells = {0, 0, 1},
     .place = place_plate,
     .tilted = true},
    {.name = "sheets",
     .fine = 30,
     .cells = {0, 0, 3},
     .place = place_sheets,
     .region = has_sheets},
    {.name = "spikes", .fine = 24, .place = place_spikes},
    {.name = "stairs", .fine = 18, .place = place_stairs, .region = has_stairs},
    {.name = "gear",
     .fine = 8,
     .cells = {(size_t)TEETH * TOOTH, 0, 0},
     .wrapped = true,
     .place = place_gear,
     .tilted = true},
    {.name = "turned", .fine = 16, .place = place_turned, .tilted = true},
    {.name = "hand", .fine = 40, .function = hand, .side = 2.4, .tilted = true},
    {.name = "folded", .fine = 96, .cells = {0, 20, 1}, .place = place_folded},
    {.name = "star", .make = make_star},
    {.name = "slit", .make = make_slit},
    {.name = "spike", .make = make_spike},
    {.name = "wedge", .make = make_wedge},
    {.name = "step", .make = make_step},
    {.name = "spool", .make = make_spool},
    {.name = "halved",
     .fine = 12,
     .place = place_halved,
     .region = halves,
     .tilted = true},
    {.name = "cells", .fine = 9, .place = place_as_it_is, .region = blocks_but_one},
    {.name = "segments",
     .fine = 24,
     .place = place_segments,
     .region = halves,
     .tilted = true},
    {.name = "inlay",
     .fine = 12,
     .cells = {24, 24, 0},
     .place = place_inlay,
     .region = inlay},
};
enum { SHAPES = sizeof shapes / sizeof shapes[0] };

static void make(const shape *is, size_t fine, surface *s)
{
    if (is->make != NULL) {
        is->make(s);
        return;
    }
    if (is->function != NULL) {
        make_marching(
            &(marching){
                .cells = fine, .low = -is->side / 2, .side = is->side, .surface = s},
            is->function);
        return;
    }
    blocks b = {.grid = {.wrapped = is->wrapped},
                .place = is->place,
                .region = is->region,
                .surface = s};
    for (int i = 0; i < 3; i++)
        b.grid.cells[i] = is->cells[i] > 0 ? is->cells[i] : fine;
    make_blocks(&b);
}

static void print(const surface *s)
{
    printf("OFF\n%zu %zu 0\n", s->nodes, s->triangles);
    for (size_t i = 0; i < s->nodes; i++)
        printf("%.17g %.17g %.17g\n", s->xyz[i][0], s->xyz[i][1], s->xyz[i][2]);
    for (size_t t = 0; t < s->triangles; t++)
        printf("3 %u %u %u\n", s->triangle[t][0], s->triangle[t][1], s->triangle[t][2]);
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        for (size_t i = 0; i < SHAPES; i++)
            puts(shapes[i].name);
        return EXIT_SUCCESS;
    }
    const shape *is = shapes;
    while (is < shapes + SHAPES && strcmp(is->name, argv[1]) != 0)
        is++;
    const size_t fine = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    if (is == shapes + SHAPES || argc > 3 || (argc == 3 && (fine < 1 || fine > 1000))) {
        fprintf(stderr, "usage: shapes [NAME [N]]\n");
        return 2;
    }
    surface s = {0};
    make(is, fine > 0 ? fine : is->fine, &s);
    for (size_t i = 0; is->tilted && i < s.nodes; i++)
        tilt(s.xyz[i]);
    print(&s);
    free(s.xyz);
    free(s.triangle);
    return fclose(stdout) == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
