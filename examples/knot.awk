# SPDX-License-Identifier: GPL-3.0-or-later
# A trefoil knot as an OFF surface: awk -f knot.awk. It is a round tube, or with
# -v corners=4 a twisted bar with sharp edges; -v rings=N sets how many rings it has.

# The curve, once around for t from 0 to turn.
function x(t) { return sin(t) + 2 * sin(2 * t) }
function y(t) { return cos(t) - 2 * cos(2 * t) }
function z(t) { return -sin(3 * t) }

BEGIN {
    if (!rings)
        rings = 160
    if (!corners)
        corners = 24
    turn = 8 * atan2(1, 1)
    radius = 0.45
    # Whole ones, so that the corners meet where the tube closes.
    twists = 2
    step = 1e-4
    printf "OFF\n%d %d 0\n", rings * corners, 2 * rings * corners
    for (i = 0; i < rings; i++) {
        t = turn * i / rings
        dx = x(t + step) - x(t - step)
        dy = y(t + step) - y(t - step)
        dz = z(t + step) - z(t - step)
        d = sqrt(dx * dx + dy * dy + dz * dz)
        # u is level and across the curve, v across both.
        h = sqrt(dx * dx + dy * dy)
        ux = -dy / h; uy = dx / h
        vx = -dz * uy / d; vy = dz * ux / d; vz = (dx * uy - dy * ux) / d
        for (k = 0; k < corners; k++) {
            c = radius * cos(turn * k / corners + twists * t)
            s = radius * sin(turn * k / corners + twists * t)
            printf "%.9f %.9f %.9f\n", x(t) + c * ux + s * vx, y(t) + c * uy + s * vy,
                z(t) + s * vz
        }
    }
    for (i = 0; i < rings; i++)
        for (k = 0; k < corners; k++) {
            a = i * corners + k
            b = i * corners + (k + 1) % corners
            c = (i + 1) % rings * corners + k
            d = (i + 1) % rings * corners + (k + 1) % corners
            printf "3 %d %d %d\n3 %d %d %d\n", a, b, c, c, b, d
        }
}
