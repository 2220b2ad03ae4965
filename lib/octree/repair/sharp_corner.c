/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sharp_corner.h"

#include "../../element/shape.h"

/* The edges from x to y that close the fan of faces at the tip, and how many there are.
 */
enum { FAN_MOST = 4 };
typedef struct {
    unsigned count;
    uint32_t x[FAN_MOST], y[FAN_MOST];
} fan;

/* The element between a face, which turns counter-clockwise seen from outside, and an
 * apex inside. */
static bool add_part(tm_sharp_corner *to, size_t k, const uint32_t *face, uint32_t apex)
{
    if (to->parts == TM_SHARP_CORNER_PARTS)
        return false;
    size_t items = to->start[to->parts];
    for (size_t i = 0; i < k; i++)
        to->item[items++] = face[k - 1 - i];
    to->item[items++] = apex;
    to->start[++to->parts] = items;
    return true;
}

/* A face of the elements that the middle is not in. */
static bool add_face(tm_sharp_corner *to, fan *f, size_t k, const uint32_t *face,
                     uint32_t corner, uint32_t middle)
{
    size_t i = 0;
    while (i < k && face[i] != corner)
        i++;
    if (i == k)
        return add_part(to, k, face, middle);
    if (f->count == FAN_MOST)
        return false;
    f->x[f->count] = face[(i + 1) % k];
    f->y[f->count++] = face[(i + k - 1) % k];
    return k == 3 ||
           add_part(to, 3,
                    (uint32_t[]){face[(i + 1) % k], face[(i + 2) % k], face[(i + 3) % k]},
                    middle);
}

/* The polygon that closes the fan; false where it is not closed, of three or four edges.
 */
static bool close_fan(const fan *f, uint32_t polygon[FAN_MOST])
{
    if (f->count < 3)
        return false;
    polygon[0] = f->x[0];
    uint32_t next = f->y[0];
    for (unsigned n = 1; n < f->count; n++) {
        unsigned i = 0;
        while (i < f->count && f->x[i] != next)
            i++;
        if (i == f->count || next == polygon[0])
            return false;
        polygon[n] = next;
        next = f->y[i];
    }
    return next == polygon[0];
}

/* The tetrahedra between the triangles at the tip and the middle. */
static bool add_fan(tm_sharp_corner *to, const fan *f, uint32_t corner, uint32_t middle)
{
    bool made = true;
    for (unsigned i = 0; i < f->count && made; i++)
        made = add_part(to, 3, (uint32_t[]){corner, f->x[i], f->y[i]}, middle);
    return made;
}

bool tm_sharp_corner_divide(tm_sharp_corner *parts, const tm_mixed_mesh *mesh,
                            const uint32_t *element, size_t count, uint32_t corner,
                            uint32_t middle, bool whole)
{
    fan f = {.count = 0};
    parts->parts = 0;
    parts->start[0] = 0;
    for (size_t e = 0; e < count; e++) {
        const uint32_t *item = mesh->item + mesh->start[element[e]];
        const tm_element_shape *shape =
            &tm_element_shapes[mesh->start[element[e] + 1] - mesh->start[element[e]]];
        for (size_t i = 0; i < shape->faces; i++) {
            const size_t k = tm_mixed_face_nodes(shape->face[i]);
            uint32_t face[4];
            bool has_middle = false;
            for (size_t c = 0; c < k; c++) {
                face[c] = item[shape->face[i][c]];
                has_middle |= face[c] == middle;
            }
            if (!has_middle && !add_face(parts, &f, k, face, corner, middle))
                return false;
        }
    }
    uint32_t polygon[FAN_MOST], on_sharp_corner[FAN_MOST];
    if (!close_fan(&f, polygon))
        return false;
    for (unsigned i = 0; i < f.count; i++)
        on_sharp_corner[i] = polygon[f.count - 1 - i]; /* seen from the tip's element */
    if (!whole)
        return add_fan(parts, &f, corner, middle);
    return add_part(parts, f.count, polygon, middle) &&
           add_part(parts, f.count, on_sharp_corner, corner);
}
