# SPDX-License-Identifier: GPL-3.0-or-later
# The library as another project meets it: installed headers in C and in C++, what it
# exports, the example programs by pkg-config.
# shellcheck disable=SC2046,SC2086 # words of pkg-config and of flags

bats_require_minimum_version 1.5.0

setup_file() {
    root=$(cd "$BATS_TEST_DIRNAME/../.." && pwd)
    case ${TM_BUILD:?} in */san | */coverage) return ;; esac
    make -s -C "$root" BUILD="$TM_BUILD" PREFIX="$BATS_FILE_TMPDIR/usr" install
    PKG_CONFIG_PATH=$BATS_FILE_TMPDIR/usr/lib/pkgconfig
    LD_LIBRARY_PATH=$BATS_FILE_TMPDIR/usr/lib
    headers=$BATS_FILE_TMPDIR/usr/include/termesh
    export root headers PKG_CONFIG_PATH LD_LIBRARY_PATH
}

setup() {
    case ${TM_BUILD:?} in */san | */coverage) skip "the library is not as it is installed" ;; esac
    command -v pkg-config >/dev/null || skip "there is no pkg-config"
    cd "$BATS_TEST_TMPDIR" || exit
}

strict="-Wall -Wextra -Wshadow -Werror -pedantic"

# The installed headers, in the order of their names.
all_headers() {
    (cd "$headers/.." && find termesh -name '*.h' | sort)
}

@test "all headers of the tree stand in one file, those of one folder too" {
    (cd "$root" && find lib -name '*.h' -not -path '*/generate/*') |
        sed 's|.*|#include "&"|' >all.c
    cc -std=c17 -D_GNU_SOURCE $strict -I"$root" -I"$TM_BUILD/generated" -fsyntax-only all.c
}

@test "all installed headers in one file, as C and as C++, compile and link" {
    all_headers | sed 's|.*|#include <&>|' >all.c
    echo 'int main(void) { return tm_percent(1, 2) != 50; }' >>all.c
    cp all.c all.cc
    cc -std=c17 $strict -o all-c all.c $(pkg-config --cflags --libs termesh)
    c++ -std=c++17 $strict -o all-cc all.cc $(pkg-config --cflags --libs termesh)
    ./all-c
    ./all-cc
}

@test "all functions of the installed headers link, from C and from C++" {
    nm --defined-only -D "$LD_LIBRARY_PATH/libtermesh.so" |
        awk '$2 == "T" { print $3 }' | sort >exported
    all_headers | (cd "$headers/.." && xargs cat) | cc -fpreprocessed -E -P - |
        grep -o 'tm_[a-z0-9_]*(' | tr -d '(' | sort -u | comm -12 exported - >functions
    [ "$(wc -l <functions)" -gt 300 ]
    { all_headers | sed 's|.*|#include <&>|'
        echo 'typedef void function(void);'
        echo 'extern function *const functions[];'
        echo 'function *const functions[] = {'
        sed 's/.*/    (function *)&,/' functions
        echo '}; int main(void) { return functions[0] == 0; }'
    } >all.c
    cp all.c all.cc
    cc -std=c17 -o all-c all.c $(pkg-config --cflags --libs termesh)
    c++ -std=c++17 -o all-cc all.cc $(pkg-config --cflags --libs termesh)
}

@test "every installed header stands alone, as C and as C++" {
    all_headers >list
    [ "$(wc -l <list)" -gt 50 ]
    while read -r header; do
        printf '#include <%s>\nint one;\n' "$header" >one.c
        cc -std=c11 $strict -I"$headers/.." -fsyntax-only one.c
        c++ -std=c++17 $strict -I"$headers/.." -fsyntax-only -x c++ one.c
    done <list
}

@test "filters use installed headers only, and these no others" {
    (cd "$headers" && find . -name '*.h' | sed 's|^\./||' | sort) >installed
    for file in "$root"/cmd/*.c "$root"/cmd/*/*.c "$root"/cmd/common/*/*.[ch]; do
        sed -n 's|^#include "\(\.\./\)*lib/\([^"]*\)"|\2|p' "$file"
    done | sort -u >used
    run -0 comm -13 installed used
    [ "$output" = "" ]
    (cd "$headers" && while read -r header; do
        cd "$headers/$(dirname "$header")"
        sed -n 's|^#include "\([^"]*\)"|\1|p' "$(basename "$header")" | while read -r other; do
            [ -f "$other" ] || echo "$header includes $other"
        done
    done <"$BATS_TEST_TMPDIR/installed") >missing
    [ ! -s missing ]
}

@test "libtermesh exports names that begin with tm_ and no others" {
    run -0 nm --defined-only -g "$TM_BUILD/libtermesh.a"
    [ "$(awk 'NF == 3 && $3 !~ /^tm_/' <<<"$output")" = "" ]
    run -0 nm --defined-only -D "$LD_LIBRARY_PATH/libtermesh.so"
    [ "$(awk 'NF == 3 && $3 !~ /^tm_/' <<<"$output")" = "" ]
    [ "$(awk '$3 == "tm_stream_read"' <<<"$output")" != "" ]
}

@test "the version is the same in the header, in pkg-config and in the filters" {
    printf '#include <termesh/termesh.h>\n%s\n' \
        'TM_VERSION TM_VERSION_MAJOR.TM_VERSION_MINOR.TM_VERSION_PATCH' >version.c
    cc -E -P $(pkg-config --cflags termesh) version.c | tail -n 1 | tr -d '" ' >words
    version=$(pkg-config --modversion termesh)
    [ "$(cat words)" = "$version$version" ]
    [ "$(tet-stats --version)" = "tet-stats (termesh) $version" ]
}

@test "examples/library.c and library.cc do what lepp-improve does" {
    awk 'BEGIN { srand(4); print "termesh 1\n.node\n300 3 0 0"
        for (i = 1; i <= 300; i++) print i, rand(), rand(), rand(); print ".end" }' >points.tm
    command -v tetgen >/dev/null || skip "there is no tetgen"
    sed -n '/^.node/,/^.end/p' points.tm | sed '1d; $d' >points.node
    tetgen-mesh --no-history points.node >mesh.tm
    lepp-improve -q --no-history mesh.tm >expected.tm
    cc -std=c17 $strict -D_POSIX_C_SOURCE=200809L -o in-c "$root/examples/library.c" \
        $(pkg-config --cflags --libs termesh)
    c++ -std=c++17 $strict -o in-cc "$root/examples/library.cc" \
        $(pkg-config --cflags --libs termesh)
    cc -std=c17 -D_POSIX_C_SOURCE=200809L -o in-c-static "$root/examples/library.c" \
        $(pkg-config --cflags termesh) "$LD_LIBRARY_PATH/libtermesh.a" \
        $(pkg-config --static --libs-only-l termesh | sed 's/-ltermesh//')
    for program in in-c in-cc in-c-static; do
        ./$program <mesh.tm >made.tm 2>said
        cmp expected.tm made.tm
        grep -q '^after: [0-9]* tetrahedra, ' said
    done
    run -3 ./in-cc <points.node
    [[ $output == *"library: "* ]]
}

@test "all that is linked with is of packages that tests/packages.sh installs" {
    command -v dpkg-query >/dev/null || skip "this is not Debian"
    . "$root/tests/packages.sh"
    make -n -B -C "$root" BUILD="$TM_BUILD" all 2>/dev/null | grep -o -e ' -l[^ ]*' |
        sort -u | sed 's/ -l//' >linked
    grep -qx gmp linked
    dpkg-query -W -f='${Package} ${Depends} ${Pre-Depends}\n' |
        sed 's/([^)]*)//g; s/:[a-z0-9]*//g; s/[,|]/ /g' >depends
    awk -v first="$build_packages" '
        { needs[$1] = $0 }
        END {
            for (waiting = split(first, wait); waiting > 0;) {
                package = wait[waiting--]
                if (there[package]++ || !(package in needs))
                    continue
                print package
                for (n = split(needs[package], more); n > 1; n--)
                    wait[++waiting] = more[n]
            }
        }' depends | sort >installed
    while read -r library; do
        { dpkg-query -S "*/lib$library.so" || dpkg-query -S "*/lib$library.a"; } 2>/dev/null |
            sed 's/: .*//; s/, /\n/g' | sed 's/:.*//' | sort -u | comm -12 - installed >owner
        [ -s owner ] || {
            echo "$library"
            false
        }
    done <linked
}
