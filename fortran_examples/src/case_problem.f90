!> The harmonic balance that a case describes.
module case_problem
  use case_input, only: case_data
  use harmonic_balance, only: balance_problem, contact_incidence
  use kinds, only: pi, wp
  implicit none
  private
  public :: prepare_problem

contains

  subroutine prepare_problem(data, load_factor, harmonics, samples, problem)
    type(case_data), intent(in) :: data
    real(wp), intent(in) :: load_factor
    integer, intent(in) :: harmonics, samples
    type(balance_problem), intent(out) :: problem
    real(wp) :: phase
    integer :: dof(2, size(data%contacts)), i

    problem%model = data%model
    problem%harmonics = harmonics
    problem%tolerance = data%tolerance
    call problem%contacts%prepare(data%contacts, load_factor)
    call problem%contacts%prepare_harmonics(harmonics, samples)
    do i = 1, size(data%contacts)
      dof(:, i) = data%contacts(i)%dof
    end do
    problem%incidence = contact_incidence(dof, size(data%model%dof_name))
    allocate (problem%excitation(size(data%model%dof_name)), source=(0.0_wp, 0.0_wp))
    do i = 1, size(data%excited_dof)
      associate (force => problem%excitation(data%excited_dof(i)))
        ! amplitude * cos(omega t + phase)
        phase = data%excitation_phase(i) * pi / 180.0_wp
        force = force + data%excitation_amplitude(i) * cmplx(cos(phase), sin(phase), wp)
      end associate
    end do
  end subroutine prepare_problem
end module case_problem
