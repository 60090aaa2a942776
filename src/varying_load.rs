//! The law under a normal force that varies, with separation.
//!
//! One tangential direction: as the load rises and falls the contact runs through its family of sizes. The state is a diagram D(S)
//! with |D| <= mu over the tangential shifts S of the sizes inside the contact: `T = ∫ D dN` and `u = o + ∫ D dS`. For a path that
//! is straight in (S, u) Coulomb's law determines the diagram at the end in closed form (Jäger 1998), and this is exact for
//! elastically similar half-planes.
//!
//! - [`element`]: the laws N(U), S(N) and N(S) of a shape, tabulated independently of the load;
//! - `diagram`: a step, in characteristic coordinates;
//! - `energy`: the energy dissipated in it;
//! - [`state`]: the caller's array that holds a diagram;
//! - [`harmonic_force`]: Fourier coefficients of the forces of a periodic motion;
//! - [`tractions`]: pressure and shear traction of a diagram;
//! - [`two_directions`]: the law for two tangential directions: state, steps and harmonic force.

pub mod element;
pub mod harmonic_force;
pub mod state;
pub mod tractions;
pub mod two_directions;

pub(crate) mod diagram;
pub(crate) mod energy;
pub(crate) mod path;
pub(crate) mod table;
