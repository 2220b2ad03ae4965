/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Growing flat arrays. */
#ifndef TM_BASE_ARRAY_H
#define TM_BASE_ARRAY_H

#include <stddef.h>

/* Makes room for `needed` items of `size` bytes in `array`, which has room for
 * *capacity. Returns the array, moved if it had to grow (by half at least, so that
 * appending costs O(1) on average), with *capacity as it is then; NULL where memory is
 * out or the size overflows: array and *capacity are then as before.
 * The new room is not initialised. */
void *tm_grow(void *array, size_t *capacity, size_t needed, size_t size);

/* malloc(count * size) with the product checked; never NULL for count 0. */
void *tm_new(size_t count, size_t size);

#endif
