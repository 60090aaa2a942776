//! Stick zones: the sizes below the present contact size b, relative to it.
//!
//! Under the load of b, a monotonically increased tangential force leaves a stick zone of a smaller size c of the same shape, and
//!
//! ```text
//! Q = μ [P(b) - P(c)],        δ = μ [S(b) - S(c)],        dS = K(c) dP,
//! ```
//!
//! with the load P(c) and the tangential shift S(c) of size c (Cattaneo; Jäger and Ciavarella, 1998). Every tangential state under
//! that load is a signed sum of such differences. Nondimensionally, with loads in P(b), sizes in b and shifts in a unit that
//! depends on the shape, a stick zone is described by
//!
//! ```text
//! τ = 1 - P(c)/P(b)         the tangential force over mu N
//! x = S(b) - S(c)           the tangential displacement
//! Λ + λ = dx/dτ             the compliance K(c), λ = 0 at b
//! ```
//!
//! τ and x are stored with their complements 1 - τ and x_s - x, the distances to gross slip: whichever is smaller is computed
//! directly, so that neither end suffers cancellation.

pub(crate) mod ellipse;
pub(crate) mod rounded_flat;
pub(crate) mod small_load;

use small_load::SmallLoadSeries;

/// A complementary pair of amounts, `consumed + remaining`. Neither is computed from the other if it is the smaller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Complement {
    pub consumed: f64,
    pub remaining: f64,
}

/// A stick zone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StickZone {
    /// τ and 1 - τ.
    pub load: Complement,
    /// x and x_s - x.
    pub shift: Complement,
    /// λ; infinite for the point to which the stick zone of an ellipse or a cylinder shrinks.
    pub compliance_increase: f64,
    /// Size parameter σ if the zone was found by it; otherwise it follows from λ.
    pub size_parameter: Option<f64>,
}

/// A point along the width. The differences are computed from the dimensional lengths: for a nearly flat contact the rounding error of
/// x/b may exceed the distance from flat to edge.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfacePoint {
    /// |x|/b.
    pub x: f64,
    /// (|x| - a)/b.
    pub past_flat: f64,
    /// (b - |x|)/b.
    pub from_edge: f64,
}

/// A point of the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadPoint {
    /// 1 - τ.
    pub remaining: f64,
    /// λ.
    pub compliance_increase: f64,
    /// dλ/dτ.
    pub curvature: f64,
}

impl LoadPoint {
    /// τ and 1 - τ.
    pub fn load(&self) -> Complement {
        Complement { consumed: 1.0 - self.remaining, remaining: self.remaining }
    }
}

/// The stick zones of a contact under its load.
pub(crate) trait StickZones {
    /// The expansion for τ <= 1/2.
    fn small_load(&self) -> &SmallLoadSeries;

    /// x_s, the shift at the onset of gross slip.
    fn slip_shift(&self) -> f64;

    /// The stick zone at `1 - τ = remaining`, from 0 to 1/2.
    fn at_load_remaining(&self, remaining: f64) -> StickZone;

    /// The stick zone at `x_s - x = remaining`, for τ >= 1/2.
    fn at_shift_remaining(&self, remaining: f64) -> StickZone;

    /// [`StickZones::dissipation`] for τ >= 1/2, at the stick zone with `1 - τ = remaining`.
    fn dissipation_beyond_half(&self, remaining: f64, compliance_increase: f64) -> (f64, f64);

    /// c/b.
    fn size(&self, zone: &StickZone) -> f64;

    /// Pressure in units of N/(bL) or, for an ellipse, of N over the product of the semi-axes.
    fn pressure(&self, point: &SurfacePoint) -> f64;

    /// Shear traction over μ in those units under a monotonically increased force: the pressure of b less that of the stick zone
    /// (Eq. 21).
    fn shear(&self, point: &SurfacePoint, zone: &StickZone) -> f64;

    /// Relative slip (Eq. 15) in units of shift; `None` if there is no closed form.
    fn slip(&self, point: &SurfacePoint, zone: &StickZone) -> Option<f64>;

    /// The stick zone at a load.
    fn at_load(&self, load: Complement) -> StickZone {
        if load.consumed <= 0.5 {
            self.small_load().at_load(load, self.slip_shift())
        } else {
            self.at_load_remaining(load.remaining)
        }
    }

    /// The stick zone at a shift: the inverse of the monotonic curve.
    fn at_shift(&self, shift: Complement) -> StickZone {
        let series = self.small_load();
        if shift.consumed <= series.half_shift {
            series.at_shift(shift)
        } else {
            self.at_shift_remaining(shift.remaining)
        }
    }

    /// Energy dissipated per cycle between ±τ, in units of force times shift (Eq. 13-16), and its derivative with respect to τ; λ is
    /// given to the rounding of Λ + λ.
    fn dissipation(&self, load: Complement, compliance_increase: f64) -> (f64, f64) {
        if load.consumed <= 0.5 {
            self.small_load().dissipation(load.consumed)
        } else {
            self.dissipation_beyond_half(load.remaining, compliance_increase)
        }
    }

    /// dx/dτ = Λ + λ.
    fn compliance(&self, zone: &StickZone) -> f64 {
        self.small_load().compliance + zone.compliance_increase
    }
}
