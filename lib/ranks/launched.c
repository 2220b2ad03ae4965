/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ranks.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

extern char **environ;

/* The number that the first of these variables that is there has, or `none`. */
static unsigned number_in(const char *const *variable, size_t count, unsigned none)
{
    for (size_t i = 0; i < count; i++) {
        const char *text = getenv(variable[i]);
        char *end;
        const unsigned long number = text ? strtoul(text, &end, 10) : 0;
        if (text && end != text && number < INT_MAX)
            return (unsigned)number;
    }
    return none;
}

bool tm_launched(void)
{
    return getenv("OMPI_COMM_WORLD_SIZE") || getenv("PMIX_RANK") || getenv("PMI_RANK");
}

unsigned tm_launched_rank(void)
{
    static const char *const variable[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK",
                                           "PMI_RANK"};
    return number_in(variable, sizeof variable / sizeof *variable, 0);
}

/* PMIx says a rank only: where srun gives it, it says the size itself. */
unsigned tm_launched_count(void)
{
    static const char *const variable[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE",
                                           "SLURM_NTASKS"};
    if (!tm_launched())
        return 1;
    const unsigned count = number_in(variable, sizeof variable / sizeof *variable, 1);
    return count > 0 ? count : 1;
}

/* Whether a variable is one by which a launcher says that there are others. */
static bool is_launchers(const char *variable)
{
    static const char *const prefix[] = {"OMPI_COMM_WORLD_",
                                         "OMPI_UNIVERSE_SIZE=", "PMIX_", "PMI_"};
    for (size_t i = 0; i < sizeof prefix / sizeof *prefix; i++)
        if (strncmp(variable, prefix[i], strlen(prefix[i])) == 0)
            return true;
    return false;
}

void tm_launched_forget(void)
{
    char name[256];
    for (size_t i = 0; environ[i];) {
        const size_t length = strcspn(environ[i], "=");
        if (!is_launchers(environ[i]) || length >= sizeof name) {
            i++;
            continue;
        }
        memcpy(name, environ[i], length);
        name[length] = '\0';
        unsetenv(name);
    }
}
