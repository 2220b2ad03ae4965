# SPDX-License-Identifier: GPL-3.0-or-later
# What the system refuses, in all filters (tests/faults/run.py says what is right then):
# memory, processes, threads, files; and reads and writes that take little, or are
# interrupted. A sample of it, with FAULTS=1 all.
# shellcheck disable=SC2154 # setup_file of filters.bash sets filters

bats_require_minimum_version 1.5.0
load helpers
load filters
load large

# The rest of the input: a cube, its tetrahedra, octree elements and polyhedra.
make_inputs() {
    surface cube off >cube.off
    for format in obj ply stl poly; do
        surface cube "$format" >"cube.$format"
    done
    surface cube ply-little >binary.ply
    surface cube stl-binary >binary.stl
    gzip -c cube.off >cube.off.gz
    tetgen-mesh --quiet -a 0.05 cube.off >tets.tm
    polylla3d --quiet tets.tm >cells.tm
    awk '$1 == ".ele" { print; getline; print $1, $2, 1; cells = 1; next } /^\./ { cells = 0 }
        cells { $0 = $0 " " 1 + ($1 > 20) } 1' tets.tm >regions.tm
    is_left_out octree-mesh || octree-mesh --quiet -s 2 cube.off >elements.tm
    vtu-export --quiet tets.tm >tets.vtu
    vtu-export --quiet -o pieces.pvtu tets.tm
    vtk-export --quiet cells.tm >cells.vtk
    visf-export --quiet --binary little cells.tm >binary.visf
}

# What more a filter can do: options and files in the folder in.
more() {
    case $1 in
    lepp-improve) printf '%s\n' '-t 40 in/regions.tm' '-a delaunay -t 30 in/tets.tm' \
        '-a selective --path full --with both in/tets.tm' '-a bisection -s 1 in/tets.tm' ;;
    polylla3d) printf '%s\n' '--star in/tets.tm' '--cells 4 --star in/regions.tm' \
        '--levels 2 --absorb in/tets.tm' 'in/elements.tm' '--partition in/regions.tm' ;;
    poly-dual) echo '--feature-angle 30 --convex in/tets.tm' ;;
    poly-stats) printf '%s\n' '--plot new.svg in/cells.tm' '--for vem in/cells.tm' ;;
    tet-stats) echo '--plot new.svg in/tets.tm in/corner.tm' ;;
    jens-stats) printf '%s\n' '--histo new.histo --plot new.svg in/elements.tm' \
        '-e in/elements.tm' '-l in/elements.tm' '--certify in/elements.tm' ;;
    mesh-check) printf '%s\n' '--json - in/cells.tm' 'in/elements.tm' ;;
    mesh-view) echo 'in/tets.tm in/cells.tm' ;;
    octree-mesh) printf '%s\n' '-s 2 --polyhedra in/cube.off' '-s 1 -r in/cube.stl 2 in/cube.ply' ;;
    octree-repair) echo '-t 0.6 -i 2 --trace trace in/elements.tm' ;;
    tetgen-mesh) printf '%s\n' '-q1.4 -a 0.1 in/cube.off.gz' 'in/cube.poly' 'in/corner.node' ;;
    surface-import) printf '%s\n' in/cube.obj in/binary.ply in/binary.stl ;;
    surface-mend) echo '--weld auto --union in/cube.stl' ;;
    vtu-import) printf '%s\n' in/tets.vtu in/pieces.pvtu ;;
    vtk-import) echo 'in/cells.vtk' ;;
    visf-import) echo 'in/binary.visf' ;;
    vtu-export) printf '%s\n' in/elements.tm in/cells.tm '-o new.pvtu in/tets.tm' ;;
    vtk-export | visf-export) printf '%s\n' in/elements.tm in/cells.tm ;;
    m3d-export) echo in/elements.tm ;;
    off-export) echo '--all in/elements.tm' ;;
    medit-export) echo in/regions.tm ;;
    openfoam-export) echo 'new in/cells.tm' ;;
    esac
}

# Commands, one a line: the plain one; with standard input, a report, a file that is there
# and a thread; and what more there is.
commands() {
    local file plain="$1 --quiet --threads 1"
    file=in/$(input "$1")
    [ "$1" != octree-mesh ] || plain="$plain -s 2"
    # shellcheck disable=SC2046 # words
    echo "$plain" $(operands "$1" "$file")
    case $1 in
    tetgen-export | openfoam-export) echo "<$file $plain --json report old-set" ;;
    gmsh-export | gmsh-import) return ;; # Gmsh takes its time
    openfoam-import | tetgen-import) echo "$plain --json report -o old $file" ;;
    *) echo "<$file $plain --threads 2 --json report -o old" ;;
    esac
    more "$1" | sed "s|^|$plain |"
}

@test "what the system refuses: as if it had not, or exit 4, why, and nothing else" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers have an allocator of their own" ;; esac
    make_inputs
    for_each_filter commands | grep ' ' >cases
    is_left_out octree-mesh && sed -i '/elements\.tm/d' cases
    [ "$(wc -l <cases)" -gt 60 ]
    # shellcheck disable=SC2046 # words
    python3 "$root/tests/faults/run.py" $([ "${FAULTS:-0}" = 0 ] || echo -a -j "$(nproc)") \
        "$TM_BUILD/faults/preload.so" <cases
}

# Libraries say in their own way that there is no memory; it is not what is wrong with a file.
@test "zlib and expat have no memory, at each of their calls: exit 4, out of memory" {
    case ${TM_BUILD:?} in */san*) skip "the sanitizers have an allocator of their own" ;; esac
    make_inputs
    for file in tets.vtu cube.off cells.vtk; do
        gzip -c "$file" >"small.$file.gz"
    done
    cat >cases <<LIST
vtu-import --quiet --threads 1 in/tets.vtu
vtu-import --quiet --threads 1 in/small.tets.vtu.gz
vtk-import --quiet --threads 1 in/small.cells.vtk.gz
surface-import --quiet --threads 1 in/small.cube.off.gz
vtu-export --quiet --threads 1 in/tets.tm
mesh-view --quiet --threads 1 in/tets.tm
LIST
    python3 "$root/tests/faults/run.py" -k memory "$TM_BUILD/faults/preload.so" <cases
}

large_commands() {
    [ "$1" != tetgen-mesh ] || return 0 # TetGen is another program
    # shellcheck disable=SC2046 # words
    echo "$1" --quiet --threads 1 $(more_options "$1") $(operands "$1" "in/$(large_input "$1")")
}

# Below what the program needs to start the system ends it.
@test "little memory, ulimit -v: ends as it should, or exit 4, why, and nothing else" {
    case ${TM_BUILD:?} in */san*) skip "memory has no limit under the sanitizers" ;; esac
    make_large_inputs
    for_each_filter large_commands | grep ' ' >cases
    [ "$(wc -l <cases)" -gt 30 ]
    [ "${FAULTS:-0}" != 0 ] || { shuf -n 6 cases >some && mv some cases; }
    python3 "$root/tests/faults/run.py" -m "$TM_BUILD/faults/preload.so" <cases
}
