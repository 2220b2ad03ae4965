/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is around bad elements becomes a mesh of rank 0, which it repairs as it does a
 * whole one: where little is bad nothing else is looked at but how good the rest is. */
#include "repair_share.h"

#include "../../base/array.h"
#include "../../mesh/ranks/rows.h"
#include "../../ranks/post.h"
#include "../repair/repair_forced.h"
#include "../repair/repair_steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* So many rings of elements around what is bad are gathered first, and twice as many each
 * time that is not enough. */
enum { RINGS = 5, TRIES = 3 };

typedef struct {
    tm_repair_share *share;
    const tm_repair_options *options;
    bool *whole; /* [rows of .node]: all elements at a node that this rank has are near */
    bool *mark;  /* [mesh.nodes]: the same */
    bool *near;  /* [mesh.elements] */
    size_t cores; /* elements of all ranks that are to become better */
    tm_repair_rest rest;
    tm_repair_state part; /* on rank 0; others have nothing in it */
    uint32_t *number;     /* [part.mesh.nodes]: in the stream, ascending */
} mender;

/* Gives mark[] of all ranks what any has marked. */
static tm_status spread(const mender *m, tm_error *error)
{
    const tm_repair_share *s = m->share;
    const tm_rows rows = tm_rows_of(s->nodes);
    tm_post post = {0};
    uint32_t *got;
    size_t count;
    for (size_t n = 0; n < s->mesh.nodes; n++)
        if (m->mark[n])
            tm_post_put(&post, tm_rows_owner(&rows, s->number[n]), &s->number[n], 1);
    const tm_status status = tm_post_deliver(&post, &got, &count, error);
    for (size_t i = 0; status == TM_OK && i < count; i++)
        m->whole[got[i] - rows.first] = true;
    free(got);
    return status == TM_OK ? tm_slices_fetch(m->whole, s->nodes, sizeof *m->whole,
                                             s->number, s->mesh.nodes, m->mark, error)
                           : status;
}

/* Marks, in near[], what is to become better: bad elements, and those at nodes off the
 * surface. */
static tm_status find_cores(mender *m, tm_error *error)
{
    const tm_repair_share *s = m->share;
    const double aim = fmax(m->options->threshold, TM_REPAIR_GOOD);
    for (size_t v = 0; v < s->node->count; v++)
        m->whole[v] = s->rule[v].off_surface;
    const tm_status status = tm_slices_fetch(m->whole, s->nodes, sizeof *m->whole,
                                             s->number, s->mesh.nodes, m->mark, error);
    m->cores = 0;
    for (size_t e = 0; status == TM_OK && e < s->mesh.elements; e++) {
        m->near[e] = tm_mixed_has_marked(&m->share->mesh, e, m->mark) ||
                     tm_repair_is_bad(&s->mesh, e, tm_mixed_jens(&s->mesh, e), aim);
        m->cores += m->near[e];
    }
    tm_ranks_sum(&m->cores, 1);
    memset(m->whole, false, s->node->count);
    memset(m->mark, false, s->mesh.nodes);
    return status;
}

/* Marks so many rings around the cores, too. */
static tm_status find_near(const mender *m, unsigned rings, tm_error *error)
{
    const size_t elements = m->share->mesh.elements;
    tm_status status = TM_OK;
    for (unsigned r = 0; r < rings && status == TM_OK; r++) {
        for (size_t e = 0; e < elements; e++)
            if (m->near[e])
                tm_mixed_mark_nodes(&m->share->mesh, e, m->mark);
        status = spread(m, error);
        for (size_t e = 0; status == TM_OK && e < elements; e++)
            m->near[e] = tm_mixed_has_marked(&m->share->mesh, e, m->mark);
    }
    return status;
}

/* How good the rest is. */
static void measure_rest(mender *m)
{
    const tm_mixed_mesh *mesh = &m->share->mesh;
    m->rest = (tm_repair_rest){.worst = 1, .least = 1};
    for (size_t e = 0; e < mesh->elements; e++) {
        if (m->near[e])
            continue;
        const double jens = tm_mixed_jens(mesh, e);
        m->rest.worst = fmin(m->rest.worst, jens);
        m->rest.least = fmin(m->rest.least, tm_repair_quality(mesh, e, jens));
        m->rest.elements++;
    }
    tm_ranks_sum(&m->rest.elements, 1);
    tm_ranks_least(&m->rest.worst, 1);
    tm_ranks_least(&m->rest.least, 1);
}

/* Gives rank 0 the near elements: how many nodes each has, and these by their numbers. */
static tm_status gather_elements(const mender *m, uint8_t **length, size_t *elements,
                                 uint32_t **item, size_t *items, tm_error *error)
{
    const tm_repair_share *s = m->share;
    const tm_mixed_mesh *mesh = &s->mesh;
    size_t rows = 0, nodes = 0;
    uint8_t *own = tm_new(mesh->elements, sizeof *own);
    uint32_t *node = tm_new(mesh->start[mesh->elements], sizeof *node);
    tm_status status = tm_ranks_enough(own && node, error);
    for (size_t e = 0; status == TM_OK && e < mesh->elements; e++) {
        if (!m->near[e])
            continue;
        own[rows++] = (uint8_t)(mesh->start[e + 1] - mesh->start[e]);
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            node[nodes++] = s->number[mesh->item[i]];
    }
    if (status == TM_OK)
        status =
            tm_ranks_gather(own, rows, sizeof *own, (void **)length, elements, error);
    if (status == TM_OK)
        status = tm_ranks_gather(node, nodes, sizeof *node, (void **)item, items, error);
    free(own);
    free(node);
    return status;
}

/* The elements of rank 0's part, of their lengths. */
static tm_status fill_elements(tm_repair_state *part, const uint8_t *length,
                               tm_error *error)
{
    tm_mixed_mesh *mesh = &part->mesh;
    mesh->start = tm_new(mesh->elements + 1, sizeof *mesh->start);
    part->octant = tm_new(mesh->elements, sizeof *part->octant);
    part->origin = tm_new(mesh->elements, sizeof *part->origin);
    if (!mesh->start || !part->octant || !part->origin)
        return tm_fail_memory(error);
    mesh->start[0] = 0;
    for (size_t e = 0; e < mesh->elements; e++) {
        mesh->start[e + 1] = mesh->start[e] + length[e];
        part->octant[e] = TM_NONE;
        part->origin[e] = (uint32_t)e;
    }
    return TM_OK;
}

/* Gives rank 0 the nodes of its part, from those that have them; *end gets which of them
 * may have elements elsewhere. */
static tm_status gather_nodes(mender *m, bool **end, tm_error *error)
{
    const tm_repair_share *s = m->share;
    tm_repair_state *part = &m->part;
    const size_t nodes = part->mesh.nodes, total = s->nodes;
    part->mesh.xyz = tm_new(nodes, sizeof *part->mesh.xyz);
    part->rule = tm_new(nodes, sizeof *part->rule);
    part->on = tm_new(nodes, sizeof *part->on);
    *end = tm_new(nodes, sizeof **end);
    tm_status status =
        tm_ranks_enough(part->mesh.xyz && part->rule && part->on && *end, error);
    if (status == TM_OK)
        status = tm_slices_fetch(s->node->real, total, sizeof *part->mesh.xyz, m->number,
                                 nodes, part->mesh.xyz, error);
    if (status == TM_OK)
        status = tm_slices_fetch(s->rule, total, sizeof *part->rule, m->number, nodes,
                                 part->rule, error);
    if (status == TM_OK)
        status = tm_slices_fetch(s->on, total, sizeof *part->on, m->number, nodes,
                                 part->on, error);
    if (status == TM_OK)
        status = tm_slices_fetch(m->whole, total, sizeof *m->whole, m->number, nodes,
                                 *end, error);
    for (size_t n = 0; status == TM_OK && n < nodes; n++)
        (*end)[n] = !(*end)[n];
    return status;
}

/* What is near as a mesh of rank 0, in the order of the whole. */
static tm_status gather_part(mender *m, bool **end, tm_error *error)
{
    uint8_t *length = NULL;
    size_t elements = 0, items = 0;
    tm_repair_state *part = &m->part;
    *part = (tm_repair_state){.mesh.threads = m->share->mesh.threads, .rest = &m->rest};
    tm_status status =
        gather_elements(m, &length, &elements, &part->mesh.item, &items, error);
    if (status == TM_OK && tm_rank() == 0) {
        part->mesh.elements = elements;
        status = fill_elements(part, length, error);
        if (status == TM_OK)
            status = tm_slices_localize(part->mesh.item, items, &m->number,
                                        &part->mesh.nodes, error);
    }
    free(length);
    status = tm_ranks_agree(status, error);
    return status == TM_OK ? gather_nodes(m, end, error) : status;
}

static tm_status count_forced(const mender *m, size_t *forced, tm_error *error)
{
    bool *is = calloc(m->part.mesh.elements + 1, sizeof *is);
    const tm_status status =
        is ? tm_repair_find_forced(&m->part, m->options->threshold, is, forced, error)
           : tm_fail_memory(error);
    free(is);
    return status;
}

/* Rank 0 repairs its part. *can: nothing is bad then, and elements are what they were. */
static tm_status repair(mender *m, tm_surface *surface, size_t *forced, bool *can,
                        tm_error *error)
{
    tm_repair_report report = {0};
    tm_repair_options options = *m->options;
    options.visit = NULL;
    tm_status status = count_forced(m, forced, error);
    if (status == TM_OK)
        status = tm_repair(&m->part, surface, &options, &report, error);
    if (m->rest.reached || m->rest.whole)
        return TM_OK;
    *can = status == TM_OK && report.after.bad == 0 && report.after.off_surface == 0 &&
           !m->part.divided;
    return status;
}

/* Tries it with so many rings. */
static tm_status try_rings(mender *m, tm_surface *surface, unsigned rings, size_t *forced,
                           bool *can, tm_error *error)
{
    bool *end = NULL;
    tm_repair_state_free(&m->part);
    free(m->number);
    m->number = NULL;
    tm_status status = find_near(m, rings, error);
    if (status == TM_OK) {
        measure_rest(m);
        status = gather_part(m, &end, error);
    }
    m->rest.end = end;
    m->rest.nodes = m->part.mesh.nodes;
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_rank() == 0 ? repair(m, surface, forced, can, error) : TM_OK, error);
    free(end);
    m->rest.end = NULL;
    tm_ranks_broadcast(can, sizeof *can);
    tm_ranks_broadcast(forced, sizeof *forced);
    m->rest.reached = tm_ranks_any(m->rest.reached);
    return status;
}

/* A node on its way back. */
typedef struct {
    double xyz[3];
    uint32_t number;
} sent_node;

/* Gives the nodes of rank 0's part back to those that have them. */
static tm_status give_nodes(const mender *m, tm_error *error)
{
    const tm_rows rows = tm_rows_of(m->share->nodes);
    const size_t nodes = m->part.mesh.nodes;
    size_t *count = calloc(tm_ranks_count(), sizeof *count), all = 0;
    sent_node *list = tm_new(nodes, sizeof *list);
    void *got = NULL;
    tm_status status = tm_ranks_enough(count && list, error);
    for (size_t n = 0; status == TM_OK && n < nodes; n++) {
        list[n].number = m->number[n];
        memcpy(list[n].xyz, m->part.mesh.xyz[n], sizeof list[n].xyz);
        count[tm_rows_owner(&rows, m->number[n])]++;
    }
    if (status == TM_OK)
        status = tm_ranks_exchange(list, count, sizeof *list, &got, count, error);
    for (unsigned r = 0; status == TM_OK && r < tm_ranks_count(); r++)
        all += count[r];
    for (size_t i = 0; i < all; i++) {
        const sent_node *of = &((const sent_node *)got)[i];
        memcpy(m->share->node->real + 3 * (of->number - rows.first), of->xyz,
               sizeof of->xyz);
    }
    free(count);
    free(list);
    free(got);
    return status;
}

/* All nodes of the boundary are on it. */
static void set_places(const tm_repair_share *s)
{
    for (size_t v = 0; s->attributed && v < s->node->count; v++)
        s->node->attribute[v] = s->on[v];
}

static tm_status mend(mender *m, tm_surface *surface, size_t *forced, bool *can,
                      tm_error *error)
{
    const size_t elements = m->share->elements;
    tm_status status = find_cores(m, error);
    *can = false;
    if (status != TM_OK || m->cores >= elements / TM_REPAIR_PART_LESS)
        return status;
    m->rest.reached = true;
    for (unsigned t = 0, rings = RINGS; t < TRIES && status == TM_OK && m->rest.reached;
         t++, rings = 2 * rings)
        status = try_rings(m, surface, rings, forced, can, error);
    if (status == TM_OK && *can)
        status = give_nodes(m, error);
    return status;
}

tm_status tm_repair_share_mend(tm_repair_share *share, tm_surface *surface,
                               const tm_repair_options *options, size_t *forced,
                               bool *can, tm_error *error)
{
    mender m = {.share = share, .options = options};
    tm_status status = TM_OK;
    *can = true;
    *forced = 0;
    if (share->score.bad > 0 || share->score.off_surface > 0) {
        m.whole = tm_new(share->node->count, sizeof *m.whole);
        m.mark = tm_new(share->mesh.nodes, sizeof *m.mark);
        m.near = tm_new(share->mesh.elements, sizeof *m.near);
        status = tm_ranks_enough(m.whole && m.mark && m.near, error);
        if (status == TM_OK)
            status = mend(&m, surface, forced, can, error);
    }
    if (status == TM_OK && *can)
        set_places(share);
    tm_repair_state_free(&m.part);
    free(m.number);
    free(m.whole);
    free(m.mark);
    free(m.near);
    return status;
}
