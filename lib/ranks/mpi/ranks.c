/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The ranks of MPI_COMM_WORLD. Messages are cut, as MPI counts with an int. */
#include "../ranks.h"

#include "../../base/array.h"
#include "start.h"

#include <mpi.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PIECE = 1 << 30, TAG = 7 };

static struct {
    int rank, count;
    tm_ranks_traffic sent;
    MPI_Request *request; /* [2 * count]: room for tm_ranks_swap() */
} world = {0, 1, {0, 0}, NULL};

bool tm_ranks_are_mpi(void)
{
    return true;
}

tm_status tm_ranks_start(tm_error *error)
{
    const tm_status status = tm_mpi_init(error);
    if (status != TM_OK)
        return status;
    MPI_Comm_rank(MPI_COMM_WORLD, &world.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &world.count);
    world.request = tm_new(2 * (size_t)world.count, sizeof(MPI_Request));
    return tm_ranks_enough(world.request, error);
}

unsigned tm_rank(void)
{
    return (unsigned)world.rank;
}

unsigned tm_ranks_count(void)
{
    return (unsigned)world.count;
}

void tm_ranks_leave(void)
{
    tm_mpi_finish();
    free(world.request);
    world.request = NULL;
    world.count = 1;
    world.rank = 0;
}

void tm_ranks_end(int status)
{
    if (world.count == 1)
        exit(status);
    MPI_Abort(MPI_COMM_WORLD, status);
    abort(); /* MPI_Abort() does not return */
}

/* Comes back when MPI_Wait() will not wait, and soon sleeps until then: MPI's own waiting
 * takes a core that other ranks and threads may have use for. */
static void sleep_until(MPI_Request request)
{
    const struct timespec nap = {.tv_nsec = 20000};
    const unsigned awake = 100; /* looks */
    int done = 0;
    for (unsigned looks = 0; !done; looks++) {
        MPI_Request_get_status(request, &done, MPI_STATUS_IGNORE);
        if (!done && looks >= awake)
            nanosleep(&nap, NULL);
    }
}

static void broadcast(void *bytes, size_t size, int from)
{
    for (size_t at = 0; at < size && world.count > 1; at += PIECE) {
        MPI_Request request;
        MPI_Ibcast((char *)bytes + at, (int)(size - at < PIECE ? size - at : PIECE),
                   MPI_BYTE, from, MPI_COMM_WORLD, &request);
        sleep_until(request);
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    }
}

static void reduce(void *value, size_t count, MPI_Datatype type, MPI_Op op)
{
    MPI_Request request;
    if (world.count == 1)
        return;
    MPI_Iallreduce(MPI_IN_PLACE, value, (int)count, type, op, MPI_COMM_WORLD, &request);
    sleep_until(request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
}

tm_status tm_ranks_first_error(tm_status status, tm_error *error)
{
    int first = status == TM_OK ? world.count : world.rank;
    if (world.count == 1)
        return status;
    reduce(&first, 1, MPI_INT, MPI_MIN);
    if (first == world.count)
        return TM_OK;
    int of_all = (int)status;
    tm_error cause = tm_error_of(status, error);
    broadcast(&of_all, sizeof of_all, first);
    broadcast(&cause, sizeof cause, first);
    cause.status = (tm_status)of_all;
    return tm_fail_as(error, &cause);
}

void tm_ranks_sum(size_t *value, size_t count)
{
    reduce(value, count, MPI_UNSIGNED_LONG, MPI_SUM);
}

void tm_ranks_least(double *value, size_t count)
{
    reduce(value, count, MPI_DOUBLE, MPI_MIN);
}

void tm_ranks_largest(double *value, size_t count)
{
    reduce(value, count, MPI_DOUBLE, MPI_MAX);
}

bool tm_ranks_find_any(bool value)
{
    int any = value;
    reduce(&any, 1, MPI_INT, MPI_MAX);
    return any != 0;
}

size_t tm_ranks_before(size_t value, size_t *all)
{
    size_t sum = value;
    if (all)
        *all = value;
    if (world.count == 1)
        return 0;
    MPI_Request request;
    MPI_Iscan(&value, &sum, 1, MPI_UNSIGNED_LONG, MPI_SUM, MPI_COMM_WORLD, &request);
    sleep_until(request);
    /* clang-tidy does not know MPI_Iscan() */
    /* NOLINTNEXTLINE(clang-analyzer-optin.mpi.MPI-Checker) */
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    if (all) {
        *all = sum;
        broadcast(all, sizeof *all, world.count - 1);
    }
    return sum - value;
}

void tm_ranks_broadcast(void *bytes, size_t size)
{
    broadcast(bytes, size, 0);
}

/* Messages under way: one to each other rank, and one from each. */
typedef struct {
    size_t count; /* of world.request */
} messages;

/* Begins the piece at `at` of what another rank sends, or gets. */
static void begin(messages *m, char *bytes, size_t size, size_t at, int other, bool send)
{
    if (other == world.rank || at >= size)
        return;
    const int piece = (int)(size - at < PIECE ? size - at : PIECE);
    MPI_Request *request = &world.request[m->count++];
    if (send)
        MPI_Isend(bytes + at, piece, MPI_BYTE, other, TAG, MPI_COMM_WORLD, request);
    else
        MPI_Irecv(bytes + at, piece, MPI_BYTE, other, TAG, MPI_COMM_WORLD, request);
    world.sent.messages += send;
    world.sent.bytes += send ? (size_t)piece : 0;
}

static void wait_for_all(const messages *m)
{
    for (size_t i = 0; i < m->count; i++) {
        sleep_until(world.request[i]);
        MPI_Wait(&world.request[i], MPI_STATUS_IGNORE);
    }
}

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

void tm_ranks_swap(const void *send, const size_t *send_count, size_t size, void *got,
                   const size_t *got_count)
{
    size_t most = 0;
    for (int r = 0; r < world.count; r++)
        most = larger(most, larger(send_count[r], got_count[r]) * size);
    for (size_t at = 0; at < most; at += PIECE) {
        messages m = {0};
        char *from = (char *)send, *to = got;
        for (int r = 0; r < world.count; r++) {
            begin(&m, to, got_count[r] * size, at, r, false);
            to += got_count[r] * size;
        }
        for (int r = 0; r < world.count; r++) {
            begin(&m, from, send_count[r] * size, at, r, true);
            from += send_count[r] * size;
        }
        wait_for_all(&m);
    }
    const char *from = send;
    char *to = got;
    for (int r = 0; r < world.rank; r++) {
        from += send_count[r] * size;
        to += got_count[r] * size;
    }
    if (send_count[world.rank] > 0)
        memcpy(to, from, send_count[world.rank] * size);
}

tm_status tm_ranks_exchange(const void *send, const size_t *send_count, size_t size,
                            void **got, size_t *got_count, tm_error *error)
{
    const unsigned count = tm_ranks_count();
    size_t *to = tm_new(2 * (size_t)count, sizeof *to);
    *got = NULL;
    if (tm_ranks_any(!to)) {
        free(to);
        return tm_fail_memory(error);
    }
    size_t *from = to + count, items = 0;
    memcpy(to, send_count, count * sizeof *to);
    from[0] = to[0];
    if (count > 1) {
        MPI_Request request;
        MPI_Ialltoall(to, 1, MPI_UNSIGNED_LONG, from, 1, MPI_UNSIGNED_LONG,
                      MPI_COMM_WORLD, &request);
        sleep_until(request);
        MPI_Wait(&request, MPI_STATUS_IGNORE);
    }
    for (unsigned r = 0; r < count; r++)
        items += from[r];
    *got = tm_new(items, size);
    const bool failed = tm_ranks_any(!*got);
    if (failed) {
        free(*got);
        *got = NULL;
    } else {
        tm_ranks_swap(send, to, size, *got, from);
        memcpy(got_count, from, count * sizeof *from);
    }
    free(to);
    return failed ? tm_fail_memory(error) : TM_OK;
}

/* How many items each rank has: count[ranks]. */
static void tell_counts(size_t own, size_t *count)
{
    MPI_Request request;
    count[0] = own;
    if (world.count == 1)
        return;
    MPI_Iallgather(&own, 1, MPI_UNSIGNED_LONG, count, 1, MPI_UNSIGNED_LONG,
                   MPI_COMM_WORLD, &request);
    sleep_until(request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
}

/* Sends the same items to all ranks, or to rank 0: `to` is NULL on those that get none.
 */
static void send_all(const void *mine, const size_t *count, size_t size, bool share,
                     char *to)
{
    const size_t own = count[world.rank] * size;
    size_t most = 0;
    for (int r = 0; r < world.count; r++)
        most = larger(most, count[r] * size);
    for (size_t at = 0; at < most; at += PIECE) {
        messages m = {0};
        char *from = to;
        for (int r = 0; to && r < world.count; from += count[r++] * size)
            begin(&m, from, count[r] * size, at, r, false);
        for (int r = 0; r < (share ? world.count : 1); r++)
            begin(&m, (char *)mine, own, at, r, true);
        wait_for_all(&m);
    }
}

static tm_status collect(const void *mine, size_t count, size_t size, bool share,
                         void **all, size_t *total, tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    const size_t before = tm_ranks_before(count, total);
    const bool receives = share || world.rank == 0;
    size_t *counts = tm_new(ranks, sizeof *counts), sum = 0;
    *all = NULL;
    if (tm_ranks_any(!counts)) {
        free(counts);
        return tm_fail_memory(error);
    }
    tell_counts(count, counts);
    for (unsigned r = 0; r < ranks; r++)
        sum += counts[r];
    char *to = receives ? tm_new(sum, size) : NULL;
    const bool failed = tm_ranks_any(receives && !to);
    if (failed) {
        free(to);
        to = NULL;
    } else {
        send_all(mine, counts, size, share, to);
        if (to && count > 0)
            memcpy(to + before * size, mine, count * size);
    }
    *all = to;
    free(counts);
    return failed ? tm_fail_memory(error) : TM_OK;
}

tm_status tm_ranks_gather(const void *mine, size_t count, size_t size, void **all,
                          size_t *total, tm_error *error)
{
    return collect(mine, count, size, false, all, total, error);
}

tm_status tm_ranks_share(const void *mine, size_t count, size_t size, void **all,
                         size_t *total, tm_error *error)
{
    return collect(mine, count, size, true, all, total, error);
}

void tm_ranks_send(unsigned to, const void *bytes, size_t size)
{
    MPI_Request request;
    MPI_Isend(bytes, (int)size, MPI_BYTE, (int)to, TAG, MPI_COMM_WORLD, &request);
    sleep_until(request);
    MPI_Wait(&request, MPI_STATUS_IGNORE);
    world.sent.messages++;
    world.sent.bytes += size;
}

void tm_ranks_receive(unsigned from, void *bytes, size_t room, size_t *size)
{
    MPI_Status status;
    int got = 0;
    MPI_Request request;
    MPI_Irecv(bytes, (int)room, MPI_BYTE, (int)from, TAG, MPI_COMM_WORLD, &request);
    sleep_until(request);
    MPI_Wait(&request, &status);
    MPI_Get_count(&status, MPI_BYTE, &got);
    *size = (size_t)got;
}

struct tm_ranks_file {
    MPI_File file;
};

static tm_status fail_file(int code, tm_error *error)
{
    char why[MPI_MAX_ERROR_STRING] = "";
    int length;
    MPI_Error_string(code, why, &length);
    return tm_fail(error, TM_ERROR_SYSTEM, "cannot write: %s", why);
}

tm_status tm_ranks_file_open(tm_ranks_file **file, const char *name, tm_error *error)
{
    *file = malloc(sizeof **file);
    if (tm_ranks_any(!*file)) {
        free(*file);
        *file = NULL;
        return tm_fail_memory(error);
    }
    const int code = MPI_File_open(MPI_COMM_WORLD, name, MPI_MODE_WRONLY, MPI_INFO_NULL,
                                   &(*file)->file);
    const tm_status status =
        tm_ranks_agree(code == MPI_SUCCESS ? TM_OK : fail_file(code, error), error);
    if (status == TM_OK)
        return TM_OK;
    if (code == MPI_SUCCESS)
        MPI_File_close(&(*file)->file);
    free(*file);
    *file = NULL;
    return status;
}

tm_status tm_ranks_file_put(tm_ranks_file *file, size_t at, const char *bytes,
                            size_t size, tm_error *error)
{
    for (size_t done = 0; done < size; done += PIECE) {
        const size_t left = size - done;
        const int piece = (int)(left < PIECE ? left : PIECE);
        const int code =
            MPI_File_write_at(file->file, (MPI_Offset)(at + done), bytes + done, piece,
                              MPI_BYTE, MPI_STATUS_IGNORE);
        if (code != MPI_SUCCESS)
            return fail_file(code, error);
    }
    return TM_OK;
}

tm_status tm_ranks_file_close(tm_ranks_file **file, tm_error *error)
{
    const int code = MPI_File_close(&(*file)->file);
    free(*file);
    *file = NULL;
    return tm_ranks_agree(code == MPI_SUCCESS ? TM_OK : fail_file(code, error), error);
}

tm_ranks_traffic tm_ranks_sent(void)
{
    return world.sent;
}
