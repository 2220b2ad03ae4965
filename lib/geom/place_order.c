/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "place_order.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
    const tm_placed *p = a, *q = b;
    for (int x = 0; x < 3; x++)
        if (p->xyz[x] != q->xyz[x])
            return p->xyz[x] < q->xyz[x] ? -1 : 1;
    return (p->item > q->item) - (p->item < q->item);
}

void tm_place_sort(tm_placed *placed, size_t count)
{
    if (count > 0)
        qsort(placed, count, sizeof *placed, compare);
}
