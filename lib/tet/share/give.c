/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A share becomes slices of rows. */
#include "take.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

/* A node for its home. */
typedef struct homing {
    double xyz[3];
    uint32_t number;
    int32_t marker;
} homing;

typedef struct giving {
    tm_tet_share *share;
    tm_slices *slices;
    uint32_t *number; /* [nodes]: what numbers they get */
    tm_error *error;
} giving;

/* All blocks ----------------------------------------------------------------------- */

/* Block `name` gets rows that the ranks have one after the other; they go to their
 * slices. */
static tm_status put_rows(const giving *give, const char *name, tm_error *error)
{
    tm_slices *slices = give->slices;
    tm_block *block = tm_stream_find(&slices->stream, name);
    const size_t b = (size_t)(block - slices->stream.block);
    tm_slice *slice = &slices->slice[b];
    slice->before = tm_ranks_before(block->count, &slice->total);
    return tm_slices_even(slices, b, error);
}

/* Nodes ---------------------------------------------------------------------------- */

/* Number v of the list is node v of the share, then come the loose ones. */
typedef struct node_list {
    size_t count;
    unsigned *to;
    homing *node;
    double *attribute;
    uint32_t *at; /* of the share; TM_NONE: a loose one */
} node_list;

static void add_nodes(node_list *list, const giving *give, const tm_tet_mesh *mesh,
                      const uint32_t *number, bool loose)
{
    const size_t width = mesh->node_attributes;
    for (uint32_t v = 0; v < mesh->nodes; v++) {
        if (!tm_node_lives(mesh, v))
            continue;
        homing *node = &list->node[list->count];
        *node = (homing){.number = number[v],
                         .marker = mesh->node_marker ? mesh->node_marker[v] : 0};
        memcpy(node->xyz, mesh->xyz[v], sizeof node->xyz);
        if (width > 0)
            memcpy(list->attribute + width * list->count,
                   mesh->node_attribute + width * v, width * sizeof(double));
        list->at[list->count] = loose ? TM_NONE : v;
        list->to[list->count++] = tm_rank_of(give->share->home, number[v]);
    }
}

static bool list_nodes(node_list *list, const giving *give)
{
    const tm_tet_share *share = give->share;
    const size_t all = share->mesh.nodes + share->loose_nodes.nodes;
    *list = (node_list){0};
    list->to = tm_new(all, sizeof *list->to);
    list->node = tm_new(all, sizeof *list->node);
    list->attribute = tm_new(all * share->loose_nodes.node_attributes, sizeof(double));
    list->at = tm_new(all, sizeof *list->at);
    if (!list->to || !list->node || !list->attribute || !list->at)
        return false;
    add_nodes(list, give, &share->mesh, share->number, false);
    add_nodes(list, give, &share->loose_nodes, share->loose_number, true);
    return true;
}

/* At home: the rows of .node in the order of their numbers; answer[k] is the number that
 * the k-th of those that came gets. */
static bool make_nodes(const giving *give, tm_block *block, const homing *got,
                       const double *attribute, size_t count, uint32_t *answer)
{
    const size_t first = give->share->home[tm_rank()], width = block->attributes;
    const size_t nodes = give->share->home[tm_rank() + 1] - first;
    uint32_t *row = tm_new(nodes, sizeof *row);
    size_t rows = 0;
    for (size_t v = 0; v < nodes && row; v++)
        row[v] = TM_NONE;
    for (size_t k = 0; k < count && row; k++)
        row[got[k].number - first] = 0;
    for (size_t v = 0; v < nodes && row; v++)
        if (row[v] == 0)
            row[v] = (uint32_t)rows++;
    const size_t before = tm_ranks_before(rows, NULL);
    tm_error error;
    const bool done = row && tm_block_allocate(block, rows, 0, &error) == TM_OK;
    for (size_t k = 0; k < count && done; k++) {
        const size_t r = row[got[k].number - first];
        memcpy(block->real + 3 * r, got[k].xyz, sizeof got[k].xyz);
        if (block->marker)
            block->marker[r] = got[k].marker;
        if (width > 0)
            memcpy(block->attribute + width * r, attribute + width * k,
                   width * sizeof(double));
        answer[k] = (uint32_t)(before + r);
    }
    free(row);
    return done;
}

/* Takes the numbers that the nodes of the list get. */
static bool take_numbers(giving *give, const node_list *list, const uint32_t *number)
{
    give->number = tm_new(give->share->mesh.nodes, sizeof *give->number);
    for (size_t k = 0; k < list->count && give->number; k++)
        if (list->at[k] != TM_NONE)
            give->number[list->at[k]] = number[k];
    return give->number;
}

/* Sends the nodes of the list home, and gets their numbers. */
static tm_status send_nodes(giving *give, const node_list *list, tm_block *block)
{
    tm_error *error = give->error;
    tm_mail mail;
    void *got = NULL, *attribute = NULL, *number = NULL;
    uint32_t *answer = NULL;
    tm_status status = tm_mail_address(&mail, list->to, list->count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, list->node, sizeof *list->node, &got, error);
    if (status == TM_OK && block->attributes > 0)
        status = tm_mail_send(&mail, list->attribute, block->attributes * sizeof(double),
                              &attribute, error);
    if (status == TM_OK) {
        answer = tm_new(mail.got, sizeof *answer);
        bool done = !tm_ranks_any(!answer);
        done = done && make_nodes(give, block, got, attribute, mail.got, answer);
        status = tm_ranks_enough(done, error);
    }
    free(got);
    free(attribute);
    if (status == TM_OK)
        status = tm_mail_answer(&mail, answer, sizeof *answer, &number, error);
    if (status == TM_OK && !take_numbers(give, list, number))
        status = tm_fail_memory(error);
    free(answer);
    free(number);
    tm_mail_free(&mail);
    return tm_ranks_agree(status, error);
}

static tm_status give_nodes(giving *give)
{
    node_list list;
    tm_block *block = tm_stream_find(&give->slices->stream, ".node");
    tm_status status = list_nodes(&list, give) ? TM_OK : tm_fail_memory(give->error);
    status = tm_ranks_agree(status, give->error);
    if (status == TM_OK)
        status = send_nodes(give, &list, block);
    free(list.to);
    free(list.node);
    free(list.attribute);
    free(list.at);
    return status == TM_OK ? put_rows(give, ".node", give->error) : status;
}

/* Tetrahedra ----------------------------------------------------------------------- */

static tm_status give_tets(const giving *give)
{
    tm_tet_mesh *mesh = &give->share->mesh;
    tm_block *block = tm_stream_find(&give->slices->stream, ".ele");
    tm_block_clear(block);
    free(mesh->neighbour);
    mesh->neighbour = NULL;
    for (size_t t = 0; t < mesh->slots; t++)
        for (int i = 0; i < 4; i++)
            mesh->tet[t][i] = give->number[mesh->tet[t][i]];
    block->count = mesh->slots;
    block->integer = (uint32_t *)mesh->tet;
    block->attribute = mesh->region;
    mesh->tet = NULL;
    mesh->region = NULL;
    mesh->slots = mesh->tets = 0;
    return put_rows(give, ".ele", give->error);
}

/* Faces ---------------------------------------------------------------------------- */

/* A row with its nodes in ascending order. */
typedef struct sorted_row {
    uint32_t key[3];
    uint32_t node[3];
    int32_t marker;
} sorted_row;

static int compare(const void *a, const void *b)
{
    const sorted_row *f = a, *g = b;
    for (int i = 0; i < 3; i++)
        if (f->key[i] != g->key[i])
            return f->key[i] < g->key[i] ? -1 : 1;
    return 0;
}

/* The listed faces from first to past - 1. */
static sorted_row *list_faces(const giving *give, size_t first, size_t past,
                              size_t *count)
{
    const tm_tet_mesh *mesh = &give->share->mesh;
    sorted_row *rows = tm_new(past - first, sizeof *rows);
    *count = 0;
    for (size_t f = first; f < past && rows; f++) {
        const tm_constrained_face *face = &mesh->face[f];
        if (!face->listed)
            continue;
        sorted_row *r = &rows[(*count)++];
        r->marker = face->marker;
        for (int i = 0; i < 3; i++)
            r->node[i] = r->key[i] = give->number[face->node[i]];
        qsort(r->key, 3, sizeof *r->key, tm_compare_numbers);
    }
    return rows;
}

/* The faces of all ranks, those at each rank's nodes, sorted; what two ranks have is one.
 */
static tm_status sort_faces(const giving *give, sorted_row **rows, size_t *count)
{
    tm_slice slice;
    tm_slices_find(give->slices, ".node", &slice);
    unsigned *to = tm_new(*count, sizeof *to);
    tm_mail mail = {0};
    void *came = NULL;
    tm_error *error = give->error;
    for (size_t k = 0; k < *count && to; k++)
        to[k] = tm_slice_owner(slice.total, tm_ranks_count(), (*rows)[k].key[0]);
    tm_status status = tm_ranks_enough(to, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, *count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, *rows, sizeof **rows, &came, error);
    free(*rows);
    free(to);
    sorted_row *got = *rows = came;
    *count = 0;
    if (status == TM_OK)
        qsort(got, mail.got, sizeof *got, compare);
    for (size_t k = 0; k < mail.got && status == TM_OK; k++)
        if (*count == 0 || compare(&got[k], &got[*count - 1]) != 0)
            got[(*count)++] = got[k];
    tm_mail_free(&mail);
    return status;
}

/* Rows as the block has them. */
static tm_status fill_block(tm_block *block, const sorted_row *rows, size_t count,
                            size_t width, tm_error *error)
{
    const tm_status status = tm_block_allocate(block, count, 0, error);
    for (size_t k = 0; k < count && status == TM_OK; k++) {
        memcpy(block->integer + width * k, rows[k].node, width * sizeof(uint32_t));
        if (block->marker)
            block->marker[k] = rows[k].marker;
    }
    return tm_ranks_agree(status, error);
}

/* Rows of a block with `total` rows, from number `before` on, to its slices: appends what
 * comes to got[]. */
static tm_status send_rows(const sorted_row *rows, size_t count, size_t before,
                           size_t total, sorted_row **got, size_t *got_count,
                           tm_error *error)
{
    unsigned *to = tm_new(count, sizeof *to);
    tm_mail mail = {0};
    void *came = NULL;
    for (size_t k = 0; k < count && to; k++)
        to[k] = tm_slice_owner(total, tm_ranks_count(), before + k);
    tm_status status = tm_ranks_enough(to, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, rows, sizeof *rows, &came, error);
    if (status == TM_OK) {
        sorted_row *all = realloc(*got, (*got_count + mail.got + 1) * sizeof *all);
        if (all) {
            *got = all;
            memcpy(all + *got_count, came, mail.got * sizeof *all);
            *got_count += mail.got;
        }
        status = tm_ranks_enough(all, error);
    }
    tm_mail_free(&mail);
    free(to);
    free(came);
    return status;
}

/* Those inside of parts, as the parts come; then the others, by their nodes. */
static tm_status give_faces(const giving *give, size_t inner_faces)
{
    tm_error *error = give->error;
    tm_block *block = tm_stream_find(&give->slices->stream, ".face");
    if (!block)
        return TM_OK;
    size_t inner_count, other_count, count = 0, inner_all, other_all;
    sorted_row *inner = list_faces(give, 0, inner_faces, &inner_count), *got = NULL;
    sorted_row *other =
        list_faces(give, inner_faces, give->share->mesh.faces, &other_count);
    tm_status status = tm_ranks_enough(inner && other, error);
    if (status == TM_OK)
        status = sort_faces(give, &other, &other_count);
    if (status == TM_OK) {
        const size_t before = tm_ranks_before(inner_count, &inner_all);
        const size_t others_before = tm_ranks_before(other_count, &other_all);
        const size_t total = inner_all + other_all;
        status = send_rows(inner, inner_count, before, total, &got, &count, error);
        if (status == TM_OK)
            status = send_rows(other, other_count, inner_all + others_before, total, &got,
                               &count, error);
    }
    if (status == TM_OK)
        status = fill_block(block, got, count, 3, error);
    free(inner);
    free(other);
    free(got);
    return status == TM_OK ? put_rows(give, ".face", error) : status;
}

/* Edges ---------------------------------------------------------------------------- */

/* Each edge to one rank, by its key; (*keep)[k]: no rank before this one has it. */
static tm_status ask_for_edges(const giving *give, const sorted_row *rows, size_t count,
                               bool **keep)
{
    tm_error *error = give->error;
    unsigned *to = tm_new(count, sizeof *to);
    tm_edge_map known = {0};
    tm_mail mail = {0};
    void *came = NULL, *answer = NULL;
    for (size_t k = 0; k < count && to; k++)
        to[k] = rows[k].key[0] % tm_ranks_count();
    tm_status status = tm_ranks_enough(to, error);
    if (status == TM_OK)
        status = tm_mail_address(&mail, to, count, error);
    if (status == TM_OK)
        status = tm_mail_send(&mail, rows, sizeof *rows, &came, error);
    bool *first = status == TM_OK ? tm_new(mail.got, sizeof *first) : NULL;
    bool done = first && tm_edge_map_reserve(&known, mail.got);
    for (size_t k = 0; k < mail.got && done; k++) {
        const uint32_t *key = ((const sorted_row *)came)[k].key;
        first[k] = !tm_edge_map_get(&known, key[0], key[1]);
        tm_edge_map_put(&known, key[0], key[1], 0);
    }
    if (status == TM_OK)
        status = tm_ranks_enough(done, error);
    if (status == TM_OK)
        status = tm_mail_answer(&mail, first, sizeof *first, &answer, error);
    *keep = answer;
    tm_edge_map_free(&known);
    tm_mail_free(&mail);
    free(to);
    free(came);
    free(first);
    return status;
}

static sorted_row *list_edges(const giving *give, size_t *count)
{
    const tm_tet_mesh *mesh = &give->share->mesh;
    sorted_row *rows = tm_new(mesh->edges, sizeof *rows);
    *count = 0;
    for (size_t e = 0; e < mesh->edges && rows; e++) {
        if (mesh->edge[e].gone)
            continue;
        sorted_row *r = &rows[(*count)++];
        *r = (sorted_row){.marker = mesh->edge[e].marker};
        for (int i = 0; i < 2; i++)
            r->node[i] = give->number[mesh->edge[e].node[i]];
        r->key[0] = r->node[0] < r->node[1] ? r->node[0] : r->node[1];
        r->key[1] = r->node[0] < r->node[1] ? r->node[1] : r->node[0];
    }
    return rows;
}

/* As the parts come. */
static tm_status give_edges(const giving *give)
{
    tm_error *error = give->error;
    tm_block *block = tm_stream_find(&give->slices->stream, ".edge");
    if (!block)
        return TM_OK;
    size_t count, kept = 0;
    bool *keep = NULL;
    sorted_row *rows = list_edges(give, &count);
    tm_status status = tm_ranks_enough(rows, error);
    if (status == TM_OK)
        status = ask_for_edges(give, rows, count, &keep);
    for (size_t k = 0; k < count && status == TM_OK; k++)
        if (keep[k])
            rows[kept++] = rows[k];
    if (status == TM_OK)
        status = fill_block(block, rows, kept, 2, error);
    free(rows);
    free(keep);
    return status == TM_OK ? put_rows(give, ".edge", error) : status;
}

/* All ------------------------------------------------------------------------------ */

tm_status tm_tet_share_give(tm_tet_share *share, size_t inner_faces, tm_slices *slices,
                            tm_error *error)
{
    giving give = {.share = share, .slices = slices, .error = error};
    tm_status status = give_nodes(&give);
    if (status == TM_OK)
        status = give_faces(&give, inner_faces);
    if (status == TM_OK)
        status = give_edges(&give);
    if (status == TM_OK)
        status = give_tets(&give);
    free(give.number);
    tm_tet_share_free(share);
    return status;
}
