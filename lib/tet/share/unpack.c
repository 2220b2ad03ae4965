/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a rank gets. */
#include "packet.h"

#include "../../base/array.h"
#include "../../geom/space_order.h"
#include "../../mesh/face_table.h"

#include <stdlib.h>
#include <string.h>

typedef struct unpacking {
    const packet *p;
    tm_tet_share *to;
    uint32_t *node;  /* [nodes that came]: of the mesh */
    uint32_t *where; /* [tets that came]: of the mesh */
    uint32_t *mate;  /* of half faces */
    tm_error *error;
} unpacking;

static int compare(const void *a, const void *b)
{
    const uint64_t k = *(const uint64_t *)a, l = *(const uint64_t *)b;
    return (k > l) - (k < l);
}

static bool make_nodes(tm_tet_share *to, size_t nodes)
{
    tm_tet_mesh *mesh = &to->mesh;
    mesh->node_room = nodes;
    mesh->xyz = tm_new(nodes, sizeof *mesh->xyz);
    to->number = tm_new(nodes, sizeof *to->number);
    to->due = tm_new(nodes, sizeof *to->due);
    return mesh->xyz && to->number && to->due;
}

static bool make_values(tm_tet_mesh *mesh, const tm_tet_mesh *like)
{
    mesh->node_attributes = like->node_attributes;
    if (like->node_attributes > 0)
        mesh->node_attribute =
            tm_new(mesh->node_room * like->node_attributes, sizeof(double));
    if (like->node_marker)
        mesh->node_marker = tm_new(mesh->node_room, sizeof *mesh->node_marker);
    return (mesh->node_attribute || !like->node_attributes) &&
           (mesh->node_marker || !like->node_marker);
}

static void unpack_node(const unpacking *u, size_t k)
{
    const packed_node *from = &u->p->node[k];
    tm_tet_mesh *mesh = &u->to->mesh;
    const size_t v = mesh->nodes++, width = mesh->node_attributes;
    memcpy(mesh->xyz[v], from->xyz, sizeof mesh->xyz[v]);
    u->to->number[v] = from->number;
    u->to->due[v] = from->due;
    if (mesh->node_marker)
        mesh->node_marker[v] = from->marker;
    if (width > 0)
        memcpy(mesh->node_attribute + width * v, u->p->attribute + width * k,
               width * sizeof(double));
}

/* In the order of their numbers; those that came more than once are one. */
static bool unpack_nodes(unpacking *u, const tm_tet_mesh *like)
{
    const size_t came = u->p->all[NODES];
    uint64_t *order = tm_new(came, sizeof *order);
    u->node = tm_new(came, sizeof *u->node);
    size_t nodes = 0;
    for (size_t k = 0; k < came && order; k++)
        order[k] = (uint64_t)u->p->node[k].number << 32 | k;
    if (order)
        qsort(order, came, sizeof *order, compare);
    for (size_t k = 0; k < came && order; k++)
        nodes += k == 0 || order[k] >> 32 != order[k - 1] >> 32;
    const bool done =
        order && u->node && make_nodes(u->to, nodes) && make_values(&u->to->mesh, like);
    for (size_t k = 0; k < came && done; k++) {
        if (k == 0 || order[k] >> 32 != order[k - 1] >> 32)
            unpack_node(u, (uint32_t)order[k]);
        u->node[(uint32_t)order[k]] = (uint32_t)u->to->mesh.nodes - 1;
    }
    free(order);
    return done;
}

static bool make_tets(unpacking *u, const tm_tet_mesh *like, bool connected)
{
    tm_tet_share *to = u->to;
    tm_tet_mesh *mesh = &to->mesh;
    const size_t tets = u->p->all[TETS];
    mesh->slots = mesh->tets = mesh->slot_room = tets;
    to->beyond = (uint32_t)tets;
    mesh->regions = like->regions;
    mesh->tet = tm_new(tets, sizeof *mesh->tet);
    mesh->neighbour = connected ? calloc(tets + 1, sizeof *mesh->neighbour) : NULL;
    if (like->regions > 0)
        mesh->region = tm_new(tets * like->regions, sizeof *mesh->region);
    to->index = tm_new(tets, sizeof *to->index);
    to->own = tm_new(tets, sizeof *to->own);
    u->where = tm_new(tets, sizeof *u->where);
    return mesh->tet && (mesh->neighbour || !connected) &&
           (mesh->region || like->regions == 0) && to->index && to->own && u->where;
}

/* where[k] is the place of the k-th by key. */
static bool sort_tets(const unpacking *u)
{
    const size_t tets = u->p->all[TETS];
    tm_curve_point *placed = tm_new(tets, sizeof *placed);
    for (uint32_t k = 0; k < tets && placed; k++)
        placed[k] = (tm_curve_point){u->p->tet[k].key, k};
    const bool done = placed && tm_space_sort(placed, tets, 1);
    for (uint32_t k = 0; k < tets && done; k++)
        u->where[placed[k].item] = k;
    free(placed);
    return done;
}

static bool lock_edges(tm_tet_mesh *mesh, uint32_t t, unsigned locked)
{
    for (int e = 0; locked >> e > 0; e++) {
        if (!(locked >> e & 1))
            continue;
        if (!tm_edge_map_reserve(&mesh->locked, 1))
            return false;
        tm_edge_map_put(&mesh->locked, mesh->tet[t][tm_packed_edge_end[e][0]],
                        mesh->tet[t][tm_packed_edge_end[e][1]], 0);
    }
    return true;
}

static bool unpack_tets(const unpacking *u)
{
    tm_tet_share *to = u->to;
    tm_tet_mesh *mesh = &to->mesh;
    const size_t width = mesh->regions;
    const uint32_t *node = u->node;
    size_t k = 0;
    for (unsigned r = 0; r < tm_ranks_count(); r++) {
        for (size_t past = k + u->p->count[TETS][r]; k < past; k++) {
            const packed_tet *from = &u->p->tet[k];
            const uint32_t t = u->where[k];
            for (int i = 0; i < 4; i++)
                mesh->tet[t][i] = node[from->node[i]];
            to->index[t] = from->index;
            to->own[t] = r == tm_rank();
            if (width > 0)
                memcpy(mesh->region + width * t, u->p->region + width * k,
                       width * sizeof(double));
            if (!lock_edges(mesh, t, from->locked))
                return false;
        }
        node += u->p->count[NODES][r];
    }
    return true;
}

/* neighbour[][] of faces that stay gets where they are in the packet. */
static void find_faces(const unpacking *u)
{
    size_t k = 0, tets = 0;
    for (unsigned r = 0; r < tm_ranks_count(); r++) {
        for (size_t past = k + u->p->count[FACES][r]; k < past; k++) {
            const uint32_t half = u->p->face[k].half;
            const uint32_t t = u->where[tets + half / 4];
            u->to->mesh.neighbour[t][half % 4] = (uint32_t)k | TM_FACE_BIT;
        }
        tets += u->p->count[TETS][r];
    }
}

/* The nodes of each face of the packet become those of the mesh. */
static void translate_faces(const unpacking *u, uint32_t (*node)[3])
{
    size_t k = 0;
    const uint32_t *of_rank = u->node;
    for (unsigned r = 0; r < tm_ranks_count(); r++) {
        for (size_t past = k + u->p->count[FACES][r]; k < past; k++)
            for (int i = 0; i < 3; i++)
                node[k][i] = of_rank[u->p->face[k].node[i]];
        of_rank += u->p->count[NODES][r];
    }
}

/* A face that stays, at half face h; g is the one across it, or h. */
static void add_face(const unpacking *u, const uint32_t (*node)[3], uint32_t h,
                     uint32_t g)
{
    tm_tet_mesh *mesh = &u->to->mesh;
    const uint32_t k = mesh->neighbour[h / 4][h % 4] & ~TM_FACE_BIT;
    const packed_face *from = &u->p->face[k];
    tm_constrained_face *face = &mesh->face[mesh->faces];
    *face = (tm_constrained_face){.marker = from->marker, .listed = from->listed};
    memcpy(face->node, node[k], sizeof face->node);
    face->side[from->side] = h;
    face->side[!from->side] = g != h ? g : from->has_other ? 4 * u->to->beyond : TM_NONE;
    mesh->neighbour[h / 4][h % 4] = (uint32_t)mesh->faces | TM_FACE_BIT;
    if (g != h)
        mesh->neighbour[g / 4][g % 4] = (uint32_t)mesh->faces | TM_FACE_BIT;
    mesh->faces++;
}

static tm_status connect(unpacking *u)
{
    tm_tet_mesh *mesh = &u->to->mesh;
    const tm_mesh_view view = {.nodes = mesh->nodes,
                               .elements = mesh->slots,
                               .item = (const uint32_t *)mesh->tet};
    const size_t faces = u->p->all[FACES];
    uint32_t(*node)[3] = tm_new(faces, sizeof *node);
    if (!node)
        return tm_fail_memory(u->error);
    tm_status status = tm_face_mates(&u->mate, &view, u->error);
    if (status == TM_OK)
        status = tm_tet_mesh_reserve(mesh, 0, 0, faces, 0, u->error);
    if (status == TM_OK) {
        find_faces(u);
        translate_faces(u, node);
    }
    for (uint32_t h = 0; h < 4 * mesh->slots && status == TM_OK; h++) {
        const uint32_t g = u->mate[h];
        if (g < h)
            continue;
        if (mesh->neighbour[h / 4][h % 4] & TM_FACE_BIT)
            add_face(u, (const uint32_t(*)[3])node, h, g);
        else if (g != h)
            tm_tet_join(mesh, h, g);
        else
            mesh->neighbour[h / 4][h % 4] = 4 * u->to->beyond;
    }
    free(node);
    return status;
}

static tm_status unpack_edges(const unpacking *u)
{
    tm_tet_mesh *mesh = &u->to->mesh;
    const uint32_t *node = u->node;
    size_t k = 0;
    tm_status status = tm_tet_mesh_reserve(mesh, 0, 0, 0, u->p->all[EDGES], u->error);
    for (unsigned r = 0; r < tm_ranks_count() && status == TM_OK; r++) {
        for (size_t past = k + u->p->count[EDGES][r]; k < past; k++) {
            const packed_edge *from = &u->p->edge[k];
            const uint32_t a = node[from->node[0]], b = node[from->node[1]];
            if (tm_tet_mesh_edge(mesh, a, b))
                continue;
            tm_edge_map_put(&mesh->edge_of, a, b, (uint32_t)mesh->edges);
            mesh->edge[mesh->edges++] = (tm_marked_edge){{a, b}, from->marker, false};
        }
        node += u->p->count[NODES][r];
    }
    return status;
}

tm_status tm_packet_unpack(const packet *p, const tm_tet_mesh *like, tm_tet_share *to,
                           tm_error *error)
{
    const bool connected = like->neighbour;
    unpacking u = {.p = p, .to = to, .error = error};
    to->mesh = (tm_tet_mesh){.first_dead = TM_NONE,
                             .edge_markers = like->edge_markers,
                             .inner_edges = like->inner_edges,
                             .inner_marked_edges = like->inner_marked_edges,
                             .flat = like->flat};
    const bool done = unpack_nodes(&u, like) && make_tets(&u, like, connected) &&
                      sort_tets(&u) && unpack_tets(&u);
    tm_status status = done ? TM_OK : tm_fail_memory(error);
    if (status == TM_OK && connected)
        status = connect(&u);
    if (status == TM_OK)
        status = unpack_edges(&u);
    free(u.node);
    free(u.where);
    free(u.mate);
    return status;
}
