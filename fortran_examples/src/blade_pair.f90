!> Two neighbouring titanium blades, reduced to the degrees of freedom that contacts and excitation see.
!>
!> Each blade is a Timoshenko beam that bends in the circumferential direction. Its foot sits in a dovetail slot: the
!> flanks, pressed together by the centrifugal force, carry the deflection w in their normal direction (a stiff
!> spring) and part of the rocking of the foot (a spring: the pressure moves along the flanks). The rest of the rocking
!> is carried by friction: a rotation theta of the foot slides the two flanks, a lever r away from the axis of the
!> blade, by +r theta and -r theta. By symmetry both flanks see the same loop, so one coordinate, r theta, serves both.
!>
!> The platform is a rigid mass 30 mm above the foot. The damper is pressed against the undersides of the two platforms
!> and seated in the second one, so that it slides on the first. Where it touches, an underside moves by
!> w - e theta, with e the distance from the axis of the platform to its underside.
module blade_pair
  use craig_bampton, only: reduce
  use dense_algebra, only: symmetric_modes
  use kinds, only: name_length, wp
  use timoshenko_beam, only: beam_element, beam_section
  implicit none
  private
  public :: build_blade_pair, full_blade, reduced_blade, blade_young_modulus

  real(wp), parameter :: young_modulus = 114.0e9_wp       ! Ti-6Al-4V, Pa
  real(wp), parameter :: poisson_ratio = 0.32_wp
  real(wp), parameter :: density = 4430.0_wp              ! kg/m3
  real(wp), parameter :: blade_length = 0.120_wp          ! m
  real(wp), parameter :: blade_width = 0.040_wp
  real(wp), parameter :: blade_thickness = 0.006_wp
  integer, parameter :: elements = 24
  integer, parameter :: platform_node = 6                 ! 30 mm above the foot, node 0

  real(wp), parameter :: foot_stiffness = 5.0e8_wp        ! flanks in their normal direction, N/m
  real(wp), parameter :: rocking_stiffness = 2.0e4_wp     ! rocking not carried by friction, N m/rad
  real(wp), parameter :: flank_lever = 0.008_wp           ! r, m
  real(wp), parameter :: platform_mass = 0.012_wp         ! kg
  real(wp), parameter :: platform_inertia = 4.0e-7_wp     ! kg m2
  real(wp), parameter :: underside_distance = 0.003_wp    ! e, m

  real(wp), parameter :: mistuning = 0.005_wp             ! of the stiffness of the second blade
  real(wp), parameter :: damping_ratio = 1.0e-3_wp        ! material and air, in all modes
  integer, parameter :: modes_kept = 8                    ! of each blade, with its boundary fixed

  character(len=8), parameter :: boundary_name(3) = ['root    ', 'platform', 'tip     ']

contains

  !> Young's modulus of blade 1 or 2.
  pure function blade_young_modulus(blade) result(modulus)
    integer, intent(in) :: blade
    real(wp) :: modulus

    modulus = young_modulus * merge(1.0_wp, 1.0_wp + mistuning, blade == 1)
  end function blade_young_modulus

  !> Matrices and names of both blades; boundary of blade 1, its modes, then blade 2 alike.
  subroutine build_blade_pair(mass, damping, stiffness, names)
    real(wp), allocatable, intent(out) :: mass(:,:), damping(:,:), stiffness(:,:)
    character(len=name_length), allocatable, intent(out) :: names(:)
    real(wp), allocatable :: blade_mass(:,:), blade_stiffness(:,:)
    integer :: blade, first, last, n, i

    n = size(boundary_name) + modes_kept
    allocate (mass(2*n, 2*n), stiffness(2*n, 2*n), damping(2*n, 2*n), source=0.0_wp)
    allocate (names(2*n))
    do blade = 1, 2
      first = (blade - 1) * n + 1
      last = blade * n
      call reduced_blade(blade, blade_mass, blade_stiffness)
      mass(first:last, first:last) = blade_mass
      stiffness(first:last, first:last) = blade_stiffness
      damping(first:last, first:last) = modal_damping(blade_mass, blade_stiffness)
      do i = 1, size(boundary_name)
        write (names(first + i - 1), '(2a, i0)') trim(boundary_name(i)), '_', blade
      end do
      do i = 1, modes_kept
        write (names(first + size(boundary_name) + i - 1), '(a, i0, a, i0)') 'mode_', i, '_', blade
      end do
    end do
  end subroutine build_blade_pair

  subroutine reduced_blade(blade, mass, stiffness)
    integer, intent(in) :: blade
    real(wp), allocatable, intent(out) :: mass(:,:), stiffness(:,:)
    real(wp), allocatable :: all_mass(:,:), all_stiffness(:,:)

    call full_blade(blade, all_mass, all_stiffness)
    call reduce(all_mass, all_stiffness, [rotation(0), deflection(platform_node), deflection(elements)], &
                modes_kept, mass, stiffness)
  end subroutine reduced_blade

  !> All degrees of freedom of one blade, with the rotation of the foot replaced by the sliding of the flanks and the
  !> deflection of the platform by that of its underside.
  subroutine full_blade(blade, mass, stiffness)
    integer, intent(in) :: blade
    real(wp), allocatable, intent(out) :: mass(:,:), stiffness(:,:)
    real(wp) :: element_stiffness(4, 4), element_mass(4, 4), area, second_moment, modulus
    real(wp), allocatable :: change(:,:)
    integer :: e, n, i

    area = blade_width * blade_thickness
    second_moment = blade_width * blade_thickness**3 / 12.0_wp
    modulus = blade_young_modulus(blade)
    call beam_element(beam_section( &
      bending_stiffness=modulus * second_moment, &
      shear_stiffness=5.0_wp / 6.0_wp * modulus / (2.0_wp * (1.0_wp + poisson_ratio)) * area, &
      mass_per_length=density * area, &
      inertia_per_length=density * second_moment), &
      blade_length / elements, element_stiffness, element_mass)

    n = 2 * (elements + 1)
    allocate (mass(n, n), stiffness(n, n), change(n, n), source=0.0_wp)
    do e = 1, elements
      associate (d => [(i, i=2*e - 1, 2*e + 2)])
        stiffness(d, d) = stiffness(d, d) + element_stiffness
        mass(d, d) = mass(d, d) + element_mass
      end associate
    end do
    call add(stiffness, deflection(0), foot_stiffness)
    call add(stiffness, rotation(0), rocking_stiffness)
    call add(mass, deflection(platform_node), platform_mass)
    call add(mass, rotation(platform_node), platform_inertia)

    do i = 1, n
      change(i, i) = 1.0_wp
    end do
    change(rotation(0), rotation(0)) = 1.0_wp / flank_lever
    change(deflection(platform_node), rotation(platform_node)) = underside_distance
    mass = matmul(transpose(change), matmul(mass, change))
    stiffness = matmul(transpose(change), matmul(stiffness, change))

  contains

    pure subroutine add(matrix, dof, value)
      real(wp), intent(inout) :: matrix(:,:)
      integer, intent(in) :: dof
      real(wp), intent(in) :: value
      matrix(dof, dof) = matrix(dof, dof) + value
    end subroutine add
  end subroutine full_blade

  !> The same damping ratio in all modes of the blade with open contacts: D = M Phi diag(2 zeta omega) Phi^T M.
  function modal_damping(mass, stiffness) result(damping)
    real(wp), intent(in) :: mass(:,:), stiffness(:,:)
    real(wp) :: damping(size(mass, 1), size(mass, 1))
    real(wp) :: omega(size(mass, 1)), modes(size(mass, 1), size(mass, 1)), scaled(size(mass, 1), size(mass, 1))
    integer :: i

    call symmetric_modes(stiffness, mass, omega, modes)
    modes = matmul(mass, modes)
    do i = 1, size(omega)
      scaled(:, i) = 2.0_wp * damping_ratio * omega(i) * modes(:, i)
    end do
    damping = matmul(scaled, transpose(modes))
    damping = 0.5_wp * (damping + transpose(damping))
  end function modal_damping

  pure integer function deflection(node)
    integer, intent(in) :: node
    deflection = 2 * node + 1
  end function deflection

  pure integer function rotation(node)
    integer, intent(in) :: node
    rotation = 2 * node + 2
  end function rotation
end module blade_pair
