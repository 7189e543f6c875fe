# Nacre: finds CGAL by its headers, with the exact numbers (GMP, MPFR) that its predicates fall back on. CGAL's own
# CMake files are not used: they print messages on build types and look for much that the Delaunay triangulation does
# not need.
include(FindPackageHandleStandardArgs)
find_path(CGAL_INCLUDE CGAL/Delaunay_triangulation_3.h)
find_path(CGAL_BOOST_INCLUDE boost/version.hpp)
find_library(CGAL_GMP gmp)
find_library(CGAL_MPFR mpfr)
mark_as_advanced(CGAL_INCLUDE CGAL_BOOST_INCLUDE CGAL_GMP CGAL_MPFR)
if(CGAL_INCLUDE)
  file(STRINGS ${CGAL_INCLUDE}/CGAL/version.h Cgal_VERSION REGEX "define CGAL_VERSION [0-9.]+")
  string(REGEX MATCH "[0-9.]+$" Cgal_VERSION "${Cgal_VERSION}")
endif()
find_package_handle_standard_args(Cgal REQUIRED_VARS CGAL_INCLUDE CGAL_BOOST_INCLUDE CGAL_GMP CGAL_MPFR
  VERSION_VAR Cgal_VERSION)
if(Cgal_FOUND AND NOT TARGET cgal::cgal)
  add_library(cgal::cgal INTERFACE IMPORTED GLOBAL)
  target_include_directories(cgal::cgal SYSTEM INTERFACE ${CGAL_INCLUDE} ${CGAL_BOOST_INCLUDE})
  target_link_libraries(cgal::cgal INTERFACE TBB::tbb TBB::tbbmalloc ${CGAL_MPFR} ${CGAL_GMP})
  target_compile_definitions(cgal::cgal INTERFACE CGAL_USE_GMP=1 CGAL_USE_MPFR=1 CGAL_LINKED_WITH_TBB)
  # Interval arithmetic changes the rounding mode; contraction would make results differ from machine to machine.
  target_compile_options(cgal::cgal INTERFACE -frounding-math -ffp-contract=off)
endif()
