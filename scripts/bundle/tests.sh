#!/bin/sh
# SPDX-License-Identifier: MIT
# The tests: tests TIER [ARGUMENTS of GoogleTest]; without a tier all those that need no device.
here=$(dirname "$(readlink -f "$0")")
. "$here/libexec/environment.sh"
VOXTACT_TEST_HEAD=$here/share/data/ch2.nii.gz
VK_LAYER_PATH=$here/share/vulkan/explicit_layer.d${VK_LAYER_PATH:+:$VK_LAYER_PATH}
export VOXTACT_TEST_HEAD VK_LAYER_PATH
if [ $# -gt 0 ]; then
    tier=$1
    shift
    if [ ! -x "$here/libexec/voxtact_${tier}_tests" ]; then
        printf 'tests: no such tier: %s; there are:' "$tier" >&2
        for program in "$here"/libexec/voxtact_*_tests; do
            name=${program##*/voxtact_}
            printf ' %s' "${name%_tests}" >&2
        done
        printf '\n' >&2
        exit 2
    fi
    exec "$here/libexec/voxtact_${tier}_tests" "$@"
fi
status=0
for tier in unit cpu lab c; do
    printf '== %s\n' "$tier"
    "$here/libexec/voxtact_${tier}_tests" --gtest_brief=1 || status=1
done
exit $status
