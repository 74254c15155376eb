# SPDX-License-Identifier: MIT
# PKG_CONFIG, STAGE: an install tree, PACKAGE: voxtact or voxtact_c, COMPILER, FLAGS (with commas between them), SOURCE:
# one of the examples, BUILD, REQUIRE_DEVICE; ALSO: another package, of the machine, that the example needs; PRINTS: what
# it then prints, with | for the ends of lines.
# What pkg-config says is enough to compile, link and run a program, wherever the install tree lies.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
file(REMOVE_RECURSE "${BUILD}")
file(MAKE_DIRECTORY "${BUILD}")
file(COPY "${STAGE}/" DESTINATION "${BUILD}/moved")
file(GLOB_RECURSE package "${BUILD}/moved/${PACKAGE}.pc")
get_filename_component(folder "${package}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${folder}")
step("${PKG_CONFIG}" --cflags --libs "${PACKAGE}" ${ALSO})
string(STRIP "${step_output}" flags)
separate_arguments(flags UNIX_COMMAND "${flags}")
string(REPLACE "," ";" own "${FLAGS}")
step("${COMPILER}" ${own} -Wall -Wextra -Wpedantic -Werror "${SOURCE}" -o "${BUILD}/program" ${flags} -ldl
     "-Wl,-rpath,${folder}/..")
if(PRINTS)
  string(REPLACE "|" "\n" prints "${PRINTS}")
  run_program("${BUILD}/program" "^${prints}$")
elseif(PACKAGE STREQUAL "voxtact_c")
  run_program("${BUILD}/program" "${embed_c_prints}")
else()
  run_program("${BUILD}/program" "${embed_prints}")
endif()
