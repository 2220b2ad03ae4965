/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small mesh, improved in every way: it stays a mesh, with the same volume in each
 * region, the same area under each marker and the same field of attributes, but where the
 * surface may move. */
#include "target.h"

#include "../../../lib/tet/delaunay/delaunay.h"
#include "../../unit/tet_fixture.h"

static tm_status along_paths(tm_tet_mesh *mesh, tm_error *error)
{
    static const double growth = 4;
    tm_lepp_report report;
    tm_lepp_options options = {.max_growth = growth};
    options.algorithm = (tm_lepp_algorithm)random_below(6);
    options.factor = 1 + random_unit();
    options.angle = 10 + 40 * random_unit();
    options.measure = (tm_tet_measure)random_below(2);
    options.stop = (tm_lepp_stop)random_below(3);
    options.passes = random_below(3);
    options.max_star = random_below(8);
    options.path = (tm_lepp_path)random_below(3);
    options.count_invalid_swaps = random_below(2);
    if (options.algorithm == TM_LEPP_SWAP_CENTROID && options.stop == TM_LEPP_CONVERGED)
        options.stop = TM_LEPP_ORIGINAL; /* it has no end of its own */
    if (options.algorithm == TM_LEPP_SELECTIVE)
        options.sweeps = random_below(4);
    else if (options.algorithm < TM_LEPP_SWAP_CENTROID && random_below(2))
        options.sizes.longest = 0.25 + random_unit();
    const tm_status status = tm_lepp_improve(mesh, &options, &report, error);
    require(options.algorithm != TM_LEPP_DELAUNAY ||
                report.not_delaunay_after == tm_tet_mesh_not_delaunay(mesh),
            "it is less Delaunay than is said");
    return status;
}

static tm_status with_all(tm_tet_mesh *mesh, bool *surface_moves, tm_error *error)
{
    tm_improve_report report;
    tm_improve_options options = {.angle = 10 + 40 * random_unit()};
    options.measure = (tm_tet_measure)random_below(2);
    options.max_growth = random_below(5) / 2.0;
    options.ops = 1 + random_below(TM_IMPROVE_ALL_OPS);
    options.passes = 1 + random_below(4);
    options.threads = 1 + random_below(2);
    *surface_moves = random_below(2);
    if (*surface_moves)
        options.surface.tolerance = 0.1 * random_unit();
    return tm_improve(mesh, &options, &report, error);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    tm_error error;
    bool surface_moves = false;
    bytes_start(bytes, size);
    const int n = 1 + (int)random_below(3);
    const bool paths = random_below(2);
    const double by = random_unit();
    make_mesh(&mesh, &stream, n, by, random_below(2));
    const invariants before = measure_invariants(&mesh);
    const tm_status status =
        paths ? along_paths(&mesh, &error) : with_all(&mesh, &surface_moves, &error);
    if (status != TM_OK)
        require(false, error.what);
    assert_valid(&mesh);
    const invariants after = measure_invariants(&mesh);
    if (!surface_moves)
        assert_same_invariants(&before, &after);
    require(tm_tet_mesh_to_stream(&mesh, &stream, &error) == TM_OK, "the mesh is kept");
    check_round_trip(&stream);
    tm_stream_free(&stream);
    return 0;
}
