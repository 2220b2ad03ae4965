/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls that fail, for one program: a library for LD_PRELOAD, which run.py sets. The
 * environment:
 *
 *     TM_FAULTS_COUNT    a file of KINDS 64-bit counts, which grow with the calls
 *     TM_FAULTS          KIND FIRST LAST: these calls of that kind fail, FIRST from 1;
 *                        or "short 0 0": a read or a write takes few bytes; or
 *                        "interrupted 0 0": every other one is, before it began
 *
 * Both and LD_PRELOAD are forgotten at once: programs that the program runs are as they
 * always are, processes that it forks go on counting. The GNU C library does not call its
 * own read() and write() by these names: stdio is not disturbed.
 */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MEMORY, MAP, THREAD, PROCESS, OPEN, READ, WRITE, CLOSE, NAME, KINDS };

static const struct {
    const char *name;
    int cause;
} kind[KINDS] = {{"memory", ENOMEM},  {"map", ENOMEM},  {"thread", EAGAIN},
                 {"process", EAGAIN}, {"open", EMFILE}, {"read", EIO},
                 {"write", ENOSPC},   {"close", EIO},   {"name", EIO}};

static _Atomic uint64_t *count; /* [KINDS]; NULL before start() */
static int fails = -1;          /* that kind */
static unsigned long long first, last;
static bool is_short, is_interrupted;
static _Thread_local int undisturbed; /* in calls that are not ours to test */

/* Whether this call is to fail; errno says why. */
static bool is_hit(int k)
{
    if (!count || undisturbed > 0)
        return false;
    const uint64_t which = atomic_fetch_add(&count[k], 1) + 1;
    if (k != fails || which < first || which > last)
        return false;
    errno = kind[k].cause;
    return true;
}

/* Whether it is interrupted, as every other one is. */
static bool is_disturbed(void)
{
    static atomic_uint calls;
    if (!count || !is_interrupted || undisturbed > 0 || calls++ % 2 == 0)
        return false;
    errno = EINTR;
    return true;
}

/* Of so many bytes that many. */
static size_t part(size_t bytes)
{
    enum { FEW = 7 };
    static atomic_uint calls;
    if (!count || !is_short || undisturbed > 0)
        return bytes;
    const size_t few = 1 + calls++ % FEW;
    return bytes < few ? bytes : few;
}

__attribute__((constructor)) static void start(void)
{
    char what[16] = "";
    const char *faults = getenv("TM_FAULTS"), *file = getenv("TM_FAULTS_COUNT");
    if (!faults || !file || sscanf(faults, "%15s %llu %llu", what, &first, &last) != 3)
        return;
    const int fd = open(file, O_RDWR | O_CLOEXEC);
    void *page =
        mmap(NULL, KINDS * sizeof *count, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (page == MAP_FAILED)
        abort();
    close(fd);
    for (int k = 0; k < KINDS; k++)
        if (strcmp(what, kind[k].name) == 0)
            fails = k;
    is_short = strcmp(what, "short") == 0;
    is_interrupted = strcmp(what, "interrupted") == 0;
    unsetenv("TM_FAULTS");
    unsetenv("TM_FAULTS_COUNT");
    unsetenv("LD_PRELOAD");
    count = page;
}

/* The function of that name that this one stands before. */
#define NEXT(name)                                                                       \
    static __typeof__(&name) next;                                                       \
    if (!next)                                                                           \
    next = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

/* Memory --------------------------------------------------------------------------- */

/* dlsym() allocates. The linker's names. NOLINTBEGIN(bugprone-reserved-identifier) */
void *__libc_malloc(size_t size);
void *__libc_calloc(size_t number, size_t size);
void *__libc_realloc(void *old, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

void *malloc(size_t size)
{
    return is_hit(MEMORY) ? NULL : __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
    return is_hit(MEMORY) ? NULL : __libc_calloc(number, size);
}

void *realloc(void *old, size_t size)
{
    return is_hit(MEMORY) ? NULL : __libc_realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return is_hit(MEMORY) ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    *memory = is_hit(MEMORY) ? NULL : __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}

/* NOLINTEND(bugprone-reserved-identifier) */

void *mmap(void *place, size_t size, int access, int flags, int fd, off_t offset)
{
    NEXT(mmap);
    return is_hit(MAP) ? MAP_FAILED : next(place, size, access, flags, fd, offset);
}

/* Threads and processes ------------------------------------------------------------ */

typedef struct {
    void *(*work)(void *);
    void *argument;
} job;

static void *work_undisturbed(void *argument)
{
    const job j = *(job *)argument;
    undisturbed++;
    free(argument);
    return j.work(j.argument);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                   void *(*work)(void *), void *argument)
{
    NEXT(pthread_create);
    job *j = undisturbed > 0 ? malloc(sizeof *j) : NULL;
    if (!j)
        return is_hit(THREAD) ? EAGAIN : next(thread, attributes, work, argument);
    *j = (job){work, argument};
    return next(thread, attributes, work_undisturbed, j);
}

pid_t fork(void)
{
    NEXT(fork);
    return is_hit(PROCESS) ? -1 : next();
}

int pipe2(int fd[2], int flags)
{
    NEXT(pipe2);
    return is_hit(OPEN) ? -1 : next(fd, flags);
}

pid_t waitpid(pid_t child, int *status, int options)
{
    NEXT(waitpid);
    return is_disturbed() ? -1 : next(child, status, options);
}

int poll(struct pollfd *fd, nfds_t number, int timeout)
{
    NEXT(poll);
    return is_disturbed() ? -1 : next(fd, number, timeout);
}

/* Files ---------------------------------------------------------------------------- */

/* The mode is there where the flags make a file. */
static mode_t mode_of(int flags, va_list arguments)
{
    const bool makes = (flags & O_CREAT) || (flags & O_TMPFILE) == O_TMPFILE;
    return makes ? va_arg(arguments, mode_t) : 0;
}

int open(const char *name, int flags, ...)
{
    NEXT(open);
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_of(flags, arguments);
    va_end(arguments);
    return is_hit(OPEN) ? -1 : next(name, flags, mode);
}

int openat(int folder, const char *name, int flags, ...)
{
    NEXT(openat);
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_of(flags, arguments);
    va_end(arguments);
    return is_hit(OPEN) ? -1 : next(folder, name, flags, mode);
}

int mkostemp(char *name, int flags)
{
    NEXT(mkostemp);
    return is_hit(OPEN) ? -1 : next(name, flags);
}

char *mkdtemp(char *name)
{
    NEXT(mkdtemp);
    return is_hit(OPEN) ? NULL : next(name);
}

int mkdir(const char *name, mode_t mode)
{
    NEXT(mkdir);
    return is_hit(OPEN) ? -1 : next(name, mode);
}

FILE *fopen(const char *name, const char *mode)
{
    NEXT(fopen);
    return is_hit(OPEN) ? NULL : next(name, mode);
}

DIR *opendir(const char *name)
{
    NEXT(opendir);
    return is_hit(OPEN) ? NULL : next(name);
}

ssize_t read(int fd, void *bytes, size_t size)
{
    NEXT(read);
    return is_disturbed() || is_hit(READ) ? -1 : next(fd, bytes, part(size));
}

ssize_t write(int fd, const void *bytes, size_t size)
{
    NEXT(write);
    return is_disturbed() || is_hit(WRITE) ? -1 : next(fd, bytes, part(size));
}

/* It is closed all the same. */
int close(int fd)
{
    NEXT(close);
    const int closed = next(fd);
    return is_hit(CLOSE) ? -1 : closed;
}

int linkat(int from, const char *old, int to, const char *new, int flags)
{
    NEXT(linkat);
    return is_hit(NAME) ? -1 : next(from, old, to, new, flags);
}

int rename(const char *old, const char *new)
{
    NEXT(rename);
    return is_hit(NAME) ? -1 : next(old, new);
}

int symlink(const char *to, const char *name)
{
    NEXT(symlink);
    return is_hit(NAME) ? -1 : next(to, name);
}

/* Open MPI, libsc and p4est do not survive a call that fails while they start; that there
 * is memory the library has asked before. What threads they start do is not for us to
 * test, either.
 * ---------------------------------------------------------------------------- */

int MPI_Init_thread(int *arguments, char ***argument, int wanted, int *got);
void sc_init(void *ranks, int catches, int prints, void *log, int level);
void p4est_init(void *log, int level);

int MPI_Init_thread(int *arguments, char ***argument, int wanted, int *got)
{
    NEXT(MPI_Init_thread);
    undisturbed++;
    const int status = next(arguments, argument, wanted, got);
    undisturbed--;
    return status;
}

/* MPI_Comm is a pointer in Open MPI. */
void sc_init(void *ranks, int catches, int prints, void *log, int level)
{
    NEXT(sc_init);
    undisturbed++;
    next(ranks, catches, prints, log, level);
    undisturbed--;
}

void p4est_init(void *log, int level)
{
    NEXT(p4est_init);
    undisturbed++;
    next(log, level);
    undisturbed--;
}
