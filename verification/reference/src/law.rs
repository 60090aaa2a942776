//! One contact under a constant load: monotonic curve, energy and tractions, by the nested sizes of its family.
//!
//! Lengths are in units of b, loads of P, forces of mu N, displacements of 2 mu P/(πE*) (elliptical: mu N C0). A stick zone of size c
//! carries N_c, so `τ = 1 - N_c/N_b`, and the displacement is `mu (S_b - S_c)`.

use crate::Real;
use crate::family::{Family, Given, Size, angle};
use microslip::{EllipticParameters, Layer, Parameters};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Bits of every result after cancellation: 33 digits.
const RESULT_BITS: i32 = 112;

/// Parameters of a contact.
#[derive(Debug, Clone, Copy)]
pub enum Input {
    Flat(Parameters),
    Ellipse(EllipticParameters),
}

impl Input {
    /// The same contact with another layer.
    pub fn with_layer(self, layer: Layer) -> Input {
        match self {
            Input::Flat(p) => Input::Flat(Parameters { layer, ..p }),
            Input::Ellipse(p) => Input::Ellipse(EllipticParameters { layer, ..p }),
        }
    }

    pub fn layer(&self) -> Layer {
        let (Input::Flat(Parameters { layer, .. }) | Input::Ellipse(EllipticParameters { layer, .. })) = *self;
        layer
    }
}

/// A contact at every precision used so far.
#[derive(Clone)]
pub struct Reference {
    pub input: Input,
    levels: RefCell<BTreeMap<u32, Rc<Law>>>,
    /// Bits that the closed forms of this contact lose: eight for each one by which w is below a.
    lost: i32,
}

impl Reference {
    pub fn new(input: Input) -> Reference {
        Reference { lost: Law::new(&input, 128).family.lost_bits(), input, levels: RefCell::default() }
    }

    /// Differences of the force \[N\] at a displacement \[m\] by the parameters N, mu, a, R, L and E*, each times its parameter (a: times b),
    /// with steps of 2⁻¹⁰⁰: central, with the relative error of their square; from above if a is about 0, where the second derivative is finite.
    pub fn differences(&self, displacement: f64) -> [Real; 6] {
        let first = self.law(0);
        let share = Real::new(first.bits, displacement.abs()) / &first.displacement_unit / &first.x_slip;
        let bits = self.law(bits_for(&share) + bits_for(&(1.0 - &share)) + 420).bits;
        let step = (-100.0 * Real::new(bits, 2.0).ln()).exp();
        let force = |change: &Change| {
            let law = Law::changed(&self.input, bits, change);
            let x = Real::new(bits, displacement.abs()) / &law.displacement_unit;
            &law.slip_force * law.at_x(&x).tau
        };
        // Wide enough for a step to both sides.
        let has_flat =
            matches!(&self.input, Input::Flat(p) if (&step * &first.half_width).f64() < 1e-3 * p.flat_half_width);
        core::array::from_fn(|parameter| {
            let at = |step: &Real| {
                let mut change = Change::none(bits);
                match [0, 1, 5, 2, 3, 4][parameter] {
                    5 => change.added_flat = step * &first.half_width,
                    factor => change.factors[factor] = 1.0 + step,
                }
                force(&change)
            };
            if parameter == 2 && !has_flat {
                (at(&step) - at(&Real::new(bits, 0.0))) / &step
            } else {
                (at(&step) - at(&-&step)) / &step / 2.0
            }
        })
    }

    /// The parameters N, mu, b (instead of a), R, L and E*.
    pub fn values(&self) -> [Real; 6] {
        let law = self.law(0);
        let [load, friction, radius, length] = match &self.input {
            Input::Flat(p) => {
                [p.normal_force, p.friction_coefficient, p.edge_radius, p.length].map(|value| law.real(value))
            }
            Input::Ellipse(p) => {
                let load = law.real(p.normal_force);
                let size = &law.half_width;
                let radius = 4.0 * &law.composite_modulus * size.square() * size / (3.0 * &load);
                [load, law.real(p.friction_coefficient), radius, law.real(1.0)]
            }
        };
        [load, friction, law.half_width.clone(), radius, length, law.composite_modulus.clone()]
    }

    /// The law with at least this many bits beyond those that every formula of the contact may lose.
    pub fn law(&self, extra: i32) -> Rc<Law> {
        let need = (RESULT_BITS + self.lost + extra.max(0)) as u32;
        let bits = [128, 160, 192, 256, 320, 384, 512, 640, 768, 1024, 1536, 2048, 3072, 4096, 8192, 16384, 32768];
        let bits = *bits.iter().find(|bits| **bits >= need).expect("precision");
        let known = self.levels.borrow().get(&bits).cloned();
        known.unwrap_or_else(|| {
            let law = Rc::new(Law::new(&self.input, bits));
            self.levels.borrow_mut().insert(bits, law.clone());
            law
        })
    }

    /// The point of a force \[N\], and the law with bits to spare.
    pub fn at_force_with(&self, force: f64, extra: i32) -> (Rc<Law>, Point) {
        let first = self.law(0);
        let tau = Real::new(first.bits, force.abs()) / &first.slip_force;
        let law = self.law(bits_for(&tau) + bits_for(&(1.0 - &tau)) / 2 + extra);
        let point = law.at_force(force);
        (law, point)
    }

    pub fn at_force(&self, force: f64) -> (Rc<Law>, Point) {
        self.at_force_with(force, 0)
    }

    /// The point of a displacement \[m\].
    pub fn at_displacement(&self, displacement: f64) -> (Rc<Law>, Point) {
        let first = self.law(0);
        let share = Real::new(first.bits, displacement.abs()) / &first.displacement_unit / &first.x_slip;
        let law = self.law(bits_for(&share) + bits_for(&(1.0 - &share)) / 2);
        let point = law.at_x(&(Real::new(law.bits, displacement.abs()) / &law.displacement_unit));
        (law, point)
    }
}

/// Bits that differences of two stick zones lose at a small share: three for each one by which it is below 1.
pub fn bits_for(share: &Real) -> i32 {
    if share.is_positive() { (-3 * share.exponent()).clamp(0, 24000) } else { 0 }
}

/// One contact at one precision.
pub struct Law {
    pub bits: u32,
    pub half_width: Real,
    pub composite_modulus: Real,
    pub slip_force: Real,
    pub displacement_unit: Real,
    pub stiffness_unit: Real,
    pub pressure_unit: Real,
    pub friction: Real,
    /// Λ: compliance of full stick.
    pub full_stick: Real,
    /// x at gross slip.
    pub x_slip: Real,
    family: Family,
    /// The whole contact.
    whole: Size,
}

/// A stick zone, and its point of the monotonic curve.
#[derive(Debug, Clone)]
pub struct Point {
    pub tau: Real,
    pub one_minus_tau: Real,
    /// Displacement, and the remaining one before gross slip.
    pub x: Real,
    pub x_remaining: Real,
    /// dx/dτ = Λ + λ; infinite in gross slip of a cylinder or an ellipse.
    pub compliance: Real,
    /// dλ/dτ.
    pub curvature: Real,
    /// Energy of the cycle between ±τ.
    pub energy: Real,
    /// Of the stick zone over b.
    pub size: Real,
    zone: Size,
}

impl Point {
    pub fn slips(&self) -> bool {
        self.one_minus_tau.is_zero()
    }

    /// dτ/dx, 0 in gross slip.
    pub fn stiffness(&self) -> Real {
        if self.slips() { Real::new(self.tau.bits(), 0.0) } else { 1.0 / &self.compliance }
    }

    /// τ h'': by how much λ changes relative to τ.
    pub fn rate(&self) -> f64 {
        if self.slips() { 0.0 } else { (&self.tau * &self.curvature).f64() }
    }
}

/// Changes of the parameters: factors of N, mu, R, L and E*, and a length added to a.
#[derive(Debug, Clone)]
pub struct Change {
    pub factors: [Real; 5],
    pub added_flat: Real,
}

impl Change {
    pub fn none(bits: u32) -> Change {
        Change { factors: [(); 5].map(|()| Real::new(bits, 1.0)), added_flat: Real::new(bits, 0.0) }
    }
}

impl Law {
    pub fn new(input: &Input, bits: u32) -> Law {
        Law::changed(input, bits, &Change::none(bits))
    }

    /// The law of changed parameters. The bodies of an ellipse keep their shapes, but for a common factor R of their radii.
    pub fn changed(input: &Input, bits: u32, change: &Change) -> Law {
        let family = Family::changed(input, bits, change);
        let whole = family.find(Given::Load, &family.load);
        let (friction, unit) = (&change.factors[1] * &family.friction, family.compliance_unit());
        let slip_force = friction * &family.load;
        Law {
            bits,
            half_width: whole.half_width.clone(),
            composite_modulus: family.composite_modulus.clone(),
            displacement_unit: &slip_force * &unit,
            pressure_unit: family.mean_pressure(&whole),
            friction: family.friction.clone(),
            full_stick: &whole.tangential_compliance / &unit,
            x_slip: &whole.shift / (&whole.load * &unit),
            stiffness_unit: 1.0 / unit,
            slip_force,
            family,
            whole,
        }
    }

    pub fn real(&self, value: f64) -> Real {
        Real::new(self.bits, value)
    }

    /// A displacement \[m\] in its unit.
    pub fn x(&self, displacement: f64) -> Real {
        self.real(displacement) / &self.displacement_unit
    }

    pub fn energy_unit(&self) -> Real {
        &self.slip_force * &self.displacement_unit
    }

    /// The point of a stick zone.
    fn at(&self, zone: Size) -> Point {
        let whole = &self.whole;
        let [load, shift] = [&whole.load - &zone.load, &whole.shift - &zone.shift];
        // 8 ∫ T dδ - 4 T δ.
        let area = &whole.load * &shift - (&whole.potential - &zone.potential);
        let energy = (8.0 * area - 4.0 * &load * &shift) * &self.stiffness_unit / whole.load.square();
        let cubed = zone.tangential_compliance.square() * &zone.tangential_compliance;
        let per_load = &self.stiffness_unit / &whole.load;
        Point {
            tau: load / &whole.load,
            one_minus_tau: &zone.load / &whole.load,
            x: shift * &per_load,
            x_remaining: &zone.shift * per_load,
            compliance: &zone.tangential_compliance * &self.stiffness_unit,
            curvature: self.family.curvature(&zone) * cubed * &whole.load * &self.stiffness_unit,
            energy,
            size: &zone.half_width / &whole.half_width,
            zone,
        }
    }

    /// The point of gross slip: the stick zone is the flat.
    pub fn slip_point(&self) -> Point {
        let infinite = self.real(f64::INFINITY);
        let zone = if self.family.has_flat() {
            self.family.size(&self.real(0.0))
        } else {
            Size { tangential_compliance: infinite.clone(), ..Size::zero(self.bits) }
        };
        let whole = &self.whole;
        let energy =
            (4.0 * &whole.load * &whole.shift - 8.0 * &whole.potential) * &self.stiffness_unit / whole.load.square();
        Point {
            tau: self.real(1.0),
            one_minus_tau: self.real(0.0),
            x: self.x_slip.clone(),
            x_remaining: self.real(0.0),
            compliance: &zone.tangential_compliance * &self.stiffness_unit,
            curvature: infinite,
            energy,
            size: &zone.half_width / &whole.half_width,
            zone,
        }
    }

    /// The point of a force \[N\]; a double that equals the rounded mu N is mu N.
    pub fn at_force(&self, force: f64) -> Point {
        let force = force.abs();
        if force >= self.slip_force.f64() {
            self.slip_point()
        } else {
            self.at_tau(&(self.real(force) / &self.slip_force))
        }
    }

    pub fn at_tau(&self, tau: &Real) -> Point {
        let one_minus_tau = 1.0 - tau;
        if !one_minus_tau.is_positive() {
            return self.slip_point();
        }
        let point = self.at(self.family.find(Given::Load, &(&self.whole.load * &one_minus_tau)));
        Point { tau: tau.clone(), one_minus_tau, ..point }
    }

    /// The point of a displacement in its unit.
    pub fn at_x(&self, x: &Real) -> Point {
        let x_remaining = &self.x_slip - x;
        if !x_remaining.is_positive() {
            return self.slip_point();
        }
        let shift = &x_remaining * &self.whole.load / &self.stiffness_unit;
        let point = self.at(if x.is_zero() { self.whole.clone() } else { self.family.find(Given::Shift, &shift) });
        Point { x: x.clone(), x_remaining, ..point }
    }

    /// The point of a stick zone by its w over b.
    pub fn at_w(&self, w: &Real) -> Point {
        self.at(self.family.size(&(w * &self.half_width)))
    }

    /// w over b of the whole contact, and of a stick zone.
    pub fn w_range(&self) -> Real {
        &self.whole.w / &self.half_width
    }

    pub fn w(&self, point: &Point) -> Real {
        &point.zone.w / &self.half_width
    }

    /// -dτ/dw at a stick zone.
    pub fn load_rate(&self, point: &Point) -> Real {
        self.family.load_rate(&point.zone.w) * &self.half_width / &self.whole.load
    }

    /// Pressure at x/b under the contact of a stick zone (of b: `None`), in units of N/(bL), elliptical of N/(b l).
    pub fn pressure(&self, x: &Real, stick: Option<&Point>) -> Real {
        let size = stick.map_or(&self.whole, |point| &point.zone);
        self.family.pressure(size, &(x * &self.half_width)) / &self.pressure_unit
    }

    /// Shear traction over mu in the same units (Eq. 21).
    pub fn shear(&self, x: &Real, stick: &Point) -> Real {
        let all = self.pressure(x, None);
        if stick.slips() { all } else { all - self.pressure(x, Some(stick)) }
    }

    /// Slip at x/b (Eq. 15) in units of displacement; beyond b its continuation.
    pub fn slip(&self, x: &Real, stick: &Point) -> Real {
        let [a, g] = self.family.flat(&self.whole).expect("no slip of an elliptical contact");
        let w = self.w(stick);
        let c2 = a.square() + w.square();
        let xi2 = x.square() - &c2;
        if !xi2.is_positive() {
            return self.real(0.0);
        }
        let (xi, psi) = (xi2.sqrt(), angle(&a, &w));
        let mut sum =
            x * psi * &xi + (x.square() + a.square()) * (&a * &xi).atan2(&(x * &w)) - 2.0 * a * x * xi.atan2(&w);
        if !stick.slips() {
            sum = sum - &stick.one_minus_tau * &g / 2.0 * (x / c2.sqrt()).acosh();
        }
        2.0 * sum / g
    }
}
