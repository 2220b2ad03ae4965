# SPDX-License-Identifier: GPL-3.0-or-later
# A gear wheel with a bore as an OFF surface: awk -f gear.awk; -v teeth=N sets how many
# teeth it has. Its faces are polygons, its edges sharp.

# A point at a height, on a circle, in units of the 8 steps that a tooth is cut into.
function point(radius, step, height) {
    printf "%.9f %.9f %g\n", radius * cos(step * angle), radius * sin(step * angle), height
}

BEGIN {
    if (!teeth)
        teeth = 16
    n = 8 * teeth
    angle = 8 * atan2(1, 1) / n
    bore = 0.4
    foot = 0.85
    tip = 1
    # Nodes: rim below, rim above, bore below, bore above, n of each.
    printf "OFF\n%d %d 0\n", 4 * n, 4 * n
    for (height = 0; height < 0.4; height += 0.3)
        for (i = 0; i < n; i++)
            point(i % 8 < 4 ? tip : foot, i, height)
    for (height = 0; height < 0.4; height += 0.3)
        for (i = 0; i < n; i++)
            point(bore, i, height)
    for (i = 0; i < n; i++) {
        j = (i + 1) % n
        printf "4 %d %d %d %d\n", i, j, n + j, n + i                         # rim
        printf "4 %d %d %d %d\n", 2 * n + j, 2 * n + i, 3 * n + i, 3 * n + j # bore
        printf "4 %d %d %d %d\n", j, i, 2 * n + i, 2 * n + j                 # below
        printf "4 %d %d %d %d\n", n + i, n + j, 3 * n + j, 3 * n + i         # above
    }
}
