/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What polylla3d is asked for: its options, and which of them go together. */
#ifndef CMD_COMMON_POLY_SETTINGS_H
#define CMD_COMMON_POLY_SETTINGS_H

#include "../../../lib/poly/partition.h"
#include "../app/filter.h"

extern const struct option poly_options[];
extern const filter_words poly_option_words[];
extern const char poly_options_help[];

typedef struct poly_settings {
    tm_poly_options poly;
    bool partition;   /* is given, */
    size_t attribute; /* by this one, from 1; 0: the last one */
    bool merge, ignore_markers, label;
    size_t levels;  /* coarser ones */
    bool any;       /* of the other options is given */
    bool for_tets;  /* one that is for tetrahedra alone */
    double degrees; /* of --merge-coplanar */
} poly_settings;

/* Reads all options; those that do not go together end the program. */
poly_settings poly_settings_read(filter *f);

#endif
