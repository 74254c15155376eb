# SPDX-License-Identifier: MIT
# What every target of the project has in common.

set(VOXTACT_EXPORT_MAP "${CMAKE_CURRENT_LIST_DIR}/voxtact.map")

function(voxtact_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                             POSITION_INDEPENDENT_CODE ON)
  # -Wno-restrict: GCC 12 warns falsely about std::string's operator+ (GCC bug 105651).
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor
                                           -Wold-style-cast $<$<BOOL:${VOXTACT_WARNINGS_AS_ERRORS}>:-Werror>)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    target_link_options(${target} PRIVATE "LINKER:--version-script=${VOXTACT_EXPORT_MAP}")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${VOXTACT_EXPORT_MAP}")
  endif()
endfunction()
