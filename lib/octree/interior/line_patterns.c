/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "line_patterns.h"
#include "octant_mask.h"

#include <stdlib.h>

enum { OCTANTS = 8, SIDES = 6 };

const uint8_t tm_side_octants[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

bool tm_sectors_turn(const unsigned label[4], unsigned count)
{
    unsigned steps = 0, met = 0;
    for (unsigned i = 0; i < 4; i++) {
        const unsigned next = label[(i + 1) % 4];
        met |= 1u << label[i];
        if (next != label[i] && next != (label[i] + 1) % count)
            return false;
        steps += next != label[i];
    }
    return met == (1u << count) - 1 && steps == count;
}

static unsigned count_met(tm_line_code code, unsigned side)
{
    unsigned met = 0, count = 0;
    for (unsigned i = 0; i < 4; i++)
        met |= 1u << tm_code_at(code, tm_side_octants[side][i]);
    for (; met; met >>= 1)
        count += met & 1;
    return count;
}

static bool has_good_masks(tm_line_code code, unsigned sectors)
{
    unsigned sector[OCTANTS];
    for (unsigned o = 0; o < OCTANTS; o++)
        sector[o] = tm_code_at(code, o);
    return tm_octants_are_good(sector, sectors);
}

/* Whether no face is between sectors that are not neighbours. */
static bool has_good_faces(tm_line_code code, unsigned sectors)
{
    for (unsigned o = 0; o < OCTANTS; o++)
        for (unsigned axis = 0; axis < 3 && sectors == 4; axis++)
            if ((tm_code_at(code, o) ^ tm_code_at(code, o ^ 1u << axis)) == 2)
                return false;
    return true;
}

/* Whether the code is a pattern, and which. */
static bool look_at(tm_line_code code, unsigned sectors, tm_line_pattern *pattern)
{
    unsigned ends = 0, from = SIDES, to = SIDES;
    for (unsigned side = 0; side < SIDES; side++) {
        const unsigned met = count_met(code, side);
        unsigned out[4], in[4];
        if (met < 3)
            continue;
        if (met < sectors || ++ends > 2)
            return false;
        for (unsigned i = 0; i < 4; i++) {
            out[i] = tm_code_at(code, tm_side_octants[side][i]);
            in[3 - i] = out[i];
        }
        if (tm_sectors_turn(out, sectors))
            to = side;
        else if (tm_sectors_turn(in, sectors))
            from = side;
    }
    *pattern = (tm_line_pattern){code, (uint8_t)from, (uint8_t)to, 0};
    return ends == 2 && from < SIDES && to < SIDES && has_good_masks(code, sectors) &&
           has_good_faces(code, sectors);
}

/* The next way to give octants sectors; false after the last one. */
static bool next_code(tm_line_code *code, unsigned sectors)
{
    for (unsigned o = 0; o < OCTANTS; o++) {
        const unsigned at = tm_code_at(*code, o);
        *code = (tm_line_code)(*code & ~(3u << 2 * o));
        if (at + 1 < sectors) {
            *code = (tm_line_code)(*code | (at + 1) << 2 * o);
            return true;
        }
    }
    return false;
}

static unsigned bucket_of(const tm_line_pattern *p)
{
    return TM_SIDE_CODES * p->from + tm_side_code(p->code, p->from);
}

/* Numbers the ends of the patterns. */
static void number_ends(tm_line_patterns *patterns)
{
    uint16_t number[SIDES * TM_SIDE_CODES] = {0}; /* 0: none yet */
    for (uint32_t i = 0; i < patterns->count; i++) {
        tm_line_pattern *p = &patterns->pattern[i];
        uint16_t *of = &number[TM_SIDE_CODES * p->to + tm_side_code(p->code, p->to)];
        if (*of == 0)
            *of = (uint16_t)++patterns->ends;
        p->end = (uint16_t)(*of - 1);
    }
}

tm_status tm_line_patterns_make(tm_line_patterns *patterns, unsigned sectors,
                                tm_error *error)
{
    *patterns = (tm_line_patterns){0};
    uint32_t *start = patterns->start;
    tm_line_pattern found;
    tm_line_code code = 0;
    do
        if (look_at(code, sectors, &found)) {
            start[bucket_of(&found) + 1]++;
            patterns->count++;
        }
    while (next_code(&code, sectors));
    patterns->pattern = malloc((patterns->count + 1) * sizeof *patterns->pattern);
    if (!patterns->pattern)
        return tm_fail_memory(error);
    for (unsigned i = 0; i < SIDES * TM_SIDE_CODES; i++)
        start[i + 1] += start[i];
    uint32_t fill[SIDES * TM_SIDE_CODES];
    for (unsigned i = 0; i < SIDES * TM_SIDE_CODES; i++)
        fill[i] = start[i];
    do
        if (look_at(code, sectors, &found))
            patterns->pattern[fill[bucket_of(&found)]++] = found;
    while (next_code(&code, sectors));
    number_ends(patterns);
    return TM_OK;
}

void tm_line_patterns_free(tm_line_patterns *patterns)
{
    free(patterns->pattern);
    *patterns = (tm_line_patterns){0};
}
