/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a rank gives. */
#include "packet.h"

#include "../../base/array.h"

#include <stdlib.h>
#include <string.h>

const uint8_t tm_packed_edge_end[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

typedef struct filling {
    packet *p;
    const tm_tet_share *share;
    unsigned rank;         /* that is filled for */
    uint32_t *place;       /* [nodes]: in the list of the rank */
    unsigned *listed;      /* [nodes]: for that rank and one more */
    unsigned *edge_listed; /* [edges]: the same */
} filling;

bool tm_packet_start(packet *p)
{
    *p = (packet){0};
    bool done = true;
    for (int l = 0; l < LISTS; l++) {
        p->count[l] = calloc(tm_ranks_count(), sizeof *p->count[l]);
        done &= p->count[l] != NULL;
    }
    return done;
}

void tm_packet_free(packet *p)
{
    free(p->tet);
    free(p->region);
    free(p->node);
    free(p->attribute);
    free(p->face);
    free(p->edge);
    for (int l = 0; l < LISTS; l++)
        free(p->count[l]);
    *p = (packet){0};
}

/* Room for one more of a list. */
static void *next_of(filling *f, int list, void **array, size_t size)
{
    packet *p = f->p;
    char *moved = tm_grow(*array, &p->room[list], p->all[list] + 1, size);
    if (!moved)
        return NULL;
    *array = moved;
    p->count[list][f->rank]++;
    return moved + size * p->all[list]++;
}

/* The place of a node in the list of the rank; TM_NONE where memory is out. */
static uint32_t place_of(filling *f, uint32_t v)
{
    if (f->listed[v] == f->rank + 1)
        return f->place[v];
    const tm_tet_mesh *mesh = &f->share->mesh;
    const uint32_t place = (uint32_t)f->p->count[NODES][f->rank];
    void *array = f->p->node;
    packed_node *node = next_of(f, NODES, &array, sizeof *node);
    f->p->node = array;
    if (!node)
        return TM_NONE;
    *node = (packed_node){.number = f->share->number[v],
                          .marker = mesh->node_marker ? mesh->node_marker[v] : 0,
                          .due = f->share->due[v]};
    memcpy(node->xyz, mesh->xyz[v], sizeof node->xyz);
    f->listed[v] = f->rank + 1;
    f->place[v] = place;
    return place;
}

static uint8_t locked_edges(const tm_tet_mesh *mesh, uint32_t t)
{
    unsigned locked = 0;
    for (int e = 0; e < 6 && mesh->locked.count > 0; e++) {
        const uint8_t *end = tm_packed_edge_end[e];
        if (tm_edge_map_get(&mesh->locked, mesh->tet[t][end[0]], mesh->tet[t][end[1]]))
            locked |= 1u << e;
    }
    return (uint8_t)locked;
}

static bool add_face(filling *f, uint32_t t, uint32_t i, uint32_t half)
{
    const uint32_t n = f->share->mesh.neighbour[t][i];
    if (!(n & TM_FACE_BIT))
        return true;
    const tm_constrained_face *from = &f->share->mesh.face[n & ~TM_FACE_BIT];
    void *array = f->p->face;
    packed_face *face = next_of(f, FACES, &array, sizeof *face);
    f->p->face = array;
    if (!face)
        return false;
    const uint8_t side = from->side[0] != 4 * t + i;
    *face = (packed_face){.half = half,
                          .marker = from->marker,
                          .side = side,
                          .listed = from->listed,
                          .has_other = from->side[!side] != TM_NONE};
    for (int k = 0; k < 3; k++)
        face->node[k] = f->place[from->node[k]];
    return true;
}

static bool add_edges(filling *f, uint32_t t)
{
    const tm_tet_mesh *mesh = &f->share->mesh;
    const uint32_t *n = mesh->tet[t];
    for (int e = 0; e < 6 && mesh->edges > 0; e++) {
        const uint8_t *end = tm_packed_edge_end[e];
        const tm_marked_edge *from = tm_tet_mesh_edge(mesh, n[end[0]], n[end[1]]);
        if (!from || f->edge_listed[from - mesh->edge] == f->rank + 1)
            continue;
        void *array = f->p->edge;
        packed_edge *edge = next_of(f, EDGES, &array, sizeof *edge);
        f->p->edge = array;
        if (!edge)
            return false;
        f->edge_listed[from - mesh->edge] = f->rank + 1;
        *edge = (packed_edge){{f->place[from->node[0]], f->place[from->node[1]]},
                              from->marker};
    }
    return true;
}

/* Tetrahedron t, the k-th that goes to the rank. */
static bool add_tet(filling *f, uint32_t t, uint32_t key, uint32_t k)
{
    const tm_tet_share *share = f->share;
    packed_tet *tet = &f->p->tet[f->p->all[TETS]];
    *tet = (packed_tet){.key = key,
                        .index = share->index ? share->index[t] : 0,
                        .locked = locked_edges(&share->mesh, t)};
    for (int i = 0; i < 4; i++) {
        tet->node[i] = place_of(f, share->mesh.tet[t][i]);
        if (tet->node[i] == TM_NONE)
            return false;
    }
    const size_t width = share->mesh.regions;
    if (width > 0)
        memcpy(f->p->region + width * f->p->all[TETS], share->mesh.region + width * t,
               width * sizeof(double));
    for (uint32_t i = 0; i < 4; i++)
        if (share->mesh.neighbour && !add_face(f, t, i, 4 * k + i))
            return false;
    f->p->count[TETS][f->rank]++;
    f->p->all[TETS]++;
    return add_edges(f, t);
}

/* Attributes of the nodes listed, from first on. */
static bool add_attributes(filling *f, size_t first, const uint32_t *node_of_place)
{
    const size_t width = f->share->mesh.node_attributes;
    packet *p = f->p;
    double *moved = realloc(p->attribute, (p->all[NODES] * width + 1) * sizeof *moved);
    if (!moved)
        return false;
    p->attribute = moved;
    for (size_t k = first; k < p->all[NODES]; k++)
        memcpy(moved + width * k,
               f->share->mesh.node_attribute + width * node_of_place[k - first],
               width * sizeof *moved);
    return true;
}

/* All for one rank: the tetrahedra of the deal from `first` on. */
static bool fill_for_rank(filling *f, const tm_tet_deal *deal, size_t first)
{
    const tm_tet_mesh *mesh = &f->share->mesh;
    const size_t nodes = f->p->all[NODES];
    for (size_t k = 0; k < deal->count[f->rank]; k++)
        if (!add_tet(f, deal->tet[first + k], deal->key[first + k], (uint32_t)k))
            return false;
    if (mesh->node_attributes == 0)
        return true;
    uint32_t *node = tm_new(f->p->count[NODES][f->rank], sizeof *node);
    for (uint32_t v = 0; v < mesh->nodes && node; v++)
        if (f->listed[v] == f->rank + 1)
            node[f->place[v]] = v;
    const bool done = node && add_attributes(f, nodes, node);
    free(node);
    return done;
}

bool tm_packet_fill(packet *p, const tm_tet_share *share, const tm_tet_deal *deal)
{
    const tm_tet_mesh *mesh = &share->mesh;
    filling f = {.p = p, .share = share};
    size_t first = 0;
    f.place = tm_new(mesh->nodes, sizeof *f.place);
    f.listed = calloc(mesh->nodes + 1, sizeof *f.listed);
    f.edge_listed = calloc(mesh->edges + 1, sizeof *f.edge_listed);
    p->tet = tm_new(deal->tets, sizeof *p->tet);
    p->region = tm_new(deal->tets * mesh->regions, sizeof *p->region);
    bool done = f.place && f.listed && f.edge_listed && p->tet && p->region;
    for (f.rank = 0; f.rank < tm_ranks_count() && done; f.rank++) {
        done = fill_for_rank(&f, deal, first);
        first += deal->count[f.rank];
    }
    free(f.place);
    free(f.listed);
    free(f.edge_listed);
    return done;
}
