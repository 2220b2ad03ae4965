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
    double *jens;        /* [own elements] */
    bool *near;          /* [nodes]: within the rings of what is bad */
    uint32_t *label;     /* [nodes of the octree]: of their sets */
    bool *mark;          /* [nodes] */
    uint32_t *candidate; /* own elements that are near what was bad at first */
    size_t candidates;
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

static bool is_bad(const sender *s, size_t e)
{
    return s->jens[e - s->share->elements.first] < s->options->threshold;
}

static void mark_nodes(const sender *s, size_t e, bool *mark)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
        mark[mesh->item[i]] = true;
}

/* Marks the nodes of candidates that are bad, of any rank, then so many rings around. */
static tm_status mark_near(const sender *s, unsigned rings, tm_error *error)
{
    const tm_mesh_ghosts *ghosts = &s->share->ghosts;
    const size_t nodes = s->mesh->assembly.mesh.nodes;
    memset(s->near, false, nodes);
    for (size_t c = 0; c < s->candidates; c++)
        if (is_bad(s, s->candidate[c]))
            mark_nodes(s, s->candidate[c], s->near);
    tm_status status = tm_mesh_ghosts_mark(ghosts, s->near, error);
    for (unsigned ring = 0; ring < rings && status == TM_OK; ring++) {
        memcpy(s->mark, s->near, nodes);
        for (size_t c = 0; c < s->candidates; c++)
            if (is_near(s, s->candidate[c]))
                mark_nodes(s, s->candidate[c], s->mark);
        status = tm_mesh_ghosts_mark(ghosts, s->mark, error);
        memcpy(s->near, s->mark, nodes);
    }
    return status;
}

/* At first all own elements are candidates; then those within the most rings. */
static tm_status find_candidates(sender *s, tm_error *error)
{
    size_t count = 0;
    s->candidate = tm_new(own_elements(s), sizeof *s->candidate);
    tm_status status =
        tm_ranks_agree(s->candidate ? TM_OK : tm_fail_memory(error), error);
    if (status != TM_OK)
        return status;
    s->candidates = own_elements(s);
    for (size_t e = 0; e < s->candidates; e++)
        s->candidate[e] = (uint32_t)(s->share->elements.first + e);
    status = mark_near(s, RINGS, error);
    for (size_t c = 0; status == TM_OK && c < s->candidates; c++)
        if (is_near(s, s->candidate[c]))
            s->candidate[count++] = s->candidate[c];
    s->candidates = count;
    uint32_t *fewer = realloc(s->candidate, (count + 1) * sizeof *fewer);
    s->candidate = fewer ? fewer : s->candidate;
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
    for (size_t c = 0; c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        const uint32_t first = near_node(s, e);
        if (first == TM_NONE)
            continue;
        const uint32_t with = stand_in(s, first);
        for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++)
            if (s->near[mesh->item[i]])
                tm_set_unite(s->label, with, stand_in(s, mesh->item[i]));
    }
}

/* Finds the sets. */
static tm_status find_sets(const sender *s, tm_error *error)
{
    for (size_t n = 0; n < s->share->of->octree.nodes; n++)
        s->label[n] = (uint32_t)n;
    join_near(s);
    return tm_share_join_sets(s->share->of, s->label, error);
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
    size_t *next = calloc(p->ranks, sizeof *next), all = 0;
    for (size_t c = 0; next && c < s->candidates; c++)
        if (is_near(s, s->candidate[c]))
            p->elements[rank_of(s, p, s->candidate[c])]++;
    for (unsigned r = 0; next && r < p->ranks; r++) {
        next[r] = all;
        all += p->elements[r];
    }
    p->element = tm_new(all, sizeof *p->element);
    for (size_t c = 0; next && p->element && c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        if (is_near(s, e))
            enter_element(s, e, &p->element[next[rank_of(s, p, e)]++]);
    }
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
    size_t count = 0, room = 0;
    address *list = NULL;
    for (size_t c = 0; c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        if (!is_near(s, e))
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
static tm_status mend(const sender *s, unsigned pass, const sent_element *element,
                      size_t elements, sent_node *node, size_t nodes, sent_node **moved,
                      size_t *listed, size_t *measured, tm_error *error)
{
    tm_optimise_report report = {0};
    received r = {.mesh.threads = s->mesh->assembly.mesh.threads};
    tm_optimise_options options = *s->options;
    tm_status status = TM_OK;
    *moved = tm_new(nodes, sizeof **moved);
    if (*moved && allocate(&r, elements, nodes)) {
        take_nodes(&r, node, nodes);
        take_elements(&r, element, elements);
        options.number = r.element;
        options.pass = pass;
        status =
            tm_mixed_optimise(&r.mesh, r.rule, s->boundary, &options, &report, error);
        *measured = report.measured;
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

/* Sends what is near, and mends what comes: by one pass, or on rank 0 by all. */
static tm_status mend_sent(const sender *s, unsigned pass, sent_node **moved,
                           size_t *listed, size_t *measured, tm_error *error)
{
    parcel p = {.to_first = pass == 0};
    void *elements = NULL, *nodes = NULL;
    size_t element_count = 0, node_count = 0;
    tm_status status = tm_ranks_agree(pack(s, &p) ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK)
        status = tm_ranks_exchange(p.element, p.elements, sizeof *p.element, &elements,
                                   p.elements, error);
    free(p.element);
    p.element = NULL;
    if (status == TM_OK)
        status =
            tm_ranks_exchange(p.node, p.nodes, sizeof *p.node, &nodes, p.nodes, error);
    for (unsigned r = 0; status == TM_OK && r < p.ranks; r++) {
        element_count += p.elements[r];
        node_count += p.nodes[r];
    }
    unpack(&p);
    if (status == TM_OK)
        status = mend(s, pass, elements, element_count, nodes, node_count, moved, listed,
                      measured, error);
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

/* How many candidates of all ranks are bad. */
static size_t count_bad(const sender *s)
{
    size_t bad = 0;
    for (size_t c = 0; c < s->candidates; c++)
        bad += is_bad(s, s->candidate[c]);
    tm_ranks_sum(&bad, 1);
    return bad;
}

/* Mends by one pass, or by all, what is bad and puts it where it is then. */
static tm_status make_pass(const sender *s, unsigned pass, size_t *measured,
                           tm_error *error)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    sent_node *moved = NULL;
    size_t listed = 0, here = 0;
    tm_status status = mark_near(s, pass == 0 ? RINGS : tm_optimise_rings(pass), error);
    if (status == TM_OK && pass > 0)
        status = find_sets(s, error);
    if (status == TM_OK)
        status = mend_sent(s, pass, &moved, &listed, &here, error);
    if (status == TM_OK)
        status = put_moved(s, moved, listed, error);
    for (size_t c = 0; status == TM_OK && c < s->candidates; c++)
        if (is_near(s, s->candidate[c]))
            s->jens[s->candidate[c] - s->share->elements.first] =
                tm_mixed_jens(mesh, s->candidate[c]);
    tm_ranks_sum(&here, 1);
    *measured += here;
    free(moved);
    return status;
}

/* Makes the passes, each of which all ranks make together. Where they measure so much
 * that one process would have ended before, all goes to rank 0, from where it was:
 * `kept`. */
static tm_status make_passes(const sender *s, const double (*kept)[3], tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    const unsigned passes = tm_optimise_passes(s->options->effort);
    tm_status status = TM_OK;
    size_t measured = 0;
    for (unsigned p = 1; p <= passes && status == TM_OK && count_bad(s) > 0; p++) {
        status = make_pass(s, p, &measured, error);
        if (measured >= s->options->most_measured)
            break;
    }
    if (status != TM_OK || measured < s->options->most_measured)
        return status;
    memcpy(mesh->xyz, kept, mesh->nodes * sizeof *kept);
    for (size_t c = 0; c < s->candidates; c++)
        s->jens[s->candidate[c] - s->share->elements.first] =
            tm_mixed_jens(mesh, s->candidate[c]);
    return make_pass(s, 0, &measured, error);
}

static double find_worst(const sender *s)
{
    double worst = 1;
    for (size_t e = 0; e < own_elements(s); e++)
        worst = fmin(worst, s->jens[e]);
    tm_ranks_least(&worst, 1);
    return worst;
}

static tm_status optimise(sender *s, tm_optimise_report *report, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    tm_parallel_runs(mesh->threads, own_elements(s), TM_CHUNK, measure_chunk, s);
    report->worst_after = find_worst(s);
    if (report->worst_after >= s->options->threshold)
        return TM_OK;
    tm_status status = find_candidates(s, error);
    double(*kept)[3] = tm_new(mesh->nodes, sizeof *kept);
    if (status == TM_OK)
        status = tm_ranks_agree(kept ? TM_OK : tm_fail_memory(error), error);
    if (status == TM_OK) {
        memcpy(kept, mesh->xyz, mesh->nodes * sizeof *kept);
        status = make_passes(s, (const double(*)[3])kept, error);
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
                .near = tm_new(elements->nodes, sizeof *s.near),
                .mark = tm_new(elements->nodes, sizeof *s.mark),
                .label = tm_new(share->of->octree.nodes, sizeof *s.label)};
    tm_status status =
        s.jens && s.near && s.mark && s.label ? TM_OK : tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status = optimise(&s, report, error);
    free(s.jens);
    free(s.near);
    free(s.mark);
    free(s.label);
    free(s.candidate);
    return status;
}
