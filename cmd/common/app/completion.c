/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "completion.h"

static void print_words(const filter *f, int option)
{
    for (const filter_words *row = f->words; row && row->first; row++)
        for (int k = 0; k < row->count && row->option == option; k++)
            printf(" %s", filter_word_of(row, k));
}

/* The letter of an option; of those that every filter has, unless it is another one's. */
static char letter_of(const filter *f, int option)
{
    if (option == FILTER_QUIET)
        return f->q_is_own ? '-' : 'q';
    if (option == FILTER_THREADS)
        return f->j_is_own ? '-' : 'j';
    return option < FILTER_JSON ? (char)option : '-';
}

void filter_print_completion(const filter *f)
{
    static const char *const argument[] = {[no_argument] = "none",
                                           [required_argument] = "required",
                                           [optional_argument] = "optional"};
    for (const struct option *o = f->options; o->name; o++) {
        printf("%c %s %s", letter_of(f, o->val), o->name, argument[o->has_arg]);
        print_words(f, o->val);
        puts("");
    }
    filter_exit_after_text(f);
}
