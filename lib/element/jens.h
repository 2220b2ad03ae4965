/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quality of tetrahedra, pyramids, wedges and hexahedra: the scaled Jacobian of a corner
 * and the element-normalised one, J_ENS.
 *
 * The scaled Jacobian J_S of a corner is the determinant of the three edge vectors that
 * leave it, each of length 1, in the element's positive order: in [-1, 1], negative where
 * the corner is inverted. J_ENS is 1 where J_S is the K that the corner has in a regular
 * element:
 *
 *     J_ENS =  (1 + K) - J_S   if J_S >  K
 *           =   J_S / K        if -K <= J_S <= K
 *           = -(1 + K) - J_S   if J_S < -K
 *
 * (S. Donoso, 2022, after E. Daines and C. Lobos, 2018). An element is as good as its
 * worst corner. A corner with an edge of length 0 has J_S = 0, as a flat one has: it is
 * not inverted, nor is it valid. So is one whose edges overflow.
 *
 * The nodes of elements are in the order of ../mixed/mixed_mesh.h, by which positive
 * means with a positive volume. */
#ifndef TM_ELEMENT_JENS_H
#define TM_ELEMENT_JENS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* The constants K. That of the apex is J_S at the apex of the pyramid whose base corners
 * have √6/3: a square base, and as high as the base is wide. */
#define TM_SQRT_2 1.41421356237309504880
#define TM_SQRT_3 1.73205080756887729353
#define TM_SQRT_6 2.44948974278317809820

#define TM_K_TETRAHEDRON  (TM_SQRT_2 / 2)
#define TM_K_PYRAMID_BASE (TM_SQRT_6 / 3)
#define TM_K_PYRAMID_APEX (2 * TM_SQRT_6 / 9)
#define TM_K_WEDGE        (TM_SQRT_3 / 2)
#define TM_K_HEXAHEDRON   1.0

enum { TM_CORNERS_MOST = 8, TM_ELEMENT_NODES_MOST = 8 };

/* The corners of an element. Corner i is at node[i][0], and its three neighbours, in
 * positive order, are node[i][1 … 3]. A pyramid has eight: those of its base, and at its
 * apex each three lateral edges that follow each other. */
typedef struct tm_element_shape {
    size_t corners;
    unsigned char node[TM_CORNERS_MOST][4];
    double k[TM_CORNERS_MOST];
} tm_element_shape;

/* By the number of nodes: 4 tetrahedron, 5 pyramid, 6 wedge, 8 hexahedron; others have no
 * corners. */
extern const tm_element_shape tm_element_shapes[TM_ELEMENT_NODES_MOST + 1];

/* J_ENS of a corner with that J_S. */
static inline double tm_jens_of(double jacobian, double k)
{
    if (jacobian > k)
        return (1 + k) - jacobian;
    return jacobian >= -k ? jacobian / k : -(1 + k) - jacobian;
}

/* J_S of every corner, in the order of the shape, which is one of tm_element_shapes; item
 * are the element's nodes. */
void tm_scaled_jacobians(const tm_element_shape *shape, const double (*xyz)[3],
                         const uint32_t *item, double jacobian[TM_CORNERS_MOST]);

/* J_ENS of an element of so many nodes, 4, 5, 6 or 8: the least of its corners. */
double tm_jens(size_t nodes, const double (*xyz)[3], const uint32_t *item);

/* The least scaled Jacobian of its corners. */
double tm_least_scaled_jacobian(size_t nodes, const double (*xyz)[3],
                                const uint32_t *item);

/* J_S of the corner at p with the neighbours a, b, c in positive order. */
double tm_scaled_jacobian(const double p[3], const double a[3], const double b[3],
                          const double c[3]);

/* The same with slope[i] its derivative with respect to p, a, b, c (i = 0 … 3), which is
 * 0 where the value is no derivative of anything: an edge of length 0. */
double tm_scaled_jacobian_slope(const double p[3], const double a[3], const double b[3],
                                const double c[3], double slope[4][3]);

/* The derivative of tm_jens_of() with respect to J_S; at ±K that from the middle. */
static inline double tm_jens_slope_of(double jacobian, double k)
{
    return fabs(jacobian) <= k ? 1 / k : -1;
}

#endif
