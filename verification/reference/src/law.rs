//! One contact: size, monotonic curve, energy and tractions.
//!
//! Lengths are in units of b, loads of P, forces of mu N, displacements of 2 mu P/(πE*) (elliptical: mu N C0).
//! A stick zone of half-width c with w² = c² - a², ψ = atan(w/a) carries g(w)/g(w_b) of the load, g = 2 (a² + w²) ψ - 2 a w.

use crate::Real;
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Material, Parameters};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::f64::consts::PI;
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
    /// Bits that the closed forms of this contact lose: eight for each one by which w is below a.
    lost: i32,
}

/// Bits by which w is below a.
pub(crate) fn flatness(a: &Real, w: &Real) -> i32 {
    if a.is_zero() { 0 } else { (a.exponent() - w.exponent()).max(0) }
}

impl Reference {
    pub fn new(input: Input) -> Reference {
        let lost = match &input {
            Input::Flat(p) => {
                let (a, load) = (Real::new(64, p.flat_half_width), Law::load(p, 64));
                let scale = &a + load.sqrt();
                let a = a / &scale;
                8 * flatness(&a, &Real::new(64, w_guess(a.f64(), (load / scale.square()).f64())))
            }
            Input::Ellipse(_) => 0,
        };
        Reference { input, levels: RefCell::default(), lost }
    }

    /// Differences of the force \[N\] at a displacement \[m\] by the parameters N, mu, a, R, L and E*, each times its parameter (a: times b),
    /// with steps of 2⁻¹⁰⁰: central, with the relative error of their square; from above if a is about 0, where the second derivative is finite.
    pub fn differences(&self, displacement: f64) -> [Real; 6] {
        let first = self.law(0);
        let share = first.x(displacement.abs()) / &first.x_slip;
        let bits = self.law(bits_for(&share) + bits_for(&(1.0 - &share)) + 420).bits;
        let step = (-100.0 * Real::new(bits, 2.0).ln()).exp();
        let force = |change: &Change| {
            let law = Law::changed(&self.input, bits, change);
            let x = law.x(displacement.abs());
            let point = law.at_x(&x);
            if point.slips() || matches!(law.shape, Shape::Ellipse) {
                return &law.slip_force * point.tau;
            }
            // The root is converged to the bits of a result only; a Newton step doubles them.
            let found = law.at_w(&point.w);
            &law.slip_force * (&found.tau + (x - &found.x) / &found.compliance)
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
    pub shape: Shape,
}

pub enum Shape {
    Flat(Box<Flat>),
    Ellipse,
}

/// The flat with rounded edges, in units of b.
pub struct Flat {
    pub a: Real,
    pub w: Real,
    pub psi: Real,
    pub g: Real,
    ln_a: Real,
    /// B and C at b.
    b_sum: Real,
    c_sum: Real,
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
    pub w: Real,
    pub psi: Real,
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

/// (1 - ν²)/E of each body.
fn compliances(bits: u32, material: &[Material; 2]) -> [Real; 2] {
    material.each_ref().map(|body| (1.0 - Real::new(bits, body.poisson_ratio).square()) / body.young_modulus)
}

/// 1/E*.
pub(crate) fn compliance_of(bits: u32, material: &[Material; 2]) -> Real {
    let [one, two] = compliances(bits, material);
    one + two
}

/// Mean over both bodies, weighted by their compliances.
pub(crate) fn mean(bits: u32, material: &[Material; 2], function: impl Fn(&Real) -> Real) -> Real {
    let [one, two] = compliances(bits, material);
    let [f, g] = material.each_ref().map(|body| function(&Real::new(bits, body.poisson_ratio)));
    (&one * f + &two * g) / (one + two)
}

/// Changes of the parameters N, mu, a, R, L and E*: factors, but of a, to which a length is added.
type Change = [Real; 6];
const ADDED: usize = 2;

fn unchanged(bits: u32) -> Change {
    [1.0, 1.0, 0.0, 1.0, 1.0, 1.0].map(|value| Real::new(bits, value))
}

impl Law {
    pub fn new(input: &Input, bits: u32) -> Law {
        Law::changed(input, bits, &unchanged(bits))
    }

    /// The law of changed parameters. The bodies of an ellipse keep their shapes, but for a common factor R of their radii.
    fn changed(input: &Input, bits: u32, change: &Change) -> Law {
        match input {
            Input::Flat(p) => Law::flat(p, bits, change),
            Input::Ellipse(p) => Law::ellipse(p, bits, change),
        }
    }

    /// 4RP/E* \[length²\].
    fn load(p: &Parameters, bits: u32) -> Real {
        4.0 * Real::new(bits, p.edge_radius) * p.normal_force / p.length * compliance_of(bits, &p.material)
    }

    fn flat(p: &Parameters, bits: u32, change: &Change) -> Law {
        let [by_load, by_friction, added_flat, by_radius, by_length, by_modulus] = change;
        let real = |value: f64| Real::new(bits, value);
        let pi = Real::pi(bits);
        let modulus = by_modulus / compliance_of(bits, &p.material);
        let length = by_length * p.length;
        let load = by_load * p.normal_force / &length;
        let size = Law::load(p, bits) * by_radius * by_load / by_length / by_modulus;
        let (flat, half_width) = Flat::new(&(added_flat + p.flat_half_width), &size);
        let ratio = mean(bits, &p.material, |nu| nu / (1.0 - nu));
        let mut full_stick = (2.0 * &length / &half_width).ln() + ratio;
        if p.displacement_reference != CENTRE_POINT {
            let across = mean(bits, &p.material, |nu| (1.0 - 2.0 * nu) / (1.0 - nu));
            let along = 1.0 - real(2.0).ln() + Real::parse(bits, "0.093");
            full_stick = full_stick - along + 8.0 / pi.square() * across * &half_width / &length;
        }
        let slip_force = by_friction * by_load * p.friction_coefficient * p.normal_force;
        let stiffness_unit = &pi * &modulus * &length / 2.0;
        Law {
            bits,
            pressure_unit: load / &half_width,
            half_width,
            displacement_unit: &slip_force / &stiffness_unit,
            slip_force,
            stiffness_unit,
            composite_modulus: modulus,
            friction: real(p.friction_coefficient),
            x_slip: &full_stick + &flat.b_sum / &flat.g,
            full_stick,
            shape: Shape::Flat(Box::new(flat)),
        }
    }

    fn ellipse(p: &EllipticParameters, bits: u32, change: &Change) -> Law {
        let [by_load, by_friction, _, by_radius, _, by_modulus] = change;
        let by_size = (by_load * by_radius / by_modulus).cbrt();
        let (b, l) = (&by_size * p.semi_axis_x, &by_size * p.semi_axis_y);
        let (all, cosine) = cerruti(&b, &l);
        let mut compliance = Real::new(bits, 0.0);
        for body in &p.material {
            let nu = Real::new(bits, body.poisson_ratio);
            let sum = (1.0 - &nu) * &all + &nu * &cosine;
            compliance = compliance + (1.0 + &nu) / (Real::pi(bits) * body.young_modulus * by_modulus) * sum;
        }
        let slip_force = by_friction * by_load * p.friction_coefficient * p.normal_force;
        Law {
            bits,
            composite_modulus: by_modulus / compliance_of(bits, &p.material),
            pressure_unit: Real::new(bits, p.normal_force) / &b / &l,
            half_width: b,
            displacement_unit: &slip_force * &compliance,
            slip_force,
            stiffness_unit: 1.0 / compliance,
            friction: Real::new(bits, p.friction_coefficient),
            full_stick: Real::new(bits, 1.0),
            x_slip: Real::new(bits, 1.5),
            shape: Shape::Ellipse,
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
        let (infinite, zero) = (self.real(f64::INFINITY), self.real(0.0));
        let (increase, size, energy, psi) = match &self.shape {
            Shape::Flat(flat) => {
                let energy = 4.0 * (&flat.b_sum / &flat.g - &flat.c_sum / flat.g.square());
                if flat.a.is_zero() {
                    (infinite.clone(), zero.clone(), energy, Real::pi(self.bits) / 2.0)
                } else {
                    (-&flat.ln_a, flat.a.clone(), energy, zero)
                }
            }
            Shape::Ellipse => (infinite.clone(), zero.clone(), self.real(6.0) / 5.0, zero),
        };
        Point {
            tau: self.real(1.0),
            one_minus_tau: self.real(0.0),
            x: self.x_slip.clone(),
            x_remaining: self.real(0.0),
            compliance: &self.full_stick + increase,
            curvature: infinite,
            energy,
            size,
            w: self.real(0.0),
            psi,
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
        match &self.shape {
            Shape::Flat(flat) => {
                let (w, psi) = if tau.is_zero() {
                    (flat.w.clone(), flat.psi.clone())
                } else {
                    size_of_load(&flat.a, &(&one_minus_tau * &flat.g), Some(tau))
                };
                self.stick_zone(flat, w, psi, Some(one_minus_tau))
            }
            Shape::Ellipse => self.elliptic(one_minus_tau.cbrt()),
        }
    }

    /// The point of a stick zone by its w (elliptical: its size).
    pub fn at_w(&self, w: &Real) -> Point {
        match &self.shape {
            Shape::Flat(flat) => self.stick_zone(flat, w.clone(), flat.psi_of(w), None),
            Shape::Ellipse => self.elliptic(w.clone()),
        }
    }

    /// w of the whole contact, and -dτ/dw at a stick zone.
    pub fn w_range(&self) -> Real {
        if let Shape::Flat(flat) = &self.shape { flat.w.clone() } else { self.real(1.0) }
    }

    pub fn load_rate(&self, point: &Point) -> Real {
        match &self.shape {
            Shape::Flat(flat) => 4.0 * &point.w * &point.psi / &flat.g,
            Shape::Ellipse => 3.0 * point.w.square(),
        }
    }

    fn elliptic(&self, size: Real) -> Point {
        let square = size.square();
        let rest = &square * &size;
        // (4/3) ∫ (1-u) (u-s) u^(-4/3) du from s to 1.
        let energy = self.real(4.0) / 3.0
            * (1.5 * (1.0 + &rest) * (1.0 - &square) - self.real(3.0) / 5.0 * (1.0 - &rest * &square)
                + 3.0 * (&rest - &square));
        let compliance = 1.0 / &size;
        Point {
            tau: 1.0 - &rest,
            x: 1.5 * (1.0 - &square),
            x_remaining: 1.5 * &square,
            curvature: &compliance / (3.0 * &rest),
            energy,
            one_minus_tau: rest,
            compliance,
            w: size.clone(),
            psi: self.real(0.0),
            size,
        }
    }

    /// The point of a displacement in its unit, by Newton's iteration of third order.
    pub fn at_x(&self, x: &Real) -> Point {
        let x_remaining = &self.x_slip - x;
        if !x_remaining.is_positive() {
            return self.slip_point();
        }
        let Shape::Flat(flat) = &self.shape else {
            return self.elliptic((x_remaining / &self.x_slip).sqrt());
        };
        if x.is_zero() {
            return self.at_w(&flat.w);
        }
        let share = x / &self.x_slip;
        // Λτ + h''(0) τ²/2 <= x.
        let root = (self.full_stick.square() + x * &flat.g / (2.0 * &flat.psi)).sqrt();
        let tau = 2.0 * x / (&self.full_stick + root);
        let mut w = if tau.f64() < 1e-4 {
            &flat.w - tau * &flat.g / (4.0 * &flat.w * &flat.psi)
        } else {
            let remaining = x_remaining.f64();
            // Newton's iteration in the guess converges from below; s > 0.18 up to half the displacement of gross slip.
            let start = if share.f64() > 0.5 {
                remaining / (self.full_stick.f64() + 0.25)
            } else {
                0.1f64.max(1.0 - tau.f64())
            };
            self.real(w_guess(flat.a.f64(), self.one_minus_tau_guess(flat, remaining, start) * flat.g.f64()))
        };
        let mut psi = flat.psi_of(&w);
        for _ in 0..200 {
            let now = self.stick_zone(flat, w.clone(), psi, None);
            let newton = (x - &now.x) / &now.compliance;
            // Second order in τ, then in w.
            let d_tau = &newton * (1.0 - &newton * &now.curvature / &now.compliance / 2.0);
            let slope = 4.0 * &w * &now.psi;
            let d_load = -(&d_tau * &flat.g);
            let c2 = flat.a.square() + w.square();
            let bend = 4.0 * (&now.psi + &w * &flat.a / &c2);
            let first = &d_load / &slope;
            let step = &first * (1.0 - &first * &bend / &slope / 2.0);
            let next = &w + &step;
            let last = w.clone();
            // Keep w between 0 and w_b.
            w = if !next.is_positive() {
                w / 4.0
            } else if next > flat.w {
                (&last + &flat.w) / 2.0
            } else {
                next.clone()
            };
            if step.is_zero() || w == flat.w {
                return self.at_w(&w);
            }
            let relative = step.exponent() - last.exponent();
            let required = RESULT_BITS + 8 + 3 * bits_below_one(&share) + 2 * flatness(&flat.a, &w);
            if w == next && 3 * relative < -required {
                let psi = psi_after(&now.psi, &flat.a, &last, &c2, &step);
                return Point { x: x.clone(), x_remaining, ..self.stick_zone(flat, w, psi, None) };
            }
            psi = flat.psi_of(&w);
        }
        panic!("no point of the curve at {:e} of gross slip", share.f64());
    }

    /// s = 1 - τ of the remaining displacement s (Λ + λ + β), in doubles.
    fn one_minus_tau_guess(&self, flat: &Flat, x_remaining: f64, mut s: f64) -> f64 {
        let (a, g_b, full_stick) = (flat.a.f64(), flat.g.f64(), self.full_stick.f64());
        for _ in 0..12 {
            let w = w_guess(a, s * g_b);
            let (psi, increase) = (w.atan2(a), -0.5 * (a * a + w * w).ln());
            let step = (x_remaining - s * (full_stick + increase + beta(a, w, psi))) / (full_stick + increase);
            s = (s + step).max(0.25 * s);
            if step.abs() < 1e-13 * s {
                break;
            }
        }
        s
    }

    fn stick_zone(&self, flat: &Flat, w: Real, psi: Real, one_minus_tau: Option<Real>) -> Point {
        let a = &flat.a;
        let c2 = a.square() + w.square();
        let (g, one_minus_tau) = match one_minus_tau {
            Some(s) => (&s * &flat.g, s),
            None => {
                let g = load(a, &w, &psi);
                (g.clone(), g / &flat.g)
            }
        };
        let tau = 1.0 - &one_minus_tau;
        let increase = -c2.ln() / 2.0;
        let (b_sum, c_sum) = (b_sum(a, &w, &psi), c_sum(a, &w, &g, &(&flat.ln_a + &increase)));
        let difference = (&flat.b_sum - b_sum) / &flat.g;
        let x = &self.full_stick * &tau + (&difference - &one_minus_tau * &increase);
        let energy =
            4.0 * ((&tau - 1.0) * &increase + (2.0 - &tau) * difference - (&flat.c_sum - c_sum) / flat.g.square());
        Point {
            x_remaining: &self.x_slip - &x,
            compliance: &self.full_stick + &increase,
            curvature: &flat.g / (4.0 * &c2 * &psi),
            size: c2.sqrt(),
            tau,
            one_minus_tau,
            x,
            energy,
            w,
            psi,
        }
    }

    /// Pressure at x/b under the contact of a stick zone (of b: `None`), in units of N/(bL), elliptical of N/(b l).
    pub fn pressure(&self, x: &Real, stick: Option<&Point>) -> Real {
        let Shape::Flat(flat) = &self.shape else {
            // Hertz' ellipse on its x axis: the stick zone has σ³ of the load on σ² of the area.
            let size = stick.map_or(self.real(1.0), |point| point.size.clone());
            let square = size.square() - x.square();
            return if x >= &size { self.real(0.0) } else { square.sqrt() * 1.5 / Real::pi(self.bits) };
        };
        let (w, psi) = stick.map_or((&flat.w, &flat.psi), |point| (&point.w, &point.psi));
        let sum = punch_pressure(&flat.a, w, psi, x);
        4.0 / Real::pi(self.bits) * sum / &flat.g
    }

    /// Shear traction over mu in the same units (Eq. 21).
    pub fn shear(&self, x: &Real, stick: &Point) -> Real {
        let all = self.pressure(x, None);
        if stick.slips() { all } else { all - self.pressure(x, Some(stick)) }
    }

    /// Slip at x/b (Eq. 15) in units of displacement; beyond b its continuation.
    pub fn slip(&self, x: &Real, stick: &Point) -> Real {
        let Shape::Flat(flat) = &self.shape else { panic!("no slip of an elliptical contact") };
        let (a, w, psi) = (&flat.a, &stick.w, &stick.psi);
        let c2 = a.square() + w.square();
        let xi2 = x.square() - &c2;
        if !xi2.is_positive() {
            return self.real(0.0);
        }
        let xi = xi2.sqrt();
        let mut sum = x * psi * &xi + (x.square() + a.square()) * (a * &xi).atan2(&(x * w)) - 2.0 * a * x * xi.atan2(w);
        if !stick.slips() {
            sum = sum - &stick.one_minus_tau * &flat.g / 2.0 * (x / c2.sqrt()).acosh();
        }
        2.0 * sum / &flat.g
    }
}

impl Flat {
    /// The flat and its half-width b, under the load g = 4RP/E* \[length²\].
    fn new(a: &Real, load: &Real) -> (Flat, Real) {
        let (w, psi) = size_of_load(a, load, None);
        let b = (a.square() + w.square()).sqrt();
        let (a, w, g) = (a / &b, &w / &b, load / b.square());
        let ln_a = if a.is_zero() { a.clone() } else { a.ln() };
        (Flat { b_sum: b_sum(&a, &w, &psi), c_sum: c_sum(&a, &w, &g, &ln_a), a, w, psi, g, ln_a }, b)
    }

    fn psi_of(&self, w: &Real) -> Real {
        if self.a.is_zero() { Real::pi(w.bits()) / 2.0 } else { (w / &self.a).atan() }
    }
}

/// The load g(w) rounded to a double: 4RP/E* of a contact of half-width √(a² + w²).
pub fn load_of_size(a: f64, w: f64) -> f64 {
    let lost = 4.0 * (a / w).max(1.0).log2();
    let [a, w] = [a, w].map(|length| Real::new(128 + lost as u32, length));
    load(&a, &w, &w.atan2(&a)).f64()
}

/// The pressure of Eq. 17 at x, with sin φ = x/c, sin φ0 = a/c; the quotients of both logarithms meet in |x² - a²|.
pub(crate) fn punch_pressure(a: &Real, w: &Real, psi: &Real, x: &Real) -> Real {
    let c2 = a.square() + w.square();
    let zeta2 = &c2 - x.square();
    if !zeta2.is_positive() {
        return 0.0 * zeta2;
    }
    let zeta = zeta2.sqrt();
    let mut sum = psi * &zeta;
    if !x.is_zero() {
        sum = sum + x * ((x * w + a * &zeta).ln() - c2.ln() / 2.0);
    }
    if !a.is_zero() {
        sum = sum - a * (w + &zeta).ln();
    }
    let beyond = a - x;
    if !beyond.is_zero() {
        sum = sum + &beyond * (&beyond * (a + x)).abs().ln() / 2.0;
    }
    sum
}

/// g = 2 (a² + w²) ψ - 2 a w.
pub(crate) fn load(a: &Real, w: &Real, psi: &Real) -> Real {
    2.0 * (a.square() + w.square()) * psi - 2.0 * a * w
}

/// B = (w² + 3a²) ψ - 3 a w = ∫ g dc/c.
pub(crate) fn b_sum(a: &Real, w: &Real, psi: &Real) -> Real {
    (w.square() + 3.0 * a.square()) * psi - 3.0 * a * w
}

/// B/g in doubles.
pub(crate) fn beta(a: f64, w: f64, psi: f64) -> f64 {
    if psi < 0.05 {
        return psi * psi / 5.0;
    }
    ((w * w + 3.0 * a * a) * psi - 3.0 * a * w) / (2.0 * (a * a + w * w) * psi - 2.0 * a * w)
}

/// C = ∫ g² dc/c, with ln(a/c).
pub(crate) fn c_sum(a: &Real, w: &Real, g: &Real, ln_a_over_c: &Real) -> Real {
    let first = g.square() / 4.0;
    if a.is_zero() {
        return first;
    }
    let (a2, w2) = (a.square(), w.square());
    let c2 = &a2 + &w2;
    let a4 = a2.square();
    let second = 2.0 * a * g * w2 * w / (3.0 * &c2);
    let third = 4.0 * (&a2 * &c2 - &a4 * &a2 / &c2) + 16.0 * a4 * ln_a_over_c;
    first - second + third / 3.0
}

fn bits_below_one(share: &Real) -> i32 {
    (-share.exponent()).clamp(0, 8000)
}

/// ψ after a small step of w, to second order.
fn psi_after(psi: &Real, a: &Real, w: &Real, c2: &Real, step: &Real) -> Real {
    if a.is_zero() {
        return psi.clone();
    }
    let first = a * step / c2;
    psi + &first * (1.0 - w * step / c2)
}

/// w of a load, in doubles.
pub(crate) fn w_guess(a: f64, load: f64) -> f64 {
    if a == 0.0 {
        return (load / PI).sqrt();
    }
    let g = |w: f64| {
        let psi = w.atan2(a);
        if psi < 0.2 {
            let t = 4.0 * psi * psi;
            (a * a + w * w) * psi * t / 3.0 * (1.0 - t / 20.0 * (1.0 - t / 42.0 * (1.0 - t / 72.0)))
        } else {
            2.0 * (a * a + w * w) * psi - 2.0 * a * w
        }
    };
    let hertz = load / PI;
    let mut w = (hertz * hertz.sqrt() + 0.75 * a * load).cbrt();
    for _ in 0..6 {
        let slope = 4.0 * w * w.atan2(a);
        if slope > 0.0 {
            w = (w - (g(w) - load) / slope).max(0.25 * w);
        }
    }
    w
}

/// w and ψ of the contact of a load: the root of g(w) by Halley's iteration. With a share, to that share of its difference to b.
pub(crate) fn size_of_load(a: &Real, load: &Real, share: Option<&Real>) -> (Real, Real) {
    let bits = load.bits();
    if a.is_zero() {
        let pi = Real::pi(bits);
        return ((load / &pi).sqrt(), pi / 2.0);
    }
    let scale = a + load.sqrt();
    let mut w = Real::new(bits, w_guess((a / &scale).f64(), (load / scale.square()).f64())) * &scale;
    for _ in 0..400 {
        let psi = (&w / a).atan();
        let c2 = a.square() + w.square();
        let value = 2.0 * &c2 * &psi - 2.0 * a * &w - load;
        let slope = 4.0 * &w * &psi;
        let bend = 4.0 * (&psi + &w * a / &c2);
        let newton = &value / &slope;
        let step = -(&newton / (1.0 - &newton * bend / slope / 2.0));
        let relative = step.exponent() - w.exponent();
        let required =
            share.map_or(bits as i32, |share| RESULT_BITS + 8 + 3 * bits_below_one(share) + 2 * flatness(a, &w));
        let psi = psi_after(&psi, a, &w, &c2, &step);
        let next = &w + &step;
        if 3 * relative < -required {
            return (next, psi);
        }
        w = if next.is_positive() { next } else { w / 4.0 };
    }
    panic!("no contact of the load {load:?} on the flat {a:?}");
}

/// J = ∫ dθ/W and J_cos = ∫ cos²θ dθ/W, W² = l² cos²θ + b² sin²θ, θ from 0 to π/2, from K and E by the
/// arithmetic-geometric mean.
pub(crate) fn cerruti(b: &Real, l: &Real) -> (Real, Real) {
    let (small, large) = (b.clone().min(l), b.clone().max(l));
    if small == large {
        let all = Real::pi(b.bits()) / 2.0 / large;
        return (all.clone(), all / 2.0);
    }
    // Differences of both elliptic integrals lose twice as many bits as k² is below 1.
    let lost = (-2 * (1.0 - (&small / &large).square()).exponent()).max(0) as u32;
    let bits = b.bits() + lost;
    let (half_pi, ratio) = (Real::pi(bits) / 2.0, small.at(bits) / &large);
    let k2 = 1.0 - ratio.square();
    let (mut mean, mut geometric, mut power) = (Real::new(bits, 1.0), ratio, 0.5);
    let mut sum = &k2 / 2.0;
    loop {
        let half = (&mean - &geometric) / 2.0;
        let next = (&mean + &geometric) / 2.0;
        geometric = (&mean * &geometric).sqrt();
        mean = next;
        power *= 2.0;
        sum = sum + half.square() * power;
        // The next half-difference is about half of its square.
        if half.is_zero() || 2 * half.exponent() < -(bits as i32) - 16 {
            break;
        }
    }
    // K, and E = K (1 - Σ 2ⁿ⁻¹ c_n²).
    let k = half_pi / &mean;
    let e = &k * (1.0 - sum);
    let cosine = if b < l { (&e - (1.0 - &k2) * &k) / &k2 } else { (&k - &e) / &k2 };
    ((k / &large).at(b.bits()), (cosine / large).at(b.bits()))
}
