# SPDX-License-Identifier: MIT
# cmake -DSPIRV_OPT=spirv-opt -DSPV=in_out.spv -P optimize_spirv.cmake
# Of a compute shader. One function, values instead of variables, nothing that has no use: a driver makes a pipeline of that in a third to a
# half of the time. No arithmetic is folded, so each operation rounds as it is written. Without merge-return, which
# costs 2 to 5 % of the run time on llvmpipe, functions with a return in the middle stay; spirv-opt warns of each.
set(passes
    inline-entry-points-exhaustive eliminate-dead-functions private-to-local
    eliminate-local-single-block eliminate-local-single-store eliminate-dead-code-aggressive
    scalar-replacement=100 convert-local-access-chains
    eliminate-local-single-block eliminate-local-single-store eliminate-dead-code-aggressive
    ssa-rewrite eliminate-dead-code-aggressive vector-dce merge-blocks)
list(TRANSFORM passes PREPEND --)
execute_process(COMMAND "${SPIRV_OPT}" ${passes} "${SPV}" -o "${SPV}" RESULT_VARIABLE result ERROR_VARIABLE messages)
if(NOT result EQUAL 0)
  file(REMOVE "${SPV}")
  message(FATAL_ERROR "spirv-opt ${SPV}: ${result}\n${messages}")
endif()
