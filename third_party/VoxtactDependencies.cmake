# How each dependency is found. Everything comes from the system; the lists packages-*.txt beside this file name
# the packages of Debian 12. Nothing is downloaded and nothing is copied.

# voxtact::voxtact: Vulkan headers, and at build time glm, glslang and SPIRV-Tools.
find_package(VulkanHeaders CONFIG QUIET)
if(NOT TARGET Vulkan::Headers)
  find_path(VOXTACT_VULKAN_INCLUDE_DIR vulkan/vulkan_core.h REQUIRED)
  add_library(Vulkan::Headers INTERFACE IMPORTED)
  set_target_properties(Vulkan::Headers PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${VOXTACT_VULKAN_INCLUDE_DIR}")
endif()
find_package(glm CONFIG REQUIRED)
find_program(VOXTACT_GLSLANG glslangValidator REQUIRED)
find_program(VOXTACT_SPIRV_OPT spirv-opt REQUIRED)
find_program(VOXTACT_SPIRV_VAL spirv-val REQUIRED)

# voxtact::cpu: of xxHash the header alone, at build time.
if(VOXTACT_BUILD_CPU)
  find_path(VOXTACT_XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
  find_package(hwy 1.0.3 CONFIG REQUIRED)
  find_package(Threads REQUIRED)
endif()

# voxtact::io
if(VOXTACT_BUILD_IO)
  find_package(nlohmann_json 3.10 CONFIG REQUIRED)
  # JPEG 2000 in DICOM files. OpenJPEG's own package file asks for its programs, which nobody needs.
  find_path(VOXTACT_OPENJPEG_INCLUDE_DIR openjpeg.h PATH_SUFFIXES openjpeg-2.5 REQUIRED)
  find_library(VOXTACT_OPENJPEG_LIBRARY openjp2 REQUIRED)
  find_package(PNG REQUIRED)
  find_package(pugixml CONFIG REQUIRED) # XML of VTK
  find_package(ZLIB REQUIRED)
endif()

# voxtact-step: OpenCASCADE. Its package file asks for all of its libraries, viewers included.
if(VOXTACT_BUILD_STEP)
  find_path(VOXTACT_OPENCASCADE_INCLUDE_DIR STEPControl_Reader.hxx PATH_SUFFIXES opencascade REQUIRED)
  add_library(voxtact_opencascade INTERFACE)
  target_include_directories(voxtact_opencascade SYSTEM INTERFACE "${VOXTACT_OPENCASCADE_INCLUDE_DIR}")
  foreach(name TKSTEP TKIGES TKXSBase TKMesh TKTopAlgo TKGeomAlgo TKBRep TKGeomBase TKG3d TKG2d TKMath TKernel)
    find_library(VOXTACT_OPENCASCADE_${name} ${name} REQUIRED)
    target_link_libraries(voxtact_opencascade INTERFACE "${VOXTACT_OPENCASCADE_${name}}")
  endforeach()
endif()

# Headers that draw letters in the program, and read PNG in the tests.
if(VOXTACT_BUILD_APP OR VOXTACT_BUILD_TESTS)
  find_path(VOXTACT_STB_INCLUDE_DIR stb_truetype.h PATH_SUFFIXES stb REQUIRED)
endif()

# the Python package. The system's Python is asked first: that is where Debian's numpy and cffi are.
if(VOXTACT_BUILD_PYTHON)
  find_program(VOXTACT_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH)
  find_program(VOXTACT_PYTHON python3 REQUIRED)
  set(Python_EXECUTABLE "${VOXTACT_PYTHON}" CACHE FILEPATH "The Python that builds and tests the package")
  find_package(Python 3.9 COMPONENTS Interpreter REQUIRED)
endif()

# the program: volk is a header and a source file that the program compiles.
if(VOXTACT_BUILD_APP)
  find_package(CLI11 CONFIG REQUIRED)
  find_path(VOXTACT_VOLK_INCLUDE_DIR volk.h REQUIRED)
  # What `render` writes on pictures with: it becomes part of the program. Any TrueType file will do.
  find_file(VOXTACT_FONT DejaVuSans.ttf PATHS /usr/share/fonts /usr/local/share/fonts
            PATH_SUFFIXES truetype/dejavu TTF dejavu dejavu-sans-fonts NO_DEFAULT_PATH REQUIRED)
endif()

# FCL is what `bench` compares with, where it is found.
if(VOXTACT_BUILD_BENCH)
  find_package(octomap QUIET)
  find_package(fcl QUIET)
  set(VOXTACT_WITH_FCL OFF)
  if(TARGET fcl AND TARGET octomap)
    set(VOXTACT_WITH_FCL ON)
  endif()
endif()

# the window of the program: Dear ImGui with its GLFW backend, which Debian's library has in it and builds with FreeType.
# What it draws we record ourselves, so that nothing links the Vulkan loader.
if(VOXTACT_BUILD_VIEW)
  find_package(glfw3 3.3 CONFIG REQUIRED)
  find_package(Freetype REQUIRED)
  find_path(VOXTACT_IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui REQUIRED)
  find_library(VOXTACT_IMGUI_LIBRARY imgui REQUIRED)
  find_library(VOXTACT_STB_LIBRARY stb REQUIRED) # Debian's Dear ImGui has no copies of its files
  add_library(voxtact_imgui INTERFACE)
  target_include_directories(voxtact_imgui SYSTEM INTERFACE "${VOXTACT_IMGUI_INCLUDE_DIR}")
  target_link_libraries(voxtact_imgui INTERFACE "${VOXTACT_IMGUI_LIBRARY}" "${VOXTACT_STB_LIBRARY}" glfw Freetype::Freetype)
endif()

if(VOXTACT_BUILD_TESTS)
  find_package(GTest REQUIRED)
  if(VOXTACT_BUILD_IO)
    find_package(charls 2.3 CONFIG REQUIRED) # writes JPEG-LS
    # The judge of our readers and writers.
    enable_language(C) # its look for HDF5 compiles a C file
    find_package(ITK 5.2 CONFIG REQUIRED COMPONENTS ITKCommon ITKIOImageBase ITKIONIFTI ITKIONRRD ITKIOMeta)
  endif()
endif()
