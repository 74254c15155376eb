# SPDX-License-Identifier: MIT
# find_package(voxtact) from an install tree. An export set a target, so that voxtact::voxtact can be found where the
# packages behind voxtact::cpu and voxtact::io are not there.
#
# Install components: `voxtact` (the library, its headers and the package files), `voxtact_cpu`,
# `voxtact_io`, `voxtact_render`, `voxtact_samples` and `voxtact_c`. The program, `voxtact_program`, installs itself in
# src/cli, and the Python package, `voxtact_python`, in src/python.
include(CMakePackageConfigHelpers)
set(voxtact_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/voxtact")
set(voxtact_include_dir "${CMAKE_INSTALL_INCLUDEDIR}/voxtact")

# Every public header belongs to the library, but for those of the other targets.
file(GLOB voxtact_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/voxtact/*.h")
set(voxtact_io_headers "${PROJECT_SOURCE_DIR}/include/voxtact/io.h")
set(voxtact_cpu_headers "${PROJECT_SOURCE_DIR}/include/voxtact/cpu.h")
set(voxtact_render_headers "${PROJECT_SOURCE_DIR}/include/voxtact/looks.h" "${PROJECT_SOURCE_DIR}/include/voxtact/render.h")
set(voxtact_samples_headers "${PROJECT_SOURCE_DIR}/include/voxtact/samples.h")
file(GLOB voxtact_c_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/voxtact/voxtact*.h")
list(REMOVE_ITEM voxtact_headers ${voxtact_io_headers} ${voxtact_cpu_headers} ${voxtact_render_headers}
     ${voxtact_samples_headers} ${voxtact_c_headers})
list(APPEND voxtact_c_headers "${PROJECT_SOURCE_DIR}/include/voxtact/device_memory.h") # which C++ has, too

# voxtact_install(TARGET EXPORT_SET HEADER...): installs under the component TARGET.
function(voxtact_install target export_set)
  install(FILES ${ARGN} DESTINATION "${voxtact_include_dir}" COMPONENT ${target})
  install(
    TARGETS ${target}
    EXPORT ${export_set}
    RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT ${target}
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${target} NAMELINK_COMPONENT ${target}
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${target})
  install(EXPORT ${export_set} NAMESPACE voxtact:: DESTINATION "${voxtact_package_dir}" COMPONENT ${target})
endfunction()

voxtact_install(voxtact voxtact-targets ${voxtact_headers})
install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT voxtact)
if(VOXTACT_BUILD_CPU)
  voxtact_install(voxtact_cpu voxtact-cpu-targets ${voxtact_cpu_headers})
endif()
if(VOXTACT_BUILD_IO)
  voxtact_install(voxtact_io voxtact-io-targets ${voxtact_io_headers})
endif()
if(VOXTACT_BUILD_RENDER)
  voxtact_install(voxtact_render voxtact-render-targets ${voxtact_render_headers})
endif()
if(VOXTACT_BUILD_SAMPLES)
  voxtact_install(voxtact_samples voxtact-samples-targets ${voxtact_samples_headers})
endif()
if(VOXTACT_BUILD_C)
  voxtact_install(voxtact_c voxtact-c-targets ${voxtact_c_headers})
endif()

# For pkg-config. An install tree can be moved: its places are told from that of the file. A static library brings what
# it must be linked with, whether or not --static is asked for.
function(voxtact_pkg_config name description libraries)
  set(folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
  set(VOXTACT_PC_NAME "${name}")
  set(VOXTACT_PC_DESCRIPTION "${description}")
  set(VOXTACT_PC_LIBRARIES "${libraries}")
  cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_LIBDIR BASE_DIRECTORY "/prefix" OUTPUT_VARIABLE VOXTACT_PC_LIBDIR)
  cmake_path(ABSOLUTE_PATH CMAKE_INSTALL_INCLUDEDIR BASE_DIRECTORY "/prefix" OUTPUT_VARIABLE VOXTACT_PC_INCLUDEDIR)
  foreach(place LIBDIR INCLUDEDIR)
    file(RELATIVE_PATH from_file "/prefix/${folder}" "${VOXTACT_PC_${place}}")
    if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_${place}}")
      string(REGEX REPLACE "/$" "" from_file "${from_file}")
      set(VOXTACT_PC_${place} "\${pcfiledir}/${from_file}")
    endif()
  endforeach()
  configure_file("${PROJECT_SOURCE_DIR}/cmake/package.pc.in" "${PROJECT_BINARY_DIR}/${name}.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${name}.pc" DESTINATION "${folder}" COMPONENT ${name})
endfunction()
get_target_property(voxtact_type voxtact TYPE)
set(voxtact_static_needs "")
set(voxtact_c_static_needs "")
set(VOXTACT_PC_DEFINES "")
if(voxtact_type STREQUAL "STATIC_LIBRARY")
  set(VOXTACT_PC_DEFINES " -DVOXTACT_STATIC")
  list(TRANSFORM VOXTACT_CXX_RUNTIME PREPEND " -l" OUTPUT_VARIABLE voxtact_static_needs)
  string(JOIN "" voxtact_static_needs ${voxtact_static_needs})
  set(voxtact_c_static_needs " -lvoxtact_cpu -lvoxtact -lhwy")
  if(VOXTACT_BUILD_IO)
    set(voxtact_c_static_needs " -lvoxtact_io${voxtact_c_static_needs} -lpng -lpugixml -lz -lopenjp2")
  endif()
  if(VOXTACT_BUILD_RENDER)
    string(PREPEND voxtact_c_static_needs " -lvoxtact_render")
  endif()
  string(PREPEND voxtact_c_static_needs " -lvoxtact_samples")
endif()
voxtact_pkg_config(voxtact "${PROJECT_DESCRIPTION}" "-lvoxtact${voxtact_static_needs}")
if(VOXTACT_BUILD_C)
  voxtact_pkg_config(voxtact_c "${PROJECT_DESCRIPTION}; in C" "-lvoxtact_c${voxtact_c_static_needs}${voxtact_static_needs} -pthread")
endif()

# What a static voxtact::c is linked with, as components of the package; a shared one needs none of them.
set(VOXTACT_C_NEEDS "")
if(voxtact_type STREQUAL "STATIC_LIBRARY")
  set(VOXTACT_C_NEEDS "cpu;samples")
  if(VOXTACT_BUILD_IO)
    list(APPEND VOXTACT_C_NEEDS io)
  endif()
  if(VOXTACT_BUILD_RENDER)
    list(APPEND VOXTACT_C_NEEDS render)
  endif()
endif()
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/voxtact-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/voxtact-config.cmake" INSTALL_DESTINATION "${voxtact_package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/voxtact-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/voxtact-config.cmake" "${PROJECT_BINARY_DIR}/voxtact-config-version.cmake"
        DESTINATION "${voxtact_package_dir}" COMPONENT voxtact)
