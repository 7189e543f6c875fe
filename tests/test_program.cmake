# One test program for each folder, and one test of ctest for each suite in it: a process for each of more than a thousand
# tests would cost more than many of them.

# nacre_test_program(<name> [FOLDER <folder>] [LABEL <label>] [NEEDS_VIEWER] [PACED <regular expression>] LINK <libraries>)
# Makes test_<name> from the *_test.cpp below the folder (default: the name); its suites become the tests <name>.<Suite>.
# A program with a label is built by the target long_tests alone.
# PACED: suites in which somebody acts at their own pace: two processors for each. Without what it needs, each of its files becomes a test that is
# skipped.
function(nacre_test_program name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "NEEDS_VIEWER" "FOLDER;LABEL;PACED" "LINK")
  if(NOT arg_FOLDER)
    set(arg_FOLDER ${name})
  endif()
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${arg_FOLDER}/*_test.cpp)
  if(name STREQUAL "app")
    list(FILTER sources EXCLUDE REGEX "/app/viewer/")  # a program of its own
  endif()
  if(arg_NEEDS_VIEWER AND NOT NACRE_HAS_VIEWER)
    foreach(source IN LISTS sources)
      get_filename_component(source ${source} NAME_WE)
      add_test(NAME ${name}.${source} COMMAND ${CMAKE_COMMAND} -E echo "Skipped: this build has no viewer")
      set_tests_properties(${name}.${source} PROPERTIES SKIP_REGULAR_EXPRESSION "^Skipped")
    endforeach()
    return()
  endif()

  add_executable(test_${name} ${sources})
  if(arg_LABEL)
    set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(long_tests test_${name})
  endif()
  target_link_libraries(test_${name} PRIVATE test_paths ${arg_LINK} GTest::gtest_main)
  nacre_unity(test_${name} 16)
  # Compiled for speed of compiling. The numerics come first in the link, so that where an inline function or a template is in
  # both, theirs is kept: what is tested is what the program runs, and one function does not round in two ways.
  target_compile_options(test_${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_options(test_${name} PRIVATE
    "LINKER:--whole-archive,$<TARGET_FILE:nacre_compute>,--no-whole-archive")

  # After each build the program says which suites it has; ctest reads that before it runs.
  set(suites ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
  add_custom_command(TARGET test_${name} POST_BUILD BYPRODUCTS ${suites} VERBATIM
    COMMAND ${CMAKE_COMMAND} -DNAME=${name} -DPROGRAM=$<TARGET_FILE:test_${name}> -DOUT=${suites}
      "-DLABEL=${arg_LABEL}" "-DPACED=${arg_PACED}" -P ${CMAKE_CURRENT_SOURCE_DIR}/list_suites.cmake)
  set(labelled)
  if(arg_LABEL)
    set(labelled "  set_tests_properties(${name}.not_built PROPERTIES LABELS ${arg_LABEL})\n")
  endif()
  file(WRITE ${suites}.include "if(EXISTS \"${suites}\")\n  include(\"${suites}\")\nelse()\n"
    "  add_test(${name}.not_built test_${name}_not_built)\n${labelled}endif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${suites}.include)
endfunction()
