/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several processes that work on one mesh, started by a launcher (mpirun, srun): ranks.
 * What they say to each other goes through here. There are two sets of these functions:
 * alone.c, of the library, is that of one rank, and needs no MPI; mpi/ranks.c, which a
 * program is linked with before the library, is that of MPI_COMM_WORLD.
 *
 * All functions but tm_rank() and tm_ranks_count() are called by all ranks, in the same
 * order. Those that return a tm_status return the same one on all of them: where one has
 * no memory, all fail. Items are of any type, of `size` bytes. Of one rank each costs a
 * copy at most. */
#ifndef TM_RANKS_RANKS_H
#define TM_RANKS_RANKS_H

#include "../base/extern_c.h"
#include "../base/error.h"

#include <stdbool.h>
#include <stddef.h>

TM_EXTERN_C_BEGIN

/* Whether a launcher (mpirun, srun) has started the program, what number it has among the
 * others, and how many they are, before anything is started: by the launcher's variables,
 * Open MPI's, PMIx's or PMI's. 0 and 1 where there is none. */
bool tm_launched(void);
unsigned tm_launched_rank(void);
unsigned tm_launched_count(void);

/* Forgets the launcher: from now on this is one process without others, which need not
 * be there for MPI to start, as p4est wants it. */
void tm_launched_forget(void);

/* Whether these are the functions of MPI. */
bool tm_ranks_are_mpi(void);

/* Begins to work together, once; at the program's end that ends. TM_ERROR_SYSTEM where
 * MPI does not start. */
tm_status tm_ranks_start(tm_error *error);

/* Which rank this is, and how many there are; 0 and 1 before tm_ranks_start(). */
unsigned tm_rank(void);
unsigned tm_ranks_count(void);

/* Ends what tm_ranks_start() began: each rank is alone then, rank 0 of 1. Rank 0 may go
 * on; the others are to end. */
void tm_ranks_leave(void);

/* Ends all ranks at once with that exit status, whatever the others do. */
void tm_ranks_end(int status) __attribute__((noreturn));

/* The error of the lowest rank that has one, on all of them: a step that may fail on some
 * ranks ends with `status = tm_ranks_agree(status, error)`. TM_OK where none failed. */
tm_status tm_ranks_first_error(tm_status status, tm_error *error);

static inline tm_status tm_ranks_agree(tm_status status, tm_error *error)
{
    const tm_status first = tm_ranks_first_error(status, error);
    return first == TM_OK ? status : first;
}

/* Sums, minima and maxima over all ranks, in place. */
void tm_ranks_sum(size_t *value, size_t count);
void tm_ranks_least(double *value, size_t count);
void tm_ranks_largest(double *value, size_t count);
bool tm_ranks_find_any(bool value);

static inline bool tm_ranks_any(bool value)
{
    return tm_ranks_find_any(value) || value;
}

/* Whether all ranks have the memory that they need: tm_fail_memory() on all where one has
 * not. */
static inline tm_status tm_ranks_enough(bool enough, tm_error *error)
{
    return tm_ranks_any(!enough) ? tm_fail_memory(error) : TM_OK;
}

/* The sum over the ranks before this one; *all (may be NULL) gets that of all. */
size_t tm_ranks_before(size_t value, size_t *all);

/* Rank 0's bytes, to all others. */
void tm_ranks_broadcast(void *bytes, size_t size);

/* Gives each rank its own: `send` has send_count[0] items for rank 0, then send_count[1]
 * for rank 1, and so on. *got, to be freed, has what came, in the order of ranks,
 * got_count[r] items of rank r. got_count has tm_ranks_count() numbers; it may be
 * send_count. TM_ERROR_SYSTEM where memory is out: *got is NULL then. */
tm_status tm_ranks_exchange(const void *send, const size_t *send_count, size_t size,
                            void **got, size_t *got_count, tm_error *error);

/* The same where each knows what it gets, got_count[r] items of rank r, and has the room
 * for it: nothing is sent but these. */
void tm_ranks_swap(const void *send, const size_t *send_count, size_t size, void *got,
                   const size_t *got_count);

/* Of all ranks' items, in the order of ranks, *all, to be freed: tm_ranks_gather() on
 * rank 0 (NULL elsewhere), tm_ranks_share() on all. *total (may be NULL) is their number,
 * on all ranks. */
tm_status tm_ranks_gather(const void *mine, size_t count, size_t size, void **all,
                          size_t *total, tm_error *error);
tm_status tm_ranks_share(const void *mine, size_t count, size_t size, void **all,
                         size_t *total, tm_error *error);

/* From one rank to another, which call both, and no other does. tm_ranks_receive() gets
 * *size bytes, at most `room`. */
void tm_ranks_send(unsigned to, const void *bytes, size_t size);
void tm_ranks_receive(unsigned from, void *bytes, size_t room, size_t *size);

/* A file that is there, for all ranks to write to: where they do so is theirs. Errors are
 * TM_ERROR_SYSTEM, of tm_ranks_file_put() on the rank that has them.
 * tm_ranks_file_close() says whether all is written; *file is NULL then, and after
 * tm_ranks_file_open() has failed. */
typedef struct tm_ranks_file tm_ranks_file;
tm_status tm_ranks_file_open(tm_ranks_file **file, const char *name, tm_error *error);
tm_status tm_ranks_file_put(tm_ranks_file *file, size_t at, const char *bytes,
                            size_t size, tm_error *error);
tm_status tm_ranks_file_close(tm_ranks_file **file, tm_error *error);

/* What this rank has sent to others so far. Collective sums and the like, whose size does
 * not grow with the mesh, are not counted. */
typedef struct tm_ranks_traffic {
    size_t bytes, messages;
} tm_ranks_traffic;
tm_ranks_traffic tm_ranks_sent(void);

TM_EXTERN_C_END

#endif
