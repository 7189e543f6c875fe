# The test bodies that run on every device: tests/compute/**/*_body.hpp, as far as they hold tests.

# nacre_device_bodies(RESULT): their paths, relative to the source folder; not those that another one includes.
function(nacre_device_bodies result)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
    ${PROJECT_SOURCE_DIR}/tests/compute/*_body.hpp)
  set(bodies)
  set(included)
  foreach(header IN LISTS headers)
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} tests REGEX "^NACRE_DEVICE_TEST" LIMIT_COUNT 1)
    if(tests)
      list(APPEND bodies ${header})
    endif()
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} others REGEX "^#include \".*_body\\.hpp\"")
    list(TRANSFORM others REPLACE "#include \"(.*)\"" "\\1")
    list(APPEND included ${others})
  endforeach()
  list(REMOVE_ITEM bodies ${included})
  set(${result} ${bodies} PARENT_SCOPE)
endfunction()

# nacre_device_body_source(FILE HEADER...): writes the source that instantiates these bodies on CUDA.
function(nacre_device_body_source file)
  set(content "// Nacre: test bodies on CUDA, a list that CMake writes.\n")
  string(APPEND content "#include \"compute/device/executor_cuda.cuh\"\n")
  foreach(header IN LISTS ARGN)
    string(APPEND content "#include \"${header}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT ${file} CONTENT "${content}" @ONLY)
endfunction()
