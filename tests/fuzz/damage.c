/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "damage.h"

#include "../unit/random.h"

#include <ctype.h>
#include <string.h>

/* All blocks that a stream may have. */
static const char all_blocks[] = "termesh 1\n# made by hand\n.node\n"
                                 "8 3 2 1\n"
                                 "1 0 0 0 .5 7 1\n2 1 0 0 1e-3 7 1\n3 1 1 0 -2 7 2\n"
                                 "4 0 1 0 3 7 2\n5 0 0 1 0 7 0\n6 1 0 1 0 7 -1\n"
                                 "7 1 1 1 0 7 0\n8 0 1 1 0 7 0\n"
                                 ".ele\n5 4 1\n"
                                 "1 1 2 3 6 1\n2 1 3 4 8 1\n3 1 6 8 5 2\n4 3 6 7 8 2\n"
                                 "5 1 3 8 6 2\n"
                                 ".face\n4 1\n"
                                 "1 1 3 2 5\n2 1 2 6 5\n3 1 4 3 -6\n4 3 6 1 9\n"
                                 ".edge\n3 1\n1 1 2 4\n2 1 3 0\n3 3 4 4\n"
                                 ".mix\n3 1\n"
                                 "1 8 1 2 3 4 5 6 7 8 0\n2 4 1 2 3 6 1.5\n"
                                 "3 5 1 2 3 4 5 2\n"
                                 ".octant\n2 0\n1 1 0 0 0 1 3\n2 1 1 0 0 3 4\n"
                                 ".root\n1 0\n1 0 0 0 1 1\n"
                                 ".facet\n4 1\n"
                                 "1 1 -1 3 1 3 2 0\n2 1 -1 3 1 2 6 0\n"
                                 "3 1 -1 3 2 3 6 0\n4 1 -1 3 1 6 3 0\n"
                                 ".cell\n1 1\n1 4 1 2 3 4 0.25\n"
                                 "surface.node\n4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n"
                                 "4 0 0 1\n"
                                 "surface.face\n4 1\n1 1 3 2 5\n2 1 2 4 5\n3 2 3 4 6\n"
                                 "4 1 4 3 0\n"
                                 ".group\n3 0\n1 2 5 inlet port\n2 3 1 steel\n"
                                 "3 1 4 gr\xc3\xb6\xc3\x9f"
                                 "er\n"
                                 "# a comment\n.unknown\nsome text\n\n# and more\n.end\n";

/* What numbers are replaced by. */
static const char *const odd_numbers[] = {
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "255",
    "1000",
    "1001",
    "65536",
    "2147483648",
    "4294967294",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "99999999999999999999999",
    "1e15",
    "1e154",
    "1.7976931348623157e308",
    "1e309",
    "5e-324",
    "1e-170",
    "0.1",
    "0.30000000000000004",
    "nan",
    "inf",
    "0x10",
    "1,5",
    "",
};
enum { ODD_NUMBERS = sizeof odd_numbers / sizeof odd_numbers[0] };

/* The six tetrahedra of a cube, as corners 4z + 2y + x, around the diagonal 0 7. */
static const unsigned char cube[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                         {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

/* A coordinate of the lattice, moved by up to `moved` steps of a grid, so that nodes in
 * one place or plane occur. */
static double coordinate(unsigned i, unsigned moved)
{
    enum { GRID = 8 };
    return i + ((double)random_below(2 * moved + 1) - moved) / GRID;
}

/* A block of cubes, cut into tetrahedra, with nodes moved. */
static void make_lattice(tm_text *text)
{
    enum { SIDE_MAX = 3, MOVED_MAX = 5 };
    unsigned n = 1 + random_below(SIDE_MAX), m = n + 1, moved = random_below(MOVED_MAX);
    unsigned base = random_below(2), markers = random_below(2);
    tm_text_format(text, "termesh 1\n.node\n%u 3 0 %u\n", m * m * m, markers);
    for (unsigned v = 0; v < m * m * m; v++) {
        tm_text_format(text, "%u %g %g %g", v + base, coordinate(v % m, moved),
                       coordinate(v / m % m, moved), coordinate(v / m / m, moved));
        tm_text_string(text, markers ? random_below(2) ? " 3\n" : " 0\n" : "\n");
    }
    tm_text_format(text, ".ele\n%u 4 1\n", 6 * n * n * n);
    for (unsigned t = 0; t < 6 * n * n * n; t++) {
        unsigned c = t / 6, corner = c % n + m * (c / n % n) + m * m * (c / n / n);
        tm_text_format(text, "%u", t + base);
        for (unsigned i = 0; i < 4; i++) {
            unsigned k = cube[t % 6][i];
            tm_text_format(text, " %u",
                           corner + k % 2 + m * (k / 2 % 2) + m * m * (k / 4) + base);
        }
        tm_text_string(text, random_below(8) ? " 1\n" : " 2\n");
    }
    tm_text_string(text, ".end\n");
}

/* A row of .facet of make_cells(): the square below a cube, across an axis. */
static void make_square(tm_text *text, const unsigned p[3], unsigned axis, unsigned n,
                        unsigned base)
{
    const unsigned m = n + 1, step[3] = {1, m, m * m}, cube_step[3] = {1, n, n * n};
    const unsigned u = step[(axis + 1) % 3], w = step[(axis + 2) % 3];
    const unsigned v = p[0] + m * (p[1] + m * p[2]) + base;
    const unsigned above = p[0] + n * (p[1] + n * p[2]) + base;
    const unsigned below = above - cube_step[axis];
    if (p[axis] == 0)
        tm_text_format(text, " %u -1 4 %u %u %u %u\n", above, v, v + w, v + u + w, v + u);
    else if (p[axis] == n)
        tm_text_format(text, " %u -1 4 %u %u %u %u\n", below, v, v + u, v + u + w, v + w);
    else
        tm_text_format(text, " %u %u 4 %u %u %u %u\n", below, above, v, v + u, v + u + w,
                       v + w);
}

/* The number of the square below the cube at p across an axis. */
static unsigned square(const unsigned p[3], unsigned axis, unsigned n)
{
    const unsigned u = (axis + 1) % 3, w = (axis + 2) % 3;
    return (n + 1) * n * n * axis + (p[axis] * n + p[u]) * n + p[w];
}

/* A block of cubes as polyhedra, with nodes moved, so that no facet need be plane. */
static void make_cells(tm_text *text)
{
    enum { SIDE_MAX = 3, MOVED_MAX = 5, AXES = 3 };
    const unsigned n = 1 + random_below(SIDE_MAX), m = n + 1;
    const unsigned moved = random_below(MOVED_MAX), base = random_below(2);
    tm_text_format(text, "termesh 1\n.node\n%u 3 0 0\n", m * m * m);
    for (unsigned v = 0; v < m * m * m; v++)
        tm_text_format(text, "%u %g %g %g\n", v + base, coordinate(v % m, moved),
                       coordinate(v / m % m, moved), coordinate(v / m / m, moved));
    tm_text_format(text, ".facet\n%u 0\n", AXES * m * n * n);
    for (unsigned f = 0; f < AXES * m * n * n; f++) {
        const unsigned axis = f / (m * n * n), rest = f % (m * n * n);
        unsigned p[3];
        p[axis] = rest / (n * n);
        p[(axis + 1) % 3] = rest / n % n;
        p[(axis + 2) % 3] = rest % n;
        tm_text_format(text, "%u", f + base);
        make_square(text, p, axis, n, base);
    }
    tm_text_format(text, ".cell\n%u 1\n", n * n * n);
    for (unsigned c = 0; c < n * n * n; c++) {
        unsigned p[3] = {c % n, c / n % n, c / n / n};
        tm_text_format(text, "%u 6", c + base);
        for (unsigned axis = 0; axis < AXES; axis++) {
            tm_text_format(text, " %u", square(p, axis, n) + base);
            p[axis]++;
            tm_text_format(text, " %u", square(p, axis, n) + base);
            p[axis]--;
        }
        tm_text_string(text, " 6\n");
    }
    tm_text_string(text, ".end\n");
}

/* Puts bytes in the place of [from, to). */
static void replace(tm_text *text, size_t from, size_t to, const char *bytes, size_t size)
{
    tm_text changed = {0};
    tm_text_append(&changed, text->byte, from);
    tm_text_append(&changed, bytes, size);
    tm_text_append(&changed, text->byte + to, text->size - to);
    tm_text_free(text);
    *text = changed;
}

static size_t anywhere(const tm_text *text)
{
    return random_below((unsigned)text->size + 1);
}

static void replace_number(tm_text *text)
{
    size_t from = anywhere(text);
    while (from > 0 && !isspace((unsigned char)text->byte[from - 1]))
        from--;
    size_t to = from;
    while (to < text->size && !isspace((unsigned char)text->byte[to]))
        to++;
    const char *number = odd_numbers[random_below(ODD_NUMBERS)];
    replace(text, from, to, number, strlen(number));
}

static void replace_byte(tm_text *text)
{
    static const char likely[] = "0123456789-+.eE \n\r\t#";
    char byte = random_below(4) ? likely[random_below(sizeof likely - 1)]
                                : (char)random_below(UINT8_MAX + 1);
    if (text->size > 0)
        text->byte[random_below((unsigned)text->size)] = byte;
}

/* A piece of the stream, of any size or of whole lines. */
static void choose_piece(const tm_text *text, size_t *from, size_t *to)
{
    enum { LONG = 64 };
    *from = anywhere(text);
    *to = *from + random_below(LONG);
    if (*to > text->size)
        *to = text->size;
    if (random_below(2))
        return;
    while (*from > 0 && text->byte[*from - 1] != '\n')
        (*from)--;
    while (*to < text->size && text->byte[*to - (*to > 0)] != '\n')
        (*to)++;
}

static void damage(tm_text *text)
{
    size_t from, to;
    choose_piece(text, &from, &to);
    switch (random_below(8)) {
    case 0:
        replace(text, anywhere(text), text->size, "", 0);
        break;
    case 1:
        replace(text, from, to, "", 0);
        break;
    case 2: {
        size_t at = anywhere(text);
        tm_text piece = {0};
        tm_text_append(&piece, text->byte + from, to - from);
        replace(text, at, at, piece.byte, piece.size);
        tm_text_free(&piece);
        break;
    }
    case 3:
        replace_byte(text);
        break;
    default:
        replace_number(text);
    }
}

/* All blocks, or those of mixed elements, or of tetrahedra: else no filter that takes
 * these would see them. */
static void make_blocks(tm_text *text)
{
    static const char *const name[] = {"\n.cell\n", "\n.facet\n", "\n.root\n",
                                       "\n.octant\n", "\n.mix\n"};
    const size_t gone[] = {0, 1, sizeof name / sizeof *name};
    tm_text_string(text, all_blocks);
    for (size_t i = 0, count = gone[random_below(3)]; i < count; i++) {
        const char *from = strstr(text->byte, name[i]) + 1;
        const char *to = strstr(from + 1, "\n.") ? strstr(from + 1, "\n.") + 1 : from;
        const char *part = strstr(from, "\nsurface.");
        if (part && part + 1 < to)
            to = part + 1;
        replace(text, (size_t)(from - text->byte), (size_t)(to - text->byte), "", 0);
    }
}

void make_damaged(tm_text *text, uint64_t seed, uint64_t number)
{
    enum { DAMAGES = 4 };
    random_state = seed;
    random_state = random_bits() + number;
    random_state = random_bits();
    switch (random_below(4)) {
    case 0:
        make_cells(text);
        break;
    case 1:
        make_blocks(text);
        break;
    default:
        make_lattice(text);
    }
    for (unsigned n = random_below(DAMAGES); n > 0 && text->size > 0; n--)
        damage(text);
}
