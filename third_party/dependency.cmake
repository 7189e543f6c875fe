# Nacre: looks for one dependency at a time and prints one table of what was found and what is switched off.

# nacre_dependency(<name> PACKAGE <debian package> [REQUIRED] [SWITCHES <what its absence switches off>]
#                  FIND <arguments of find_package> |
#                  HEADER <file> [IN <folder suffixes>] [MACROS <macros that make its version>] |
#                  FOUND <true or false> [VERSION <version>])
# FIND makes the package's targets, HEADER only looks for the header, FOUND reports what the caller has looked for. If a
# REQUIRED dependency is missing, nacre_dependency_table stops the configuration and lists all such packages in one
# line. Sets <name>_FOUND in the caller's scope.
function(nacre_dependency name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "REQUIRED" "PACKAGE;SWITCHES;HEADER;FOUND;VERSION" "FIND;IN;MACROS")
  if(arg_FIND)
    list(GET arg_FIND 0 package)
    find_package(${arg_FIND} QUIET)
    set(arg_FOUND ${${package}_FOUND})
    set(arg_VERSION ${${package}_VERSION})
    if(NOT arg_VERSION)
      set(arg_VERSION ${${package}_VERSION_STRING})
    endif()
  elseif(arg_HEADER)
    find_path(NACRE_${name}_INCLUDE ${arg_HEADER} PATH_SUFFIXES ${arg_IN} HINTS ${CUDAToolkit_INCLUDE_DIRS})
    mark_as_advanced(NACRE_${name}_INCLUDE)
    set(arg_FOUND ${NACRE_${name}_INCLUDE})
    nacre_header_version(arg_VERSION "${NACRE_${name}_INCLUDE}/${arg_HEADER}" ${arg_MACROS})
  endif()

  if(NOT arg_FOUND)
    set(state "not found")
    set(note "switches off ${arg_SWITCHES} (Debian: ${arg_PACKAGE})")
    if(arg_REQUIRED)
      set(note "needed (Debian: ${arg_PACKAGE})")
      set_property(GLOBAL APPEND PROPERTY NACRE_MISSING ${arg_PACKAGE})
    endif()
  elseif(arg_VERSION)
    set(state "${arg_VERSION}")
  else()
    set(state "found")
  endif()
  nacre_dependency_row("${name}" "${state}" "${note}")
  set(${name}_FOUND ${arg_FOUND} PARENT_SCOPE)
endfunction()

# Joins the numbers that a header defines for the given macros with dots; empty if there are none.
function(nacre_header_version result header)
  set(numbers)
  foreach(macro IN LISTS ARGN)
    if(EXISTS ${header})
      file(STRINGS ${header} line REGEX "define[ \t]+${macro}[ \t]" LIMIT_COUNT 1)
      string(REGEX MATCH "${macro}[ \t]+\"?([0-9.]+)" line "${line}")
      set(number ${CMAKE_MATCH_1})
      if(number MATCHES "^[0-9]+$" AND number GREATER 99999)  # CUB packs three numbers into one
        math(EXPR number_major "${number} / 100000")
        math(EXPR number_minor "${number} / 100 % 1000")
        math(EXPR number_patch "${number} % 100")
        set(number "${number_major}.${number_minor}.${number_patch}")
      endif()
      list(APPEND numbers ${number})
    endif()
  endforeach()
  list(JOIN numbers "." version)
  set(${result} "${version}" PARENT_SCOPE)
endfunction()

# Adds one line to the table: name, version or state, note.
function(nacre_dependency_row name state note)
  nacre_pad(name 20)
  nacre_pad(state 16)
  string(STRIP "${name}${state}${note}" line)
  nacre_dependency_heading("  ${line}")
endfunction()

# Adds a line of text to the table.
function(nacre_dependency_heading line)
  set_property(GLOBAL APPEND_STRING PROPERTY NACRE_TABLE "   ${line}\n")
endfunction()

# Fills the named variable with blanks up to a width.
function(nacre_pad variable width)
  string(LENGTH "${${variable}}" length)
  math(EXPR missing "${width} - ${length}")
  if(missing LESS 1)
    set(missing 1)
  endif()
  string(REPEAT " " ${missing} blanks)
  set(${variable} "${${variable}}${blanks}" PARENT_SCOPE)
endfunction()

# Prints the table; fatal if something needed is missing.
function(nacre_dependency_table)
  get_property(table GLOBAL PROPERTY NACRE_TABLE)
  message(STATUS "Dependencies of Nacre\n${table}")
  get_property(missing GLOBAL PROPERTY NACRE_MISSING)
  if(missing)
    list(JOIN missing " " missing)
    message(FATAL_ERROR "Nacre needs packages that are not installed; run ./dev setup, or: apt-get install ${missing}")
  endif()
endfunction()
