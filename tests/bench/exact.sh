#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The exact predicates on degenerate points of a lattice, with coordinates that are rounded
# and with whole ones.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
for spacing in 0.1 1; do
    echo "spacing $spacing"
    exact "$spacing"
done
