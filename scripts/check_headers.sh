#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Each public header compiles alone, without warnings.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

check() {
    printf '#include "%s"\n' "$1" |
        "${C| bash -c:-c++}" -std=c++20 -fsyntax-only -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast -Werror \
            -Iinclude -x c++ - || {
        printf '%s does not compile alone\n' "$1" >&2
        return 1
    }
}
export -f check
# shellcheck disable=SC2016
(cd include && find voxtact -name '*.h') | sort | xargs -P "$(nproc)" -I{} bash -c 'check "$1"' _ {}
