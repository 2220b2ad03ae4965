/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lists of jens-stats: a line for each element. */
#ifndef CMD_COMMON_JENS_LIST_H
#define CMD_COMMON_JENS_LIST_H

#include "../../../lib/base/error.h"
#include "../../../lib/base/text.h"
#include "../../../lib/examine/jens_statistics.h"

typedef enum jens_list_kind {
    JENS_LIST_ELEMENTS, /* J_ENS and J_S, the least of the corners each */
    JENS_LIST_ASPECT,   /* the aspect ratio */
    JENS_LIST_NODES,    /* J_ENS of each node, in the order of the element's nodes */
    JENS_LIST_VERDICT   /* the scaled Jacobian and the shape, as in verdict.h */
} jens_list_kind;

/* Appends the lines: the element's number, from base, and its values, in the shortest
 * form that reads back to the same double; the same for every number of threads. */
tm_status jens_list(tm_text *text, jens_list_kind kind, const tm_elements *elements,
                    unsigned base, unsigned threads, tm_error *error);

#endif
