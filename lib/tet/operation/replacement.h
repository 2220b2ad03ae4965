/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Replacement of a cavity: some tetrahedra go, others that fill the same space come. All
 * operations but those that change a mesh in place are made of it. */
#ifndef TM_OPERATION_REPLACEMENT_H
#define TM_OPERATION_REPLACEMENT_H

#include "../mesh.h"

/* A face that stays in its surface but not in its triangle: it gets other nodes. */
typedef struct tm_face_renewal {
    uint32_t face;
    uint32_t node[3];
} tm_face_renewal;

struct tm_face_slot;

typedef struct tm_replacement {
    const uint32_t *old; /* the cavity: tetrahedra of one region */
    size_t old_count;
    const uint32_t (*node)[4]; /* positive, and filling the cavity exactly */
    size_t count;
    const tm_face_renewal *renewal; /* of constrained faces at the cavity */
    size_t renewals;                /* 0 or 2 */
    uint32_t *created;              /* [count]: the tetrahedra made */
} tm_replacement;

/* Memory that replacements share; {0} is none. */
typedef struct tm_replacement_table {
    struct tm_face_slot *slot;
    uint8_t *state; /* of each slot */
    size_t room;
} tm_replacement_table;

void tm_replacement_table_free(tm_replacement_table *table);

/* Memory for replacements of so many tetrahedra by so many: they cannot fail for it then.
 * False where memory is out. */
bool tm_replacement_table_reserve(tm_replacement_table *table, size_t old_count,
                                  size_t count);

/* Does it. No face inside the cavity may be constrained. TM_ERROR_SYSTEM, with nothing
 * changed, where memory is out. Expected O(old_count + count). */
tm_status tm_tet_replace(tm_tet_mesh *mesh, const tm_replacement *what,
                         tm_replacement_table *table, tm_error *error);

#endif
