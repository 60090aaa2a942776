!> Newmark's method with constant average acceleration for a linear structure with friction contacts.
!>
!> It is written for the accelerations: with short steps the displacements would be subject to cancellation. As in the
!> harmonic balance only the relative displacements of the contacts are unknown, since the structure is linear.
module newmark
  use dense_algebra, only: solve
  use friction_contacts, only: contact_history, contact_set
  use kinds, only: wp
  use linear_structure, only: structure
  use messages, only: fail, text
  implicit none
  private
  public :: prepare_newmark, initial_acceleration, newmark_step

  type, public :: newmark_scheme
    real(wp) :: step = 0.0_wp
    real(wp), allocatable :: inverse(:,:)        !! of M + step/2 D + step**2/4 K
    real(wp), allocatable :: by_force(:,:)       !! inverse times B
    real(wp), allocatable :: compliance(:,:)     !! step**2/4 B^T inverse B
    real(wp), allocatable :: contact_scale(:)    !! size of the relative displacement of each contact
  end type newmark_scheme

  type, public :: motion
    real(wp), allocatable :: displacement(:), velocity(:), acceleration(:)
    type(contact_history) :: contacts, trial     !! history until the last instant, and of the trial step
    real(wp), allocatable :: contact_displacement(:), contact_force(:)
  end type motion

  integer, parameter :: newton_steps = 50
  real(wp), parameter :: newton_tolerance = 1.0e-12_wp

contains

  subroutine prepare_newmark(model, incidence, step, contact_scale, scheme)
    type(structure), intent(in) :: model
    real(wp), intent(in) :: incidence(:,:), step, contact_scale(:)
    type(newmark_scheme), intent(out) :: scheme
    real(wp), allocatable :: matrix(:,:)
    integer :: i

    scheme%step = step
    scheme%contact_scale = contact_scale
    matrix = model%mass + 0.5_wp * step * model%damping + 0.25_wp * step**2 * model%stiffness
    allocate (scheme%inverse, mold=matrix)
    scheme%inverse = 0.0_wp
    do i = 1, size(matrix, 1)
      scheme%inverse(i, i) = 1.0_wp
    end do
    call solve(matrix, scheme%inverse)
    scheme%by_force = matmul(scheme%inverse, incidence)
    scheme%compliance = 0.25_wp * step**2 * matmul(transpose(incidence), scheme%by_force)
  end subroutine prepare_newmark

  !> Acceleration from the equation of motion.
  subroutine initial_acceleration(model, incidence, excitation, state)
    type(structure), intent(in) :: model
    real(wp), intent(in) :: incidence(:,:), excitation(:)
    type(motion), intent(inout) :: state
    real(wp) :: matrix(size(excitation), size(excitation)), right(size(excitation), 1)

    matrix = model%mass
    right(:, 1) = excitation - matmul(model%damping, state%velocity) - matmul(model%stiffness, state%displacement) &
                  - matmul(incidence, state%contact_force)
    call solve(matrix, right)
    state%acceleration = right(:, 1)
  end subroutine initial_acceleration

  !> One step; `excitation` is the force at its end.
  subroutine newmark_step(scheme, model, incidence, contacts, excitation, state)
    type(newmark_scheme), intent(in) :: scheme
    type(structure), intent(in) :: model
    real(wp), intent(in) :: incidence(:,:)
    type(contact_set), intent(in) :: contacts
    real(wp), intent(in) :: excitation(:)
    type(motion), intent(inout) :: state
    real(wp), dimension(size(excitation)) :: displacement, velocity, acceleration
    real(wp), dimension(size(incidence, 2)) :: u, u_free, force, stiffness
    real(wp) :: matrix(size(u), size(u)), correction(size(u), 1)
    integer :: iteration, i

    if (.not. allocated(state%trial%force)) state%trial = state%contacts
    associate (h => scheme%step)
      displacement = state%displacement + h * state%velocity + 0.25_wp * h**2 * state%acceleration
      velocity = state%velocity + 0.5_wp * h * state%acceleration
      acceleration = matmul(scheme%inverse, excitation - matmul(model%damping, velocity) &
                            - matmul(model%stiffness, displacement))
      u_free = matmul(displacement + 0.25_wp * h**2 * acceleration, incidence)

      u = matmul(displacement + 0.25_wp * h**2 * state%acceleration, incidence)
      do iteration = 1, newton_steps
        call contacts%try_step(state%contacts, u, force, stiffness, state%trial)
        correction(:, 1) = u_free - u - matmul(scheme%compliance, force)
        if (all(abs(correction(:, 1)) <= newton_tolerance * scheme%contact_scale)) exit
        do i = 1, size(u)
          matrix(:, i) = scheme%compliance(:, i) * stiffness(i)
          matrix(i, i) = matrix(i, i) + 1.0_wp
        end do
        call solve(matrix, correction)
        u = u + correction(:, 1)
      end do
      if (iteration > newton_steps) call fail('time step: no equilibrium within '//text(newton_steps)//' iterations')

      acceleration = acceleration - matmul(scheme%by_force, force)
      state%displacement = displacement + 0.25_wp * h**2 * acceleration
      state%velocity = velocity + 0.5_wp * h * acceleration
    end associate
    state%acceleration = acceleration
    state%contacts = state%trial
    state%contact_displacement = u
    state%contact_force = force
  end subroutine newmark_step
end module newmark
