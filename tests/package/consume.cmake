# SPDX-License-Identifier: MIT
# Configures, builds and runs consumer/ against an install tree.
# CONSUMER, EMBED_SOURCE, PREFIX, BUILD (emptied first), BUILD_TYPE, CXX, CXX_FLAGS, GENERATOR, REQUIRE_DEVICE;
# COMPONENTS: what to ask find_package for; EXPECT_REFUSAL: configuring must fail with this text.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
file(REMOVE_RECURSE "${BUILD}")
set(configure
    "${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${BUILD}" -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DCMAKE_PREFIX_PATH=${PREFIX}"
    "-DEMBED_SOURCE=${EMBED_SOURCE}" "-DCONSUMER_COMPONENTS=${COMPONENTS}")
if(EXPECT_REFUSAL)
  execute_process(COMMAND ${configure} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  # CMake breaks its lines.
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(result EQUAL 0 OR NOT output MATCHES "${EXPECT_REFUSAL}")
    message(FATAL_ERROR "configuring ended with ${result} and said\n${output}\ninstead of '${EXPECT_REFUSAL}'")
  endif()
  return()
endif()
step(${configure})
# The package must be the one in PREFIX.
file(STRINGS "${BUILD}/CMakeCache.txt" found REGEX "^voxtact_DIR:PATH=")
string(FIND "${found}" "voxtact_DIR:PATH=${PREFIX}/" at)
if(NOT at EQUAL 0)
  message(FATAL_ERROR "another package was found: ${found}")
endif()
step("${CMAKE_COMMAND}" --build "${BUILD}")
if(COMPONENTS STREQUAL "io")
  run_program("${BUILD}/reader" "^512 voxels, 4 triangles\n$")
elseif(COMPONENTS STREQUAL "samples")
  run_program("${BUILD}/sampler" "^4096 voxels, 3068 triangles\n$")
elseif(COMPONENTS STREQUAL "render")
  run_program("${BUILD}/painter" "^step 0.5 mm, linked\n$")
else()
  run_consumers("${BUILD}")
endif()
