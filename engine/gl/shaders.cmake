# Embeds the files of shaders/ in nacre_gl as strings, so that a program contains its shaders.
file(GLOB shader_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/../../shaders/*.vert ${CMAKE_CURRENT_LIST_DIR}/../../shaders/*.frag
  ${CMAKE_CURRENT_LIST_DIR}/../../shaders/*.glsl)
set(shader_sources ${CMAKE_CURRENT_BINARY_DIR}/shader_sources.cpp)
add_custom_command(OUTPUT ${shader_sources}
  COMMAND ${CMAKE_COMMAND} -DOUT=${shader_sources} "-DFILES=${shader_files}"
    -P ${CMAKE_CURRENT_LIST_DIR}/embed_shaders.cmake
  DEPENDS ${shader_files} ${CMAKE_CURRENT_LIST_DIR}/embed_shaders.cmake
  COMMENT "Embedding shaders" VERBATIM)
target_sources(nacre_gl PRIVATE ${shader_sources})
