/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "wrong_option.h"

#include <ctype.h>
#include <string.h>

enum { LETTERS_MAX = 32 };

/* How many letters are to be changed, left out, put in, or swapped with the next one, to
 * make one word of the other (optimal string alignment distance). */
static size_t distance(const char *a, size_t a_size, const char *b)
{
    size_t row[3][LETTERS_MAX + 1], b_size = strlen(b);
    if (a_size > LETTERS_MAX || b_size > LETTERS_MAX)
        return LETTERS_MAX;
    for (size_t j = 0; j <= b_size; j++)
        row[0][j] = j;
    for (size_t i = 1; i <= a_size; i++) {
        size_t *now = row[i % 3], *last = row[(i + 2) % 3], *before = row[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= b_size; j++) {
            size_t best = last[j - 1] + (a[i - 1] != b[j - 1]);
            best = last[j] + 1 < best ? last[j] + 1 : best;
            best = now[j - 1] + 1 < best ? now[j - 1] + 1 : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] &&
                before[j - 2] + 1 < best)
                best = before[j - 2] + 1;
            now[j] = best;
        }
    }
    return row[a_size % 3][b_size];
}

/* The option that is most like the name, or NULL where none is like it. */
static const struct option *nearest(const filter *f, const char *name, size_t size)
{
    const struct option *found = NULL;
    size_t least = size / 3 + 2; /* of these letters one in three may be wrong */
    for (const struct option *o = f->options; o->name; o++) {
        const size_t d = distance(name, size, o->name);
        if (d < least) {
            least = d;
            found = o;
        }
    }
    return found;
}

_Noreturn static void fail_ambiguous(const filter *f, const char *name, size_t size)
{
    char all[256] = "";
    for (const struct option *o = f->options; o->name; o++)
        if (strncmp(o->name, name, size) == 0)
            snprintf(all + strlen(all), sizeof all - strlen(all), "%s--%s",
                     *all ? ", " : "", o->name);
    filter_usage_error(f, "ambiguous option '--%.*s' (%s)", (int)size, name, all);
}

/* `word` is as it was given: --NAME or --NAME=ARGUMENT. */
_Noreturn static void fail_long(const filter *f, const char *word)
{
    const char *name = word + strlen("--");
    const size_t size = strcspn(name, "=");
    const struct option *meant = NULL;
    size_t like = 0;
    for (const struct option *o = f->options; o->name; o++) {
        if (strncmp(o->name, name, size) != 0)
            continue;
        meant = o;
        like++;
        if (o->name[size] == '\0') {
            like = 1;
            break;
        }
    }
    if (like > 1)
        fail_ambiguous(f, name, size);
    if (like == 1 && meant->has_arg == no_argument)
        filter_usage_error(f, "option '--%s' takes no argument, but '%s' is given",
                           meant->name, name + size + 1);
    if (like == 1)
        filter_usage_error(f, "option '--%s' lacks its argument", meant->name);
    meant = nearest(f, name, size);
    if (meant)
        filter_usage_error(f, "unknown option '--%.*s' (--%s?)", (int)size, name,
                           meant->name);
    filter_usage_error(f, "unknown option '--%.*s'", (int)size, name);
}

_Noreturn static void fail_short(const filter *f, int letter)
{
    const int other = islower(letter) ? toupper(letter) : tolower(letter);
    if (letter != ':' && strchr(f->letters, letter))
        filter_usage_error(f, "option '-%c' lacks its argument", letter);
    if (other != letter && strchr(f->letters, other))
        filter_usage_error(f, "unknown option '-%c' (-%c?)", letter, other);
    filter_usage_error(f, "unknown option '-%c'", letter);
}

/* getopt_long() leaves in optopt the letter of a short option that it refuses. Of a long
 * one it leaves 0 or what stands for it, which may be a letter: then the word before
 * optind tells, for a short option that lacks its argument was the end of that word. */
void filter_wrong_option(const filter *f)
{
    const int letter = (unsigned char)optopt;
    const char *word = f->argv[optind - 1];
    const bool is_long = strncmp(word, "--", 2) == 0;
    if (optopt == 0 || optopt >= FILTER_JSON ||
        (is_long && letter != ':' && strchr(f->letters, letter)))
        fail_long(f, word);
    fail_short(f, letter);
}
