//! The shared library of the Python package: it exports the functions of `microslip.h`.

pub use microslip::ffi::*;
