# SPDX-License-Identifier: GPL-3.0-or-later
# gnuplot -c improve-front.gp FIGURES SVG "MESH…": bad tetrahedra against size, a panel for
# each mesh; our runs are a line, the others are points. FIGURES is as improve.sh makes
# it: mesh, kind, name, tetrahedra, ratio, bad %, … with tabs.
meshes = ARG3
n = words(meshes)
columns = n < 2 ? 1 : 2
rows = (n + columns - 1) / columns
set terminal svg size 620 * columns, 420 * rows font "sans,12" background "white"
set output ARG2
set datafile separator "\t"
set multiplot layout rows, columns
set logscale x
set xtics (0.1, 0.25, 0.5, 1, 2, 4, 8)
set xrange [0.06:12]
set yrange [0:*]
set grid
set key below
set xlabel "tetrahedra, times the input's"
set ylabel "bad tetrahedra, %"
of(mesh, kind) = sprintf("<awk -F '\\t' '$1 == \"%s\" && $2 == \"%s\"' '%s'", mesh, kind, ARG1)
others(mesh) = system(sprintf("awk -F '\\t' '$1 == \"%s\" && $2 ~ /peer|else/ { print $2 }' '%s' | sort -ru", \
    mesh, ARG1))
do for [i = 1:n] {
    mesh = word(meshes, i)
    set title mesh
    plot of(mesh, "ours") using 5:6 with linespoints pt 7 ps 0.7 lw 2 lc rgb "#c03020" \
            title "lepp-improve", \
        for [kind in others(mesh)] of(mesh, kind) using 5:6:3 with labels left \
            point pt (kind eq "peer" ? 5 : 4) ps 0.7 \
            lc rgb (kind eq "peer" ? "#205080" : "#808080") offset 0.7, 0 font ",9" \
            title (kind eq "peer" ? "others, this machine" : "others, elsewhere")
}
unset multiplot
