!> Multi-harmonic balance of a linear structure with friction contacts, condensed to the contacts.
!>
!> The structure is linear, so at one frequency the relative displacements u of the contacts follow from the contact
!> forces f(u) through the dynamic compliance C seen from the contacts:
!>
!>     R(u, omega) = u + C(omega) f(u) - u_free(omega) = 0,    C_k = B^T (K + i k omega D - (k omega)^2 M)^-1 B,
!>
!> with u_free the relative displacements without contact forces. A contact force is an internal force, positive with
!> the relative displacement, hence its sign. The unknowns of Newton's method are u alone, the Fourier coefficients of every
!> component of every contact; f and df/du come from contacts%harmonic_force.
!>
!> Harmonic 0 is the static equilibrium, solved together with the others. A body that is held by its contacts alone, such as a
!> damper, has no static compliance without them. So for k = 0 springs S of the normal stiffness at the normal force of the
!> case are added to the structure and subtracted from the contacts:
!>
!>     C_0 = B^T (K + B S B^T)^-1 B,    f replaced by f - S u.
module harmonic_balance
  use basics, only: wp
  use dense_algebra, only: solve
  use fourier_series, only: get_harmonic, set_harmonic
  use friction_contacts, only: contact_set, max_components
  use linear_structure, only: structure
  implicit none
  private
  public :: evaluate, newton_error, solve_at, solve_from_rest, structure_response

  type, public :: balance_problem
    type(structure) :: model
    type(contact_set) :: contacts
    real(wp), allocatable :: incidence(:,:)       !! B: contact forces to degrees of freedom
    complex(wp), allocatable :: excitation(:)     !! F in Re(F exp(i omega t)), for each degree of freedom
    real(wp), allocatable :: static_load(:)       !! for each degree of freedom
    integer :: harmonics = 0
    real(wp) :: tolerance = 0.0_wp                !! of R, relative to the displacement of each contact
    real(wp), allocatable :: springs(:)           !! S: of normal components; else 0
    real(wp), allocatable :: offset(:)            !! of each component without any displacement of the structure
  end type balance_problem

  !> The balance at one frequency and one set of displacements.
  type, public :: balance_point
    real(wp), allocatable :: residual(:,:)        !! R, (coefficient, component)
    real(wp), allocatable :: jacobian(:,:)        !! dR/du, both in array element order
    real(wp), allocatable :: by_omega(:,:)        !! dR/domega
    real(wp), allocatable :: force(:,:)           !! f(u)
    real(wp), allocatable :: dissipated(:)        !! per period and contact
    real(wp) :: free_size = 0.0_wp                !! largest relative displacement without contact forces
    real(wp), allocatable, private :: spring_force(:)     !! S u for the mean u
    !> Response of all degrees of freedom to contact forces, (dof, component, harmonic), and to loads, (dof, harmonic).
    complex(wp), allocatable, private :: by_force(:,:,:), by_load(:,:)
  end type balance_point

  integer, parameter :: newton_steps = 40, halvings = 8
  !> A residual that no method accepts, for displacements beyond the range of the law.
  real(wp), parameter :: beyond_range = 1.0e100_wp

contains

  !> R and its exact derivatives.
  subroutine evaluate(problem, omega, displacement, point)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(in), contiguous :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    complex(wp), dimension(size(problem%incidence, 1), size(problem%incidence, 1)) :: stiffness, rate
    complex(wp) :: solution(size(problem%incidence, 1), size(problem%incidence, 2) + 1)
    complex(wp), dimension(size(problem%incidence, 2), size(problem%incidence, 2) + 1) :: seen, seen_rate
    complex(wp) :: residual, residual_rate, force
    real(wp) :: contact_jacobian(size(displacement, 1), size(displacement, 1), max_components, size(displacement, 2))
    real(wp) :: rows(2, size(displacement, 1))
    logical :: allowed
    integer :: n, components, m, k, i, j, c, p, row, column

    n = size(problem%incidence, 1)
    components = size(problem%incidence, 2)
    m = size(displacement, 1)
    if (.not. allocated(point%force)) then
      allocate (point%residual(m, components), point%by_omega(m, components), point%force(m, components))
      allocate (point%jacobian(m * components, m * components), point%dissipated(size(problem%contacts%items)))
      allocate (point%spring_force(components), point%by_force(n, components, 0:problem%harmonics))
      allocate (point%by_load(n, 0:problem%harmonics))
    end if
    call problem%contacts%harmonic_force(displacement, point%force, contact_jacobian, point%dissipated, allowed)
    if (.not. allowed) then
      point%residual = beyond_range
      return
    end if

    point%free_size = 0.0_wp
    associate (springs => problem%springs, offset => problem%offset)
      point%spring_force = springs * displacement(1, :)
      do k = 0, problem%harmonics
        stiffness = cmplx(problem%model%stiffness - (k * omega)**2 * problem%model%mass, &
                          k * omega * problem%model%damping, wp)
        rate = cmplx(-2.0_wp * k**2 * omega * problem%model%mass, k * problem%model%damping, wp)
        solution(:, :components) = problem%incidence
        solution(:, components + 1) = merge(problem%excitation, (0.0_wp, 0.0_wp), k == 1)
        if (k == 0) then
          do i = 1, components
            if (springs(i) > 0.0_wp) call add_spring(springs(i), problem%incidence(:, i), stiffness)
          end do
          solution(:, components + 1) = problem%static_load - matmul(problem%incidence, springs * offset)
        end if
        call solve(stiffness, solution)
        ! The matrices are symmetric: B^T d(Z^-1) = -(Z^-1 B)^T dZ Z^-1.
        seen = matmul(transpose(problem%incidence), solution)
        seen_rate = -matmul(transpose(solution(:, :components)), matmul(rate, solution))
        if (k == 0) seen(:, components + 1) = seen(:, components + 1) + offset

        point%by_force(:, :, k) = solution(:, :components)
        point%by_load(:, k) = solution(:, components + 1)
        point%free_size = max(point%free_size, maxval(abs(seen(:, components + 1))))
        do i = 1, components
          residual = get_harmonic(displacement(:, i), k) - seen(i, components + 1)
          residual_rate = -seen_rate(i, components + 1)
          do j = 1, components
            force = get_harmonic(point%force(:, j), k)
            if (k == 0) force = force - point%spring_force(j)
            residual = residual + seen(i, j) * force
            residual_rate = residual_rate + seen_rate(i, j) * force
          end do
          call set_harmonic(point%residual(:, i), k, residual)
          call set_harmonic(point%by_omega(:, i), k, residual_rate)

          row = (i - 1) * m + max(2*k, 1)
          do c = 1, size(problem%contacts%items)
            associate (first => problem%contacts%items(c)%first, last => problem%contacts%items(c)%last)
              do j = first, last
                rows = 0.0_wp
                do p = first, last
                  call add_compliance(seen(i, p), k, contact_jacobian(:, :, p - first + 1, j), rows)
                end do
                if (k == 0) rows(1, 1) = rows(1, 1) - real(seen(i, j)) * springs(j)
                column = (j - 1) * m
                point%jacobian(row:row + min(k, 1), column + 1:column + m) = rows(:1 + min(k, 1), :)
              end do
            end associate
          end do
        end do
      end do
    end associate
    do i = 1, m * components
      point%jacobian(i, i) = point%jacobian(i, i) + 1.0_wp
    end do
  end subroutine evaluate

  pure subroutine add_spring(spring, direction, stiffness)
    real(wp), intent(in) :: spring, direction(:)
    complex(wp), intent(inout) :: stiffness(:,:)
    integer :: j

    do j = 1, size(direction)
      stiffness(:, j) = stiffness(:, j) + spring * direction(j) * direction
    end do
  end subroutine add_spring

  !> Adds rows of harmonic k of (compliance times contact Jacobian), with X = cos - i sin.
  pure subroutine add_compliance(compliance, k, contact_jacobian, rows)
    complex(wp), intent(in) :: compliance
    integer, intent(in) :: k
    real(wp), intent(in) :: contact_jacobian(:,:)
    real(wp), intent(inout) :: rows(:,:)

    if (k == 0) then
      rows(1, :) = rows(1, :) + real(compliance) * contact_jacobian(1, :)
    else
      rows(1, :) = rows(1, :) + real(compliance) * contact_jacobian(2*k, :) + aimag(compliance) * contact_jacobian(2*k + 1, :)
      rows(2, :) = rows(2, :) + real(compliance) * contact_jacobian(2*k + 1, :) - aimag(compliance) * contact_jacobian(2*k, :)
    end if
  end subroutine add_compliance

  !> Coefficients (coefficient, dof) of all degrees of freedom at a solution.
  pure function structure_response(problem, point) result(response)
    type(balance_problem), intent(in) :: problem
    type(balance_point), intent(in) :: point
    real(wp) :: response(2 * problem%harmonics + 1, size(problem%incidence, 1))
    complex(wp) :: amplitude, force
    integer :: dof, k, j

    do dof = 1, size(response, 2)
      do k = 0, problem%harmonics
        amplitude = point%by_load(dof, k)
        do j = 1, size(problem%incidence, 2)
          force = get_harmonic(point%force(:, j), k)
          if (k == 0) force = force - point%spring_force(j)
          amplitude = amplitude - point%by_force(dof, j, k) * force
        end do
        call set_harmonic(response(:, dof), k, amplitude)
      end do
    end do
  end function structure_response

  !> Residual over its tolerance: converged if at most 1. A stuck contact moves far less than the free structure would, whose
  !> rounding error it inherits.
  pure function newton_error(problem, displacement, point) result(error)
    type(balance_problem), intent(in) :: problem
    real(wp), intent(in) :: displacement(:,:)
    type(balance_point), intent(in) :: point
    real(wp) :: error
    integer :: i

    error = 0.0_wp
    do i = 1, size(displacement, 2)
      error = max(error, norm2(point%residual(:, i)) / (problem%tolerance * norm2(displacement(:, i)) &
                                                        + 8.0_wp * epsilon(error) * point%free_size))
    end do
  end function newton_error

  !> Newton's method at a fixed frequency. A step that does not reduce the residual is halved: near the onset of gross slip,
  !> where the tangent stiffness changes fast, full steps may alternate between stick and slip.
  subroutine solve_at(problem, omega, displacement, point, converged)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(inout), contiguous :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    logical, intent(out) :: converged
    real(wp) :: matrix(size(displacement), size(displacement)), step(size(displacement), 1)
    real(wp) :: start(size(displacement, 1), size(displacement, 2)), size_before, fraction
    logical :: singular
    integer :: iteration, halving

    call evaluate(problem, omega, displacement, point)
    do iteration = 1, newton_steps
      converged = newton_error(problem, displacement, point) <= 1.0_wp
      if (converged) return
      matrix = point%jacobian
      step(:, 1) = -reshape(point%residual, [size(displacement)])
      call solve(matrix, step, singular)
      if (singular) return
      start = displacement
      size_before = norm2(point%residual)
      fraction = 1.0_wp
      do halving = 0, halvings
        displacement = start + fraction * reshape(step, shape(start))
        call evaluate(problem, omega, displacement, point)
        ! At rest mean forces have a corner: they follow the size of a vibration. So the first step is taken whole.
        if (iteration == 1 .or. norm2(point%residual) < size_before .or. newton_error(problem, displacement, point) <= 1.0_wp) exit
        fraction = 0.5_wp * fraction
      end do
    end do
    converged = newton_error(problem, displacement, point) <= 1.0_wp
  end subroutine solve_at

  !> Without a neighbouring solution: from the static equilibrium, if there is a load, the excitation grows in steps that shrink
  !> if Newton's method fails. Newton's method for the equilibrium starts with the
  !> springs in place of the contacts; if that fails, without tangential displacements.
  subroutine solve_from_rest(problem, omega, displacement, point, converged)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(out), contiguous :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    logical, intent(out) :: converged
    complex(wp) :: full(size(problem%excitation))
    real(wp) :: trial(size(displacement, 1), size(displacement, 2)), reached, growth
    real(wp), parameter :: min_growth = 1.0e-3_wp

    full = problem%excitation
    displacement = 0.0_wp
    if (any(abs(problem%static_load) > 0.0_wp) .or. any(abs(problem%offset) > 0.0_wp)) then
      problem%excitation = 0.0_wp
      call evaluate(problem, omega, displacement, point)
      trial = displacement
      trial(1, :) = -point%residual(1, :)
      displacement = trial
      call solve_at(problem, omega, displacement, point, converged)
      if (.not. converged) then
        displacement = 0.0_wp
        where (problem%springs > 0.0_wp) displacement(1, :) = trial(1, :)
        call solve_at(problem, omega, displacement, point, converged)
      end if
      problem%excitation = full
      if (.not. converged) return
    end if
    reached = 0.0_wp
    growth = 1.0_wp
    do
      trial = displacement
      problem%excitation = min(reached + growth, 1.0_wp) * full
      call solve_at(problem, omega, trial, point, converged)
      if (converged) then
        displacement = trial
        reached = min(reached + growth, 1.0_wp)
        growth = 2.0_wp * growth
        if (reached >= 1.0_wp) exit
      else
        growth = 0.25_wp * growth
        if (growth < min_growth) exit
      end if
    end do
    problem%excitation = full
  end subroutine solve_from_rest
end module harmonic_balance
