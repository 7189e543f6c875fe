# Nacre: finds tinyobjloader by its header, which holds all of it (Debian's own CMake files link a library).
include(FindPackageHandleStandardArgs)
find_path(TINYOBJ_INCLUDE tiny_obj_loader.h)
mark_as_advanced(TINYOBJ_INCLUDE)
find_package_handle_standard_args(Tinyobjloader DEFAULT_MSG TINYOBJ_INCLUDE)
if(Tinyobjloader_FOUND AND NOT TARGET tinyobjloader::tinyobjloader)
  add_library(tinyobjloader::tinyobjloader INTERFACE IMPORTED GLOBAL)
  target_include_directories(tinyobjloader::tinyobjloader SYSTEM INTERFACE ${TINYOBJ_INCLUDE})
endif()
