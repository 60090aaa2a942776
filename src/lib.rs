//! **microslip**: the friction law of a contact with rounded edges, for blade dynamics.
#![no_std]
#![deny(unsafe_code)]
extern crate std;

pub mod error;
pub mod parameters;

mod law;
mod numerics;
mod range;
mod tag;

pub mod shape;

pub mod constant_load;

pub mod hbm;

pub mod ffi;

pub use constant_load::complex_stiffness::ComplexStiffness;
pub use constant_load::contact::Contact;
pub use constant_load::curve::CurvePoint;
pub use constant_load::hysteresis_loop::HysteresisLoop;
pub use error::Error;
pub use parameters::{EllipticParameters, Material, Parameters};
