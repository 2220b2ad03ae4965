/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of lepp-improve, and what they ask for. */
#ifndef CMD_COMMON_IMPROVE_SETTINGS_H
#define CMD_COMMON_IMPROVE_SETTINGS_H

#include "../../../lib/tet/improve/improve.h"
#include "../../../lib/tet/lepp/lepp.h"
#include "../app/filter.h"
#include "../input/tet_set.h"

/* What is to be done, by one of two engines. */
typedef struct improve_settings {
    bool is_improve;
    bool is_length; /* the surface's tolerance is one, not a part of the diagonal */
    tm_improve_options improve;
    tm_lepp_options lepp;
    tet_set set;      /* --set; no rules: all that is bad */
    const char *plot; /* NULL: none */
} improve_settings;

/* For the filter: how it is called, and the options with their words. */
extern const char improve_synopsis[], improve_help[], improve_letters[];
extern const struct option improve_options[];
extern const filter_words improve_words[];

/* Reads the options; those that do not go together are a usage error. */
improve_settings improve_settings_read(filter *f);

/* Whether tetrahedra are made small: --until-size. */
bool improve_has_sizes(const improve_settings *o);

#endif
