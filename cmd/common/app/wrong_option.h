/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef CMD_COMMON_WRONG_OPTION_H
#define CMD_COMMON_WRONG_OPTION_H

#include "filter.h"

/* The usage error for what getopt_long() has just refused: an option that is unknown (and
 * the nearest one), ambiguous (and what it could be), lacks its argument, or takes none.
 */
_Noreturn void filter_wrong_option(const filter *f);

#endif
