/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "rows.h"

#include "../../base/array.h"
#include "packet.h"

#include <stdlib.h>
#include <string.h>

typedef struct row {
    uint32_t number; /* of all rows */
    uint32_t node[3];
    int32_t marker;
} row;

/* Rows to the home of their first node. */
static tm_status send_home(const tm_tet_share *share, const tm_block *block,
                           size_t before, row **got, size_t *count, tm_error *error)
{
    const size_t width = tm_block_integers(block->kind);
    row *rows = calloc(block->count + 1, sizeof *rows);
    unsigned *to = tm_new(block->count, sizeof *to);
    tm_mail mail = {0};
    void *came = NULL;
    for (size_t k = 0; k < block->count && rows && to; k++) {
        rows[k].number = (uint32_t)(before + k);
        memcpy(rows[k].node, block->integer + width * k, width * sizeof(uint32_t));
        rows[k].marker = block->marker ? block->marker[k] : 0;
        to[k] = tm_rank_of(share->home, rows[k].node[0]);
    }
    tm_status status = tm_ranks_enough(rows && to, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, block->count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, rows, sizeof *rows, &came, error);
    *got = came;
    *count = mail.got;
    tm_mail_free(&mail);
    free(rows);
    free(to);
    return status;
}

/* From the home to all ranks that have the first node. */
static tm_status send_on(const tm_tet_share *share, const tm_share_book *book, row **rows,
                         size_t *count, tm_error *error)
{
    const size_t first = share->home[tm_rank()];
    size_t all = 0, k = 0;
    for (size_t i = 0; i < *count; i++) {
        const size_t v = (*rows)[i].node[0] - first;
        all += book->start[v + 1] - book->start[v];
    }
    row *copies = tm_new(all, sizeof *copies);
    unsigned *to = tm_new(all, sizeof *to);
    tm_mail mail = {0};
    void *came = NULL;
    for (size_t i = 0; i < *count && copies && to; i++) {
        const size_t v = (*rows)[i].node[0] - first;
        for (size_t j = book->start[v]; j < book->start[v + 1]; j++) {
            copies[k] = (*rows)[i];
            to[k++] = book->rank[j];
        }
    }
    tm_status status = tm_ranks_enough(copies && to, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, all, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, copies, sizeof *copies, &came, error);
    free(*rows);
    *rows = came;
    *count = mail.got;
    tm_mail_free(&mail);
    free(copies);
    free(to);
    return status;
}

/* The rank's own tetrahedra at each node. */
typedef struct at_nodes {
    size_t *start; /* [nodes + 1] */
    uint32_t *tet;
} at_nodes;

static bool list_at_nodes(at_nodes *at, const tm_tet_share *share)
{
    const tm_tet_mesh *mesh = &share->mesh;
    at->start = calloc(mesh->nodes + 2, sizeof *at->start);
    at->tet = tm_new(4 * mesh->slots, sizeof *at->tet);
    if (!at->start || !at->tet)
        return false;
    for (uint32_t h = 0; h < 4 * mesh->slots; h++)
        at->start[mesh->tet[h / 4][h % 4] + 2] += share->own[h / 4];
    for (size_t v = 0; v < mesh->nodes; v++)
        at->start[v + 2] += at->start[v + 1];
    for (uint32_t h = 0; h < 4 * mesh->slots; h++)
        if (share->own[h / 4])
            at->tet[at->start[mesh->tet[h / 4][h % 4] + 1]++] = h / 4;
    return true;
}

/* Makes the row's nodes those of the share; whether they are of one of its own
 * tetrahedra. */
static bool is_own(const tm_tet_share *share, const at_nodes *at, row *r, size_t width)
{
    const tm_tet_mesh *mesh = &share->mesh;
    for (size_t i = 0; i < width; i++) {
        const size_t v = tm_first_not_below(share->number, mesh->nodes, r->node[i]);
        if (v == mesh->nodes || share->number[v] != r->node[i])
            return false;
        r->node[i] = (uint32_t)v;
    }
    for (size_t k = at->start[r->node[0]]; k < at->start[r->node[0] + 1]; k++) {
        const uint32_t *n = mesh->tet[at->tet[k]];
        size_t found = 0;
        for (size_t i = 0; i < width; i++)
            for (int c = 0; c < 4; c++)
                found += n[c] == r->node[i];
        if (found == width)
            return true;
    }
    return false;
}

static bool has_node_twice(const row *r, size_t width)
{
    for (size_t i = 0; i < width; i++)
        for (size_t j = 0; j < i; j++)
            if (r->node[i] == r->node[j])
                return true;
    return false;
}

/* Keeps the rows of own tetrahedra, with nodes of the share. */
static tm_status claim(const tm_tet_share *share, row *rows, size_t *count, size_t width,
                       bool *can, tm_error *error)
{
    at_nodes at = {0};
    size_t kept = 0;
    const bool done = list_at_nodes(&at, share);
    for (size_t k = 0; k < *count && done; k++) {
        if (has_node_twice(&rows[k], width))
            *can = false;
        else if (is_own(share, &at, &rows[k], width))
            rows[kept++] = rows[k];
    }
    *count = kept;
    free(at.start);
    free(at.tet);
    return tm_ranks_enough(done, error);
}

/* Whether some rank has claimed each of `total` rows. */
static tm_status are_all_claimed(const row *rows, size_t count, size_t total, bool *all,
                                 tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t first = tm_slice_first(total, ranks, tm_rank());
    const size_t past = tm_slice_first(total, ranks, tm_rank() + 1);
    unsigned *to = tm_new(count, sizeof *to);
    uint32_t *number = tm_new(count, sizeof *number);
    bool *claimed = calloc(past - first + 1, sizeof *claimed);
    tm_mail mail = {0};
    void *got = NULL;
    for (size_t k = 0; k < count && to && number; k++) {
        to[k] = tm_slice_owner(total, ranks, rows[k].number);
        number[k] = rows[k].number;
    }
    const bool done = to && number && claimed;
    tm_status status = tm_ranks_enough(done, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, number, sizeof *number, &got, error);
    for (size_t k = 0; k < mail.got && status == TM_OK; k++)
        claimed[((const uint32_t *)got)[k] - first] = true;
    for (size_t k = 0; k < past - first && status == TM_OK; k++)
        *all &= claimed[k];
    tm_mail_free(&mail);
    free(to);
    free(number);
    free(claimed);
    free(got);
    return status;
}

/* The rows of a block that the rank has a use for. */
static tm_status take_block(const tm_tet_share *share, const tm_slices *slices,
                            const char *name, const tm_share_book *book, row **rows,
                            size_t *count, size_t *total, bool *can, tm_error *error)
{
    tm_slice slice;
    const tm_block *block = tm_slices_find(slices, name, &slice);
    *rows = NULL;
    *count = *total = 0;
    if (!block)
        return TM_OK;
    *total = slice.total;
    tm_status status = send_home(share, block, slice.before, rows, count, error);
    if (status == TM_OK)
        status = send_on(share, book, rows, count, error);
    if (status == TM_OK)
        status = claim(share, *rows, count, tm_block_integers(block->kind), can, error);
    if (status == TM_OK)
        status = are_all_claimed(*rows, *count, slice.total, can, error);
    return status;
}

static tm_status take_faces(tm_tet_share *share, const tm_slices *slices,
                            const tm_share_book *book, size_t *faces, bool *can,
                            tm_error *error)
{
    tm_tet_mesh *mesh = &share->mesh;
    row *rows;
    size_t count;
    tm_status status =
        take_block(share, slices, ".face", book, &rows, &count, faces, can, error);
    if (status == TM_OK)
        status = tm_tet_mesh_reserve(mesh, 0, 0, count, 0, error);
    for (size_t k = 0; k < count && status == TM_OK; k++) {
        tm_constrained_face *face = &mesh->face[mesh->faces++];
        *face = (tm_constrained_face){
            .side = {TM_NONE, TM_NONE}, .marker = rows[k].marker, .listed = true};
        memcpy(face->node, rows[k].node, sizeof face->node);
    }
    free(rows);
    return tm_ranks_agree(status, error);
}

static tm_status take_edges(tm_tet_share *share, const tm_slices *slices,
                            const tm_share_book *book, bool *can, tm_error *error)
{
    tm_tet_mesh *mesh = &share->mesh;
    row *rows;
    size_t count, total;
    tm_status status =
        take_block(share, slices, ".edge", book, &rows, &count, &total, can, error);
    if (status == TM_OK)
        status = tm_tet_mesh_reserve(mesh, 0, 0, 0, count, error);
    for (size_t k = 0; k < count && status == TM_OK; k++) {
        const uint32_t *n = rows[k].node;
        *can &= !tm_tet_mesh_edge(mesh, n[0], n[1]);
        tm_edge_map_put(&mesh->edge_of, n[0], n[1], (uint32_t)mesh->edges);
        mesh->edge[mesh->edges++] = (tm_marked_edge){{n[0], n[1]}, rows[k].marker, false};
    }
    free(rows);
    const tm_block *block = tm_stream_find(&slices->stream, ".edge");
    mesh->edge_markers = block && block->markers;
    return tm_ranks_agree(status, error);
}

tm_status tm_share_take_rows(tm_tet_share *share, const tm_slices *slices,
                             const tm_share_book *book, size_t *faces, bool *can,
                             tm_error *error)
{
    const tm_status status = take_faces(share, slices, book, faces, can, error);
    return status == TM_OK ? take_edges(share, slices, book, can, error) : status;
}

/* The locked edges of own tetrahedra, by numbers of the whole mesh. */
static bool list_locked(const tm_tet_share *share, tm_edge_map *edges)
{
    const tm_tet_mesh *mesh = &share->mesh;
    for (size_t k = 0; k < 6 * mesh->slots && mesh->locked.count > 0; k++) {
        const uint32_t *n = mesh->tet[k / 6];
        const uint8_t *end = tm_packed_edge_end[k % 6];
        if (!share->own[k / 6] || !tm_edge_map_get(&mesh->locked, n[end[0]], n[end[1]]))
            continue;
        if (!tm_edge_map_reserve(edges, 1))
            return false;
        tm_edge_map_put(edges, share->number[n[end[0]]], share->number[n[end[1]]], 0);
    }
    return true;
}

tm_status tm_share_count_locked(const tm_tet_share *share, size_t *locked,
                                tm_error *error)
{
    tm_edge_map edges = {0};
    uint64_t *key = NULL;
    unsigned *to = NULL;
    tm_mail mail = {0};
    void *got = NULL;
    size_t count = 0;
    bool done = list_locked(share, &edges);
    key = tm_new(edges.count, sizeof *key);
    to = tm_new(edges.count, sizeof *to);
    done &= key && to;
    for (size_t s = 0; s < edges.room && done; s++)
        if (edges.slot[s].key != 0) {
            to[count] = tm_rank_of(share->home, edges.slot[s].key >> 32);
            key[count++] = edges.slot[s].key;
        }
    tm_edge_map_free(&edges);
    tm_status status = tm_ranks_enough(done, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, key, sizeof *key, &got, error);
    for (size_t k = 0; k < mail.got && status == TM_OK; k++) {
        const uint64_t came = ((const uint64_t *)got)[k];
        if (tm_edge_map_reserve(&edges, 1))
            tm_edge_map_put(&edges, (uint32_t)(came >> 32), (uint32_t)came, 0);
        else
            status = tm_fail_memory(error);
    }
    *locked = edges.count;
    tm_ranks_sum(locked, 1);
    tm_edge_map_free(&edges);
    tm_mail_free(&mail);
    free(key);
    free(to);
    free(got);
    return tm_ranks_agree(status, error);
}
