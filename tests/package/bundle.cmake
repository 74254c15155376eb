# SPDX-License-Identifier: MIT
# The bundle: all that it needs is there, it runs from another folder without anything of the environment, and a library
# that is missing or a path that leads out of it is found. SOURCE, BUILD, WORK.
cmake_minimum_required(VERSION 3.22)
include("${CMAKE_CURRENT_LIST_DIR}/step.cmake")

file(REMOVE_RECURSE "${WORK}")
# A list of libraries that is longer than a pipe holds: bundle.sh reads it to its end, or ldconfig dies by SIGPIPE.
file(WRITE "${WORK}/bin/ldconfig" "#!/bin/sh
/sbin/ldconfig \"$@\"
exec /usr/bin/seq -f 'libnothing.so.%.0f (libc6,x86-64) => /nowhere' 20000
")
file(CHMOD "${WORK}/bin/ldconfig" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
step("${CMAKE_COMMAND}" -E env "PATH=${WORK}/bin:$ENV{PATH}" "${SOURCE}/scripts/bundle.sh" "${BUILD}" "${WORK}/made")
file(GLOB made LIST_DIRECTORIES true "${WORK}/made/voxtact-*")
list(FILTER made EXCLUDE REGEX "[.]tar[.]gz$")
set(folder "${WORK}/another place")
file(RENAME "${made}" "${folder}")

foreach(command "--version" "touch;--volume;builtin:head:16;--mesh;builtin:scalpel:100;--format;csv")
  step(env -i "${folder}/voxtact" ${command})
endforeach()
step(env -i "${folder}/tests" lab --gtest_filter=QuantileTest.*)

# What the check is for.
function(expect_complaint text)
  execute_process(COMMAND "${SOURCE}/scripts/bundle/check.sh" "${folder}" RESULT_VARIABLE status ERROR_VARIABLE said)
  if(status EQUAL 0 OR NOT said MATCHES "${text}")
    message(FATAL_ERROR "the check should say '${text}'; it ends with ${status} and says: ${said}")
  endif()
endfunction()
step("${SOURCE}/scripts/bundle/check.sh" "${folder}")
file(RENAME "${folder}/lib/libhwy.so.1" "${WORK}/libhwy.so.1")
expect_complaint("libexec/voxtact needs libhwy.so.1, which is not there")
file(RENAME "${WORK}/libhwy.so.1" "${folder}/lib/libhwy.so.1")
step(patchelf --set-rpath "/opt/lib:$ORIGIN/../lib" "${folder}/libexec/voxtact")
expect_complaint("libexec/voxtact looks for libraries in '/opt/lib'")
step(patchelf --set-rpath "$ORIGIN/../lib:" "${folder}/libexec/voxtact")
expect_complaint("libexec/voxtact looks for libraries in ''")
step(patchelf --set-rpath "$ORIGIN/../lib" "${folder}/libexec/voxtact")
file(RENAME "${folder}/share/licences/voxtact.txt" "${WORK}/voxtact.txt")
expect_complaint("voxtact.txt is not there")
file(REMOVE_RECURSE "${WORK}")
