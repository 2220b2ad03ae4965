# SPDX-License-Identifier: GPL-3.0-or-later
# surface-mend: each kind of fault, alone and two at a time, is mended or named.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# Prints a box of 2 x 1 x 1 as text STL, or two bodies, with these faults, one after the
# other; the volume of what it should be goes to the file `volume`.
broken() {
    python3 - "$@" <<'END'
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
    elif kind == 'shuffle':
        random.shuffle(t)
print('solid')
for f in t:
    print('facet normal 0 0 0\nouter loop')
    for p in f:
        print('vertex %.17g %.17g %.17g' % p)
    print('endloop\nendfacet')
print('endsolid')
open('volume', 'w').write(str(volume))
END
}

# What the faults need to be told.
options_for() {
    case " $* " in
    *' gap '*) echo --weld auto ;;
    *' hole '*) echo --fill 0.6 ;;
    *' island '*) echo --islands 0.01 ;;
    esac
}

# mends KIND…: the surface is closed, has its volume, and a second time nothing changes.
mends() {
    broken "$@" >broken.stl
    # shellcheck disable=SC2046 # words
    surface-mend $(options_for "$@") --json report -o mended.tm broken.stl
    grep -q '"open_edges": 0, "good": true' report
    tetgen-mesh --quiet -q mended.tm | mesh-check --json - -o list >checked
    grep -o '"volume": [-0-9.e]*' checked | awk -v want="$(cat volume)" \
        '{ exit !($2 > want - 1e-6 && $2 < want + 1e-6) }'
    # shellcheck disable=SC2046 # words
    surface-mend $(options_for "$@") -o again.tm mended.tm 2>said
    [ ! -s said ]
    cmp <(grep -v '^#' mended.tm) <(grep -v '^#' again.tm)
}

@test "each kind of fault alone" {
    for kind in noise gap double back degenerate flat junction turned inward hole island wall \
        crack inside cavity shuffle; do
        echo "$kind"
        mends $kind
    done
}

@test "two faults at a time" {
    for kinds in 'noise turned' 'junction turned' 'flat noise' 'gap turned' 'double shuffle' \
        'hole inward' 'wall turned' 'noise junction' 'flat junction' 'wall junction' \
        'inside turned' 'crack turned' 'noise shuffle' 'gap inward' 'double turned' \
        'wall double' 'island turned'; do
        echo "$kinds"
        # shellcheck disable=SC2086 # words
        mends $kinds
    done
}

@test "what was done is said, with a place, and counted" {
    broken flat turned >broken.stl
    run -0 --separate-stderr surface-mend --json report -o mended.tm broken.stl
    [ "${#stderr_lines[@]}" -eq 2 ]
    [[ "${stderr_lines[0]}" == 'surface-mend: broken.stl: 1 triangle had no area: its neighbour is divided instead, at ('*')' ]]
    [[ "${stderr_lines[1]}" == 'surface-mend: broken.stl: 1 piece had triangles that are turned, at ('*')' ]]
    grep -q '"flat": 1, .*"turned": 1, ' report
    run -0 --separate-stderr surface-mend --quiet -o mended.tm broken.stl
    [ "$stderr" = "" ]
}

@test "a good surface stays as it is to the byte, with markers and names" {
    python3 - >good.stl <<'END'
for name, faces in (('inlet port', [((0, 0, 0), (0, 1, 0), (1, 0, 0))]),
                    ('wall', [((0, 0, 0), (1, 0, 0), (0, 0, 1)), ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
                              ((0, 1, 0), (0, 0, 0), (0, 0, 1))])):
    print('solid', name)
    for f in faces:
        print('facet normal 0 0 0\nouter loop')
        for p in f:
            print('vertex %g %g %g' % p)
        print('endloop\nendfacet')
    print('endsolid', name)
END
    surface-import good.stl >good.tm
    run -0 --separate-stderr surface-mend -o mended.tm good.tm
    [ "$stderr" = "" ]
    cmp <(grep -v '^#' good.tm) <(grep -v '^#' mended.tm)
    surface sphere off >sphere.off
    surface-mend sphere.off | grep -v '^#' | cmp - <(surface-import sphere.off | grep -v '^#')
}

@test "holes: only those that are small enough, and with the marker beside them" {
    broken hole >hole.stl
    run -1 --separate-stderr surface-mend --fill 0.1 --json report -o mended.tm hole.stl
    [[ "$stderr" == 'surface-mend: hole.stl: still: '*'edges with one triangle: 4'* ]]
    grep -q '"filled": 0, .*"open_edges": 4, "good": false' report
    surface-import hole.stl | ply-export | sed 's/^property list.*/&\nproperty int marker/
        /^3 /s/$/ 5/' >hole.ply
    surface-mend --fill 1 hole.ply | awk '/^\.face/ { f = 1; getline; next } /^\./ { f = 0 }
        f && $5 != 5 { bad++ } f { n++ } END { print n, bad + 0 }' | grep -x '132 0'
}

@test "--union: the wall of two bodies goes" {
    broken wall >wall.stl
    surface-mend --quiet --union -o one.tm wall.stl
    surface-mend --quiet -o two.tm wall.stl
    [ "$(header .face one.tm | cut -d ' ' -f 1)" -eq 228 ]
    [ "$(header .face two.tm | cut -d ' ' -f 1)" -eq 246 ]
    tetgen-mesh --quiet one.tm | mesh-check --json - -o list | grep -q '"volume": 3,'
}

@test "what crosses itself is refused with a place, and written all the same: exit 1" {
    python3 - >cross.off <<'END'
print('OFF\n8 8 0')
for x in (0, 0.1):
    for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        print(p[0] + x, p[1] + x, p[2] + x)
for b in (0, 4):
    for f in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
        print(3, *(b + v for v in f))
END
    run -1 --separate-stderr surface-mend -o cross.tm cross.off
    [[ "$stderr" == 'surface-mend: cross.off: still: two pieces of the surface cross: faces '*' meet near ('* ]]
    [ "$(header .face cross.tm | cut -d ' ' -f 1)" -eq 8 ]
}

@test "usage is exit 2, the wrong kind exit 3" {
    for wrong in --weld=x --weld=-1 --fill=x --islands --cut; do
        run -2 surface-mend "$wrong" sphere.off
    done
    cubes >cubes.tm
    run -3 surface-mend cubes.tm
}
