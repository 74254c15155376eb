#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What takes too long for every change: the tests under the address and undefined-behaviour sanitizers and under the
# thread sanitizer, every fuzz target for a minute, every mutant, all random cases of the tests, the tests of
# agreement on other software drivers, a copy of the sources with one more counting method, the program with shared
# libraries of ours, and ten minutes of random input to the window. All of it runs, and the status is 1 if any part
# failed.
# Under the thread sanitizer the tiers of the host alone: lavapipe's own threads are not built with it.
set -uo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." || exit 1
failed=()

sanitized() {
    local preset=$1 tiers=$2
    { [ -f "build/$preset/build.ninja" ] || cmake --preset "$preset" >/dev/null; } &&
        cmake --build --preset "$preset" >"build/$preset.log" 2>&1 &&
        ctest --preset "$preset" -j "$(nproc)" -L "$tiers"
}

# lavapipe and the validation layer keep what they have until the end of the process.
ASAN_OPTIONS=${ASAN_OPTIONS:-detect_leaks=0} sanitized asan '^(unit|cpu|io|fuzz|faults|cli|gpu)$' || failed+=(asan)
sanitized tsan '^(unit|cpu|io|fuzz)$' || failed+=(tsan)
scripts/fuzz.sh 60 || failed+=(fuzz)
scripts/mutate.py || failed+=(mutate)
{ VOXTACT_TEST_LONG=1 ctest --preset release -j "$(nproc)" -L '^(cpu|gpu)$'; } || failed+=(long)
scripts/second_drivers.sh build/release/tests/gpu/voxtact_gpu_tests || [ $? -eq 77 ] || failed+=(drivers)
scripts/change.py --build || failed+=(change)
{ cmake -S . -B build/shared -G Ninja -DBUILD_SHARED_LIBS=ON -DVOXTACT_BUILD_TESTS=OFF >/dev/null &&
    cmake --build build/shared >build/shared.log 2>&1 && build/shared/voxtact info builtin:head >/dev/null; } ||
    failed+=(shared)
if [ -x build/release/voxtact ]; then # the window: ten minutes of random input under validation
    python3 -B tests/view/window/soak.py build/release/voxtact soak 600 || failed+=(soak)
fi

if [ ${#failed[@]} -gt 0 ]; then
    printf 'deep: failed: %s\n' "${failed[*]}" >&2
    exit 1
fi
