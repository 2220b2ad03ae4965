/* SPDX-License-Identifier: GPL-3.0-or-later */
/* improve_small TETS IN OUT [nodes]: what lepp-improve makes of large meshes, of a small
 * one that is cut into parts of about so many tetrahedra: without a launcher by one
 * process, else by all ranks, which share it. OUT is there. Says what was found and done,
 * in a line, and as the report of lepp-improve has it; of nodes that may move only where
 * asked. Used by tests/cli/lepp-ranks.bats. */
#include "../../lib/tet/improve/improve_ranks.h"
#include "../../lib/tet/share/take.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>

static const double angle = 35;

static void stop_at(tm_status status, const tm_error *error)
{
    if (status == TM_OK)
        return;
    fprintf(stderr, "rank %u: %s\n", tm_rank(), error->what);
    tm_ranks_end((int)status);
}

static void say(const tm_share_notes *n, const tm_improve_report *r, size_t tets,
                const tm_forced *forced)
{
    if (tm_rank() > 0)
        return;
    printf("%zu turned, %zu flat, %zu dropped, %zu locked: %zu -> %zu, bad %zu -> %zu, ",
           n->turned, n->flat, n->dropped_faces, n->locked, r->tets_before, tets,
           r->bad_before, r->bad_after);
    printf("%zu passes, %zu kicks, %zu operations, %zu forced\n", r->passes, r->kicks,
           tm_improve_operations(r), forced->tets);
    tm_text text = {0};
    tm_json json = {&text, 0};
    tm_json_open(&json, NULL, '{');
    tm_improve_report_json(&json, r);
    tm_forced_json(&json, forced);
    tm_json_close(&json, '}');
    puts(text.byte ? text.byte : "");
    tm_text_free(&text);
}

static void improve_alone(int in, int out, const tm_improve_options *options, size_t size,
                          bool nodes)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_improve_report report;
    tm_forced forced;
    tm_error error;
    tm_stream_init(&stream);
    stop_at(tm_stream_read(&stream, in, "", 1, &error), &error);
    stop_at(tm_tet_mesh_from_stream(&mesh, &stream, 1, &error), &error);
    const tm_share_notes notes = {mesh.turned, mesh.flat, mesh.dropped_faces,
                                  mesh.locked.count};
    stop_at(tm_improve_parts(&mesh, options, size, tm_improve, &report, &error), &error);
    for (int d = 0; d < 4 && !nodes; d++)
        report.nodes_free[d] = 0;
    stop_at(tm_forced_find(&forced, &mesh, angle, &error), &error);
    say(&notes, &report, mesh.tets, &forced);
    stop_at(tm_tet_mesh_to_stream(&mesh, &stream, &error), &error);
    stop_at(tm_stream_write(&stream, out, 1, &error), &error);
    tm_forced_free(&forced);
    tm_stream_free(&stream);
}

static void improve_together(int in, int out, const tm_improve_options *options,
                             size_t size, bool nodes)
{
    tm_slices slices = {0};
    tm_tet_share share;
    tm_share_notes notes;
    tm_improve_report report;
    tm_forced forced;
    tm_error error;
    bool can, alone;
    size_t inner_faces;
    const tm_improve_cut cut = {size, tm_improve};
    stop_at(tm_ranks_start(&error), &error);
    tm_stream_init(&slices.stream);
    stop_at(tm_slices_read(&slices, in, "", 1, &error), &error);
    stop_at(tm_tet_share_take(&share, &slices, size, &notes, &can, &error), &error);
    if (!can) {
        if (tm_rank() == 0)
            printf("one process has more to say\n");
        tm_slices_free(&slices);
        return;
    }
    stop_at(tm_improve_ranks(&share, options, &cut, nodes, &report, &alone, &inner_faces,
                             &error),
            &error);
    stop_at(tm_improve_ranks_forced(&share, angle, &forced, &error), &error);
    say(&notes, &report, share.all_tets, &forced);
    stop_at(tm_tet_share_give(&share, inner_faces, &slices, &error), &error);
    stop_at(tm_slices_write(&slices, out, 1, &error), &error);
    tm_forced_free(&forced);
    tm_slices_free(&slices);
}

int main(int argc, char **argv)
{
    const tm_improve_options options = {.angle = angle,
                                        .measure = TM_MEASURE_DIHEDRAL,
                                        .ops = TM_IMPROVE_ALL_OPS,
                                        .threads = 1};
    if (argc < 4)
        return 2;
    const size_t size = strtoul(argv[1], NULL, 10);
    const int in = open(argv[2], O_RDONLY), out = open(argv[3], O_WRONLY | O_TRUNC);
    if (in < 0 || out < 0)
        return 2;
    if (tm_launched())
        improve_together(in, out, &options, size, argc > 4);
    else
        improve_alone(in, out, &options, size, argc > 4);
    return 0;
}
