//! The law for two tangential directions. A displacement is `[u, v, w]` or `[u, v, N]`, a force `[Tx, Ty, N]`.
//!
//! The contact is a family of nested sizes, as in one direction, but slip has a direction of its own at each point.
//! Springs at nodes of the family carry the displacement of the sizes within; the tractions at one point of each shell
//! are a triangular map of them, and Coulomb's law holds at these points, with slip in the direction of the traction.
//!
//! - `nodes`: where the family is divided into shells, and their tables;
//! - `shells`: the shells of a contact under a load, its springs and their map to tractions;
//! - `matrix`: small matrices;
//! - `slip`: Coulomb's law at the points;
//! - `step`: a step of a contact, and the bounds of Coulomb's law beside the points: spring at the edge, gross slip,
//!   the whole force;
//! - `energy`: the energy that a step dissipates;
//! - `tangent`: derivatives of a step;
//! - `moving_nodes`: the contact between two steps, and its nodes, which move with the load;
//! - `path`, `state`: a step between contacts that may be open, and the state in the caller's memory;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion.

pub mod harmonic_force;

mod energy;
mod matrix;
mod moving_nodes;
mod nodes;
mod path;
mod shells;
mod slip;
mod state;
mod step;
mod tangent;

pub use crate::law::Law;

/// The law of elements with two tangential directions.
pub struct TwoDirections;

#[cfg(test)]
mod tests;
