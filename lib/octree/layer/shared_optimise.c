/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shared_optimise.h"

#include "../../base/array.h"
#include "../../base/parallel.h"
#include "../../element/jens.h"
#include "../../ranks/ranks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes of so many rings around bad elements may move (optimise.c), and all elements at
 * these are looked at. */
enum { RINGS = 2, MOST_NODES = 8 };

/* A node on its way. */
typedef struct {
    double xyz[3];
    tm_node_rule rule;
    uint32_t number;
} sent_node;

/* An element on its way. */
typedef struct {
    uint32_t number, nodes;
    uint32_t node[MOST_NODES]; /* by their numbers */
} sent_element;

typedef struct {
    tm_assembly *assembly;
    const tm_mesh_share *share;
    const tm_node_rule *rule;
    const tm_optimise_options *options;
    double *jens; /* [own elements] */
    bool *near;   /* [nodes]: within the rings */
    double worst; /* of own elements that stay as they are */
    size_t elements, nodes;
    sent_element *element;
    sent_node *node;
} sender;

static void measure_chunk(void *context, size_t first, size_t past)
{
    const sender *s = context;
    for (size_t e = first; e < past; e++)
        s->jens[e] = tm_mixed_jens(&s->assembly->mesh, s->share->elements.first + e);
}

static size_t own_elements(const sender *s)
{
    return s->share->elements.past - s->share->elements.first;
}

static bool is_near(const sender *s, size_t e)
{
    const tm_mixed_mesh *mesh = &s->assembly->mesh;
    bool near = false;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        near |= s->near[mesh->item[i]];
    return near;
}

/* Marks the nodes of own bad elements. */
static void mark_bad(const sender *s, bool *mark)
{
    const tm_mixed_mesh *mesh = &s->assembly->mesh;
    for (size_t e = 0; e < own_elements(s); e++) {
        const size_t at = s->share->elements.first + e;
        if (s->jens[e] < s->options->threshold)
            for (size_t i = mesh->start[at]; i < mesh->start[at + 1]; i++)
                mark[mesh->item[i]] = true;
    }
}

/* Marks the nodes of own elements that have one that is near. */
static void mark_next(const sender *s, bool *mark)
{
    const tm_mixed_mesh *mesh = &s->assembly->mesh;
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++)
        if (is_near(s, e))
            for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
                mark[mesh->item[i]] = true;
}

/* Marks what is near bad elements of any rank. */
static tm_status mark_near(sender *s, bool *mark, tm_error *error)
{
    const size_t nodes = s->assembly->mesh.nodes;
    mark_bad(s, s->near);
    tm_status status = tm_mesh_ghosts_mark(&s->share->ghosts, s->near, error);
    for (int ring = 0; ring < RINGS && status == TM_OK; ring++) {
        memcpy(mark, s->near, nodes);
        mark_next(s, mark);
        status = tm_mesh_ghosts_mark(&s->share->ghosts, mark, error);
        memcpy(s->near, mark, nodes);
    }
    return status;
}

static void enter_element(sender *s, size_t e, bool *has)
{
    const tm_mixed_mesh *mesh = &s->assembly->mesh;
    const tm_mesh_share *share = s->share;
    sent_element *to = &s->element[s->elements++];
    *to = (sent_element){
        .number = (uint32_t)(share->elements.number + e - share->elements.first),
        .nodes = (uint32_t)(mesh->start[e + 1] - mesh->start[e])};
    for (uint32_t i = 0; i < to->nodes; i++) {
        const uint32_t n = mesh->item[mesh->start[e] + i];
        to->node[i] = share->number[n];
        s->nodes += !has[n];
        has[n] = true;
    }
}

/* Lists the elements at near nodes, and their nodes. */
static bool list_near(sender *s, bool *has)
{
    const tm_mixed_mesh *mesh = &s->assembly->mesh;
    size_t count = 0;
    s->worst = 1;
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++)
        if (is_near(s, e))
            count++;
        else
            s->worst = fmin(s->worst, s->jens[e - s->share->elements.first]);
    s->element = tm_new(count, sizeof *s->element);
    if (!s->element)
        return false;
    memset(has, false, mesh->nodes);
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++)
        if (is_near(s, e))
            enter_element(s, e, has);
    s->node = tm_new(s->nodes, sizeof *s->node);
    if (!s->node)
        return false;
    s->nodes = 0;
    for (size_t n = 0; n < mesh->nodes; n++) {
        if (!has[n])
            continue;
        sent_node *to = &s->node[s->nodes++];
        *to = (sent_node){.rule = s->rule[n], .number = s->share->number[n]};
        memcpy(to->xyz, mesh->xyz[n], sizeof to->xyz);
    }
    return true;
}

/* What rank 0 has of all. */
typedef struct {
    tm_mixed_mesh mesh;
    tm_node_rule *rule;
    uint32_t *number;  /* [nodes] */
    uint32_t *element; /* [elements]: their numbers */
} received;

static int compare_nodes(const void *a, const void *b)
{
    const sent_node *m = a, *n = b;
    return (m->number > n->number) - (m->number < n->number);
}

static bool allocate(received *r, size_t elements, size_t nodes)
{
    r->mesh.xyz = tm_new(nodes, sizeof *r->mesh.xyz);
    r->mesh.start = tm_new(elements + 1, sizeof *r->mesh.start);
    r->mesh.item = tm_new(elements * MOST_NODES, sizeof *r->mesh.item);
    r->rule = tm_new(nodes, sizeof *r->rule);
    r->number = tm_new(nodes, sizeof *r->number);
    r->element = tm_new(elements, sizeof *r->element);
    return r->mesh.xyz && r->mesh.start && r->mesh.item && r->rule && r->number &&
           r->element;
}

static void take_nodes(received *r, sent_node *node, size_t count)
{
    if (count > 0)
        qsort(node, count, sizeof *node, compare_nodes);
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && node[i].number == node[i - 1].number)
            continue;
        const size_t n = r->mesh.nodes++;
        r->number[n] = node[i].number;
        r->rule[n] = node[i].rule;
        memcpy(r->mesh.xyz[n], node[i].xyz, sizeof node[i].xyz);
    }
}

static void take_elements(received *r, const sent_element *element, size_t count)
{
    size_t items = 0;
    for (size_t e = 0; e < count; e++) {
        r->element[e] = element[e].number;
        r->mesh.start[e] = items;
        for (uint32_t i = 0; i < element[e].nodes; i++)
            r->mesh.item[items++] = (uint32_t)tm_first_not_below(r->number, r->mesh.nodes,
                                                                 element[e].node[i]);
    }
    r->mesh.start[count] = items;
    r->mesh.elements = count;
}

/* Lists the nodes that are elsewhere than they were: sorted as in r. */
static size_t list_moved(const received *r, const sent_node *old, size_t count,
                         sent_node *moved)
{
    size_t n = 0, listed = 0;
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && old[i].number == old[i - 1].number)
            continue;
        if (memcmp(old[i].xyz, r->mesh.xyz[n], sizeof old[i].xyz) != 0) {
            moved[listed].number = r->number[n];
            memcpy(moved[listed++].xyz, r->mesh.xyz[n], sizeof old[i].xyz);
        }
        n++;
    }
    return listed;
}

/* On rank 0: mends all of it; *moved gets what is elsewhere then. */
static tm_status mend(const sender *s, const sent_element *element, size_t elements,
                      sent_node *node, size_t nodes, const tm_boundary *boundary,
                      sent_node **moved, size_t *listed, tm_optimise_report *report,
                      tm_error *error)
{
    received r = {.mesh.threads = s->assembly->mesh.threads};
    tm_optimise_options options = *s->options;
    tm_status status = TM_OK;
    *moved = tm_new(nodes, sizeof **moved);
    if (*moved && allocate(&r, elements, nodes)) {
        take_nodes(&r, node, nodes);
        take_elements(&r, element, elements);
        options.number = r.element;
        status = tm_mixed_optimise(&r.mesh, r.rule, boundary, &options, report, error);
        *listed = list_moved(&r, node, nodes, *moved);
    } else {
        status = tm_fail_memory(error);
    }
    free(r.mesh.xyz);
    free(r.mesh.start);
    free(r.mesh.item);
    free(r.rule);
    free(r.number);
    free(r.element);
    return status;
}

static void put_moved(const sender *s, const sent_node *moved, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t n = tm_mesh_share_node(s->share, s->assembly, moved[i].number);
        if (n != TM_NONE)
            memcpy(s->assembly->mesh.xyz[n], moved[i].xyz, sizeof moved[i].xyz);
    }
}

/* Sends what is near to rank 0, and takes what has moved. */
static tm_status send_and_take(const sender *s, const tm_boundary *boundary,
                               tm_optimise_report *report, tm_error *error)
{
    void *elements = NULL, *nodes = NULL, *got = NULL;
    size_t element_count, node_count, moved_count = 0;
    sent_node *moved = NULL;
    tm_status status = tm_ranks_gather(s->element, s->elements, sizeof *s->element,
                                       &elements, &element_count, error);
    if (status == TM_OK)
        status = tm_ranks_gather(s->node, s->nodes, sizeof *s->node, &nodes, &node_count,
                                 error);
    if (status == TM_OK && tm_rank() == 0)
        status = mend(s, elements, element_count, nodes, node_count, boundary, &moved,
                      &moved_count, report, error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status =
            tm_ranks_share(moved, moved_count, sizeof *moved, &got, &moved_count, error);
    if (status == TM_OK)
        put_moved(s, got, moved_count);
    tm_ranks_broadcast(report, sizeof *report);
    free(elements);
    free(nodes);
    free(moved);
    free(got);
    return status;
}

static tm_status find_bad(const sender *s, size_t *bad, double *worst)
{
    *bad = 0;
    *worst = 1;
    for (size_t e = 0; e < own_elements(s); e++) {
        *bad += s->jens[e] < s->options->threshold;
        *worst = fmin(*worst, s->jens[e]);
    }
    tm_ranks_sum(bad, 1);
    tm_ranks_least(worst, 1);
    return TM_OK;
}

static tm_status optimise(sender *s, bool *mark, const tm_boundary *boundary,
                          tm_optimise_report *report, tm_error *error)
{
    size_t bad;
    tm_parallel_runs(s->assembly->mesh.threads, own_elements(s), TM_CHUNK, measure_chunk,
                     s);
    find_bad(s, &bad, &report->worst_after);
    if (bad == 0)
        return TM_OK;
    tm_status status = mark_near(s, mark, error);
    if (status == TM_OK)
        status = list_near(s, mark) ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = send_and_take(s, boundary, report, error);
    tm_ranks_least(&s->worst, 1);
    report->worst_after = fmin(report->worst_after, s->worst);
    return status;
}

tm_status tm_shared_optimise(tm_assembly *assembly, const tm_mesh_share *share,
                             tm_node_rule *rule, const tm_boundary *boundary,
                             const tm_optimise_options *options,
                             tm_optimise_report *report, tm_error *error)
{
    tm_mixed_mesh *mesh = &assembly->mesh;
    if (!share)
        return tm_mixed_optimise(mesh, rule, boundary, options, report, error);
    *report = (tm_optimise_report){0};
    sender s = {.assembly = assembly,
                .share = share,
                .rule = rule,
                .options = options,
                .jens =
                    tm_new(share->elements.past - share->elements.first, sizeof *s.jens),
                .near = calloc(mesh->nodes + 1, sizeof *s.near)};
    bool *mark = tm_new(mesh->nodes, sizeof *mark);
    tm_status status = s.jens && s.near && mark ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = optimise(&s, mark, boundary, report, error);
    free(s.jens);
    free(s.near);
    free(s.element);
    free(s.node);
    free(mark);
    return status;
}
