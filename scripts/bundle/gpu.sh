#!/bin/sh
# SPDX-License-Identifier: MIT
# Everything that a GPU should be asked: gpu OUT
here=$(dirname "$(readlink -f "$0")")
. "$here/libexec/environment.sh"
VOXTACT=$here/libexec/voxtact
VOXTACT_GPU_TESTS=$here/libexec/voxtact_gpu_tests
VOXTACT_TEST_HEAD=$here/share/data/ch2.nii.gz
VK_LAYER_PATH=$here/share/vulkan/explicit_layer.d${VK_LAYER_PATH:+:$VK_LAYER_PATH}
export VOXTACT VOXTACT_GPU_TESTS VOXTACT_TEST_HEAD VK_LAYER_PATH
exec "$here/libexec/gpu.sh" "$@"
