# SPDX-License-Identifier: MIT
# Writes a ctest entry for each suite of a Google Test program, named PREFIX and the suite: its tests share a device and
# what that has compiled, which takes most of the time on lavapipe.
# PROGRAM, PREFIX, ARGUMENTS (a list), LABEL, TIMEOUT, OUT.
cmake_minimum_required(VERSION 3.22)
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" lines "${listed}")
set(suites "")
foreach(line IN LISTS lines)
  if(line MATCHES "^([A-Za-z0-9_/]+)\\.")
    list(APPEND suites "${CMAKE_MATCH_1}")
  endif()
endforeach()
set(entries "")
foreach(suite IN LISTS suites)
  string(APPEND entries "add_test([=[${PREFIX}${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=] ${ARGUMENTS})\n"
         "set_tests_properties([=[${PREFIX}${suite}]=] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT} SKIP_RETURN_CODE 77)\n")
endforeach()
file(WRITE "${OUT}" "${entries}")
