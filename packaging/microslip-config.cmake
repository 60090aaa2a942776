# find_package(microslip): the targets
#
#   microslip::microslip   the static library
#   microslip::shared      the shared one, where it was installed
#   microslip::fortran     the source of the Fortran module, with the static library; to be linked PRIVATE
#
# The paths are relative to this file, so the installed tree may be moved.

get_filename_component(_microslip_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

# Compile this file with the program that uses it: module files depend on the compiler.
set(microslip_FORTRAN_MODULE "${_microslip_prefix}/include/microslip.f90")

if(NOT TARGET microslip::microslip)
  add_library(microslip::microslip STATIC IMPORTED)
  set_target_properties(microslip::microslip PROPERTIES
    IMPORTED_LOCATION "${_microslip_prefix}/lib/libmicroslip.a"
    INTERFACE_INCLUDE_DIRECTORIES "${_microslip_prefix}/include"
    INTERFACE_LINK_LIBRARIES m)

  add_library(microslip::fortran INTERFACE IMPORTED)
  set_target_properties(microslip::fortran PROPERTIES
    INTERFACE_SOURCES "${microslip_FORTRAN_MODULE}"
    INTERFACE_LINK_LIBRARIES microslip::microslip)

  if(EXISTS "${_microslip_prefix}/lib/libmicroslip.so")
    add_library(microslip::shared SHARED IMPORTED)
    set_target_properties(microslip::shared PROPERTIES
      IMPORTED_LOCATION "${_microslip_prefix}/lib/libmicroslip.so"
      INTERFACE_INCLUDE_DIRECTORIES "${_microslip_prefix}/include")
  endif()
endif()

unset(_microslip_prefix)
