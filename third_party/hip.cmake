# Nacre: AMD's GPUs. With NACRE_HIP the sources of the CUDA backend are compiled by hipcc, in whose words CUDA's are
# said by compute/device/hip. Sets what cuda.cmake sets. Experimental: no AMD card has run it.
set(NACRE_HIP_ARCHITECTURES gfx90a gfx1030 CACHE STRING "Kinds of AMD GPU that code is made for")
find_program(NACRE_HIPCC hipcc)
find_library(NACRE_AMDHIP amdhip64)
find_path(NACRE_ROCPRIM rocprim/rocprim.hpp)
mark_as_advanced(NACRE_HIPCC NACRE_AMDHIP NACRE_ROCPRIM)
foreach(need NACRE_HIPCC NACRE_AMDHIP NACRE_ROCPRIM)
  if(NOT ${need})
    message(FATAL_ERROR "NACRE_HIP=ON needs hipcc, its library and rocPRIM: apt-get install hipcc librocprim-dev")
  endif()
endforeach()
set(NACRE_HAS_CUDA ON)
set(nacre_cuda_state "HIP")

# nacre_hip_sources(TARGET SOURCE...): adds what hipcc makes of these .cu files.
function(nacre_hip_sources target)
  list(TRANSFORM NACRE_HIP_ARCHITECTURES PREPEND --offload-arch= OUTPUT_VARIABLE architectures)
  set(hip ${PROJECT_SOURCE_DIR}/compute/device/hip)
  if(NACRE_MARCH)
    set(march -march=${NACRE_MARCH})
  endif()
  foreach(source IN LISTS ARGN)
    cmake_path(GET source STEM name)
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}.hip.o)
    set(level -O3)
    if(name STREQUAL mesh_pipeline_cuda)
      set(level -O1)  # above, LLVM 15 crashes where it lays out the branches of SearchJunctions
    endif()
    add_custom_command(OUTPUT ${object} DEPENDS ${source} DEPFILE ${object}.d VERBATIM
      COMMAND ${NACRE_HIPCC} -x hip ${architectures} -std=c++20 ${level} -fPIC ${march} -fno-math-errno -ffp-contract=fast
        -include cuda_runtime.h -I${hip} -I${PROJECT_SOURCE_DIR} -DNACRE_HAS_CUDA=1 -DNACRE_HIP=1 -Wno-unused-result
        -MD -MF ${object}.d -c ${source} -o ${object}
      COMMENT "Building HIP object ${name}.hip.o")
    target_sources(${target} PRIVATE ${object})
    set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  endforeach()
  target_include_directories(${target} BEFORE PUBLIC ${hip})
  target_compile_definitions(${target} PUBLIC NACRE_HAS_CUDA=1 NACRE_HIP=1 __HIP_PLATFORM_AMD__=1)
  target_link_libraries(${target} PUBLIC ${NACRE_AMDHIP})
endfunction()
