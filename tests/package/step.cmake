# SPDX-License-Identifier: MIT
# For the scripts of this folder.

# step(COMMAND...): runs it and fails with its output when it fails; `step_output` is what it wrote.
macro(step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE step_result OUTPUT_VARIABLE step_output ERROR_VARIABLE step_output)
  if(NOT step_result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${step_result}:\n${step_output}")
  endif()
endmacro()

# run_program(PATH EXPECTED): it must end with 0 and print EXPECTED (a regular expression). 77 says that there is no
# device, which skips the test unless REQUIRE_DEVICE.
macro(run_program path expected)
  get_filename_component(program_folder "${path}" DIRECTORY)
  execute_process(COMMAND "${path}" WORKING_DIRECTORY "${program_folder}" RESULT_VARIABLE program_result
                  OUTPUT_VARIABLE program_output ERROR_VARIABLE program_errors)
  if(program_result EQUAL 77 AND NOT REQUIRE_DEVICE)
    message("SKIPPED: ${path}: ${program_output}${program_errors}")
    return()
  endif()
  if(NOT program_result EQUAL 0 OR NOT program_output MATCHES "${expected}")
    message(FATAL_ERROR "${path} ended with ${program_result} and printed\n${program_output}${program_errors}\n"
                        "instead of ${expected}")
  endif()
  message(STATUS "${path}: ${program_output}")
endmacro()

# What the examples print: of 4 mm of the plate, 32 pixels, 24 are in the opaque half.
set(embed_prints "^certified: touch\nwrapped: 1024 fragments, method query\n$")
set(embed_c_prints
    "^touch 1, 768 fragments, method cpu\ndistance 0 to 0 mm\ntouch 1, 768 fragments, method query\n$")

# run_consumers(FOLDER): the programs of consumer/ that need nothing but the library.
macro(run_consumers folder)
  run_program("${folder}/embed" "${embed_prints}")
  run_program("${folder}/beside_volk" "^default method query-any\n$")
  run_program("${folder}/beside_loader" "^default method query-any\n$")
endmacro()
