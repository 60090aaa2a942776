# find_package(microslip) defines the targets
#
#   microslip::microslip   the static library
#   microslip::shared      the shared library, if installed
#   microslip::fortran     the Fortran module and the static library, if the project has enabled Fortran
#
# The paths are relative to this file, so the installed tree may be moved.

get_filename_component(_microslip_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET microslip::microslip)
  add_library(microslip::microslip STATIC IMPORTED)
  set_target_properties(microslip::microslip PROPERTIES
    IMPORTED_LOCATION "${_microslip_prefix}/lib/libmicroslip.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_microslip_prefix}/include"
    INTERFACE_LINK_LIBRARIES m)
endif()

if(NOT TARGET microslip::shared AND EXISTS "${_microslip_prefix}/lib/libmicroslip.so")
  add_library(microslip::shared SHARED IMPORTED)
  set_target_properties(microslip::shared PROPERTIES
    IMPORTED_LOCATION "${_microslip_prefix}/lib/libmicroslip.so"
    INTERFACE_INCLUDE_DIRECTORIES "${_microslip_prefix}/include")
endif()

if(CMAKE_Fortran_COMPILER_LOADED AND NOT TARGET microslip::fortran)
  # Module files depend on the compiler: the module is compiled once, in the build tree of the project.
  if(NOT TARGET microslip_fortran)
    set(_microslip_modules "${CMAKE_CURRENT_BINARY_DIR}/microslip_modules")
    file(MAKE_DIRECTORY "${_microslip_modules}") # older versions of CMake require that it exists
    add_library(microslip_fortran STATIC EXCLUDE_FROM_ALL "${_microslip_prefix}/include/microslip.f90")
    set_target_properties(microslip_fortran PROPERTIES
      Fortran_FORMAT FREE
      Fortran_MODULE_DIRECTORY "${_microslip_modules}"
      POSITION_INDEPENDENT_CODE ON)
    target_include_directories(microslip_fortran INTERFACE "${_microslip_modules}")
    target_link_libraries(microslip_fortran PUBLIC microslip::microslip)
    unset(_microslip_modules)
  endif()

  # Imported, so that a project can export targets that are linked with it.
  add_library(microslip::fortran INTERFACE IMPORTED)
  set_target_properties(microslip::fortran PROPERTIES INTERFACE_LINK_LIBRARIES microslip_fortran)
endif()

unset(_microslip_prefix)
