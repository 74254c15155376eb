# SPDX-License-Identifier: MIT
# ABIDW, ABIDIFF, BUILD: a build tree, LIBRARY: what its target voxtact_c_abi makes, with debug information, HEADERS: the
# folder of the public headers, RECORD, WORK: a folder; RENEW: write the record instead of comparing with it.
#
# The record says what a program that was compiled yesterday counts on: functions, structs, enumerations. It holds no
# place, no private type and no name of a compiler, and abi_c.suppr leaves out what is Vulkan's.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
step("${CMAKE_COMMAND}" --build "${BUILD}" --target voxtact_c_abi)
file(MAKE_DIRECTORY "${WORK}")
set(now "${WORK}/voxtact_c.abi")
step("${ABIDW}" --headers-dir "${HEADERS}" --drop-private-types --exported-interfaces-only --no-show-locs
     --no-comp-dir-path --no-corpus-path --no-architecture --no-elf-needed --no-parameter-names --type-id-style hash
     --out-file "${now}" "${LIBRARY}")
if(RENEW)
  # Where the sources lie, or what several were put into to be compiled, is the builder's own.
  file(READ "${now}" text)
  string(REGEX REPLACE " path='[^']*/([^/']*)'" " path='\\1'" text "${text}")
  file(WRITE "${RECORD}" "${text}")
  message(STATUS "${RECORD} is renewed")
  return()
endif()

# compare(WITH RESULT OUTPUT)
function(compare with result output)
  execute_process(COMMAND "${ABIDIFF}" --suppressions "${CMAKE_CURRENT_LIST_DIR}/abi_c.suppr" --no-show-locs
                          --no-architecture --harmless "${with}" "${now}"
                  RESULT_VARIABLE ended OUTPUT_VARIABLE said ERROR_VARIABLE said)
  set(${result} "${ended}" PARENT_SCOPE)
  set(${output} "${said}" PARENT_SCOPE)
endfunction()

compare("${RECORD}" result output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "the binary interface is not what ${RECORD} has (abidiff ended with ${result}):\n${output}\n"
                      "If that is meant: cmake --build ${BUILD} --target voxtact_c_abi_record\n"
                      "Functions, enumerators and last members of structs with a struct_size may be added; anything "
                      "else needs another SOVERSION in src/c/CMakeLists.txt.")
endif()

# This comparison does see structs and enumerations: another name of a member, another number of an enumerator.
file(READ "${RECORD}" text)
foreach(change "name='threshold'/name='limit'" "name='VXT_METHOD_CPU' value='5'/name='VXT_METHOD_CPU' value='6'")
  string(REGEX MATCH "^(.*)/(.*)$" both "${change}")
  string(REPLACE "${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}" other "${text}")
  file(WRITE "${WORK}/other.abi" "${other}")
  compare("${WORK}/other.abi" result output)
  if(NOT result EQUAL 4)
    message(SEND_ERROR "abidiff does not see that ${change} (it ended with ${result}):\n${output}")
  endif()
endforeach()
