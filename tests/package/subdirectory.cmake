# SPDX-License-Identifier: MIT
# Configures, builds and runs consumer/ with voxtact as a subdirectory of it.
# CONSUMER, EMBED_SOURCE, SOURCE, BUILD (kept), SHARED, BUILD_TYPE, CXX, CXX_FLAGS, GENERATOR, REQUIRE_DEVICE, OUTER (the
# build that this test is of), LAUNCHER (ccache, perhaps none).
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
set(configure
    "${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${BUILD}" -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${BUILD_TYPE}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" "-DEMBED_SOURCE=${EMBED_SOURCE}"
    "-DVOXTACT_SOURCE=${SOURCE}" "-DBUILD_SHARED_LIBS=${SHARED}")

# Not at the top level, everything beside the library is off.
file(REMOVE "${BUILD}/CMakeCache.txt")
step(${configure})
file(STRINGS "${BUILD}/CMakeCache.txt" options REGEX "^VOXTACT_[A-Z_]+:BOOL=")
foreach(option VOXTACT_BUILD_CPU VOXTACT_BUILD_IO VOXTACT_BUILD_RENDER VOXTACT_BUILD_SAMPLES VOXTACT_INSTALL VOXTACT_WARNINGS_AS_ERRORS)
  if(NOT "${option}:BOOL=OFF" IN_LIST options)
    message(FATAL_ERROR "${option} is not off by default in a subdirectory: ${options}")
  endif()
endforeach()
if(options MATCHES "VOXTACT_BUILD_(APP|TESTS|C):BOOL=ON")
  message(FATAL_ERROR "the program, the tests or the C interface are on by default in a subdirectory: ${options}")
endif()

set(launcher "")
if(LAUNCHER)
  set(launcher "${BUILD}/launch.sh")
  set(nested "${BUILD}/voxtact")
  configure_file("${CMAKE_CURRENT_LIST_DIR}/launch.sh.in" "${launcher}" @ONLY
                 FILE_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
endif()

# The consumer's -Werror is not for voxtact, which has its own here. And a shared voxtact may leave no symbol open. The
# install rules and the other libraries are for the tests that come after.
step(${configure} "-DCMAKE_CXX_COMPILER_LAUNCHER=${launcher}" -DVOXTACT_WARNINGS_AS_ERRORS=ON -DVOXTACT_INSTALL=ON
     -DVOXTACT_BUILD_CPU=ON -DVOXTACT_BUILD_IO=ON -DVOXTACT_BUILD_RENDER=ON -DVOXTACT_BUILD_SAMPLES=ON -DVOXTACT_BUILD_C=ON
     -DCMAKE_SHARED_LINKER_FLAGS=-Wl,--no-undefined)
step("${CMAKE_COMMAND}" --build "${BUILD}")
run_consumers("${BUILD}")
run_program("${BUILD}/embed_c" "${embed_c_prints}")
