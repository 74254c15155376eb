# SPDX-License-Identifier: MIT
# Configures, builds and runs consumer_c/ against an install tree.
# CONSUMER, EMBED_SOURCE, PREFIX, BUILD (emptied first), BUILD_TYPE, CC, GENERATOR, REQUIRE_DEVICE.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
file(REMOVE_RECURSE "${BUILD}")
step("${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${BUILD}" -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}"
     "-DCMAKE_C_COMPILER=${CC}" "-DCMAKE_PREFIX_PATH=${PREFIX}" "-DEMBED_SOURCE=${EMBED_SOURCE}")
step("${CMAKE_COMMAND}" --build "${BUILD}")
run_program("${BUILD}/embed" "${embed_c_prints}")
run_program("${BUILD}/beside_volk" "^default method query-any\n$")
run_program("${BUILD}/beside_loader" "^default method query-any\n$")
