# SPDX-License-Identifier: MIT
# README, EXAMPLE. The code block of the README after `<!-- docs/example/embed.cpp -->` is, byte for byte and less the
# indentation, what the example has between [readme] and [/readme].
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
between("${example}" "    // [readme]\n" "    // [/readme]\n" compiled)
string(REGEX REPLACE "\n    " "\n" compiled "\n${compiled}")
file(READ "${README}" readme)
between("${readme}" "<!-- docs/example/embed.cpp -->\n```cpp" "```" shown)
if(NOT "${shown}" STREQUAL "${compiled}")
  message(FATAL_ERROR "the README shows\n${shown}\ninstead of what is compiled:\n${compiled}")
endif()
