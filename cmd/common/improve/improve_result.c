/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "improve_result.h"

#include <stdio.h>
#include <string.h>

/* Text at the end of a string that is `size` bytes long. */
static void add(char *text, size_t size, const char *format, size_t count)
{
    size_t length = strlen(text);
    snprintf(text + length, size - length, format, count);
}

static void add_effects(const tm_improve_report *r, char *text, size_t size)
{
    static const char *const words[TM_IMPROVE_EFFECTS] = {"%zu edges and ",
                                                          "%zu faces removed, ",
                                                          "%zu times a node moved, ",
                                                          "%zu points inserted, ",
                                                          "%zu nodes removed",
                                                          ", %zu cavities filled anew",
                                                          ", %zu tetrahedra peeled off"};
    for (int k = 0; k < TM_IMPROVE_EFFECTS; k++)
        if (k <= TM_EFFECT_NODES_REMOVED ||
            tm_improve_effects(r, (tm_improve_effect)k) > 0)
            add(text, size, words[k], tm_improve_effects(r, (tm_improve_effect)k));
}

/* What no operation could help against. */
static void add_forced(const tm_forced *forced, char *text, size_t size)
{
    if (forced->bad == 0)
        return;
    add(text, size, "; %zu bad left, ", forced->bad);
    add(text, size, "%zu forced by the surface", forced->tets);
}

static void add_star_operations(const improve_settings *o, const tm_lepp_report *r,
                                char *text, size_t size)
{
    add(text, size, "%zu edges removed, ", r->swaps);
    add(text, size, "%zu points inserted", tm_lepp_operations(r) - r->swaps);
    if (o->lepp.sweeps & TM_SWEEP_SMOOTH)
        add(text, size, ", %zu times a node moved", tm_lepp_swept(&r->smooth));
    if (o->lepp.sweeps & TM_SWEEP_SWAP)
        add(text, size, ", %zu faces swapped", tm_lepp_swept(&r->swap));
}

/* One line about the run. */
void improve_result_summarise(const improve_settings *o, const improve_result *r,
                              size_t tets, char *text, size_t size)
{
    bool is_improve = o->is_improve;
    size_t tets_before = is_improve ? r->improve.tets_before : r->lepp.tets_before;
    size_t bad_before = is_improve ? r->improve.bad_before : r->lepp.bad_before;
    size_t bad_after = is_improve ? r->improve.bad_after : r->lepp.bad_after;
    double before = tm_percent(bad_before, tets_before);
    if (r->changes == 0)
        snprintf(text, size, "%s: %zu tetrahedra, %.2f%% bad",
                 improve_has_sizes(o) ? "nothing to refine"
                 : bad_before > 0     ? "nothing found that helps"
                                      : "nothing to improve",
                 tets, before);
    else
        snprintf(text, size, "%zu -> %zu tetrahedra, %.2f%% -> %.2f%% bad; ", tets_before,
                 tets, before, tm_percent(bad_after, tets));
    if (r->changes > 0 && is_improve)
        add_effects(&r->improve, text, size);
    else if (r->changes > 0)
        add_star_operations(o, &r->lepp, text, size);
    if (is_improve)
        add_forced(&r->forced, text, size);
    if (r->changes > 0 && o->set.rules > 0) {
        add(text, size, "; set: %zu", r->set_before);
        add(text, size, " -> %zu tetrahedra", r->set_after);
    }
}

/* What -a delaunay promises, and where it cannot. */
static void note_delaunay(const filter *f, const tm_lepp_report *r)
{
    if (r->not_delaunay_before > 0)
        filter_note(f,
                    "the mesh is not Delaunay: a node is inside of a sphere at %zu faces",
                    r->not_delaunay_before);
    if (r->delaunay.stopped > 0)
        filter_note(f,
                    "%zu faces that stay kept a point from tetrahedra beyond, whose "
                    "spheres hold it",
                    r->delaunay.stopped);
    if (r->delaunay.refused > 0)
        filter_note(f,
                    "%zu terminal edges are left: their midpoints do not see all "
                    "tetrahedra whose spheres hold them",
                    r->delaunay.refused);
    if (r->delaunay.cut_back > 0)
        filter_note(
            f,
            "%zu points do not see, or may not take, all tetrahedra whose spheres "
            "hold them",
            r->delaunay.cut_back);
    if (r->not_delaunay_after > 0)
        filter_note(
            f, "the result is not Delaunay: a node is inside of a sphere at %zu faces",
            r->not_delaunay_after);
    if (r->abandoned > 0)
        filter_note(f, "%zu bad tetrahedra are left: their paths did not end",
                    r->abandoned);
}

/* Where --until-size could not be reached. */
static void note_larger(const filter *f, const improve_settings *o,
                        const improve_result *r)
{
    const bool is_full = r->lepp.no_room > 0;
    if (r->lepp.larger_after > 0)
        filter_note(f, "%zu tetrahedra%s are still larger than --until-size says%s",
                    r->lepp.larger_after, o->set.rules > 0 ? " of the set" : "",
                    is_full ? ": --max-growth is reached" : "");
}

void improve_result_note(const filter *f, const improve_settings *o,
                         const improve_result *r)
{
    if (!o->is_improve && o->lepp.algorithm == TM_LEPP_DELAUNAY)
        note_delaunay(f, &r->lepp);
    note_larger(f, o, r);
    if (o->is_improve && r->improve.too_large)
        filter_note(f, "the mesh could not be made as small as --max-growth says");
}

void improve_result_json(filter *f, const improve_settings *o, const improve_result *r)
{
    tm_json *json = filter_json_begin(f);
    tm_tet_statistics_object(json, "before", &r->before);
    tm_tet_statistics_object(json, "after", &r->after);
    tm_json_double(json, "seconds", r->seconds);
    if (o->is_improve) {
        tm_improve_report_json(json, &r->improve);
        tm_forced_json(json, &r->forced);
    } else {
        tm_lepp_report_json(json, &o->lepp, &r->lepp);
    }
    if (o->set.rules > 0) {
        tm_json_open(json, "set", '{');
        tm_json_integer(json, "before", (int64_t)r->set_before);
        tm_json_integer(json, "after", (int64_t)r->set_after);
        tm_json_close(json, '}');
    }
    filter_json_end(f);
}
