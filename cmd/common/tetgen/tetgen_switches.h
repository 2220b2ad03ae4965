/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers and letters as TetGen reads them on its command line. */
#ifndef CMD_COMMON_TETGEN_SWITCHES_H
#define CMD_COMMON_TETGEN_SWITCHES_H

#include "tetgen.h"

/* "-a0.1" */
void tetgen_volume_switch(char to[TETGEN_SWITCH], double value);

/* "-q1.4", without an exponent, which TetGen does not read in a ratio. */
void tetgen_ratio_switch(char to[TETGEN_SWITCH], double value);

/* Takes more switches for a request, whose text becomes *more: a usage error where
 * TetGen has no such one, or where it would need files or do nothing. */
void tetgen_take_switches(const filter *f, tetgen_request *r, tm_text *more,
                          const char *switches);

#endif
