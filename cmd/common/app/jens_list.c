/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "jens_list.h"

#include "../../../lib/base/array.h"
#include "../../../lib/base/parallel.h"
#include "../../../lib/element/aspect_ratio.h"
#include "../../../lib/element/jens.h"
#include "../../../lib/element/verdict.h"

#include <stdlib.h>

enum { CHUNK = 8192 }; /* elements that one thread lists at a time */

typedef struct listing {
    jens_list_kind kind;
    const tm_elements *elements;
    unsigned base;
    tm_text *chunk;
} listing;

static void value(tm_text *text, double number)
{
    tm_text_append(text, " ", 1);
    tm_text_double(text, number);
}

/* A node may be of several corners, as the apex of a pyramid: it has the least of them.
 */
static void list_nodes(tm_text *text, size_t nodes, const double (*xyz)[3],
                       const uint32_t *item)
{
    const tm_element_shape *shape = &tm_element_shapes[nodes];
    double jacobian[TM_ELEMENT_CORNERS], least[TM_ELEMENT_NODES];
    tm_scaled_jacobians(shape, xyz, item, jacobian);
    for (size_t v = 0; v < nodes; v++)
        least[v] = 1;
    for (size_t i = 0; i < shape->corners; i++) {
        const double jens = tm_jens_of(jacobian[i], shape->k[i]);
        double *node = &least[shape->corner[i][0]];
        *node = jens < *node ? jens : *node;
    }
    for (size_t v = 0; v < nodes; v++)
        value(text, least[v]);
}

static void list_chunk(void *context, size_t chunk)
{
    const listing *l = context;
    const tm_elements *elements = l->elements;
    const size_t first = chunk * CHUNK;
    const size_t end = elements->count - first < CHUNK ? elements->count : first + CHUNK;
    tm_text *text = &l->chunk[chunk];
    for (size_t e = first; e < end; e++) {
        size_t nodes;
        const uint32_t *item = tm_element_at(elements, e, &nodes);
        tm_text_integer(text, (int64_t)(e + l->base));
        switch (l->kind) {
        case JENS_LIST_ELEMENTS:
            value(text, tm_jens(nodes, elements->xyz, item));
            value(text, tm_least_scaled_jacobian(nodes, elements->xyz, item));
            break;
        case JENS_LIST_ASPECT:
            value(text, tm_aspect_ratio(nodes, elements->xyz, item));
            break;
        case JENS_LIST_NODES:
            list_nodes(text, nodes, elements->xyz, item);
            break;
        default:
            value(text, tm_verdict_scaled_jacobian(nodes, elements->xyz, item));
            value(text, tm_verdict_shape(nodes, elements->xyz, item));
        }
        tm_text_append(text, "\n", 1);
    }
}

tm_status jens_list(tm_text *text, jens_list_kind kind, const tm_elements *elements,
                    unsigned base, unsigned threads, tm_error *error)
{
    const size_t chunks = elements->count / CHUNK + (elements->count % CHUNK != 0);
    tm_text *chunk = calloc(chunks + 1, sizeof *chunk);
    if (!chunk)
        return tm_fail_memory(error);
    listing l = {kind, elements, base, chunk};
    tm_parallel(threads, chunks, list_chunk, &l);
    for (size_t i = 0; i < chunks; i++) {
        tm_text_append(text, chunk[i].byte, chunk[i].size);
        text->failed |= chunk[i].failed;
        tm_text_free(&chunk[i]);
    }
    free(chunk);
    return text->failed ? tm_fail_memory(error) : TM_OK;
}
