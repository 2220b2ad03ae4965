/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Slices of rows become a share. */
#include "take.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../geom/predicates.h"
#include "../../stream/coordinates.h"
#include "../connect.h"
#include "rows.h"

#include <stdlib.h>
#include <string.h>

typedef struct taking {
    const tm_slices *slices;
    tm_tet_share *share;
    tm_share_notes *notes;
    bool *can;
    tm_error *error;
} taking;

/* Whether all can go on: not where one has failed, or has met what it leaves to others.
 */
static bool goes_on(const taking *take, tm_status *status)
{
    *status = tm_ranks_agree(*status, take->error);
    *take->can = !tm_ranks_any(!*take->can);
    return *status == TM_OK && *take->can;
}

/* All nodes of the slice are loose at first: no tetrahedron is known. */
static tm_status take_nodes(taking *take)
{
    tm_slice slice;
    const tm_block *block = tm_slices_find(take->slices, ".node", &slice);
    tm_tet_share *share = take->share;
    tm_tet_mesh *to = &share->loose_nodes;
    const unsigned ranks = tm_ranks_count();
    share->home = tm_new(ranks + (size_t)1, sizeof *share->home);
    share->loose_number = tm_new(block->count, sizeof *share->loose_number);
    to->node_attributes = block->attributes;
    to->node_room = block->count;
    to->xyz = tm_new(block->count, sizeof *to->xyz);
    if (block->attributes > 0)
        to->node_attribute = tm_new(block->count * block->attributes, sizeof(double));
    if (block->marker)
        to->node_marker = tm_new(block->count, sizeof *to->node_marker);
    if (!share->home || !share->loose_number || !to->xyz ||
        (block->attributes > 0 && !to->node_attribute) ||
        (block->marker && !to->node_marker))
        return tm_fail_memory(take->error);
    const tm_tet_mesh from = {.xyz = (double(*)[3])block->real,
                              .node_attributes = block->attributes,
                              .node_attribute = block->attribute,
                              .node_marker = block->marker};
    for (uint32_t v = 0; v < block->count; v++) {
        tm_tet_copy_node(to, v, &from, v);
        share->loose_number[v] = (uint32_t)(slice.before + v);
    }
    share->loose = to->nodes = block->count;
    share->all_nodes = slice.total;
    for (unsigned r = 0; r <= ranks; r++)
        share->home[r] = tm_slice_first(slice.total, ranks, r);
    *take->can &= tm_coordinates_check((const double(*)[3])to->xyz, to->nodes, 0,
                                       take->error) == TM_OK;
    return TM_OK;
}

/* The rows of the slice, by numbers of the whole mesh. */
static tm_status take_tets(taking *take)
{
    tm_slice slice;
    const tm_block *block = tm_slices_find(take->slices, ".ele", &slice);
    tm_tet_share *share = take->share;
    tm_tet_mesh *to = &share->mesh;
    const size_t tets = block->count, width = block->attributes;
    to->slots = to->tets = to->slot_room = tets;
    to->regions = width;
    to->tet = tm_new(tets, sizeof *to->tet);
    to->region = width > 0 ? tm_new(tets * width, sizeof *to->region) : NULL;
    share->index = tm_new(tets, sizeof *share->index);
    if (!to->tet || (width > 0 && !to->region) || !share->index)
        return tm_fail_memory(take->error);
    memcpy(to->tet, block->integer, tets * sizeof *to->tet);
    if (width > 0)
        memcpy(to->region, block->attribute, tets * width * sizeof *to->region);
    for (uint32_t t = 0; t < tets; t++) {
        share->index[t] = (uint32_t)slice.before + t;
        *take->can &= !tm_has_node_twice(to->tet[t], TM_TET_NODES);
    }
    share->all_tets = slice.total;
    return TM_OK;
}

/* Gets the nodes that the rows name. */
static tm_status fetch_nodes(taking *take)
{
    tm_tet_share *share = take->share;
    tm_tet_mesh *to = &share->mesh;
    const tm_tet_mesh *from = &share->loose_nodes;
    const size_t width = from->node_attributes;
    tm_error *error = take->error;
    tm_status status = tm_slices_localize((uint32_t *)to->tet, 4 * to->slots,
                                          &share->number, &to->nodes, error);
    const size_t nodes = to->node_room = to->nodes;
    to->node_attributes = width;
    to->xyz = tm_new(nodes, sizeof *to->xyz);
    to->node_attribute = width > 0 ? tm_new(nodes * width, sizeof(double)) : NULL;
    to->node_marker = from->node_marker ? tm_new(nodes, sizeof *to->node_marker) : NULL;
    share->due = tm_new(nodes, sizeof *share->due);
    if (status == TM_OK && (!to->xyz || (width > 0 && !to->node_attribute) ||
                            (from->node_marker && !to->node_marker) || !share->due))
        status = tm_fail_memory(error);
    status = tm_ranks_agree(status, error);
    for (size_t v = 0; v < nodes && status == TM_OK; v++)
        share->due[v] = true;
    if (status == TM_OK)
        status = tm_slices_fetch(from->xyz, share->all_nodes, sizeof *to->xyz,
                                 share->number, nodes, to->xyz, error);
    if (status == TM_OK && width > 0)
        status = tm_slices_fetch(from->node_attribute, share->all_nodes,
                                 width * sizeof(double), share->number, nodes,
                                 to->node_attribute, error);
    if (status == TM_OK && from->node_marker)
        status =
            tm_slices_fetch(from->node_marker, share->all_nodes, sizeof *to->node_marker,
                            share->number, nodes, to->node_marker, error);
    return status;
}

static void count_turned(taking *take)
{
    const tm_tet_mesh *mesh = &take->share->mesh;
    for (size_t t = 0; t < mesh->slots; t++) {
        const uint32_t *n = mesh->tet[t];
        const int sign = tm_orient3d(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                                     mesh->xyz[n[3]]);
        take->notes->flat += sign == 0;
        take->notes->turned += sign < 0;
    }
}

/* Nodes of the slice that some rank has are loose no more. */
static void keep_loose(tm_tet_share *share, const tm_share_book *book)
{
    tm_tet_mesh *mesh = &share->loose_nodes;
    size_t kept = 0;
    for (uint32_t v = 0; v < share->loose; v++) {
        if (book->start[v] < book->start[v + 1])
            continue;
        tm_tet_copy_node(mesh, (uint32_t)kept, mesh, v);
        share->loose_number[kept++] = share->loose_number[v];
    }
    share->loose = mesh->nodes = kept;
}

/* Gets the tetrahedra around, all in the order of the input. */
static tm_status widen(taking *take, tm_share_book *book)
{
    tm_mail mail;
    uint32_t *number;
    tm_tet_share *share = take->share;
    tm_status status = tm_share_book_make(book, share, &mail, &number, take->error);
    if (status == TM_OK) {
        keep_loose(share, book);
        status = tm_share_widen_by(share, book, number, &mail, share->index, share,
                                   take->error);
    }
    tm_mail_free(&mail);
    free(number);
    return status;
}

static tm_status connect(taking *take)
{
    tm_tet_mesh *mesh = &take->share->mesh;
    tm_error error;
    mesh->neighbour = tm_new(mesh->slots, sizeof *mesh->neighbour);
    if (!mesh->neighbour)
        return tm_fail_memory(take->error);
    const tm_status status = tm_tet_mesh_connect(mesh, 0, 1, &error);
    if (status == TM_ERROR_SYSTEM)
        return tm_fail_as(take->error, &error);
    *take->can &= status == TM_OK;
    return TM_OK;
}

/* Of what two ranks have, the one with the first side counts. */
static void count_faces(taking *take, size_t rows)
{
    const tm_tet_share *share = take->share;
    size_t kept = 0;
    for (size_t f = 0; f < share->mesh.faces; f++) {
        const tm_constrained_face *face = &share->mesh.face[f];
        kept += face->listed && share->own[face->side[0] / 4];
    }
    tm_ranks_sum(&kept, 1);
    take->notes->dropped_faces = rows - kept;
}

/* What is one of the whole mesh. */
static void agree_on_mesh(taking *take)
{
    tm_tet_mesh *mesh = &take->share->mesh;
    size_t *counts[] = {&take->notes->flat, &take->notes->turned};
    for (int i = 0; i < 2; i++)
        tm_ranks_sum(counts[i], 1);
    mesh->flat = take->notes->flat;
    mesh->inner_edges = tm_ranks_any(mesh->inner_edges);
    mesh->inner_marked_edges = tm_ranks_any(mesh->inner_marked_edges);
}

static tm_status take_all(taking *take, size_t parts, tm_share_book *book)
{
    tm_tet_share *share = take->share;
    size_t faces = 0;
    tm_status status = take_nodes(take);
    if (status == TM_OK)
        status = take_tets(take);
    if (!goes_on(take, &status))
        return status;
    status = fetch_nodes(take);
    if (status != TM_OK)
        return status;
    count_turned(take);
    status = tm_tet_share_deal_along(share, parts, 0, take->error);
    if (status == TM_OK)
        status = widen(take, book);
    if (status == TM_OK)
        status =
            tm_share_take_rows(share, take->slices, book, &faces, take->can, take->error);
    if (!goes_on(take, &status))
        return status;
    status = connect(take);
    if (!goes_on(take, &status))
        return status;
    count_faces(take, faces);
    agree_on_mesh(take);
    return tm_share_count_locked(share, &take->notes->locked, take->error);
}

tm_status tm_tet_share_take(tm_tet_share *share, const tm_slices *slices, size_t size,
                            tm_share_notes *notes, bool *can, tm_error *error)
{
    tm_slice slice;
    tm_share_book book = {0};
    taking take = {slices, share, notes, can, error};
    const size_t most = (size_t)1 << 30; /* keys of a deal */
    const tm_block *node = tm_stream_find(&slices->stream, ".node");
    const tm_block *ele = tm_slices_find(slices, ".ele", &slice);
    *share = (tm_tet_share){0};
    *notes = (tm_share_notes){0};
    *can = node && ele && slice.total < most;
    if (!*can)
        return TM_OK;
    const tm_status status =
        take_all(&take, tm_tet_parts_count(slice.total, size), &book);
    tm_share_book_free(&book);
    if (status != TM_OK || !*can)
        tm_tet_share_free(share);
    return status;
}
