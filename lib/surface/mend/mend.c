/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "soup.h"

#include "../../base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    tm_soup soup;
    const tm_mend_options *options;
    tm_mend_report *report;
    tm_error *error;
} mender;

static const double relative = 1e-9; /* of the diagonal: lengths that are none */

static double hair(const mender *m)
{
    return relative * m->soup.diagonal;
}

/* Drops what has become too many, and finds the edges of the rest, where they are not
 * known of the triangles as they are. */
static tm_status clean(mender *m, tm_mend_report *report, bool edges_known)
{
    const bool all = m->options->all_doubles;
    tm_mended *doubles = &report->step[TM_MEND_DOUBLE];
    tm_mended *degenerate = &report->step[TM_MEND_DEGENERATE];
    const size_t before = degenerate->count;
    tm_status status = tm_soup_drop_degenerate(&m->soup, degenerate, m->error);
    edges_known = edges_known && degenerate->count == before;
    if (status == TM_OK && !(edges_known && !tm_soup_has_doubles(&m->soup))) {
        status = tm_soup_drop_doubles(&m->soup, all, doubles, m->error);
        if (status == TM_OK)
            status = tm_soup_find_edges(&m->soup, m->error);
    }
    if (status != TM_OK || m->soup.crowded == 0)
        return status;
    status = tm_soup_drop_quads(&m->soup, hair(m), all, doubles, m->error);
    return status == TM_OK ? tm_soup_find_edges(&m->soup, m->error) : status;
}

typedef tm_status mend_step(mender *m, tm_mend_report *report, double size);

/* Where nothing is joined the edges are as before. */
static tm_status weld_all(mender *m, tm_mend_report *report, double size)
{
    tm_mended *welded = &report->step[TM_MEND_WELDED];
    const size_t before = welded->count;
    const tm_status status = tm_soup_weld(&m->soup, size, true, welded, m->error);
    return status == TM_OK && welded->count > before ? clean(m, report, false) : status;
}

static tm_status weld_open(mender *m, tm_mend_report *report, double size)
{
    const tm_status status =
        tm_soup_weld(&m->soup, size, false, &report->step[TM_MEND_WELDED], m->error);
    return status == TM_OK ? clean(m, report, false) : status;
}

static tm_status split(mender *m, tm_mend_report *report, double size)
{
    const tm_status status =
        tm_soup_split(&m->soup, size, &report->step[TM_MEND_SPLIT], m->error);
    return status == TM_OK ? clean(m, report, false) : status;
}

/* Triangles without area go, and those beside their longest edges are divided. */
static tm_status flatten(mender *m, tm_mend_report *report, double size)
{
    tm_mended parts = {0};
    tm_status status =
        tm_soup_drop_flat(&m->soup, size, &report->step[TM_MEND_FLAT], m->error);
    if (status == TM_OK)
        status = tm_soup_find_edges(&m->soup, m->error);
    if (status == TM_OK)
        status = tm_soup_split(&m->soup, 2 * size, &parts, m->error);
    return status == TM_OK ? clean(m, report, false) : status;
}

static tm_status fill(mender *m, tm_mend_report *report, double size)
{
    const tm_status status =
        tm_soup_fill(&m->soup, size, &report->step[TM_MEND_FILLED], m->error);
    return status == TM_OK ? clean(m, report, false) : status;
}

static size_t wrong(const tm_soup *soup)
{
    return soup->open + soup->crowded;
}

/* What a step must do to stay: bodies that touch afterwards have crowded edges. */
typedef enum { FEWER_WRONG, NO_MORE_WRONG, NO_MORE_OPEN } aim;

static bool is_reached(aim what, const tm_soup *before, const tm_soup *after)
{
    if (what == NO_MORE_OPEN)
        return after->open <= before->open;
    return wrong(after) + (what == FEWER_WRONG) <= wrong(before);
}

/* Does a step; goes back where it does not reach its aim. */
static tm_status try(mender *m, mend_step *what, double size, aim to, bool *better)
{
    tm_soup before;
    tm_mend_report report = *m->report;
    *better = false;
    tm_status status = tm_soup_copy(&before, &m->soup, m->error);
    if (status == TM_OK)
        status = what(m, &report, size);
    *better = status == TM_OK && is_reached(to, &before, &m->soup);
    if (*better) {
        *m->report = report;
        tm_soup_free(&before);
        return TM_OK;
    }
    tm_soup_free(&m->soup);
    m->soup = before;
    return status == TM_OK ? tm_soup_find_edges(&m->soup, m->error) : status;
}

/* How many edges are wrong with nodes so close welded. */
static tm_status wrong_at(mender *m, double size, size_t *count)
{
    tm_soup now = m->soup;
    tm_mend_report report = {.weld = size};
    tm_status status = tm_soup_copy(&m->soup, &now, m->error);
    if (status == TM_OK)
        status = tm_soup_find_edges(&m->soup, m->error);
    if (status == TM_OK)
        status = weld_open(m, &report, size);
    *count = wrong(&m->soup);
    tm_soup_free(&m->soup);
    m->soup = now;
    return status;
}

/* The least distance that leaves the fewest wrong edges. */
static tm_status find_distance(mender *m, double least)
{
    const double step = 3.16227766016837933, most = 1e-2;
    size_t fewest = wrong(&m->soup), count;
    tm_status status = TM_OK;
    m->report->weld = least;
    for (double size = least; size <= most * m->soup.diagonal && status == TM_OK;
         size *= step) {
        status = wrong_at(m, size, &count);
        if (status == TM_OK && count < fewest) {
            fewest = count;
            m->report->weld = size;
        }
        if (fewest == 0)
            break;
    }
    return status;
}

/* Open edges are closed. */
static tm_status close_edges(mender *m)
{
    const tm_mend_options *o = m->options;
    bool better = true;
    tm_status status = TM_OK;
    if (o->weld_auto)
        status = find_distance(m, hair(m));
    if (status == TM_OK && o->weld_auto)
        status = try(m, weld_open, m->report->weld, FEWER_WRONG, &better);
    for (better = true; better && status == TM_OK && m->soup.open > 0;)
        status = try(m, split, fmax(m->report->weld, hair(m)), FEWER_WRONG, &better);
    if (status == TM_OK && o->fill > 0 && m->soup.open > 0)
        status = try(m, fill, o->fill, FEWER_WRONG, &better);
    return status;
}

/* Triangles without area: a few rounds, as the pieces of a neighbour may be flat, too. */
static tm_status flatten_all(mender *m)
{
    enum { ROUNDS = 4 };
    bool better = true;
    tm_status status = TM_OK;
    for (int round = 0; round < ROUNDS && better && status == TM_OK; round++) {
        if (!tm_soup_has_flat(&m->soup, hair(m)))
            break;
        status = try(m, flatten, hair(m), NO_MORE_WRONG, &better);
    }
    return status;
}

static tm_status drop_islands(mender *m)
{
    tm_status status = tm_soup_drop_islands(&m->soup, m->options->islands,
                                            &m->report->step[TM_MEND_ISLANDS], m->error);
    return status == TM_OK ? tm_soup_find_edges(&m->soup, m->error) : status;
}

static tm_status mend(mender *m)
{
    tm_mend_report *r = m->report;
    bool better;
    r->open_before = m->soup.open;
    r->weld = m->options->weld >= 0 ? m->options->weld : hair(m);
    tm_status status =
        tm_soup_weld(&m->soup, 0, true, &r->step[TM_MEND_WELDED], m->error);
    if (status == TM_OK)
        status = clean(m, r, r->step[TM_MEND_WELDED].count == 0);
    if (status == TM_OK && r->weld > 0)
        status = try(m, weld_all, r->weld, NO_MORE_OPEN, &better);
    if (status == TM_OK && m->soup.open > 0)
        status = close_edges(m);
    if (status == TM_OK)
        status = flatten_all(m);
    if (status == TM_OK && m->options->islands > 0)
        status = drop_islands(m);
    if (status == TM_OK)
        status = tm_soup_turn(&m->soup, &r->step[TM_MEND_TURNED], &r->manifold, m->error);
    r->open_edges = m->soup.open;
    return status;
}

static bool has_changed(const tm_mend_report *report)
{
    for (int i = 0; i < TM_MEND_STEPS; i++)
        if (report->step[i].count > 0)
            return true;
    return false;
}

/* Drops the nodes that no triangle has. */
static tm_status drop_nodes(tm_stream *stream, tm_error *error)
{
    tm_block *node = tm_stream_find(stream, ".node");
    tm_block *face = tm_stream_find(stream, ".face");
    uint32_t *number = tm_new(node->count, sizeof *number), count = 0;
    if (!number)
        return tm_fail_memory(error);
    memset(number, UINT8_MAX, node->count * sizeof *number);
    for (size_t i = 0; i < 3 * face->count; i++)
        number[face->integer[i]] = 0;
    for (size_t v = 0; v < node->count; v++) {
        if (number[v] == TM_NONE)
            continue;
        number[v] = count;
        memmove(node->real + 3 * count, node->real + 3 * v, 3 * sizeof *node->real);
        if (node->attribute)
            memmove(node->attribute + count * node->attributes,
                    node->attribute + v * node->attributes,
                    node->attributes * sizeof *node->attribute);
        if (node->marker)
            node->marker[count] = node->marker[v];
        count++;
    }
    node->count = count;
    for (size_t i = 0; i < 3 * face->count; i++)
        face->integer[i] = number[face->integer[i]];
    free(number);
    return TM_OK;
}

tm_status tm_mend(tm_stream *stream, const tm_mend_options *options,
                  tm_mend_report *report, tm_error *error)
{
    mender m = {.options = options, .report = report, .error = error};
    *report = (tm_mend_report){0};
    tm_status status = tm_soup_take(&m.soup, stream, error);
    if (status == TM_OK)
        status = mend(&m);
    tm_soup_give(&m.soup, stream);
    if (status == TM_OK && has_changed(report))
        status = drop_nodes(stream, error);
    return status;
}
