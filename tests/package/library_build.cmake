# SPDX-License-Identifier: MIT
# The manual's build of the library alone: it configures without the packages that the manual does not name for it, and is
# optimised. SOURCE, BUILD, CXX, GENERATOR.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")

function(configure options)
  file(REMOVE_RECURSE "${BUILD}")
  step("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${BUILD}" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${CXX}" ${options} ${ARGN})
  file(STRINGS "${BUILD}/CMakeCache.txt" type REGEX "^CMAKE_BUILD_TYPE:")
  if(NOT type MATCHES "=Release$")
    message(FATAL_ERROR "without a build type the library is not optimised: ${type}")
  endif()
endfunction()

file(READ "${SOURCE}/docs/index.md" manual)
set(options -DVOXTACT_BUILD_IO=OFF -DVOXTACT_BUILD_CPU=OFF)
string(JOIN " " written ${options})
if(NOT manual MATCHES "cmake -S . -B build/library ${written}\n")
  message(FATAL_ERROR "docs/index.md builds the library with other options than ${written}")
endif()
set(without "")
foreach(package ITK nlohmann_json PNG ZLIB CLI11 GTest hwy fcl octomap)
  list(APPEND without "-DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON")
endforeach()
configure("${options}" ${without})

# With the host engine, Highway as well.
list(REMOVE_ITEM without -DCMAKE_DISABLE_FIND_PACKAGE_hwy=ON)
configure(-DVOXTACT_BUILD_IO=OFF ${without})
