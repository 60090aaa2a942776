//! **microslip**: a friction contact law for blade dynamics, the microslip model of Allara (2009) for flat contacts with rounded
//! edges, cylinders and elliptical Hertz contacts.
//!
//! - [`Parameters`] or [`EllipticParameters`] define a [`Contact`].
//! - [`constant_load`]: monotonic curve, hysteresis, dissipated energy, complex stiffness and harmonic force under a constant
//!   normal force.
//! - [`element`]: the laws of a shape in tables, for a normal force that varies, with separation.
//! - [`one_direction`], [`two_directions`]: states, steps and harmonic force of an element with one and with two tangential
//!   directions.
//! - [`shape`]: normal and tangential laws of the contact shapes, independent of the load.
//! - [`ffi`]: the C interface.
//!
//! A steel cylinder under 800 N:
//!
//! ```
//! use microslip::{Contact, Material, Parameters};
//!
//! let parameters = Parameters {
//!     flat_half_width: 0.0,
//!     edge_radius: 0.05,
//!     length: 0.02,
//!     normal_force: 800.0,
//!     friction_coefficient: 0.5,
//!     material: [Material { young_modulus: 2e11, poisson_ratio: 0.3 }; 2],
//!     displacement_reference: 1,
//!     ..Parameters::default()
//! };
//! let contact = Contact::rounded_flat(&parameters)?;
//! let point = contact.curve_at_displacement(0.5 * contact.slip_displacement)?;
//! assert!(point.force() < 0.5 * 800.0 && point.stiffness() < contact.initial_stiffness);
//! let stiffness = contact.complex_stiffness(0.5 * contact.slip_displacement)?;
//! assert!(stiffness.real < contact.initial_stiffness && stiffness.imaginary > 0.0);
//! # Ok::<(), microslip::Error>(())
//! ```
#![no_std]
#![deny(unsafe_code)]
#![cfg_attr(test, allow(dead_code))]
extern crate std;

pub mod error;
pub mod parameters;

mod limits;
mod numerics;
mod tag;

mod fourier;
pub mod shape;

pub mod face;
mod plausibility;

pub mod element;

pub mod law;

pub mod constant_load;
pub mod one_direction;
pub mod two_directions;

// Its tests are in tests/: without it the unit tests compile in two thirds of the time.
#[cfg(not(test))]
pub mod ffi;

pub use constant_load::complex_stiffness::ComplexStiffness;
pub use constant_load::contact::Contact;
pub use constant_load::curve::CurvePoint;
pub use constant_load::hysteresis_loop::HysteresisLoop;
pub use error::Error;
pub use parameters::{EllipticParameters, Layer, Material, PARAMETERS, Parameters, Sensitivity};
