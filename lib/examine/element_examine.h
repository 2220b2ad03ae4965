/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Examines tetrahedra or mixed elements as they came, which may be wrong in any way:
 * nothing is turned, dropped or refused. */
#ifndef TM_EXAMINE_ELEMENT_EXAMINE_H
#define TM_EXAMINE_ELEMENT_EXAMINE_H

#include "../base/extern_c.h"
#include "../base/error.h"
#include "../mesh/mesh_view.h"
#include "examination.h"

TM_EXTERN_C_BEGIN

/* Fills *found, with `mixed` set where the view is not of tetrahedra alone. An element
 * that names a node twice is counted as degenerate and takes no part in anything else. An
 * element is inverted if the determinant of one of its corners is negative, else
 * degenerate if one is zero, exactly; see mixed_volume.h. It is turned if all that are
 * not zero are negative, upright if they are positive; else it has no side, as if it was
 * flat.
 *
 * Faces are the same if they have the same nodes in the same cyclic order, from wherever
 * and in whichever sense. TM_UNMATCHED_FACE counts faces of more than two elements;
 * quadrilaterals with the nodes of another one in another cyclic order; and pairs of a
 * triangle and a quadrilateral that are faces of one element each and have three nodes in
 * common. Two elements at a face overlap if both have a side, and it is the same.
 *
 * A row of .facet is dangling unless it is a face of the elements that it names, and of
 * no others, and turns as termesh-stream(5) says (either way, where the first one has no
 * side). The edges and vertices that are examined for being open or not manifold are
 * those of the boundary faces, which belong to one element. Volumes: tm_mixed_volume().
 * The result is the same for every number of threads. Tetrahedra alone have the same
 * defects as the same ones among mixed elements. TM_ERROR_SYSTEM where memory is out or
 * tm_face_table_make() says so. Expected O(nodes + elements + rows). */
tm_status tm_element_examine(tm_examination *found, const tm_mesh_view *mesh,
                             unsigned threads, tm_error *error);

TM_EXTERN_C_END

#endif
