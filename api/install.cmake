# cmake --install: headers, one library, and nacreConfig.cmake, so that find_package(nacre) gives nacre::compute.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# All parts in one library. BUILD_SHARED_LIBS chooses which kind; a shared one shows only what include/nacre declares.
set(parts nacre_api nacre_run nacre_writers nacre_picture nacre_scene nacre_system nacre_compute nacre_delaunay)
set(objects)
foreach(part IN LISTS parts)
  list(APPEND objects $<TARGET_OBJECTS:${part}>)
endforeach()
add_library(nacre_installed ${objects})
set_target_properties(nacre_installed PROPERTIES OUTPUT_NAME nacre EXPORT_NAME compute LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(nacre_installed INTERFACE cxx_std_20)
target_include_directories(nacre_installed INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(nacre_installed PRIVATE TBB::tbb TBB::tbbmalloc fmt::fmt ZLIB::ZLIB mpfr gmp)
if(NACRE_HIP)
  target_link_libraries(nacre_installed PRIVATE ${NACRE_AMDHIP})
elseif(NACRE_HAS_CUDA)
  set_target_properties(nacre_installed PROPERTIES CUDA_RUNTIME_LIBRARY Static)
  target_link_libraries(nacre_installed PRIVATE CUDA::cudart_static)
endif()

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/nacre)
get_target_property(nacre_library_type nacre_installed TYPE)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/nacreConfig.cmake.in nacreConfig.cmake
  INSTALL_DESTINATION ${config_folder})
write_basic_package_version_file(nacreConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(TARGETS nacre_installed EXPORT nacre_targets COMPONENT library)
install(EXPORT nacre_targets NAMESPACE nacre:: FILE nacreTargets.cmake DESTINATION ${config_folder} COMPONENT library)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/nacreConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/nacreConfigVersion.cmake
  DESTINATION ${config_folder} COMPONENT library)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/nacre DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT library)
