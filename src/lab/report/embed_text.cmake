# SPDX-License-Identifier: MIT
# cmake -DOUT=assets.cpp "-DTEXTS=kName=path;..." -P embed_text.cmake
# Writes the files as string literals of these names; a path that is empty gives an empty text.

function(append_text name path)
  set(text "")
  if(path)
    file(READ "${path}" text)
  endif()
  string(FIND "${text}" ")voxtact\"" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${path} holds the end of a raw string")
  endif()
  file(APPEND "${OUT}" "const std::string_view ${name} = R\"voxtact(${text})voxtact\";\n")
endfunction()

file(WRITE "${OUT}" "#include \"lab/report/report_assets.h\"\n\nnamespace voxtact::lab {\n\n")
foreach(text IN LISTS TEXTS)
  string(REGEX MATCH "^([A-Za-z]+)=(.*)$" matched "${text}")
  append_text("${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}")
endforeach()
file(APPEND "${OUT}" "\n} // namespace voxtact::lab\n")
