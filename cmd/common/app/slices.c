/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Streams of which each rank has a slice: input and output. */
#include "filter.h"

#include "../../../lib/ranks/ranks.h"
#include "../../../lib/stream/ranks/pass.h"
#include "../../../lib/text/file.h"
#include "kinds.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

void filter_read_slices(const filter *f, tm_slices *slices)
{
    tm_error error;
    const bool opens = f->input || tm_rank() == 0;
    const int fd = opens ? filter_open_input(f, &error) : -1;
    filter_agree(f, opens && fd < 0 ? error.status : TM_OK, &error);
    *slices = (tm_slices){0};
    tm_stream_init(&slices->stream);
    slices->stream.progress = filter_progress(f);
    tm_status status =
        tm_slices_read(slices, fd, filter_input_name(f), f->threads, &error);
    if (status == TM_OK && tm_rank() == 0) /* others may have no rows */
        status = kinds_check(f->name, &slices->stream, filter_input_name(f), &error);
    filter_agree(f, status, &error);
    if (f->input)
        close(fd);
}

/* Whether all ranks are on one machine. */
static bool is_one_machine(void)
{
    char own[256] = "", first[256];
    gethostname(own, sizeof own - 1);
    memcpy(first, own, sizeof first);
    tm_ranks_broadcast(first, sizeof first);
    return !tm_ranks_any(memcmp(own, first, sizeof own) != 0);
}

/* Rank 0's file, as others find it. */
typedef struct {
    char path[OUTPUT_PATH];
    dev_t device;
    ino_t number;
} shared_file;

/* Begins -o FILE on rank 0. Whether all ranks can write to it: not where it is no file of
 * ours, or where others do not see it. */
static bool begin_file(filter *f, int *fd, shared_file *file)
{
    struct stat about;
    memset(file, 0, sizeof *file);
    f->files->named = !is_one_machine();
    if (tm_rank() == 0) {
        *fd = filter_open_output(f);
        output_files_path(f->files, file->path);
        if (fstat(*fd, &about) == 0) {
            file->device = about.st_dev;
            file->number = about.st_ino;
        }
    }
    tm_ranks_broadcast(file, sizeof *file);
    const bool seen = file->path[0] && stat(file->path, &about) == 0 &&
                      about.st_ino == file->number &&
                      (f->files->named || about.st_dev == file->device);
    return !tm_ranks_any(!seen);
}

void filter_write_slices(filter *f, tm_slices *slices, const char *summary, ...)
{
    tm_error error;
    char done[512];
    int fd = STDOUT_FILENO;
    shared_file file;
    va_list arguments;
    va_start(arguments, summary);
    vsnprintf(done, sizeof done, summary, arguments);
    va_end(arguments);
    if (tm_rank() == 0)
        filter_add_history(f, &slices->stream, done);
    slices->stream.progress = filter_progress(f);
    if (!f->output && tm_rank() == 0)
        fd = filter_open_output(f);
    const tm_status status =
        f->output && begin_file(f, &fd, &file)
            ? tm_slices_write_file(slices, file.path, f->threads, &error)
            : tm_slices_write(slices, fd, f->threads, &error);
    if (status != TM_OK)
        filter_name_output(f, &error);
    filter_agree(f, status, &error);
}

void filter_write_texts(filter *f, const tm_text *text)
{
    tm_error error;
    tm_status status = TM_OK;
    filter_agree(f, text->failed ? tm_fail_memory(&error) : TM_OK, &error);
    if (tm_rank() > 0) {
        tm_pass_text(text->byte, text->size);
        tm_pass_end();
    } else {
        const int fd = filter_open_output(f);
        filter_stage(f, "writing");
        status = tm_write_text(fd, text, &error);
        status = tm_pass_on(fd, status, &error);
    }
    if (status != TM_OK)
        filter_name_output(f, &error);
    filter_agree(f, status, &error);
}
