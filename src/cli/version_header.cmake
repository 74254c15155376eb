# SPDX-License-Identifier: MIT
# cmake -DSOURCE=checkout -DOUT=version.h -DVERSION=0.1.0 -DGLSLANG=glslangValidator -DGIT=git -P version_header.cmake
# Run at every build, so that the revision is never stale; OUT is touched only when it changes.

set(revision "unknown")
if(GIT)
  execute_process(COMMAND "${GIT}" -C "${SOURCE}" rev-parse --show-toplevel OUTPUT_VARIABLE top ERROR_QUIET
                  OUTPUT_STRIP_TRAILING_WHITESPACE)
  file(REAL_PATH "${SOURCE}" source)
  # A copy without .git inside somebody else's repository must not report that one's revision.
  if("${top}" STREQUAL "${source}")
    execute_process(COMMAND "${GIT}" -C "${SOURCE}" describe --always --dirty --abbrev=12 --exclude=*
                    OUTPUT_VARIABLE described ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(described)
      set(revision "${described}")
    endif()
  endif()
endif()

execute_process(COMMAND "${GLSLANG}" --version OUTPUT_VARIABLE output ERROR_QUIET)
set(glslang "unknown")
if(output MATCHES "Glslang Version: [0-9]+:([^\n]+)")
  set(glslang "${CMAKE_MATCH_1}")
endif()

set(text "#pragma once
namespace voxtact::app {
inline constexpr char kVersion[] = \"${VERSION}\";
inline constexpr char kGitRevision[] = \"${revision}\";
inline constexpr char kGlslangVersion[] = \"${glslang}\";
} // namespace voxtact::app
")
set(old "")
if(EXISTS "${OUT}")
  file(READ "${OUT}" old)
endif()
if(NOT old STREQUAL text)
  file(WRITE "${OUT}" "${text}")
endif()
