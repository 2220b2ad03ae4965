/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gmsh_elements.h"

#include "../../../lib/base/array.h"
#include "../../../lib/base/hash.h"
#include "../../../lib/element/shape.h"

#include <stdlib.h>
#include <string.h>

/* Nodes ---------------------------------------------------------------------------- */

/* A number and whose it is. */
typedef struct tagged {
    size_t tag;
    uint32_t index;
} tagged;

static int compare(const void *a, const void *b)
{
    const tagged *p = a, *q = b;
    if (p->tag != q->tag)
        return p->tag < q->tag ? -1 : 1;
    return (p->index > q->index) - (p->index < q->index);
}

/* At most so many times as many numbers as there are makes them dense. */
enum { DENSE = 4 };

/* Puts the indices of dense numbers in order, by counting; false where memory is out. */
static bool count_tags(tagged *order, const size_t *tag, size_t count, size_t most)
{
    uint32_t *start = calloc(most + 2, sizeof *start);
    if (!start)
        return false;
    for (size_t i = 0; i < count; i++)
        start[tag[i] + 1]++;
    for (size_t t = 0; t < most; t++)
        start[t + 1] += start[t];
    for (size_t i = 0; i < count; i++)
        order[start[tag[i]]++] = (tagged){tag[i], (uint32_t)i};
    free(start);
    return true;
}

/* Numbers in ascending order, malloc'ed; NULL where memory is out. */
static tagged *sort_tags(const size_t *tag, size_t count)
{
    tagged *order = tm_new(count, sizeof *order);
    bool is_sorted = true;
    size_t most = 0;
    for (size_t i = 0; order && i < count; i++) {
        order[i] = (tagged){tag[i], (uint32_t)i};
        is_sorted &= i == 0 || tag[i - 1] <= tag[i];
        most = tag[i] > most ? tag[i] : most;
    }
    if (!order || is_sorted)
        return order;
    if (most / DENSE > count)
        qsort(order, count, sizeof *order, compare);
    else if (!count_tags(order, tag, count, most)) {
        free(order);
        return NULL;
    }
    return order;
}

/* Which node has a number: index[number] where the numbers are dense, else by search. */
typedef struct node_index {
    size_t nodes;
    tagged *order;
    size_t numbers; /* of index */
    uint32_t *index;
} node_index;

static tm_status index_nodes(node_index *find, const gmsh_model *model, tm_error *error)
{
    find->nodes = model->nodes;
    find->order = sort_tags(model->node_tag, model->nodes);
    if (!find->order)
        return tm_fail_memory(error);
    const size_t most = model->nodes > 0 ? find->order[model->nodes - 1].tag : 0;
    if (most / DENSE > model->nodes)
        return TM_OK;
    find->index = tm_new(most + 1, sizeof *find->index);
    if (!find->index)
        return tm_fail_memory(error);
    find->numbers = most + 1;
    memset(find->index, 0xFF, find->numbers * sizeof *find->index);
    for (size_t v = model->nodes; v-- > 0;) /* of equal numbers the first */
        find->index[find->order[v].tag] = (uint32_t)v;
    return TM_OK;
}

/* The node of that number, or TM_NONE. */
static uint32_t find_node(const node_index *find, size_t tag)
{
    if (find->index)
        return tag < find->numbers ? find->index[tag] : TM_NONE;
    size_t lo = 0, hi = find->nodes;
    while (lo < hi) {
        const size_t middle = (lo + hi) / 2;
        if (find->order[middle].tag < tag)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo < find->nodes && find->order[lo].tag == tag ? (uint32_t)lo : TM_NONE;
}

/* Elements ------------------------------------------------------------------------- */

/* Between partitions Gmsh makes elements of its own: their entity's parent is of a higher
 * dimension. */
static bool is_between(const gmsh_model *model, const gmsh_run *run)
{
    const gmsh_entity *entity = &model->entity[run->entity];
    return entity->parent >= 0 && entity->parent_dimension > entity->dimension;
}

static tm_status make_room(gmsh_mesh *mesh, const gmsh_model *model, tm_error *error)
{
    size_t count[GMSH_DIMENSIONS] = {0};
    for (size_t r = 0; r < model->runs; r++) {
        const gmsh_run *run = &model->run[r];
        gmsh_elements *elements = &mesh->of[run->dimension];
        count[run->dimension] += run->count;
        if (run->corners > elements->width)
            elements->width = run->corners;
    }
    for (int d = 0; d < GMSH_DIMENSIONS; d++) {
        gmsh_elements *elements = &mesh->of[d];
        if (count[d] >= TM_HASH_FREE)
            return tm_fail(error, TM_ERROR_SYSTEM,
                           "has %zu elements (a stream has room "
                           "for 2^32)",
                           count[d]);
        elements->count = tm_new(count[d], sizeof *elements->count);
        elements->node = tm_new(count[d] * elements->width, sizeof *elements->node);
        elements->set = tm_new(count[d], sizeof *elements->set);
        elements->tag = tm_new(count[d], sizeof *elements->tag);
        if (!elements->count || !elements->node || !elements->set || !elements->tag)
            return tm_fail_memory(error);
    }
    return TM_OK;
}

/* Marks which nodes are corners of something, and which are only between corners. */
enum { IS_CORNER = 1, IS_BETWEEN = 2 };

/* Appends element i of a run. */
static tm_status take_element(gmsh_elements *elements, const gmsh_run *run, size_t i,
                              const node_index *find, unsigned char *use, tm_error *error)
{
    const size_t *tag = run->node + i * run->nodes;
    uint32_t *node = elements->node + elements->elements * elements->width;
    for (size_t k = 0; k < run->nodes; k++) {
        const uint32_t v = find_node(find, tag[k]);
        if (v == TM_NONE)
            return tm_fail(error, TM_ERROR_INPUT,
                           "element %zu has node %zu, which is not there", run->tag[i],
                           tag[k]);
        use[v] |= k < run->corners ? IS_CORNER : IS_BETWEEN;
        if (k < run->corners)
            node[k] = v;
    }
    elements->count[elements->elements] = (uint8_t)run->corners;
    elements->tag[elements->elements++] = run->tag[i];
    return TM_OK;
}

/* The physical groups of elements of .msh files before version 4, by their numbers: in
 * such a file each element has its own, but Gmsh gives all elements of an entity those
 * that one of them has. */
typedef struct own_groups {
    size_t elements;
    tagged *order; /* index: in run */
    const gmsh_run **run;
} own_groups;

static tm_status find_own_groups(own_groups *own, const gmsh_model *swapped,
                                 int dimension, tm_error *error)
{
    size_t count = 0;
    for (size_t r = 0; r < swapped->runs; r++)
        if (swapped->run[r].dimension == dimension)
            count += swapped->run[r].count;
    size_t *tag = tm_new(count, sizeof *tag);
    own->run = tm_new(count, sizeof(gmsh_run *));
    for (size_t r = 0; tag && own->run && r < swapped->runs; r++)
        for (size_t i = 0;
             swapped->run[r].dimension == dimension && i < swapped->run[r].count; i++) {
            tag[own->elements] = swapped->run[r].tag[i];
            own->run[own->elements++] = &swapped->run[r];
        }
    own->order = tag && own->run ? sort_tags(tag, count) : NULL;
    free(tag);
    return own->order ? TM_OK : tm_fail_memory(error);
}

static void free_own_groups(own_groups *own)
{
    free(own->order);
    free(own->run);
}

/* The set of element i of a run, which it has now as those of its entity. */
static tm_status own_set(const own_groups *own, gmsh_sets *sets, const gmsh_run *run,
                         size_t i, uint32_t *set, tm_error *error)
{
    const node_index find = {.nodes = own->elements, .order = own->order};
    const uint32_t at = find_node(&find, run->tag[i]);
    if (at == TM_NONE || sets->set[*set].groups == 0)
        return TM_OK;
    const gmsh_run *swapped = own->run[own->order[at].index];
    const int group = gmsh_entity_whole(&sets->swapped->entity[swapped->entity]);
    return group == 0
               ? gmsh_sets_ungrouped(sets, &sets->model->entity[run->entity], set, error)
               : gmsh_sets_single(sets, run->dimension, group, set, error);
}

/* The elements of one dimension, in the order in which they come. */
static tm_status take_elements(gmsh_mesh *mesh, const gmsh_model *model, int dimension,
                               gmsh_sets *sets, const node_index *find,
                               unsigned char *use, tm_error *error)
{
    gmsh_elements *elements = &mesh->of[dimension];
    own_groups own = {0};
    tm_status status = TM_OK;
    if (sets->swapped)
        status = find_own_groups(&own, sets->swapped, dimension, error);
    for (size_t r = 0; r < model->runs; r++) {
        const gmsh_run *run = &model->run[r];
        if (run->dimension != dimension)
            continue;
        if (is_between(model, run)) {
            mesh->between += run->count;
            continue;
        }
        mesh->high_order += run->nodes > run->corners ? run->count : 0;
        for (size_t i = 0; i < run->count && status == TM_OK; i++) {
            uint32_t *set = &elements->set[elements->elements];
            *set = sets->of_entity[run->entity];
            status = take_element(elements, run, i, find, use, error);
            if (status == TM_OK && sets->swapped)
                status = own_set(&own, sets, run, i, set, error);
        }
    }
    free_own_groups(&own);
    return status;
}

/* Their order, and each once ----------------------------------------------------------
 */

static void copy_element(gmsh_elements *to, size_t e, const gmsh_elements *from, size_t f)
{
    const size_t size = to->width * sizeof *to->node;
    to->count[e] = from->count[f];
    to->set[e] = from->set[f];
    to->tag[e] = from->tag[f];
    if (size > 0)
        memmove(to->node + e * to->width, from->node + f * from->width, size);
}

static void free_elements(gmsh_elements *elements)
{
    free(elements->count);
    free(elements->node);
    free(elements->set);
    free(elements->tag);
    *elements = (gmsh_elements){0};
}

/* Puts elements in the order of their numbers. */
static tm_status sort_elements(gmsh_elements *elements, tm_error *error)
{
    bool is_sorted = true;
    for (size_t e = 1; e < elements->elements; e++)
        is_sorted &= elements->tag[e - 1] <= elements->tag[e];
    if (is_sorted)
        return TM_OK;
    tagged *order = sort_tags(elements->tag, elements->elements);
    gmsh_elements sorted = {.elements = elements->elements, .width = elements->width};
    sorted.count = tm_new(sorted.elements, sizeof *sorted.count);
    sorted.node = tm_new(sorted.elements * sorted.width, sizeof *sorted.node);
    sorted.set = tm_new(sorted.elements, sizeof *sorted.set);
    sorted.tag = tm_new(sorted.elements, sizeof *sorted.tag);
    const bool has_room =
        order && sorted.count && sorted.node && sorted.set && sorted.tag;
    for (size_t e = 0; has_room && e < sorted.elements; e++)
        copy_element(&sorted, e, elements, order[e].index);
    free(order);
    if (!has_room) {
        free_elements(&sorted);
        return tm_fail_memory(error);
    }
    free_elements(elements);
    *elements = sorted;
    return TM_OK;
}

/* Whether two elements have the same nodes, in any order; none is degenerate. */
static bool are_same(const uint32_t *a, const uint32_t *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        size_t k = 0;
        while (k < count && b[k] != a[i])
            k++;
        if (k == count)
            return false;
    }
    return true;
}

/* The same for any order of the nodes. */
static uint64_t hash_of(const gmsh_elements *elements, size_t e)
{
    const uint32_t *node = elements->node + e * elements->width;
    uint64_t sum = 0;
    for (size_t i = 0; i < elements->count[e]; i++)
        sum += tm_hash(0, node[i]);
    return tm_hash(0, sum);
}

/* Where an element with the nodes of element e is, or could be put. */
static uint32_t *find_element(const tm_hash_table *table, const gmsh_elements *elements,
                              size_t e)
{
    const size_t count = elements->count[e];
    const uint32_t *node = elements->node + e * elements->width;
    uint32_t *slot = tm_hash_slot(table, hash_of(elements, e));
    for (; *slot != TM_HASH_FREE; slot = tm_hash_next(table, slot))
        if (elements->count[*slot] == count &&
            are_same(elements->node + *slot * elements->width, node, count))
            break;
    return slot;
}

/* Removes elements that are there already, whose groups the first one gets, and those
 * that name a corner twice. */
static tm_status keep_each_once(gmsh_mesh *mesh, gmsh_elements *elements, gmsh_sets *sets,
                                tm_error *error)
{
    enum { AHEAD = 16 }; /* memory is asked for so many elements before it is needed */
    tm_hash_table table = {0};
    if (!tm_hash_make(&table, elements->elements))
        return tm_fail_memory(error);
    tm_status status = TM_OK;
    size_t kept = 0;
    for (size_t e = 0; e < elements->elements && status == TM_OK; e++) {
        const uint32_t *node = elements->node + e * elements->width;
        if (e + AHEAD < elements->elements)
            __builtin_prefetch(tm_hash_slot(&table, hash_of(elements, e + AHEAD)));
        if (tm_has_node_twice(node, elements->count[e])) {
            mesh->degenerate++;
            continue;
        }
        uint32_t *slot = find_element(&table, elements, e);
        if (*slot != TM_HASH_FREE) {
            mesh->repeated++;
            status = gmsh_sets_join(sets, elements->set[*slot], elements->set[e],
                                    &elements->set[*slot], error);
            continue;
        }
        *slot = (uint32_t)kept;
        if (kept < e)
            copy_element(elements, kept, elements, e);
        kept++;
    }
    elements->elements = kept;
    tm_hash_free(&table);
    return status;
}

/* All together --------------------------------------------------------------------- */

/* Nodes that are only between corners are left out; the others are in the order of their
 * numbers. */
static tm_status take_nodes(gmsh_mesh *mesh, const gmsh_model *model,
                            const node_index *find, const unsigned char *use,
                            tm_error *error)
{
    uint32_t *place = tm_new(model->nodes, sizeof *place);
    mesh->xyz = tm_new(model->nodes, sizeof *mesh->xyz);
    if (!place || !mesh->xyz) {
        free(place);
        return tm_fail_memory(error);
    }
    for (size_t v = 0; v < model->nodes; v++) {
        place[v] = (uint32_t)mesh->nodes;
        if (use[v] != IS_BETWEEN)
            memcpy(mesh->xyz[mesh->nodes++],
                   model->xyz + 3 * (size_t)find->order[v].index, sizeof *mesh->xyz);
    }
    for (int d = 0; d < GMSH_DIMENSIONS && mesh->nodes < model->nodes; d++) {
        gmsh_elements *elements = &mesh->of[d];
        for (size_t e = 0; e < elements->elements; e++)
            for (size_t i = 0; i < elements->count[e]; i++) {
                uint32_t *node = &elements->node[e * elements->width + i];
                *node = place[*node];
            }
    }
    free(place);
    return TM_OK;
}

tm_status gmsh_mesh_take(gmsh_mesh *mesh, const gmsh_model *model, gmsh_sets *sets,
                         tm_error *error)
{
    node_index find = {0};
    unsigned char *use = NULL;
    if (model->nodes >= TM_HASH_FREE)
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "has %zu nodes (a stream has room for 2^32)", model->nodes);
    tm_status status = index_nodes(&find, model, error);
    if (status == TM_OK && !(use = calloc(model->nodes + 1, 1)))
        status = tm_fail_memory(error);
    if (status == TM_OK)
        status = make_room(mesh, model, error);
    for (int d = 0; d < GMSH_DIMENSIONS && status == TM_OK; d++) {
        status = take_elements(mesh, model, d, sets, &find, use, error);
        if (status == TM_OK)
            status = sort_elements(&mesh->of[d], error);
        if (status == TM_OK)
            status = keep_each_once(mesh, &mesh->of[d], sets, error);
    }
    if (status == TM_OK)
        status = take_nodes(mesh, model, &find, use, error);
    free(use);
    free(find.order);
    free(find.index);
    return status;
}

void gmsh_mesh_free(gmsh_mesh *mesh)
{
    for (int d = 0; d < GMSH_DIMENSIONS; d++)
        free_elements(&mesh->of[d]);
    free(mesh->xyz);
    *mesh = (gmsh_mesh){0};
}
