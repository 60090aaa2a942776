! A library of another interface than the module initialises nothing. Its caller changes MSLIP_MODULE_ABI_VERSION.
program other_interface
  use microslip
  use checks, only: check_status, report
  implicit none
  type(mslip_parameters) :: p
  type(mslip_elliptic_parameters) :: e
  type(mslip_contact) :: contact
  type(mslip_element) :: element
  integer(mslip_int) :: status

  call mslip_contact_init(p, contact, status)
  call check_status('contact', status, MSLIP_BAD_CONTACT)
  call mslip_contact_init_elliptic(e, contact, status)
  call check_status('elliptic contact', status, MSLIP_BAD_CONTACT)
  call mslip_element_init(p, 1_mslip_int, MSLIP_INPUT_APPROACH, element, status)
  call check_status('element', status, MSLIP_BAD_ELEMENT)
  call mslip_element_init_elliptic(e, 1_mslip_int, MSLIP_INPUT_APPROACH, element, status)
  call check_status('elliptic element', status, MSLIP_BAD_ELEMENT)
  call report()
end program other_interface
