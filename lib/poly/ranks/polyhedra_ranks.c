/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "polyhedra_ranks.h"

#include "../../base/array.h"
#include "../../element/shape.h"
#include "../../ranks/post.h"
#include "parts.h"

#include <stdlib.h>
#include <string.h>

static size_t rows_of_all(const tm_slices *slices, const char *name)
{
    tm_slice slice = {0};
    tm_slices_find(slices, name, &slice);
    return slice.total;
}

static tm_tet_slices blocks_of(const tm_slices *slices)
{
    const tm_stream *stream = &slices->stream;
    tm_tet_slices s = {.node = tm_stream_find(stream, ".node"),
                       .ele = tm_stream_find(stream, ".ele"),
                       .face = tm_stream_find(stream, ".face"),
                       .edge = tm_stream_find(stream, ".edge"),
                       .nodes = tm_rows_of(rows_of_all(slices, ".node")),
                       .tets = tm_rows_of(rows_of_all(slices, ".ele")),
                       .faces = rows_of_all(slices, ".face")};
    s.width = s.ele ? s.ele->attributes : 0;
    return s;
}

/* Rows of .edge that join a node to itself or are there twice: each is looked at by who
 * has its smaller node. */
static tm_status check_edges(const tm_tet_slices *slices, bool *odd, tm_error *error)
{
    tm_post post = {0};
    uint32_t *got = NULL;
    size_t words = 0;
    for (size_t e = 0; slices->edge && e < slices->edge->count; e++) {
        const uint32_t *n = slices->edge->integer + 2 * e;
        const bool back = n[0] > n[1];
        const uint32_t edge[2] = {n[back], n[!back]};
        *odd |= n[0] == n[1];
        tm_post_put(&post, tm_rows_owner(&slices->nodes, edge[0]), edge, 2);
    }
    tm_status status = tm_post_deliver(&post, &got, &words, error);
    tm_edge_map seen = {0};
    if (status == TM_OK)
        status = tm_ranks_enough(tm_edge_map_reserve(&seen, words / 2), error);
    for (size_t i = 0; status == TM_OK && i < words; i += 2) {
        *odd |= tm_edge_map_get(&seen, got[i], got[i + 1]) != NULL;
        tm_edge_map_put(&seen, got[i], got[i + 1], 0);
    }
    tm_edge_map_free(&seen);
    free(got);
    *odd = tm_ranks_any(*odd);
    return status;
}

/* What is at the tetrahedra that this rank has. */
static tm_status take_share(tm_poly_tets *share, const tm_sorted_tets *s,
                            const tm_homes *homes, const tm_tet_slices *slices,
                            const tm_poly_options *options, bool *odd, tm_error *error)
{
    tm_post asking = {0};
    for (size_t v = 0; v < s->nodes.set.count; v++)
        tm_poly_tets_ask(&asking, s, v, tm_rank());
    return tm_poly_tets_make(share, &asking, homes, slices, odd, options, error);
}

/* Whether an edge of this rank's tetrahedra is locked; those of others may seem to be. */
static bool touches_itself(const tm_poly_tets *share, uint32_t own, size_t count)
{
    const tm_tet_mesh *mesh = &share->mesh;
    if (mesh->locked.count == 0)
        return false;
    for (size_t t = own; t < own + count; t++)
        for (int e = 0; e < TM_TET_EDGES; e++)
            if (tm_edge_map_get(&mesh->locked, mesh->tet[t][tm_edge_corner[e][0]],
                                mesh->tet[t][tm_edge_corner[e][1]]))
                return true;
    return false;
}

/* Whether something is odd: each row of .face is to be a face that stays. */
static bool is_odd(const tm_poly_tets *share, const tm_sorted_tets *s, size_t faces)
{
    const tm_tet_mesh *mesh = &share->mesh;
    const uint32_t own = tm_number_set_below(&share->tet, (uint32_t)s->rows.first);
    size_t stay = 0;
    for (size_t f = 0; f < mesh->faces; f++) {
        const uint32_t *side = mesh->face[f].side;
        const uint32_t first = (side[0] < side[1] ? side[0] : side[1]) / 4;
        stay += mesh->face[f].listed && side[0] != TM_NONE && first >= own &&
                first < own + s->rows.count;
    }
    tm_ranks_sum(&stay, 1);
    return tm_ranks_any(mesh->dropped_faces > 0 || stay != faces ||
                        touches_itself(share, own, s->rows.count));
}

/* Puts .facet and .cell in the place of .ele and .face. */
static tm_status put_blocks(tm_slices *slices, tm_block made[2], size_t before,
                            size_t facets, size_t cells, tm_error *error)
{
    static const char *const gone[] = {".ele", ".face"};
    tm_stream *stream = &slices->stream;
    for (size_t k = 0; k < sizeof gone / sizeof *gone; k++) {
        tm_block *block = tm_stream_find(stream, gone[k]);
        if (block)
            tm_slices_remove(slices, block);
    }
    tm_slice *slice = realloc(slices->slice, (stream->blocks + 2) * sizeof *slice);
    tm_status status = tm_ranks_enough(slice, error);
    if (slice)
        slices->slice = slice;
    if (status != TM_OK)
        return status;
    const size_t first = stream->blocks;
    slice[first] = (tm_slice){before, facets};
    slice[first + 1] = (tm_slice){tm_rows_of(cells).first, cells};
    for (int k = 0; k < 2 && status == TM_OK; k++)
        status = tm_ranks_agree(tm_stream_put(stream, &made[k], error), error);
    return status == TM_OK ? tm_slices_even(slices, first, error) : status;
}

/* What is made on the way. */
typedef struct working {
    tm_sorted_tets sorted;
    tm_homes homes;
    tm_poly_tets share;
    tm_rank_cells cells;
} working;

static tm_status find_cells(working *w, const tm_tet_slices *slices,
                            const tm_poly_options *options, bool ignore_markers,
                            tm_polyhedra_report *report, bool *odd, tm_error *error)
{
    tm_poly_options boxed = *options;
    tm_status status = check_edges(slices, odd, error);
    if (status == TM_OK && !*odd)
        status = tm_sorted_tets_make(&w->sorted, slices, odd, error);
    if (status == TM_OK && !*odd)
        status = tm_homes_make(&w->homes, &w->sorted, slices, odd, error);
    if (status == TM_OK && !*odd)
        status =
            take_share(&w->share, &w->sorted, &w->homes, slices, options, odd, error);
    if (status == TM_OK && !*odd)
        *odd = is_odd(&w->share, &w->sorted, slices->faces);
    if (status != TM_OK || *odd)
        return status;
    tm_block_clear(slices->ele); /* nobody will ask for it any more */
    if (ignore_markers)
        tm_ignore_markers(&w->share.mesh);
    report->turned = w->sorted.turned;
    boxed.box = (const double(*)[3])w->sorted.box;
    return tm_rank_cells_make(&w->cells, &w->sorted, &w->homes, slices, &w->share, &boxed,
                              ignore_markers, &report->poly, error);
}

tm_status tm_polyhedra_ranks(tm_slices *slices, const tm_poly_options *options,
                             bool ignore_markers, tm_polyhedra_report *report, bool *odd,
                             tm_error *error)
{
    working w = {0};
    const tm_tet_slices blocks = blocks_of(slices);
    tm_block made[2] = {{.name = ".facet",
                         .kind = TM_FACET,
                         .markers = blocks.face && blocks.face->markers},
                        {.name = ".cell", .kind = TM_CELL}};
    size_t before = 0;
    *report = (tm_polyhedra_report){0};
    *odd = !blocks.node || !blocks.ele;
    tm_status status =
        *odd ? TM_OK
             : find_cells(&w, &blocks, options, ignore_markers, report, odd, error);
    tm_homes_free(&w.homes);
    if (status == TM_OK && !*odd)
        status = tm_rank_facets(&w.cells, &w.sorted, &blocks, &w.share, &made[0],
                                &made[1], &before, &report->facets, &report->lost, error);
    tm_sorted_tets_free(&w.sorted);
    tm_poly_tets_free(&w.share);
    free(w.cells.cell);
    free(w.cells.first);
    if (status == TM_OK && !*odd)
        status =
            put_blocks(slices, made, before, report->facets, report->poly.cells, error);
    for (int k = 0; k < 2; k++)
        tm_block_clear(&made[k]);
    return status;
}
