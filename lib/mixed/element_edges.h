/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The edges of each kind of element, in the node order of .mix. */
#ifndef TM_MIXED_ELEMENT_EDGES_H
#define TM_MIXED_ELEMENT_EDGES_H

#include <stdint.h>

typedef struct tm_element_edges {
    uint8_t count;
    uint8_t edge[12][2];
} tm_element_edges;

/* Those of an element of k = 4, 5, 6 or 8 nodes. */
static inline const tm_element_edges *tm_element_edges_of(unsigned k)
{
    static const tm_element_edges edges[] = {
        {6, {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}},
        {8, {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
        {9, {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
        {0, {{0, 0}}},
        {12,
         {{0, 1},
          {1, 2},
          {2, 3},
          {3, 0},
          {4, 5},
          {5, 6},
          {6, 7},
          {7, 4},
          {0, 4},
          {1, 5},
          {2, 6},
          {3, 7}}}};
    return &edges[k - 4];
}

#endif
