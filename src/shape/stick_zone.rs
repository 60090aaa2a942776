//! Stick zones: the sizes below the present contact size b, relative to it.
//!
//! Under the load of b, a monotonically increased tangential force leaves a stick zone of a smaller size c of the same shape, and
//!
//! ```text
//! Q = μ [P(b) - P(c)],        δ = μ [S(b) - S(c)],        dS = K_t(c) dP,
//! ```
//!
//! with the load P(c) and the tangential shift S(c) of size c (Cattaneo; Jäger and Ciavarella, 1998). Every tangential state under
//! that load is a signed sum of such differences. Nondimensionally, with loads in P(b), sizes in b and shifts in a unit that
//! depends on the shape, 2μP/(πE*) or C_t μN, a stick zone is described by
//!
//! ```text
//! τ = 1 - P(c)/P(b)         the tangential force over mu N
//! x = S(b) - S(c)           the tangential displacement
//! Λ + λ = dx/dτ             the compliance of c, λ = 0 at b
//! ```
//!
//! Each of τ and x is stored together with its distance to gross slip, 1 - τ and x_s - x. The smaller number of each pair is
//! computed directly and not as a difference, so that neither small forces nor the approach to gross slip suffer cancellation.
//!
//! The load g and the means β and γ of a size are given by its shape (`size`). In these units the compliances are the same for all
//! line contacts and for all ellipses:
//!
//! ```text
//! line      λ = ln(b/c),     Λ = ln(2L/b) + ν/(1-ν)                 Eq. 8-10
//! ellipse   λ = b/c - 1,     Λ = 1, the same for all ellipses
//! ```
//!
//! The index c denotes a stick zone and b the contact; `1 - τ = g_c/g_b`. Then
//!
//! ```text
//! remaining shift  x_s - x = (1-τ) (Λ + λ + β_c)           x = Λ τ + β_b - (1-τ) (λ + β_c)
//! energy           W = 4 [(2-τ) (β_b - (1-τ) β_c) - (1-τ) λ - (γ_b - (1-τ)² γ_c)]                Eq. 13-16
//! ```
//!
//! A layer adds its shift, compliance and energy. These formulas are evaluated for τ >= 1/2; for smaller τ they suffer cancellation
//! and are replaced by the expansion of `small_load`.

pub(crate) mod small_load;

use crate::numerics::chebyshev::{Interpolant, SeriesPoint};
use crate::numerics::guard::TINY;
use crate::shape::size::{InversePower, Size};
use crate::shape::tractions::SurfacePoint;
use crate::shape::{Complement, LayerCompliance};
use core::f64::consts::PI;
use small_load::{RETAINED_TERMS, SmallLoadSeries};

/// A stick zone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StickZone {
    /// τ and 1 - τ.
    pub load: Complement,
    /// x and x_s - x.
    pub shift: Complement,
    /// Compliance increase λ of contact and layer; infinite if the stick zone of an ellipse or a cylinder has shrunk to a point.
    pub compliance_increase: f64,
    /// The leg of the stick zone if it is known; otherwise it follows from the load.
    pub leg: Option<f64>,
}

/// Moments of the curvature h'' of the contact without its layer, integrals over the load t from 0 to τ that are free of
/// cancellation.
#[derive(Clone, Copy)]
pub(crate) struct Moments {
    /// ∫ h'' dt = λ.
    pub increase: f64,
    /// ∫ t h'' dt = τ λ - h.
    pub first: f64,
    /// ∫ (1-t) h'' dt = β_b - (1-τ) β_c.
    pub complement: f64,
    /// ∫ (4 leg/g_b) h'' dt, for the derivative by a; not used for an ellipse.
    pub by_flat: f64,
}

/// The stick zones of a contact under its load, with a layer in series or without; lengths in units of b.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StickZones {
    /// The size of the contact, and its load g and means β and γ.
    contact: Size,
    load: f64,
    beta: f64,
    gamma: f64,
    /// x_s, the shift at the onset of gross slip.
    pub slip_shift: f64,
    /// The layer in series.
    pub layer: LayerCompliance,
    /// The expansion for τ <= 1/2, without the layer.
    pub small_load_without_layer: SmallLoadSeries,
    /// The expansion for τ <= 1/2, with the layer.
    pub small_load: SmallLoadSeries,
}

impl StickZones {
    /// The stick zones of a contact (lengths in units of its half-width) with the compliance Λ of full stick.
    pub fn new(contact: Size, compliance: f64, layer: LayerCompliance) -> StickZones {
        let load = contact.load();
        let mut zones =
            StickZones { contact, load, beta: contact.beta(load), gamma: contact.gamma(load), ..StickZones::default() };
        zones.slip_shift = compliance + zones.beta + layer.shift(1.0);
        zones.small_load_without_layer = SmallLoadSeries::new(compliance, &zones.curvatures());
        (zones.layer, zones.small_load) = (layer, zones.small_load_without_layer);
        if zones.has_layer() {
            zones.small_load = SmallLoadSeries::new(compliance + layer.compliance(1.0), &zones.curvatures());
        }
        zones
    }

    /// Whether there is a layer that is compliant in the tangential direction.
    pub fn has_layer(&self) -> bool {
        self.layer.tangential > 0.0
    }

    /// Compliance increase λ of a stick zone without the layer, accurate also for c close to b.
    fn increase_of(&self, size: &Size) -> f64 {
        let square_difference = (self.contact.leg - size.leg) * (self.contact.leg + size.leg);
        self.contact.kernel().increase(size.half_width, square_difference)
    }

    /// Curvature `h'' = dλ/dτ` at a stick zone without the layer: g_b times -dΛ/dg.
    fn curvature_of(&self, size: &Size) -> f64 {
        self.load * size.decrease_with_load()
    }

    /// Values and slopes of the curvature h'' as a function of z at τ = (1+z)/4. It is positive, and its singularity at τ = 1 is as
    /// far from the interval as the interval is long.
    fn curvatures(&self) -> [SeriesPoint; RETAINED_TERMS / 2] {
        Interpolant::<{ RETAINED_TERMS / 2 }>::at_points(|z| {
            let load = Complement::of_remaining(0.75 - 0.25 * z);
            let punch = self.size_under(load.remaining);
            let value = self.curvature_of(&punch);
            // Logarithmic derivative of h'' with respect to -ln leg.
            let ([decrease, change], [rate, _]) = (punch.decrease(), punch.rates());
            let slope = value * (2.0 + rate - change / decrease) * self.load / punch.load_slope();
            let [layer, layer_slope] = self.layer.curvature(load);
            SeriesPoint { value: value + layer, slope: 0.25 * (slope + layer_slope) }
        })
    }

    /// The size with `1 - τ = remaining`.
    fn size_under(&self, remaining: f64) -> Size {
        self.contact.at_load(remaining * self.load)
    }

    /// The size with `1 - τ = remaining`, and its g. The λ of contact and layer must be accurate to the rounding of Λ + λ.
    fn size_near(&self, remaining: f64, compliance_increase: f64) -> (Size, f64) {
        let load = remaining * self.load;
        let own = compliance_increase - self.layer.increase(Complement::of_remaining(remaining));
        let square = self.contact.leg * self.contact.leg;
        let leg = (square - self.contact.kernel().square_difference(own)).max(0.25 * square * remaining).sqrt();
        (self.contact.resized(leg).at_load_near(load), load)
    }

    /// The stick zone of a size with the load g and `1 - τ = g/g_b`. The consumed shift is computed as Λ τ + h, which is not a
    /// difference of two large terms if the curve is nearly straight. It does not contain the shift of the layer, a logarithm that
    /// the iteration does not need.
    fn zone(&self, punch: &Size, load: f64, remaining: f64) -> StickZone {
        let (full_stick, beta) = (self.small_load_without_layer.compliance, punch.beta(load));
        let (load, increase) = (Complement::of_remaining(remaining), self.increase_of(punch));
        let mut zone = StickZone {
            load,
            shift: Complement {
                consumed: full_stick * load.consumed + ((self.beta - remaining * beta) - remaining * increase),
                remaining: remaining * (full_stick + increase + beta),
            },
            compliance_increase: increase,
            leg: Some(punch.leg),
        };
        if self.has_layer() {
            zone.shift.remaining += self.layer.shift(remaining);
            zone.compliance_increase += self.layer.increase(load);
        }
        zone
    }

    /// The stick zone of a size that was found for a remaining shift.
    fn at_size(&self, punch: &Size, remaining: f64) -> StickZone {
        let load = punch.load();
        let shift = Complement { consumed: self.slip_shift - remaining, remaining };
        StickZone { shift, ..self.zone(punch, load, load / self.load) }
    }

    /// An estimate of the size at a remaining shift. The contact alone has at most this shift, and at most the shift that scales as
    /// the root of the load which the layer alone would carry (its true power is about 2/3). The load follows with a constant mean
    /// compliance Λ + λ + β: first with its smallest value, then with its value at the size found. The result is at most the size
    /// of the contact, because the compliance of larger sizes may be negative.
    fn initial_guess(&self, remaining: f64) -> Size {
        let slip_shift = self.small_load_without_layer.compliance + self.beta;
        let mut own = remaining;
        if self.has_layer() {
            let of_layer = self.layer.load_of_extent(remaining / self.layer.tangential);
            own = own.min(slip_shift * of_layer.sqrt()).max(f64::MIN_POSITIVE);
        }
        let near = |compliance: f64| self.contact.estimated_leg(own / compliance * self.load);
        let leg = near(self.small_load_without_layer.compliance);
        if self.contact.is_power_law() {
            return self.contact.resized(leg);
        }
        let increase = -0.5 * (self.contact.flat * self.contact.flat + leg * leg).clamp(TINY, 1.0).ln();
        self.contact.resized(near(slip_shift + increase).min(self.contact.leg))
    }

    /// The stick zone at a remaining shift, its size, and the expansion of the inverse about it, by iteration from a size close to
    /// it.
    ///
    /// One iteration raises the relative error to its fourth power.
    fn refine(&self, remaining: f64, start: Size) -> (StickZone, Size, InversePower) {
        if self.contact.is_power_law() && !self.has_layer() {
            let punch = self.initial_guess(remaining);
            return (self.at_size(&punch, remaining), punch, InversePower::default());
        }
        let mut punch = start;
        let mut iterations_left = 8;
        loop {
            let (leg, load, slope) = (punch.leg, punch.load(), punch.load_slope());
            let now = self.zone(&punch, load, load / self.load);
            let compliance = self.compliance(&now);
            let ([mut decrease, mut change], slope_of_psi) = (punch.decrease(), punch.rates());
            if self.has_layer() {
                let ([of_layer, rate], slope) = (self.layer.curvature(now.load), slope / self.load);
                decrease += of_layer * slope;
                change += slope * (of_layer * (2.0 + slope_of_psi[0]) - rate * slope);
            }
            let per_compliance = 1.0 / compliance;
            let slope_of_compliance = decrease * per_compliance;
            let power = slope * compliance / (now.shift.remaining * self.load).max(TINY);
            let rates = [slope_of_compliance, change * per_compliance + slope_of_compliance * slope_of_compliance];
            let inverse = punch.inverse(now.shift.remaining, power, slope_of_psi, rates);
            let step = inverse.step(remaining);
            iterations_left -= 1;
            punch = self.contact.resized((leg + step).max(0.0).min(self.contact.leg));
            if step.abs() <= 2e-5 * compliance.min(1.0) * leg || iterations_left == 0 {
                return (self.at_size(&punch, remaining), punch, inverse);
            }
        }
    }

    /// A function that returns the stick zone and dλ/dτ at a remaining shift, for a decreasing sequence of shifts that starts close
    /// to x_s. Each point is predicted by the expansion about the previous point, so that the closed forms are nearly always
    /// evaluated once.
    pub fn sequence(&self) -> impl FnMut(f64) -> (StickZone, f64) {
        let mut last: Option<InversePower> = None;
        move |remaining| {
            let leg = last.as_ref().map_or(self.contact.leg, |last| last.leg(remaining));
            let (zone, punch, inverse) = self.refine(remaining, self.contact.resized(leg));
            last = Some(inverse);
            let [of_layer, _] = self.layer.curvature(zone.load);
            (zone, self.curvature_of(&punch) + of_layer)
        }
    }

    /// The stick zone under a tangential force τ.
    pub fn at_load(&self, load: Complement) -> StickZone {
        if load.consumed <= 0.5 {
            return self.small_load.at_load(load, self.slip_shift);
        }
        let mut zone = self.zone(&self.size_under(load.remaining), load.remaining * self.load, load.remaining);
        zone.shift.consumed += self.layer.shift(self.layer.consumed(load));
        let vanishes = load.remaining <= 0.0 && self.contact.flat <= 0.0;
        StickZone { compliance_increase: if vanishes { f64::INFINITY } else { zone.compliance_increase }, ..zone }
    }

    /// The stick zone at a shift: the inverse of the monotonic curve.
    pub fn at_shift(&self, shift: Complement) -> StickZone {
        if shift.consumed <= self.small_load.half_shift {
            self.small_load.at_shift(shift)
        } else if shift.remaining <= 0.0 {
            self.at_load(Complement::of_remaining(0.0))
        } else {
            self.refine(shift.remaining, self.initial_guess(shift.remaining)).0
        }
    }

    /// dx/dτ = Λ + λ.
    pub fn compliance(&self, zone: &StickZone) -> f64 {
        self.small_load.compliance + zone.compliance_increase
    }

    /// Energy dissipated per cycle between ±τ, in units of force times shift (Eq. 13-16), and its derivative with respect to τ:
    /// `4 (τ λ - h)` with `h = β_b - (1-τ) (λ + β_c)`. The given λ needs to be accurate only to the rounding of Λ + λ.
    pub fn dissipation(&self, load: Complement, compliance_increase: f64) -> (f64, f64) {
        if load.consumed <= 0.5 {
            return self.small_load.dissipation(load.consumed);
        }
        let remaining = load.remaining;
        let (punch, load_c) = self.size_near(remaining, compliance_increase);
        let (beta, gamma) = (punch.beta(load_c), punch.gamma(load_c));
        let increase = self.increase_of(&punch);
        let square_difference = self.gamma - remaining * remaining * gamma;
        let energy =
            4.0 * ((1.0 + remaining) * (self.beta - remaining * beta) - remaining * increase - square_difference);
        let slope = 4.0 * (increase - self.beta + remaining * beta);
        if !self.has_layer() {
            return (energy, slope);
        }
        (energy + self.layer.dissipation(load), slope + 4.0 * self.layer.first_moment(load))
    }

    /// The moments at a load. For τ > 1/2 they follow from the given λ of contact and layer, which needs to be accurate only to the
    /// rounding of Λ + λ.
    ///
    /// The moment `by_flat` is 4 [(leg_b - a ψ_b) - (leg_c - a ψ_c)]/g_b, because dc/da at a constant load is leg/(c ψ).
    pub fn moments(&self, load: Complement, compliance_increase: f64) -> Moments {
        let Size { flat, leg, .. } = self.contact;
        let tau = load.consumed;
        let (increase, first, complement, leg_difference) = if tau <= 0.5 {
            let [increase, first] = self.small_load_without_layer.moments(tau);
            let square_difference = -(-2.0 * increase).exp_m1();
            (
                increase,
                first,
                increase - first,
                square_difference / (leg + (leg * leg - square_difference).max(0.0).sqrt()),
            )
        } else {
            let (punch, load_c) = self.size_near(load.remaining, compliance_increase);
            let increase = self.increase_of(&punch);
            let complement = self.beta - load.remaining * punch.beta(load_c);
            (increase, increase - complement, complement, leg - punch.leg)
        };
        let by_flat = if leg * leg <= 3.0 * flat * flat {
            // 2 ∫ (1-t) h'' dt + a ∫ 4 leg/g_b h'' dt = τ; the first term is the smaller one.
            (tau - 2.0 * complement) / flat
        } else {
            let angle = (flat * leg_difference).atan2(flat * flat + leg * (leg - leg_difference));
            4.0 / self.load * (leg_difference - flat * angle)
        };
        Moments { increase, first, complement, by_flat }
    }

    /// d(ln b)/d(ln g_b), and db/da at a constant load.
    pub fn size_slopes(&self) -> [f64; 2] {
        [self.small_load_without_layer.initial_curvature(), self.contact.leg / self.contact.psi]
    }

    /// leg² of a stick zone, and `leg_b² - leg²` free of cancellation.
    fn square_difference(&self, zone: &StickZone) -> [f64; 2] {
        if let Some(leg) = zone.leg {
            return [leg * leg, (self.contact.leg - leg) * (self.contact.leg + leg)];
        }
        let increase = if self.has_layer() {
            self.small_load_without_layer.moments(zone.load.consumed)[0]
        } else {
            zone.compliance_increase
        };
        let square_difference = self.contact.kernel().square_difference(increase);
        [(self.contact.leg * self.contact.leg - square_difference).max(0.0), square_difference]
    }

    /// c/b.
    pub fn size(&self, zone: &StickZone) -> f64 {
        let [square, _] = self.square_difference(zone);
        (self.contact.flat * self.contact.flat + square).sqrt().max(self.contact.flat)
    }

    /// Pressure of the contact less the pressure of a smaller size, given `[leg², leg_b² - leg²]` of the latter.
    fn pressure_beyond(&self, [square, square_difference]: [f64; 2], point: &SurfacePoint) -> f64 {
        let legs = [square.sqrt(), self.contact.leg, square_difference];
        self.contact.pressure(legs, point) * self.traction_scale() / PI
    }

    /// Factor of the integrals of `tractions`.
    fn traction_scale(&self) -> f64 {
        4.0 / self.load.max(TINY)
    }

    /// Pressure in units of N/(bL) or, for an ellipse, of N over the product of the semi-axes.
    pub fn pressure(&self, point: &SurfacePoint) -> f64 {
        self.pressure_beyond([0.0, self.contact.leg * self.contact.leg], point)
    }

    /// Shear traction over μ in those units under a monotonically increased force: the pressure of b less that of the stick zone
    /// (Eq. 21).
    pub fn shear(&self, point: &SurfacePoint, zone: &StickZone) -> f64 {
        self.pressure_beyond(self.square_difference(zone), point)
    }

    /// Relative slip (Eq. 15) in units of shift; `None` for an ellipse, for which there is no closed form.
    pub fn slip(&self, point: &SurfacePoint, zone: &StickZone) -> Option<f64> {
        let [square, _] = self.square_difference(zone);
        let slip = self.contact.resized(square.sqrt()).slip(point);
        (!slip.is_nan()).then_some(slip * self.traction_scale())
    }
}
