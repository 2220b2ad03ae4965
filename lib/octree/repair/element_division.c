/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "element_division.h"

#include "../../element/shape.h"
#include "../../optimise/optimise.h"
#include "../../element/jens.h"
#include "../../stream/stream.h"

#include <string.h>

/* A division as a mesh of its own: the element's nodes, then the middle. */
typedef struct {
    size_t k;
    double xyz[TM_ELEMENT_NODES + 1][3];
    size_t parts;
    size_t start[TM_DIVISION_PARTS + 1];
    uint32_t item[TM_DIVISION_ITEMS];
} small;

static void add_part(small *s, size_t corners, const uint8_t *face)
{
    size_t items = s->start[s->parts];
    for (size_t i = 0; i < corners; i++)
        s->item[items++] = face[corners - 1 - i]; /* as seen from the middle */
    s->item[items++] = (uint32_t)s->k;
    s->start[++s->parts] = items;
}

/* The parts, each quadrilateral uncut (0) or cut from its corner 0 or 1 (1, 2). */
static void add_parts(small *s, const uint8_t cut[TM_ELEMENT_FACES])
{
    const tm_element_shape *shape = &tm_element_shapes[s->k];
    s->parts = 0;
    s->start[0] = 0;
    for (size_t f = 0; f < shape->faces; f++) {
        const uint8_t *c = shape->face[f];
        if (cut[f] == 0) {
            add_part(s, tm_mixed_face_nodes(c), c);
            continue;
        }
        const size_t o = cut[f] - 1U;
        add_part(s, 3, (const uint8_t[]){c[o], c[o + 1], c[o + 2]});
        add_part(s, 3, (const uint8_t[]){c[o + 2], c[(o + 3) % 4], c[o]});
    }
}

/* The worst part, and how many are below the threshold. */
static double measure(const small *s, double threshold, size_t *low)
{
    double worst = 1;
    *low = 0;
    for (size_t e = 0; e < s->parts; e++) {
        const double jens = tm_jens(s->start[e + 1] - s->start[e],
                                    (const double(*)[3])s->xyz, s->item + s->start[e]);
        worst = jens < worst ? jens : worst;
        *low += jens < threshold;
    }
    return worst;
}

/* Moves the middle alone, from the mean of the corners. */
static tm_status place_middle(small *s, double threshold, tm_error *error)
{
    tm_node_rule rule[TM_ELEMENT_NODES + 1];
    for (size_t i = 0; i <= s->k; i++)
        rule[i] = (tm_node_rule){.where = TM_NONE,
                                 .freedom = i == s->k ? TM_MOVES_FREELY : TM_MOVES_NOT};
    for (int j = 0; j < 3; j++) {
        double sum = 0;
        for (size_t i = 0; i < s->k; i++)
            sum += s->xyz[i][j];
        s->xyz[s->k][j] = sum / (double)s->k;
    }
    tm_mixed_mesh mesh = {.nodes = s->k + 1,
                          .xyz = s->xyz,
                          .elements = s->parts,
                          .start = s->start,
                          .item = s->item};
    const tm_optimise_options options = {.threshold = threshold,
                                         .off_surface_threshold = threshold};
    tm_optimise_report report;
    return tm_mixed_optimise(&mesh, rule, NULL, &options, &report, error);
}

/* Tries one way to cut the faces; it becomes *parts if it is better. */
static tm_status try_cut(tm_division *parts, small *s,
                         const uint8_t cut[TM_ELEMENT_FACES], const uint32_t *node,
                         double threshold, tm_error *error)
{
    add_parts(s, cut);
    const tm_status status = place_middle(s, threshold, error);
    size_t low;
    const double worst = measure(s, threshold, &low);
    if (status != TM_OK || (parts->parts > 0 && worst <= parts->worst))
        return status;
    *parts = (tm_division){.parts = s->parts, .worst = worst, .low = low};
    memcpy(parts->start, s->start, sizeof parts->start);
    memcpy(parts->middle, s->xyz[s->k], sizeof parts->middle);
    for (size_t i = 0; i < s->start[s->parts]; i++)
        parts->item[i] = s->item[i] == s->k ? TM_NONE : node[s->item[i]];
    return TM_OK;
}

tm_status tm_division_find(tm_division *parts, const tm_mixed_mesh *mesh, size_t e,
                           unsigned open, double threshold, tm_error *error)
{
    const uint32_t *node = mesh->item + mesh->start[e];
    small s = {.k = mesh->start[e + 1] - mesh->start[e]};
    const tm_element_shape *shape = &tm_element_shapes[s.k];
    for (size_t i = 0; i < s.k; i++)
        memcpy(s.xyz[i], mesh->xyz[node[i]], sizeof s.xyz[i]);
    *parts = (tm_division){.parts = 0};
    uint8_t best[TM_ELEMENT_FACES] = {0};
    tm_status status = try_cut(parts, &s, best, node, threshold, error);
    for (size_t f = 0; f < shape->faces; f++) {
        if (!(open >> f & 1) || tm_mixed_face_nodes(shape->face[f]) == 3)
            continue;
        uint8_t cut[TM_ELEMENT_FACES];
        memcpy(cut, best, sizeof cut);
        for (uint8_t way = 1; way <= 2 && status == TM_OK; way++) {
            const double before = parts->worst;
            cut[f] = way;
            status = try_cut(parts, &s, cut, node, threshold, error);
            if (parts->worst > before)
                best[f] = way;
        }
    }
    return status;
}
