/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "ranks.h"

#include <limits.h>
#include <stdlib.h>

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
