!> Multi-harmonic balance of a linear structure with friction contacts, condensed to the contacts.
!>
!> The structure is linear, so at one frequency the relative displacements u of the contacts follow from the contact
!> forces f(u) through the dynamic compliance C seen from the contacts:
!>
!>     R(u, omega) = u + C(omega) f(u) - u_free(omega) = 0,    C_k = B^T (K + i k omega D - (k omega)^2 M)^-1 B,
!>
!> with u_free the relative displacements without contact forces. A contact force is an internal force, positive with
!> the relative displacement, hence its sign. The unknowns of Newton's method are u alone, the Fourier coefficients of
!> every contact; f and df/du come from contacts%harmonic_force.
module harmonic_balance
  use basics, only: wp
  use dense_algebra, only: solve
  use fourier_series, only: get_harmonic, set_harmonic
  use friction_contacts, only: contact_set
  use linear_structure, only: structure
  implicit none
  private
  public :: evaluate, newton_error, solve_at, solve_from_rest, structure_response

  type, public :: balance_problem
    type(structure) :: model
    type(contact_set) :: contacts
    real(wp), allocatable :: incidence(:,:)       !! B: forces on the structure = B f; displacements of the contacts = B^T x
    real(wp), allocatable :: excitation(:)        !! F in F cos(omega t), for each degree of freedom
    integer :: harmonics = 0
    real(wp) :: tolerance = 0.0_wp                !! of R, relative to the displacement of each contact
  end type balance_problem

  !> The balance at one frequency and one set of displacements.
  type, public :: balance_point
    real(wp), allocatable :: residual(:,:)        !! R, (coefficient, contact)
    real(wp), allocatable :: jacobian(:,:)        !! dR/du, both in array element order
    real(wp), allocatable :: by_omega(:,:)        !! dR/domega
    real(wp), allocatable :: force(:,:)           !! f(u)
    real(wp), allocatable :: dissipated(:)        !! per period and contact
    real(wp) :: free_size = 0.0_wp                !! largest relative displacement without contact forces
    !> Response of all degrees of freedom to contact forces, (dof, contact, harmonic), and to the excitation, (dof, harmonic).
    complex(wp), allocatable, private :: by_force(:,:,:), by_load(:,:)
  end type balance_point

contains

  !> R and its exact derivatives.
  subroutine evaluate(problem, omega, displacement, point)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(in) :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    complex(wp), dimension(size(problem%incidence, 1), size(problem%incidence, 1)) :: stiffness, rate
    complex(wp) :: solution(size(problem%incidence, 1), size(problem%incidence, 2) + 1)
    complex(wp), dimension(size(problem%incidence, 2), size(problem%incidence, 2) + 1) :: seen, seen_rate
    complex(wp) :: force(size(displacement, 2)), row(size(displacement, 1))
    real(wp) :: contact_jacobian(size(displacement, 1), size(displacement, 1), size(displacement, 2))
    integer :: dofs, contacts, m, k, i, j, first, last

    dofs = size(problem%incidence, 1)
    contacts = size(displacement, 2)
    m = size(displacement, 1)
    if (.not. allocated(point%force)) then
      allocate (point%residual(m, contacts), point%by_omega(m, contacts), point%force(m, contacts))
      allocate (point%jacobian(m * contacts, m * contacts), point%dissipated(contacts))
      allocate (point%by_force(dofs, contacts, 0:problem%harmonics), point%by_load(dofs, 0:problem%harmonics))
    end if
    call problem%contacts%harmonic_force(displacement, point%force, contact_jacobian, point%dissipated)

    point%free_size = 0.0_wp
    do k = 0, problem%harmonics
      stiffness = cmplx(problem%model%stiffness - (k * omega)**2 * problem%model%mass, k * omega * problem%model%damping, wp)
      rate = cmplx(-2.0_wp * k**2 * omega * problem%model%mass, k * problem%model%damping, wp)
      solution(:, :contacts) = problem%incidence
      solution(:, contacts + 1) = merge(problem%excitation, 0.0_wp, k == 1)
      call solve(stiffness, solution)
      ! The matrices are symmetric: B^T d(Z^-1) = -(Z^-1 B)^T dZ Z^-1.
      seen = matmul(transpose(problem%incidence), solution)
      seen_rate = -matmul(transpose(solution(:, :contacts)), matmul(rate, solution))

      point%by_force(:, :, k) = solution(:, :contacts)
      point%by_load(:, k) = solution(:, contacts + 1)
      point%free_size = max(point%free_size, maxval(abs(seen(:, contacts + 1))))
      force = get_harmonic(point%force, k)
      call set_harmonic(point%residual, k, get_harmonic(displacement, k) + matmul(seen(:, :contacts), force) &
                                           - seen(:, contacts + 1))
      call set_harmonic(point%by_omega, k, matmul(seen_rate(:, :contacts), force) - seen_rate(:, contacts + 1))
      first = max(2*k, 1)
      last = 2*k + 1
      do j = 1, contacts
        row = get_harmonic(contact_jacobian(:, :, j), k)
        do i = 1, contacts
          associate (part => point%jacobian((i - 1) * m + first:(i - 1) * m + last, (j - 1) * m + 1:j * m))
            part(1, :) = real(seen(i, j) * row)
            if (k > 0) part(2, :) = -aimag(seen(i, j) * row)
          end associate
        end do
      end do
    end do
    do i = 1, m * contacts
      point%jacobian(i, i) = point%jacobian(i, i) + 1.0_wp
    end do
  end subroutine evaluate

  !> Coefficients (coefficient, dof) of all degrees of freedom at a solution.
  pure function structure_response(problem, point) result(response)
    type(balance_problem), intent(in) :: problem
    type(balance_point), intent(in) :: point
    real(wp) :: response(2 * problem%harmonics + 1, size(problem%incidence, 1))
    integer :: k

    do k = 0, problem%harmonics
      call set_harmonic(response, k, point%by_load(:, k) - matmul(point%by_force(:, :, k), get_harmonic(point%force, k)))
    end do
  end function structure_response

  !> Residual over its tolerance: converged if at most 1. A stuck contact moves far less than the free structure would, whose
  !> rounding error it inherits.
  pure function newton_error(problem, displacement, point) result(error)
    type(balance_problem), intent(in) :: problem
    real(wp), intent(in) :: displacement(:,:)
    type(balance_point), intent(in) :: point
    real(wp) :: error

    error = maxval(norm2(point%residual, dim=1) / (problem%tolerance * norm2(displacement, dim=1) &
                                                   + 8.0_wp * epsilon(error) * point%free_size))
  end function newton_error

  !> Newton's method at a fixed frequency. A step that does not reduce the residual is halved: near the onset of gross slip,
  !> where the tangent stiffness changes fast, full steps may alternate between stick and slip.
  subroutine solve_at(problem, omega, displacement, point, converged)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(inout) :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    logical, intent(out) :: converged
    integer, parameter :: newton_steps = 40, halvings = 8
    real(wp) :: matrix(size(displacement), size(displacement)), step(size(displacement), 1)
    real(wp) :: start(size(displacement, 1), size(displacement, 2)), size_before, fraction
    logical :: singular
    integer :: iteration, halving

    call evaluate(problem, omega, displacement, point)
    do iteration = 0, newton_steps
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
        if (norm2(point%residual) < size_before) exit
        fraction = 0.5_wp * fraction
      end do
    end do
  end subroutine solve_at

  !> Without a neighbouring solution: the excitation grows in steps that shrink if Newton's method fails.
  subroutine solve_from_rest(problem, omega, displacement, point, converged)
    type(balance_problem), intent(inout) :: problem
    real(wp), intent(in) :: omega
    real(wp), intent(out) :: displacement(:,:)
    type(balance_point), intent(inout) :: point
    logical, intent(out) :: converged
    real(wp) :: full(size(problem%excitation)), reached, growth
    real(wp) :: trial(size(displacement, 1), size(displacement, 2))

    full = problem%excitation
    displacement = 0.0_wp
    reached = 0.0_wp
    growth = 1.0_wp
    do while (reached < 1.0_wp .and. growth > 1.0e-3_wp)
      trial = displacement
      problem%excitation = min(reached + growth, 1.0_wp) * full
      call solve_at(problem, omega, trial, point, converged)
      if (converged) then
        displacement = trial
        reached = min(reached + growth, 1.0_wp)
        growth = 2.0_wp * growth
      else
        growth = 0.25_wp * growth
      end if
    end do
    problem%excitation = full
  end subroutine solve_from_rest
end module harmonic_balance
