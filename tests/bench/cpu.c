/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cpu RUNS COMMAND…: runs the command so many times with its output thrown away, and
 * prints the median of its CPU seconds (user and system, children too) and the largest
 * resident size in kB. Standard input is read from the file that it is, each time anew.
 * Exit status 1 if a run failed. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static double seconds(struct timeval t)
{
    const double microsecond = 1e-6;
    return (double)t.tv_sec + microsecond * (double)t.tv_usec;
}

static int compare(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* CPU seconds of one run; *size grows to its resident size. */
static double run(char **command, long *size)
{
    struct rusage used;
    int status;
    pid_t child = fork();
    if (child == 0) {
        int null = open("/dev/null", O_WRONLY);
        lseek(STDIN_FILENO, 0, SEEK_SET);
        dup2(null, STDOUT_FILENO);
        execvp(command[0], command);
        perror(command[0]);
        _exit(1);
    }
    if (wait4(child, &status, 0, &used) < 0 || status != 0)
        exit(EXIT_FAILURE);
    if (used.ru_maxrss > *size)
        *size = used.ru_maxrss;
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

int main(int argc, char **argv)
{
    int runs = argc > 2 ? atoi(argv[1]) : 0;
    double *time = calloc((size_t)(runs > 0 ? runs : 1), sizeof *time);
    long size = 0;
    if (runs < 1 || !time) {
        fputs("usage: cpu RUNS COMMAND [ARGUMENT]…\n", stderr);
        return 2;
    }
    for (int i = 0; i < runs; i++)
        time[i] = run(argv + 2, &size);
    qsort(time, (size_t)runs, sizeof *time, compare);
    printf("%.4f %ld\n", time[runs / 2], size);
    free(time);
    return 0;
}
