/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sets of tetrahedra and sizes, as the user names them: --set and --until-size. */
#ifndef CMD_COMMON_TET_SET_H
#define CMD_COMMON_TET_SET_H

#include "../../../lib/stream/stream.h"
#include "../app/filter.h"

typedef enum tet_set_kind { TET_SET_LIST, TET_SET_BOX, TET_SET_ATTRIBUTE } tet_set_kind;

/* One --set: box=x0,y0,z0,x1,y1,z1; region or attribute_2 or 2, then <, <=, =, >= or >,
 * then a number, or region=NAME of .group; a file of numbers. */
typedef struct tet_set_rule {
    tet_set_kind kind;
    const char *text; /* as given */
    double low[3], high[3];
    size_t attribute;       /* from 1 */
    bool less, equal, more; /* what of the value is in the set */
    double value;
    const char *name; /* of the value, by .group; NULL: it is a number */
} tet_set_rule;

/* All of them; what one of them names is in the set. */
typedef struct tet_set {
    tet_set_rule *rule;
    size_t rules;
} tet_set;

/* Takes one more; a usage error where it cannot be understood. */
void tet_set_add(const filter *f, tet_set *set, const char *text);
void tet_set_free(tet_set *set);

/* Of the stream's tetrahedra, those that are in the set: an array to free, or NULL where
 * there are no rules. Exits where the stream has not what a rule asks for. */
bool *tet_set_find(const filter *f, const tet_set *set, const tm_stream *stream);

/* The number of "attribute_2", from 1; 0 where the text is no such name. */
size_t tet_set_attribute(const char *text, size_t length);

/* Exits unless the nodes have the attribute, from 1, and it is greater than 0 at those of
 * the tetrahedra that are in the set; NULL: at all. */
void tet_set_check_sizes(const filter *f, const tm_stream *stream, size_t attribute,
                         const bool *in_set);

#endif
