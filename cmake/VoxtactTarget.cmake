# SPDX-License-Identifier: MIT
# What every target of the project has in common.

set(VOXTACT_EXPORT_MAP "${CMAKE_CURRENT_LIST_DIR}/voxtact.map")

# What C++ brings, for those who link a static library of ours without a C++ compiler: stdc++ and m, or c++.
set(VOXTACT_CXX_RUNTIME ${CMAKE_CXX_IMPLICIT_LINK_LIBRARIES})
list(FILTER VOXTACT_CXX_RUNTIME INCLUDE REGEX "^(std)?c\\+\\+$|^m$")
list(REMOVE_DUPLICATES VOXTACT_CXX_RUNTIME)

# What is warned of; and no fused multiply-add, wherever the processor has one: builtins, poses and matrices are the same
# on every machine. -Wno-restrict: GCC 12 warns falsely about std::string's operator+ (GCC bug 105651).
if(MSVC)
  set(VOXTACT_WARNINGS /W4 /permissive- $<$<BOOL:${VOXTACT_WARNINGS_AS_ERRORS}>:/WX>)
  set(VOXTACT_NO_CONTRACTION /fp:precise)
else()
  set(VOXTACT_WARNINGS $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor
                       -Wold-style-cast $<$<BOOL:${VOXTACT_WARNINGS_AS_ERRORS}>:-Werror>)
  set(VOXTACT_NO_CONTRACTION -ffp-contract=off)
endif()

function(voxtact_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
                                             POSITION_INDEPENDENT_CODE ON)
  target_compile_options(${target} PRIVATE ${VOXTACT_WARNINGS})
  if(NOT BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PUBLIC VOXTACT_STATIC)
  endif()
  if(WIN32 AND BUILD_SHARED_LIBS)
    target_compile_definitions(${target} PRIVATE VOXTACT_EXPORTS)
  endif()
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY" AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    # Another library of ours lies beside it, and a program that does not use that one itself need not know where.
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "\$ORIGIN" LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")
    target_link_options(${target} PRIVATE "LINKER:--version-script=${VOXTACT_EXPORT_MAP}")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${VOXTACT_EXPORT_MAP}")
  endif()
endfunction()

# What most files include of the standard library, and what takes a compiler longest to read.
set(VOXTACT_STANDARD_HEADERS
    <algorithm> <array> <atomic> <bit> <chrono> <cmath> <condition_variable> <cstddef> <cstdint> <cstdio> <cstdlib> <cstring>
    <filesystem> <fstream> <functional> <iostream> <iterator> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional>
    <random> <set> <span> <sstream> <string> <string_view> <thread> <tuple> <unordered_map> <utility> <variant> <vector>)

# voxtact_precompile(TARGET [HEADER...]): the standard headers, and those, are read once for all of the target's files. A
# file still includes what it uses: clang-tidy reads each by itself. Not for the libraries that others build, which include
# little, nor for what includes CLI11: of that, GCC compiles more than it needs, three times as long.
function(voxtact_precompile target)
  if(VOXTACT_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE ${VOXTACT_STANDARD_HEADERS} ${ARGN})
    voxtact_precompiled_options(${target})
  endif()
endfunction()

# voxtact_precompiled(TARGET OTHER): what OTHER has precompiled serves TARGET, which is compiled by the same options.
function(voxtact_precompiled target other)
  if(VOXTACT_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${other})
    voxtact_precompiled_options(${target})
  endif()
endfunction()

# The first is for ccache. The others: of a precompiled std::string GCC 12 warns falsely where it appends (as -Wrestrict).
function(voxtact_precompiled_options target)
  target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess;-Wno-stringop-overflow;-Wno-array-bounds>")
endfunction()

# voxtact_together(TARGET [APART FILE...]): its files are compiled some at a time, because most of their time goes into
# headers that all of them include. Names of unnamed namespaces are then distinct within the target; files that cannot
# keep to that, or that take long by themselves, stay APART. `./run lint --deep` reads each file by itself, so that
# each still includes what it uses.
function(voxtact_together target)
  cmake_parse_arguments(together "" "" APART ${ARGN})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${VOXTACT_TOGETHER} UNITY_BUILD_BATCH_SIZE 8)
  set_source_files_properties(${together_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  # Of a type in an unnamed namespace, used in a file that is included.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# voxtact_quickly_compiled(TARGET): compiles in two thirds of the time; for targets whose time is spent in libraries.
# VOXTACT_FAST: options of those of its files whose own run time matters.
set(VOXTACT_FAST $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang>>:-O3>)

function(voxtact_quickly_compiled target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU,Clang>>:-O1>)
endfunction()

# voxtact_room(NAME SOURCE...): the sources of a room, each compiled once. A library is made of rooms' objects, with
# voxtact_add_rooms(); what a shared one hides, others find in voxtact_NAME_inside, with voxtact_look_inside().
function(voxtact_room name)
  set(room voxtact_${name}_objects)
  add_library(${room} OBJECT ${ARGN})
  voxtact_target(${room})
  target_include_directories(${room} PUBLIC "${PROJECT_SOURCE_DIR}/include"
                                     PRIVATE "${PROJECT_SOURCE_DIR}/src")
  # No prototypes: a call of a linked vk* function does not compile.
  target_compile_definitions(${room} PRIVATE VK_NO_PROTOTYPES)
  target_compile_options(${room} PRIVATE ${VOXTACT_NO_CONTRACTION})
  target_link_libraries(${room} PUBLIC Vulkan::Headers PRIVATE glm::glm)
endfunction()

# voxtact_add_rooms(LIBRARY ROOM...)
function(voxtact_add_rooms library)
  get_target_property(type ${library} TYPE)
  foreach(room ${ARGN})
    target_sources(${library} PRIVATE $<TARGET_OBJECTS:voxtact_${room}_objects>)
    if(type STREQUAL "SHARED_LIBRARY")
      add_library(voxtact_${room}_inside STATIC $<TARGET_OBJECTS:voxtact_${room}_objects>)
      set_target_properties(voxtact_${room}_inside PROPERTIES LINKER_LANGUAGE CXX)
      # What the objects use, whoever takes them uses.
      target_link_libraries(voxtact_${room}_inside PRIVATE $<TARGET_PROPERTY:voxtact_${room}_objects,LINK_LIBRARIES>)
    endif()
  endforeach()
endfunction()

# voxtact_look_inside(TARGET ROOM...): the target uses what a shared library does not export of these rooms, which are
# named after those that they use. It takes a copy of its own of the objects that it needs, and exports nothing of them.
function(voxtact_look_inside target)
  set(rooms ${ARGN})
  list(REVERSE rooms)
  foreach(room ${rooms})
    if(TARGET voxtact_${room}_inside)
      target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:voxtact_${room}_inside>)
      target_link_options(${target} PRIVATE "LINKER:--exclude-libs,libvoxtact_${room}_inside.a")
    endif()
  endforeach()
endfunction()

# voxtact_executable(TARGET NAME SOURCE...): one of the programs, which lie side by side.
function(voxtact_executable target name)
  add_executable(${target} ${ARGN})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")
  voxtact_target(${target})
  target_link_libraries(${target} PRIVATE voxtact_program)
  if(BUILD_SHARED_LIBS)
    # Shared libraries of ours, in an install tree, which can be moved, and beside the program in the build tree.
    file(RELATIVE_PATH libraries "/prefix/${CMAKE_INSTALL_BINDIR}" "/prefix/${CMAKE_INSTALL_LIBDIR}")
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "\$ORIGIN/${libraries};\$ORIGIN")
  endif()
  if(VOXTACT_INSTALL)
    install(TARGETS ${target} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT voxtact_program)
  endif()
endfunction()
