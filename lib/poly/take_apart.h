/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regions taken apart into pieces that are balls (shelling.h), each by itself: what is
 * made of a region does not depend on the others, but by the centroid. */
#ifndef TM_POLY_TAKE_APART_H
#define TM_POLY_TAKE_APART_H

#include "shelling.h"

/* Takes the regions label[slots], 0 … report->regions-1, of a shelling's mesh apart; none
 * of its tetrahedra is in a piece yet. A region whose pieces are a ball together is one,
 * if its options ask for no more than balls. Pieces get numbers below slots, some of
 * which are of none, ascending by their regions and then as they were begun.
 * Those labelled report->regions are in no region, and in no piece then.
 * report->taken_apart is how many regions are several. Regions are taken several at a
 * time, by options->threads, unless stars are by the centroid. Expected O(slots). */
tm_status tm_take_apart(tm_shelling *s, const uint32_t *label, tm_poly_report *report,
                        tm_error *error);

#endif
