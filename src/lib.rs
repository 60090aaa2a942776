//! **microslip**: a friction contact law for blade dynamics, the microslip model of Allara (2009) for flat contacts with rounded edges,
//! cylinders and elliptical Hertz contacts.
//!
//! - [`Parameters`] or [`EllipticParameters`] define a [`Contact`].
//! - [`constant_load`]: monotonic curve, hysteresis, dissipated energy and complex stiffness under a constant normal force.
//! - [`hbm`]: Fourier coefficients of the friction force for the harmonic balance method.
//! - [`shape`]: normal and tangential laws of the contact shapes, independent of the load.
//! - [`ffi`]: the C interface.
#![no_std]
#![deny(unsafe_code)]
extern crate std;

pub mod error;
pub mod parameters;

mod law;
mod numerics;
mod range;
mod simd;
mod tag;

pub mod shape;

pub mod constant_load;

pub mod varying_load;

pub mod hbm;

pub mod ffi;

pub use constant_load::complex_stiffness::ComplexStiffness;
pub use constant_load::contact::Contact;
pub use constant_load::curve::CurvePoint;
pub use constant_load::hysteresis_loop::HysteresisLoop;
pub use constant_load::sensitivity::{PARAMETERS, Sensitivity};
pub use error::Error;
pub use parameters::{EllipticParameters, Material, Parameters};
