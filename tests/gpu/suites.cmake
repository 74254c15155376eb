# SPDX-License-Identifier: MIT
# Writes a ctest entry for each suite of a Google Test program, named PREFIX and the suite: its tests share a device and
# what that has compiled, which takes most of the time on lavapipe. Suites that need the same programs share an entry,
# which is named after all of them.
# PROGRAM, PREFIX, ARGUMENTS (a list), LABEL, TIMEOUT, OUT; TOGETHER: suites that share an entry, with a comma between
# two of them, a list of such.
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
function(add_entry) # SUITE...
  list(JOIN ARGN "+" name)
  # Those of many suites take longest, and begin first.
  list(LENGTH ARGN cost)
  list(TRANSFORM ARGN APPEND ".*" OUTPUT_VARIABLE filter)
  list(JOIN filter ":" filter)
  string(APPEND entries "add_test([=[${PREFIX}${name}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${filter}]=] ${ARGUMENTS})\n"
         "set_tests_properties([=[${PREFIX}${name}]=] PROPERTIES LABELS ${LABEL} TIMEOUT ${TIMEOUT} SKIP_RETURN_CODE 77 COST ${cost}0)\n")
  set(entries "${entries}" PARENT_SCOPE)
endfunction()
foreach(together IN LISTS TOGETHER)
  string(REPLACE "," ";" together "${together}")
  set(some "")
  foreach(suite IN LISTS together)
    if(suite IN_LIST suites)
      list(APPEND some "${suite}")
      list(REMOVE_ITEM suites "${suite}")
    endif()
  endforeach()
  if(some)
    add_entry(${some})
  endif()
endforeach()
foreach(suite IN LISTS suites)
  add_entry(${suite})
endforeach()
file(WRITE "${OUT}" "${entries}")
