# SPDX-License-Identifier: GPL-3.0-or-later
"""awkward.py: prints the names of the shapes, a line each.
awkward.py NAME [N]: prints a surface that is hard to fill with good tetrahedra; N is how
fine it is. Those with regions or markers are .poly files, the others OFF."""
import math
import sys


class Surface:
    """Nodes without duplicates, polygons with markers, regions."""

    def __init__(self):
        self.number, self.nodes, self.faces, self.regions = {}, [], [], []

    def node(self, p):
        p = tuple(float(c) for c in p)
        if p not in self.number:
            self.number[p] = len(self.nodes)
            self.nodes.append(p)
        return self.number[p]

    def face(self, *points, marker=0):
        v = [self.node(p) for p in points]
        v = [n for i, n in enumerate(v) if n != v[i - 1]]
        if len(v) > 2:
            self.faces.append((v, marker))

    def quad(self, a, b, c, d, marker=0):
        self.face(a, b, c, marker=marker)
        self.face(a, c, d, marker=marker)

    def print_off(self):
        print("OFF\n%d %d 0" % (len(self.nodes), len(self.faces)))
        for p in self.nodes:
            print("%.17g %.17g %.17g" % p)
        for v, _ in self.faces:
            print(len(v), *v)

    def print_poly(self):
        print(len(self.nodes), 3, 0, 0)
        for i, p in enumerate(self.nodes, 1):
            print(i, "%.17g %.17g %.17g" % p)
        print(len(self.faces), 1)
        for v, marker in self.faces:
            print(1, 0, marker)
            print(len(v), *(n + 1 for n in v))
        print(0)
        print(len(self.regions))
        for i, (p, value) in enumerate(self.regions, 1):
            print(i, "%.17g %.17g %.17g" % p, value)


def sheet(s, us, vs, place, marker=0, turned=False):
    """A grid of squares, two triangles each; place(u, v) says where. turned: inside out."""
    for u, u2 in zip(us, us[1:]):
        for v, v2 in zip(vs, vs[1:]):
            corners = [place(u, v), place(u2, v), place(u2, v2), place(u, v2)]
            m = marker(u, v) if callable(marker) else marker
            s.quad(*(corners[::-1] if turned else corners), marker=m)


def steps(n, low=0.0, high=1.0):
    return [low + (high - low) * i / n for i in range(n)] + [high]


def box(s, xs, ys, zs, marker=0):
    """A box whose sides have the lines of these coordinates."""
    for axis, (us, vs, ends) in enumerate(((ys, zs, xs), (zs, xs, ys), (xs, ys, zs))):
        for turned, w in ((True, ends[0]), (False, ends[-1])):
            def place(u, v, axis=axis, w=w):
                p = [w, u, v]
                return p[-axis:] + p[:-axis] if axis else p
            sheet(s, us, vs, place, marker, turned)


def extrude(s, polygon, ys):
    """Counter-clockwise in x and z seen from -y; caps are polygons."""
    s.face(*((x, ys[0], z) for x, z in polygon))
    s.face(*((x, ys[-1], z) for x, z in reversed(polygon)))
    for (x, z), (x2, z2) in zip(polygon, polygon[1:] + polygon[:1]):
        for y, y2 in zip(ys, ys[1:]):
            s.quad((x, y, z), (x, y2, z), (x2, y2, z2), (x2, y, z2))


def sphere(s, n, radius, centre=(0, 0, 0), marker=0, noise=lambda: 0.0):
    """The sides of a cube with n by n squares each, blown up."""
    seen = {}

    def place(p):
        if p not in seen:
            q = [math.tan(math.pi / 4 * c) for c in p]
            r = radius * (1 + noise()) / math.sqrt(sum(c * c for c in q))
            seen[p] = tuple(c * r + o for c, o in zip(q, centre))
        return seen[p]
    cube = Surface()
    box(cube, steps(n, -1), steps(n, -1), steps(n, -1))
    for v, _ in cube.faces:
        s.face(*(place(cube.nodes[k]) for k in v), marker=marker)


def random(seed):
    """Uniform in -1 to 1, the same in each run (Park and Miller)."""
    state = seed
    while True:
        state = state * 16807 % 2147483647
        yield 2 * state / 2147483647 - 1


def needles(s, n):
    """A plate; its large sides are triangles from one edge to the other, and unevenly so."""
    def place(z):
        return lambda u, v: (u ** (1 + v / 2), v, z)
    us = steps(n)
    sheet(s, us, [0, 1], place(0), turned=True)
    sheet(s, us, [0, 1], place(0.1))
    for y in (0, 1):
        sheet(s, us, [0, 0.1], lambda u, v, y=y: (u ** (1 + y / 2), y, v), turned=y == 1)
    for x in (0, 1):
        sheet(s, [0, 1], [0, 0.1], lambda u, v, x=x: (x, u, v), turned=x == 0)


def strips(s, n):
    """A cylinder: n strips from end to end, and fans."""
    ring = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
    for (x, y), (u, v) in zip(ring, ring[1:] + ring[:1]):
        s.quad((x, y, 0), (u, v, 0), (u, v, 2), (x, y, 2))
        s.face((u, v, 0), (x, y, 0), (0, 0, 0))
        s.face((x, y, 2), (u, v, 2), (0, 0, 2))


def scan(s, n):
    """A torus with noise of a fifth of an edge; 2 n n triangles."""
    size, values = 0.2 * 2 * math.pi / n, random(7)
    seen = {}

    def place(u, v):
        key = round(u * n) % n, round(v * n) % n
        if key not in seen:
            a, b = (2 * math.pi * k / n for k in key)
            r = 0.4 + size * 0.4 * next(values)
            seen[key] = ((1 + r * math.cos(b)) * math.cos(a),
                         (1 + r * math.cos(b)) * math.sin(a), r * math.sin(b))
        return seen[key]
    sheet(s, steps(n), steps(n), place)


def slotted(s, n, width):
    """A box with a slot from the top nearly to the bottom."""
    a, b = 0.5 - width / 2, 0.5 + width / 2
    extrude(s, [(0, 0), (1, 0), (1, 1), (b, 1), (b, 0.2), (a, 0.2), (a, 1), (0, 1)], steps(n))


def gap(s, n):
    """Walls so near that nothing but exact arithmetic sees between them."""
    slotted(s, n, 1e-7)


def slit(s, n):
    """Two walls nearer to each other than a surface may move."""
    slotted(s, n, 2e-3)


def tiny(s, n):
    """A box of which every second row of squares is 1e-9 wide."""
    lines = sorted({0.0, 1.0} | {x + w for x in steps(n)[1:-1] for w in (0, 1e-9)})
    box(s, lines, lines, steps(n))


def folds(s, n):
    """A thin sheet in n folds."""
    thick, polygon = 0.02, [(i / n, 0.3 * (i % 2)) for i in range(n + 1)]
    extrude(s, polygon + [(x, z + thick) for x, z in reversed(polygon)], steps(2))


def knife(s, n):
    """A wedge of two degrees."""
    extrude(s, [(0, 0), (1, -0.0175), (1, 0.0175)], steps(n))


def plates(s, n):
    """Two plates with a slit between them, held together by a block: nearer to each other
    than a surface may move."""
    extrude(s, [(0, 0), (1, 0), (1, 0.1), (0.1, 0.1), (0.1, 0.102), (1, 0.102), (1, 0.2),
                (0, 0.2)], steps(n))


def tube(s, n):
    """Handles: a slab with three holes, bent."""
    holes = {(x, 1) for x in (1, 3, 5)}
    cells = {(x, y) for x in range(7) for y in range(3)} - holes

    def place(x, y, z):
        a = 0.5 * x
        return ((4 + z) * math.sin(a), y, (4 + z) * math.cos(a))
    for x, y in cells:
        xs, ys = steps(n, x, x + 1), steps(n, y, y + 1)
        sheet(s, xs, ys, lambda u, v: place(u, v, 0), turned=True)
        sheet(s, xs, ys, lambda u, v: place(u, v, 1))
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            if (x + dx, y + dy) in cells:
                continue
            fixed = max(dx, 0) + x if dx else max(dy, 0) + y
            if dx:
                sheet(s, ys, steps(n), lambda u, v, f=fixed: place(f, u, v), turned=dx < 0)
            else:
                sheet(s, xs, steps(n), lambda u, v, f=fixed: place(u, f, v), turned=dy > 0)


def wavy(s, n):
    """A box of two regions, a wave between them; each side has its marker."""
    def wave(u, v):
        return 0.5 + 0.1 * math.sin(2 * math.pi * u) * math.cos(math.pi * v)
    us = steps(n)
    for marker, z in ((1, 0.0), (2, 1.0)):
        sheet(s, us, us, lambda u, v, z=z: (u, v, z), marker, turned=z == 0)
    sheet(s, us, us, lambda u, v: (u, v, wave(u, v)), 9)
    for marker, at in ((3, 0.0), (4, 1.0)):
        for low in (True, False):
            def height(u, v, w, low=low):
                if low:
                    return w * wave(u, v)
                return 1 if w == 1 else wave(u, v) + w * (1 - wave(u, v))
            for along in (0, 1):
                def place(t, w, along=along, at=at, height=height):
                    u, v = (t, at) if along == 0 else (at, t)
                    return (u, v, height(u, v, w))
                sheet(s, us, steps(max(1, n // 2)), place, marker + 2 * along,
                      turned=(along == 0) == (at == 1))
    s.regions = [((0.5, 0.5, 0.1), 3), ((0.5, 0.5, 0.9), 7)]


def nested(s, n):
    """Three spheres in each other, a region in each."""
    for marker, radius in ((1, 1), (2, 0.7), (3, 0.35)):
        sphere(s, n, radius, marker=marker)
    s.regions = [((0, 0, 0.9), 10), ((0, 0, 0.5), 20), ((0, 0, 0), 30)]


def patches(s, n):
    """A box with a marker for each side, and a disc in the top with one of its own."""
    us = steps(n)
    for marker, z in ((1, 0.0), (2, 0.5)):
        def disc(u, v, marker=marker):
            middle = 0.5 / n
            inside = math.hypot(u + middle - 0.5, v + middle - 0.5) < 0.3
            return 9 if marker == 2 and inside else marker
        sheet(s, us, us, lambda u, v, z=z: (u, v, z), disc, turned=z == 0)
    for at in (0.0, 1.0):
        zs = steps(max(1, n // 2), 0, 0.5)
        sheet(s, us, zs, lambda u, v, at=at: (u, at, v), 3 + int(at), turned=at == 1)
        sheet(s, us, zs, lambda u, v, at=at: (at, u, v), 5 + int(at), turned=at == 0)


# the name, the function, how fine by default
SHAPES = {"needles": (needles, 200), "strips": (strips, 1000), "scan": (scan, 100),
          "gap": (gap, 4), "slit": (slit, 8), "tiny": (tiny, 6), "folds": (folds, 8),
          "knife": (knife, 8), "plates": (plates, 8), "tube": (tube, 3),
          "wavy": (wavy, 16), "nested": (nested, 8), "patches": (patches, 12)}


def main():
    if len(sys.argv) < 2:
        print("\n".join(SHAPES))
        return
    make, fine = SHAPES[sys.argv[1]]
    s = Surface()
    make(s, int(sys.argv[2]) if len(sys.argv) > 2 else fine)
    if s.regions or any(marker for _, marker in s.faces):
        s.print_poly()
    else:
        s.print_off()


main()
