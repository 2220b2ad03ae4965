/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The octants of .oct files as blocks of a stream. The lattice is found again from
 * rounded coordinates: nine digits in the files of the mesher. */
#include "oct.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COORDINATES = 3, OCTANT_NUMBERS = 6, ROOTS_MAX = 1 << 16 };

/* How far a coordinate may be off, of the largest one. */
static const double rounding = 2e-8;

/* And how far an octant's corner from its place, in its own sides. */
static const double slack = 0.05;

typedef struct giver {
    const tm_oct *oct;
    const char *name;
    double low[COORDINATES]; /* of the brick */
    double top[COORDINATES];
    double tolerance;
    double unit;      /* side of an octant of the finest level */
    unsigned finest;  /* the deepest level */
    size_t coarsest;  /* an octant of the lowest level */
    uint32_t *anchor; /* [octants][COORDINATES] */
    tm_error *error;
} giver;

static void bounds(const tm_oct *oct, size_t o, double low[COORDINATES],
                   double high[COORDINATES])
{
    for (int i = 0; i < COORDINATES; i++) {
        low[i] = DBL_MAX;
        high[i] = -DBL_MAX;
        for (int c = 0; c < TM_OCT_CORNERS; c++) {
            low[i] = fmin(low[i], oct->xyz[oct->corner[o][c]][i]);
            high[i] = fmax(high[i], oct->xyz[oct->corner[o][c]][i]);
        }
    }
}

static double side_of(const giver *g, size_t o)
{
    return g->unit * ldexp(1, (int)(g->finest - g->oct->level[o]));
}

/* Bounds of all octants, levels, and how exact coordinates are. */
static void find_extent(giver *g)
{
    const tm_oct *oct = g->oct;
    double most = 0;
    for (int i = 0; i < COORDINATES; i++) {
        g->low[i] = DBL_MAX;
        g->top[i] = -DBL_MAX;
    }
    for (size_t o = 0; o < oct->octants; o++) {
        double low[COORDINATES], high[COORDINATES];
        bounds(oct, o, low, high);
        for (int i = 0; i < COORDINATES; i++) {
            g->low[i] = fmin(g->low[i], low[i]);
            g->top[i] = fmax(g->top[i], high[i]);
            most = fmax(most, fmax(fabs(low[i]), fabs(high[i])));
        }
        if (oct->level[o] > g->finest)
            g->finest = oct->level[o];
        if (oct->level[o] < oct->level[g->coarsest])
            g->coarsest = o;
    }
    g->tolerance = rounding * most;
}

/* The unit first from an octant, then from the longest extent of them all. */
static tm_status find_unit(giver *g)
{
    double low[COORDINATES], high[COORDINATES], longest = 0;
    bounds(g->oct, g->coarsest, low, high);
    g->unit = ldexp(high[0] - low[0], -(int)(g->finest - g->oct->level[g->coarsest]));
    for (int i = 0; i < COORDINATES; i++)
        longest = fmax(longest, g->top[i] - g->low[i]);
    double units = round(longest / g->unit);
    if (!(units >= 1 && units < UINT32_MAX) || g->tolerance > longest / units / 4)
        return tm_fail_at(
            g->error, TM_ERROR_INPUT, g->name, 0, NULL,
            "the octants are too small for the digits of their coordinates, "
            "or have no size");
    g->unit = longest / units;
    for (size_t o = 0; o < g->oct->octants; o++) {
        double side = side_of(g, o);
        bounds(g->oct, o, low, high);
        for (int i = 0; i < COORDINATES; i++)
            if (fabs(high[i] - low[i] - side) > 2 * g->tolerance + slack * side)
                return tm_fail_at(g->error, TM_ERROR_INPUT, g->name, 0, NULL,
                                  "octant %zu is %g long, but octants of level %d are "
                                  "cubes of side %g",
                                  o, high[i] - low[i], g->oct->level[o], side);
    }
    return TM_OK;
}

/* Counts the octants in units from g->low. TM_NONE where all are at multiples of their
 * sides, or the first that is not. */
static size_t count_off(giver *g)
{
    for (size_t o = 0; o < g->oct->octants; o++) {
        double low[COORDINATES], high[COORDINATES], side = side_of(g, o);
        double units = ldexp(1, (int)(g->finest - g->oct->level[o]));
        bounds(g->oct, o, low, high);
        for (int i = 0; i < COORDINATES; i++) {
            double sides = (low[i] - g->low[i]) / side, whole = round(sides);
            if (fabs(sides - whole) > slack + g->tolerance / side || whole < 0 ||
                (whole + 1) * units >= UINT32_MAX)
                return o;
            g->anchor[COORDINATES * o + (size_t)i] = (uint32_t)(whole * units);
        }
    }
    return TM_NONE;
}

/* The brick begins at the lowest point, or at a multiple of the coarsest octant's side
 * from it. */
static tm_status find_anchors(giver *g)
{
    const tm_oct *oct = g->oct;
    double octants_low[COORDINATES], low[COORDINATES], high[COORDINATES];
    memcpy(octants_low, g->low, sizeof octants_low);
    for (size_t p = 0; p < oct->points; p++)
        for (int i = 0; i < COORDINATES; i++)
            g->low[i] = fmin(g->low[i], oct->xyz[p][i]);
    if (count_off(g) == TM_NONE)
        return TM_OK;
    double side = side_of(g, g->coarsest);
    bounds(oct, g->coarsest, low, high);
    for (int i = 0; i < COORDINATES; i++)
        g->low[i] =
            low[i] - side * ceil((low[i] - octants_low[i] - g->tolerance) / side - slack);
    size_t wrong = count_off(g);
    if (wrong == TM_NONE)
        return TM_OK;
    return tm_fail_at(g->error, TM_ERROR_INPUT, g->name, 0, NULL,
                      "octant %zu is not where a tree has octants of level %d", wrong,
                      oct->level[wrong]);
}

/* Blocks --------------------------------------------------------------------------- */

static tm_status add(giver *g, tm_stream *stream, const char *name, size_t count,
                     size_t items, tm_block **block)
{
    *block = tm_stream_add(stream, name);
    return *block ? tm_block_allocate(*block, count, items, g->error)
                  : tm_fail_memory(g->error);
}

static tm_status give_roots(giver *g, tm_stream *stream)
{
    const tm_oct *oct = g->oct;
    const uint64_t side = UINT64_C(1) << g->finest;
    size_t roots[COORDINATES] = {1, 1, 1};
    for (size_t o = 0; o < oct->octants; o++)
        for (size_t i = 0; i < COORDINATES; i++) {
            size_t past = g->anchor[COORDINATES * o + i] / side + 1;
            roots[i] = past > roots[i] ? past : roots[i];
        }
    if ((double)roots[0] * (double)roots[1] * (double)roots[2] > ROOTS_MAX)
        return tm_fail_at(g->error, TM_ERROR_INPUT, g->name, 0, NULL,
                          "the octants are in %zu x %zu x %zu cubes of level 0 (at most "
                          "%d)",
                          roots[0], roots[1], roots[2], ROOTS_MAX);
    const double size = g->unit * (double)side;
    for (int i = 0; i < COORDINATES; i++)
        if (!isfinite(g->low[i] + (double)roots[i] * size))
            return tm_fail_at(g->error, TM_ERROR_INPUT, g->name, 0, NULL,
                              "a cube of level 0 would be too large (1.8e308)");
    tm_block *root;
    const tm_status status =
        add(g, stream, ".root", roots[0] * roots[1] * roots[2], 0, &root);
    if (status != TM_OK)
        return status;
    double *real = root->real;
    for (size_t r = 0; r < root->count; r++) {
        const size_t at[COORDINATES] = {r % roots[0], r / roots[0] % roots[1],
                                        r / roots[0] / roots[1]};
        for (size_t i = 0; i < COORDINATES; i++)
            *real++ = g->low[i] + (double)at[i] * size;
        *real++ = size;
        root->integer[r] = g->finest;
    }
    return TM_OK;
}

/* Each id is there once. */
static tm_status give_ids(giver *g, tm_block *octant)
{
    uint32_t *ids;
    tm_error cause;
    for (size_t o = 0; o < octant->count; o++)
        octant->attribute[o] = g->oct->id[o];
    const tm_status status = tm_octant_ids(&ids, octant, 0, &cause);
    free(ids);
    return status == TM_OK
               ? TM_OK
               : tm_fail_at(g->error, status, g->name, 0, NULL, "%s", cause.what);
}

static tm_status give_octants(giver *g, tm_stream *stream, bool one_each)
{
    tm_block *octant = tm_stream_add(stream, ".octant");
    if (!octant)
        return tm_fail_memory(g->error);
    octant->attributes = g->oct->id ? 1 : 0;
    const tm_status status = tm_block_allocate(octant, g->oct->octants, 0, g->error);
    if (status != TM_OK)
        return status;
    uint32_t *row = octant->integer, element = 0;
    for (size_t o = 0; o < octant->count; o++, row += OCTANT_NUMBERS) {
        *row = g->oct->level[o];
        memcpy(row + 1, g->anchor + COORDINATES * o, COORDINATES * sizeof *row);
        row[OCTANT_NUMBERS - 2] = element;
        element += one_each ? 1 : g->oct->elements[o];
        row[OCTANT_NUMBERS - 1] = element;
    }
    return g->oct->id ? give_ids(g, octant) : TM_OK;
}

/* The octants as hexahedra, whose corners are in the order of .mix. */
static tm_status give_hexahedra(giver *g, tm_stream *stream)
{
    const tm_oct *oct = g->oct;
    stream->base = 0;
    tm_block *node;
    tm_status status = add(g, stream, ".node", oct->points, 0, &node);
    if (status != TM_OK)
        return status;
    if (oct->points > 0)
        memcpy(node->real, oct->xyz, oct->points * sizeof *oct->xyz);
    tm_block *mix;
    status = add(g, stream, ".mix", oct->octants, TM_OCT_CORNERS * oct->octants, &mix);
    if (status != TM_OK)
        return status;
    for (size_t o = 0; o <= oct->octants; o++)
        mix->start[o] = TM_OCT_CORNERS * o;
    memcpy(mix->item, oct->corner, oct->octants * sizeof *oct->corner);
    return TM_OK;
}

static tm_status check_elements(const giver *g, const tm_block *mix)
{
    uint64_t sum = 0;
    for (size_t o = 0; o < g->oct->octants; o++)
        sum += g->oct->elements[o];
    if (sum != mix->count)
        return tm_fail_at(g->error, TM_ERROR_INPUT, g->name, 0, NULL,
                          "has %llu elements in its octants, but the mesh has %zu",
                          (unsigned long long)sum, mix->count);
    return TM_OK;
}

tm_status tm_oct_to_stream(const tm_oct *oct, tm_stream *stream, const char *name,
                           tm_error *error)
{
    giver g = {.oct = oct, .name = name, .error = error};
    const tm_block *mix = tm_stream_find(stream, ".mix");
    const bool one_each = !mix;
    if (oct->octants == 0)
        return tm_fail_at(error, TM_ERROR_INPUT, name, 0, NULL, "has no octants");
    g.anchor = malloc(oct->octants * COORDINATES * sizeof *g.anchor);
    if (!g.anchor)
        return tm_fail_memory(error);
    tm_status status = mix ? check_elements(&g, mix) : TM_OK;
    find_extent(&g);
    if (status == TM_OK)
        status = find_unit(&g);
    if (status == TM_OK)
        status = find_anchors(&g);
    if (status == TM_OK && one_each)
        status = give_hexahedra(&g, stream);
    if (status == TM_OK)
        status = give_octants(&g, stream, one_each);
    if (status == TM_OK)
        status = give_roots(&g, stream);
    free(g.anchor);
    return status;
}
