! A sum over the bits of what the compiler's runtime computes in quadruple precision, real and complex. Compiled as
! -cpp -DGUEST the host calls the library as well.
program quadruple
  use, intrinsic :: iso_fortran_env, only: int64, real128
#ifdef GUEST
  use microslip
#endif
  implicit none
  integer, parameter :: rounds = 20000
  integer(int64) :: bits, state
  real(real128), volatile :: x, y, results(6)
  complex(real128), volatile :: z, w, products(4)
  complex(kind(1d0)), volatile :: narrow(2)
  integer :: i

#ifdef GUEST
  call ask_guest
#endif
  bits = 0
  state = 88172645463325252_int64
  do i = 1, rounds
    x = any_number(); y = any_number(); z = cmplx(x, any_number(), real128); w = cmplx(y, any_number(), real128)
    results = [x + y, x*y, x/y, sqrt(abs(x)), real(real(x, kind(1d0)), real128), real(int(1000*x), real128)]
    products = [z*w, z/w, exp(z), sqrt(w)]
    narrow = [cmplx(z, kind=kind(1d0))*cmplx(w, kind=kind(1d0)), cmplx(z, kind=kind(1d0))/cmplx(w, kind=kind(1d0))]
    call take(transfer(results, [bits]))
    call take(transfer(products, [bits]))
    call take(transfer(narrow, [bits]))
  end do
  print '(z16.16)', bits
#ifdef GUEST
  call ask_guest
#endif

contains

  subroutine take(words)
    integer(int64), intent(in) :: words(:)
    integer :: k
    do k = 1, size(words)
      bits = ieor(ishftc(bits, 7), words(k))
    end do
  end subroutine take

  ! In -1 to 1, with all digits.
  function any_number() result(number)
    real(real128) :: number
    number = draw()*2.0_real128**(-63) + draw()*2.0_real128**(-116)
  end function any_number

  function draw() result(word)
    real(real128) :: word
    state = ieor(state, ishft(state, 13))
    state = ieor(state, ishft(state, -7))
    state = ieor(state, ishft(state, 17))
    word = real(state, real128)
  end function draw

#ifdef GUEST
  subroutine ask_guest
    type(mslip_parameters) :: p
    type(mslip_contact) :: contact
    integer(mslip_int) :: status
    real(mslip_real) :: k_real(2), k_imag(2)
    call mslip_parameters_default(p)
    p%flat_half_width = 3e-4_mslip_real; p%edge_radius = 2e-3_mslip_real; p%length = 2e-2_mslip_real
    p%normal_force = 100; p%friction_coefficient = 0.4_mslip_real
    p%material = mslip_material(2.1e11_mslip_real, 0.3_mslip_real)
    call mslip_contact_init(p, contact, status)
    if (status /= MSLIP_OK) error stop 'no contact'
    call mslip_complex_stiffness(contact, contact%slip_displacement*[0.5_mslip_real, 2.0_mslip_real], status, k_real, k_imag)
    if (status /= MSLIP_OK .or. any(k_imag <= 0)) error stop 'no stiffness'
  end subroutine ask_guest
#endif
end program quadruple
