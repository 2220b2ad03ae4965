# SPDX-License-Identifier: GPL-3.0-or-later
# poly-dual: what it makes of whole meshes, and what it keeps.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0

setup_file() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    {
        surface sphere off | tetgen-mesh --no-history -q >sphere.tm
        two_boxes >boxes.poly
        tetgen-mesh --no-history -q1.4 -a 0.05 --switches A boxes.poly >boxes.tm
        "$TM_BUILD/bench/shapes" gear 6 | tetgen-mesh -q | lepp-improve --no-history >gear.tm
    } 2>/dev/null
}

setup() {
    load helpers
    cd "$BATS_FILE_TMPDIR" || exit
    out=$BATS_TEST_TMPDIR
}

# Sums a column of volumes of the regions of polyhedra: region_volumes FILE.
region_volumes() {
    python3 - "$1" <<'END'
import collections, sys
blocks, lines = {}, iter(open(sys.argv[1]))
for line in lines:
    if line[0] == '.' and line.strip() != '.end':
        head = next(lines).split()
        blocks[line.strip()] = [next(lines).split() for _ in range(int(head[0]))]
base = int(blocks['.node'][0][0])
xyz = [[float(x) for x in row[1:4]] for row in blocks['.node']]
region = [int(float(row[2 + int(row[1]) + 1])) for row in blocks['.cell']]
volume = collections.Counter()
for row in blocks['.facet']:
    k = int(row[3])
    p = [xyz[int(n) - base] for n in row[4:4 + k]]
    six = 0
    for b, c in zip(p[1:], p[2:]):
        a = p[0]
        six += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                + a[2] * (b[0] * c[1] - b[1] * c[0]))
    volume[region[int(row[1]) - base]] += six / 6
    if row[2] != '-1':
        volume[region[int(row[2]) - base]] -= six / 6
print(*('%d %.9f' % item for item in sorted(volume.items())))
END
}

@test "a ball: a cell for each node, nothing wrong, the same volume, fit for finite volumes" {
    poly-dual --no-history --json "$out/report.json" sphere.tm >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    [ "$(json "$out/report.json" polyhedra)" = "$(header .node sphere.tm | cut -d' ' -f1)" ]
    [ "$(json "$out/report.json" tets)" = "$(header .ele sphere.tm | cut -d' ' -f1)" ]
    [ "$(json "$out/report.json" nodes_taken_apart)" = 0 ]
    mesh-check --json "$out/tets.json" sphere.tm >/dev/null
    mesh-check --json "$out/dual.json" "$out/dual.tm" >/dev/null
    python3 - "$out" <<'END'
import json, sys
tets, dual = (json.load(open(sys.argv[1] + f)) for f in ('/tets.json', '/dual.json'))
assert abs(tets['volume'] - dual['volume']) <= 1e-12 * tets['volume']
assert abs(tets['area'] - dual['area']) <= 1e-12 * tets['area']
END
    run -0 poly-stats --for fv "$out/dual.tm"
}

@test "a curved surface that may be smooth has one facet for each node" {
    poly-dual --quiet --no-history --feature-angle 45 sphere.tm >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    facets=$(rows .facet "$out/dual.tm" | awk '$3 == -1' | wc -l)
    nodes=$(rows .face sphere.tm | awk '{ print $2; print $3; print $4 }' | sort -u | wc -l)
    [ "$facets" -eq "$nodes" ]
    run -0 poly-stats --for fv "$out/dual.tm"
}

@test "regions, markers and attributes: cells are of one region, sides keep their area" {
    poly-dual --quiet --no-history boxes.tm >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    run -0 region_volumes "$out/dual.tm"
    [ "$output" = '3 1.000000000 7 1.000000000' ]
    # Each side of the boxes, and what is between them, is of facets with its marker.
    [ "$(rows .facet "$out/dual.tm" | awk '{ print $NF }' | sort -un | tr '\n' ' ')" = \
        '0 11 12 13 14 15 16 20 ' ]
    # What is between regions has a cell on both sides; no node of an interface has one.
    [ "$(rows .facet "$out/dual.tm" | awk '$NF == 20 && $3 == -1' | wc -l)" -eq 0 ]
    # Markers of nodes are those of the sides and corners; 0 inside.
    [ "$(rows .node "$out/dual.tm" | awk '{ print $NF }' | sort -un | head -n 1)" = 0 ]
}

@test "edges of .edge that are on the surface are in two halves; those inside go, with a note" {
    cat >"$out/one.tm" <<'END'
termesh 1
.node
5 3 0 0
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 .2 .2 .2
.ele
4 4 0
1 1 2 3 5
2 1 4 2 5
3 1 3 4 5
4 2 4 3 5
.edge
2 1
1 1 2 9
2 1 5 8
.end
END
    run -0 --separate-stderr poly-dual --no-history "$out/one.tm"
    [[ $stderr == *'1 marked edges that are inside (.edge)'* ]]
    printf '%s\n' "$output" >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    [ "$(rows .edge "$out/dual.tm" | awk '{ print $NF }' | tr '\n' ' ')" = '9 9 ' ]
    run -3 poly-dual --strict "$out/one.tm"
}

@test "where the surface is concave cells are cut, and all centroids see their facets" {
    poly-dual --quiet --no-history --feature-angle 30 --json "$out/report.json" gear.tm \
        2>"$out/errors" >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    [ "$(json "$out/report.json" nodes_cut)" -gt 0 ]
    [ "$(json "$out/report.json" wrong_pyramids)" = 0 ]
    cells=$(json "$out/report.json" polyhedra)
    [ "$cells" -gt "$(header .node gear.tm | cut -d' ' -f1)" ]
    [ $((3 * cells)) -lt "$(json "$out/report.json" tets)" ]
    run -0 poly-stats --for fv "$out/dual.tm"
}

@test "--convex leaves no cell that is not convex, and hardly more cells" {
    poly-dual --quiet --feature-angle 30 --json "$out/fast.json" gear.tm >"$out/fast.tm"
    poly-dual --quiet --feature-angle 30 --convex --json "$out/report.json" gear.tm \
        >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    cells=$(json "$out/fast.json" polyhedra)
    [ "$(json "$out/report.json" polyhedra)" -ge "$cells" ]
    [ $((100 * $(json "$out/report.json" polyhedra))) -lt $((101 * cells)) ]
    [ "$(json "$out/fast.json" concave)" -gt 100 ]
    [ "$(json "$out/report.json" concave)" = 0 ]
    [ "$(json "$out/report.json" bad_facets)" = 0 ]
    poly-stats -q --json "$out/stats.json" "$out/dual.tm" >/dev/null
    for key in concave no_fan unseen small_weights small_volume_ratios small_determinants; do
        [ "$(json "$out/stats.json" finite_volume $key)" = 0 ]
    done
    run -0 poly-stats --for fv "$out/dual.tm"
}

@test "--convex cuts cells that have the surface on two sides of a hollow" {
    "$TM_BUILD/bench/shapes" cortex 16 | tetgen-mesh -q >"$out/cortex.tm" 2>/dev/null
    poly-dual --quiet --feature-angle 30 --convex --json "$out/report.json" \
        "$out/cortex.tm" >"$out/dual.tm"
    mesh-check "$out/dual.tm"
    [ "$(json "$out/report.json" concave)" = 0 ]
    run -0 poly-stats --for fv "$out/dual.tm"
}

@test "names stay; blocks that are not known go; a part stays" {
    awk '/^\.end/ { print ".group\n1 0\n1 2 11 bottom side\n.mine\n1 0\n1 2\nsurface.node\n1 3 0 0\n1 0 0 0" }
        { print }' boxes.tm >"$out/named.tm"
    for filter in poly-dual polylla3d; do
        run -0 --separate-stderr "$filter" --no-history "$out/named.tm"
        [[ $stderr == *'the block .mine, as the elements are polyhedra now: left out'* ]]
        [[ $output == *'2 11 bottom side'* ]]
        [[ $output == *'surface.node'* ]]
        [[ $output != *'.mine'* ]]
        mesh-check -q <<<"$output"
        run -3 "$filter" --strict -o "$out/strict.tm" "$out/named.tm"
        [ ! -e "$out/strict.tm" ]
    done
}

@test "the same bytes whatever the number of threads and the order of tetrahedra" {
    poly-dual --quiet --no-history -j 1 gear.tm >"$out/1.tm"
    poly-dual --quiet --no-history -j 2 gear.tm | cmp - "$out/1.tm"
    # Rows of .ele backwards.
    python3 - gear.tm >"$out/other.tm" <<'END'
import sys
lines = open(sys.argv[1]).read().splitlines()
first = lines.index('.ele') + 2
end = first + int(lines[first - 1].split()[0])
rows = [line.split() for line in lines[first:end]]
numbers = [row[0] for row in rows]
lines[first:end] = [' '.join([n] + row[1:]) for n, row in zip(numbers, rows[::-1])]
print(*lines, sep='\n')
END
    cells=$(header .cell "$out/1.tm")
    poly-dual --quiet --no-history "$out/other.tm" >"$out/2.tm"
    [ "$(header .cell "$out/2.tm")" = "$cells" ]
}

@test "what is polyhedra already, or has facets, is refused" {
    poly-dual --quiet boxes.tm >"$out/dual.tm"
    run -3 poly-dual "$out/dual.tm"
    [[ $output == *'holds polyhedra'* ]]
    awk '/^\.end/ { print ".facet\n0 0" } { print }' boxes.tm >"$out/facets.tm"
    run -3 poly-dual "$out/facets.tm"
    [[ $output == *'has .facet or .cell already'* ]]
    run -2 poly-dual --feature-angle 91 boxes.tm
}

# Thin tetrahedra around an edge: hub N.
hub() {
    awk -v n="$1" 'BEGIN {
        printf "termesh 1\n.node\n%d 3 0 0\n", n + 2
        for (i = 1; i <= n; i++)
            print i, cos(6.283185307179586 * i / n), sin(6.283185307179586 * i / n), 0
        print n + 1, 0, 0, -0.5 "\n" n + 2, 0, 0, 0.5
        printf ".ele\n%d 4 0\n", n
        for (i = 1; i <= n; i++)
            print i, i, i % n + 1, n + 1, n + 2
        print ".end"
    }'
}

# Points on a sphere, the same ones each time: on_sphere N.
on_sphere() {
    awk -v n="$1" 'BEGIN {
        print n, 3
        for (i = 1; i <= n; i++) {
            s = (s + 0.7548776662466927) % 1
            t = (t + 0.5698402909980532) % 1
            z = 2 * s - 1
            r = sqrt(1 - z * z)
            print i, r * cos(6.283185307179586 * t), r * sin(6.283185307179586 * t), z
        }
    }' | tetgen-mesh
}

@test "what takes too long is bounded: the work by the size, and the rounds" {
    on_sphere 150 >points.tm
    hub 150 >hub.tm
    for mesh in points hub; do
        poly-dual -q --json "$out/json" -o "$out/dual.tm" $mesh.tm
        mesh-check -q "$out/dual.tm"
        poly-stats "$out/dual.tm" | grep -q '^ *pyramids without volume *0$'
        tets=$(header .ele $mesh.tm | cut -d ' ' -f 1)
        rounds=$(json "$out/json" rounds)
        [ "$rounds" -gt 0 ]
        [ "$rounds" -le 40 ]
        [ "$(json "$out/json" work)" -le $((50000 * tets)) ]
    done
}
