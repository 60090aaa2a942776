//! Numerical methods that do not depend on contact mechanics: interpolation, quadrature, root finding, polynomials, numbers with
//! derivatives, records in arrays of doubles, and the classification of floating-point values.

pub(crate) mod chebyshev;
pub(crate) mod const_math;
pub(crate) mod dual;
pub(crate) mod fp_class;
pub(crate) mod guard;
pub(crate) mod lanes;
pub(crate) mod polynomial;
pub(crate) mod quadrature;
pub(crate) mod record;
pub(crate) mod roots;
pub(crate) mod slices;
