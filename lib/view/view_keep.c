/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "view_parts.h"

#include "../base/array.h"
#include "../mesh/face_table.h"
#include "../mesh/poly_arrays.h"

#include <stdlib.h>

enum { WORST_PART = 100 };

/* outer[e] of all elements: bit i where half face i has no mate. */
static tm_status mark_elements(const view_source *s, uint8_t *outer, tm_error *error)
{
    const tm_mesh_view mesh = s->content == TM_CONTENT_MIXED
                                  ? tm_mesh_view_of_mixed(s->stream)
                                  : tm_mesh_view_of_tets(s->stream);
    uint32_t *mate = NULL;
    const tm_status status = tm_face_mates(&mate, &mesh, error);
    for (size_t e = 0, k; e < mesh.elements && status == TM_OK; e++) {
        tm_mesh_view_nodes(&mesh, e, &k);
        for (size_t i = 0; i < tm_element_shapes[k].faces; i++) {
            const uint32_t half = tm_half_face(&mesh, e, i);
            if (mate[half] == half || mate[half] == TM_NONE)
                outer[e] |= (uint8_t)(1u << i);
        }
    }
    free(mate);
    return status;
}

static void mark_polyhedra(const view_source *s, uint8_t *outer)
{
    const tm_poly_arrays mesh = tm_poly_arrays_of(s->stream);
    for (size_t f = 0; f < mesh.facets; f++)
        if (mesh.side[f][1] == TM_NONE && mesh.side[f][0] < mesh.cells)
            outer[mesh.side[f][0]] = 1;
}

/* keep[e] of the worst hundredth; of those that are equally bad the first. */
static tm_status mark_worst(const view_source *s, unsigned threads, bool *keep,
                            tm_error *error)
{
    const size_t count = s->cell->count;
    double *value = NULL, *sorted = tm_new(count, sizeof *sorted);
    tm_status status =
        sorted ? tm_view_quality(s, threads, &value, error) : tm_fail_memory(error);
    if (status == TM_OK) {
        for (size_t e = 0; e < count; e++)
            sorted[e] = value[e];
        qsort(sorted, count, sizeof *sorted, tm_compare_reals);
        const double limit = sorted[count / WORST_PART];
        size_t equal = count / WORST_PART;
        while (equal > 0 && sorted[equal - 1] == limit)
            equal--;
        equal = count / WORST_PART - equal;
        for (size_t e = 0; e < count; e++) {
            keep[e] = value[e] < limit || (value[e] == limit && equal > 0);
            equal -= keep[e] && value[e] == limit;
        }
    }
    free(sorted);
    free(value);
    return status;
}

/* Lists what is kept or has an outer face. */
static tm_status list(view_source *s, const bool *keep, const uint8_t *outer,
                      tm_error *error)
{
    const size_t count = s->cell->count;
    s->kept = 0;
    s->number = tm_new(count, sizeof *s->number);
    s->outer = tm_new(count, 1);
    if (!s->number || !s->outer)
        return tm_fail_memory(error);
    for (size_t e = 0; e < count; e++) {
        if (!keep[e] && outer[e] == 0)
            continue;
        s->outer[s->kept] = outer[e];
        s->number[s->kept++] = (uint32_t)e;
    }
    return TM_OK;
}

tm_status tm_view_keep(view_source *s, size_t most, unsigned threads, tm_error *error)
{
    const size_t count = s->cell->count;
    s->kept = count;
    if (count <= most || s->content < TM_CONTENT_TETRAHEDRA)
        return TM_OK;
    bool *keep = calloc(count, sizeof *keep);
    uint8_t *outer = calloc(count, 1);
    tm_status status = keep && outer ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK && s->content == TM_CONTENT_POLYHEDRA)
        mark_polyhedra(s, outer);
    else if (status == TM_OK)
        status = mark_elements(s, outer, error);
    if (status == TM_OK)
        status = mark_worst(s, threads, keep, error);
    if (status == TM_OK)
        status = list(s, keep, outer, error);
    free(keep);
    free(outer);
    return status;
}
