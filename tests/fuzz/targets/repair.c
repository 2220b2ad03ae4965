/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mesh of an octree with nodes moved at will, repaired: nothing is worse, elements
 * fit together, and nodes are where they belong. */
#include "target.h"

#include "../../../lib/octree/repair/repair.h"
#include "../../unit/repair_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    repair_case c;
    tm_polygon_surface p;
    tm_repair_report report;
    tm_error error;
    bytes_start(bytes, size);
    if (start_mpi(NULL) != 0)
        give_up("MPI");
    tm_polygon_surface_init(&p);
    add_random_solid(&p);
    start_case(&c, &p, 1);
    const size_t inside = random_below(5);
    damage(&c, inside, random_below(3));
    tm_repair_options options = {.method =
                                     random_below(4) ? TM_REPAIR_FULL : TM_REPAIR_REFINE};
    options.threshold = random_between(0, 0.2);
    options.iterations = random_below(2);
    options.growth = random_between(1, 3);
    const tm_examination first = examine_state(&c.state);
    assert_ok(tm_repair(&c.state, &c.surface, &options, &report, &error), &error);
    check_score(&c.state, &report.after, options.threshold);
    if (options.method == TM_REPAIR_FULL) {
        check_not_worse(&report.before, &report.after);
        check_state(&c.state, &c.surface, &first);
    }
    assert_ok(tm_repair_to_stream(&c.state, &c.stream, &c.surface, &c.notes, &error),
              &error);
    check_round_trip(&c.stream);
    end_case(&c);
    return 0;
}
