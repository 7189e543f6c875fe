# Nacre: finds the stb headers, used as headers only.
include(FindPackageHandleStandardArgs)
find_path(STB_INCLUDE stb_image_write.h PATH_SUFFIXES stb)
mark_as_advanced(STB_INCLUDE)
find_package_handle_standard_args(Stb DEFAULT_MSG STB_INCLUDE)
if(Stb_FOUND AND NOT TARGET stb::stb)
  add_library(stb::stb INTERFACE IMPORTED GLOBAL)
  target_include_directories(stb::stb SYSTEM INTERFACE ${STB_INCLUDE})
endif()
