#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# mesh-view on a million tetrahedra: the size of the page, CPU seconds beside mesh-check's,
# and in headless Chromium, which draws by software, what it takes to be seen and to be cut:
# CPU seconds of the page's thread, for a loaded machine says nothing by its clock.
# shellcheck source-path=SCRIPTDIR source=common.inc
. "$(dirname "$0")/common.inc"
unit_cube >"$work/cube.off"
tetgen-mesh --quiet -q -a"${VOLUME:-0.0000019}" -o "$work/grid.tm" "$work/cube.off"
tets_of "$work/grid.tm" | awk '{ printf "%d tetrahedra\n", $1 }'
mesh-view -q -o "$work/grid.html" "$work/grid.tm"
ls -l "$work/grid.html" | awk '{ printf "page %26.1f MB (at most 25)\n", $5 / 1e6 }'
check=$(cpu "$runs" mesh-check -q -j 1 "$work/grid.tm" | cut -d ' ' -f 1)
view=$(cpu "$runs" mesh-view -q -j 1 "$work/grid.tm" | cut -d ' ' -f 1)
awk -v c="$check" -v v="$view" 'BEGIN {
    printf "mesh-check %20.2f s\nmesh-view %21.2f s   %.1f x mesh-check (at most 2)\n", c, v, v / c }'
command -v chromium >/dev/null || { echo "there is no chromium" >&2; exit; }
PYTHONPATH=tests/view python3 - "$work/grid.html" <<'END'
import sys
from browser import Browser

with Browser() as browser:
    def cpu():
        metrics = browser.call('Performance.getMetrics')['metrics']
        return next(m['value'] for m in metrics if m['name'] == 'TaskDuration')
    browser.call('Performance.enable', timeDomain='threadTicks')
    wall = browser.open(sys.argv[1])
    print(f'seen after {cpu():20.2f} s (at most 3), {wall:.2f} by the clock')
    browser.run('meshView.setNormal([1, -1, 0.3])')
    for cut in ('whole', 'plain'):
        browser.run(f'meshView.setCut("{cut}"), 1')
        browser.run('new Promise(r => requestAnimationFrame(() => setTimeout(r, 500)))')
        moves, before = 10, cpu()
        for i in range(moves):
            browser.run(f'meshView.setOffset({(i - moves / 2) / moves}), 1')
            browser.run('new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))')
        print(f'{cut:6} cut, a move {(cpu() - before) / moves:14.3f} s (at most 0.2)')
END
