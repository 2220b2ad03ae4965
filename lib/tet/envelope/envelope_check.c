/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "../../base/array.h"
#include "envelope_parts.h"

#include <math.h>
#include <stdlib.h>

#define FAIL(...) tm_fail(error, TM_ERROR_INTERNAL, __VA_ARGS__)

/* A face is covered and linked, and near the nodes it keeps; these are counted. */
static tm_status check_face(tm_envelope *e, const tm_tet_mesh *mesh, uint32_t f,
                            uint32_t *kept, tm_error *error)
{
    const double rounding = 1 + 1e-9;
    const uint32_t *n = mesh->face[f].node;
    const double *p = mesh->xyz[n[0]], *q = mesh->xyz[n[1]], *r = mesh->xyz[n[2]];
    tm_covered triangle = {{p, q, r}, e->below[f]};
    if (!tm_envelope_covers(e, &triangle))
        return FAIL("face %u is not covered by the reference", f);
    if (!tm_envelope_is_linked(e, e->below[f], f))
        return FAIL("face %u is not known above triangle %u", f, e->below[f]);
    for (uint32_t v = e->first_kept[f]; v != TM_NONE; v = e->next_kept[v]) {
        if (!(sqrt(tm_triangle_distance2(e->reference->xyz[v], p, q, r)) <=
              e->tolerance * rounding))
            return FAIL("node %u of the reference is far from face %u", v, f);
        if (kept[v]++ > 0)
            return FAIL("node %u of the reference is kept twice", v);
    }
    return TM_OK;
}

tm_status tm_envelope_check(tm_envelope *envelope, const tm_tet_mesh *mesh,
                            tm_error *error)
{
    const tm_surface *reference = envelope->reference;
    uint32_t *kept = calloc(reference->nodes + 1, sizeof *kept);
    tm_status status = kept ? TM_OK : tm_fail_memory(error);
    for (uint32_t f = 0; f < mesh->faces && status == TM_OK; f++)
        if (mesh->face[f].side[0] != TM_NONE || mesh->face[f].side[1] != TM_NONE)
            status = check_face(envelope, mesh, f, kept, error);
    for (size_t c = 0; c < reference->curves && status == TM_OK; c++)
        for (size_t k = reference->curve_start[c]; k < reference->curve_start[c + 1]; k++)
            kept[reference->curve_node[k]] = 1;
    for (size_t k = 0; k < reference->corners && status == TM_OK; k++)
        kept[reference->corner[k]] = 1;
    for (size_t v = 0; v < reference->nodes && status == TM_OK; v++)
        if (kept[v] == 0)
            status = FAIL("node %zu of the reference is kept by no face", v);
    free(kept);
    return status;
}
