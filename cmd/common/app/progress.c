/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "progress.h"

#include "../../../lib/ranks/ranks.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

/* Nothing is drawn of what is over before; then so many lines a second. */
static const double patience = 0.5, period = 0.2;

static const char erase[] = "\r\033[K";

/* The text ------------------------------------------------------------------------- */

/* Appends printf-style text. */
static void add(char line[PROGRESS_LINE], const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static void add(char line[PROGRESS_LINE], const char *format, ...)
{
    const size_t length = strlen(line);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + length, PROGRESS_LINE - length, format, arguments);
    va_end(arguments);
}

/* Digits in groups of three: "1 240". */
static void add_count(char line[PROGRESS_LINE], size_t count)
{
    enum { GROUP = 1000 };
    if (count >= GROUP) {
        add_count(line, count / GROUP);
        add(line, " %03zu", count % GROUP);
    } else {
        add(line, "%zu", count);
    }
}

/* "12 s", "1:05", "1:00:05" */
static void add_time(char line[PROGRESS_LINE], double seconds)
{
    enum { MINUTE = 60 };
    const unsigned long s = (unsigned long)seconds;
    const unsigned long minutes = s / MINUTE, hours = minutes / MINUTE;
    if (hours > 0)
        add(line, "%lu:%02lu:%02lu", hours, minutes % MINUTE, s % MINUTE);
    else if (minutes > 0)
        add(line, "%lu:%02lu", minutes, s % MINUTE);
    else
        add(line, "%lu s", s);
}

static void add_share(char line[PROGRESS_LINE], const tm_progress_at *at)
{
    const double hundred = 100, kilobyte = 1000;
    if (at->of > 0) {
        const size_t done = at->done < at->of ? at->done : at->of;
        add(line, ", %.0f %%", hundred * (double)done / (double)at->of);
    } else if (at->done > 0 && at->bytes) {
        add(line, ", ");
        add_count(line, (size_t)((double)at->done / kilobyte));
        add(line, " kB");
    } else if (at->done > 0) {
        add(line, ", ");
        add_count(line, at->done);
    }
}

void progress_line(char line[PROGRESS_LINE], const char *name, const tm_progress_at *at,
                   double seconds, size_t columns)
{
    line[0] = '\0';
    add(line, "%s: %s", name, at->what);
    if (at->doing)
        add(line, ": %s", at->doing);
    if (at->pass > 0)
        add(line, ", pass %zu", at->pass);
    if (at->all_bad > 0) {
        add(line, ": ");
        add_count(line, at->bad);
        add(line, " of ");
        add_count(line, at->all_bad);
        add(line, " bad left");
    }
    add_share(line, at);
    add(line, ", ");
    add_time(line, seconds);
    if (columns > 0 && columns <= PROGRESS_LINE)
        line[columns - 1] = '\0'; /* the last column may be a line break */
}

void progress_stage_line(char line[PROGRESS_LINE], const char *name, const char *what,
                         const progress_clock *from, const progress_clock *to,
                         long kilobytes)
{
    const double kilobytes_in_megabyte = 1024, million = 1e6;
    snprintf(line, PROGRESS_LINE, "%s: %s: %.2f s, %.2f s of CPU, %.1f MB at most", name,
             what, to->seconds - from->seconds, to->cpu - from->cpu,
             (double)kilobytes / kilobytes_in_megabyte);
    if (to->sent > from->sent)
        add(line, ", %.1f MB sent", (double)(to->sent - from->sent) / million);
    add(line, "\n");
}

/* Clocks and memory ---------------------------------------------------------------- */

static double now(void)
{
    const double nanosecond = 1e-9;
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + nanosecond * (double)t.tv_nsec;
}

static double seconds_of(const struct timeval *t)
{
    const double microsecond = 1e-6;
    return (double)t->tv_sec + microsecond * (double)t->tv_usec;
}

/* Programs that were run and have ended count as well. */
static progress_clock measure(const progress *p, long *kilobytes)
{
    static const int who[] = {RUSAGE_SELF, RUSAGE_CHILDREN};
    progress_clock clock = {.seconds = now() - p->began, .sent = tm_ranks_sent().bytes};
    *kilobytes = 0;
    for (size_t i = 0; i < sizeof who / sizeof *who; i++) {
        struct rusage usage;
        getrusage(who[i], &usage);
        clock.cpu += seconds_of(&usage.ru_utime) + seconds_of(&usage.ru_stime);
        if (usage.ru_maxrss > *kilobytes)
            *kilobytes = usage.ru_maxrss;
    }
    return clock;
}

/* The terminal --------------------------------------------------------------------- */

/* For the signal handler. */
static volatile sig_atomic_t drawn_on = -1, ended;

static void put(int fd, const char *text, size_t size)
{
    (void)!write(fd, text, size);
}

static void erase_line(progress *p)
{
    if (p->shown)
        put(p->fd, erase, sizeof erase - 1);
    p->shown = false;
}

static size_t columns_of(int fd)
{
    enum { USUAL = 80 };
    struct winsize size;
    const bool known = ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : USUAL;
}

/* The terminal is another job's. */
static bool is_in_background(int fd)
{
    const pid_t foreground = tcgetpgrp(fd);
    return foreground > 0 && foreground != getpgrp();
}

/* Nothing has come of a pipe yet: it is the other program that works. */
static bool waits(const tm_progress_at *at)
{
    return !at->what || (at->bytes && at->of == 0 && at->done == 0);
}

void progress_draw(progress *p, double seconds)
{
    char line[PROGRESS_LINE], text[PROGRESS_LINE + 8];
    if (ended || waits(&p->at) || is_in_background(p->fd))
        return;
    progress_line(line, p->name, &p->at, seconds, columns_of(p->fd));
    const int size = snprintf(text, sizeof text, "\r%s\033[K", line);
    p->shown = true;
    put(p->fd, text, (size_t)size);
}

static void leave(int signal_number)
{
    ended = 1;
    if (drawn_on >= 0)
        put(drawn_on, erase, sizeof erase - 1);
    raise(signal_number); /* the handler is gone: SA_RESETHAND */
}

static const int deadly[] = {SIGINT,  SIGTERM, SIGHUP,  SIGQUIT,
                             SIGPIPE, SIGXCPU, SIGUSR1, SIGUSR2};

static void erase_at_signals(void)
{
    struct sigaction action = {.sa_handler = leave, .sa_flags = (int)SA_RESETHAND}, old;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++) {
        sigaction(deadly[i], NULL, &old);
        if (old.sa_handler != SIG_IGN)
            sigaction(deadly[i], &action, NULL);
    }
}

/* The thread ----------------------------------------------------------------------- */

static struct timespec timespec_of(double seconds)
{
    const double nanosecond = 1e-9;
    const time_t whole = (time_t)seconds;
    return (struct timespec){whole, (long)((seconds - (double)whole) / nanosecond)};
}

static void *draw_on_and_on(void *argument)
{
    progress *p = argument;
    double next = p->began + patience;
    pthread_mutex_lock(&p->lock);
    while (!p->ending) {
        const struct timespec at = timespec_of(next);
        if (pthread_cond_timedwait(&p->wake, &p->lock, &at) != ETIMEDOUT)
            continue;
        progress_draw(p, now() - p->began);
        next = now() + period;
    }
    pthread_mutex_unlock(&p->lock);
    return NULL;
}

/* Starts the thread, to which no signal comes; false where there is none to be had. */
static bool start_thread(progress *p)
{
    enum { STACK = 1 << 18 };
    pthread_condattr_t monotonic;
    pthread_attr_t small;
    sigset_t all, before;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&p->wake, &monotonic);
    pthread_condattr_destroy(&monotonic);
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, STACK);
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    const bool started = pthread_create(&p->thread, &small, draw_on_and_on, p) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&small);
    return started;
}

/* What the library says -------------------------------------------------------------- */

/* With -v: what the stage took that is over. */
static void end_stage(progress *p)
{
    char line[PROGRESS_LINE];
    long kilobytes;
    if (!p->verbose)
        return;
    const progress_clock clock = measure(p, &kilobytes);
    if (p->at.what) {
        progress_stage_line(line, p->name, p->at.what, &p->stage, &clock, kilobytes);
        erase_line(p);
        put(p->fd, line, strlen(line));
    }
    p->stage = clock;
}

static void take(void *context, const tm_progress_at *at)
{
    progress *p = context;
    pthread_mutex_lock(&p->lock);
    if (p->at.what != at->what && (!p->at.what || strcmp(p->at.what, at->what) != 0))
        end_stage(p);
    p->at = *at;
    pthread_mutex_unlock(&p->lock);
}

static bool can_erase(int fd)
{
    const char *terminal = getenv("TERM");
    return isatty(fd) && terminal && *terminal && strcmp(terminal, "dumb") != 0;
}

void progress_start(progress *p, const char *name, bool quiet, bool verbose)
{
    *p = (progress){.to = {.report = take, .context = p},
                    .name = name,
                    .fd = STDERR_FILENO,
                    .verbose = verbose,
                    .began = now()};
    pthread_mutex_init(&p->lock, NULL);
    if (quiet || !can_erase(p->fd) || !start_thread(p))
        return;
    p->draws = true;
    drawn_on = p->fd;
    erase_at_signals();
}

const tm_progress *progress_context(const progress *p)
{
    return p && (p->draws || p->verbose) ? &p->to : NULL;
}

void progress_hold(progress *p)
{
    if (!p)
        return;
    pthread_mutex_lock(&p->lock);
    /* What is there may also be the line of another filter of the pipe. */
    if (p->draws && now() - p->began >= patience && !is_in_background(p->fd))
        p->shown = true;
    erase_line(p);
}

void progress_release(progress *p)
{
    if (p)
        pthread_mutex_unlock(&p->lock);
}

void progress_end(progress *p)
{
    if (!p)
        return;
    pthread_mutex_lock(&p->lock);
    p->ending = true;
    erase_line(p);
    end_stage(p);
    p->at.what = NULL;
    pthread_mutex_unlock(&p->lock);
    if (!p->draws)
        return;
    pthread_cond_signal(&p->wake);
    pthread_join(p->thread, NULL);
    p->draws = false;
    drawn_on = -1;
}
