/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "view_parts.h"

#include "../base/array.h"
#include "../base/parallel.h"
#include "../element/aspect_ratio.h"
#include "../element/jens.h"
#include "../element/tet_quality.h"
#include "../examine/poly/poly_statistics.h"
#include "../geom/vector.h"
#include "../stream/group.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Elements that one thread measures at a time. */
enum { CHUNK = 8192 };

typedef double measure_of(const double (*xyz)[3], const uint32_t *node, size_t k);

static double smallest_dihedral(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    double degrees[TM_TET_EDGES], least = HUGE_VAL;
    (void)k;
    tm_tet_dihedrals(xyz[node[0]], xyz[node[1]], xyz[node[2]], xyz[node[3]], degrees);
    for (size_t e = 0; e < TM_TET_EDGES; e++)
        least = fmin(least, degrees[e]);
    return least;
}

static double volume_quality(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    (void)k;
    return tm_tet_volume_quality(xyz[node[0]], xyz[node[1]], xyz[node[2]], xyz[node[3]]);
}

static double jens(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    return tm_jens(k, xyz, node);
}

static double aspect_ratio(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    return tm_aspect_ratio(k, xyz, node);
}

/* Of a triangle, in degrees. */
static double smallest_angle(const double (*xyz)[3], const uint32_t *node, size_t k)
{
    const double degrees = 57.29577951308232088;
    double least = HUGE_VAL;
    for (size_t i = 0; i < k; i++) {
        const double *p = xyz[node[i]];
        double u[3], v[3], normal[3];
        tm_subtract(u, xyz[node[(i + 1) % k]], p);
        tm_subtract(v, xyz[node[(i + 2) % k]], p);
        tm_cross(normal, u, v);
        least = fmin(least, atan2(tm_norm(normal), tm_dot(u, v)) * degrees);
    }
    return least;
}

typedef struct measure {
    const char *key, *label, *unit;
    measure_of *of;
} measure;

static const measure of_surfaces[] = {{"angle", "smallest angle", "°", smallest_angle}};
static const measure of_tetrahedra[] = {
    {"dihedral", "smallest dihedral angle", "°", smallest_dihedral},
    {"volume-quality", "volume quality", "", volume_quality},
    {"jens", "J_ENS", "", jens}};
static const measure of_mixed[] = {{"jens", "J_ENS", "", jens},
                                   {"aspect", "aspect ratio", "", aspect_ratio}};

/* By tm_content; the first one is that by which elements are bad. */
static const struct {
    const measure *measure;
    size_t count;
} measures[] = {[TM_CONTENT_SURFACE] = {of_surfaces, 1},
                [TM_CONTENT_TETRAHEDRA] = {of_tetrahedra, 3},
                [TM_CONTENT_MIXED] = {of_mixed, 2},
                [TM_CONTENT_POLYHEDRA] = {NULL, 0}};

typedef struct measuring {
    const view_source *source;
    measure_of *of;
    size_t count;
    uint32_t *bits; /* of the elements in the page; or NULL */
    double *value;  /* of all */
} measuring;

static void measure_chunk(void *context, size_t chunk)
{
    const measuring *m = context;
    const double(*xyz)[3] = (const double(*)[3])m->source->node->real;
    const size_t first = chunk * CHUNK;
    const size_t end = m->count - first < CHUNK ? m->count : first + CHUNK;
    for (size_t i = first, k; i < end; i++) {
        const size_t e = m->bits ? view_element(m->source, i) : i;
        const uint32_t *node = tm_row_nodes(m->source->cell, e, &k);
        const double value = m->of(xyz, node, k);
        if (m->bits)
            m->bits[i] = tm_view_float_rounded(value);
        else
            m->value[i] = value;
    }
}

static void run(const measuring *m, unsigned threads)
{
    tm_parallel(threads, (m->count + CHUNK - 1) / CHUNK, measure_chunk, (void *)m);
}

/* Volumes and kernels of all polyhedra, malloc'ed. */
static tm_status measure_polyhedra(const view_source *s, unsigned threads,
                                   double **volume, double **radius, tm_error *error)
{
    const tm_poly_arrays mesh = tm_poly_arrays_of(s->stream);
    *volume = tm_new(mesh.cells, sizeof **volume);
    *radius = tm_new(mesh.cells, sizeof **radius);
    tm_status status = *volume && *radius ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK)
        status = tm_poly_measure_each(*volume, *radius, &mesh, threads, error);
    if (status == TM_OK)
        return TM_OK;
    free(*volume);
    free(*radius);
    *volume = *radius = NULL;
    return status;
}

tm_status tm_view_quality(const view_source *s, unsigned threads, double **value,
                          tm_error *error)
{
    const tm_content content = s->content;
    *value = NULL;
    if (content == TM_CONTENT_POLYHEDRA) {
        double *volume = NULL;
        const tm_status status = measure_polyhedra(s, threads, &volume, value, error);
        free(volume);
        return status;
    }
    if (content < TM_CONTENT_TETRAHEDRA)
        return TM_OK;
    *value = tm_new(s->cell->count, sizeof **value);
    if (!*value)
        return tm_fail_memory(error);
    run(&(measuring){s, measures[content].measure->of, s->cell->count, NULL, *value},
        threads);
    return TM_OK;
}

/* Fields ----------------------------------------------------------------------------- */

typedef struct field {
    const char *key, *label, *unit;
    const char *of; /* "element", "node", "facet" */
    bool quality;   /* the less, the worse */
} field;

static void add_field(view_writer *w, const field *f, const uint32_t *bits, size_t count,
                      const char *type)
{
    tm_json_open(&w->json, NULL, '{');
    tm_json_string(&w->json, "key", f->key);
    tm_json_string(&w->json, "label", f->label);
    tm_json_string(&w->json, "unit", f->unit ? f->unit : "");
    tm_json_string(&w->json, "of", f->of);
    tm_json_bool(&w->json, "quality", f->quality);
    tm_view_numbers(w, "values", type, bits, count);
    tm_json_close(&w->json, '}');
}

static void add_measures(view_writer *w, const view_source *s, uint32_t *bits)
{
    if (s->content < TM_CONTENT_SURFACE)
        return;
    for (size_t i = 0; i < measures[s->content].count; i++) {
        const measure *m = &measures[s->content].measure[i];
        run(&(measuring){s, m->of, s->kept, bits, NULL}, w->threads);
        add_field(w, &(field){m->key, m->label, m->unit, "element", true}, bits, s->kept,
                  "f32");
    }
}

static void take_values(const view_source *s, const double *value, uint32_t *bits)
{
    for (size_t k = 0; k < s->kept; k++) {
        const double v = value[view_element(s, k)];
        bits[k] = tm_view_float_rounded(isfinite(v) ? v : 0);
    }
}

static tm_status add_polyhedra(view_writer *w, const view_source *s, uint32_t *bits,
                               tm_error *error)
{
    double *volume, *radius;
    if (s->content != TM_CONTENT_POLYHEDRA)
        return TM_OK;
    const tm_status status = measure_polyhedra(s, w->threads, &volume, &radius, error);
    if (status != TM_OK)
        return status;
    take_values(s, radius, bits);
    add_field(w, &(field){"kernel", "kernel ball / diameter", "", "element", true}, bits,
              s->kept, "f32");
    take_values(s, volume, bits);
    add_field(w, &(field){"volume", "volume", "", "element", false}, bits, s->kept,
              "f32");
    free(volume);
    free(radius);
    return TM_OK;
}

/* The level of the octant that each element is in, -1 of none. */
static void add_levels(view_writer *w, const view_source *s, uint32_t *bits)
{
    const tm_block *octant = tm_stream_find(s->stream, ".octant");
    enum { LEVEL = 0, BEGIN = 4, END = 5 };
    const size_t integers = tm_block_integers(TM_OCTANT), count = s->cell->count;
    if (!octant || octant->count == 0 || s->content != TM_CONTENT_MIXED)
        return;
    uint32_t *level = tm_new(count, sizeof *level);
    if (!level) {
        w->data->failed = true;
        return;
    }
    for (size_t e = 0; e < count; e++)
        level[e] = TM_NONE;
    for (size_t o = 0; o < octant->count; o++) {
        const uint32_t *row = octant->integer + integers * o;
        for (size_t e = row[BEGIN]; e < row[END] && level[e] == TM_NONE; e++)
            level[e] = row[LEVEL];
    }
    for (size_t k = 0; k < s->kept; k++)
        bits[k] = level[view_element(s, k)];
    add_field(w, &(field){"level", "octant level", "", "element", false}, bits, s->kept,
              "i32");
    free(level);
}

static void add_attributes(view_writer *w, const view_source *s, const tm_block *block,
                           uint32_t *bits)
{
    const bool nodes = block == s->node;
    const size_t region = nodes ? SIZE_MAX : tm_group_region_attribute(block);
    const size_t count = nodes ? block->count : s->kept;
    for (size_t a = 0; a < block->attributes && count > 0; a++) {
        char key[64], label[64];
        snprintf(key, sizeof key, "%s-%zu", nodes ? "node" : "attribute", a + 1);
        snprintf(label, sizeof label, "%sattribute %zu", nodes ? "node " : "", a + 1);
        const bool before = region != SIZE_MAX && a < region;
        const field f = {a == region ? "region"
                         : before    ? "tetrahedra"
                                     : key,
                         a == region ? "region"
                         : before    ? "tetrahedra"
                                     : label,
                         "", nodes ? "node" : "element", false};
        for (size_t k = 0; k < count; k++) {
            const size_t row = nodes ? k : view_element(s, k);
            bits[k] = tm_view_float(block->attribute[row * block->attributes + a]);
        }
        add_field(w, &f, bits, count, "f32");
    }
}

static void add_markers(view_writer *w, const view_source *s, uint32_t *bits)
{
    if (s->content == TM_CONTENT_SURFACE && s->cell->marker) {
        for (size_t k = 0; k < s->kept; k++)
            bits[k] = (uint32_t)s->cell->marker[k];
        add_field(w, &(field){"marker", "marker", "", "element", false}, bits, s->kept,
                  "i32");
    }
    if (!s->node->marker)
        return;
    for (size_t v = 0; v < s->node->count; v++)
        bits[v] = (uint32_t)s->node->marker[v];
    add_field(w, &(field){"node-marker", "node marker", "", "node", false}, bits,
              s->node->count, "i32");
}

tm_status tm_view_fields(view_writer *w, const view_source *s, tm_error *error)
{
    const size_t room = s->kept > s->node->count ? s->kept : s->node->count;
    uint32_t *bits = tm_new(room, sizeof *bits);
    if (!bits)
        return tm_fail_memory(error);
    tm_json_open(&w->json, "fields", '[');
    add_measures(w, s, bits);
    const tm_status status = add_polyhedra(w, s, bits, error);
    if (status == TM_OK) {
        add_levels(w, s, bits);
        if (s->content > TM_CONTENT_POINTS)
            add_attributes(w, s, s->cell, bits);
        add_attributes(w, s, s->node, bits);
        add_markers(w, s, bits);
    }
    tm_json_close(&w->json, ']');
    free(bits);
    return status;
}
