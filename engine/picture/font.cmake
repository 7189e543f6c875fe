# Puts DejaVu Sans (Debian: fonts-dejavu-core) into nacre_picture, so that a program carries its font with it.
# Without the font, text is drawn with stb_easy_font's line letters.
find_file(NACRE_FONT DejaVuSans.ttf DOC "TrueType font of the legend and time stamp"
  PATHS /usr/share/fonts/truetype/dejavu /usr/share/fonts/dejavu /usr/share/fonts/dejavu-sans-fonts /usr/share/fonts/TTF
  NO_DEFAULT_PATH)

if(NACRE_FONT)
  message(STATUS "Font of pictures: ${NACRE_FONT}")
  set(nacre_font_object ${CMAKE_CURRENT_BINARY_DIR}/embedded_font.cpp)
  configure_file(${CMAKE_CURRENT_LIST_DIR}/embedded_font.cpp.in ${nacre_font_object} @ONLY)
  set_source_files_properties(${nacre_font_object} PROPERTIES OBJECT_DEPENDS ${NACRE_FONT})
  set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/text.cpp PROPERTIES COMPILE_DEFINITIONS NACRE_HAS_FONT=1)
  target_sources(nacre_picture PRIVATE ${nacre_font_object})
else()
  message(STATUS "Font of pictures: DejaVuSans.ttf not found (Debian: fonts-dejavu-core), text is drawn as plain lines")
endif()
