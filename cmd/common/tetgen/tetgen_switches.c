/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tetgen_switches.h"

#include "../../../lib/number/number.h"

#include <float.h>
#include <string.h>

void tetgen_volume_switch(char to[TETGEN_SWITCH], double value)
{
    *to++ = '-';
    *to++ = 'a';
    *tm_write_double(to, value) = '\0';
}

void tetgen_ratio_switch(char to[TETGEN_SWITCH], double value)
{
    double read = 0;
    for (int decimals = 0; decimals < DBL_DIG + 2 && read != value; decimals++) {
        snprintf(to, TETGEN_SWITCH, "-q%.*f", decimals, value);
        tm_read_double(to + 2, to + strlen(to), &read);
    }
}

/* What TetGen 1.5 has switches for: those that change the mesh, each with what of a
 * number it reads behind it; those that need files that it is not given, or that write
 * others than are read; those that change nothing here. */
static const struct {
    char letter;
    const char *number;
} taken[] = {{'A', ""},
             {'a', "0123456789.eE+-"},
             {'c', ""},
             {'C', ""},
             {'D', "0123456789"},
             {'e', ""},
             {'f', ""},
             {'J', ""},
             {'M', "0123456789/"},
             {'O', "0123456789/"},
             {'q', "0123456789./"},
             {'S', "0123456789"},
             {'T', "0123456789.eE+-"},
             {'V', ""},
             {'Y', "0123456789/"}};
static const char refused[] = "dhiImNEFloRrtw", idle[] = "BgGkKnpQvxXz";

/* Behind the switch that a text begins with; exits where that is none that is taken. */
static const char *skip_switch(const filter *f, const char *at)
{
    for (size_t i = 0; i < sizeof taken / sizeof *taken; i++)
        if (*at == taken[i].letter)
            return at + 1 + strspn(at + 1, taken[i].number);
    if (strchr(refused, *at))
        filter_usage_error(f, "--switches: '%c' is not possible here (nor any of %s)",
                           *at, refused);
    if (strchr(idle, *at))
        filter_usage_error(f, "--switches: '%c' would do nothing here (nor any of %s)",
                           *at, idle);
    filter_usage_error(f, "--switches: '%c' is no switch of TetGen here", *at);
}

void tetgen_take_switches(const filter *f, tetgen_request *r, tm_text *more,
                          const char *switches)
{
    if (*switches == '-')
        switches++;
    if (!*switches)
        filter_usage_error(f, "--switches: there are none");
    for (const char *at = switches; *at;)
        at = skip_switch(f, at);
    tm_text_string(more, "-");
    tm_text_string(more, switches);
    r->more = more->byte;
}
