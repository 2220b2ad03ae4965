/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "star_insertion.h"

#include "../../element/tet_four.h"
#include "../../geom/predicates.h"

#include <string.h>

void tm_star_centroid(const tm_tet_mesh *mesh, const tm_star *star, double p[3])
{
    const double *a = mesh->xyz[star->a], *b = mesh->xyz[star->b];
    size_t rings = star->size + !star->closed;
    double x = a[0] + b[0], y = a[1] + b[1], z = a[2] + b[2];
    for (size_t i = 0; i < rings; i++) {
        const double *r = mesh->xyz[star->ring[i]];
        x += r[0];
        y += r[1];
        z += r[2];
    }
    p[0] = x / (double)(rings + 2);
    p[1] = y / (double)(rings + 2);
    p[2] = z / (double)(rings + 2);
}

void tm_star_wcentroid(const tm_tet_mesh *mesh, const tm_star *star, double p[3])
{
    const double *a = mesh->xyz[star->a], *b = mesh->xyz[star->b];
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (size_t i = 0; i < star->size; i++)
            sum += (a[k] + b[k] + mesh->xyz[star->ring[i]][k] +
                    mesh->xyz[star->ring[i + 1]][k]) /
                   4;
        p[k] = sum / (double)star->size;
    }
}

void tm_star_midpoint(const tm_tet_mesh *mesh, const tm_star *star, double p[3])
{
    for (int k = 0; k < 3; k++)
        p[k] = mesh->xyz[star->a][k] / 2 + mesh->xyz[star->b][k] / 2;
}

bool tm_star_sees(const tm_tet_mesh *mesh, const tm_star *star, const double p[3])
{
    const double *a = mesh->xyz[star->a], *b = mesh->xyz[star->b];
    for (size_t i = 0; i < star->size; i++) {
        const double *r = mesh->xyz[star->ring[i]], *s = mesh->xyz[star->ring[i + 1]];
        if (tm_orient3d(a, p, r, s) <= 0 || tm_orient3d(p, b, r, s) <= 0)
            return false;
    }
    return true;
}

bool tm_star_contains(const tm_tet_mesh *mesh, const tm_star *star, const double p[3])
{
    const double *a = mesh->xyz[star->a], *b = mesh->xyz[star->b];
    for (size_t i = 0; i < star->size; i++) {
        const double *r = mesh->xyz[star->ring[i]], *s = mesh->xyz[star->ring[i + 1]];
        if (tm_orient3d(p, b, r, s) >= 0 && tm_orient3d(a, p, r, s) >= 0 &&
            tm_orient3d(a, b, p, s) >= 0 && tm_orient3d(a, b, r, p) >= 0)
            return true;
    }
    return false;
}

double tm_star_insertion_quality(const tm_tet_mesh *mesh, const tm_star *star,
                                 const double p[3], tm_tet_measure measure, double least)
{
    const double *a = mesh->xyz[star->a], *b = mesh->xyz[star->b];
    double worst = HUGE_VAL;
    for (size_t i = 0; i < star->size; i++) {
        const double *r = mesh->xyz[star->ring[i]], *s = mesh->xyz[star->ring[i + 1]];
        double lower = tm_tet_measure_of(measure, a, p, r, s);
        if (lower < least)
            return 0;
        double upper = tm_tet_measure_of(measure, p, b, r, s);
        if (upper < least)
            return 0;
        worst = fmin(worst, fmin(lower, upper));
    }
    return worst;
}

#ifdef TM_FOUR_IS_THERE

/* May a point be inserted, and how good would that be? It is the most frequent question
 * of all, so four tetrahedra are asked about at a time: a p r s and p b r s of two ring
 * edges. True only where all are
 * positive for certain; *quality then as tm_star_insertion_quality() says. */
TM_FOUR static bool try_four(const tm_tet_mesh *mesh, const tm_star *star,
                             const double p[3], double least, double *quality)
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const tm_vector_four first = tm_four_in_turn(x[star->a], p);
    const tm_vector_four second = tm_four_in_turn(p, x[star->b]);
    tm_four worst = _mm256_set1_pd(HUGE_VAL);
    unsigned certain = TM_FOUR_ALL;
    for (size_t i = 0; i < star->size; i += 2) {
        size_t j = i + 1 < star->size ? i + 1 : i;
        const uint32_t *r = star->ring;
        const tm_vector_four third = tm_four_two(x[r[i]], x[r[j]]);
        const tm_vector_four fourth = tm_four_two(x[r[i + 1]], x[r[j + 1]]);
        const tm_four_measure m = tm_four_sine2(first, second, third, fourth);
        certain &= tm_four_positive(&m);
        worst = _mm256_min_pd(worst, m.sine2);
    }
    double of[4];
    _mm256_storeu_pd(of, worst);
    double of_all = tm_lesser(tm_lesser(of[0], of[1]), tm_lesser(of[2], of[3]));
    *quality = of_all < least ? 0 : of_all;
    return certain == TM_FOUR_ALL;
}

#endif

bool tm_star_try_insertion(const tm_tet_mesh *mesh, const tm_star *star,
                           const double p[3], tm_tet_measure measure, double least,
                           double *quality)
{
#ifdef TM_FOUR_IS_THERE
    if (measure == TM_MEASURE_DIHEDRAL && tm_has_four() &&
        try_four(mesh, star, p, least, quality))
        return true;
#endif
    *quality = 0;
    if (!tm_star_sees(mesh, star, p))
        return false;
    *quality = tm_star_insertion_quality(mesh, star, p, measure, least);
    return true;
}

/* The marker of a point on the edge: the edge's own if it has one, else the greatest of
 * the faces at it that stay; 0 inside. */
static int32_t marker_on_edge(const tm_tet_mesh *mesh, const tm_star *star)
{
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, star->a, star->b);
    if (edge && edge->marker != 0)
        return edge->marker;
    int32_t marker = 0;
    bool found = false;
    for (size_t i = 0; i < star->size + !star->closed && star->constrained_face; i++) {
        uint32_t f = tm_star_face(mesh, star, i);
        if (f == TM_NONE)
            continue;
        if (!found || mesh->face[f].marker > marker)
            marker = mesh->face[f].marker;
        found = true;
    }
    return marker;
}

/* The attributes of the new node: on the edge the mean of its ends, else interpolated. */
static void set_attributes(tm_tet_mesh *mesh, const tm_star *star, bool on_edge,
                           uint32_t v)
{
    size_t width = mesh->node_attributes;
    double *attribute = mesh->node_attribute;
    if (!on_edge) {
        tm_tet_interpolate(mesh, star->tet, star->size, mesh->xyz[v],
                           attribute + v * width);
        return;
    }
    for (size_t k = 0; k < width; k++)
        attribute[v * width + k] =
            attribute[star->a * width + k] / 2 + attribute[star->b * width + k] / 2;
}

static uint32_t add_node(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                         bool on_edge)
{
    uint32_t v = tm_tet_mesh_new_node(mesh, p);
    if (mesh->node_attributes)
        set_attributes(mesh, star, on_edge, v);
    if (mesh->node_marker && on_edge)
        mesh->node_marker[v] = marker_on_edge(mesh, star);
    return v;
}

/* Splits the edge of .edge between a and b, if there is one, at p. */
static void split_edge(tm_tet_mesh *mesh, uint32_t a, uint32_t b, uint32_t p)
{
    tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, b);
    if (!edge)
        return;
    uint32_t first = (uint32_t)(edge - mesh->edge), second = (uint32_t)mesh->edges++;
    tm_edge_map_remove(&mesh->edge_of, a, b);
    mesh->edge[second] = (tm_marked_edge){{p, edge->node[1]}, edge->marker, false};
    tm_edge_map_put(&mesh->edge_of, p, edge->node[1], second);
    tm_edge_map_put(&mesh->edge_of, edge->node[0], p, first);
    edge->node[1] = p;
}

/* Splits tetrahedron t = (a b r s): it keeps a, r, s and gets p for b; u becomes
 * (p b r s). Only the faces opposite a and b are connected. */
static void split_tet(tm_tet_mesh *mesh, uint32_t t, uint32_t u, const tm_star *star,
                      uint32_t p)
{
    uint32_t a = tm_tet_corner(mesh, t, star->a), b = tm_tet_corner(mesh, t, star->b);
    memcpy(mesh->tet[u], mesh->tet[t], sizeof mesh->tet[u]);
    mesh->tet[u][a] = p;
    mesh->tet[t][b] = p;
    for (size_t k = 0; k < mesh->regions; k++)
        mesh->region[u * mesh->regions + k] = mesh->region[t * mesh->regions + k];
    tm_tet_replace_half(mesh, 4 * u + a, 4 * t + a, mesh->neighbour[t][a]);
    tm_tet_join(mesh, 4 * t + a, 4 * u + b);
}

/* Splits a face that stays: it keeps a and gets p for b; a new one gets p for a. The
 * new one's sides are those halves that the caller sets. Returns its number. */
static uint32_t split_face(tm_tet_mesh *mesh, uint32_t f, const tm_star *star, uint32_t p)
{
    uint32_t g = (uint32_t)mesh->faces++;
    mesh->face[g] = mesh->face[f];
    for (int i = 0; i < 3; i++) {
        if (mesh->face[f].node[i] == star->b)
            mesh->face[f].node[i] = p;
        if (mesh->face[g].node[i] == star->a)
            mesh->face[g].node[i] = p;
    }
    return g;
}

/* The face of tetrahedron i of the star that is opposite ring node `opposite`, as a half
 * face of the upper tetrahedron (p b r s); *lower is that of the lower one. */
static uint32_t upper_half(const tm_tet_mesh *mesh, const tm_star *star,
                           const uint32_t *upper, size_t i, uint32_t opposite,
                           uint32_t *lower)
{
    uint32_t corner = tm_tet_corner(mesh, star->tet[i], opposite);
    *lower = 4 * star->tet[i] + corner;
    return 4 * upper[i] + corner;
}

/* Connects the upper tetrahedra across the face with ring node i, between tetrahedra
 * i - 1 and i of the star (before and after; TM_NONE at the ends of an open star). */
static void connect_upper(tm_tet_mesh *mesh, const tm_star *star, const uint32_t *upper,
                          size_t i, uint32_t p)
{
    size_t before = i > 0 ? i - 1 : star->closed ? star->size - 1 : TM_NONE;
    size_t after = i < star->size ? i : TM_NONE;
    uint32_t half[2] = {TM_NONE, TM_NONE}, lower[2] = {TM_NONE, TM_NONE};
    if (before != TM_NONE)
        half[0] = upper_half(mesh, star, upper, before, star->ring[before], &lower[0]);
    if (after != TM_NONE)
        half[1] = upper_half(mesh, star, upper, after, star->ring[after + 1], &lower[1]);
    uint32_t there = lower[0] != TM_NONE ? lower[0] : lower[1];
    uint32_t across = mesh->neighbour[there / 4][there % 4];
    if (!(across & TM_FACE_BIT)) {
        tm_tet_join(mesh, half[0], half[1]);
        return;
    }
    uint32_t f = across & ~TM_FACE_BIT, g = split_face(mesh, f, star, p);
    for (int s = 0; s < 2; s++)
        if (half[s] != TM_NONE) {
            mesh->face[g].side[mesh->face[f].side[0] != lower[s]] = half[s];
            mesh->neighbour[half[s] / 4][half[s] % 4] = g | TM_FACE_BIT;
        }
}

tm_status tm_star_insert(tm_tet_mesh *mesh, const tm_star *star, const double p[3],
                         bool on_edge, uint32_t *created, tm_error *error)
{
    tm_status status = tm_tet_mesh_reserve(mesh, 1, star->size, star->size + 1, 1, error);
    if (status != TM_OK)
        return status;
    uint32_t v = add_node(mesh, star, p, on_edge);
    if (on_edge)
        split_edge(mesh, star->a, star->b, v);
    else if (mesh->inner_edges)
        tm_tet_mesh_forget_edge(mesh, star->a, star->b);
    uint32_t *upper = created + star->size;
    for (size_t i = 0; i < star->size; i++) {
        created[i] = star->tet[i];
        upper[i] = tm_tet_mesh_new_tet(mesh);
        split_tet(mesh, star->tet[i], upper[i], star, v);
    }
    for (size_t i = 0; i < star->size + !star->closed; i++)
        connect_upper(mesh, star, upper, i, v);
    return TM_OK;
}
