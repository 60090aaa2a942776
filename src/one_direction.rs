//! The law for one tangential direction under a normal force that varies, with separation. A displacement is `[u, w]` or `[u, N]`,
//! a force `[T, N]`.
//!
//! As the load rises and falls the contact runs through its family of sizes. The state is a diagram D(S)
//! with |D| <= mu over the tangential shifts S of the sizes inside the contact: `T = ∫ D dN` and `u = o + ∫ D dS`. For a path that
//! is straight in (S, u) Coulomb's law determines the diagram at the end in closed form (Jäger 1998), and this is exact for
//! elastically similar half-planes.
//!
//! - `diagram`: the diagram in characteristic coordinates, and a step in it;
//! - `step`, `energy`: a step of a contact that may open or close, and the energy dissipated in it;
//! - `state`: the caller's array that holds a diagram;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion;
//! - [`tractions`]: pressure and shear traction of a diagram.

pub mod harmonic_force;
pub mod tractions;

mod diagram;
mod energy;
pub(crate) mod state;
mod step;

pub use crate::law::Law;
pub use state::state_length;

/// The law of elements with one tangential direction.
pub struct OneDirection;
