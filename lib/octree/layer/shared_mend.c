/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "shared_parts.h"

#include "../../base/array.h"
#include "../../ranks/ranks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 8 };

/* An element on its way. */
typedef struct {
    uint32_t number, nodes;
    uint32_t node[MOST_NODES]; /* by their numbers */
} sent_element;

uint32_t tm_shared_stand_in(const tm_shared_work *s, uint32_t n)
{
    const tm_assembly *a = &s->mesh->assembly;
    const size_t middle = a->mesh.nodes - a->middles;
    if (n < a->core)
        return a->grid_node[n];
    return n < middle ? s->mesh->boundary.grid_node[n - a->outer]
                      : s->share->of->octree.node[a->middle_leaf[n - middle]][0];
}

/* What goes to other ranks: those of rank r are element[…], behind those of the ranks
 * before it, and count[r]. */
typedef struct {
    unsigned ranks;
    bool to_first;            /* all of it goes to rank 0 */
    size_t *elements, *nodes; /* [ranks] */
    sent_element *element;
    tm_sent_node *node;
} parcel;

/* The rank that mends an own element, which is near: that of the first node of its set.
 */
static unsigned rank_of(const tm_shared_work *s, const parcel *p, size_t e)
{
    const size_t number = s->label[tm_shared_stand_in(s, tm_shared_near_node(s, e))];
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

static void enter_element(const tm_shared_work *s, size_t e, sent_element *to)
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
static bool pack_elements(const tm_shared_work *s, parcel *p)
{
    size_t *next = calloc(p->ranks, sizeof *next), all = 0;
    for (size_t c = 0; next && c < s->candidates; c++)
        if (tm_shared_is_near(s, s->candidate[c]))
            p->elements[rank_of(s, p, s->candidate[c])]++;
    for (unsigned r = 0; next && r < p->ranks; r++) {
        next[r] = all;
        all += p->elements[r];
    }
    p->element = tm_new(all, sizeof *p->element);
    for (size_t c = 0; next && p->element && c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        if (tm_shared_is_near(s, e))
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
static bool pack_nodes(const tm_shared_work *s, parcel *p)
{
    const tm_mixed_mesh *mesh = &s->mesh->assembly.mesh;
    size_t count = 0, room = 0;
    address *list = NULL;
    for (size_t c = 0; c < s->candidates; c++) {
        const size_t e = s->candidate[c];
        if (!tm_shared_is_near(s, e))
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
        p->node[i] = (tm_sent_node){.rule = s->rule[n], .number = s->share->number[n]};
        memcpy(p->node[i].xyz, mesh->xyz[n], sizeof p->node[i].xyz);
    }
    free(list);
    return p->node != NULL;
}

static bool pack(const tm_shared_work *s, parcel *p)
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
    const tm_sent_node *m = a, *n = b;
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

static void take_nodes(received *r, tm_sent_node *node, size_t count)
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

/* Bit for bit. */
static bool is_same(const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
        if (a[i] != b[i] || signbit(a[i]) != signbit(b[i]))
            return false;
    return true;
}

/* Lists the nodes that are elsewhere than they were: sorted as in r. */
static size_t list_moved(const received *r, const tm_sent_node *old, size_t count,
                         tm_sent_node *moved)
{
    size_t n = 0, listed = 0;
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && old[i].number == old[i - 1].number)
            continue;
        if (!is_same(old[i].xyz, r->mesh.xyz[n])) {
            moved[listed].number = r->number[n];
            memcpy(moved[listed++].xyz, r->mesh.xyz[n], sizeof old[i].xyz);
        }
        n++;
    }
    return listed;
}

/* Mends what has come; *moved gets what is elsewhere then. */
static tm_status mend(const tm_shared_work *s, unsigned pass, const sent_element *element,
                      size_t elements, tm_sent_node *node, size_t nodes,
                      tm_sent_node **moved, size_t *listed, size_t *measured,
                      tm_error *error)
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

tm_status tm_shared_mend(const tm_shared_work *s, unsigned pass, tm_sent_node **moved,
                         size_t *listed, size_t *measured, tm_error *error)
{
    parcel p = {.to_first = pass == 0};
    void *elements = NULL, *nodes = NULL;
    size_t element_count = 0, node_count = 0;
    tm_status status = tm_ranks_enough(pack(s, &p), error);
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
static unsigned owner_of(const tm_shared_work *s, const tm_own_range *range,
                         uint32_t number)
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
    const tm_sent_node *m = a, *n = b;
    if (m->rule.where != n->rule.where)
        return m->rule.where < n->rule.where ? -1 : 1;
    return compare_nodes(a, b);
}

tm_status tm_shared_put(const tm_shared_work *s, tm_sent_node *moved, size_t listed,
                        tm_error *error)
{
    const tm_own_range own[] = {s->share->core, s->share->outer, s->share->middles};
    size_t *count = calloc(tm_ranks_count(), sizeof *count), all = 0;
    double(*xyz)[3] = s->mesh->assembly.mesh.xyz;
    void *range = NULL, *got = NULL;
    tm_status status = tm_ranks_enough(count, error);
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
        const tm_sent_node *of = &((const tm_sent_node *)got)[i];
        memcpy(xyz[tm_mesh_share_node(s->share, &s->mesh->assembly, of->number)], of->xyz,
               sizeof of->xyz);
    }
    if (status == TM_OK)
        tm_mesh_ghosts_fill(&s->share->ghosts, xyz, sizeof *xyz);
    free(count);
    free(range);
    free(got);
    return status;
}
