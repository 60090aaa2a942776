!> Kinds and constants shared by all programs.
module kinds
  use, intrinsic :: iso_fortran_env, only: real64
  implicit none
  private

  integer, parameter, public :: wp = real64
  real(wp), parameter, public :: pi = acos(-1.0_wp)
  integer, parameter, public :: path_length = 256
  integer, parameter, public :: name_length = 32
end module kinds
