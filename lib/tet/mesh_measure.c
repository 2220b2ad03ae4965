/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_measure.h"

#include "../element/tet_four.h"

#include <float.h>

static uint8_t longest_edge(const tm_tet_mesh *mesh, uint32_t t)
{
    tm_edge_rank rank;
    return (uint8_t)tm_longest_edge(mesh, t, &rank);
}

static double sine2_of(const tm_tet_mesh *mesh, uint32_t t)
{
    const uint32_t *n = mesh->tet[t];
    return tm_tet_sine2(mesh->xyz[n[0]], mesh->xyz[n[1]], mesh->xyz[n[2]],
                        mesh->xyz[n[3]]);
}

#ifdef TM_FOUR_IS_THERE

/* For each of the four which of its edges are the longest: bit e for edge e. */
TM_FOUR static void find_longest(const tm_four_measure *m, uint64_t edges[4])
{
    tm_four most = m->length2[0];
    for (int e = 1; e < 6; e++)
        most = _mm256_max_pd(most, m->length2[e]);
    __m256i found = _mm256_setzero_si256();
    for (int e = 0; e < 6; e++) {
        tm_four is = _mm256_cmp_pd(m->length2[e], most, _CMP_EQ_OQ);
        __m256i bit = _mm256_set1_epi64x((long long)1 << e);
        found = _mm256_or_si256(found, _mm256_and_si256(_mm256_castpd_si256(is), bit));
    }
    _mm256_storeu_si256((__m256i *)(void *)edges, found);
}

TM_FOUR static void measure_four(const tm_tet_mesh *mesh, const uint32_t tet[4],
                                 double sine2[4], uint8_t longest[4])
{
    const double(*x)[3] = (const double(*)[3])mesh->xyz;
    const uint32_t *p = mesh->tet[tet[0]], *q = mesh->tet[tet[1]];
    const uint32_t *r = mesh->tet[tet[2]], *s = mesh->tet[tet[3]];
    tm_vector_four corner[4];
    for (int i = 0; i < 4; i++)
        corner[i] = tm_four_points(x[p[i]], x[q[i]], x[r[i]], x[s[i]]);
    tm_four_measure m = tm_four_sine2(corner[0], corner[1], corner[2], corner[3]);
    uint64_t edges[4];
    find_longest(&m, edges);
    _mm256_storeu_pd(sine2, m.sine2);
    unsigned valid = tm_four_bits(m.valid);
    for (int i = 0; i < 4; i++) {
        bool one_longest = edges[i] != 0 && (edges[i] & (edges[i] - 1)) == 0;
        longest[i] =
            one_longest ? (uint8_t)__builtin_ctzll(edges[i]) : longest_edge(mesh, tet[i]);
        if (!(valid >> i & 1))
            sine2[i] = sine2_of(mesh, tet[i]);
    }
}

#endif

void tm_tet_mesh_measure(const tm_tet_mesh *mesh, const uint32_t *tet, size_t count,
                         double sine2[TM_MEASURED_AT_ONCE],
                         uint8_t longest[TM_MEASURED_AT_ONCE])
{
#ifdef TM_FOUR_IS_THERE
    if (tm_has_four()) {
        uint32_t four[TM_MEASURED_AT_ONCE]; /* the last one again where there are fewer */
        for (size_t i = 0; i < TM_MEASURED_AT_ONCE; i++)
            four[i] = tet[i < count ? i : count - 1];
        measure_four(mesh, four, sine2, longest);
        return;
    }
#endif
    for (size_t i = 0; i < count; i++) {
        sine2[i] = sine2_of(mesh, tet[i]);
        longest[i] = longest_edge(mesh, tet[i]);
    }
}

double tm_flatness(const double (*xyz)[3], size_t count)
{
    const double ulps = 64;
    double largest = 0;
    for (size_t v = 0; v < count; v++)
        for (int k = 0; k < 3 && !isnan(xyz[v][0]); k++)
            largest = fmax(largest, fabs(xyz[v][k]));
    return ulps * DBL_EPSILON * largest;
}

double tm_facet_flatness(const tm_tet_mesh *mesh)
{
    return tm_flatness((const double(*)[3])mesh->xyz, mesh->nodes);
}

static bool is_near_plane(const double normal[3], const double on_plane[3],
                          const double p[3], double flatness)
{
    double to[3];
    tm_subtract(to, p, on_plane);
    return fabs(tm_dot(normal, to)) <= flatness * tm_norm(normal);
}

static bool is_between_two(const tm_constrained_face *face)
{
    return face->side[0] != TM_NONE && face->side[1] != TM_NONE;
}

bool tm_facet_continues(const tm_tet_mesh *mesh, uint32_t f, uint32_t g, uint32_t a,
                        uint32_t b, uint32_t c, uint32_t d, double flatness)
{
    const tm_constrained_face *p = &mesh->face[f], *q = &mesh->face[g];
    const tm_marked_edge *edge = tm_tet_mesh_edge(mesh, a, b);
    if (p->marker != q->marker || p->listed != q->listed ||
        is_between_two(p) != is_between_two(q) || (edge && edge->marker != 0) ||
        tm_edge_map_get(&mesh->locked, a, b))
        return false;
    double of_c[3], of_d[3];
    tm_triangle_normal(of_c, mesh->xyz[a], mesh->xyz[b], mesh->xyz[c]);
    tm_triangle_normal(of_d, mesh->xyz[b], mesh->xyz[a], mesh->xyz[d]);
    return tm_dot(of_c, of_d) > 0 &&
           is_near_plane(of_c, mesh->xyz[a], mesh->xyz[d], flatness) &&
           is_near_plane(of_d, mesh->xyz[a], mesh->xyz[c], flatness);
}
