/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Ends a long operation early, so that what is best until then is written: at the first
 * SIGINT or SIGTERM (a second one ends the program), or after so many seconds. */
#ifndef CMD_COMMON_EARLY_END_H
#define CMD_COMMON_EARLY_END_H

#include "../../../lib/base/stop.h"

/* From now on, with `seconds` > 0 for so long by the clock on the wall. */
void early_end_begin(double seconds);

/* What the library is to be given where it takes a tm_stop. */
const tm_stop *early_end_stop(void);

/* Whether a signal came; whether the time is over. */
bool early_end_by_signal(void);
bool early_end_by_time(void);

/* Signals end the program again, as they did before. */
void early_end_finish(void);

#endif
