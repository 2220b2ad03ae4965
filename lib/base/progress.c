/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

void tm_progress_stage(const tm_progress *progress, const char *what)
{
    const tm_progress_at at = {.what = what};
    tm_progress_tell(progress, &at);
}

static void report_within(void *context, const tm_progress_at *at)
{
    const tm_progress_within *within = context;
    tm_progress_at outer = *at;
    outer.what = within->what;
    outer.doing = at->what;
    tm_progress_tell(within->outer, &outer);
}

const tm_progress *tm_progress_begin_within(tm_progress_within *within,
                                            const tm_progress *outer, const char *what)
{
    *within = (tm_progress_within){{report_within, within}, outer, what};
    tm_progress_stage(outer, what);
    return outer ? &within->inner : NULL;
}
