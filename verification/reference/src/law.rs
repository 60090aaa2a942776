//! One contact under a constant normal force: size, monotonic curve, energy and tractions, as differences of two sizes of its
//! family.
//!
//! Loads are in units of N, forces of mu N, displacements of mu N times the unit of compliances, positions of b. A stick zone of
//! size c has τ = 1 - N_c/N and the displacement mu (S_b - S_c).

use crate::Real;
use crate::family::{ADDED, Change, Family, Given, Size, unchanged};
use microslip::{EllipticParameters, Parameters};
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

/// A contact at every precision used so far.
#[derive(Clone)]
pub struct Reference {
    pub input: Input,
    levels: RefCell<BTreeMap<u32, Rc<Law>>>,
    lost: i32,
}

impl Reference {
    pub fn new(input: Input) -> Reference {
        let Law { family, whole, .. } = Law::new(&input, &unchanged(64));
        Reference { input, levels: RefCell::default(), lost: family.lost(&whole) }
    }

    /// Differences of the force \[N\] at a displacement \[m\] by the parameters N, mu, a, R, L and E*, each times its parameter (a:
    /// times b), with steps of 2⁻¹⁰⁰: central, with the relative error of their square; from above if a is about 0, where the
    /// second derivative is finite.
    pub fn differences(&self, displacement: f64) -> [Real; 6] {
        let first = self.law(0);
        let share = first.x(displacement.abs()) / &first.x_slip;
        let bits = self.law(bits_for(&share) + bits_for(&(1.0 - &share)) + 420).bits;
        let step = (-100.0 * Real::new(bits, 2.0).ln()).exp();
        let force = |change: &Change| {
            let law = Law::new(&self.input, change);
            &law.slip_force * law.at_x(&law.x(displacement.abs())).tau
        };
        // Wide enough for a step to both sides.
        let has_flat =
            matches!(&self.input, Input::Flat(p) if (&step * &first.half_width).f64() < 1e-3 * p.flat_half_width);
        core::array::from_fn(|parameter| {
            let at = |step: &Real| {
                let mut change = unchanged(bits);
                change[parameter] = if parameter == ADDED { step * &first.half_width } else { 1.0 + step };
                force(&change)
            };
            if parameter == ADDED && !has_flat {
                (at(&step) - at(&Real::new(bits, 0.0))) / &step
            } else {
                (at(&step) - at(&-&step)) / &step / 2.0
            }
        })
    }

    /// The parameters N, mu, b (instead of a), R, L and E*.
    pub fn values(&self) -> [Real; 6] {
        let law = self.law(0);
        let [radius, length] = match &self.input {
            Input::Flat(p) => [p.edge_radius, p.length].map(|value| law.real(value)),
            Input::Ellipse(_) => {
                let size = &law.half_width;
                [4.0 * &law.composite_modulus * size.square() * size / (3.0 * &law.family.load), law.real(1.0)]
            }
        };
        let [load, friction] = [&law.family.load, &law.friction].map(Real::clone);
        [load, friction, law.half_width.clone(), radius, length, law.composite_modulus.clone()]
    }

    /// The law with at least this many bits beyond those of a result and those that a nearly flat contact loses.
    pub fn law(&self, extra: i32) -> Rc<Law> {
        let need = (RESULT_BITS + self.lost + extra.max(0)) as u32;
        let bits = [128, 160, 192, 256, 320, 384, 512, 640, 768, 1024, 1536, 2048, 3072, 4096, 8192, 16384, 32768];
        let bits = *bits.iter().find(|bits| **bits >= need).expect("precision");
        let known = self.levels.borrow().get(&bits).cloned();
        known.unwrap_or_else(|| {
            let law = Rc::new(Law::new(&self.input, &unchanged(bits)));
            self.levels.borrow_mut().insert(bits, law.clone());
            law
        })
    }

    /// The point of a force \[N\], and the law with bits to spare.
    pub fn at_force_with(&self, force: f64, extra: i32) -> (Rc<Law>, Point) {
        let first = self.law(0);
        let tau = first.real(force.abs()) / &first.slip_force;
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
        let share = first.x(displacement.abs()) / &first.x_slip;
        let law = self.law(bits_for(&share) + bits_for(&(1.0 - &share)) / 2);
        let point = law.at_x(&law.x(displacement.abs()));
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
    pub composite_modulus: Real,
    pub half_width: Real,
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
    pub size: Real,
    /// w of the stick zone \[m\], and -dτ/dw.
    pub w: Real,
    pub load_rate: Real,
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

impl Law {
    fn new(input: &Input, change: &Change) -> Law {
        let family = Family::changed(input, change);
        let whole = family.find(Given::Load, &family.load);
        let (slip_force, unit) = (&family.friction * &family.load, family.compliance_unit());
        Law {
            bits: family.bits,
            composite_modulus: family.composite_modulus.clone(),
            half_width: whole.half_width.clone(),
            displacement_unit: &slip_force * unit,
            slip_force,
            stiffness_unit: 1.0 / unit,
            pressure_unit: family.pressure_unit(&whole.half_width),
            friction: family.friction.clone(),
            full_stick: &whole.tangential_compliance / unit,
            x_slip: &whole.shift / (unit * &family.load),
            whole,
            family,
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

    /// The point of gross slip.
    pub fn slip_point(&self) -> Point {
        self.at_w(&self.real(0.0))
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
        self.at(Given::Load, &(1.0 - tau), &self.whole.load)
    }

    /// The point of a displacement in its unit.
    pub fn at_x(&self, x: &Real) -> Point {
        self.at(Given::Shift, &(1.0 - x / &self.x_slip), &self.whole.shift)
    }

    /// The point whose stick zone has this part of the load or shift of the whole contact.
    fn at(&self, given: Given, part: &Real, of_whole: &Real) -> Point {
        if !part.is_positive() {
            return self.slip_point();
        }
        self.point(if *part == self.real(1.0) {
            self.whole.clone()
        } else {
            self.family.find(given, &(part * of_whole))
        })
    }

    /// The point of a stick zone by its w.
    pub fn at_w(&self, w: &Real) -> Point {
        self.point(self.family.size(w))
    }

    /// w of the whole contact.
    pub fn w_range(&self) -> Real {
        self.whole.w.clone()
    }

    fn point(&self, zone: Size) -> Point {
        let (Size { load, shift, potential, .. }, stiffness) = (&self.whole, &self.stiffness_unit);
        let slipped = shift - &zone.shift;
        let energy = (load + &zone.load) * &slipped - 2.0 * (potential - &zone.potential);
        Point {
            tau: (load - &zone.load) / load,
            one_minus_tau: &zone.load / load,
            x: stiffness * slipped / load,
            x_remaining: stiffness * &zone.shift / load,
            compliance: stiffness * &zone.tangential_compliance,
            curvature: stiffness * &zone.stiffening * load,
            energy: 4.0 * stiffness * energy / load.square(),
            size: &zone.half_width / &self.half_width,
            w: zone.w.clone(),
            load_rate: &zone.rate / load,
            zone,
        }
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

    /// Slip at x/b in units of displacement; beyond b its continuation.
    pub fn slip(&self, x: &Real, stick: &Point) -> Real {
        &self.friction * self.family.slip(&stick.zone, &(x * &self.half_width)) / &self.displacement_unit
    }
}
