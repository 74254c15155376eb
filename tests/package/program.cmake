# SPDX-License-Identifier: MIT
# BUILD: a build tree; STAGE: the prefix, emptied first; EXPECTED: what the installed program's version begins with.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
file(REMOVE_RECURSE "${STAGE}")
step("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${STAGE}" --component voxtact_program)
step("${STAGE}/bin/voxtact" --version)
if(NOT step_output MATCHES "${EXPECTED}")
  message(FATAL_ERROR "${STAGE}/bin/voxtact --version printed\n${step_output}\ninstead of ${EXPECTED}")
endif()
step("${STAGE}/bin/voxtact" info builtin:sphere:16)
