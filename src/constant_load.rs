//! The contact law under a constant normal force: monotonic curve, return-point memory, Masing's rule, cycles.

pub(crate) mod complex_stiffness;
pub(crate) mod contact;
pub(crate) mod curve;
pub(crate) mod energy;
pub mod equivalents;
pub(crate) mod interpolant;
pub mod masing;
pub(crate) mod memory;
pub mod state;
pub(crate) mod steady_state;
