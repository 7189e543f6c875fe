# The program installed by `cmake --install --component program`, and Debian packages of it and of the library by CPack:
# `./dev package`.
include(GNUInstallDirs)
set(NACRE_MAINTAINER "Nacre maintainers <maintainers@nacre.example.org>" CACHE STRING
  "Who is named as the maintainer of packages: NAME <ADDRESS>")
set(here ${CMAKE_CURRENT_LIST_DIR})
set(doc ${CMAKE_INSTALL_DATAROOTDIR}/doc)

if(NACRE_LEVELS)
  include(${here}/levels.cmake)
  nacre_build_levels(nacre)
  add_executable(nacre_launcher ${here}/launcher.cpp)  # for any x86-64: without nacre_options
  target_compile_features(nacre_launcher PRIVATE cxx_std_20)
  target_link_options(nacre_launcher PRIVATE -s)
  # Not with OUTPUT_NAME: ninja would take "nacre" for the launcher.
  install(PROGRAMS $<TARGET_FILE:nacre_launcher> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME nacre COMPONENT program)
  install(TARGETS nacre RUNTIME DESTINATION libexec/nacre/${NACRE_MARCH} COMPONENT program)
  foreach(level IN LISTS NACRE_LEVELS)
    install(PROGRAMS ${PROJECT_BINARY_DIR}/levels/${level}/bin/nacre DESTINATION libexec/nacre/${level} COMPONENT program)
  endforeach()
else()
  install(TARGETS nacre RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
foreach(child nacre-vtk-import nacre-dicom-import)
  if(TARGET ${child})
    install(TARGETS ${child} RUNTIME DESTINATION libexec/nacre COMPONENT program)
  endif()
endforeach()
if(NACRE_HAS_VIEWER)
  install(FILES ${here}/nacre.desktop DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/applications COMPONENT program)
  install(FILES ${here}/nacre.svg DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/icons/hicolor/scalable/apps COMPONENT program)
endif()

# Debian wants its man pages and changelogs packed, without a time stamp, and a copyright file for each package.
find_program(NACRE_GZIP gzip)
mark_as_advanced(NACRE_GZIP)
string(REGEX MATCH "<.*>" address "${NACRE_MAINTAINER}")
configure_file(${here}/nacre.1 nacre.1 COPYONLY)
configure_file(${here}/changelog.in changelog @ONLY)
if(NACRE_GZIP)
  foreach(file nacre.1 changelog)
    add_custom_command(OUTPUT ${file}.gz COMMAND ${NACRE_GZIP} -9nc ${file} > ${file}.gz DEPENDS ${file} VERBATIM)
  endforeach()
  add_custom_target(nacre_package_files ALL DEPENDS nacre.1.gz changelog.gz)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/nacre.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz DESTINATION ${doc}/nacre COMPONENT program)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/changelog.gz DESTINATION ${doc}/libnacre-dev COMPONENT library_documents)
endif()
install(FILES ${here}/copyright DESTINATION ${doc}/nacre COMPONENT program)
install(FILES ${here}/copyright DESTINATION ${doc}/libnacre-dev COMPONENT library_documents)
# What only debuggers and linkers of other kinds would read.
if(TARGET nacre_installed AND CMAKE_STRIP)
  install(CODE "execute_process(COMMAND ${CMAKE_STRIP} --strip-debug --remove-section=.comment --remove-section=.note
    --enable-deterministic-archives \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/libnacre.a\")"
    COMPONENT library_documents)
endif()

set(CPACK_PACKAGE_NAME nacre)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${NACRE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program)
if(TARGET nacre_installed)
  list(APPEND CPACK_COMPONENTS_ALL library library_documents)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_PROGRAM_GROUP program)
set(CPACK_COMPONENT_LIBRARY_GROUP library)
set(CPACK_COMPONENT_LIBRARY_DOCUMENTS_GROUP library)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME nacre)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "unsteady flow on surfaces, and meshes of segmented volumes
Nacre shows unsteady flow on surfaces as a moving texture (unsteady flow line
integral convolution), and makes conformal meshes of several materials,
triangles and tetrahedra, of segmented volumes such as CT and MRI scans. Both
rest on the closest point embedding of a surface.

This package has the program with its window, for the levels x86-64-v2, v3
and v4 of processors; the best is chosen when it starts.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libnacre-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libtbb-dev, libfmt-dev, zlib1g-dev, libmpfr-dev, libgmp-dev")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "library of Nacre: flow on surfaces, and meshes (development files)
Nacre shows unsteady flow on surfaces as a moving texture, and makes conformal
meshes of several materials of segmented volumes.

This package has its headers, a static library, and what find_package(nacre)
of CMake needs. It is for processors of the level x86-64-v2 and above.")
include(CPack)
