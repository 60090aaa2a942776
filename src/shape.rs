//! Shapes: the nested family of sizes that a contact runs through under a growing normal load.
//!
//! A shape is defined by geometry and material, independently of the load. Each size s of the contact has a normal force N(s),
//! and as the load grows, every increment dN is carried like a flat punch of that size. It brings the bodies closer by `dU = K_n
//! dN` and makes a fully stuck contact more compliant by `dS = K_t dN`:
//!
//! ```text
//! N(s)  normal force                      K_n(s)  normal compliance of a punch of size s
//! U(s)  normal approach                   K_t(s)  tangential compliance
//! S(s)  tangential shift                  M(s) = ∫ N dS
//! ```
//!
//! The monotonic curve, hysteresis and energies follow from N and S alone (Jäger 1998; Ciavarella 1998), without the geometry.
//! Under a constant load only the sizes below the present one are involved: its stick zones.

pub(crate) mod hertz_ellipse;
pub(crate) mod layer;
pub(crate) mod rounded_flat;
pub(crate) mod rounded_punch;
pub(crate) mod stick_zone;
pub(crate) mod tractions;

pub use hertz_ellipse::HertzEllipse;
pub(crate) use layer::{Layer, Layered};
pub use rounded_flat::RoundedFlat;
pub(crate) use rounded_flat::size_under_load;
pub(crate) use rounded_punch::{RoundedPunch, TINY};

/// A complementary pair of amounts, `consumed + remaining`. Neither is computed from the other if it is the smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Complement {
    pub consumed: f64,
    pub remaining: f64,
}

impl Complement {
    /// The pair with the sum 1.
    pub fn of_remaining(remaining: f64) -> Complement {
        Complement { consumed: 1.0 - remaining, remaining }
    }
}

/// A nested family of contact sizes in absolute terms. A size is given by a parameter w \[m\] that is 0 for the smallest one.
pub(crate) trait Shape {
    /// The shape in both directions of the plane of contact.
    fn plane(&self) -> Plane<'_>;

    /// Half-width s \[m\]; for an ellipse the semi-axis x.
    fn half_width(&self, w: f64) -> f64;

    /// N, U or S \[N, m\].
    fn value(&self, quantity: Quantity, w: f64) -> f64;

    /// The derivative of N, U or S by N: 1, K_n, K_t \[m/N\].
    fn compliance(&self, quantity: Quantity, w: f64) -> f64;

    /// M = ∫ N dS \[J\].
    fn potential(&self, w: f64) -> f64;

    /// K_n \[m/N\] of a flat punch of the half-width s below that of the flat; not used without a flat.
    fn compliance_under_flat(&self, half_width: f64) -> f64;

    /// The pressure that a size adds, times sqrt(s² - x²)/s and in any unit: dp/d(s²).
    fn pressure_weight(&self, w: f64) -> f64;

    /// d(w²)/dN \[m²/N\].
    fn size_slope(&self, w: f64) -> f64;

    /// The size w at which N, U or S has a value.
    fn size_at(&self, quantity: Quantity, value: f64) -> f64;

    /// The largest size for which the laws hold.
    fn largest_size(&self) -> f64;

    /// Pressure \[Pa\] at x \[m\] along the width that the sizes from `from` to `to` carry; 0 outside the contact. For an ellipse on
    /// the x axis.
    fn pressure_between(&self, from: f64, to: f64, x: f64) -> f64;

    /// N, U and S about the size w > 0 as functions of one of them: Taylor coefficients in ρ for the argument `x (1 + ρ)`.
    fn series(&self, w: f64, argument: Quantity) -> [Series; 3];

    /// N \[N\].
    fn load(&self, w: f64) -> f64 {
        self.value(Quantity::Load, w)
    }

    /// The size w under a normal force \[N\].
    fn at_load(&self, load: f64) -> f64 {
        self.size_at(Quantity::Load, load)
    }
}

/// What grows with the size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Quantity {
    /// Normal force N.
    Load,
    /// Normal approach U.
    Approach,
    /// Tangential shift S.
    Shift,
}

impl Quantity {
    /// N, U and S.
    pub const ALL: [Quantity; 3] = [Quantity::Load, Quantity::Approach, Quantity::Shift];
}

/// A contact under forces in both directions of the plane of contact, x and y.
pub(crate) struct Plane<'a> {
    /// The contact without its layer.
    pub shape: &'a dyn Shape,
    pub layer: &'a Layer,
    /// S = `per_approach` U + `per_load` N in each direction, without the layer.
    pub per_approach: [f64; 2],
    pub per_load: [f64; 2],
    /// Half-width of the flat \[m\].
    pub flat: f64,
    /// The largest size for which the laws hold.
    pub largest: f64,
}

impl Plane<'_> {
    /// N, and S in both directions.
    pub fn load_and_shifts(&self, w: f64) -> [f64; 3] {
        let (load, approach) = (self.shape.load(w), self.shape.value(Quantity::Approach, w));
        let layer = self.layer.shift(load);
        let shift = |k: usize| self.per_approach[k] * approach + self.per_load[k] * load + layer;
        [load, shift(0), shift(1)]
    }

    /// K_t in a direction of a flat punch of the half-width s below that of the flat: a load of 0.
    pub fn compliance_under_flat(&self, k: usize, half_width: f64) -> f64 {
        let contact = self.shape.compliance_under_flat(half_width);
        self.per_approach[k] * contact + self.per_load[k] + self.layer.compliance(0.0)
    }
}

/// Number of Taylor coefficients in a [`Series`].
pub(crate) const ORDER: usize = 16;

/// Taylor coefficients.
pub(crate) type Series = [f64; ORDER];

/// The series of an argument itself, `x (1 + ρ)`.
pub(crate) fn identity(x: f64) -> Series {
    let mut series = [0.0; ORDER];
    (series[0], series[1]) = (x, x);
    series
}

/// A power series whose coefficients are stored from the last to the first, with zeros behind, so that the sums over k of products of
/// coefficients i and k - i run through contiguous memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reversed([f64; 2 * ORDER]);

impl Reversed {
    pub const ZERO: Reversed = Reversed([0.0; 2 * ORDER]);

    /// Sets the coefficient k.
    #[inline(always)]
    pub fn set(&mut self, k: usize, value: f64) {
        if let Some(coefficient) = self.0.get_mut((ORDER - 1).wrapping_sub(k)) {
            *coefficient = value;
        }
    }

    /// Term k of the product with another series.
    #[inline(always)]
    pub fn product_term(&self, other: &Series, k: usize) -> f64 {
        let reversed =
            self.0.get((ORDER - 1).wrapping_sub(k)..).and_then(<[f64]>::first_chunk).unwrap_or(&[0.0; ORDER]);
        let mut sums = [0.0; 4];
        for (one, two) in other.as_chunks::<4>().0.iter().zip(reversed.as_chunks::<4>().0) {
            for lane in 0..4 {
                sums[lane] += one[lane] * two[lane];
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    /// Term k of this series as a quotient, from the terms before it, given term k of the numerator and the reciprocal of term 0 of the
    /// denominator.
    #[inline(always)]
    pub fn quotient_term(&mut self, numerator: f64, denominator: &Series, reciprocal: f64, k: usize) -> f64 {
        let term = (numerator - self.product_term(denominator, k)) * reciprocal;
        self.set(k, term);
        term
    }
}
