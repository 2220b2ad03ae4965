/* SPDX-License-Identifier: GPL-3.0-or-later */
/* exact [SPACING]: the exact predicates on random points of a lattice, beside the same
 * determinants in GMP's rational numbers: nanoseconds of CPU for a call, the median of
 * five runs, and their ratio. Signs are compared. */
#include "../../lib/geom/predicates.h"

#include <gmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { SETS = 2000, POINTS = 5, RUNS = 5, LATTICE = 20 };

typedef double point_set[POINTS][3];
typedef int predicate(const point_set p);

static int orient3d(const point_set p)
{
    return tm_orient3d_exact(p[0], p[1], p[2], p[3]);
}

static int insphere(const point_set p)
{
    return tm_insphere_exact(p[0], p[1], p[2], p[3], p[4]);
}

/* d[v][0 … 2]: point v seen from `origin`, and its squared distance in d[v][3]. */
static void differences(mpq_t d[POINTS][4], const point_set p, int count, int origin)
{
    for (int v = 0; v < count; v++) {
        mpq_set_ui(d[v][3], 0, 1);
        for (int i = 0; i < 3; i++) {
            mpq_t square;
            mpq_init(square);
            mpq_set_d(square, p[origin][i]);
            mpq_set_d(d[v][i], p[v][i]);
            mpq_sub(d[v][i], d[v][i], square);
            mpq_mul(square, d[v][i], d[v][i]);
            mpq_add(d[v][3], d[v][3], square);
            mpq_clear(square);
        }
    }
}

/* sum += sign · factor · det(p, q, r). */
static void add_determinant(mpq_t sum, int sign, const mpq_t factor, mpq_t p[4],
                            mpq_t q[4], mpq_t r[4])
{
    mpq_t product;
    mpq_init(product);
    for (int i = 0; i < 6; i++) {
        const int j = (i + 1 + i / 3) % 3, k = (i + 2 - i / 3) % 3;
        mpq_mul(product, p[i % 3], q[j]);
        mpq_mul(product, product, r[k]);
        mpq_mul(product, product, factor);
        if ((sign > 0) == (i < 3))
            mpq_add(sum, sum, product);
        else
            mpq_sub(sum, sum, product);
    }
    mpq_clear(product);
}

static void change(mpq_t d[POINTS][4], void (*with)(mpq_t))
{
    for (int v = 0; v < POINTS; v++)
        for (int i = 0; i < 4; i++)
            with(d[v][i]);
}

static int rational(const point_set p, int count)
{
    mpq_t d[POINTS][4], sum;
    change(d, mpq_init);
    mpq_init(sum);
    if (count == 4) {
        mpq_t one;
        mpq_init(one);
        mpq_set_ui(one, 1, 1);
        differences(d, p, 4, 0);
        add_determinant(sum, 1, one, d[1], d[2], d[3]);
        mpq_clear(one);
    } else {
        differences(d, p, 4, 4);
        add_determinant(sum, 1, d[0][3], d[1], d[2], d[3]);
        add_determinant(sum, -1, d[1][3], d[2], d[3], d[0]);
        add_determinant(sum, 1, d[2][3], d[3], d[0], d[1]);
        add_determinant(sum, -1, d[3][3], d[0], d[1], d[2]);
    }
    const int sign = mpq_sgn(sum);
    mpq_clear(sum);
    change(d, mpq_clear);
    return sign;
}

static int rational_orient3d(const point_set p)
{
    return rational(p, 4);
}

static int rational_insphere(const point_set p)
{
    return rational(p, 5);
}

static int compare(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Nanoseconds for a call; *signs is a sum over all sets. */
static double measure(predicate *of, const point_set *set, int repeats, long *signs)
{
    double took[RUNS];
    for (int run = 0; run < RUNS; run++) {
        *signs = 0;
        const clock_t begin = clock();
        for (int k = 0; k < repeats; k++)
            for (long n = 0; n < SETS; n++)
                *signs += (n % 7 + 1) * of(set[n]);
        took[run] = 1e9 * (double)(clock() - begin) / CLOCKS_PER_SEC / SETS / repeats;
        *signs /= repeats;
    }
    qsort(took, RUNS, sizeof *took, compare);
    return took[RUNS / 2];
}

static void print(const char *name, predicate *ours, predicate *peer,
                  const point_set *set)
{
    long signs, expected;
    const double us = measure(ours, set, 50, &signs);
    const double gmp = measure(peer, set, 2, &expected);
    printf("%s %8.0f ns  GMP's rationals %8.0f ns  %6.1f times as fast%s\n", name, us,
           gmp, gmp / us, signs == expected ? "" : "  OTHER SIGNS");
}

int main(int argc, char **argv)
{
    const double spacing = argc > 1 ? strtod(argv[1], NULL) : 0.1;
    static point_set set[SETS];
    srand(1);
    for (int n = 0; n < SETS; n++)
        for (int v = 0; v < POINTS; v++) {
            const int x = rand() % LATTICE, y = rand() % LATTICE;
            set[n][v][0] = x * spacing;
            set[n][v][1] = y * spacing;
            set[n][v][2] = (x + y) * spacing; /* on a plane, but for rounding */
        }
    print("orient3d", orient3d, rational_orient3d, (const point_set *)set);
    print("insphere", insphere, rational_insphere, (const point_set *)set);
    return EXIT_SUCCESS;
}
