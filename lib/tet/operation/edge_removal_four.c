/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The programme of edge_removal.c for the worst dihedral angle, two triangles at a time:
 * they make four tetrahedra. What two triangles are worth does not depend on their order,
 * so the plan is the same. */
#include "edge_removal.h"

#include "../../element/tet_four.h"

#ifdef TM_FOUR_IS_THERE

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

bool tm_edge_removal_plan_four(const tm_tet_mesh *mesh, const tm_star *star, double least,
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

#else

bool tm_edge_removal_plan_four(const tm_tet_mesh *mesh, const tm_star *star, double least,
                               tm_edge_removal *plan)
{
    (void)mesh, (void)star, (void)least, (void)plan;
    return false;
}

#endif
