/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot.h"

#include "../../../lib/text/file.h"
#include "../../../lib/text/input.h"
#include "../process/become.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

/* A file in memory that holds the script, at its beginning, or an empty one for NULL; -1
 * where that fails. A file and not a pipe, so that gnuplot and we never wait for each
 * other. */
static int memory_file(const tm_text *script, tm_error *error)
{
    const int fd = memfd_create("gnuplot", MFD_CLOEXEC);
    if (fd >= 0 &&
        (!script || tm_write_all(fd, script->byte, script->size, NULL) == TM_OK) &&
        lseek(fd, 0, SEEK_SET) == 0)
        return fd;
    tm_fail(error, TM_ERROR_SYSTEM, "cannot hold the script for gnuplot: %s",
            strerror(errno));
    if (fd >= 0)
        close(fd);
    return -1;
}

/* Starts gnuplot without the user's own settings. Returns 0 or what errno would say. */
static int start(int input, int output, int complaints, pid_t *child)
{
    char *const arguments[] = {"gnuplot", "-d", NULL};
    const int standard[] = {input, output, complaints};
    const pid_t parent = getpid();
    int failure[2], reason = 0;
    /* In the C locale gnuplot complains that it cannot write a degree sign. */
    if (setenv("LC_ALL", "C.UTF-8", 1) != 0 || pipe2(failure, O_CLOEXEC) != 0)
        return errno;
    *child = fork();
    if (*child == 0)
        become_program(arguments, parent, standard, failure[1]);
    if (*child < 0)
        reason = errno;
    close(failure[1]);
    if (*child > 0 && tm_read_some(failure[0], (char *)&reason, sizeof reason) > 0)
        waitpid(*child, NULL, 0);
    close(failure[0]);
    return reason;
}

/* Waits for its end, which must be as it should; else what it said of that is in the
 * error, the first of it. */
static tm_status wait_for(pid_t child, int complaints, tm_error *error)
{
    int status;
    char said[256];
    while (waitpid(child, &status, 0) < 0) {
        if (errno != EINTR)
            return tm_fail(error, TM_ERROR_SYSTEM, "cannot wait for gnuplot: %s",
                           strerror(errno));
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return TM_OK;
    const ssize_t size = pread(complaints, said, sizeof said - 1, 0);
    said[size > 0 ? size : 0] = '\0';
    const char *line = said + strspn(said, " \n\r\t");
    const int length = (int)strcspn(line, "\n\r");
    if (WIFSIGNALED(status))
        return tm_fail(error, TM_ERROR_SYSTEM,
                       "gnuplot was ended by signal %d (%s)%s%.*s", WTERMSIG(status),
                       strsignal(WTERMSIG(status)), length > 0 ? ": " : "", length, line);
    return tm_fail(error, TM_ERROR_SYSTEM, "gnuplot failed with exit status %d%s%.*s",
                   WEXITSTATUS(status), length > 0 ? ": " : "", length, line);
}

/* SVG from its beginning to its end. */
static bool is_picture(const tm_text *figure)
{
    static const char xml[] = "<?xml", svg[] = "<svg", end[] = "</svg>";
    size_t size = figure->size;
    if (size < strlen(xml) + strlen(end) ||
        (memcmp(figure->byte, xml, strlen(xml)) != 0 &&
         memcmp(figure->byte, svg, strlen(svg)) != 0))
        return false;
    while (size > 0 && strchr(" \n\r\t", figure->byte[size - 1]))
        size--;
    return size >= strlen(end) &&
           memcmp(figure->byte + size - strlen(end), end, strlen(end)) == 0;
}

static tm_status run(int script, int complaints, tm_text *figure, tm_error *error)
{
    int end[2];
    if (pipe2(end, O_CLOEXEC) != 0)
        return tm_fail(error, TM_ERROR_SYSTEM, "cannot run gnuplot: %s", strerror(errno));
    pid_t child = -1;
    const int reason = start(script, end[1], complaints, &child);
    close(end[1]);
    tm_status status = TM_OK;
    if (reason == ENOENT)
        status =
            tm_fail(error, TM_ERROR_SYSTEM, "--plot needs gnuplot (package gnuplot-nox)");
    else if (reason != 0)
        status =
            tm_fail(error, TM_ERROR_SYSTEM, "cannot run gnuplot: %s", strerror(reason));
    else
        status = tm_read_all(end[0], "gnuplot", figure, error);
    close(end[0]);
    if (reason == 0) {
        const tm_status ended =
            wait_for(child, complaints, status == TM_OK ? error : NULL);
        status = status == TM_OK ? ended : status;
    }
    if (status == TM_OK && !is_picture(figure))
        status = tm_fail(error, TM_ERROR_SYSTEM,
                         "gnuplot ended well, but what it made is no picture (is there "
                         "another program of that name in PATH?)");
    return status;
}

static tm_status draw(const filter *f, const tm_text *script, const char *file,
                      tm_error *error)
{
    if (script->failed || script->size == 0)
        return tm_fail_memory(error);
    const int fd = memory_file(script, error);
    const int complaints = fd < 0 ? -1 : memory_file(NULL, error);
    tm_text figure = {0};
    tm_status status =
        complaints < 0 ? TM_ERROR_SYSTEM : run(fd, complaints, &figure, error);
    if (complaints >= 0)
        close(complaints);
    if (fd >= 0)
        close(fd);
    if (status == TM_OK)
        status = output_files_write(f->files, file, &figure, error);
    tm_text_free(&figure);
    return status;
}

void plot_check_file(const filter *f, const char *file)
{
    filter_no_picture(f, file, "SVG, which browsers show (--plot FILE.svg)");
    filter_other_file(f, "--plot", file);
}

void plot_write(const filter *f, tm_text *script, const char *file)
{
    tm_error error;
    filter_stage(f, "drawing");
    if (draw(f, script, file, &error) != TM_OK)
        filter_fail(f, &error);
    tm_text_free(script);
}

void plot_begin(tm_text *script)
{
    tm_text_string(
        script,
        "set terminal svg size 1040,450 enhanced font 'Helvetica,15' background 'white'\n"
        "set encoding utf8\n"
        "set border 3 linecolor '#555555'\n"
        "set tics nomirror out scale 0.6 textcolor '#333333'\n"
        "set xtics offset 0,0.35\n"
        "set grid ytics back linetype 1 linewidth 0.6 linecolor '#e4e4e4'\n"
        "set tmargin screen 0.86\n"
        "set bmargin screen 0.185\n"
        "unset key\n"
        "bad = '#fbe9e7'\n"
        "grey = '#b4bac1'\n"
        "blue = '#1f6fb2'\n"
        "set multiplot\n");
}

void plot_end(tm_text *script)
{
    tm_text_string(script, "unset multiplot\n");
}

void plot_grouped(tm_text *script, size_t number)
{
    enum { GROUP = 3, DIGITS = 24 };
    char digits[DIGITS];
    const int length = snprintf(digits, sizeof digits, "%zu", number);
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % GROUP == 0)
            tm_text_string(script, "\u2009");
        tm_text_append(script, &digits[i], 1);
    }
}

void plot_outline(tm_text *script, const char *name, const size_t *histogram, size_t bins,
                  double width, size_t whole)
{
    tm_text_format(script, "$%s << END\n0 0\n", name);
    for (size_t i = 0; i < bins; i++) {
        const double share = tm_percent(histogram[i], whole);
        tm_text_format(script, "%.4g %.6g\n%.4g %.6g\n", width * (double)i, share,
                       width * (double)(i + 1), share);
    }
    tm_text_format(script, "%.4g 0\nEND\n", width * (double)bins);
}

double plot_highest(const size_t *histogram, size_t bins, size_t whole)
{
    double highest = 0;
    for (size_t i = 0; i < bins; i++)
        highest = fmax(highest, tm_percent(histogram[i], whole));
    return highest;
}

double plot_axis(double highest)
{
    const double headroom = 1.06, of_nothing = 10;
    return headroom * (highest > 0 ? highest : of_nothing);
}

void plot_blue(tm_text *script, const char *name)
{
    tm_text_format(script,
                   "$%s with filledcurves y=0 fillstyle transparent solid 0.3 noborder "
                   "linecolor rgb blue, $%s with lines linewidth 2 linecolor rgb blue",
                   name, name);
}
