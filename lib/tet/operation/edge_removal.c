/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "edge_removal.h"

#include "../../geom/predicates.h"
#include "../../element/tet_four.h"
#include "../mesh_set.h"

#include <string.h>

/* The worse of the two tetrahedra on triangle i k j; 0 as soon as one is below least. */
static double triangle_quality(const tm_tet_mesh *mesh, const tm_star *star,
                               tm_tet_measure measure, size_t i, size_t k, size_t j,
                               double least)
{
    const double *x = mesh->xyz[star->ring[i]], *y = mesh->xyz[star->ring[k]];
    const double *z = mesh->xyz[star->ring[j]];
    double above = tm_tet_measure_of(measure, x, y, z, mesh->xyz[star->b]);
    if (above < least)
        return 0;
    double below = tm_tet_measure_of(measure, x, z, y, mesh->xyz[star->a]);
    return above < below ? above : below;
}

/* best[i][j] and apex[i][j] from the shorter chords. */
static void plan_chord(const tm_tet_mesh *mesh, const tm_star *star,
                       tm_tet_measure measure, double least, tm_edge_removal *plan,
                       size_t i, size_t j)
{
    double best = 0;
    for (size_t k = i + 1; k < j; k++) {
        double quality = plan->best[i][k];
        if (plan->best[k][j] < quality)
            quality = plan->best[k][j];
        double needed = best > least ? best : least;
        if (quality < needed)
            continue;
        double triangle = triangle_quality(mesh, star, measure, i, k, j, needed);
        if (triangle < quality)
            quality = triangle;
        if (quality >= least && quality > best) {
            best = quality;
            plan->apex[i][j] = (uint8_t)k;
        }
    }
    plan->best[i][j] = best;
}

static bool is_positive(const tm_tet_mesh *mesh, uint32_t a, uint32_t b, uint32_t c,
                        uint32_t d)
{
    return tm_orient3d(mesh->xyz[a], mesh->xyz[b], mesh->xyz[c], mesh->xyz[d]) > 0;
}

/* Whether all tetrahedra of the plan on polygon i … j are exactly positive. */
static bool is_valid(const tm_tet_mesh *mesh, const tm_star *star,
                     const tm_edge_removal *plan, size_t i, size_t j)
{
    if (j - i < 2)
        return true;
    size_t k = plan->apex[i][j];
    const uint32_t *r = star->ring;
    return is_positive(mesh, r[i], r[k], r[j], star->b) &&
           is_positive(mesh, r[i], r[j], r[k], star->a) &&
           is_valid(mesh, star, plan, i, k) && is_valid(mesh, star, plan, k, j);
}

#ifdef TM_FOUR_IS_THERE

/* The same for the worst dihedral angle, two triangles at a time: they make four
 * tetrahedra. What two triangles are worth does not depend on their order, so the plan is
 * the same. Without the exact signs. */

/* A triangle i k j that may be better than what chord i j has. */
typedef struct {
    size_t i, k, j;
} triangle;

typedef struct {
    const tm_tet_mesh *mesh;
    const tm_star *star;
    double least;
    tm_edge_removal *plan;
    triangle triangle[2]; /* that wait to be measured together */
    size_t triangles;
} programme;

static inline double sides_of(const programme *p, size_t i, size_t k, size_t j)
{
    return tm_lesser(p->plan->best[i][k], p->plan->best[k][j]);
}

/* What a triangle makes of its chord, whose two tetrahedra are so good. */
static inline void take(programme *p, const triangle *t, double above, double below)
{
    double *best = &p->plan->best[t->i][t->j];
    double quality = tm_lesser(sides_of(p, t->i, t->k, t->j), tm_lesser(above, below));
    if (quality >= p->least && quality > *best) {
        *best = quality;
        p->plan->apex[t->i][t->j] = (uint8_t)t->k;
    }
}

/* Measures the triangles that wait, one or two. */
TM_FOUR static void measure(programme *p)
{
    const double(*xyz)[3] = (const double(*)[3])p->mesh->xyz;
    const uint32_t *r = p->star->ring;
    const double *a = xyz[p->star->a], *b = xyz[p->star->b];
    const triangle *t = &p->triangle[0], *u = &p->triangle[p->triangles - 1];
    const double *x[2] = {xyz[r[t->i]], xyz[r[u->i]]};
    const double *y[2] = {xyz[r[t->k]], xyz[r[u->k]]};
    const double *z[2] = {xyz[r[t->j]], xyz[r[u->j]]};
    const tm_four_measure m =
        tm_four_sine2(tm_four_two(x[0], x[1]), tm_four_points(y[0], z[0], y[1], z[1]),
                      tm_four_points(z[0], y[0], z[1], y[1]), tm_four_in_turn(b, a));
    double sine2[4];
    _mm256_storeu_pd(sine2, m.sine2);
    if (tm_four_bits(m.valid) != TM_FOUR_ALL)
        for (int i = 0; i < 2; i++) {
            sine2[2 * i] = tm_tet_sine2(x[i], y[i], z[i], b);
            sine2[2 * i + 1] = tm_tet_sine2(x[i], z[i], y[i], a);
        }
    take(p, t, sine2[0], sine2[1]);
    if (p->triangles > 1)
        take(p, u, sine2[2], sine2[3]);
    p->triangles = 0;
}

/* The triangles on the chords over so many ring edges. */
static void plan_chords(programme *p, size_t length)
{
    for (size_t i = 0; i + length < p->star->size; i++) {
        size_t j = i + length;
        p->plan->best[i][j] = 0;
        for (size_t k = i + 1; k < j; k++) {
            double sides = sides_of(p, i, k, j);
            if (sides < p->least || sides < p->plan->best[i][j])
                continue;
            triangle *t = &p->triangle[p->triangles++];
            t->i = i;
            t->k = k;
            t->j = j;
            if (p->triangles == 2)
                measure(p);
        }
    }
    if (p->triangles > 0)
        measure(p);
}

static bool plan_four(const tm_tet_mesh *mesh, const tm_star *star, double least,
                      tm_edge_removal *plan)
{
    programme p = {.mesh = mesh, .star = star, .least = least, .plan = plan};
    size_t n = star->size;
    for (size_t i = 0; i + 1 < n; i++)
        plan->best[i][i + 1] = HUGE_VAL;
    plan_chords(&p, 2);
    /* Every triangulation has an ear: without a good one there is none. */
    bool has_ear = false;
    for (size_t i = 0; i + 2 < n; i++)
        has_ear |= plan->best[i][i + 2] > 0;
    for (size_t length = 3; length < n && has_ear; length++)
        plan_chords(&p, length);
    return has_ear && plan->best[0][n - 1] > 0;
}

#endif

bool tm_edge_removal_plan(const tm_tet_mesh *mesh, const tm_star *star,
                          tm_tet_measure measure, double least, tm_edge_removal *plan)
{
    size_t n = star->size;
#ifdef TM_FOUR_IS_THERE
    if (measure == TM_MEASURE_DIHEDRAL && tm_has_four()) {
        if (!plan_four(mesh, star, least, plan))
            return false;
        plan->quality = plan->best[0][n - 1];
        return is_valid(mesh, star, plan, 0, n - 1);
    }
#endif
    for (size_t i = 0; i + 1 < n; i++)
        plan->best[i][i + 1] = HUGE_VAL;
    for (size_t length = 2; length < n; length++) {
        double longest_best = 0;
        for (size_t i = 0; i + length < n; i++) {
            plan_chord(mesh, star, measure, least, plan, i, i + length);
            if (plan->best[i][i + length] > longest_best)
                longest_best = plan->best[i][i + length];
        }
        /* Every triangulation has an ear: without a good one there is none. */
        if (length == 2 && longest_best == 0)
            return false;
    }
    plan->quality = plan->best[0][n - 1];
    return plan->quality > 0 && is_valid(mesh, star, plan, 0, n - 1);
}

/* What the two tetrahedra on triangle i k j cost; HUGE_VAL where one is below least. */
static double triangle_cost(const tm_tet_mesh *mesh, const tm_star *star,
                            const tm_cost *cost, size_t i, size_t k, size_t j,
                            double least)
{
    const double *x = mesh->xyz[star->ring[i]], *y = mesh->xyz[star->ring[k]];
    const double *z = mesh->xyz[star->ring[j]];
    double above = tm_cost_quality(cost, least, x, y, z, mesh->xyz[star->b]);
    if (above < least)
        return HUGE_VAL;
    double below = tm_cost_quality(cost, least, x, z, y, mesh->xyz[star->a]);
    if (below < least)
        return HUGE_VAL;
    return tm_cost_of(cost, above) + tm_cost_of(cost, below);
}

bool tm_edge_removal_plan_cheapest(const tm_tet_mesh *mesh, const tm_star *star,
                                   const tm_cost *cost, double least, double most,
                                   tm_edge_removal *plan)
{
    size_t n = star->size + !star->closed;
    for (size_t i = 0; i + 1 < n; i++)
        plan->best[i][i + 1] = 0;
    for (size_t length = 2; length < n; length++) {
        bool any = false;
        for (size_t i = 0; i + length < n; i++) {
            size_t j = i + length;
            double best = most;
            for (size_t k = i + 1; k < j; k++) {
                double sum = plan->best[i][k] + plan->best[k][j];
                if (!(sum < best))
                    continue;
                sum += triangle_cost(mesh, star, cost, i, k, j, least);
                if (sum < best) {
                    best = sum;
                    plan->apex[i][j] = (uint8_t)k;
                }
            }
            plan->best[i][j] = best < most ? best : HUGE_VAL;
            any |= best < most;
        }
        /* Every triangulation has an ear: without a good one there is none. */
        if (length == 2 && !any)
            return false;
    }
    plan->quality = plan->best[0][n - 1];
    return plan->quality < most && is_valid(mesh, star, plan, 0, n - 1);
}

static size_t list(const tm_star *star, const tm_edge_removal *plan, size_t i, size_t j,
                   uint32_t (*node)[4])
{
    if (j - i < 2)
        return 0;
    size_t k = plan->apex[i][j];
    const uint32_t *r = star->ring;
    memcpy(node[0], (uint32_t[4]){r[i], r[k], r[j], star->b}, sizeof node[0]);
    memcpy(node[1], (uint32_t[4]){r[i], r[j], r[k], star->a}, sizeof node[1]);
    size_t count = 2 + list(star, plan, i, k, node + 2);
    return count + list(star, plan, k, j, node + count);
}

size_t tm_edge_removal_list(const tm_star *star, const tm_edge_removal *plan,
                            uint32_t (*node)[4])
{
    return list(star, plan, 0, star->size - star->closed, node);
}

void tm_edge_removal_renewals(const tm_tet_mesh *mesh, const tm_star *star, bool first,
                              tm_face_renewal renewal[2])
{
    size_t n = star->size;
    uint32_t r = star->ring[0], s = star->ring[n];
    for (int i = 0; i < 2; i++) {
        uint32_t t = star->tet[i ? n - 1 : 0], opposite = star->ring[i ? n - 1 : 1];
        uint32_t across = mesh->neighbour[t][tm_tet_corner(mesh, t, opposite)];
        renewal[i].face = across & ~TM_FACE_BIT;
        for (int k = 0; k < 3; k++) {
            uint32_t v = mesh->face[renewal[i].face].node[k];
            if (first && v == (i ? star->a : star->b))
                v = i ? r : s;
            renewal[i].node[k] = v;
        }
    }
}

/* An outer face of the star: the half face that is going, and what is across it. */
typedef struct {
    uint32_t old;
    uint32_t across;
} outer_face;

typedef struct {
    tm_tet_mesh *mesh;
    const tm_star *star;
    const tm_edge_removal *plan;
    uint32_t *created;
    size_t made;
    outer_face above[TM_REMOVAL_MAX]; /* of each ring edge, with b */
    outer_face below[TM_REMOVAL_MAX]; /* with a */
} removal;

static void save_outer_faces(removal *r)
{
    for (size_t i = 0; i < r->star->size; i++) {
        uint32_t t = r->star->tet[i];
        uint32_t a = tm_tet_corner(r->mesh, t, r->star->a);
        uint32_t b = tm_tet_corner(r->mesh, t, r->star->b);
        r->above[i] = (outer_face){4 * t + a, r->mesh->neighbour[t][a]};
        r->below[i] = (outer_face){4 * t + b, r->mesh->neighbour[t][b]};
    }
}

static void attach(tm_tet_mesh *mesh, uint32_t half, const outer_face *outer)
{
    tm_tet_replace_half(mesh, half, outer->old, outer->across);
}

/* Makes the tetrahedra on polygon i … j. above and below are the half faces that wait
 * at chord i j for those. */
static void build(removal *r, size_t i, size_t j, uint32_t above, uint32_t below)
{
    tm_tet_mesh *mesh = r->mesh;
    const uint32_t *ring = r->star->ring;
    size_t k = r->plan->apex[i][j];
    uint32_t t = r->created[r->made++], u = r->created[r->made++];
    memcpy(mesh->tet[t], (uint32_t[4]){ring[i], ring[k], ring[j], r->star->b},
           sizeof mesh->tet[t]);
    memcpy(mesh->tet[u], (uint32_t[4]){ring[i], ring[j], ring[k], r->star->a},
           sizeof mesh->tet[u]);
    tm_tet_join(mesh, 4 * t + 3, 4 * u + 3);
    if (above == TM_NONE) { /* the chord 0 n-1 is the ring's last edge */
        attach(mesh, 4 * t + 1, &r->above[j]);
        attach(mesh, 4 * u + 2, &r->below[j]);
    } else {
        tm_tet_join(mesh, 4 * t + 1, above);
        tm_tet_join(mesh, 4 * u + 2, below);
    }
    if (k == i + 1) {
        attach(mesh, 4 * t + 2, &r->above[i]);
        attach(mesh, 4 * u + 1, &r->below[i]);
    } else {
        build(r, i, k, 4 * t + 2, 4 * u + 1);
    }
    if (j == k + 1) {
        attach(mesh, 4 * t + 0, &r->above[k]);
        attach(mesh, 4 * u + 0, &r->below[k]);
    } else {
        build(r, k, j, 4 * t + 0, 4 * u + 0);
    }
}

/* The slots of the new tetrahedra: those of the star, then new ones. All are of the one
 * region that a star without constrained faces is in. */
static void take_slots(removal *r)
{
    tm_tet_mesh *mesh = r->mesh;
    size_t had = r->star->size, needed = 2 * had - 4;
    tm_tet_mesh_spread_set(mesh, r->star->tet, had);
    for (size_t i = 0; i < had && i < needed; i++)
        r->created[i] = r->star->tet[i];
    for (size_t i = had; i < needed; i++) {
        r->created[i] = tm_tet_mesh_new_tet(mesh);
        for (size_t k = 0; k < mesh->regions; k++)
            mesh->region[r->created[i] * mesh->regions + k] =
                mesh->region[r->star->tet[0] * mesh->regions + k];
    }
    for (size_t i = needed; i < had; i++)
        tm_tet_mesh_delete_tet(mesh, r->star->tet[i]);
}

tm_status tm_edge_removal_apply(tm_tet_mesh *mesh, const tm_star *star,
                                const tm_edge_removal *plan, uint32_t *created,
                                tm_error *error)
{
    tm_status status = tm_tet_mesh_reserve(mesh, 0, star->size, 0, 0, error);
    if (status != TM_OK)
        return status;
    removal r = {.mesh = mesh, .star = star, .plan = plan, .created = created};
    save_outer_faces(&r);
    take_slots(&r);
    build(&r, 0, star->size - 1, TM_NONE, TM_NONE);
    if (mesh->inner_edges || !star->closed || star->constrained_face)
        tm_tet_mesh_forget_edge(mesh, star->a, star->b);
    return TM_OK;
}
