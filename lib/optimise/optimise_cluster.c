/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cluster: the nodes that move, the elements around them, copied out of the mesh. */
#include "optimise_parts.h"

#include "../base/array.h"
#include "../element/jens.h"
#include "../geom/vector.h"
#include "../stream/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Moving nodes of a cluster, about: what is larger is worked on in overlapping parts. */
enum { MOVING_MOST = 600 };

static bool add_node(tm_cluster *cluster, const tm_cluster_source *source, uint32_t v)
{
    if (cluster->nodes == cluster->node_room) {
        uint32_t *grown = tm_grow(cluster->node, &cluster->node_room, cluster->nodes + 1,
                                  sizeof *cluster->node);
        if (!grown)
            return false;
        cluster->node = grown;
    }
    source->local[v] = (uint32_t)cluster->nodes;
    cluster->node[cluster->nodes++] = v;
    return true;
}

static bool add_element(tm_cluster *cluster, const tm_cluster_source *source, uint32_t e)
{
    if (cluster->elements == cluster->element_room) {
        uint32_t *grown = tm_grow(cluster->element, &cluster->element_room,
                                  cluster->elements + 1, sizeof *cluster->element);
        if (!grown)
            return false;
        cluster->element = grown;
    }
    source->taken[e] = true;
    cluster->element[cluster->elements++] = e;
    return true;
}

static bool may_move(const tm_node_rule *rule)
{
    return rule->freedom == TM_MOVES_AT_CORNER ? rule->off_surface
                                               : rule->freedom != TM_MOVES_NOT;
}

/* The nodes of an element that are not in the cluster; only those that can move, or all.
 */
static bool add_nodes_of(tm_cluster *cluster, const tm_cluster_source *source, uint32_t e,
                         bool all)
{
    const tm_mixed_mesh *mesh = source->mesh;
    for (size_t i = mesh->start[e]; i < mesh->start[e + 1]; i++) {
        const uint32_t v = mesh->item[i];
        if (source->local[v] != TM_NONE)
            continue;
        if (!all && (!may_move(&source->rule[v]) || source->vicinity->row[v] == TM_NONE))
            continue;
        if (!add_node(cluster, source, v))
            return false;
    }
    return true;
}

/* Adds the nodes that move, ring by ring. */
static bool gather_moving(tm_cluster *cluster, const tm_cluster_source *source,
                          const uint32_t *core, size_t cores, unsigned rings)
{
    const tm_vicinity *vicinity = source->vicinity;
    for (size_t e = 0; e < cores; e++)
        if (!add_nodes_of(cluster, source, core[e], false))
            return false;
    size_t done = 0;
    for (unsigned r = 0; r < rings; r++) {
        const size_t end = cluster->nodes;
        for (; done < end && cluster->nodes < MOVING_MOST; done++) {
            const uint32_t row = vicinity->row[cluster->node[done]];
            for (size_t i = vicinity->start[row]; i < vicinity->start[row + 1]; i++)
                if (!add_nodes_of(cluster, source, vicinity->element[i], false))
                    return false;
        }
    }
    cluster->moving = cluster->nodes;
    return true;
}

/* Adds the elements around them, and their other nodes. */
static bool gather_elements(tm_cluster *cluster, const tm_cluster_source *source)
{
    const tm_vicinity *vicinity = source->vicinity;
    for (size_t v = 0; v < cluster->moving; v++) {
        const uint32_t row = vicinity->row[cluster->node[v]];
        for (size_t i = vicinity->start[row]; i < vicinity->start[row + 1]; i++) {
            const uint32_t e = vicinity->element[i];
            if (!source->taken[e] && !add_element(cluster, source, e))
                return false;
        }
    }
    for (size_t e = 0; e < cluster->elements; e++)
        if (!add_nodes_of(cluster, source, cluster->element[e], true))
            return false;
    return true;
}

/* Room for `count` items, whatever they were. */
#define RENEW(array, count)                                                              \
    (free(array), (array) = tm_new((count), sizeof *(array)), (array) != NULL)

/* Arrays for as many nodes and elements as there is room for in node[] and element[]. */
static bool make_room(tm_cluster *cluster, size_t old_nodes, size_t old_elements)
{
    const size_t nodes = cluster->node_room, elements = cluster->element_room;
    bool made = true;
    if (nodes > old_nodes)
        made = RENEW(cluster->xyz, nodes) && RENEW(cluster->rule, nodes) &&
               RENEW(cluster->point, nodes) && RENEW(cluster->offset, nodes) &&
               RENEW(cluster->size, nodes) && RENEW(cluster->old, nodes) &&
               RENEW(cluster->old_point, nodes) && RENEW(cluster->best, nodes) &&
               RENEW(cluster->pull, nodes) &&
               RENEW(cluster->vector, 3 * nodes * TM_CLUSTER_VECTORS);
    if (elements > old_elements)
        made = made && RENEW(cluster->start, elements + 1) &&
               RENEW(cluster->item, elements * TM_ELEMENT_NODES) &&
               RENEW(cluster->threshold, elements) && RENEW(cluster->before, elements) &&
               RENEW(cluster->jens, elements) && RENEW(cluster->element_size, elements) &&
               RENEW(cluster->corner, elements * TM_ELEMENT_CORNERS);
    return made;
}

static void copy_elements(tm_cluster *cluster, const tm_cluster_source *source)
{
    const tm_mixed_mesh *mesh = source->mesh;
    cluster->start[0] = 0;
    for (size_t e = 0; e < cluster->elements; e++) {
        const uint32_t id = cluster->element[e];
        size_t end = cluster->start[e];
        for (size_t i = mesh->start[id]; i < mesh->start[id + 1]; i++)
            cluster->item[end++] = source->local[mesh->item[i]];
        cluster->start[e + 1] = end;
        cluster->threshold[e] = tm_threshold_of(source->options, id);
        cluster->before[e] = cluster->jens[e] = source->jens[id];
    }
}

/* The mean length of the edges at each node that moves; old[v] counts them. Where all
 * have length 0 any will do: such a node has no slope. */
static void measure_sizes(tm_cluster *cluster)
{
    double(*count)[3] = cluster->old;
    for (size_t v = 0; v < cluster->moving; v++)
        cluster->size[v] = count[v][0] = 0;
    for (size_t e = 0; e < cluster->elements; e++) {
        const uint32_t *item = cluster->item + cluster->start[e];
        const tm_element_shape *shape =
            &tm_element_shapes[cluster->start[e + 1] - cluster->start[e]];
        for (size_t i = 0; i < shape->corners; i++) {
            const uint32_t v = item[shape->corner[i][0]];
            for (size_t j = 1; v < cluster->moving && j < 4; j++) {
                const double *to = cluster->xyz[item[shape->corner[i][j]]];
                cluster->size[v] += sqrt(tm_distance2(cluster->xyz[v], to));
                count[v][0]++;
            }
        }
    }
    for (size_t v = 0; v < cluster->moving; v++)
        cluster->size[v] = cluster->size[v] > 0 ? cluster->size[v] / count[v][0] : 1;
}

static void measure_elements(tm_cluster *cluster)
{
    for (size_t e = 0; e < cluster->elements; e++) {
        const uint32_t *item = cluster->item + cluster->start[e];
        const tm_element_shape *shape =
            &tm_element_shapes[cluster->start[e + 1] - cluster->start[e]];
        double sum = 0;
        for (size_t i = 0; i < shape->corners; i++)
            for (size_t j = 1; j < 4; j++)
                sum += sqrt(tm_distance2(cluster->xyz[item[shape->corner[i][0]]],
                                         cluster->xyz[item[shape->corner[i][j]]]));
        cluster->element_size[e] = sum > 0 ? sum / (double)(3 * shape->corners) : 1;
    }
}

/* Where nodes of the boundary are on it, and how far from it those that are off the
 * surface. */
static void find_points(tm_cluster *cluster)
{
    for (size_t v = 0; v < cluster->moving; v++) {
        const tm_node_rule *rule = &cluster->rule[v];
        const double *p = cluster->xyz[v];
        tm_boundary_point *at = &cluster->point[v];
        *at = (tm_boundary_point){.guess = TM_NONE};
        memset(cluster->offset[v], 0, sizeof *cluster->offset);
        tm_cluster_find(cluster, v, p);
        if (rule->off_surface)
            tm_subtract(cluster->offset[v], p, at->xyz);
    }
}

tm_status tm_cluster_gather(tm_cluster *cluster, const tm_cluster_source *source,
                            const uint32_t *core, size_t cores, unsigned rings,
                            tm_error *error)
{
    const size_t old_nodes = cluster->node_room, old_elements = cluster->element_room;
    cluster->boundary = source->boundary;
    cluster->nodes = cluster->elements = cluster->moving = 0;
    bool made = gather_moving(cluster, source, core, cores, rings) &&
                gather_elements(cluster, source) &&
                make_room(cluster, old_nodes, old_elements);
    if (made && cluster->moving > 0) {
        for (size_t v = 0; v < cluster->nodes; v++)
            memcpy(cluster->xyz[v], source->mesh->xyz[cluster->node[v]],
                   sizeof *cluster->xyz);
        for (size_t v = 0; v < cluster->moving; v++)
            cluster->rule[v] = source->rule[cluster->node[v]];
        copy_elements(cluster, source);
        measure_sizes(cluster);
        measure_elements(cluster);
        find_points(cluster);
        memcpy(cluster->best, cluster->xyz, cluster->moving * sizeof *cluster->best);
        cluster->first = cluster->best_score = tm_cluster_score(cluster);
    }
    for (size_t v = 0; v < cluster->nodes; v++)
        source->local[cluster->node[v]] = TM_NONE;
    for (size_t e = 0; e < cluster->elements; e++)
        source->taken[cluster->element[e]] = false;
    return made ? TM_OK : tm_fail_memory(error);
}

void tm_cluster_approach(tm_cluster *cluster, size_t v, double factor, double threshold)
{
    for (size_t e = 0; e < cluster->elements; e++) {
        cluster->threshold[e] = fmin(cluster->threshold[e], threshold);
        cluster->jens[e] = cluster->before[e];
    }
    cluster->first = cluster->best_score = tm_cluster_score(cluster);
    cluster->best_score.bad++; /* as it is now would do */
    if (cluster->first.bad == 0)
        cluster->best_score.worst = -INFINITY;
    for (size_t i = 0; i < 3; i++) {
        cluster->offset[v][i] *= factor;
        cluster->xyz[v][i] = cluster->point[v].xyz[i] + cluster->offset[v][i];
    }
}

void tm_cluster_free(tm_cluster *cluster)
{
    free(cluster->node);
    free(cluster->xyz);
    free(cluster->rule);
    free(cluster->point);
    free(cluster->offset);
    free(cluster->size);
    free(cluster->old);
    free(cluster->old_point);
    free(cluster->best);
    free(cluster->pull);
    free(cluster->vector);
    free(cluster->element);
    free(cluster->start);
    free(cluster->item);
    free(cluster->threshold);
    free(cluster->before);
    free(cluster->jens);
    free(cluster->corner);
    free(cluster->element_size);
    *cluster = (tm_cluster){0};
}
