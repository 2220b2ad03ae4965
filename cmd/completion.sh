#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the completion of a filter for bash and zsh: completion.sh FILTER FOLDER makes
# FOLDER/bash/NAME and FOLDER/zsh/_NAME. Options and their words are from the tables in
# the filter, which it prints itself (cmd/common/app/completion.h); what --help says of an
# option is what zsh shows beside it. Used by make.
set -eu
filter=$1
folder=$2
name=${filter##*/}
mkdir -p "$folder/bash" "$folder/zsh"
options=$("$filter" --completion)
help=$("$filter" --help)

# bash: the words of the option before, else files, which "-o default" completes.
printf '%s\n' "$options" | awk -v name="$name" '
    {
        option = ($1 == "-" ? "" : "-" $1 " ") "--" $2
        all = all " " option
        if ($3 != "required")
            next
        gsub(/ /, " | ", option)
        words = $0
        sub(/^[^ ]+ [^ ]+ [^ ]+ ?/, "", words)
        if (words == "")
            files = files (files == "" ? "" : " | ") option
        else
            cases = cases "    " option ")\n        words=\"" words "\" ;;\n"
    }
    END {
        function_name = "_termesh_" name
        gsub(/-/, "_", function_name)
        print "# bash completion for " name ", made by cmd/completion.sh of termesh"
        print function_name "()\n{"
        print "    local word=${COMP_WORDS[COMP_CWORD]} words="
        print "    local before=${COMP_WORDS[COMP_CWORD - 1]}"
        print "    # --option=word is three words for readline"
        print "    if [[ $word == = ]]; then"
        print "        word="
        print "    elif [[ $before == = ]]; then"
        print "        before=${COMP_WORDS[COMP_CWORD - 2]}"
        print "    fi"
        print "    case $before in"
        printf "%s", cases
        print "    " files ") ;;"
        print "    *)\n        [[ $word != -* ]] || words=\"" substr(all, 2) "\" ;;"
        print "    esac"
        print "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))"
        print "}\ncomplete -o default -F " function_name " " name
    }' >"$folder/bash/$name"

# zsh: the same for _arguments, with the argument and the line of --help.
printf '%s\n--\n%s\n' "$help" "$options" | awk -v name="$name" '
    !tables && $0 == "--" { tables = 1; next }
    # Of the help: "  -a, --all L         octants of level L everywhere".
    !tables && match($0, /^  (-.,|   ) --[a-z0-9-]+/) {
        long = substr($0, 7, RLENGTH - 6)
        rest = substr($0, RLENGTH + 1)
        if (match(rest, /^(\[=| )[A-Z]+(\.[a-z]+)?\]?( [A-Z] )?/)) {
            argument[long] = substr(rest, 1, RLENGTH)
            gsub(/[][=]|^ | $/, "", argument[long])
            rest = substr(rest, RLENGTH + 1)
        }
        sub(/^ +/, "", rest)
        text[long] = rest
        next
    }
    !tables {
        if (long != "" && text[long] == "") {
            text[long] = $0
            sub(/^ +/, "", text[long])
        }
        next
    }
    {
        long = "--" $2
        words = $0
        sub(/^[^ ]+ [^ ]+ [^ ]+ ?/, "", words)
        what = text[long]
        gsub(/[][\\:]/, "\\\\&", what)
        gsub(/\047/, "\047\\\047\047", what)
        of = argument[long] == "" ? " " : argument[long]
        of = ($3 == "optional" ? "::" : ":") of ":" (words == "" ? "_files" : "(" words ")")
        short = $1 == "-" ? "" : "-" $1
        if ($3 == "none") {
            of = ""
            before = short == "" ? "" : "(" short " " long ")"
        } else {
            before = "*"
            short = short == "" ? "" : short ($3 == "required" ? "+" : "-")
            long = long ($3 == "required" ? "=" : "=-")
        }
        if (short == "")
            spec = "\047" before long "[" what "]" of "\047"
        else
            spec = "\047" before "\047{" short "," long "}\047[" what "]" of "\047"
        specs = specs " \\\n    " spec
    }
    END {
        print "#compdef " name
        print "# made by cmd/completion.sh of termesh"
        print "_arguments -s -S" specs " \\\n    \047*:file:_files\047"
    }' >"$folder/zsh/_$name"
