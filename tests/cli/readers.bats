# SPDX-License-Identifier: GPL-3.0-or-later
# No reader uses a byte that it has not read or set: all of them under valgrind, on files
# that are cut off at every byte, or damaged.

bats_require_minimum_version 1.5.0

setup() {
    case ${TM_BUILD:?} in */san) skip "the sanitizers do not run under valgrind" ;; esac
    command -v valgrind >/dev/null || skip "there is no valgrind"
}

checked() {
    TM_CASES=300 valgrind -q --error-exitcode=99 "$TM_BUILD/tests/$1"
}

@test "files that are cut off or changed, under valgrind" {
    checked test_truncation
}

@test "damaged files, under valgrind" {
    checked test_format_fuzz
}

@test "files of boxes and octants, under valgrind" {
    checked test_rule_files
}

# What FILE claims is refused in little memory: refused COMMAND… (with the file last).
refused() {
    (ulimit -v 300000 && "$@") >out 2>err && status=0 || status=$?
    [ "$status" -eq 3 ] || { echo "$*: exit status $status" && cat err && return 1; }
}

@test "a billion rows that a header claims: exit 3, in 300 MB" {
    cd "$BATS_TEST_TMPDIR"
    n=1000000000
    row() { printf '%b' "$2" >"$1"; }
    row a.node "$n 3 0 0\n1 0 0 0\n"
    row a.ele "$n 4 0\n1 1 1 1 1\n"
    row a.face "$n 0\n1 1 1 1\n"
    row a.edge "$n 0\n1 1 1\n"
    row one.node '1 3 0 0\n1 0 0 0\n'
    row wide.node "1 3 $n 0\n1 0 0 0\n"
    row a.off "OFF\n$n $n 0\n0 0 0\n"
    row long.off "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n$n 0 1 2\n"
    row a.ply "ply\nformat ascii 1.0\nelement vertex $n\nproperty float x\nproperty float y\n\
property float z\nend_header\n0 0 0\n"
    row b.ply "ply\nformat binary_little_endian 1.0\nelement vertex $n\nproperty float x\n\
property float y\nproperty float z\nend_header\n0 0 0\n"
    { head -c 80 /dev/zero; printf '\0\312\232\073'; } >a.stl
    row a.poly "1 3\n1 0 0 0\n$n 0\n1\n3 1 1 1\n"
    row a.smesh "1 3\n1 0 0 0\n1 0\n$n 1 1 1\n"
    row a.mdl "[Vertices, ARRAY1<POINT3D>]\n$n\n0 0 0\n[Triangles, ARRAY1<STRING>]\n0\n"
    row a.m3d "[Nodes, ARRAY1<STRING>]\n$n\n1 0 0 0\n"
    row a.mvm "MIXED\n$n $n\n0 0 0\n"
    row a.oct "$n $n $n\n0 0 0\n"
    row a.visf "2 2\n$n\n0 0 0\n"
    row b.visf "2 1\n3\n0 0 0\n1 0 0\n0 1 0\n$n\n3 0 1 2\n"
    row c.visf "2 1\n3\n0 0 0\n1 0 0\n0 1 0\n1\n$n 0 1 2\n0\n"
    printf '1\2\0\0\0\0\312\232\073\0\0\0\0' >d.visf
    row a.reg "n_regions $n\n0 0 0\n1 1 1\n5\n"
    row a.tm "termesh 1\n.node\n$n 3 1000 1\n1 0 0 0\n.end\n"
    row b.tm "termesh 1\n.node\n1 3 0 0\n1 0 0 0\n.cell\n$n 1000\n1 $n 1 1 1 1\n.end\n"
    for file in a.node wide.node; do refused tetgen-import "$file"; done
    for file in a.ele a.face a.edge; do refused tetgen-import one.node "$file"; done
    for file in a.node *.off *.ply a.stl a.poly a.smesh a.mdl; do
        refused tetgen-mesh "$file"
        refused octree-mesh "$file"
    done
    refused mdl-import a.mdl
    for file in a.m3d a.mvm; do refused m3d-import "$file"; done
    refused oct-import a.oct
    for file in *.visf; do refused visf-import "$file"; done
    refused octree-mesh -b a.reg one.node
    for file in a.tm b.tm; do
        for command in mesh-check poly-stats vtu-export; do refused "$command" "$file"; done
    done
}
