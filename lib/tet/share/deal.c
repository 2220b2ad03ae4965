/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tetrahedra from rank to rank. */
#include "packet.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_tet_share_free(tm_tet_share *share)
{
    tm_tet_mesh_free(&share->mesh);
    tm_tet_mesh_free(&share->loose_nodes);
    free(share->number);
    free(share->due);
    free(share->index);
    free(share->own);
    free(share->home);
    free(share->loose_number);
    *share = (tm_tet_share){0};
}

void tm_tet_deal_free(tm_tet_deal *deal)
{
    free(deal->count);
    free(deal->tet);
    free(deal->key);
    *deal = (tm_tet_deal){0};
}

/* One list of the packet, that is given back, to its ranks. */
static tm_status exchange(void **list, const size_t *count, size_t size, void **got,
                          size_t *got_count, size_t *all, tm_error *error)
{
    const tm_status status = tm_ranks_exchange(*list, count, size, got, got_count, error);
    free(*list);
    *list = NULL;
    *all = 0;
    for (unsigned r = 0; r < tm_ranks_count(); r++)
        *all += got_count[r];
    return status;
}

#define EXCHANGE(field, list, size)                                                      \
    do {                                                                                 \
        void *given = out->field, *got = NULL;                                           \
        out->field = NULL;                                                               \
        status = exchange(&given, out->count[list], size, &got, in->count[list],         \
                          &in->all[list], error);                                        \
        in->field = got;                                                                 \
        if (status != TM_OK)                                                             \
            return status;                                                               \
    } while (0)

static tm_status exchange_all(packet *out, packet *in, const tm_tet_mesh *like,
                              tm_error *error)
{
    tm_status status;
    EXCHANGE(tet, TETS, sizeof *in->tet);
    EXCHANGE(node, NODES, sizeof *in->node);
    EXCHANGE(face, FACES, sizeof *in->face);
    EXCHANGE(edge, EDGES, sizeof *in->edge);
    if (like->regions > 0)
        EXCHANGE(region, TETS, like->regions * sizeof(double));
    if (like->node_attributes > 0)
        EXCHANGE(attribute, NODES, like->node_attributes * sizeof(double));
    return TM_OK;
}

/* Tetrahedra and their nodes are given away. */
static void empty(tm_tet_share *share)
{
    tm_tet_mesh_free(&share->mesh);
    free(share->number);
    free(share->due);
    free(share->index);
    free(share->own);
    share->number = share->index = NULL;
    share->due = share->own = NULL;
}

tm_status tm_tet_share_deal(tm_tet_share *share, const tm_tet_deal *deal,
                            tm_tet_share *to, tm_error *error)
{
    packet out, in;
    bool done = tm_packet_start(&out);
    done &= tm_packet_start(&in);
    done = done && tm_packet_fill(&out, share, deal);
    const tm_tet_mesh like = share->mesh; /* its pointers are not followed */
    tm_status status = tm_ranks_enough(done, error);
    if (status == TM_OK && to == share)
        empty(share);
    if (status == TM_OK)
        status = exchange_all(&out, &in, &like, error);
    tm_packet_free(&out);
    if (status == TM_OK) {
        tm_tet_share made = {0};
        status = tm_packet_unpack(&in, &like, &made, error);
        to->mesh = made.mesh;
        to->beyond = made.beyond;
        to->number = made.number;
        to->due = made.due;
        to->index = made.index;
        to->own = made.own;
    }
    tm_packet_free(&in);
    return tm_ranks_agree(status, error);
}
