# SPDX-License-Identifier: GPL-3.0-or-later
# Coordinates of all sizes that a stream can hold: what cannot be computed with is refused,
# the rest is as it is at size 1.
# shellcheck disable=SC2086,SC2154 # lists of words; run sets stderr

bats_require_minimum_version 1.5.0
load helpers

# Multiplies the coordinates of a stream's nodes and roots: scaled FACTOR [NODE]: all, or
# those of the node of that number alone.
scaled() {
    python3 -c '
import sys
factor, one = sys.argv[1], sys.argv[2:]
factor = float.fromhex(factor) if "p" in factor else float(factor)
width = {"node": 3, "root": 4}
block, header = "", False
for line in sys.stdin:
    word = line.split()
    if line[:1].isalpha() or line[:1] == ".":
        block, header = line.strip().split(".")[-1], True
    elif header:
        header = False
    elif block in width and word and (not one or word[0] == one[0]):
        for i in range(1, 1 + width[block]):
            word[i] = repr(max(min(float(word[i]) * factor, 1.7e308), -1.7e308))
        line = " ".join(word) + "\n"
    sys.stdout.write(line)' "$@"
}

setup_file() {
    cd "$BATS_FILE_TMPDIR" || exit
    {
        surface cube off >cube.off
        tetgen-mesh -q1.4 --no-history cube.off >tets.tm
        tetgen-mesh -q1.4 -a .02 --no-history cube.off >fine.tm
        { sed '/^\.ele/,$d' tets.tm; echo .end; } >points.tm
        { sed '/^\.ele/,/^\.face/{/^\.face/!d}' tets.tm; } >surface.tm
        octree-mesh --no-history -a 1 cube.off >mixed.tm
        polylla3d --no-history tets.tm >polyhedra.tm
    } 2>/dev/null
}

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

meshes="points surface tets mixed polyhedra"

# The commands that read a stream, with options that compute more.
computing='jens-stats --certify
jens-stats -j
jens-stats -a
jens-stats --verdict
lepp-improve
lepp-improve -a selective --with both -t 60
mesh-check
octree-mesh -s 2
octree-repair -t .2 -i 1
poly-dual
poly-dual --feature-angle 30 --convex
poly-stats
polylla3d
polylla3d --mode cavity --star --merge-coplanar
tet-stats --list
tetgen-mesh'
converting='getfem-export
m3d-export
mvm-export
oct-export
off-export --all
openfoam-export made
tetgen-export made
visf-export
vtk-export
vtu-export'

# Runs each command on the streams, which are called MESH@WHAT: no signal, no internal
# error, no error of the system, and no number that is none in what it says, nor one that
# is unknown and is known of MESH. (TetGen may abort; that is told.) sane COMMANDS FILE…
sane() {
    python3 - "$@" <<'END'
import glob, os, re, subprocess, sys
no_number = re.compile(rb'\b(nan|inf|infinity)\b', re.I)

def run(command, file):
    if os.path.exists('report'):
        os.remove('report')
    for old in glob.glob('made.*'):
        os.remove(old)
    made = subprocess.run(command.split() + ['--json', 'report', file],
                          capture_output=True, timeout=60)
    report = open('report', 'rb').read() if os.path.exists('report') else b''
    return made, report

wrong = []
for file in sys.argv[2:]:
    for command in sys.argv[1].split('\n'):
        made, report = run(command, file)
        said = made.stderr + report
        if not command.startswith('vtu-export'): # binary
            said += made.stdout
        told = made.returncode == 4 and b"'tetgen' was ended by signal" in made.stderr
        if made.returncode not in (0, 1, 3) and not told or no_number.search(said) or (
                b'null' in report and b'null' not in run(command, file.split('@')[0])[1]):
            wrong.append((file, command, made.returncode, said[:2000]))
for each in wrong:
    print(*each)
sys.exit(len(wrong) > 0)
END
}

@test "sizes from 1e-200 to 1.7e308: no signal, no internal error, no nan, in all filters" {
    for mesh in $meshes; do
        cp "$BATS_FILE_TMPDIR/$mesh.tm" "$mesh"
        for size in 1e-200 1e-44 9e44 1e101 1e155 1e200 4e307 1.7e308; do
            scaled "$size" <"$mesh" >"$mesh@$size"
        done
    done
    sane "$computing" ./*@*
    sane "$converting" ./*@1e-200 ./*@1.7e308
}

@test "one node that is very near or far from where it was: no signal, no nan" {
    for mesh in $meshes; do
        cp "$BATS_FILE_TMPDIR/$mesh.tm" "$mesh"
        for size in 1e-200 9e44; do
            scaled "$size" 8 <"$mesh" >"$mesh@$size"
        done
    done
    sane "$computing" ./*@*
}

# A stream without its coordinates.
without_coordinates() {
    sed '/^\.node/,/^[a-z.]*\.[a-df-mo-z]/d; /^surface.node/,/^surface.face/d' "$1"
}

@test "a mesh scaled by a power of two within the limits: the same, and the same numbers" {
    cd "$BATS_FILE_TMPDIR"
    for power in 0x1p-140 0x1p140; do
        for mesh in fine mixed polyhedra; do
            scaled "$power" <"$mesh.tm" >"$mesh@.tm"
        done
        for command in 'lepp-improve -q -a selective --with both -t 60' 'polylla3d -q' \
            'lepp-improve -q -t 45' 'lepp-improve -q -t 45 --surface-tolerance .01'; do
            $command --no-history fine.tm >expected.tm
            $command --no-history fine@.tm >found.tm
            without_coordinates found.tm | cmp - <(without_coordinates expected.tm)
        done
        for command in 'jens-stats mixed' 'jens-stats --certify mixed'; do
            cmp <($command@.tm) <($command.tm)
        done
        for key in not_star_shaped min_dihedral max_dihedral non_simple; do
            diff <(poly-stats --json - polyhedra@.tm | json /dev/stdin "$key") \
                <(poly-stats --json - polyhedra.tm | json /dev/stdin "$key")
        done
    done
}

@test "what is beyond the limits is refused by name" {
    cd "$BATS_FILE_TMPDIR"
    scaled 1e155 8 <tets.tm >far.tm
    scaled 1e-200 <tets.tm >near.tm
    for command in lepp-improve polylla3d tet-stats jens-stats mesh-check; do
        run -3 --separate-stderr "$command" far.tm
        [[ "$stderr" == "$command: far.tm: .node: node 8 at ("*'): beyond 1e+45, where '* ]]
        [[ "$stderr" == *' (scale the mesh)' ]]
        run -3 --separate-stderr "$command" near.tm
        [[ "$stderr" == "$command: near.tm: .node: the largest coordinate is 1e-200: "* ]]
    done
    scaled 1e155 8 <surface.tm >far.tm
    run -3 --separate-stderr tetgen-mesh far.tm
    [[ "$stderr" == 'tetgen-mesh: far.tm: node 8 at ('*'): beyond 1e+45, where '* ]]
    scaled 1e155 8 <polyhedra.tm >far.tm
    run -3 --separate-stderr poly-stats far.tm
    [[ "$stderr" == 'poly-stats: far.tm: .node: node 8 at ('*'): beyond 1e+45, where '* ]]
    scaled 1e155 8 <mixed.tm >far.tm
    run -3 --separate-stderr octree-repair far.tm
    [[ "$stderr" == 'octree-repair: far.tm: .node: node 8 at ('*'): beyond 1e+45, where '* ]]
    sed '5s/.*/0 1e155 0/' cube.off >far.off
    run -3 --separate-stderr octree-mesh far.off
    [[ "$stderr" == 'octree-mesh: far.off: node '*' at (0, 1e+155, 0): beyond 1e+45, '* ]]
}
