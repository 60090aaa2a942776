!> Plane Timoshenko beam element with two nodes. Degrees of freedom: deflection and rotation at each node.
!>
!> The interpolation satisfies the static equations of the beam exactly (Friedman and Kosmatka, Computers and
!> Structures 47, 1993), so that thin beams do not lock.
module timoshenko_beam
  use kinds, only: wp
  implicit none
  private
  public :: beam_section, beam_element

  type :: beam_section
    real(wp) :: bending_stiffness       !! E I
    real(wp) :: shear_stiffness         !! kappa G A
    real(wp) :: mass_per_length         !! rho A
    real(wp) :: inertia_per_length      !! rho I
  end type beam_section

contains

  pure subroutine beam_element(section, length, stiffness, mass)
    type(beam_section), intent(in) :: section
    real(wp), intent(in) :: length
    real(wp), intent(out) :: stiffness(4, 4), mass(4, 4)
    ! Gauss points and weights on [0, 1]: the mass has polynomials of degree 6.
    real(wp), parameter :: inner = sqrt(3.0_wp / 7.0_wp - 2.0_wp / 7.0_wp * sqrt(1.2_wp))
    real(wp), parameter :: outer = sqrt(3.0_wp / 7.0_wp + 2.0_wp / 7.0_wp * sqrt(1.2_wp))
    real(wp), parameter :: point(4) = 0.5_wp * (1.0_wp + [-outer, -inner, inner, outer])
    real(wp), parameter :: inner_weight = (18.0_wp + sqrt(30.0_wp)) / 72.0_wp
    real(wp), parameter :: weight(4) = [0.5_wp - inner_weight, inner_weight, inner_weight, 0.5_wp - inner_weight]
    real(wp) :: shear, deflection(4), rotation(4), x, l
    integer :: g, i

    l = length
    shear = 12.0_wp * section%bending_stiffness / (section%shear_stiffness * l**2)

    stiffness = reshape([ &
      12.0_wp,     6.0_wp * l,            -12.0_wp,    6.0_wp * l, &
      6.0_wp * l,  (4.0_wp + shear) * l**2, -6.0_wp * l, (2.0_wp - shear) * l**2, &
      -12.0_wp,    -6.0_wp * l,           12.0_wp,     -6.0_wp * l, &
      6.0_wp * l,  (2.0_wp - shear) * l**2, -6.0_wp * l, (4.0_wp + shear) * l**2], [4, 4])
    stiffness = stiffness * section%bending_stiffness / (l**3 * (1.0_wp + shear))

    mass = 0.0_wp
    do g = 1, size(point)
      x = point(g)
      deflection = [1.0_wp - 3.0_wp * x**2 + 2.0_wp * x**3 + shear * (1.0_wp - x), &
                    l * (x - 2.0_wp * x**2 + x**3 + 0.5_wp * shear * (x - x**2)), &
                    3.0_wp * x**2 - 2.0_wp * x**3 + shear * x, &
                    l * (-x**2 + x**3 + 0.5_wp * shear * (x**2 - x))] / (1.0_wp + shear)
      rotation = [6.0_wp / l * (x**2 - x), &
                  1.0_wp - 4.0_wp * x + 3.0_wp * x**2 + shear * (1.0_wp - x), &
                  6.0_wp / l * (x - x**2), &
                  3.0_wp * x**2 - 2.0_wp * x + shear * x] / (1.0_wp + shear)
      do i = 1, 4
        mass(:, i) = mass(:, i) + weight(g) * l * ( &
                     section%mass_per_length * deflection * deflection(i) &
                     + section%inertia_per_length * rotation * rotation(i))
      end do
    end do
  end subroutine beam_element
end module timoshenko_beam
