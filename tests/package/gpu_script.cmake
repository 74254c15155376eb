# SPDX-License-Identifier: MIT
# scripts/gpu.sh with programs that stand in for the real ones: one step hangs, one fails; of the suites of tests one hangs
# and cannot be asked to end, one has no tests, one dies where the validation layer is on. All others are done, and the summary says so. SOURCE, WORK.
cmake_minimum_required(VERSION 3.22)

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
file(WRITE "${WORK}/voxtact" [=[#!/bin/sh
for last; do out=$last; done
case "$*" in
--version) echo 'voxtact 1.2.3 "of a test"' ;;
devices*) echo '{"rows": [{"name": "GPU", "type": "discrete", "default": 1}]}' >"$out" ;;
*--certified*) sleep 100 ;;
*--paper*) echo 'methods disagree: "query" \\ atomic' >&2; exit 3 ;;
*) echo '{"rows": []}' >"$out" ;;
esac
]=])
file(WRITE "${WORK}/tests" [=[#!/bin/sh
case "$*" in
*DrillTest*--no-validation* | *--no-validation*DrillTest*) ;;
*DrillTest*) kill -SEGV $$ ;;
*EditTest*) exit 1 ;;
*HostAgreementTest*) trap '' TERM; while :; do sleep 1; done ;;
*BricksTest*) none=1 ;;
esac
for argument; do
    case $argument in --gtest_output=json:*) printf '{\n  "tests": %d\n}\n' "$((none ? 0 : 3))" >"${argument#*json:}" ;; esac
done
]=])
file(CHMOD "${WORK}/voxtact" "${WORK}/tests" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)

function(run_script status said)
  execute_process(COMMAND env "VOXTACT=${WORK}/voxtact" "VOXTACT_GPU_TESTS=${WORK}/tests" VOXTACT_GPU_LIMIT=22
                          "${SOURCE}/scripts/gpu.sh" ${ARGN}
                  RESULT_VARIABLE ended OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT ended EQUAL status OR NOT output MATCHES "${said}")
    message(FATAL_ERROR "gpu.sh ${ARGN} ended with ${ended} instead of ${status}, and said:\n${output}")
  endif()
endfunction()

run_script(1 "certified answers [^\n]*timed out" "${WORK}/out")
run_script(2 "is not empty" "${WORK}/out")
run_script(2 "usage: gpu OUT")

file(READ "${WORK}/out/gpu.json" summary)
function(expect value)
  string(JSON found GET "${summary}" ${ARGN})
  if(NOT found STREQUAL value)
    message(FATAL_ERROR "gpu.json: ${ARGN} is '${found}' instead of '${value}'")
  endif()
endfunction()
expect("voxtact 1.2.3 \"of a test\"" voxtact)
expect(OFF all_done)
expect(GPU devices rows 0 name)
set(wanted "done" "done" "failed with exit status 1" "done" "timed out" "failed with exit status 3" "done")
foreach(number RANGE 6)
  list(GET wanted ${number} status)
  expect("${status}" steps ${number} status)
endforeach()
expect("methods disagree: \"query\" \\ atomic" steps 5 last_line)
expect(batches.json steps 6 file)
file(READ "${WORK}/out/agreement.json" summary)
string(JSON suites LENGTH "${summary}" suites)
math(EXPR last "${suites} - 1")
foreach(number RANGE ${last})
  string(JSON suite GET "${summary}" suites ${number} suite)
  if(suite STREQUAL EditTest)
    expect("failed with exit status 1" suites ${number} status)
  elseif(suite STREQUAL HostAgreementTest)
    expect("timed out" suites ${number} status)
  elseif(suite STREQUAL DrillTest)
    expect("done, without the validation layer" suites ${number} status)
  elseif(suite STREQUAL BricksTest)
    expect("has no tests" suites ${number} status)
  else()
    expect("done" suites ${number} status)
    expect(3 suites ${number} result tests)
  endif()
endforeach()
file(READ "${WORK}/out/log.txt" log)
if(NOT log MATCHES "DrillTest: died of signal 11; once more without the validation layer")
  message(FATAL_ERROR "the log does not tell of the suite that died:\n${log}")
endif()
file(REMOVE_RECURSE "${WORK}")
