/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether the Jacobian determinant of an element is positive everywhere in it, which its
 * corners alone do not say: a hexahedron can be inverted inside, or at an edge or a face,
 * though no corner is.
 *
 * The determinant is a polynomial. Written in Bernstein polynomials it is nowhere below
 * the least of its coefficients, which are cheap; where that is not enough the element is
 * halved, and halved again (A. Johnen, J.-F. Remacle, C. Geuzaine, Geometrical validity
 * of curvilinear finite elements, 2013). What is left to do depends on the kind:
 *
 * - tetrahedron: the determinant is constant.
 * - pyramid, as VTK has it: a hexahedron whose top is drawn together in the apex,
 *   x(ξ, η, ζ) = (1-ζ) Q(ξ, η) + ζ A with the bilinear base Q. The determinant is (1-ζ)²
 *   times det(Q_ξ, Q_η, A-Q), in which all terms of higher degree cancel: it is bilinear
 *   in ξ and η, so that it is positive if it is at the four corners of the base. The
 *   factor, 0 at the apex only, belongs to the map and not to the element.
 * - wedge: linear along the triangle and quadratic from one triangle to the other, so
 *   that it is positive if it is along the three lateral edges.
 * - hexahedron, trilinear: of degree 2 in each of ξ, η, ζ; 27 coefficients.
 *
 * Nothing here is left to rounding: signs at corners are exact (../geom/predicates.h),
 * and coefficients count with a bound of their errors. */
#ifndef TM_ELEMENT_CERTIFY_H
#define TM_ELEMENT_CERTIFY_H

#include "../base/extern_c.h"

#include <stddef.h>
#include <stdint.h>

TM_EXTERN_C_BEGIN

typedef enum tm_certificate {
    TM_POSITIVE,     /* proved: everywhere in the element, its boundary included */
    TM_NOT_POSITIVE, /* proved: zero or negative somewhere */
    TM_UNDECIDED     /* as near to zero as rounding, or as the last halving, can tell */
} tm_certificate;

/* Of an element of so many nodes, 4, 5, 6 or 8, in the order of shape.h.
 * Coordinates must be finite. Nearly always O(1): 20 ns for a tetrahedron, 0.2 µs for a
 * hexahedron; a hexahedron is halved TM_CERTIFY_BOXES times at most. */
tm_certificate tm_certify(size_t nodes, const double (*xyz)[3], const uint32_t *item);

enum { TM_CERTIFY_BOXES = 20000 };

TM_EXTERN_C_END

#endif
