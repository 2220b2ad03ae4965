/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rows in the form in which the writer writes them: small whole numbers, one blank before
 * each. Most of a mesh is such rows, so they have a reader of their own: all ends of
 * numbers are found first, so that the numbers need not wait for each other, and nothing
 * is decided before the end of a row. What is otherwise is left to row.c. */
#include "row.h"

#include "../number/digits.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

/* One bit for each of the TM_ROW_WINDOW bytes at `at` that is no digit, the first lowest;
 * all higher bits are set. Subtracting '0' as a number without sign leaves digits at
 * most 9. */
static inline uint64_t gaps_of(const char *at)
{
    uint64_t digits = 0;
#ifdef __SSE2__
    const __m128i zero = _mm_set1_epi8('0'), nine = _mm_set1_epi8(9);
#pragma GCC unroll 3
    for (int v = 0; v < TM_ROW_WINDOW; v += 16) {
        __m128i byte = _mm_loadu_si128((const __m128i *)(const void *)(at + v));
        __m128i value = _mm_sub_epi8(byte, zero);
        __m128i is_digit = _mm_cmpeq_epi8(_mm_min_epu8(value, nine), value);
        digits |= (uint64_t)(unsigned)_mm_movemask_epi8(is_digit) << v;
    }
#else
    for (int i = 0; i < TM_ROW_WINDOW; i++)
        digits |= (uint64_t)((unsigned char)(at[i] - '0') <= 9) << i;
#endif
    return ~digits;
}

/* The place in a row that is being read as plain numbers; `wrong` is not 0 as soon as
 * something was not as it is written. */
typedef struct {
    const char *begin;
    const char *window;
    uint64_t gaps;
    uint64_t wrong;
} plain_row;

/* The digits of the next number, one to eight, as values in the last bytes of a word with
 * zeros before them; `separator` follows. */
static inline uint64_t plain_digits(plain_row *r, char separator)
{
    const char *past = r->window + __builtin_ctzll(r->gaps);
    unsigned others = TM_WORD_BYTES - (unsigned)(past - r->begin);
    uint64_t word = tm_word_load(r->begin) - tm_word_of('0');
    r->gaps &= r->gaps - 1;
    r->wrong |= (others & ~7u) | (unsigned char)(*past ^ separator);
    r->begin = past + 1;
    return word << (8 * others & 63);
}

static inline uint64_t plain_number(plain_row *r, char separator)
{
    return tm_word_join(plain_digits(r, separator));
}

/* The next `count` numbers as nodes below limit; the line ends after them, or a marker
 * follows. */
static inline void plain_nodes(plain_row *r, uint32_t base, size_t limit, uint32_t *to,
                               size_t count, bool line_ends)
{
    for (size_t i = 0; i < count; i++) {
        bool last = i + 1 == count && line_ends;
        uint64_t node = plain_number(r, last ? '\n' : ' ') - base;
        r->wrong |= node >= limit;
        to[i] = (uint32_t)node;
    }
}

/* The four nodes of a tetrahedron, and the line's end. */
static inline void plain_tet(plain_row *r, uint32_t base, size_t limit, uint32_t *to)
{
#ifdef __SSE2__
    /* tm_word_join() for all four at once: digits to pairs, pairs to fours, fours to the
     * eight. */
    const __m128i first = _mm_set1_epi16(0xff), ten = _mm_set1_epi16(10);
    const __m128i hundreds = _mm_set1_epi32(100 | 1 << 16);
    const __m128i ten_thousands = _mm_set1_epi32(10000 | 1 << 16);
    const __m128i last = _mm_set1_epi32(limit < INT32_MAX ? (int)limit - 1 : INT32_MAX);
    uint64_t digits[4];
#pragma GCC unroll 4
    for (int i = 0; i < 4; i++)
        digits[i] = plain_digits(r, i == 3 ? '\n' : ' ');
    __m128i half[2];
#pragma GCC unroll 2
    for (int h = 0; h < 2; h++) {
        __m128i v =
            _mm_set_epi64x((long long)digits[2 * h + 1], (long long)digits[2 * h]);
        __m128i pairs = _mm_add_epi16(_mm_mullo_epi16(_mm_and_si128(v, first), ten),
                                      _mm_srli_epi16(v, 8));
        half[h] = _mm_madd_epi16(pairs, hundreds);
    }
    __m128i number = _mm_madd_epi16(_mm_packs_epi32(half[0], half[1]), ten_thousands);
    __m128i node = _mm_sub_epi32(number, _mm_set1_epi32((int)base));
    __m128i wrong = _mm_or_si128(_mm_cmpgt_epi32(node, last),
                                 _mm_cmplt_epi32(node, _mm_setzero_si128()));
    r->wrong |= (uint64_t)(unsigned)_mm_movemask_epi8(wrong);
    _mm_storeu_si128((__m128i *)(void *)to, node);
#else
    plain_nodes(r, base, limit, to, 4, true);
#endif
}

static const char *read_tets(tm_row_context *c, const char *at, const char *end,
                             size_t most)
{
    size_t row = c->block->count, limit = c->limit, first = c->before + c->base;
    uint32_t base = c->base, *to = c->block->integer;
    while (row < most && at < end) {
        plain_row r = {at, at, gaps_of(at), 0};
        uint64_t number = plain_number(&r, ' ');
        plain_tet(&r, base, limit, to + 4 * row);
        if (r.wrong | (number ^ (row + first)))
            break;
        at = r.begin;
        row++;
    }
    c->block->count = row;
    return at;
}

/* Faces and edges. */
static const char *read_others(tm_row_context *c, const char *at, const char *end,
                               size_t most)
{
    tm_block *block = c->block;
    size_t width = c->shape->integers, row = block->count, first = c->before + c->base;
    while (row < most && at < end) {
        plain_row r = {at, at, gaps_of(at), 0};
        uint64_t number = plain_number(&r, ' ');
        plain_nodes(&r, c->base, c->limit, block->integer + row * width, width,
                    !block->markers);
        if (block->markers)
            block->marker[row] = (int32_t)plain_number(&r, '\n');
        if (r.wrong | (number ^ (row + first)))
            break;
        at = r.begin;
        row++;
    }
    block->count = row;
    return at;
}

const char *tm_row_read_plain(tm_row_context *c, const char *at, const char *end,
                              size_t most)
{
    tm_block_kind kind = c->block->kind;
    if (c->block->attributes > 0 || c->limit == 0)
        return at;
    if (kind == TM_ELE)
        return read_tets(c, at, end, most);
    return kind == TM_FACE || kind == TM_EDGE ? read_others(c, at, end, most) : at;
}
