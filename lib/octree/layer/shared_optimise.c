/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shared_optimise.h"

#include "../../base/array.h"
#include "../../base/disjoint_sets.h"
#include "../../base/parallel.h"
#include "../../element/jens.h"
#include "../../ranks/ranks.h"
#include "mesh_share.h"

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
    tm_octree_mesh *mesh;
    const tm_mesh_share *share;
    tm_node_rule *rule;
    const tm_boundary *boundary;
    const tm_optimise_options *options;
    double *jens;    /* [own elements] */
    bool *near;      /* [nodes]: within the rings */
    uint32_t *label; /* [nodes of the octree]: of their sets */
    bool *crosses;   /* [nodes of the octree]: others may have some of the set */
    double worst;    /* of own elements that stay as they are */
} sender;

static void measure_chunk(void *context, size_t first, size_t past)
{
    const sender *s = context;
    for (size_t e = first; e < past; e++)
        s->jens[e] = tm_mixed_jens(&s->mesh->assembly.mesh, s->share->elements.first + e);
}

static size_t own_elements(const sender *s)
{
    return s->share->elements.past - s->share->elements.first;
}

/* A near node of an element, or TM_NONE. */
static uint32_t near_node(const sender *s, size_t e)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        if (s->near[mesh->item[i]])
            return mesh->item[i];
    return TM_NONE;
}

static bool is_near(const sender *s, size_t e)
{
    return near_node(s, e) != TM_NONE;
}

/* Marks the nodes of own bad elements. */
static void mark_bad(const sender *s, bool *mark)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
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
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++)
        if (is_near(s, e))
            for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
                mark[mesh->item[i]] = true;
}

/* Marks what is near bad elements of any rank. */
static tm_status mark_near(sender *s, tm_error *error)
{
    const size_t nodes = s->mesh->assembly.mesh.nodes;
    bool *mark = tm_new(nodes, sizeof *mark);
    tm_status status = tm_ranks_agree(mark ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK) {
        mark_bad(s, s->near);
        status = tm_mesh_ghosts_mark(&s->share->ghosts, s->near, error);
    }
    for (int ring = 0; ring < RINGS && status == TM_OK; ring++) {
        memcpy(mark, s->near, nodes);
        mark_next(s, mark);
        status = tm_mesh_ghosts_mark(&s->share->ghosts, mark, error);
        memcpy(s->near, mark, nodes);
    }
    s->worst = 1;
    for (size_t e = 0; e < own_elements(s) && status == TM_OK; e++)
        if (!is_near(s, s->share->elements.first + e))
            s->worst = fmin(s->worst, s->jens[e]);
    free(mark);
    return status;
}

/* The node of the octree that stands for a node of the mesh: where it is, or a corner of
 * its leaf. */
static uint32_t stand_in(const sender *s, uint32_t n)
{
    const tm_assembly *a = &s->mesh->assembly;
    const size_t middle = a->mesh.nodes - a->middles;
    if (n < a->core)
        return a->grid_node[n];
    return n < middle ? s->mesh->boundary.grid_node[n - a->outer]
                      : s->share->of->octree.node[a->middle_leaf[n - middle]][0];
}

/* Joins the near nodes of each element: what is of different sets has nothing to do with
 * each other. */
static void join_near(const sender *s)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++) {
        const uint32_t first = near_node(s, e);
        if (first == TM_NONE)
            continue;
        const uint32_t with = stand_in(s, first);
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            if (s->near[mesh->item[i]])
                tm_set_unite(s->label, with, stand_in(s, mesh->item[i]));
    }
}

/* Finds the sets, and those that have nodes which other ranks know, too. */
static tm_status find_sets(sender *s, tm_error *error)
{
    const tm_octree_share *of = s->share->of;
    const size_t nodes = of->octree.nodes;
    s->label = tm_new(nodes, sizeof *s->label);
    s->crosses = calloc(nodes + 1, sizeof *s->crosses);
    const tm_status status =
        tm_ranks_agree(s->label && s->crosses ? TM_OK : tm_fail_memory(error), error);
    if (status != TM_OK)
        return status;
    for (size_t n = 0; n < nodes; n++)
        s->label[n] = (uint32_t)n;
    join_near(s);
    for (uint32_t n = 0; n < nodes; n++)
        if (n < of->own_node_first || n >= of->own_node_past)
            s->crosses[tm_set_root(s->label, n)] = true;
    for (size_t i = 0; i < of->nodes_sent.start[of->ranks]; i++)
        s->crosses[tm_set_root(s->label, of->nodes_sent.item[i])] = true;
    for (uint32_t n = 0; n < nodes; n++) /* a root comes before the others */
        s->crosses[n] = s->crosses[tm_set_root(s->label, n)];
    return tm_share_join_sets(of, s->label, error);
}

/* Whether an own element, which is near, is of a set that is this rank's alone. */
static bool is_alone(const sender *s, size_t e)
{
    return !s->crosses[stand_in(s, near_node(s, e))];
}

/* What is this rank's alone is mended where it is. */
static tm_status mend_alone(const sender *s, tm_optimise_report *report, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const tm_own_range *own = &s->share->elements;
    double *threshold = tm_new(mesh->elements, sizeof *threshold);
    uint32_t *number = tm_new(mesh->elements, sizeof *number);
    tm_status status = threshold && number ? TM_OK : tm_fail_memory(error);
    for (size_t e = 0; status == TM_OK && e < mesh->elements; e++) {
        const bool here =
            e >= own->first && e < own->past && is_near(s, e) && is_alone(s, e);
        threshold[e] = here ? s->options->threshold : -HUGE_VAL;
        number[e] = (uint32_t)(own->number + e - own->first);
    }
    if (status == TM_OK) {
        tm_optimise_options options = *s->options;
        options.thresholds = threshold;
        options.number = number;
        status = tm_mixed_optimise(mesh, s->rule, s->boundary, &options, report, error);
    }
    free(threshold);
    free(number);
    return status;
}

/* What goes to other ranks: those of rank r are element[…], behind those of the ranks
 * before it, and count[r]. */
typedef struct {
    unsigned ranks;
    bool to_first;            /* all of it goes to rank 0 */
    size_t *elements, *nodes; /* [ranks] */
    sent_element *element;
    sent_node *node;
} parcel;

/* The rank that mends an own element, which is near: that of the first node of its set.
 */
static unsigned rank_of(const sender *s, const parcel *p, size_t e)
{
    const size_t number = s->label[stand_in(s, near_node(s, e))];
    unsigned first = 0, past = p->ranks;
    while (!p->to_first && past - first > 1) {
        const unsigned middle = first + (past - first) / 2;
        if (s->share->of->first_node[middle] <= number)
            first = middle;
        else
            past = middle;
    }
    return first;
}

static bool is_sent(const sender *s, const parcel *p, size_t e)
{
    return is_near(s, e) && (p->to_first || !is_alone(s, e));
}

static void enter_element(const sender *s, size_t e, sent_element *to)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const tm_mesh_share *share = s->share;
    *to = (sent_element){
        .number = (uint32_t)(share->elements.number + e - share->elements.first),
        .nodes = (uint32_t)(mesh->start[e + 1] - mesh->start[e])};
    for (uint32_t i = 0; i < to->nodes; i++)
        to->node[i] = share->number[mesh->item[mesh->start[e] + i]];
}

/* Sorts elements by the ranks that they go to. */
static bool pack_elements(const sender *s, parcel *p)
{
    const tm_own_range *own = &s->share->elements;
    size_t *next = calloc(p->ranks, sizeof *next), all = 0;
    for (size_t e = own->first; next && e < own->past; e++)
        if (is_sent(s, p, e))
            p->elements[rank_of(s, p, e)]++;
    for (unsigned r = 0; next && r < p->ranks; r++) {
        next[r] = all;
        all += p->elements[r];
    }
    p->element = tm_new(all, sizeof *p->element);
    for (size_t e = own->first; next && p->element && e < own->past; e++)
        if (is_sent(s, p, e))
            enter_element(s, e, &p->element[next[rank_of(s, p, e)]++]);
    free(next);
    return next && p->element;
}

/* A node that goes to a rank. */
typedef struct {
    unsigned rank;
    uint32_t node;
} address;

static int compare_addresses(const void *a, const void *b)
{
    const address *p = a, *q = b;
    if (p->rank != q->rank)
        return p->rank < q->rank ? -1 : 1;
    return (p->node > q->node) - (p->node < q->node);
}

/* The nodes of all of these, once for each rank. */
static bool pack_nodes(const sender *s, parcel *p)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const tm_own_range *own = &s->share->elements;
    size_t count = 0, room = 0;
    address *list = NULL;
    for (size_t e = own->first; e < own->past; e++) {
        if (!is_sent(s, p, e))
            continue;
        address *grown = tm_grow(list, &room, count + MOST_NODES, sizeof *list);
        if (!grown) {
            free(list);
            return false;
        }
        list = grown;
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            list[count++] = (address){rank_of(s, p, e), mesh->item[i]};
    }
    if (count > 0)
        qsort(list, count, sizeof *list, compare_addresses);
    size_t different = 0;
    for (size_t i = 0; i < count; i++)
        if (i == 0 || compare_addresses(&list[i], &list[different - 1]) != 0)
            list[different++] = list[i];
    p->node = tm_new(different, sizeof *p->node);
    for (size_t i = 0; p->node && i < different; i++) {
        const uint32_t n = list[i].node;
        p->nodes[list[i].rank]++;
        p->node[i] = (sent_node){.rule = s->rule[n], .number = s->share->number[n]};
        memcpy(p->node[i].xyz, mesh->xyz[n], sizeof p->node[i].xyz);
    }
    free(list);
    return p->node != NULL;
}

static bool pack(const sender *s, parcel *p)
{
    p->ranks = tm_ranks_count();
    p->elements = calloc(p->ranks, sizeof *p->elements);
    p->nodes = calloc(p->ranks, sizeof *p->nodes);
    return p->elements && p->nodes && pack_elements(s, p) && pack_nodes(s, p);
}

static void unpack(parcel *p)
{
    free(p->elements);
    free(p->nodes);
    free(p->element);
    free(p->node);
    *p = (parcel){0};
}

/* What a rank has got to mend. */
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

/* Mends what has come; *moved gets what is elsewhere then. */
static tm_status mend(const sender *s, const sent_element *element, size_t elements,
                      sent_node *node, size_t nodes, sent_node **moved, size_t *listed,
                      tm_optimise_report *report, tm_error *error)
{
    received r = {.mesh.threads = s->mesh->assembly.mesh.threads};
    tm_optimise_options options = *s->options;
    tm_status status = TM_OK;
    *moved = tm_new(nodes, sizeof **moved);
    if (*moved && allocate(&r, elements, nodes)) {
        take_nodes(&r, node, nodes);
        take_elements(&r, element, elements);
        options.number = r.element;
        status = tm_mixed_optimise(&r.mesh, r.rule, s->boundary, &options, report, error);
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

/* Sends what is sent, and mends what comes. */
static tm_status mend_sent(const sender *s, bool to_first, sent_node **moved,
                           size_t *listed, tm_optimise_report *report, tm_error *error)
{
    parcel p = {.to_first = to_first};
    void *elements = NULL, *nodes = NULL;
    size_t element_count = 0, node_count = 0;
    tm_status status = tm_ranks_agree(pack(s, &p) ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK)
        status = tm_ranks_exchange(p.element, p.elements, sizeof *p.element, &elements,
                                   p.elements, error);
    if (status == TM_OK)
        status =
            tm_ranks_exchange(p.node, p.nodes, sizeof *p.node, &nodes, p.nodes, error);
    for (unsigned r = 0; status == TM_OK && r < p.ranks; r++) {
        element_count += p.elements[r];
        node_count += p.nodes[r];
    }
    unpack(&p);
    if (status == TM_OK)
        status = mend(s, elements, element_count, nodes, node_count, moved, listed,
                      report, error);
    free(elements);
    free(nodes);
    return tm_ranks_agree(status, error);
}

/* The rank that has a node of the whole mesh. range[3 * ranks]: what each has of the
 * octree's, outer ones and middles. */
static unsigned owner_of(const sender *s, const tm_own_range *range, uint32_t number)
{
    const tm_mesh_share *share = s->share;
    size_t within = number, kind = 0;
    const size_t all[] = {share->core.all, share->outer.all, share->middles.all};
    while (within >= all[kind])
        within -= all[kind++];
    unsigned first = 0, past = tm_ranks_count();
    while (past - first > 1) {
        const unsigned middle = first + (past - first) / 2;
        if (range[3 * middle + kind].number <= within)
            first = middle;
        else
            past = middle;
    }
    return first;
}

static int compare_moved(const void *a, const void *b)
{
    const sent_node *m = a, *n = b;
    if (m->rule.where != n->rule.where)
        return m->rule.where < n->rule.where ? -1 : 1;
    return compare_nodes(a, b);
}

/* Gives the moved nodes to their ranks, and these to those that have them as ghosts. */
static tm_status put_moved(const sender *s, sent_node *moved, size_t listed,
                           tm_error *error)
{
    const tm_own_range own[] = {s->share->core, s->share->outer, s->share->middles};
    size_t *count = calloc(tm_ranks_count(), sizeof *count), all = 0;
    double(*xyz)[3] = s->mesh->assembly.mesh.xyz;
    void *range = NULL, *got = NULL;
    tm_status status = tm_ranks_agree(count ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK)
        status = tm_ranks_share(own, 3, sizeof *own, &range, NULL, error);
    for (size_t i = 0; status == TM_OK && i < listed; i++) {
        moved[i].rule.where = owner_of(s, range, moved[i].number);
        count[moved[i].rule.where]++;
    }
    if (listed > 0)
        qsort(moved, listed, sizeof *moved, compare_moved);
    if (status == TM_OK)
        status = tm_ranks_exchange(moved, count, sizeof *moved, &got, count, error);
    for (unsigned r = 0; status == TM_OK && r < tm_ranks_count(); r++)
        all += count[r];
    for (size_t i = 0; i < all; i++) {
        const sent_node *of = &((const sent_node *)got)[i];
        memcpy(xyz[tm_mesh_share_node(s->share, &s->mesh->assembly, of->number)], of->xyz,
               sizeof of->xyz);
    }
    if (status == TM_OK)
        status = tm_mesh_ghosts_fill(&s->share->ghosts, xyz, sizeof *xyz, error);
    free(count);
    free(range);
    free(got);
    return status;
}

/* Each rank what is its alone, then the others. Where together they measure so much that
 * one process would have ended before, all goes to rank 0, from where it was: `kept`. */
static tm_status mend_all(const sender *s, const double (*kept)[3], tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    tm_optimise_report alone = {0}, sent = {0};
    sent_node *moved = NULL;
    size_t listed = 0;
    tm_status status = tm_ranks_agree(mend_alone(s, &alone, error), error);
    if (status == TM_OK)
        status = mend_sent(s, false, &moved, &listed, &sent, error);
    size_t measured = alone.measured + sent.measured;
    tm_ranks_sum(&measured, 1);
    if (status == TM_OK && measured >= s->options->most_measured) {
        free(moved);
        memcpy(mesh->xyz, kept, mesh->nodes * sizeof *kept);
        moved = NULL;
        status = mend_sent(s, true, &moved, &listed, &sent, error);
    }
    if (status == TM_OK)
        status = put_moved(s, moved, listed, error);
    free(moved);
    return status;
}

/* How many of all are bad, and the worst. */
static size_t find_bad(const sender *s, double *worst)
{
    size_t bad = 0;
    *worst = 1;
    for (size_t e = 0; e < own_elements(s); e++) {
        bad += s->jens[e] < s->options->threshold;
        *worst = fmin(*worst, s->jens[e]);
    }
    tm_ranks_sum(&bad, 1);
    tm_ranks_least(worst, 1);
    return bad;
}

/* The worst of all elements, when those that are near have changed. */
static double find_worst(const sender *s)
{
    double worst = s->worst;
    for (size_t e = s->share->elements.first; e < s->share->elements.past; e++)
        if (is_near(s, e))
            worst = fmin(worst, tm_mixed_jens(&s->mesh->assembly.mesh, e));
    tm_ranks_least(&worst, 1);
    return worst;
}

static tm_status optimise(sender *s, tm_optimise_report *report, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    tm_parallel_runs(mesh->threads, own_elements(s), TM_CHUNK, measure_chunk, s);
    if (find_bad(s, &report->worst_after) == 0)
        return TM_OK;
    tm_status status = mark_near(s, error);
    free(s->jens);
    s->jens = NULL;
    if (status == TM_OK)
        status = find_sets(s, error);
    double(*kept)[3] = tm_new(mesh->nodes, sizeof *kept);
    if (status == TM_OK)
        status = tm_ranks_agree(kept ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK) {
        memcpy(kept, mesh->xyz, mesh->nodes * sizeof *kept);
        status = mend_all(s, (const double(*)[3])kept, error);
    }
    free(kept);
    report->worst_after = find_worst(s);
    return status;
}

tm_status tm_shared_optimise(tm_octree_mesh *mesh, tm_node_rule *rule,
                             const tm_boundary *boundary,
                             const tm_optimise_options *options,
                             tm_optimise_report *report, tm_error *error)
{
    const tm_mesh_share *share = mesh->share;
    tm_mixed_mesh *elements = &mesh->assembly.mesh;
    if (!share)
        return tm_mixed_optimise(elements, rule, boundary, options, report, error);
    *report = (tm_optimise_report){0};
    sender s = {.mesh = mesh,
                .share = share,
                .rule = rule,
                .boundary = boundary,
                .options = options,
                .jens =
                    tm_new(share->elements.past - share->elements.first, sizeof *s.jens),
                .near = calloc(elements->nodes + 1, sizeof *s.near)};
    tm_status status =
        tm_ranks_agree(s.jens && s.near ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK)
        status = optimise(&s, report, error);
    free(s.jens);
    free(s.near);
    free(s.label);
    free(s.crosses);
    return status;
}
