/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What lepp-improve has done, and how that is said. */
#ifndef CMD_COMMON_IMPROVE_RESULT_H
#define CMD_COMMON_IMPROVE_RESULT_H

#include "../../../lib/examine/tet_statistics.h"
#include "../../../lib/tet/improve/improve_forced.h"
#include "improve_settings.h"

/* What was done, by the engine that did it. */
typedef struct improve_result {
    tm_improve_report improve;
    tm_lepp_report lepp;
    tm_forced forced;                /* with improve */
    tm_tet_statistics before, after; /* with --json */
    double seconds;
    size_t changes;
    size_t set_before, set_after; /* tetrahedra; with --set */
} improve_result;

/* One line about the run, of a mesh that has so many tetrahedra now. */
void improve_result_summarise(const improve_settings *o, const improve_result *r,
                              size_t tets, char *text, size_t size);

/* Notes of what could not be done as it was asked for. */
void improve_result_note(const filter *f, const improve_settings *o,
                         const improve_result *r);

/* The report of --json. */
void improve_result_json(filter *f, const improve_settings *o, const improve_result *r);

#endif
