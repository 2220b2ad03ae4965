# SPDX-License-Identifier: GPL-3.0-or-later
# Options that are wrong, and the completion of those that are right.
# shellcheck disable=SC2154 # run sets stderr

bats_require_minimum_version 1.5.0
load helpers

setup() {
    cd "$BATS_TEST_TMPDIR" || exit
}

# is_told MESSAGE FILTER OPTION…
is_told() {
    run -2 --separate-stderr "${@:2}" </dev/null
    [ "$output" = '' ]
    [ "${stderr_lines[0]}" = "$2: $1" ] || { echo "$stderr" && false; }
    [[ "${stderr_lines[1]}" == "usage: $2 "* ]]
}

filters() {
    for program in "$TM_BUILD"/bin/*; do # but the script, which has two options
        [ "${program##*/}" = mesh-convert ] || echo "${program##*/}"
    done
}

# The long options of --help.
options_of() {
    "$1" --help | grep -oE '^ +(-[A-Za-z], )?--[a-z0-9-]+' | grep -oE -- '--[a-z0-9-]+'
}

@test "a misspelt option and the one that is most like it" {
    is_told "unknown option '--treshold' (--threshold?)" tet-stats --treshold 1
    is_told "unknown option '--treshold' (--threshold?)" tet-stats --treshold=1
    is_told "unknown option '--jsno' (--json?)" jens-stats --jsno x
    is_told "unknown option '--max-grwoth' (--max-growth?)" lepp-improve --max-grwoth 2
    is_told "unknown option '--colour'" jens-stats --colour
    is_told "unknown option '-T' (-t?)" lepp-improve -vT 1
    is_told "unknown option '-Z'" jens-stats --strict -Zv
    is_told "unknown option '-:'" jens-stats --strict -:
    swapped() { # the second and the third letter
        name=${option#--}
        [ ${#name} -gt 4 ] || return 0
        wrong=${name:0:1}${name:2:1}${name:1:1}${name:3}
        [ "$wrong" != "$name" ] || return 0
        run -2 --separate-stderr "$1" "--$wrong"
        [[ "$stderr" == "$1: unknown option '--$wrong' (--$name?)"* ]]
    }
    for filter in $(filters); do
        for option in $(options_of "$filter"); do
            swapped "$filter"
        done
    done
}

@test "ambiguous, without its argument, with one that it does not take" {
    is_told "ambiguous option '--ver' (--version, --verbose)" tet-stats --ver
    is_told "ambiguous option '--max' (--max-growth, --max-star)" lepp-improve --max=1
    is_told "option '--json' lacks its argument" tet-stats --json
    is_told "option '--output' lacks its argument" tet-stats -v --output
    is_told "option '--output' lacks its argument" tet-stats --outp
    is_told "option '-o' lacks its argument" tet-stats --strict -vo
    is_told "option '--strict' takes no argument, but 'yes' is given" tet-stats --strict=yes
    is_told "option '--verbose' takes no argument, but '' is given" tet-stats --verb=
    is_told "--face-metric: 'x' is none of area, inradius" polylla3d --face x
    is_told "-a: 'x' is none of bisection, centroid, wcentroid, delaunay, swap-centroid, \
selective, improve" lepp-improve --algorithm x
}

@test "an argument that stands apart, where it must be attached" {
    surface cube off >cube.off
    is_told "one FILE at most, but there is also 'cube.off' (if 1.4 belongs to the option: \
-q1.4)" tetgen-mesh -q 1.4 cube.off
    is_told "one FILE at most, but there is also 'cube.off' (if 1.4 belongs to the option: \
--quality=1.4)" tetgen-mesh --qual 1.4 -a 1 cube.off
    is_told "one FILE at most, but there is also 'x.tm' (if 10 belongs to the option: \
--merge-coplanar=10)" polylla3d --merge-coplanar 10 x.tm
    is_told "one FILE at most, but there is also 'b.off'" tetgen-mesh -q cube.off b.off
    run -4 --separate-stderr tetgen-mesh -q none.off
    [ "$stderr" = 'tetgen-mesh: none.off: cannot open: No such file or directory' ]
    run -4 --separate-stderr tetgen-mesh -q 1.4 <cube.off
    [ "$stderr" = 'tetgen-mesh: 1.4: cannot open: No such file or directory (if 1.4 belongs '\
'to the option: -q1.4)' ]
    tetgen-mesh -q cube.off >/dev/null
}

# Completion ---------------------------------------------------------------------------

# What bash offers for the last of the words: offers FILTER WORD…
offers() {
    bash -c '
        source "$1"
        shift
        COMP_WORDS=("$@")
        COMP_CWORD=$(($# - 1))
        function=$(complete -p "$1") && function=${function#*-F } && ${function% *}
        [ ${#COMPREPLY[@]} -eq 0 ] || printf "%s\n" "${COMPREPLY[@]}"' \
        bash "$TM_BUILD/completion/bash/$1" "$@"
}

@test "bash completes all options of --help, of every filter, and no others" {
    for filter in $(filters); do
        bash -n "$TM_BUILD/completion/bash/$filter"
        diff <(options_of "$filter" | sort) <(offers "$filter" -- | sort)
        diff <("$filter" --help | grep -oE '^  -[A-Za-z]' | tr -d ' ' | sort) \
            <(offers "$filter" - | grep -v -- -- | sort)
        [ "$(offers "$filter" -o out --verb)" = --verbose ]
        [ "$(offers "$filter" '')" = '' ]
    done
}

@test "bash completes the words that an option takes" {
    words() { # FILTER OPTION
        run -2 --separate-stderr "$1" "$2" none
        diff <(offers "$1" "$2" '') <(sed 's/.* is none of //; s/, /\n/g; q' <<<"$stderr")
    }
    words lepp-improve -a
    words lepp-improve --algorithm
    words lepp-improve --with
    words lepp-improve --ops
    words polylla3d --mode
    words visf-export --binary
    [ "$(offers polylla3d --mode edg)" = edge ]
    [ "$(offers polylla3d --mode = edg)" = edge ]
    [ "$(offers polylla3d --mode = | wc -l)" -eq 6 ]
    [ "$(offers lepp-improve -s c)" = converged ]
    [ "$(offers polylla3d -o te)" = '' ]
}

@test "zsh: the same, with what --help says" {
    command -v zsh >/dev/null || skip "there is no zsh"
    for filter in $(filters); do
        file=$TM_BUILD/completion/zsh/_$filter
        zsh -n "$file"
        zsh -fc '_arguments() { print -rl -- "$@" }; source "$1"' zsh "$file" >specs
        diff <(options_of "$filter" | sort) \
            <(grep -oE '^([*]|\([^)]*\))?--[a-z0-9-]+' specs | sed 's/.*--/--/' | sort)
    done
    zsh -fc '_arguments() { print -rl -- "$@" }; source "$1"' zsh \
        "$TM_BUILD/completion/zsh/_polylla3d" >specs
    grep -qxF -e '--absorb[those of a few tetrahedra join others beside them]' specs
    grep -qF -e ':MODE:(terminal edge face terminal-face cavity compact)' specs
}
