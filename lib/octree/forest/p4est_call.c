/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "p4est_call.h"

#include <p4est.h>
#include <setjmp.h>

static jmp_buf before;

/* What libsc calls in place of abort(). */
static void leave(void)
{
    longjmp(before, 1);
}

tm_status tm_p4est_call(void (*work)(void *), void *user, tm_error *error)
{
    if (setjmp(before) != 0) {
        sc_set_abort_handler(NULL);
        return tm_fail_memory(error);
    }
    sc_set_abort_handler(leave);
    work(user);
    sc_set_abort_handler(NULL);
    return TM_OK;
}
