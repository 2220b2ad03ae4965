/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "parts.h"

#include "../../base/array.h"
#include "../../mesh/ranks/components.h"
#include "../../ranks/post.h"

#include <stdlib.h>
#include <string.h>

/* root[rows.count]: the root of the region of each of this rank's tetrahedra. */
static tm_status find_roots(const tm_sorted_tets *s, const tm_tet_share *share,
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

/* A tetrahedron that a rank gets to take apart: its number and its root. */
enum { NUMBER, ROOT, WORDS };

/* The regions whose roots this rank has. */
typedef struct regions_here {
    uint32_t *item; /* [count][WORDS], numbers ascending */
    size_t count;
    tm_number_set root;
    tm_tet_share share;
} regions_here;

/* Says which tetrahedra are whose, and asks for what is around them. */
static tm_status send_regions(const tm_sorted_tets *s, const uint32_t *root,
                              regions_here *h, tm_post *asking, tm_error *error)
{
    tm_post post = {0};
    unsigned *last = tm_new(s->nodes.set.count, sizeof *last); /* that it was asked for */
    post.failed = !last;
    for (size_t v = 0; last && v < s->nodes.set.count; v++)
        last[v] = tm_ranks_count();
    for (size_t t = 0; last && t < s->rows.count; t++) {
        const uint32_t *record = s->record + t * s->words;
        const unsigned to = tm_rows_owner(&s->rows, root[t]);
        tm_post_put(&post, to, (const uint32_t[]){(uint32_t)(s->rows.first + t), root[t]},
                    WORDS);
        for (size_t i = 0; i < 4; i++) {
            const size_t v = tm_number_set_below(&s->nodes.set, record[i]);
            if (last[v] != to)
                tm_tet_share_ask(asking, s, v, to);
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
static tm_status take_apart(const regions_here *h, const tm_sorted_tets *s,
                            const tm_poly_options *options, tm_poly_report *report,
                            uint32_t *name, tm_error *error)
{
    const tm_tet_mesh *mesh = &h->share.mesh;
    tm_partition partition = {.cell = tm_new(mesh->slots, sizeof *partition.cell)};
    uint32_t *first = tm_new(mesh->slots + 1, sizeof *first), *got = NULL;
    size_t words = 0;
    tm_post post = {0};
    report->regions = h->root.count;
    tm_status status = tm_ranks_enough(partition.cell && first, error);
    for (size_t t = 0; status == TM_OK && t < mesh->slots; t++)
        partition.cell[t] = (uint32_t)h->root.count;
    for (size_t i = 0; status == TM_OK && i < h->count; i++) {
        const uint32_t *item = h->item + i * WORDS;
        partition.cell[tm_number_set_below(&h->share.tet, item[NUMBER])] =
            tm_number_set_below(&h->root, item[ROOT]);
    }
    if (status == TM_OK)
        status = tm_ranks_agree(
            tm_partition_repair(&partition, mesh, options, report, error), error);
    for (size_t c = 0; status == TM_OK && c <= partition.cells; c++)
        first[c] = TM_NONE;
    for (size_t i = 0; status == TM_OK && i < h->count; i++) { /* in ascending order */
        const uint32_t t = h->item[i * WORDS + NUMBER];
        const uint32_t c = partition.cell[tm_number_set_below(&h->share.tet, t)];
        first[c] = t < first[c] ? t : first[c];
        tm_post_put(&post, tm_rows_owner(&s->rows, t), (const uint32_t[]){t, first[c]},
                    2);
    }
    if (status == TM_OK)
        status = tm_post_deliver(&post, &got, &words, error);
    for (size_t i = 0; status == TM_OK && i < words; i += 2)
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

tm_status tm_rank_cells_make(tm_rank_cells *cells, const tm_sorted_tets *sorted,
                             const tm_homes *homes, const tm_tet_slices *slices,
                             const tm_tet_share *share, const tm_poly_options *options,
                             bool ignore_markers, tm_poly_report *report, tm_error *error)
{
    const size_t count = sorted->rows.count;
    uint32_t *root = tm_new(count, sizeof *root), *name = tm_new(count, sizeof *name);
    regions_here here = {0};
    tm_post asking = {0};
    size_t regions = 0;
    bool odd = false;
    cells->cell = tm_new(count, sizeof *cells->cell);
    cells->first = tm_new(count, sizeof *cells->first);
    tm_status status =
        tm_ranks_enough(root && name && cells->cell && cells->first, error);
    if (status == TM_OK)
        status = find_roots(sorted, share, options, root, &regions, error);
    if (status == TM_OK)
        status = send_regions(sorted, root, &here, &asking, error);
    if (status == TM_OK)
        status = list_roots(&here, error);
    if (status == TM_OK)
        status =
            tm_tet_share_make(&here.share, &asking, homes, slices, &odd, options, error);
    if (status == TM_OK && odd)
        status = tm_fail(error, TM_ERROR_INTERNAL, "what was a mesh is none");
    if (status == TM_OK) {
        if (ignore_markers)
            tm_ignore_markers(&here.share.mesh);
        status = take_apart(&here, sorted, options, report, name, error);
    }
    if (status == TM_OK)
        status = number_cells(cells, sorted, name, error);
    if (status == TM_OK)
        add_up(report, sorted->rows.total, regions, cells->cells);
    tm_tet_share_free(&here.share);
    tm_number_set_free(&here.root);
    free(here.item);
    free(root);
    free(name);
    return status;
}
