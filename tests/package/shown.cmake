# SPDX-License-Identifier: MIT
# PAGE, EXAMPLE, NAMES. The code block of the page after `<!-- docs/example/EXAMPLE: NAME -->` is, byte for byte and less
# the indentation, what the example has between [NAME] and [/NAME].
cmake_minimum_required(VERSION 3.22)

# between(TEXT BEGIN END OUT): what is between the first BEGIN and the END after it.
function(between text begin end out)
  string(FIND "${text}" "${begin}" from)
  if(from EQUAL -1)
    message(FATAL_ERROR "there is no ${begin}")
  endif()
  string(LENGTH "${begin}" length)
  math(EXPR from "${from} + ${length}")
  string(SUBSTRING "${text}" ${from} -1 rest)
  string(FIND "${rest}" "${end}" to)
  if(to EQUAL -1)
    message(FATAL_ERROR "there is no ${end} after ${begin}")
  endif()
  string(SUBSTRING "${rest}" 0 ${to} rest)
  set(${out} "${rest}" PARENT_SCOPE)
endfunction()

file(READ "${EXAMPLE}" example)
file(READ "${PAGE}" page)
get_filename_component(file "${EXAMPLE}" NAME)
foreach(name ${NAMES})
  between("${example}" "    // [${name}]\n" "    // [/${name}]\n" compiled)
  string(REGEX REPLACE "\n    " "\n" compiled "\n${compiled}")
  between("${page}" "<!-- docs/example/${file}: ${name} -->\n```cpp" "```" shown)
  if(NOT "${shown}" STREQUAL "${compiled}")
    message(FATAL_ERROR "${PAGE} shows\n${shown}\ninstead of what is compiled:\n${compiled}")
  endif()
endforeach()
