/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../mesh/ranks/components.h"
#include "../../ranks/post.h"

#include <stdlib.h>
#include <string.h>

/* root[rows.count]: the root of the region of each of this rank's tetrahedra. */
static tm_status find_roots(const tm_sorted_tets *s, const tm_poly_tets *share,
                            const tm_poly_options *options, uint32_t *root,
                            size_t *regions, tm_error *error)
{
    const size_t slots = share->mesh.slots;
    uint32_t *up = tm_new(slots, sizeof *up), *number = tm_new(slots, sizeof *number);
    tm_status status = tm_ranks_enough(up && number, error);
    if (status == TM_OK) {
        tm_number_set_list(&share->tet, number);
        status =
            tm_ranks_agree(tm_partition_outlets(&share->mesh, options, up, error), error);
    }
    const uint32_t own = tm_number_set_below(&share->tet, (uint32_t)s->rows.first);
    for (size_t t = 0; status == TM_OK && t < s->rows.count; t++)
        root[t] = number[up[own + t]];
    free(up);
    free(number);
    if (status == TM_OK)
        status = tm_ranks_find_roots(&s->rows, root, error);
    *regions = 0;
    for (size_t t = 0; status == TM_OK && t < s->rows.count; t++)
        *regions += root[t] == s->rows.first + t;
    tm_ranks_sum(regions, 1);
    return status;
}

/* Regions -------------------------------------------------------------------------- */

/* A tetrahedron of a region: its number and its root. */
enum { NUMBER, ROOT, WORDS };

/* Regions that this rank takes apart. */
typedef struct regions_here {
    uint32_t *item; /* [count][WORDS], numbers ascending */
    size_t count;
    tm_number_set root;
} regions_here;

static void free_regions(regions_here *h)
{
    tm_number_set_free(&h->root);
    free(h->item);
}

/* spans[rows.count]: that of a root, where its region has tetrahedra of other ranks. */
static tm_status find_spanning(const tm_sorted_tets *s, const uint32_t *root, bool *spans,
                               tm_error *error)
{
    tm_post post = {0};
    uint32_t *got = NULL, last = TM_NONE;
    size_t count = 0;
    for (size_t t = 0; t < s->rows.count; t++)
        if (!tm_rows_have(&s->rows, root[t]) && root[t] != last) {
            last = root[t];
            tm_post_put(&post, tm_rows_owner(&s->rows, last), &last, 1);
        }
    const tm_status status = tm_post_deliver(&post, &got, &count, error);
    memset(spans, 0, s->rows.count * sizeof *spans);
    for (size_t i = 0; i < count; i++)
        spans[got[i] - s->rows.first] = true;
    free(got);
    return status;
}

static bool is_own(const tm_sorted_tets *s, const bool *spans, uint32_t root)
{
    return tm_rows_have(&s->rows, root) && !spans[root - s->rows.first];
}

/* The regions of which this rank has all. */
static tm_status list_own(const tm_sorted_tets *s, const uint32_t *root,
                          const bool *spans, regions_here *h, tm_error *error)
{
    h->item = tm_new(s->rows.count, WORDS * sizeof *h->item);
    for (size_t t = 0; h->item && t < s->rows.count; t++)
        if (is_own(s, spans, root[t])) {
            h->item[h->count * WORDS + NUMBER] = (uint32_t)(s->rows.first + t);
            h->item[h->count++ * WORDS + ROOT] = root[t];
        }
    return tm_ranks_enough(h->item, error);
}

/* Says to who has the roots of the others which tetrahedra these have, and asks for him
 * for what is around them. */
static tm_status send_spanning(const tm_sorted_tets *s, const uint32_t *root,
                               const bool *spans, regions_here *h, tm_post *asking,
                               tm_error *error)
{
    tm_post post = {0};
    unsigned *last = tm_new(s->nodes.set.count, sizeof *last); /* that it was asked for */
    post.failed = !last;
    for (size_t v = 0; last && v < s->nodes.set.count; v++)
        last[v] = tm_ranks_count();
    for (size_t t = 0; last && t < s->rows.count; t++) {
        const uint32_t *record = s->record + t * s->words;
        const unsigned to = tm_rows_owner(&s->rows, root[t]);
        if (is_own(s, spans, root[t]))
            continue;
        tm_post_put(&post, to, (const uint32_t[]){(uint32_t)(s->rows.first + t), root[t]},
                    WORDS);
        for (size_t i = 0; i < 4; i++) {
            const size_t v = tm_number_set_below(&s->nodes.set, record[i]);
            if (last[v] != to)
                tm_poly_tets_ask(asking, s, v, to);
            last[v] = to;
        }
    }
    free(last);
    const tm_status status = tm_post_deliver(&post, &h->item, &h->count, error);
    h->count /= WORDS;
    return status;
}

/* The roots of the regions. */
static tm_status list_roots(regions_here *h, tm_error *error)
{
    uint32_t *list = tm_new(h->count, sizeof *list);
    for (size_t i = 0; list && i < h->count; i++)
        list[i] = h->item[i * WORDS + ROOT];
    const bool enough = list && tm_number_set_of(&h->root, list, h->count, TM_NONE);
    free(list);
    return tm_ranks_enough(enough, error);
}

/* Takes the regions apart; what each tetrahedron is in is named by the first one in it,
 * and told to who has it. */
static tm_status take_apart(const regions_here *h, const tm_poly_tets *share,
                            const tm_sorted_tets *s, const tm_poly_options *options,
                            tm_poly_report *report, uint32_t *name, tm_error *error)
{
    const size_t slots = share->mesh.slots;
    tm_partition partition = {.cell = tm_new(slots, sizeof *partition.cell)};
    uint32_t *first = tm_new(slots + 1, sizeof *first), *got = NULL;
    size_t words = 0;
    tm_post post = {0};
    report->regions = h->root.count;
    const bool enough = partition.cell && first;
    tm_status status = tm_ranks_enough(enough, error);
    for (size_t t = 0; enough && t < slots; t++)
        partition.cell[t] = (uint32_t)h->root.count;
    for (size_t i = 0; enough && i < h->count; i++) {
        const uint32_t *item = h->item + i * WORDS;
        partition.cell[tm_number_set_below(&share->tet, item[NUMBER])] =
            tm_number_set_below(&h->root, item[ROOT]);
    }
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_partition_repair(&partition, &share->mesh, options, report, error), error);
    for (size_t c = 0; status == TM_OK && enough && c <= partition.cells; c++)
        first[c] = TM_NONE;
    for (size_t i = 0; status == TM_OK && enough && i < h->count; i++) {
        const uint32_t t = h->item[i * WORDS + NUMBER];
        const uint32_t c = partition.cell[tm_number_set_below(&share->tet, t)];
        first[c] = t < first[c] ? t : first[c];
        if (tm_rows_have(&s->rows, t))
            name[t - s->rows.first] = first[c];
        else
            tm_post_put(&post, tm_rows_owner(&s->rows, t),
                        (const uint32_t[]){t, first[c]}, 2);
    }
    if (status == TM_OK)
        status = tm_post_deliver(&post, &got, &words, error);
    for (size_t i = 0; i < words; i += 2)
        name[got[i] - s->rows.first] = got[i + 1];
    tm_partition_free(&partition);
    free(first);
    free(got);
    return status;
}

/* Numbers cells by their first tetrahedra. */
static tm_status number_cells(tm_rank_cells *cells, const tm_sorted_tets *s,
                              const uint32_t *name, tm_error *error)
{
    const size_t count = s->rows.count;
    size_t firsts = 0;
    for (size_t t = 0; t < count; t++)
        firsts += cells->first[t] = name[t] == s->rows.first + t;
    uint32_t number = (uint32_t)tm_ranks_before(firsts, &cells->cells), *found = NULL;
    for (size_t t = 0; t < count; t++)
        cells->cell[t] = cells->first[t] ? number++ : TM_NONE;
    tm_number_set set = {0};
    tm_status status =
        tm_ranks_enough(tm_number_set_of(&set, name, count, TM_NONE), error);
    if (status == TM_OK)
        status = tm_ranks_fetch(&s->rows, cells->cell, sizeof *cells->cell, &set,
                                (void **)&found, error);
    for (size_t t = 0; status == TM_OK && t < count; t++)
        cells->cell[t] = found[tm_number_set_below(&set, name[t])];
    tm_number_set_free(&set);
    free(found);
    return status;
}

static void add_up(tm_poly_report *report, size_t tets, size_t regions, size_t cells)
{
    size_t sum[] = {report->taken_apart, report->single, report->not_star};
    tm_ranks_sum(sum, 3);
    *report = (tm_poly_report){.tets = tets,
                               .regions = regions,
                               .cells = cells,
                               .taken_apart = sum[0],
                               .single = sum[1],
                               .not_star = sum[2]};
}

/* Takes apart the regions of which this rank has all. */
static tm_status take_own(const tm_sorted_tets *s, const tm_poly_tets *share,
                          const uint32_t *root, const bool *spans,
                          const tm_poly_options *options, tm_poly_report *report,
                          uint32_t *name, tm_error *error)
{
    regions_here own = {0};
    tm_status status = list_own(s, root, spans, &own, error);
    if (status == TM_OK)
        status = list_roots(&own, error);
    if (status == TM_OK)
        status = take_apart(&own, share, s, options, report, name, error);
    free_regions(&own);
    return status;
}

/* Takes the others apart, each where its root is. */
static tm_status take_spanning(const tm_sorted_tets *s, const tm_homes *homes,
                               const tm_tet_slices *slices, const uint32_t *root,
                               const bool *spans, const tm_poly_options *options,
                               bool ignore_markers, tm_poly_report *report,
                               uint32_t *name, tm_error *error)
{
    regions_here here = {0};
    tm_poly_tets share = {0};
    tm_post asking = {0};
    bool odd = false;
    tm_status status = send_spanning(s, root, spans, &here, &asking, error);
    if (status == TM_OK)
        status = list_roots(&here, error);
    if (status == TM_OK)
        status = tm_poly_tets_make(&share, &asking, homes, slices, &odd, options, error);
    if (status == TM_OK && odd)
        status = tm_fail(error, TM_ERROR_INTERNAL, "what was a mesh is none");
    if (status == TM_OK) {
        if (ignore_markers)
            tm_ignore_markers(&share.mesh);
        status = take_apart(&here, &share, s, options, report, name, error);
    }
    tm_poly_tets_free(&share);
    free_regions(&here);
    return status;
}

tm_status tm_rank_cells_make(tm_rank_cells *cells, const tm_sorted_tets *sorted,
                             const tm_homes *homes, const tm_tet_slices *slices,
                             const tm_poly_tets *share, const tm_poly_options *options,
                             bool ignore_markers, tm_poly_report *report, tm_error *error)
{
    const size_t count = sorted->rows.count;
    uint32_t *root = tm_new(count, sizeof *root), *name = tm_new(count, sizeof *name);
    bool *spans = tm_new(count, sizeof *spans);
    size_t regions = 0;
    cells->cell = tm_new(count, sizeof *cells->cell);
    cells->first = tm_new(count, sizeof *cells->first);
    tm_status status =
        tm_ranks_enough(root && name && spans && cells->cell && cells->first, error);
    if (status == TM_OK)
        status = find_roots(sorted, share, options, root, &regions, error);
    if (status == TM_OK)
        status = find_spanning(sorted, root, spans, error);
    if (status == TM_OK)
        status = take_own(sorted, share, root, spans, options, report, name, error);
    if (status == TM_OK)
        status = take_spanning(sorted, homes, slices, root, spans, options,
                               ignore_markers, report, name, error);
    if (status == TM_OK)
        status = number_cells(cells, sorted, name, error);
    if (status == TM_OK)
        add_up(report, sorted->rows.total, regions, cells->cells);
    free(root);
    free(name);
    free(spans);
    return status;
}
