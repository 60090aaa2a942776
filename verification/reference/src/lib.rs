//! The friction law in multi-precision: the closed forms of the paper's equations, with as many extra bits as they lose to
//! cancellation. No series, expansion or interpolation, and no code of the library except its parameter structures.

pub mod element;
pub mod family;
pub mod harmonic;
pub mod history;
pub mod law;
pub mod quadrature;
pub mod real;
pub mod stiffness;

pub use law::{Input, Law, Point, Reference};
pub use real::Real;

/// The seed of random tests: `MICROSLIP_SEED`, or 1.
pub fn seed() -> u64 {
    std::env::var("MICROSLIP_SEED").map_or(1, |seed| seed.parse().expect("MICROSLIP_SEED is a number"))
}
