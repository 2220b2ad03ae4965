/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "plot_style.h"

#include <stdio.h>

const char plot_settings[] =
    "set terminal svg size 1040,450 enhanced font 'Helvetica,15' background 'white'\n"
    "set encoding utf8\n"
    "set border 3 linecolor '#555555'\n"
    "set tics nomirror out scale 0.6 textcolor '#333333'\n"
    "set xtics offset 0,0.35\n"
    "set grid ytics back linetype 1 linewidth 0.6 linecolor '#e4e4e4'\n"
    "set tmargin screen 0.86\n"
    "set bmargin screen 0.185\n"
    "unset key\n"
    "bad = '#fbe9e7'\n"
    "grey = '#b4bac1'\n"
    "blue = '#1f6fb2'\n"
    "set multiplot\n";

void plot_grouped(tm_text *script, size_t number)
{
    enum { GROUP = 3, DIGITS = 24 };
    char digits[DIGITS];
    const int length = snprintf(digits, sizeof digits, "%zu", number);
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % GROUP == 0)
            tm_text_string(script, "\u2009");
        tm_text_append(script, &digits[i], 1);
    }
}
