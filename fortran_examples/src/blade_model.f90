!> Two neighbouring titanium blades as finite elements, reduced to the degrees of freedom of contacts and excitation.
!>
!>     blade_model write|check DIRECTORY       the model files, or whether they are those of this program
!>
!> Each blade is a Timoshenko beam that bends in the circumferential direction. Its foot sits in a dovetail slot: the
!> flanks, pressed together by the centrifugal force, carry the deflection w in their normal direction (a stiff
!> spring) and part of the rocking of the foot (a spring: the pressure moves along the flanks). The rest of the rocking
!> is carried by friction: a rotation theta of the foot slides the two flanks, a lever r away from the axis of the
!> blade, by +r theta and -r theta. By symmetry both flanks have the same loop, so one coordinate, r theta, serves both.
!>
!> The platform is a rigid mass 30 mm above the foot. There are two models:
!>
!> blades   The damper is pressed against the undersides of the two platforms and seated in the second one, so that it slides on
!>          the first. At the damper an underside moves by w - e theta, with e the distance from the axis of the platform to its
!>          underside.
!> wedge    The damper is a rigid body that moves in the circumferential and the radial direction, x and r. It lies between two
!>          inclined undersides, at a distance s from the axes of the blades, where these also move radially: the rotation theta
!>          moves that of the first blade by -s theta and that of the second, on the other side of its axis, by +s theta.
program blade_model
  use basics, only: argument, fail, name_length, open_table, path_length, pi, progress, text, wp
  use dense_algebra, only: solve, symmetric_modes
  use linear_structure, only: read_matrix, write_matrix
  implicit none

  character(len=*), parameter :: usage = 'blade_model write|check DIRECTORY'
  real(wp), parameter :: young_modulus = 114.0e9_wp       ! Ti-6Al-4V, Pa
  real(wp), parameter :: poisson_ratio = 0.32_wp
  real(wp), parameter :: density = 4430.0_wp              ! kg/m3
  real(wp), parameter :: blade_length = 0.120_wp          ! m
  real(wp), parameter :: blade_width = 0.040_wp
  real(wp), parameter :: blade_thickness = 0.006_wp
  integer, parameter :: elements = 24, n = 2 * (elements + 1)
  integer, parameter :: platform_node = 6                 ! 30 mm above the foot, node 0

  real(wp), parameter :: foot_stiffness = 5.0e8_wp        ! flanks in their normal direction, N/m
  real(wp), parameter :: rocking_stiffness = 2.0e4_wp     ! rocking not carried by friction, N m/rad
  real(wp), parameter :: flank_lever = 0.008_wp           ! r, m
  real(wp), parameter :: platform_mass = 0.012_wp         ! kg
  real(wp), parameter :: platform_inertia = 4.0e-7_wp     ! kg m2
  real(wp), parameter :: underside_distance = 0.003_wp    ! e, m
  real(wp), parameter :: damper_distance = 0.014_wp       ! s, m
  real(wp), parameter :: damper_mass = 0.020_wp           ! kg
  real(wp), parameter :: platform_angle = pi / 4.0_wp     ! of the undersides to the circumferential direction
  real(wp), parameter :: dashpot = 150.0_wp               ! N s/m

  real(wp), parameter :: mistuning = 0.005_wp             ! of the stiffness of the second blade
  real(wp), parameter :: material_damping = 1.0e-3_wp, aerodynamic_damping = 4.0e-3_wp   ! damping ratios, in all modes
  integer, parameter :: modes_kept = 8                    ! of each blade, with its boundary fixed
  integer, parameter :: platform = 2 * platform_node + 1  ! deflection; followed by the rotation

  ! Largest change of a natural frequency by the reduction, and of an entry of the matrices, relative to the diagonal: another
  ! LAPACK changes the modes by its rounding error times the condition of the stiffness matrix, about 1e-16 * 1e6.
  real(wp), parameter :: reduction_tolerance = 1.0e-3_wp, file_tolerance = 1.0e-9_wp

  character(len=path_length) :: directory
  real(wp), allocatable, dimension(:,:) :: mass, damping, stiffness
  real(wp) :: blade_mass(n, n), blade_stiffness(n, n)
  character(len=name_length), allocatable :: boundary_name(:)
  integer, allocatable :: boundary(:)
  integer :: reduced

  directory = argument(2, usage)
  boundary = [2, platform, 2 * elements + 1]          ! rotation, deflection, deflection
  boundary_name = [character(len=name_length) :: 'root', 'platform', 'tip']
  call make_model('blades', 'two blades', [1.0_wp, 1.0_wp], material_damping, free_bodies=0)
  boundary = [2, platform, platform + 1, 2 * elements + 1]
  boundary_name = [character(len=name_length) :: 'root', 'platform', 'platform_radial', 'tip']
  call make_model('wedge', 'two blades with a wedge damper', [-damper_distance, damper_distance], &
                  material_damping + aerodynamic_damping, free_bodies=1)

contains

  !> The blades, and after them the translations of the damper.
  subroutine make_model(name, description, levers, damping_ratio, free_bodies)
    character(len=*), intent(in) :: name, description
    real(wp), intent(in) :: levers(2), damping_ratio
    integer, intent(in) :: free_bodies
    character(len=:), allocatable :: prefix
    real(wp), allocatable :: omega(:), modes(:,:)
    integer :: blade, first, last, unit, i

    reduced = size(boundary) + modes_kept
    last = 2 * reduced + 2 * free_bodies
    if (allocated(mass)) deallocate (mass, damping, stiffness)
    allocate (mass(last, last), damping(last, last), stiffness(last, last), source=0.0_wp)
    allocate (omega(reduced), modes(reduced, reduced))
    do blade = 1, 2
      first = (blade - 1) * reduced + 1
      last = blade * reduced
      call assemble(young_modulus * merge(1.0_wp, 1.0_wp + mistuning, blade == 1), &
                    levers(blade), blade_mass, blade_stiffness)
      call reduce(blade_mass, blade_stiffness, mass(first:last, first:last), stiffness(first:last, first:last))
      damping(first:last, first:last) = modal_damping(mass(first:last, first:last), stiffness(first:last, first:last), &
                                                          damping_ratio)
      call check_reduction(blade, first, last)
    end do
    ! A free body decays like the first mode of the blades.
    call symmetric_modes(stiffness(:reduced, :reduced), mass(:reduced, :reduced), omega, modes)
    do i = 2 * reduced + 1, size(mass, 1)
      mass(i, i) = damper_mass
      damping(i, i) = 2.0_wp * damping_ratio * omega(1) * damper_mass
    end do

    if (free_bodies == 1) call add_dashpots()

    prefix = trim(directory)//'/'//name//'_'
    select case (argument(1, usage))
    case ('write')
      call write_matrix(prefix//'mass.mtx', 'mass of '//description//', kg', mass)
      call write_matrix(prefix//'damping.mtx', 'damping of '//description//', N s/m', damping)
      call write_matrix(prefix//'stiffness.mtx', 'stiffness of '//description//', contacts open, N/m', stiffness)
      unit = open_table(prefix//'dof.txt', '# degrees of freedom of '//description//'; modes are mass-normalised')
      do blade = 1, 2
        do i = 1, reduced
          write (unit, '(4a)') text(i + (blade - 1) * reduced), ' ', trim(dof_name(i)), '_'//text(blade)
        end do
      end do
      if (free_bodies == 1) write (unit, '(2a)') text(2 * reduced + 1), ' damper_x', text(2 * reduced + 2), ' damper_r'
      close (unit)
    case ('check')
      call compare(prefix, 'mass', mass)
      call compare(prefix, 'damping', damping)
      call compare(prefix, 'stiffness', stiffness)
    case default
      call fail('usage: '//usage)
    end select
  end subroutine make_model

  !> Dashpots between damper and platforms, normal to the faces.
  subroutine add_dashpots()
    real(wp) :: normal(size(mass, 1))
    integer :: blade, i

    do blade = 1, 2
      normal = 0.0_wp
      normal(2 * reduced + 1:) = [merge(-1.0_wp, 1.0_wp, blade == 1) * sin(platform_angle), cos(platform_angle)]
      i = (blade - 1) * reduced + 2             ! platform, followed by platform_radial
      normal(i:i + 1) = -normal(2 * reduced + 1:)
      do i = 1, size(normal)
        damping(:, i) = damping(:, i) + dashpot * normal(i) * normal
      end do
    end do
  end subroutine add_dashpots

  pure function dof_name(i) result(name)
    integer, intent(in) :: i
    character(len=name_length) :: name

    name = boundary_name(min(i, size(boundary)))
    if (i > size(boundary)) name = 'mode_'//text(i - size(boundary))
  end function dof_name

  !> Stiffness and mass of one Timoshenko element, (deflection, rotation) at both nodes. Its interpolation satisfies the static
  !> equations exactly (Friedman and Kosmatka, Computers and Structures 47, 1993), so that thin beams do not lock.
  pure subroutine beam_element(modulus, l, k, m)
    real(wp), intent(in) :: modulus, l
    real(wp), intent(out) :: k(4, 4), m(4, 4)
    ! Gauss points and weights on [0, 1]: the mass has polynomials of degree 6.
    real(wp), parameter :: inner = sqrt(3.0_wp / 7.0_wp - 2.0_wp / 7.0_wp * sqrt(1.2_wp))
    real(wp), parameter :: outer = sqrt(3.0_wp / 7.0_wp + 2.0_wp / 7.0_wp * sqrt(1.2_wp))
    real(wp), parameter :: point(4) = 0.5_wp * (1.0_wp + [-outer, -inner, inner, outer])
    real(wp), parameter :: inner_weight = (18.0_wp + sqrt(30.0_wp)) / 72.0_wp
    real(wp), parameter :: weight(4) = [0.5_wp - inner_weight, inner_weight, inner_weight, 0.5_wp - inner_weight]
    real(wp), parameter :: area = blade_width * blade_thickness, second_moment = area * blade_thickness**2 / 12.0_wp
    real(wp) :: bending, shear, deflection(4), rotation(4), x
    integer :: g, i

    bending = modulus * second_moment
    shear = 12.0_wp * bending / (5.0_wp / 6.0_wp * modulus / (2.0_wp * (1.0_wp + poisson_ratio)) * area * l**2)
    k = reshape([12.0_wp,    6.0_wp * l,             -12.0_wp,    6.0_wp * l, &
                 6.0_wp * l, (4.0_wp + shear) * l**2, -6.0_wp * l, (2.0_wp - shear) * l**2, &
                 -12.0_wp,   -6.0_wp * l,            12.0_wp,     -6.0_wp * l, &
                 6.0_wp * l, (2.0_wp - shear) * l**2, -6.0_wp * l, (4.0_wp + shear) * l**2], [4, 4])
    k = k * bending / (l**3 * (1.0_wp + shear))

    m = 0.0_wp
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
        m(:, i) = m(:, i) + weight(g) * l * density * (area * deflection * deflection(i) &
                                                       + second_moment * rotation * rotation(i))
      end do
    end do
  end subroutine beam_element

  !> All degrees of freedom of one blade, deflection and rotation of nodes 0, 1, ...; the rotation of the foot is replaced by
  !> the sliding of the flanks, the deflection of the platform by that of its underside, and the rotation of the platform by the
  !> radial displacement of that side, `lever` times as large.
  subroutine assemble(modulus, lever, m, k)
    real(wp), intent(in) :: modulus, lever
    real(wp), intent(out) :: m(n, n), k(n, n)
    real(wp) :: element_stiffness(4, 4), element_mass(4, 4), change(n, n)
    integer :: d, i

    call beam_element(modulus, blade_length / elements, element_stiffness, element_mass)
    m = 0.0_wp
    k = 0.0_wp
    do d = 1, n - 3, 2
      k(d:d + 3, d:d + 3) = k(d:d + 3, d:d + 3) + element_stiffness
      m(d:d + 3, d:d + 3) = m(d:d + 3, d:d + 3) + element_mass
    end do
    k(1, 1) = k(1, 1) + foot_stiffness
    k(2, 2) = k(2, 2) + rocking_stiffness
    m(platform, platform) = m(platform, platform) + platform_mass
    m(platform + 1, platform + 1) = m(platform + 1, platform + 1) + platform_inertia
    change = 0.0_wp
    do i = 1, n
      change(i, i) = 1.0_wp
    end do
    change(2, 2) = 1.0_wp / flank_lever
    change(platform, platform + 1) = underside_distance / lever
    change(platform + 1, platform + 1) = 1.0_wp / lever
    m = matmul(transpose(change), matmul(m, change))
    k = matmul(transpose(change), matmul(k, change))
  end subroutine assemble

  !> Reduction to the boundary, which stays physical, and modes with the boundary fixed (Craig and Bampton, AIAA Journal 6,
  !> 1968).
  subroutine reduce(m, k, reduced_mass, reduced_stiffness)
    real(wp), intent(in) :: m(n, n), k(n, n)
    real(wp), intent(out) :: reduced_mass(reduced, reduced), reduced_stiffness(reduced, reduced)
    real(wp) :: basis(n, reduced), static(n - size(boundary), size(boundary)), factor(n - size(boundary), n - size(boundary))
    real(wp) :: modes(n - size(boundary), n - size(boundary)), omega(n - size(boundary))
    integer :: interior(n - size(boundary)), i

    interior = pack([(i, i=1, n)], [(all(boundary /= i), i=1, n)])
    ! Static deflections of the interior under unit displacements of the boundary.
    factor = k(interior, interior)
    static = -k(interior, boundary)
    call solve(factor, static)
    call symmetric_modes(k(interior, interior), m(interior, interior), omega, modes)

    basis = 0.0_wp
    do i = 1, size(boundary)
      basis(boundary(i), i) = 1.0_wp
    end do
    basis(interior, :size(boundary)) = static
    do i = 1, modes_kept
      ! The sign of a mode is arbitrary; a fixed choice makes the files independent of the LAPACK.
      basis(interior, size(boundary) + i) = sign(1.0_wp, sum(modes(:, i))) * modes(:, i)
    end do
    reduced_mass = matmul(transpose(basis), matmul(m, basis))
    reduced_stiffness = matmul(transpose(basis), matmul(k, basis))
    reduced_mass = 0.5_wp * (reduced_mass + transpose(reduced_mass))
    reduced_stiffness = 0.5_wp * (reduced_stiffness + transpose(reduced_stiffness))
  end subroutine reduce

  !> The same damping ratio in all modes of the blade with open contacts: D = M Phi diag(2 zeta omega) Phi^T M.
  function modal_damping(m, k, damping_ratio) result(d)
    real(wp), intent(in) :: m(:,:), k(:,:), damping_ratio
    real(wp) :: d(size(m, 1), size(m, 1)), omega(size(m, 1)), modes(size(m, 1), size(m, 1)), scaled(size(m, 1), size(m, 1))
    integer :: i

    call symmetric_modes(k, m, omega, modes)
    modes = matmul(m, modes)
    do i = 1, size(omega)
      scaled(:, i) = 2.0_wp * damping_ratio * omega(i) * modes(:, i)
    end do
    d = matmul(scaled, transpose(modes))
    d = 0.5_wp * (d + transpose(d))
  end function modal_damping

  !> Natural frequencies of the reduced blade against those of all its elements, with open contacts.
  subroutine check_reduction(blade, first, last)
    integer, intent(in) :: blade, first, last
    real(wp) :: full(n), few(reduced), modes(n, n)
    integer :: i

    call symmetric_modes(blade_stiffness, blade_mass, full, modes)
    call symmetric_modes(stiffness(first:last, first:last), mass(first:last, first:last), few, modes(:reduced, :reduced))
    do i = 1, 4
      call progress('blade '//text(blade)//', mode '//text(i)//', contacts open: '//text(full(i) / (2.0_wp * pi), '(f10.2)')// &
                    ' Hz, reduced '//text(few(i) / (2.0_wp * pi), '(f10.2)')//' Hz')
      if (abs(few(i) / full(i) - 1.0_wp) > reduction_tolerance) call fail('the reduction needs more modes')
    end do
  end subroutine check_reduction

  subroutine compare(prefix, name, expected)
    character(len=*), intent(in) :: prefix, name
    real(wp), intent(in) :: expected(:,:)
    real(wp), allocatable :: stored(:,:)
    integer :: i, j

    call read_matrix(prefix//name//'.mtx', size(expected, 1), stored)
    do j = 1, size(expected, 2)
      do i = 1, size(expected, 1)
        if (.not. abs(stored(i, j) - expected(i, j)) <= file_tolerance * sqrt(expected(i, i) * expected(j, j))) then
          call fail(prefix//name//'.mtx: row '//text(i)//', column '//text(j)//' differs: run "blade_model write"')
        end if
      end do
    end do
  end subroutine compare
end program blade_model
