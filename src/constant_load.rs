//! The friction law under a constant normal force: monotonic curve, hysteresis by Masing's rule with return-point memory, and
//! cycles of prescribed amplitude.

pub(crate) mod complex_stiffness;
pub(crate) mod contact;
pub(crate) mod curve;
pub(crate) mod energy;
pub mod equivalents;
pub(crate) mod evaluator;
pub(crate) mod fields;
pub mod harmonic_force;
pub(crate) mod hysteresis_loop;
pub(crate) mod interpolant;
pub mod masing;
pub(crate) mod memory;
pub(crate) mod sensitivity;
pub mod state;
pub(crate) mod steady_state;

pub use crate::law::Law;

/// The law of contacts under a constant normal force.
pub struct ConstantLoad;
