/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Polyhedra of a small mesh, by every mode and as its dual: what is made fits together,
 * and where it was asked for each is a ball. */
#include "target.h"

#include "../../../lib/poly/dual/dual.h"
#include "../../../lib/poly/facets.h"
#include "../../../lib/poly/partition.h"
#include "../../unit/tet_fixture.h"

static void check_polyhedra_of(const tm_tet_mesh *mesh, const tm_block *facet,
                               const tm_block *cell, bool balls)
{
    static const tm_defect never[] = {TM_INVERTED,       TM_DEGENERATE,
                                      TM_UNCLOSED_EDGE,  TM_UNORIENTED_EDGE,
                                      TM_UNMATCHED_FACE, TM_REPEATED_FACE};
    tm_examination found;
    tm_poly_statistics statistics;
    tm_error error;
    const tm_poly_arrays arrays = {.nodes = mesh->nodes,
                                   .xyz = (const double(*)[3])mesh->xyz,
                                   .facets = facet->count,
                                   .side = (const uint32_t(*)[2])facet->integer,
                                   .facet_start = facet->start,
                                   .facet_node = facet->item,
                                   .cells = cell->count,
                                   .cell_start = cell->start,
                                   .cell_facet = cell->item,
                                   .attributes = cell->attributes,
                                   .attribute = cell->attribute};
    require(tm_poly_examine(&found, &arrays, 1, &error) == TM_OK &&
                tm_poly_statistics_measure(&statistics, &arrays, 1, &error) == TM_OK,
            "polyhedra are not examined");
    for (size_t i = 0; i < sizeof never / sizeof *never && balls; i++)
        require(found.defect[never[i]].count == 0, "polyhedra do not fit together");
    require(!balls || statistics.non_simple == 0, "a polyhedron is no ball");
}

static void cut(const tm_tet_mesh *mesh)
{
    tm_poly_options options = {.threads = 1};
    options.mode = (tm_poly_mode)random_below(TM_POLY_MODES);
    options.face_metric = (tm_face_metric)random_below(2);
    options.cells = 1 + random_below(8);
    options.repair = random_below(4) > 0;
    options.star = (tm_poly_star)random_below(4);
    options.radius = random_below(2) ? 0.03 : 0.1;
    options.absorb = random_below(2);
    options.no_swallow = random_below(2);
    options.max_tets = random_below(20);
    const tm_coplanar plane = {.degrees = random_below(2) ? 20 * random_unit() : 0,
                               .flatness = 1e-9};
    tm_partition partition;
    tm_poly_report report;
    tm_block facet = {.name = ".facet", .kind = TM_FACET, .markers = true};
    tm_block cell = {.name = ".cell", .kind = TM_CELL, .attributes = 1 + mesh->regions};
    size_t lost, joined;
    tm_error error;
    tm_status status = tm_partition_make(&partition, mesh, &options, &report, &error);
    if (status == TM_OK)
        status = tm_partition_facets(&partition, mesh, &facet, &cell, &lost, 1, &error);
    if (status != TM_OK)
        require(false, error.what);
    check_polyhedra_of(mesh, &facet, &cell, options.repair);
    status = tm_merge_coplanar(mesh, &plane, &facet, &cell, &joined, &error);
    if (status != TM_OK)
        require(false, error.what);
    check_polyhedra_of(mesh, &facet, &cell, false);
    tm_block_clear(&facet);
    tm_block_clear(&cell);
    tm_partition_free(&partition);
}

static void make_dual(const tm_tet_mesh *mesh)
{
    tm_dual_options options = {.feature_angle = random_below(2) ? 60 * random_unit() : 0};
    options.convex = random_below(2);
    tm_dual_blocks made;
    tm_dual_report report;
    tm_error error;
    if (tm_dual_make(&made, mesh, &options, &report, &error) != TM_OK)
        require(false, error.what);
    const tm_tet_mesh nodes = {.nodes = made.node.count,
                               .xyz = (double(*)[3])made.node.real};
    check_polyhedra_of(&nodes, &made.facet, &made.cell, true);
    tm_dual_blocks_free(&made);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_stream stream;
    tm_tet_mesh mesh;
    bytes_start(bytes, size);
    const int n = 1 + (int)random_below(3);
    const bool dual = random_below(2);
    const double by = random_unit();
    make_mesh(&mesh, &stream, n, by, random_below(2));
    if (dual)
        make_dual(&mesh);
    else
        cut(&mesh);
    tm_tet_mesh_free(&mesh);
    tm_stream_free(&stream);
    return 0;
}
