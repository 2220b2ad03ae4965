#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# How much memory does each filter take for a large mesh? large.sh [TETRAHEDRA]: a cube of
# about so many (a million) through every filter; prints CPU seconds, the peak of memory in
# MB and per tetrahedron (octree element, polyhedron) of its input, in bytes. The environment:
#   FILTERS   only these, as the first column has them
#   SECONDS_MOST   that one of them may take; 900
#   THREADS   of each; 1
# shellcheck source-path=SCRIPTDIR source=common.inc
tetrahedra=${1:-1000000}
set --
. "$(dirname "$0")/common.inc"

# A cube of n x n x n cubes of six tetrahedra, with nodes that are moved by a tenth.
cube() {
    awk -v n="$1" 'BEGIN {
        m = n + 1
        srand(1)
        printf "termesh 1\n.node\n%d 3 0 0\n", m * m * m
        for (k = 0; k < m; k++) for (j = 0; j < m; j++) for (i = 0; i < m; i++)
            printf "%d %.6g %.6g %.6g\n", v++, moved(i), moved(j), moved(k)
        printf ".ele\n%d 4 0\n", 6 * n * n * n
        path[1] = 1 " " m " " m * m; path[2] = m " " m * m " " 1; path[3] = m * m " " 1 " " m
        path[4] = m " " 1 " " m * m; path[5] = 1 " " m * m " " m; path[6] = m * m " " m " " 1
        for (p = 1; p <= 6; p++) { split(path[p], step); a[p] = step[1]; b[p] = a[p] + step[2] }
        c = 1 + m + m * m
        for (k = 0; k < n; k++) for (j = 0; j < n; j++) for (i = 0; i < n; i++) {
            o = i + m * (j + m * k)
            for (p = 1; p <= 6; p++)
                if (p <= 3) print t++, o, o + a[p], o + b[p], o + c
                else print t++, o, o + b[p], o + a[p], o + c
        }
        print ".end"
    }
    function moved(x) { return x > 0 && x < n ? x + 0.2 * (rand() - 0.5) : x }'
}

# Prints a row: row NAME COUNT COMMAND…
row() {
    name=$1 count=$2
    shift 2
    [ -z "${FILTERS:-}" ] || case " $FILTERS " in *" $name "*) ;; *) return 0 ;; esac
    status=0
    (cd "$work" && timeout "${SECONDS_MOST:-900}" cpu 1 sh -c '"$@" >/dev/null 2>message; [ $? -le 1 ]' \
        sh "$@" >"$work/figures" 2>/dev/null) || status=$?
    if [ "$status" -ne 0 ]; then
        printf '%-16s %10d  status %d: %s\n' "$name" "$count" "$status" "$(head -c 200 "$work/message")"
        return
    fi
    awk -v name="$name" -v count="$count" \
        '{ printf "%-16s %10d %9.1f %9.0f %9.1f\n", name, count, $1, $2 / 1024, 1024 * $2 / count }' \
        "$work/figures"
}

# Elements of a stream: count BLOCK FILE
count() {
    awk -v block="$1" '$1 == block { getline; print $1; exit }' "$2"
}

side=$(awk -v t="$tetrahedra" 'BEGIN { printf "%d", (t / 6) ^ (1 / 3) + 0.5 }')
cube "$side" >"$work/tets.tm"
n=$(count .ele "$work/tets.tm")
more="--quiet --threads ${THREADS:-1}"
printf '%-16s %10s %9s %9s %9s\n' filter elements "CPU s" MB "bytes/el."
# shellcheck disable=SC2086 # words
{
    row tet-stats "$n" tet-stats $more tets.tm
    row jens-stats "$n" jens-stats $more tets.tm
    row mesh-check "$n" mesh-check $more tets.tm
    for format in abaqus getfem m3d medit off obj ply stl visf vtk vtu; do
        row "$format-export" "$n" "$format-export" $more tets.tm
    done
    row mesh-view "$n" mesh-view $more tets.tm
    row tetgen-export "$n" tetgen-export $more out tets.tm
    row tetgen-import "$n" tetgen-import $more out
    rm -f "$work"/out.*
    for format in abaqus medit vtk vtu visf m3d; do
        case " ${FILTERS:-$format-import} " in *" $format-import "*) ;; *) continue ;; esac
        "$format-export" --quiet -o "$work/tets.$format" "$work/tets.tm"
        row "$format-import" "$n" "$format-import" $more "tets.$format"
        rm "$work/tets.$format"
    done
    row polylla3d "$n" polylla3d $more tets.tm
    row polylla3d-star "$n" polylla3d $more --star tets.tm
    row poly-dual "$n" poly-dual $more tets.tm
    polylla3d --quiet -o "$work/cells.tm" "$work/tets.tm"
    row poly-stats "$(count .cell "$work/cells.tm")" poly-stats $more cells.tm
    row mesh-check-poly "$(count .cell "$work/cells.tm")" mesh-check $more cells.tm
    row openfoam-export "$(count .cell "$work/cells.tm")" openfoam-export $more foam cells.tm
    rm -rf "$work/cells.tm" "$work/foam"
    row lepp-improve "$n" lepp-improve $more tets.tm
    row lepp-bisection "$n" lepp-improve $more -a bisection -s 1 tets.tm
    rm "$work/tets.tm"
    unit_cube >"$work/cube.off"
    level=$(awk -v t="$tetrahedra" 'BEGIN { printf "%d", log(t) / log(8) + 0.999 }')
    octree-mesh --quiet --most 4000000000 -a "$level" -o "$work/octants.tm" "$work/cube.off"
    n=$(count .mix "$work/octants.tm")
    row octree-mesh "$n" octree-mesh $more --most 4000000000 -a "$level" cube.off
    row octree-repair "$n" octree-repair $more -t 0.3 octants.tm
    row jens-stats-mix "$n" jens-stats $more octants.tm
    row oct-export "$n" oct-export $more octants.tm
}
