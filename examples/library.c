/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The library in C: reads tetrahedra, improves them, says how good they are, writes them.
 *
 *   cc -o library library.c $(pkg-config --cflags --libs termesh)
 *   tetgen-mesh -q knot.off | ./library >better.tm */
#include <termesh/termesh.h>

#include <stdio.h>
#include <unistd.h>

/* What tet-stats prints first, of a mesh whose removed tetrahedra are gone. */
static tm_status print_quality(const char *when, const tm_stream *stream, tm_error *error)
{
    const tm_block *node = tm_stream_find(stream, ".node");
    const tm_block *ele = tm_stream_find(stream, ".ele");
    if (!node || !ele)
        return tm_fail(error, TM_ERROR_INPUT, "there are no tetrahedra");
    const double limit = 30;
    tm_tet_statistics s;
    tm_status status = tm_tet_statistics_measure(
        &s, (const double(*)[3])node->real, node->count,
        (const uint32_t(*)[4])ele->integer, ele->count, limit, 1, error);
    if (status == TM_OK)
        fprintf(stderr, "%s: %zu tetrahedra, %.2f%% bad, angles %.1f to %.1f degrees\n",
                when, s.tets, tm_percent(s.bad, s.tets), s.min_dihedral, s.max_dihedral);
    return status;
}

static tm_status improve(tm_stream *stream, tm_error *error)
{
    tm_tet_mesh mesh;
    tm_improve_report report;
    const tm_improve_options options = {.angle = 30, .ops = TM_IMPROVE_ALL_OPS};
    tm_status status = tm_tet_mesh_from_stream(&mesh, stream, 1, error);
    if (status == TM_OK)
        status = tm_improve(&mesh, &options, &report, error);
    if (status == TM_OK)
        status = tm_tet_mesh_to_stream(&mesh, stream, error);
    tm_tet_mesh_free(&mesh);
    return status;
}

int main(void)
{
    tm_stream stream;
    tm_error error;
    tm_stream_init(&stream);
    tm_status status = tm_stream_read(&stream, STDIN_FILENO, "<stdin>", 1, &error);
    if (status == TM_OK)
        status = print_quality("before", &stream, &error);
    if (status == TM_OK)
        status = improve(&stream, &error);
    if (status == TM_OK)
        status = print_quality("after", &stream, &error);
    if (status == TM_OK)
        status = tm_stream_write(&stream, STDOUT_FILENO, 1, &error);
    if (status != TM_OK)
        fprintf(stderr, "library: line %zu: %s\n", error.line, error.what);
    tm_stream_free(&stream);
    return (int)status;
}
