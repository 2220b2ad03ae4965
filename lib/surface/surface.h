/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A closed triangle surface that bounds a solid: which points are inside, what of the
 * surface is closest, where it is sharp. All queries only read it: threads may ask at the
 * same time. */
#ifndef TM_SURFACE_SURFACE_H
#define TM_SURFACE_SURFACE_H

#include "../base/extern_c.h"
#include "polygon_surface.h"

TM_EXTERN_C_BEGIN

/* An edge is sharp where the normals beside it differ, and where the markers do. Sharp
 * edges are chained to curves that end at corners: nodes where another number than
 * two sharp edges meet, or where two meet at a sharp angle that the next node of the
 * curve does not take back, and tips, where the angles of the triangles sum up to less
 * than 180°. An open edge is sharp. A rough surface has many short curves: see
 * curve_length. A closed curve without a corner has its first node again as its last. A
 * patch is a set of triangles connected across edges that are not sharp.
 *
 * Where walls meet, at edges of three triangles or more, these are not across each other,
 * and the edge is sharp; it is not counted as open. A shell is then what is connected
 * over any edges, and `inside` means: in any region. */
typedef struct tm_surface {
    size_t nodes;
    double (*xyz)[3];
    size_t triangles;
    uint32_t (*triangle)[3]; /* seen from outside they turn counter-clockwise */
    int32_t *marker;         /* [triangles], or NULL where the file has none */
    tm_block group;          /* the names of markers: group.h */
    uint32_t *facet;         /* [triangles]: the facet of the file it is from */
    uint32_t *origin;        /* [nodes]: the node of the file */
    uint32_t (*across)[3];   /* the triangle beyond the edge from corner i to i + 1;
                                TM_NONE at an open edge */
    uint32_t *shell;         /* [triangles]: the piece connected over edges */
    uint32_t *patch;         /* [triangles] */
    size_t patches;
    size_t curves;
    size_t *curve_start;  /* [curves + 1] */
    uint32_t *curve_node; /* nodes of curve c: curve_start[c] … curve_start[c + 1) */
    uint32_t (*curve_patch)[2]; /* [curves]: the patches at its first segment */
    double *curve_length;       /* [curves] */
    size_t corners;
    uint32_t *corner; /* nodes */
    double low[3], high[3];
    struct tm_surface_tree *tree; /* bounding boxes; see surface_tree.h */

    size_t welded;     /* nodes that had another where they are */
    size_t flat;       /* triangles without area that were dropped, or went by a flip */
    size_t duplicates; /* triangles that were there twice, dropped */
    size_t touching;   /* where nodes have more than one fan of triangles: fans more */
    bool turned;       /* some or all triangles turned the other way */
    size_t components; /* connected pieces of surface: shells */
    int64_t euler;     /* nodes - edges + triangles, of all shells; a node counts once for
                          each fan of triangles around it */
    size_t open_edges; /* with one triangle; 0 unless lenient */
    size_t crossings;  /* pairs of triangles that meet elsewhere than in a common node or
                          edge; 0 unless lenient */
    bool rough; /* some of it has sharp edges all over that are not taken for any */
    size_t rough_edges; /* these */
    bool by_winding;    /* the inside is where the winding number is above 1/2 */
    bool regions;   /* what a shell in another one encloses is a region of its own, else a
                       hole; of each shell region[shell] is that which it is around, or,
                       where the file has none, region is NULL: 1 and more */
    double *region; /* [components]; with walls [cells] */
    bool walls;     /* some edges have three triangles or more: walls between regions */
    size_t cells;   /* with walls: the regions, numbered from 1; 0 is outside */
    uint32_t (*side)[2]; /* [triangles]: the region where its normal points, and the one
                            behind it, which has the larger number; NULL without walls */
    size_t repeated_regions; /* of the file, in one with another one before */
    size_t holes;            /* points in what is a hole all the same */
    double (*hole)[3];
    unsigned threads; /* how many may ask it at a time, where there is much to ask */
} tm_surface;

/* The default of feature_angle: degrees. */
#define TM_FEATURE_ANGLE 40.0

typedef struct tm_surface_options {
    double feature_angle; /* an edge is sharp where its normals differ by more: degrees */
    bool unless_rough;    /* no edge of a body is, where many of those end freely; but
                             what is long and smooth around: surface_loose.h */
    bool lenient;         /* open surfaces, and such that cross themselves, are taken */
    bool regions;         /* a shell in another one bounds a region, not a hole */
    bool walls;           /* walls between regions are taken, where no edge is open */
    unsigned threads;     /* for what is made with the surface, see there; 0: one */
} tm_surface_options;

/* Makes the surface of the polygons: nodes with equal coordinates become one, polygons
 * are cut to triangles, triangles with a node twice and duplicates go, so do nodes that
 * none has. A triangle whose three nodes are on a line goes by flipping its longest edge;
 * where that cannot be it stays. Each shell is oriented; one that an even number of
 * others encloses is turned so that its volume is positive, the others (cavities) so that
 * it is negative. Where an edge has four or more triangles, solids touch: the triangles
 * on both sides of each solid wedge become neighbours, by the file's orientation. Where
 * some are odd and no edge is open there are walls between regions, with `walls`: each
 * part of space that is closed in is one, but for those of the file's holes, and the
 * triangles are turned to the region with the smaller number.
 *
 * TM_ERROR_INPUT, with counts and a position, in the numbers of the file, where nothing
 * is left, coordinates are too large or too small (stream/coordinates.h), a facet has
 * several polygons or holes; and unless lenient where an edge has one triangle, or more
 * than two that do not pair, where a shell cannot be oriented, or where two triangles
 * meet otherwise than in common nodes and edges, exactly (touching is meeting). With
 * lenient the surface is cut open at edges of the third and fourth kind. With `regions`
 * also where a region of the file is in no shell; with walls also where one has the same
 * region on both sides, or the surface crosses itself.
 *
 * *surface need not be initialised; tm_surface_free() also after an error.
 * O(n log n). */
tm_status tm_surface_build(tm_surface *surface, const tm_polygon_surface *polygons,
                           const tm_surface_options *options, tm_error *error);

void tm_surface_free(tm_surface *surface);

/* Verifies what this header states of the arrays. TM_ERROR_INTERNAL with the first thing
 * that does not hold. O(n log n), for tests and self-checks. */
tm_status tm_surface_check(const tm_surface *surface, tm_error *error);

/* A point of the surface. */
typedef struct tm_surface_point {
    double xyz[3];
    double distance2;  /* squared distance to the point that was asked for */
    uint32_t triangle; /* on it, or on its border */
} tm_surface_point;

/* The point of the surface (of one patch; TM_NONE: any) closest to a point. Where
 * at->triangle is not TM_NONE it is a guess, and the search only looks for what is
 * closer. Expected O(log n); below 1 µs with a near guess. */
void tm_surface_closest(const tm_surface *surface, const double point[3], uint32_t patch,
                        tm_surface_point *at);

/* The point of a curve closest to a point; `segment` is the first of its two nodes,
 * counted from curve_start[curve]. */
void tm_surface_closest_on_curve(const tm_surface *surface, uint32_t curve,
                                 const double point[3], double closest[3],
                                 size_t *segment);

/* Whether a point is inside, against the whole surface. A point on the surface is either,
 * always the same.
 *
 * The number of triangles that a ray along an axis meets is odd. That is exact, as the
 * orientations are, and the point is moved by an infinitesimal amount across the ray
 * where that runs through an edge or a node (H. Edelsbrunner and E. P. Mücke, Simulation
 * of simplicity, ACM Transactions on Graphics 9, 1990): there is no ray that does not
 * count. A surface that is open or crosses itself (lenient) has by_winding: a ray through
 * a hole would be wrong, and what overlaps is inside. There the generalised winding
 * number must be above 1/2 (A. Jacobson, L. Kavan, O. Sorkine-Hornung, Robust
 * inside-outside segmentation using generalized winding numbers, 2013), from dipoles of
 * whole boxes where they are far (G. Barill, N. G. Dickson, R. Schmidt, D. I. W. Levin,
 * A. Jacobson, Fast winding numbers for soups and clouds, 2018): its mean
 * error is below 0.01, the largest about 0.1. */
bool tm_surface_has_inside(const tm_surface *surface, const double point[3]);

/* The region that a point is in, of a surface with walls; 0: outside. By the same ray:
 * each triangle that it meets leads from one region to another. */
uint32_t tm_surface_region_at(const tm_surface *surface, const double point[3]);

/* Whether at a point is what triangle t has beside it, before (0) or behind (1): the
 * region there, or where there are no walls the outside and the inside. */
bool tm_surface_is_beside(const tm_surface *surface, size_t t, int behind,
                          const double point[3]);

/* The volume of each shell, [components]; negative where it looks inward. */
void tm_surface_shell_volumes(const tm_surface *surface, double *volume);

/* Whether a point is in what is meshed: inside, or with `regions` within any shell. */
bool tm_surface_has_mesh(const tm_surface *surface, const double point[3]);

/* The generalised winding number, near 1 inside and 0 outside; for surfaces that have
 * by_winding. */
double tm_surface_winding_number(const tm_surface *surface, const double point[3]);

/* Where the solid, or a gap in it, is thin: looks for a triangle from whose centre the
 * surface is left again within a distance, along its normal to either side, first within
 * an eighth of `most`, then a quarter, a half, all of it. Fills centre with the first
 * such one; false where there is none. O(triangles) queries. */
bool tm_surface_find_thin(const tm_surface *surface, double most, double centre[3]);

/* Whether some of the surface is in the closed box: true also where it only is within
 * rounding of it. */
bool tm_surface_meets_box(const tm_surface *surface, const double low[3],
                          const double high[3]);

/* Those of the triangles list[0 … count) that are in the closed box, by the same test and
 * in the same order, to kept, which may be list. Returns how many. O(count). */
size_t tm_surface_cull(const tm_surface *surface, const uint32_t *list, size_t count,
                       const double low[3], const double high[3], uint32_t *kept);

TM_EXTERN_C_END

#endif
