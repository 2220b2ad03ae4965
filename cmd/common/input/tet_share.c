/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tet_share.h"

#include "../../../lib/ranks/ranks.h"
#include "tet_input.h"

#include <stdlib.h>
#include <string.h>

/* Whether a block may need other numbers when nodes have: other elements. */
static bool has_other_elements(const tm_stream *stream)
{
    for (size_t b = 0; b < stream->blocks; b++) {
        const tm_block *block = &stream->block[b];
        if (block->name[0] == '.' && block->kind >= TM_MIX && block->kind < TM_GROUP &&
            block->kind != TM_ROOT)
            return true;
    }
    return false;
}

bool tet_share_from_slices(const filter *f, const tm_slices *slices, size_t size,
                           tm_tet_share *share, tm_share_notes *notes)
{
    tm_error error;
    bool can = false;
    if (has_other_elements(&slices->stream))
        return false;
    filter_stage(f, "finding neighbours");
    filter_agree(f, tm_tet_share_take(share, slices, size, notes, &can, &error), &error);
    return can;
}

void tet_share_note(const filter *f, const tm_share_notes *notes)
{
    const tm_tet_mesh mesh = {.turned = notes->turned,
                              .flat = notes->flat,
                              .dropped_faces = notes->dropped_faces,
                              .locked.count = notes->locked};
    tet_mesh_note(f, &mesh);
}

void tet_share_drop_unknown(const filter *f, tm_slices *slices, const char *why)
{
    tm_stream *stream = &slices->stream;
    for (size_t b = stream->blocks; b-- > 0;)
        if (stream->block[b].kind == TM_UNKNOWN && stream->block[b].name[0] == '.')
            memmove(&slices->slice[b], &slices->slice[b + 1],
                    (stream->blocks - b - 1) * sizeof *slices->slice);
    drop_unknown_blocks(f, stream, why);
}
