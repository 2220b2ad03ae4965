# SPDX-License-Identifier: GPL-3.0-or-later
"""broken.py KIND …: prints a box of 2 x 1 x 1 as text STL, or two bodies, with these
faults, one after the other; on standard error the volume of what it should be, or
"refused" where that cannot be known."""
import random, sys
random.seed(7)
def box(o, s, n=(4, 3, 3)):
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for i in range(n[u]):
                for j in range(n[v]):
                    def at(a, b):
                        p = [0, 0, 0]
                        p[axis] = o[axis] + side * s[axis]
                        p[u] = o[u] + s[u] * a / n[u]
                        p[v] = o[v] + s[v] * b / n[v]
                        return tuple(p)
                    q = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
                    if not side:
                        q.reverse()
                    faces += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    return faces
def shaken(t, by):
    return [tuple(tuple(c + random.uniform(-by, by) for c in p) for p in f) for f in t]
t, volume = box((0, 0, 0), (2, 1, 1)), 2
for kind in sys.argv[1:]:
    middle = random.randrange(len(t))
    a, b, c = t[middle]
    m = tuple((x + y) / 2 for x, y in zip(a, b))
    if kind == 'noise':         # of floats: every triangle has corners of its own
        t = shaken(t, 1e-10)
    elif kind == 'gap':         # wider
        t = shaken(t, 1e-7)
    elif kind == 'double':
        t += random.sample(t, 9)
    elif kind == 'back':        # double, and turned
        t += [f[::-1] for f in random.sample(t, 5)]
    elif kind == 'degenerate':
        t += [(f[0], f[0], f[1]) for f in random.sample(t, 6)]
    elif kind == 'flat':        # a triangle without area closes an edge of two parts
        t[middle:middle + 1] = [(a, m, c), (m, b, c), (a, b, m)]
    elif kind == 'junction':    # an edge of two parts, and nothing closes it
        t[middle:middle + 1] = [(a, m, c), (m, b, c)]
    elif kind == 'turned':
        t = [f[::-1] if random.random() < 0.3 else f for f in t]
    elif kind == 'inward':
        t = [f[::-1] for f in t]
    elif kind == 'hole':
        del t[10:12]
    elif kind == 'island':
        t += box((3, 3, 3), (1e-3, 1e-3, 1e-3), (1, 1, 1))
    elif kind == 'wall':        # a second body; the wall is cut with other diagonals
        t += box((2, 0, 0), (1, 1, 1))
        volume += 1
    elif kind == 'crack':       # the same, beside it by less than a hair
        t += [tuple(tuple(c + 1e-11 for c in p) for p in f) for f in box((2, 0, 0), (1, 1, 1))]
        volume += 1
    elif kind == 'inside':
        t += box((0.5, 0.3, 0.3), (0.4, 0.4, 0.4), (2, 2, 2))
    elif kind == 'cavity':
        t += [f[::-1] for f in box((0.5, 0.3, 0.3), (0.4, 0.4, 0.4), (2, 2, 2))]
    elif kind == 'cross':       # a second body, partly in the first
        t += box((1.7, 0.31, 0.37), (1, 0.3, 0.3), (2, 2, 2))
        volume = 'refused'
    elif kind == 'touch':       # a corner of another one on a face of the first
        t += [tuple((x + 2, y + 0.47, z + 0.43) for x, y, z in f)
              for f in [((0, 0, 0), (1, 1, 0), (1, 0, 0)), ((0, 0, 0), (1, 0, 0), (1, 0, 1)),
                        ((0, 0, 0), (1, 0, 1), (1, 1, 0)), ((1, 0, 0), (1, 1, 0), (1, 0, 1))]]
        volume = 'refused'
    elif kind == 'torn':        # a hole that is not filled
        t = [f for f in t if min(p[0] for p in f) < 1.9]
        volume = 'refused'
    elif kind == 'shuffle':
        random.shuffle(t)
print('solid')
for f in t:
    print('facet normal 0 0 0\nouter loop')
    for p in f:
        print('vertex %.17g %.17g %.17g' % p)
    print('endloop\nendfacet')
print('endsolid')
print(volume, file=sys.stderr)
