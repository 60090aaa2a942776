program version
  use microslip, only: mslip_abi_version, MSLIP_MODULE_ABI_VERSION
  implicit none
  if (mslip_abi_version() /= MSLIP_MODULE_ABI_VERSION) error stop 'the module and the archive differ'
end program version
