/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

void tm_progress_stage(const tm_progress *progress, const char *what)
{
    const tm_progress_at at = {.what = what};
    tm_progress_tell(progress, &at);
}
