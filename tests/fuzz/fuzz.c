/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Damaged streams for the library and for every filter:
 *
 *     fuzz FOLDER CASES
 *
 * FOLDER holds the filters. Each case is read by the library; what it reads as a stream
 * must be written and read back alike; polyhedra are examined and measured, mixed
 * elements examined; tetrahedra must stay a mesh when they are improved.
 * Every FILTER_EVERY-th case goes through the filters: no signal, no report of a
 * sanitizer, no other exit status than 0, 1 and 3. No case may take longer than SECONDS
 * of processor time, or stand still.
 * TM_SEED repeats a run. The first case that fails is kept in a file. */
#include "../unit/random.h"
#include "damage.h"
#include "stream_checks.h"

#include <dirent.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FILTER_EVERY = 50, SECONDS = 20, PATIENCE = 600 };

typedef struct {
    const char *name;
    const char *arguments[8];
    bool may_fail; /* also exit status 4: a program that it runs fails, or files of
                      another case are in its way */
} command;

/* INPUT is the damaged stream; BASE the beginning of names of files beside it, MESH a
 * folder. */
#define INPUT "input.tm"
#define BASE  "base"
#define MESH  "mesh"

static const command commands[] = {
    {"tet-stats", {"--list", INPUT}, false},
    {"tet-stats", {INPUT, INPUT}, false},
    {"jens-stats", {"-l", "--certify", INPUT}, false},
    {"jens-stats", {"--verdict", "--json", "-", "-o", "list", INPUT}, false},
    {"octree-repair", {"-t", "0.2", "-i", "2", "-o", "out.tm", INPUT}, false},
    {"octree-repair",
     {"--method", "refine", "-i", "1", "--trace", "trace", INPUT},
     false},
    {"lepp-improve", {INPUT}, false},
    {"lepp-improve", {"-t", "45", "--max-growth", "0.5", INPUT}, true},
    {"lepp-improve", {"-a", "selective", "-Q", "volume", "-m", "1", INPUT}, false},
    {"lepp-improve",
     {"-a", "selective", "--with", "both", "--path", "full", INPUT},
     false},
    {"lepp-improve", {"-a", "delaunay", "--max-growth", "3", INPUT}, false},
    {"polylla3d", {"--merge-coplanar", INPUT}, false},
    {"polylla3d", {"--star", "--absorb", "--ignore-markers", INPUT}, false},
    {"polylla3d", {"--mode", "cavity", "--no-repair", INPUT}, false},
    {"poly-dual", {INPUT}, false},
    {"poly-dual", {"--feature-angle", "30", "--convex", INPUT}, false},
    {"mesh-check", {INPUT}, false},
    {"poly-stats", {INPUT}, false},
    {"tetgen-export", {"out", INPUT}, true},
    {"tetgen-import", {BASE}, false},
    {"gmsh-export", {"-o", "out.msh", INPUT}, false},
    {"gmsh-export", {"--format", "msh2", "--binary", "-", INPUT}, false},
    {"gmsh-import", {"out.msh"}, true},
    {"off-export", {INPUT}, false},
    {"off-export", {"--all", INPUT}, false},
    {"stl-export", {"--binary", "-o", "out.stl", INPUT}, false},
    {"surface-import", {"out.stl"}, true},
    {"ply-export", {"--regions", "--binary", "-o", "out.ply", INPUT}, false},
    {"surface-import", {"out.ply"}, true},
    {"obj-export", {"-o", "out.obj", INPUT}, false},
    {"surface-import", {INPUT}, false},
    {"surface-mend",
     {"--weld", "auto", "--fill", "1", "--islands", "0.01", INPUT},
     false},
    {"openfoam-export", {MESH, INPUT}, false},
    {"openfoam-import", {MESH}, true},
    {"openfoam-import", {"--elements", MESH}, true},
    {"visf-export", {"--neighbours", "-o", "out.visf", INPUT}, false},
    {"visf-import", {"out.visf"}, true},
    {"visf-import", {INPUT}, false},
    {"visf-export", {"--per-cell", "--binary", "big", INPUT}, false},
    {"vtu-export", {"-o", "out.vtu", INPUT}, false},
    {"vtu-import", {"out.vtu"}, true},
    {"vtu-import", {INPUT}, false},
    {"abaqus-export", {"-o", "out.inp", INPUT}, false},
    {"abaqus-import", {"out.inp"}, true},
    {"abaqus-import", {INPUT}, false},
    {"medit-export", {"-o", "out.mesh", INPUT}, false},
    {"medit-import", {"out.mesh"}, true},
    {"medit-import", {INPUT}, false},
    {"medit-export", {"--binary", "--sol", "out.solb", "-o", "out.meshb", INPUT}, false},
    {"medit-import", {"--sol", "out.solb", "out.meshb"}, true},
    {"vtk-export", {"-o", "out.vtk", INPUT}, false},
    {"vtk-import", {"out.vtk"}, true},
    {"vtk-import", {INPUT}, false},
    {"mesh-view", {"-o", "out.html", "--most", "2", INPUT}, false},
    {"getfem-export", {INPUT}, false},
    {"mvm-export", {INPUT}, false},
    {"m3d-export", {"-o", "out.m3d", INPUT}, false},
    {"m3d-import", {"out.m3d"}, true},
    {"m3d-import", {INPUT}, false},
    {"mdl-import", {INPUT}, false},
    {"oct-export", {"-o", "out.oct", INPUT}, false},
    {"oct-import", {"out.oct"}, true},
    {"oct-import", {"-m", "out.m3d", INPUT}, true},
    {"octree-mesh", {"-s", "3", INPUT}, false},
    {"octree-mesh", {"-b", INPUT, "-l", INPUT, INPUT}, false},
    {"octree-mesh", {"-s", "2", "-u", "--lenient", INPUT}, false},
    {"octree-mesh", {"-s", "2", "-r", INPUT, "3", INPUT}, false},
    {"tetgen-mesh", {"--tetgen", "false", INPUT}, true},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static const char *folder;
static char work[] = "/tmp/termesh-fuzz.XXXXXX";

/* The filters ---------------------------------------------------------------------- */

static void write_file(const char *name, const char *bytes, size_t size)
{
    FILE *file = fopen(name, "w");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0)
        give_up(name);
}

/* The blocks that TetGen knows as files. */
static void write_tetgen_files(const tm_text *text)
{
    static const char *const suffixes[] = {".node", ".ele", ".face", ".edge"};
    for (size_t s = 0; s < sizeof suffixes / sizeof suffixes[0]; s++) {
        char line[16], name[32];
        snprintf(line, sizeof line, "\n%s\n", suffixes[s]);
        snprintf(name, sizeof name, BASE "%s", suffixes[s]);
        const char *begin = text->byte ? strstr(text->byte, line) : NULL;
        begin = begin ? begin + strlen(line) : "";
        const char *end = strstr(begin, "\n.");
        write_file(name, begin, end ? (size_t)(end - begin) : strlen(begin));
    }
}

/* Ends this process after so many seconds of processor time, or of any; 0: never. */
static void limit_time(time_t processor, unsigned any)
{
    const struct itimerval timer = {.it_value = {.tv_sec = processor}};
    setitimer(ITIMER_PROF, &timer, NULL);
    alarm(any);
}

/* Runs a filter in the work folder. Returns wait()'s status, or 0 where the filter was
 * not built, as there is no p4est. */
static int run(const command *c)
{
    char program[PATH_MAX];
    char *arguments[sizeof c->arguments / sizeof c->arguments[0] + 2] = {program};
    snprintf(program, sizeof program, "%s/%s", folder, c->name);
    if (access(program, X_OK) != 0)
        return 0;
    memcpy(arguments + 1, c->arguments, sizeof c->arguments);
    pid_t child = fork();
    if (child < 0)
        give_up("fork");
    if (child == 0) {
        limit_time(SECONDS, PATIENCE);
        if (!freopen("/dev/null", "r", stdin) || !freopen("/dev/null", "w", stdout) ||
            !freopen("messages", "w", stderr))
            _exit(SECONDS);
        execv(program, arguments);
        _exit(127);
    }
    int status;
    waitpid(child, &status, 0);
    return status;
}

static void show_messages(void)
{
    char line[512];
    FILE *file = fopen("messages", "r");
    while (file && fgets(line, sizeof line, file))
        fputs(line, stderr);
    if (file)
        fclose(file);
}

static void check_filters(const tm_text *text)
{
    write_file(INPUT, text->byte ? text->byte : "", text->size);
    write_tetgen_files(text);
    for (size_t c = 0; c < COMMANDS; c++) {
        int status = run(&commands[c]), code = WEXITSTATUS(status);
        if (WIFEXITED(status) && (code == 0 || code == 1 || code == TM_ERROR_INPUT ||
                                  (code == TM_ERROR_SYSTEM && commands[c].may_fail)))
            continue;
        show_messages();
        if (WIFEXITED(status))
            fprintf(stderr, "fuzz: %s: exit status %d\n", commands[c].name, code);
        else
            fprintf(stderr, "fuzz: %s: %s\n", commands[c].name,
                    strsignal(WTERMSIG(status)));
        abort();
    }
}

/* ---------------------------------------------------------------------------------- */

/* The cases from *current on, which tells the parent where a crash was. */
static void run_cases(uint64_t seed, uint64_t cases, volatile uint64_t *current)
{
    for (; *current < cases; ++*current) {
        tm_text text = {0};
        make_damaged(&text, seed, *current);
        limit_time(SECONDS, PATIENCE);
        check_bytes(text.byte, text.size);
        limit_time(0, 0);
        if (*current % FILTER_EVERY == 0)
            check_filters(&text);
        tm_text_free(&text);
    }
}

/* Every filter of the folder has a command above. */
static void require_all_filters(int filters, char **filter)
{
    for (int i = 0; i < filters; i++) {
        bool found = false;
        for (size_t c = 0; c < COMMANDS && !found; c++)
            found = strcmp(commands[c].name, filter[i]) == 0;
        if (!found) {
            fprintf(stderr, "fuzz: no command for %s\n", filter[i]);
            exit(EXIT_FAILURE);
        }
    }
}

/* Keeps the case in the work folder and says how to have it again. */
static void report_failure(uint64_t seed, uint64_t number, int status)
{
    tm_text text = {0};
    make_damaged(&text, seed, number);
    write_file(INPUT, text.byte ? text.byte : "", text.size);
    fprintf(stderr, "fuzz: case %" PRIu64 " of TM_SEED=%" PRIu64 ": %s; it is %s/%s\n",
            number, seed,
            WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "a sanitizer's report",
            work, INPUT);
}

/* Removes a folder with its files. */
static void remove_folder(const char *name)
{
    DIR *entries = opendir(name);
    const struct dirent *entry;
    while (entries && (entry = readdir(entries)))
        unlinkat(dirfd(entries), entry->d_name, 0);
    if (entries)
        closedir(entries);
    rmdir(name);
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: fuzz FOLDER CASES [FILTER…]\n");
        return 2;
    }
    char resolved[PATH_MAX];
    folder = realpath(argv[1], resolved);
    uint64_t cases = strtoull(argv[2], NULL, 10);
    require_all_filters(argc - 3, argv + 3);
    random_start();
    fflush(stdout);
    const uint64_t seed = random_state;
    volatile uint64_t *current = mmap(NULL, sizeof *current, PROT_READ | PROT_WRITE,
                                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (!folder || current == MAP_FAILED || !mkdtemp(work) || chdir(work) != 0)
        give_up(work);
    pid_t child = fork();
    if (child < 0)
        give_up("fork");
    if (child == 0) {
        run_cases(seed, cases, current);
        return 0;
    }
    int status;
    waitpid(child, &status, 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        report_failure(seed, *current, status);
        return EXIT_FAILURE;
    }
    remove_folder(MESH);
    remove_folder(work);
    printf("%" PRIu64 " cases\n", cases);
    return 0;
}
