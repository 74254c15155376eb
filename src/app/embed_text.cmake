# SPDX-License-Identifier: MIT
# cmake -DOUT=assets.cpp -DPAGE=... -DSTYLE=... -DSCRIPT=... -DLIBRARY=... -DLICENCE=... -P embed_text.cmake
# Writes the files as string literals; a path that is empty gives an empty text.

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

file(WRITE "${OUT}" "#include \"app/report_assets.h\"\n\nnamespace voxtact::app {\n\n")
append_text(kReportPage "${PAGE}")
append_text(kReportStyle "${STYLE}")
append_text(kReportScript "${SCRIPT}")
append_text(kChartLibrary "${LIBRARY}")
append_text(kChartLicence "${LICENCE}")
file(APPEND "${OUT}" "\n} // namespace voxtact::app\n")
