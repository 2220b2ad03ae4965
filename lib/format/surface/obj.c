/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "surface_format.h"

#include "../../base/array.h"
#include "../../number/number.h"
#include "../../stream/group_markers.h"
#include "../scan.h"

#include <stdlib.h>
#include <string.h>

enum { POLYGON_MIN = 3 };

/* What can name the group of a face, in the order in which the names are joined. */
enum { OBJECT, GROUP, MATERIAL, NAMINGS };
static const char *const naming_word[NAMINGS] = {"o", "g", "usemtl"};

/* The group of a face: for each naming the number of its name, 0 where there is none. */
typedef struct {
    uint32_t name[NAMINGS];
} face_group;

typedef struct {
    tm_block list[NAMINGS]; /* the names, numbered from 1 by their markers */
    tm_group_markers number[NAMINGS];
    face_group now;
    face_group *of; /* [faces] */
    size_t room;
} namings;

/* True where the statement has another word, behind line continuations if need be. */
static bool more(tm_scan *scan)
{
    while (tm_scan_more(scan)) {
        tm_scan ahead = *scan;
        if (!tm_word_is(tm_scan_word(&ahead), "\\"))
            return true;
        tm_scan_end_line(scan);
    }
    return false;
}

/* The next word; a continuation that touches it is left for more(). */
static tm_word next(tm_scan *scan)
{
    tm_word word = {scan->at, 0};
    if (!more(scan))
        return word;
    word = tm_scan_word(scan);
    if (word.begin[word.size - 1] == '\\') {
        word.size--;
        scan->at--;
    }
    return word;
}

static void end_statement(tm_scan *scan)
{
    while (next(scan).size > 0)
        continue;
    tm_scan_end_line(scan);
}

static tm_status read_vertex(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    double xyz[3];
    for (int i = 0; i < 3; i++) {
        if (!more(scan))
            return tm_scan_fail(
                scan, error, "the vertex has %d coordinates (three would be right)", i);
        tm_word word = next(scan);
        tm_scan one;
        tm_scan_begin(&one, word.begin, word.size, scan->name, '\0');
        one.line = scan->line;
        tm_status status = tm_scan_double(&one, "a coordinate", &xyz[i], error);
        if (status != TM_OK)
            return status;
    }
    return tm_polygon_surface_add_node(surface, xyz, error);
}

/* The digits up to the first '/'. */
static tm_status read_corner(tm_scan *scan, tm_polygon_surface *surface, tm_error *error)
{
    tm_word word = next(scan);
    const char *end = word.begin + word.size;
    int64_t number = 0, nodes = (int64_t)surface->nodes;
    const char *after = tm_read_int64(word.begin, end, &number);
    if (!after || (after < end && *after != '/'))
        return tm_scan_fail(scan, error, "'%.*s' is not the number of a vertex",
                            tm_word_shown(word), word.begin);
    int64_t node = number < 0 ? nodes + number : number - 1;
    if (number < -nodes || number > nodes || number == 0)
        return tm_scan_fail(scan, error, "vertex %lld is out of range (1..%lld so far)",
                            (long long)number, (long long)nodes);
    return tm_polygon_surface_add_corner(surface, (uint32_t)node, error);
}

static tm_status keep_group(namings *n, size_t face, tm_error *error)
{
    face_group *grown = tm_grow(n->of, &n->room, face + 1, sizeof *grown);
    if (!grown)
        return tm_fail_memory(error);
    n->of = grown;
    grown[face] = n->now;
    return TM_OK;
}

static tm_status read_face(tm_scan *scan, tm_polygon_surface *surface, namings *n,
                           tm_error *error)
{
    int corners = 0;
    tm_status status = TM_OK;
    while (status == TM_OK && more(scan)) {
        status = read_corner(scan, surface, error);
        if (corners < POLYGON_MIN)
            corners++;
    }
    if (status == TM_OK && corners < POLYGON_MIN)
        status =
            tm_scan_fail(scan, error, "the face has %d corners (three or more)", corners);
    if (status == TM_OK)
        status = keep_group(n, surface->facets, error);
    if (status == TM_OK)
        status = tm_polygon_surface_end_face(surface, error);
    return status;
}

/* The rest of the line, which may go on in the next one, with any #. */
static void take_name(tm_scan *scan, tm_text *name)
{
    for (;;) {
        const tm_word rest = tm_scan_rest(scan);
        const bool goes_on =
            rest.size > 0 && rest.begin[rest.size - 1] == '\\' && scan->at < scan->end;
        tm_text_append(name, rest.begin, rest.size - goes_on);
        if (!goes_on)
            return;
        tm_scan_end_line(scan);
    }
}

/* o NAME, g NAME … or usemtl NAME: of the faces that follow. */
static tm_status read_name(tm_scan *scan, namings *n, int which, tm_error *error)
{
    tm_text name = {0}, clean = {0};
    int32_t number = 0;
    tm_status status = TM_OK;
    take_name(scan, &name);
    if (name.byte)
        tm_group_clean(&clean, name.byte, name.size);
    if (name.failed || clean.failed)
        status = tm_fail_memory(error);
    else if (clean.size > 0)
        status =
            tm_group_marker(&n->number[which], clean.byte, clean.size, &number, error);
    n->now.name[which] = (uint32_t)number;
    tm_text_free(&name);
    tm_text_free(&clean);
    return status;
}

/* Which namings tell faces apart; where none does, one that names them all. */
static void choose(const namings *n, size_t faces, bool used[NAMINGS])
{
    static const int first[NAMINGS] = {GROUP, OBJECT, MATERIAL};
    bool any = false;
    for (int k = 0; k < NAMINGS; k++) {
        used[k] = false;
        for (size_t f = 1; f < faces; f++)
            used[k] |= n->of[f].name[k] != n->of[0].name[k];
        any |= used[k];
    }
    for (int k = 0; k < NAMINGS && faces > 0 && !any; k++)
        any = used[first[k]] = n->of[0].name[first[k]] > 0;
}

static void join_names(const namings *n, const face_group *group,
                       const bool used[NAMINGS], tm_text *name)
{
    for (int k = 0; k < NAMINGS; k++)
        if (used[k] && group->name[k] > 0) {
            tm_text_string(name, name->size > 0 ? "/" : "");
            tm_text_string(name, tm_group_name(&n->list[k], group->name[k] - 1));
        }
}

/* Faces of one group follow each other mostly. All without a name are one group. */
static tm_status mark_faces(const namings *n, tm_polygon_surface *surface,
                            tm_error *error)
{
    bool used[NAMINGS];
    tm_group_markers markers = {.group = &surface->group, .dimension = TM_GROUP_FACES};
    tm_text name = {0};
    int32_t marker = 0, nameless = 0;
    tm_status status = TM_OK;
    choose(n, surface->facets, used);
    if (!used[OBJECT] && !used[GROUP] && !used[MATERIAL])
        return TM_OK;
    surface->has_facet_markers = true;
    for (size_t f = 0; f < surface->facets && status == TM_OK; f++) {
        if (f == 0 || memcmp(&n->of[f], &n->of[f - 1], sizeof *n->of) != 0) {
            name.size = 0;
            join_names(n, &n->of[f], used, &name);
            if (name.failed)
                status = tm_fail_memory(error);
            else if (name.size > 0 || nameless == 0)
                status = tm_group_marker(&markers, name.byte, name.size, &marker, error);
            else
                marker = nameless;
            nameless = name.size == 0 ? marker : nameless;
        }
        surface->facet_marker[f] = marker;
    }
    tm_text_free(&name);
    tm_group_markers_free(&markers);
    return status;
}

static void init_namings(namings *n)
{
    *n = (namings){.of = NULL};
    for (int k = 0; k < NAMINGS; k++) {
        tm_group_init(&n->list[k], naming_word[k]);
        n->number[k].group = &n->list[k];
    }
}

static void free_namings(namings *n)
{
    for (int k = 0; k < NAMINGS; k++) {
        tm_group_markers_free(&n->number[k]);
        tm_group_free(&n->list[k]);
    }
    free(n->of);
}

static int naming_of(tm_word word)
{
    int k = 0;
    while (k < NAMINGS && !tm_word_is(word, naming_word[k]))
        k++;
    return k;
}

tm_status tm_obj_read(tm_polygon_surface *surface, const char *bytes, size_t size,
                      const char *name, tm_error *error)
{
    tm_scan scan;
    namings n;
    init_namings(&n);
    tm_scan_begin(&scan, bytes, size, name, '#');
    tm_status status = TM_OK;
    while (status == TM_OK && tm_scan_seek(&scan)) {
        tm_word word = tm_scan_word(&scan);
        if (tm_word_is(word, "v"))
            status = read_vertex(&scan, surface, error);
        else if (tm_word_is(word, "f"))
            status = read_face(&scan, surface, &n, error);
        else if (naming_of(word) < NAMINGS)
            status = read_name(&scan, &n, naming_of(word), error);
        end_statement(&scan);
    }
    if (status == TM_OK)
        status = mark_faces(&n, surface, error);
    free_namings(&n);
    if (status != TM_OK)
        tm_polygon_surface_free(surface);
    return status;
}
