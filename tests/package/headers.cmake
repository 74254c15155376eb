# SPDX-License-Identifier: MIT
# CXX, SOURCE, INCLUDE (folders of the Vulkan headers, with colons between them), BUILD.
# Each public header compiles alone, and twice in one file.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")
file(GLOB headers RELATIVE "${SOURCE}/include" "${SOURCE}/include/voxtact/*.h")
list(LENGTH headers count)
if(count EQUAL 0)
  message(FATAL_ERROR "no headers in ${SOURCE}/include/voxtact")
endif()
string(REPLACE ":" ";" include "${INCLUDE}")
list(TRANSFORM include PREPEND -I)
foreach(header ${headers})
  string(MAKE_C_IDENTIFIER "${header}" name)
  file(WRITE "${BUILD}/${name}.cpp" "#include \"${header}\"\n#include \"${header}\"\n")
  step("${CXX}" -std=c++20 -Wall -Wextra -Wpedantic -Werror -fsyntax-only "-I${SOURCE}/include" ${include}
       "${BUILD}/${name}.cpp")
endforeach()
