/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangles while they are mended, and their edges. */
#ifndef TM_SURFACE_MEND_SOUP_H
#define TM_SURFACE_MEND_SOUP_H

#include "../../mesh/polygon_edges.h"
#include "mend.h"

#include <math.h>

typedef struct tm_soup {
    size_t nodes;
    const double (*xyz)[3];
    size_t triangles, room, marker_room;
    uint32_t (*triangle)[3];
    int32_t *marker; /* [triangles]; NULL where there are none */
    double diagonal; /* of the box */
    size_t *start;   /* [triangles + 1]: 0, 3, 6, … for the edges */
    size_t start_room;
    tm_polygon_edges edges; /* of the triangles as they were when they were looked for */
    size_t open, crowded;   /* edges of one triangle, of three or more */
} tm_soup;

/* Takes the triangles of .face over, which has none then; and gives them back. */
tm_status tm_soup_take(tm_soup *soup, tm_stream *stream, tm_error *error);
void tm_soup_give(tm_soup *soup, tm_stream *stream);
void tm_soup_free(tm_soup *soup);

/* A copy, to go back to. */
tm_status tm_soup_copy(tm_soup *copy, const tm_soup *soup, tm_error *error);

/* Finds edges, open and crowded. O(n). */
tm_status tm_soup_find_edges(tm_soup *soup, tm_error *error);

/* Appends a triangle. */
tm_status tm_soup_add(tm_soup *soup, const uint32_t node[3], int32_t marker,
                      tm_error *error);

/* Drops those of the first `count` triangles that are marked; keeps the order. */
void tm_soup_drop(tm_soup *soup, const bool *gone, size_t count);

/* Boxes around places; of none the diagonal is no number. */
typedef struct tm_soup_box {
    double low[3], high[3];
} tm_soup_box;

#define TM_SOUP_NO_BOX                                                                   \
    {                                                                                    \
        {HUGE_VAL, HUGE_VAL, HUGE_VAL},                                                  \
        {                                                                                \
            -HUGE_VAL, -HUGE_VAL, -HUGE_VAL                                              \
        }                                                                                \
    }

void tm_soup_put_in_box(tm_soup_box *box, const double place[3]);
double tm_soup_box_diagonal(const tm_soup_box *box);

/* Whether side i, from corner i to i + 1, of triangle t is an open edge. */
static inline bool tm_soup_is_open(const tm_soup *soup, size_t t, unsigned i)
{
    const size_t e = soup->edges.edge_of[3 * t + i];
    return soup->edges.start[e + 1] - soup->edges.start[e] == 1;
}

/* Counts one thing that was done, at a node. */
static inline void tm_mend_count(tm_mended *step, const double place[3])
{
    for (int x = 0; x < 3 && step->count == 0; x++)
        step->place[x] = place[x];
    step->count++;
}

/* The steps; each leaves edges to be found again. tm_soup_weld() gives nodes, all or
 * those of open edges, that are no farther apart than `within` the number of the first of
 * them. Flat is a triangle that is no higher than `within`. */
tm_status tm_soup_weld(tm_soup *soup, double within, bool all, tm_mended *welded,
                       tm_error *error);
tm_status tm_soup_drop_degenerate(tm_soup *soup, tm_mended *dropped, tm_error *error);
tm_status tm_soup_drop_flat(tm_soup *soup, double within, tm_mended *dropped,
                            tm_error *error);
bool tm_soup_has_flat(const tm_soup *soup, double within);
tm_status tm_soup_drop_doubles(tm_soup *soup, bool all, tm_mended *dropped,
                               tm_error *error);
/* Whether two triangles have the same nodes, or many an edge: by the edges, which are to
 * be those of the triangles as they are. */
bool tm_soup_has_doubles(const tm_soup *soup);
tm_status tm_soup_drop_quads(tm_soup *soup, double within, bool all, tm_mended *dropped,
                             tm_error *error);
tm_status tm_soup_split(tm_soup *soup, double within, tm_mended *split, tm_error *error);
tm_status tm_soup_fill(tm_soup *soup, double most, tm_mended *filled, tm_error *error);
tm_status tm_soup_drop_islands(tm_soup *soup, double most, tm_mended *dropped,
                               tm_error *error);
/* *closed becomes whether each edge has two triangles, which turn alike now. */
tm_status tm_soup_turn(tm_soup *soup, tm_mended *turned, bool *closed, tm_error *error);

/* near.c: nodes by cells of a grid */

typedef struct tm_near {
    const double (*xyz)[3];
    double cell; /* side */
    size_t slots;
    uint32_t *first, *next; /* [slots], [nodes]; TM_NONE */
} tm_near;

/* Of the nodes that are listed. */
bool tm_near_make(tm_near *near, const double (*xyz)[3], size_t nodes,
                  const uint32_t *list, size_t count, double cell);
void tm_near_free(tm_near *near);

/* The first node of the cell at place + offset, others by next; some of other cells may
 * be among them. */
uint32_t tm_near_first(const tm_near *near, const double place[3], const int offset[3]);

/* Lists, malloc'ed, the nodes of open edges, each once, ascending. */
bool tm_soup_open_nodes(const tm_soup *soup, uint32_t **list, size_t *count);

#endif
