//! Numerical building blocks that know nothing of contacts: interpolation, quadrature, polynomials, classification of numbers.

pub(crate) mod chebyshev;
pub(crate) mod fp_class;
pub(crate) mod polynomial;
pub(crate) mod quadrature;
pub(crate) mod sn_midpoint;
