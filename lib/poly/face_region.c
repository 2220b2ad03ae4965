/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions by faces: each tetrahedron is joined to its neighbour across its best face, if
 * that is not kept; as POLYLLA does with the longest edges of triangles. */
#include "partition.h"

#include "../base/disjoint_sets.h"
#include "../geom/vector.h"
#include "../tet/operation/ball.h"

#include <stdlib.h>

/* Squared: it is only compared. */
static double metric_of(const tm_tet_mesh *mesh, uint32_t t, uint32_t i,
                        tm_face_metric metric)
{
    uint32_t n[3];
    tm_tet_face_below(mesh, t, i, n);
    const double *a = mesh->xyz[n[0]], *b = mesh->xyz[n[1]], *c = mesh->xyz[n[2]];
    double area = tm_triangle_area(a, b, c);
    if (metric == TM_FACE_AREA)
        return area;
    double around =
        sqrt(tm_distance2(a, b)) + sqrt(tm_distance2(b, c)) + sqrt(tm_distance2(c, a));
    return around > 0 ? 2 * area / around : 0;
}

static uint32_t best_face(const tm_tet_mesh *mesh, uint32_t t, tm_face_metric metric)
{
    uint32_t best = 0;
    double most = -1;
    for (uint32_t i = 0; i < 4; i++) {
        double value = metric_of(mesh, t, i, metric);
        if (value <= most)
            continue;
        most = value;
        best = i;
    }
    return best;
}

tm_status tm_label_best_face(const tm_tet_mesh *mesh, tm_face_metric metric,
                             uint32_t *label, size_t *regions, tm_error *error)
{
    (void)error;
    for (uint32_t t = 0; t < mesh->slots; t++)
        label[t] = t;
    for (uint32_t t = 0; t < mesh->slots; t++) {
        uint32_t across = mesh->neighbour[t][best_face(mesh, t, metric)];
        if (across & TM_FACE_BIT)
            continue;
        uint32_t r = tm_set_root(label, t), s = tm_set_root(label, across / 4);
        /* The first tetrahedron is the root. */
        if (r < s)
            label[s] = r;
        else
            label[r] = s;
    }
    for (uint32_t t = 0; t < mesh->slots; t++)
        label[t] = tm_set_root(label, t);
    /* Roots come before the rest of their trees: number them on the way. */
    *regions = 0;
    for (uint32_t t = 0; t < mesh->slots; t++)
        label[t] = label[t] == t ? (uint32_t)(*regions)++ : label[label[t]];
    return TM_OK;
}
