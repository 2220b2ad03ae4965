/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "repair_share.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../examine/ranks/parts.h"
#include "../../mesh/mixed_boundary.h"
#include "../../ranks/post.h"
#include "../repair/repair_boundary.h"
#include "../repair/repair_steps.h"

#include <stdlib.h>
#include <string.h>

/* Gives the elements the numbers that the stream has for their nodes, which are borrowed
 * from it. */
static void give_back(const tm_repair_share *s)
{
    const size_t items = s->number ? s->mesh.start[s->mesh.elements] : 0;
    for (size_t i = 0; i < items; i++)
        s->mesh.item[i] = s->number[s->mesh.item[i]];
}

static tm_status take_elements(tm_repair_share *s, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh;
    mesh->elements = s->mix->count;
    mesh->start = s->mix->start;
    mesh->item = s->mix->item;
    return tm_slices_take_nodes(s->slices, mesh->item, mesh->start[mesh->elements],
                                &s->number, &mesh->nodes, &mesh->xyz, error);
}

/* Of the whole mesh; nodes that are off the surface are not known yet. */
static tm_status measure(tm_repair_share *s, double threshold, tm_error *error)
{
    tm_repair_state state = {.mesh = s->mesh};
    state.rule = calloc(s->mesh.nodes + 1, sizeof *state.rule);
    const tm_status status = tm_ranks_enough(state.rule, error);
    if (status == TM_OK)
        s->score = tm_repair_measure(&state, threshold);
    free(state.rule);
    tm_ranks_sum(&s->score.invalid, 1);
    tm_ranks_sum(&s->score.bad, 1);
    tm_ranks_least(&s->score.worst, 1);
    tm_ranks_least(&s->score.least, 1);
    return status;
}

static bool has_node_twice(const tm_block *mix)
{
    for (size_t e = 0; e < mix->count; e++)
        if (tm_has_node_twice(mix->item + mix->start[e],
                              mix->start[e + 1] - mix->start[e]))
            return true;
    return false;
}

tm_status tm_repair_share_take(tm_repair_share *share, tm_slices *slices,
                               double threshold, unsigned threads, bool *can,
                               tm_error *error)
{
    tm_slice node, mix;
    *share = (tm_repair_share){.slices = slices, .mesh.threads = threads};
    share->node = tm_slices_find(slices, ".node", &node);
    share->mix = tm_slices_find(slices, ".mix", &mix);
    *can = share->node && share->mix && mix.total > 0 &&
           !tm_ranks_any(has_node_twice(share->mix));
    if (!*can)
        return TM_OK;
    share->nodes = node.total;
    share->elements = mix.total;
    const tm_status status = take_elements(share, error);
    return status == TM_OK ? measure(share, threshold, error) : status;
}

void tm_repair_share_free(tm_repair_share *share)
{
    give_back(share);
    free(share->mesh.xyz);
    free(share->number);
    free(share->rule);
    free(share->on);
    *share = (tm_repair_share){0};
}

bool tm_repair_share_is_needed(const tm_repair_share *share)
{
    const bool surface = tm_stream_find(&share->slices->stream, "surface.node");
    return tm_ranks_any(surface && !tm_repair_says_none_held(share->node)) ||
           share->score.bad > 0;
}

/* Marks the nodes of the boundary that this rank has, of what is at its nodes. */
static tm_status put_boundary(tm_post *post, const tm_repair_share *s,
                              const tm_element_part *part, tm_error *error)
{
    const tm_mixed_mesh mesh = {.nodes = part->nodes.set.count,
                                .elements = part->view.elements,
                                .start = (size_t *)part->view.start,
                                .item = (uint32_t *)part->view.item,
                                .threads = s->mesh.threads};
    const tm_rows rows = tm_rows_of(s->nodes);
    uint32_t *face;
    size_t faces;
    const tm_status status = tm_mixed_boundary_faces(&mesh, &face, &faces, error);
    for (size_t f = 0; status == TM_OK && f < faces; f++) {
        uint32_t node[4], least = TM_NONE;
        const size_t k = tm_mixed_face_of(&mesh, face[f], node);
        for (size_t i = 0; i < k; i++)
            least = node[i] < least ? node[i] : least;
        for (size_t i = 0; i < k && tm_rows_have(&rows, part->nodes.number[least]); i++) {
            const uint32_t n = part->nodes.number[node[i]];
            tm_post_put(post, tm_rows_owner(&rows, n), &n, 1);
        }
    }
    free(face);
    return status;
}

/* Marks the nodes that came. */
static tm_status mark_posted(const tm_repair_share *s, tm_post *post, bool *where,
                             tm_error *error)
{
    const size_t before = tm_rows_of(s->nodes).first;
    uint32_t *got;
    size_t count;
    const tm_status status = tm_post_deliver(post, &got, &count, error);
    for (size_t i = 0; status == TM_OK && i < count; i++)
        where[got[i] - before] = true;
    free(got);
    return status;
}

/* What is at the nodes of this rank, for which elements go to others by the numbers of
 * the stream. */
static tm_status make_part(tm_repair_share *s, tm_element_part *part, tm_error *error)
{
    tm_mixed_mesh *mesh = &s->mesh;
    const tm_element_slices slices = {
        .own = {.elements = mesh->elements, .start = mesh->start, .item = mesh->item},
        .nodes = s->nodes,
        .elements = s->elements};
    int8_t *sign = calloc(mesh->elements + 1, sizeof *sign);
    tm_status status = tm_ranks_enough(sign, error);
    give_back(s);
    free(s->number);
    s->number = NULL;
    if (status == TM_OK)
        status = tm_element_part_make(part, &slices, sign, error);
    free(sign);
    if (status == TM_OK)
        status =
            tm_ranks_agree(tm_slices_localize(mesh->item, mesh->start[mesh->elements],
                                              &s->number, &mesh->nodes, error),
                           error);
    return status;
}

/* Marks the nodes of the boundary: where[rows of .node]. */
static tm_status find_boundary(tm_repair_share *s, bool *where, tm_error *error)
{
    tm_element_part part = {0};
    tm_post post = {0};
    tm_status status = make_part(s, &part, error);
    if (status == TM_OK)
        status = tm_ranks_agree(put_boundary(&post, s, &part, error), error);
    tm_element_part_free(&part);
    return status == TM_OK ? mark_posted(s, &post, where, error) : status;
}

tm_status tm_repair_share_prepare(tm_repair_share *share, const tm_surface *surface,
                                  bool *can, tm_error *error)
{
    const tm_block *node = share->node;
    const double(*xyz)[3] = (const double(*)[3])node->real;
    bool *where = calloc(node->count + 1, sizeof *where);
    share->rule = tm_new(node->count, sizeof *share->rule);
    share->on = tm_new(node->count, sizeof *share->on);
    tm_status status = tm_ranks_enough(where && share->rule && share->on, error);
    if (status == TM_OK)
        status = find_boundary(share, where, error);
    share->attributed =
        status == TM_OK && !tm_ranks_any(!tm_repair_are_places(node, where));
    *can = share->attributed || share->mix->attributes == 0;
    if (status == TM_OK && *can)
        status = tm_ranks_agree(
            tm_repair_find_rules(surface, node->count, xyz,
                                 share->attributed ? node->attribute : NULL, where,
                                 share->rule, share->on, error),
            error);
    free(where);
    for (size_t v = 0; status == TM_OK && *can && v < node->count; v++)
        share->score.off_surface += share->rule[v].off_surface;
    tm_ranks_sum(&share->score.off_surface, 1);
    return status;
}
