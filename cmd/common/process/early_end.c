/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "early_end.h"

#include <signal.h>
#include <time.h>

static const int signals[] = {SIGINT, SIGTERM};
enum { SIGNALS = sizeof signals / sizeof *signals };

static volatile sig_atomic_t came;
static struct sigaction before[SIGNALS];
static double limit, start; /* seconds; no limit: 0 */
static bool is_over;

static void note(int signal_number)
{
    came = signal_number;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void early_end_begin(double seconds)
{
    struct sigaction action = {.sa_handler = note, .sa_flags = (int)SA_RESETHAND};
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < SIGNALS; i++) {
        sigaction(signals[i], NULL, &before[i]);
        if (before[i].sa_handler != SIG_IGN) /* nohup, or in the background */
            sigaction(signals[i], &action, NULL);
    }
    limit = seconds;
    start = now();
}

bool early_end_by_signal(void)
{
    return came != 0;
}

bool early_end_by_time(void)
{
    is_over = is_over || (limit > 0 && now() - start >= limit);
    return is_over;
}

static bool is_wanted(void *unused)
{
    (void)unused;
    return early_end_by_signal() || early_end_by_time();
}

const tm_stop *early_end_stop(void)
{
    static const tm_stop stop = {is_wanted, NULL};
    return &stop;
}

void early_end_finish(void)
{
    for (size_t i = 0; i < SIGNALS; i++)
        sigaction(signals[i], &before[i], NULL);
}
