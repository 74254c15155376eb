#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the fuzz targets (Clang, libFuzzer, address and undefined-behaviour sanitizers) and runs each of them.
# Usage: fuzz.sh [SECONDS [TARGET...]]. A target starts from tests/fuzz/corpus/TARGET; what it learns is kept in
# build/fuzz/corpus, and an input that breaks it in build/fuzz/found, named in the output.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
seconds=${1:-600}
case "$seconds" in '' | *[!0-9]*) printf 'fuzz: %s is not a number of seconds\n' "$seconds" >&2; exit 2 ;; esac
[ $# -eq 0 ] || shift
build=build/fuzz
[ -f "$build/build.ninja" ] || cmake --preset fuzz >build/fuzz-configure.log
cmake --build --preset fuzz --target voxtact_fuzz >build/fuzz-build.log 2>&1 || {
    tail -n 40 build/fuzz-build.log >&2
    exit 1
}

if [ $# -gt 0 ]; then
    targets=("$@")
else
    targets=()
    for corpus in tests/fuzz/corpus/*/; do targets+=("$(basename "$corpus")"); done
fi
mkdir -p "$build/found" "$build/log"

fuzz_one() {
    local name=$1 program=$build/tests/fuzz/voxtact_fuzz_$1 log=$build/log/$1.txt
    mkdir -p "$build/corpus/$name"
    if [ ! -x "$program" ]; then
        printf '%s: there is no such target\n' "$name" >&2
        return 1
    fi
    # 2 GB and 20 s an input are bounds that every reader must keep.
    if "$program" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
        -artifact_prefix="$build/found/$name-" "$build/corpus/$name" "tests/fuzz/corpus/$name" >"$log" 2>&1; then
        printf '%-12s %s runs\n' "$name" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
    else
        printf '%s: broken; the end of %s:\n' "$name" "$log" >&2
        grep -vE '^(#|stat::|INFO)' "$log" | tail -n 30 >&2
        return 1
    fi
}
export -f fuzz_one
export build seconds
# shellcheck disable=SC2016
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'fuzz_one "$1"' _ {}
