//! **microslip**: the friction law of a contact with rounded edges, for blade dynamics.
//!
//! The modules follow the physics: what the user gives ([`parameters`]), size and pressure of the contact (`indentation`),
//! the family of sizes on which everything rests (`family`, provided by `rounded_flat` and `elliptic`), tractions, the
//! monotonic curve, the memory and Masing's rule on it, harmonic quantities, harmonic force, spring-slider equivalents, and the
//! C interface as a thin shell around them.
#![no_std]
#![deny(unsafe_code)]
extern crate std;

pub mod error;
pub mod parameters;

mod chebyshev;
mod number;
mod quadrature;
mod seal;
mod series;

mod family;
mod indentation;
mod inverse;
mod origin;
mod rounded_flat;
mod traction;

mod contact;
mod curve;

pub mod memory;

pub mod masing;

mod cycle_rules;
pub mod harmonic;

pub mod harmonic_force;

pub mod equivalent;

mod elliptic;

pub mod c_api;

pub use contact::Contact;
pub use curve::CurvePoint;
pub use error::Error;
pub use harmonic::{ComplexStiffness, HysteresisLoop};
pub use parameters::{EllipticParameters, Material, Parameters};
