/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mesh_share.h"

#include "../../../lib/format/tetgen.h"
#include "../../../lib/ranks/ranks.h"
#include "../../../lib/stream/coordinates.h"
#include "mesh_input.h"

#include <stdlib.h>

void mesh_share_read(const filter *f, tm_slices *slices)
{
    tm_error error;
    filter_read_slices(f, slices);
    const tm_status status = tm_slices_check_coordinates(slices, &error);
    if (status == TM_ERROR_INPUT)
        snprintf(error.file, sizeof error.file, "%s", filter_input_name(f));
    filter_agree(f, status, &error);
}

size_t mesh_share_rows(const tm_slices *slices, const char *name)
{
    tm_slice slice = {0};
    tm_slices_find(slices, name, &slice);
    return slice.total;
}

tm_element_slices mesh_share_tets(const tm_slices *slices)
{
    return (tm_element_slices){.own = tm_mesh_view_of_tets(&slices->stream),
                               .nodes = mesh_share_rows(slices, ".node"),
                               .elements = mesh_share_rows(slices, ".ele"),
                               .faces = mesh_share_rows(slices, ".face"),
                               .edges = mesh_share_rows(slices, ".edge")};
}

void mesh_share_take(const filter *f, mesh_share *share, const tm_slices *slices,
                     const char *name)
{
    tm_error error;
    *share = (mesh_share){0};
    tm_block *block = share->block = tm_slices_find(slices, name, &share->slice);
    uint32_t *item = NULL;
    size_t items = 0;
    if (block) {
        item = block->start ? block->item : block->integer;
        items = block->start ? block->start[block->count]
                             : block->count * tm_block_integers(block->kind);
    }
    filter_agree(f,
                 tm_slices_take_nodes(slices, item, items, &share->number, &share->nodes,
                                      &share->xyz, &error),
                 &error);
}

void mesh_share_free(mesh_share *share)
{
    free(share->number);
    free(share->xyz);
    *share = (mesh_share){0};
}

void mesh_share_turn(const filter *f, mesh_share *share, const char *what)
{
    const tm_block node = {
        .kind = TM_NODE, .count = share->nodes, .real = (double *)share->xyz};
    size_t turned = tm_tetgen_orient(&node, share->block).turned;
    tm_ranks_sum(&turned, 1);
    mesh_note_turned(f, turned, share->slice.total, what);
}

void mesh_share_gather(const filter *f, void **items, size_t *count, size_t size)
{
    void *all;
    tm_error error;
    filter_agree(f, tm_ranks_gather(*items, *count, size, &all, count, &error), &error);
    free(*items);
    *items = all;
    if (!all)
        *count = 0;
}

void mesh_share_leave(const filter *f, tm_slices *slices, tm_stream *stream)
{
    tm_error error;
    filter_agree(f, tm_slices_gather(slices, &error), &error);
    *stream = slices->stream;
    tm_stream_init(&slices->stream);
    tm_slices_free(slices);
    const bool goes_on = tm_rank() == 0;
    tm_ranks_leave();
    if (goes_on)
        return;
    tm_stream_free(stream);
    exit(EXIT_SUCCESS);
}
