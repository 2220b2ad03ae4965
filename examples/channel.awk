# SPDX-License-Identifier: GPL-3.0-or-later
# A bent round channel as an STL surface: awk -f channel.awk. Its solids are inlet, outlet
# and wall: names that its faces keep on the way to a solver.

# Corner i of ring s.
function node(s, i,    bend, turn) {
    bend = right_angle * s / rings
    turn = 4 * right_angle * i / corners
    return sprintf("%.6f %.6f %.6f", (bend_radius + cos(turn)) * cos(bend),
                   (bend_radius + cos(turn)) * sin(bend), sin(turn))
}

# The middle of ring s.
function middle(s,    bend) {
    bend = right_angle * s / rings
    return sprintf("%.6f %.6f 0", bend_radius * cos(bend), bend_radius * sin(bend))
}

# Its corners turn counter-clockwise, seen from outside. Readers find the normal from them.
function triangle(a, b, c) {
    print "facet normal 0 0 0\nouter loop"
    print "vertex " a "\nvertex " b "\nvertex " c
    print "endloop\nendfacet"
}

BEGIN {
    right_angle = 2 * atan2(1, 1)
    bend_radius = 3
    rings = 16
    corners = 24
    print "solid inlet"
    for (i = 0; i < corners; i++)
        triangle(middle(0), node(0, i), node(0, i + 1))
    print "endsolid inlet\nsolid outlet"
    for (i = 0; i < corners; i++)
        triangle(middle(rings), node(rings, i + 1), node(rings, i))
    print "endsolid outlet\nsolid wall"
    for (s = 0; s < rings; s++)
        for (i = 0; i < corners; i++) {
            triangle(node(s, i), node(s + 1, i), node(s + 1, i + 1))
            triangle(node(s, i), node(s + 1, i + 1), node(s, i + 1))
        }
    print "endsolid wall"
}
