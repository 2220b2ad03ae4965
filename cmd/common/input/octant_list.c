/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "octant_list.h"

#include "../../../lib/format/oct.h"
#include "../../../lib/octree/forest/rule_files.h"

uint32_t *octant_list_read(const filter *f, const char *file, const tm_stream *stream,
                           size_t *count)
{
    tm_error error;
    tm_text bytes = {0};
    uint32_t *list;
    const tm_block *octant = tm_stream_find(stream, ".octant");
    filter_read_file(f, file, &bytes);
    if (tm_ref_read(&list, count, bytes.byte, bytes.size, file, &error) != TM_OK)
        filter_fail_file(f, &error, &bytes, "octree-repair --octants");
    tm_text_free(&bytes);
    if (!octant) {
        tm_fail_at(&error, TM_ERROR_INPUT, filter_input_name(f), 0, NULL,
                   "has no octants to split (the block .octant)");
        filter_fail(f, &error);
    }
    if (tm_octants_of_ids(list, count, octant, stream->base, &error) != TM_OK) {
        snprintf(error.file, sizeof error.file, "%s",
                 error.block[0] ? filter_input_name(f) : file);
        filter_fail(f, &error);
    }
    return list;
}
