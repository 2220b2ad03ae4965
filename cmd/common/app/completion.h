/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CMD_COMMON_COMPLETION_H
#define CMD_COMMON_COMPLETION_H

#include "filter.h"

/* For cmd/completion.sh, which asks each filter when termesh is built: the tables of its
 * options. A line for each option: its letter or "-", its long name, whether there
 * is an argument (none, required, optional), and the words that may be it; with blanks
 * between. Ends the program. */
_Noreturn void filter_print_completion(const filter *f);

#endif
