/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "private_signals.h"

#include <signal.h>
#include <stddef.h>

static const int held[] = {SIGINT, SIGTERM, SIGHUP};
enum { HELD = sizeof held / sizeof held[0] };

static struct sigaction before[HELD];
static int holds; /* that were not released yet */
static volatile sig_atomic_t came;
static volatile pid_t child_group;

static void note(int signal_number)
{
    came = signal_number;
    if (child_group > 0)
        kill(-child_group, SIGKILL);
}

void private_signals_hold(void)
{
    if (holds++ > 0)
        return;
    struct sigaction action = {.sa_handler = note};
    sigemptyset(&action.sa_mask);
    came = 0;
    for (size_t i = 0; i < HELD; i++) {
        sigaction(held[i], NULL, &before[i]);
        if (before[i].sa_handler != SIG_IGN)
            sigaction(held[i], &action, NULL);
    }
}

static void mask(int how)
{
    sigset_t set;
    sigemptyset(&set);
    for (size_t i = 0; i < HELD; i++)
        sigaddset(&set, held[i]);
    sigprocmask(how, &set, NULL);
}

void private_signals_block(void)
{
    mask(SIG_BLOCK);
}

void private_signals_unblock(void)
{
    mask(SIG_UNBLOCK);
}

void private_signals_kill(pid_t group)
{
    child_group = group;
}

bool private_signals_came(void)
{
    return came != 0;
}

void private_signals_release(void)
{
    if (--holds > 0)
        return;
    for (size_t i = 0; i < HELD; i++)
        sigaction(held[i], &before[i], NULL);
    if (came)
        raise(came);
}
