/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The version of termesh: what --version prints, the shared library and termesh.pc have.
 * Programs that are linked with the shared library work with every one of the same major
 * version. */
#ifndef TM_BASE_VERSION_H
#define TM_BASE_VERSION_H

#define TM_VERSION_MAJOR 1
#define TM_VERSION_MINOR 0
#define TM_VERSION_PATCH 0
#define TM_VERSION       "1.0.0"

/* To compare with: 10000 × major + 100 × minor + patch. */
#define TM_VERSION_NUMBER                                                                \
    (10000 * TM_VERSION_MAJOR + 100 * TM_VERSION_MINOR + TM_VERSION_PATCH)

#endif
