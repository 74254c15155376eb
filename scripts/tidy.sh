#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# clang-tidy on every .cpp of src/ that the build compiles, one process a core. Usage: tidy.sh BUILD_FOLDER
# [FILE|FOLDER...]. A file that passed is looked at again only when it, a header of ours or the checks have changed.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
build=${1:?usage: tidy.sh BUILD_FOLDER [FILE...]}
shift
stamps=$build/tidy
mkdir -p "$stamps"

[ $# -gt 0 ] || set -- src
files=$(find "$@" -name '*.cpp' | sort)
newest=$(find src tests include shaders .clang-tidy -name '*.h' -printf '%T@\n' -o -name .clang-tidy -printf '%T@\n' |
    sort -n | tail -n 1)

tidy() {
    local file=$1 stamp
    stamp=$stamps/${file//\//_}
    # Examples of outside consumers are built by the tests, not by this build.
    grep -qF "\"file\": \"$PWD/$file\"" "$build/compile_commands.json" || return 0
    if [ -f "$stamp" ] && [ "$stamp" -nt "$file" ] && [ "$(cat "$stamp")" = "$newest" ]; then
        return 0
    fi
    # The count of warnings in other people's headers goes to standard error: of no interest unless it fails.
    if ! clang-tidy --quiet -p "$build" "$file" 2>"$stamp.err"; then
        cat "$stamp.err" >&2
        return 1
    fi
    rm -f "$stamp.err"
    printf '%s' "$newest" >"$stamp"
}
export -f tidy
export build stamps newest
# shellcheck disable=SC2016
printf '%s\n' "$files" | xargs -P "$(nproc)" -I{} bash -c 'tidy "$1"' _ {}
