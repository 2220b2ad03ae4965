/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small solid, an octree over it and the mesh of that: leaves fill the brick, balanced;
 * elements fit together, and none is inverted. */
#include "target.h"

#include "../../../lib/octree/forest/mpi_start.h"
#include "../../../lib/octree/layer/adaptive_refinement.h"
#include "../../unit/octree_fixture.h"

/* Coarse: thousands of cases are worth more than large ones. */
static void make_octree(tm_octree *octree, const tm_surface *surface)
{
    tm_error error;
    tm_octree_rule rule[2] = {{.kind = TM_RULE_SURFACE}, {.kind = TM_RULE_BOX}};
    rule[0].level = random_below(8) > 6;
    rule[1].level = random_below(2);
    for (int i = 0; i < 3; i++) {
        const double a = random_between(surface->low[i], surface->high[i]);
        rule[1].low[i] = a;
        rule[1].high[i] = a + (surface->high[i] - a) * random_unit() / 4;
    }
    assert_ok(tm_octree_build(octree, surface, rule, 2, &error), &error);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    tm_surface surface;
    tm_octree octree;
    tm_octree_mesh mesh;
    tm_error error;
    bytes_start(bytes, size);
    require(tm_mpi_start(&error) == TM_OK, "MPI does not start");
    make_random_surface(&surface);
    assert_ok(tm_surface_check(&surface, &error), &error);
    make_octree(&octree, &surface);
    assert_ok(tm_octree_check(&octree, &surface, &error), &error);
    const unsigned levels = random_below(2);
    const bool lay_out = random_below(2);
    const tm_status status =
        tm_octree_mesh_refine_lost(&mesh, &octree, &surface, tm_octree_deepest(&octree),
                                   levels, lay_out, NULL, &error);
    require(status == TM_OK || (status == TM_ERROR_INPUT && error.what[0]),
            "no mesh, but no reason");
    if (status == TM_OK) {
        const tm_mixed_mesh *m = &mesh.assembly.mesh;
        assert_elements_fit(m, (const double(*)[3])m->xyz);
        for (size_t e = 0; e < m->elements; e++)
            require(tm_mixed_jens(m, e) > 0, "an element is inverted");
        require(mesh.report.invalid == 0, "invalid elements are counted");
    }
    tm_octree_mesh_free(&mesh);
    tm_octree_free(&octree);
    tm_surface_free(&surface);
    return 0;
}
