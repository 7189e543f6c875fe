# One package for all x86-64 processors. What is given away is compiled once for each level of the instruction set: this build
# for NACRE_MARCH, and for each of NACRE_LEVELS (x86-64-v3, x86-64-v4) a build of its own below levels/. Which one runs is
# chosen when it starts: by app/package/launcher.cpp for the program, by python/nacre/_levels.py for the module.
# Whole programs, and not kernels, are compiled again: inline functions of one level would otherwise be linked into another.
include(ExternalProject)

# nacre_build_levels(TARGET): builds that target for each of NACRE_LEVELS too.
function(nacre_build_levels target)
  set(passed)
  foreach(name CMAKE_BUILD_TYPE CMAKE_C_COMPILER CMAKE_CXX_COMPILER CMAKE_C_COMPILER_LAUNCHER CMAKE_CXX_COMPILER_LAUNCHER
      CMAKE_CUDA_COMPILER_LAUNCHER CMAKE_CXX_FLAGS CMAKE_CUDA_ARCHITECTURES NACRE_CGAL NACRE_CUDA NACRE_CUDA_EVERY_GPU NACRE_HIP NACRE_VTK
      NACRE_DICOM NACRE_VIEWER NACRE_UNITY NACRE_WERROR NACRE_PROGRAM NACRE_PYTHON Python_EXECUTABLE nanobind_ROOT
      SKBUILD_SOABI SKBUILD_SABI_VERSION SKBUILD_SABI_COMPONENT)
    if(DEFINED ${name})
      string(REPLACE ";" "|" value "${${name}}")
      list(APPEND passed "-D${name}=${value}")
    endif()
  endforeach()
  foreach(level IN LISTS NACRE_LEVELS)
    ExternalProject_Add(nacre_${level}
      SOURCE_DIR ${PROJECT_SOURCE_DIR} BINARY_DIR ${PROJECT_BINARY_DIR}/levels/${level} LIST_SEPARATOR |
      CMAKE_ARGS ${passed} -DNACRE_MARCH=${level} -DNACRE_LEVELS= -DNACRE_TESTS=OFF -DNACRE_INSTALL=OFF -DCMAKE_SKIP_RPATH=ON
        "-DCMAKE_EXE_LINKER_FLAGS=${CMAKE_EXE_LINKER_FLAGS} -s" "-DCMAKE_MODULE_LINKER_FLAGS=${CMAKE_MODULE_LINKER_FLAGS} -s"
      BUILD_COMMAND ${CMAKE_COMMAND} --build . --target ${target} BUILD_ALWAYS ON USES_TERMINAL_BUILD ON
      INSTALL_COMMAND "")
  endforeach()
endfunction()
