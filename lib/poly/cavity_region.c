/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions by circumscribed spheres: from seeds by growing circumradius, tetrahedra are
 * flooded whose circumcentre is in the sphere of the seed. */
#include "partition.h"

#include "../base/array.h"
#include "../geom/vector.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
    double radius2;
    uint32_t t;
} seed;

/* The circumcentre; false in a flat tetrahedron. */
static bool circumcentre(const tm_tet_mesh *mesh, uint32_t t, double centre[3],
                         double *radius2)
{
    const uint32_t *n = mesh->tet[t];
    double u[3], v[3], w[3], vw[3], wu[3], uv[3];
    tm_subtract(u, mesh->xyz[n[1]], mesh->xyz[n[0]]);
    tm_subtract(v, mesh->xyz[n[2]], mesh->xyz[n[0]]);
    tm_subtract(w, mesh->xyz[n[3]], mesh->xyz[n[0]]);
    tm_cross(vw, v, w);
    tm_cross(wu, w, u);
    tm_cross(uv, u, v);
    double determinant = 2 * tm_dot(u, vw);
    *radius2 = 0;
    for (int x = 0; x < 3; x++) {
        double to = (tm_norm2(u) * vw[x] + tm_norm2(v) * wu[x] + tm_norm2(w) * uv[x]) /
                    determinant;
        centre[x] = mesh->xyz[n[0]][x] + to;
        *radius2 += to * to;
    }
    return determinant > 0 && isfinite(*radius2);
}

static int by_radius(const void *a, const void *b)
{
    const seed *s = a, *r = b;
    if (s->radius2 != r->radius2)
        return s->radius2 < r->radius2 ? -1 : 1;
    return (s->t > r->t) - (s->t < r->t);
}

/* Floods from one seed; `queue` has room for all tetrahedra. */
static void flood(const tm_tet_mesh *mesh, uint32_t t, uint32_t name, uint32_t *label,
                  uint32_t *queue)
{
    double centre[3], radius2, other[3], other2;
    size_t count = 0;
    bool has_sphere = circumcentre(mesh, t, centre, &radius2);
    label[t] = name;
    queue[count++] = t;
    for (size_t next = 0; next < count && has_sphere; next++)
        for (uint32_t i = 0; i < 4; i++) {
            uint32_t across = mesh->neighbour[queue[next]][i];
            if (across & TM_FACE_BIT || label[across / 4] != TM_NONE ||
                !circumcentre(mesh, across / 4, other, &other2) ||
                tm_distance2(centre, other) >= radius2)
                continue;
            label[across / 4] = name;
            queue[count++] = across / 4;
        }
}

tm_status tm_label_cavity(const tm_tet_mesh *mesh, uint32_t *label, size_t *regions,
                          tm_error *error)
{
    seed *seeds = tm_new(mesh->slots, sizeof *seeds);
    uint32_t *queue = tm_new(mesh->slots, sizeof *queue);
    bool done = seeds && queue;
    for (uint32_t t = 0; t < mesh->slots && done; t++) {
        double centre[3];
        seeds[t].t = t;
        if (!circumcentre(mesh, t, centre, &seeds[t].radius2))
            seeds[t].radius2 = HUGE_VAL;
        label[t] = TM_NONE;
    }
    if (done)
        qsort(seeds, mesh->slots, sizeof *seeds, by_radius);
    *regions = 0;
    for (size_t k = 0; k < mesh->slots && done; k++)
        if (label[seeds[k].t] == TM_NONE)
            flood(mesh, seeds[k].t, (uint32_t)(*regions)++, label, queue);
    free(seeds);
    free(queue);
    return done ? TM_OK : tm_fail_memory(error);
}
