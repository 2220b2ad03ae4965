/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "power.h"

#include "powers.h" /* made by generate/powers.c: defines tm_powers */

_Static_assert((int)POWER_MIN == (int)TM_POWER_MIN,
               "power.h says which powers there are");
_Static_assert((int)POWER_MAX == (int)TM_POWER_MAX,
               "power.h says which powers there are");
