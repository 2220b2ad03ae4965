/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "completion.h"

#include <string.h>

static void print_words(const filter *f, int option)
{
    for (const filter_words *row = f->words; row && row->first; row++)
        for (int k = 0; k < row->count && row->option == option; k++)
            printf(" %s", filter_word_of(row, k));
}

/* Letters that are no option of the table, as -j of --threads. */
static void print_letters(const filter *f)
{
    for (const char *at = f->letters; *at; at++) {
        const struct option *o = f->options;
        while (o->name && o->val != *at)
            o++;
        if (*at != ':' && !o->name)
            printf("%c - %s\n", *at, at[1] == ':' ? "required" : "none");
    }
}

void filter_print_completion(const filter *f)
{
    static const char *const argument[] = {[no_argument] = "none",
                                           [required_argument] = "required",
                                           [optional_argument] = "optional"};
    for (const struct option *o = f->options; o->name; o++) {
        printf("%c %s %s", o->val < FILTER_JSON ? o->val : '-', o->name,
               argument[o->has_arg]);
        print_words(f, o->val);
        puts("");
    }
    print_letters(f);
    filter_exit_after_text(f);
}
