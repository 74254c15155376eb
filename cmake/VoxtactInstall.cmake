# SPDX-License-Identifier: MIT
# find_package(voxtact) from an install tree. An export set a target, so that voxtact::voxtact can be found where the
# packages behind voxtact::cpu and voxtact::io are not there. The program installs itself, in src/app.
#
# Install components: `voxtact` (the library, its headers and the package files), `voxtact_cpu`,
# `voxtact_io`, `voxtact_render` and `voxtact_samples`.
include(CMakePackageConfigHelpers)
set(voxtact_package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/voxtact")
set(voxtact_include_dir "${CMAKE_INSTALL_INCLUDEDIR}/voxtact")

# Every public header belongs to the library, but for those of the other targets.
file(GLOB voxtact_headers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/voxtact/*.h")
set(voxtact_io_headers "${PROJECT_SOURCE_DIR}/include/voxtact/io.h")
set(voxtact_cpu_headers "${PROJECT_SOURCE_DIR}/include/voxtact/cpu.h")
set(voxtact_render_headers "${PROJECT_SOURCE_DIR}/include/voxtact/looks.h" "${PROJECT_SOURCE_DIR}/include/voxtact/render.h")
set(voxtact_samples_headers "${PROJECT_SOURCE_DIR}/include/voxtact/samples.h")
list(REMOVE_ITEM voxtact_headers ${voxtact_io_headers} ${voxtact_cpu_headers} ${voxtact_render_headers}
     ${voxtact_samples_headers})

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

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/voxtact-config.cmake.in"
                              "${PROJECT_BINARY_DIR}/voxtact-config.cmake" INSTALL_DESTINATION "${voxtact_package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/voxtact-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/voxtact-config.cmake" "${PROJECT_BINARY_DIR}/voxtact-config-version.cmake"
        DESTINATION "${voxtact_package_dir}" COMPONENT voxtact)
