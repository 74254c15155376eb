# SPDX-License-Identifier: MIT
# COMPILER, LANGUAGE (c or c++), STANDARDS (with commas between them; one that the compiler does not know is left out),
# SOURCE, INCLUDE (folders of the Vulkan headers, with colons between them), BUILD.
# The headers of the C interface, each alone and twice in one file, in each language that they are for.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
string(REPLACE ":" ";" include "${INCLUDE}")
list(TRANSFORM include PREPEND -isystem)
string(REPLACE "," ";" standards "${STANDARDS}")
file(GLOB headers RELATIVE "${SOURCE}/include/voxtact" "${SOURCE}/include/voxtact/voxtact*.h")
list(LENGTH headers count)
if(count LESS 2)
  message(FATAL_ERROR "the headers of the C interface are not in ${SOURCE}/include/voxtact: ${headers}")
endif()
set(compiled 0)
file(WRITE "${BUILD}/empty.c" "typedef int nothing;\n")
foreach(standard ${standards})
  execute_process(COMMAND "${COMPILER}" -x ${LANGUAGE} -std=${standard} -fsyntax-only "${BUILD}/empty.c"
                  RESULT_VARIABLE unknown ERROR_QUIET)
  if(NOT unknown EQUAL 0)
    message(STATUS "${COMPILER} does not know ${standard}")
    continue()
  endif()
  foreach(header ${headers})
    file(WRITE "${BUILD}/${header}.c" "#include \"voxtact/${header}\"\n#include \"voxtact/${header}\"\n")
    step("${COMPILER}" -x ${LANGUAGE} -std=${standard} -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror
         -fsyntax-only "-I${SOURCE}/include" ${include} "${BUILD}/${header}.c")
    math(EXPR compiled "${compiled} + 1")
  endforeach()
endforeach()
if(compiled EQUAL 0)
  message(FATAL_ERROR "${COMPILER} knows none of ${STANDARDS}")
endif()
# The host half is without Vulkan: no folder of its headers, and none of its names.
step("${COMPILER}" -x ${LANGUAGE} -E "-I${SOURCE}/include" "${BUILD}/voxtact.h.c")
if(step_output MATCHES "vulkan/|VkDevice")
  message(FATAL_ERROR "voxtact.h includes Vulkan")
endif()
