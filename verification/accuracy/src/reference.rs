//! The law in multi-precision, from the closed forms of the paper's equations as they are printed in the documentation: no
//! series, no expansion and no interpolation. What cancels is met with more digits.
//!
//! Lengths are in units of b, loads of P, forces of mu N, displacements of 2 mu P/(πE*) (elliptical: mu N C0).

use crate::real::Real;
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Material, Parameters};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

/// Bits of every result beyond what cancels: 33 digits.
const KEPT: i32 = 112;

#[derive(Debug, Clone, Copy)]
pub enum Given {
    Flat(Parameters),
    Ellipse(EllipticParameters),
}

/// A contact at every precision that was asked for.
#[derive(Clone)]
pub struct Reference {
    pub given: Given,
    levels: RefCell<BTreeMap<u32, Rc<Law>>>,
    /// Bits that the closed forms of the contact lose: eight for each one by which w is below a.
    lost: i32,
}

/// How many bits w is below a.
fn flatness(a: &Real, w: &Real) -> i32 {
    if a.is_zero() { 0 } else { (a.exponent() - w.exponent()).max(0) }
}

impl Reference {
    pub fn new(given: Given) -> Reference {
        let lost = match &given {
            Given::Flat(p) => {
                let (a, load) = (Real::new(64, p.flat_half_width), Law::load(p, 64));
                let scale = &a + load.sqrt();
                let a = a / &scale;
                8 * flatness(&a, &Real::new(64, w_roughly(&a, &(load / scale.square()))))
            }
            Given::Ellipse(_) => 0,
        };
        Reference { given, levels: RefCell::default(), lost }
    }

    /// The law with at least so many bits beyond those that every formula of the contact may lose.
    pub fn law(&self, extra: i32) -> Rc<Law> {
        let need = (KEPT + self.lost + extra.max(0)) as u32;
        let bits = [128, 160, 192, 256, 320, 384, 512, 640, 768, 1024, 1536, 2048, 3072, 4096, 8192, 16384, 32768];
        let bits = *bits.iter().find(|bits| **bits >= need).expect("precision");
        let known = self.levels.borrow().get(&bits).cloned();
        known.unwrap_or_else(|| {
            let law = Rc::new(Law::new(&self.given, bits));
            self.levels.borrow_mut().insert(bits, law.clone());
            law
        })
    }

    /// The law for a force \[N\], with bits to spare, and the point there.
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

    /// The law for a displacement \[m\], and the point there; `near` is some force \[N\] near that point's, from which the
    /// search starts.
    pub fn at_displacement(&self, displacement: f64, near: f64) -> (Rc<Law>, Point) {
        let first = self.law(0);
        let x = Real::new(first.bits, displacement.abs()) / &first.displacement_unit;
        let left = (&first.slip_approach - &x) / &first.slip_approach;
        let law = self.law(bits_for(&(x / &first.slip_approach)) + bits_for(&left) / 2);
        let x = Real::new(law.bits, displacement.abs()) / &law.displacement_unit;
        let near = Real::new(law.bits, near.abs()) / &law.slip_force;
        let point = law.at_approach(&x, &near);
        (law, point)
    }
}

/// Bits that differences of two members lose at a small share: three for each one by which it is below 1.
pub fn bits_for(share: &Real) -> i32 {
    if share.is_positive() { (-3 * share.exponent()).clamp(0, 24000) } else { 0 }
}

/// One contact at one precision.
pub struct Law {
    pub bits: u32,
    pub composite_modulus: Real,
    pub half_width: Real,
    /// mu N, the product itself.
    pub slip_force: Real,
    pub displacement_unit: Real,
    pub stiffness_unit: Real,
    pub pressure_unit: Real,
    pub friction: Real,
    /// Λ.
    pub full_stick: Real,
    /// x at gross slip.
    pub slip_approach: Real,
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
    half_pi: Real,
    /// B and C at b.
    b_sum: Real,
    c_sum: Real,
}

/// A member of the family: a stick zone, and the point of the curve that it belongs to.
#[derive(Debug, Clone)]
pub struct Point {
    pub tau: Real,
    pub rest: Real,
    /// x, and what is left until gross slip.
    pub approach: Real,
    pub left: Real,
    /// dx/dτ = Λ + λ.
    pub compliance: Real,
    /// dλ/dτ.
    pub curvature: Real,
    /// Energy of the cycle between ±τ.
    pub energy: Real,
    pub size: Real,
    pub w: Real,
    pub psi: Real,
}

fn compliance_of(bits: u32, body: &Material) -> Real {
    let nu = Real::new(bits, body.poisson_ratio);
    (1.0 - nu.square()) / body.young_modulus
}

/// Mean over both bodies, weighted by their compliances.
fn mean(bits: u32, material: &[Material; 2], function: impl Fn(&Real) -> Real) -> Real {
    let (mut sum, mut all) = (Real::new(bits, 0.0), Real::new(bits, 0.0));
    for body in material {
        let compliance = compliance_of(bits, body);
        sum = sum + &compliance * function(&Real::new(bits, body.poisson_ratio));
        all = all + compliance;
    }
    sum / all
}

impl Law {
    pub fn new(given: &Given, bits: u32) -> Law {
        match given {
            Given::Flat(p) => Law::flat(p, bits),
            Given::Ellipse(p) => Law::ellipse(p, bits),
        }
    }

    /// 4RP/E* \[length²\].
    fn load(p: &Parameters, bits: u32) -> Real {
        let compliance = compliance_of(bits, &p.material[0]) + compliance_of(bits, &p.material[1]);
        4.0 * Real::new(bits, p.edge_radius) * p.normal_force / p.length * compliance
    }

    fn flat(p: &Parameters, bits: u32) -> Law {
        let real = |value: f64| Real::new(bits, value);
        let pi = Real::pi(bits);
        let modulus = 1.0 / (compliance_of(bits, &p.material[0]) + compliance_of(bits, &p.material[1]));
        let (length, load) = (real(p.length), real(p.normal_force) / p.length);
        let (flat, half_width) = Flat::new(&real(p.flat_half_width), &Law::load(p, bits));
        let ratio = mean(bits, &p.material, |nu| nu / (1.0 - nu));
        let mut full_stick = (2.0 * &length / &half_width).ln() + ratio;
        if p.displacement_reference != CENTRE_POINT {
            let across = mean(bits, &p.material, |nu| (1.0 - 2.0 * nu) / (1.0 - nu));
            let along = 1.0 - Real::ln_2(bits) + Real::parse(bits, "0.093");
            full_stick = full_stick - along + 8.0 / pi.square() * across * &half_width / &length;
        }
        let slip_force = real(p.friction_coefficient) * p.normal_force;
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
            slip_approach: &full_stick + &flat.b_sum / &flat.g,
            full_stick,
            shape: Shape::Flat(Box::new(flat)),
        }
    }

    fn ellipse(p: &EllipticParameters, bits: u32) -> Law {
        let (b, l) = (Real::new(bits, p.semi_axis_x), Real::new(bits, p.semi_axis_y));
        // Differences of both elliptic integrals lose as many bits as k² is below 1, twice.
        let k2 = (1.0 - (b.clone().min(&l) / b.clone().max(&l)).square()).abs();
        let more = bits + if k2.is_zero() { 0 } else { (-2 * k2.exponent()).max(0) as u32 };
        let (all, cosine) = cerruti(&b.at(more), &l.at(more));
        let mut compliance = Real::new(bits, 0.0);
        for body in &p.material {
            let nu = Real::new(bits, body.poisson_ratio);
            let sum = (1.0 - &nu) * all.at(bits) + &nu * cosine.at(bits);
            compliance = compliance + (1.0 + &nu) / (Real::pi(bits) * body.young_modulus) * sum;
        }
        let slip_force = Real::new(bits, p.friction_coefficient) * p.normal_force;
        Law {
            bits,
            composite_modulus: 1.0 / (compliance_of(bits, &p.material[0]) + compliance_of(bits, &p.material[1])),
            pressure_unit: Real::new(bits, p.normal_force) / &b / &l,
            half_width: b,
            displacement_unit: &slip_force * &compliance,
            slip_force,
            stiffness_unit: 1.0 / compliance,
            friction: Real::new(bits, p.friction_coefficient),
            full_stick: Real::new(bits, 1.0),
            slip_approach: Real::new(bits, 1.5),
            shape: Shape::Ellipse,
        }
    }

    pub fn real(&self, value: f64) -> Real {
        Real::new(self.bits, value)
    }

    pub fn energy_unit(&self) -> Real {
        &self.slip_force * &self.displacement_unit
    }

    /// The point of gross slip.
    pub fn slip_point(&self) -> Point {
        let (infinite, zero) = (self.real(f64::INFINITY), self.real(0.0));
        let (excess, size, energy, psi) = match &self.shape {
            Shape::Flat(flat) => {
                let energy = 4.0 * (&flat.b_sum / &flat.g - &flat.c_sum / flat.g.square());
                let excess = if flat.a.is_zero() { infinite.clone() } else { -&flat.ln_a };
                let psi = if flat.a.is_zero() { flat.half_pi.clone() } else { zero };
                (excess, flat.a.clone(), energy, psi)
            }
            Shape::Ellipse => (infinite.clone(), zero.clone(), self.real(6.0) / 5.0, zero),
        };
        Point {
            tau: self.real(1.0),
            rest: self.real(0.0),
            approach: self.slip_approach.clone(),
            left: self.real(0.0),
            compliance: &self.full_stick + excess,
            curvature: infinite,
            energy,
            size,
            w: self.real(0.0),
            psi,
        }
    }

    /// The point under a force \[N\]: what is mu N as a double is mu N.
    pub fn at_force(&self, force: f64) -> Point {
        let force = force.abs();
        if force >= self.slip_force.f64() {
            self.slip_point()
        } else {
            self.at_load(&(self.real(force) / &self.slip_force))
        }
    }

    pub fn at_load(&self, tau: &Real) -> Point {
        let rest = 1.0 - tau;
        if !rest.is_positive() {
            return self.slip_point();
        }
        match &self.shape {
            Shape::Flat(flat) => {
                let (w, psi) = if tau.is_zero() {
                    (flat.w.clone(), flat.psi.clone())
                } else {
                    size_of_load(&flat.a, &(&rest * &flat.g), Some(tau))
                };
                self.member(flat, w, psi, Some(rest))
            }
            Shape::Ellipse => self.elliptic(rest.cbrt()),
        }
    }

    /// The point of a stick zone, by its w.
    pub fn at_w(&self, w: &Real) -> Point {
        match &self.shape {
            Shape::Flat(flat) => {
                let psi = flat.psi_of(w);
                self.member(flat, w.clone(), psi, None)
            }
            Shape::Ellipse => self.elliptic(w.clone()),
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
            approach: 1.5 * (1.0 - &square),
            left: 1.5 * &square,
            curvature: &compliance / (3.0 * &rest),
            energy,
            rest,
            compliance,
            w: size.clone(),
            psi: self.real(0.0),
            size,
        }
    }

    /// The point of a displacement over its unit, from a force over mu N near it: Newton's iteration with the curve's bend.
    pub fn at_approach(&self, approach: &Real, near: &Real) -> Point {
        let left = &self.slip_approach - approach;
        if !left.is_positive() {
            return self.slip_point();
        }
        let Shape::Flat(flat) = &self.shape else {
            return self.elliptic((left / self.slip_approach.clone()).sqrt());
        };
        if approach.is_zero() {
            return self.at_w(&flat.w);
        }
        let share = approach / &self.slip_approach;
        let start = if share.f64() > 0.5 {
            self.real(self.rest_roughly(flat, left.f64()))
        } else {
            1.0 - near.clone().min(&self.real(0.9999))
        };
        let mut w = self.real(w_roughly(&flat.a, &(start * &flat.g)));
        let mut psi = flat.psi_of(&w);
        for _ in 0..200 {
            let now = self.member(flat, w.clone(), psi, None);
            let newton = (approach - &now.approach) / &now.compliance;
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
            // Neither beyond b nor to nothing.
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
            if w == next && 3 * relative < -(KEPT + 8 + 3 * needed(&share) + 2 * flatness(&flat.a, &w)) {
                let psi = moved(&now.psi, &flat.a, &last, &c2, &step);
                let mut found = self.member(flat, w, psi, None);
                found.approach = approach.clone();
                found.left = left;
                return found;
            }
            psi = flat.psi_of(&w);
        }
        panic!("no point of the curve at {approach:?}");
    }

    /// s of what is left until gross slip, s (Λ + λ + β), in doubles.
    fn rest_roughly(&self, flat: &Flat, left: f64) -> f64 {
        let (a, g_b, full) = (flat.a.f64(), flat.g.f64(), self.full_stick.f64());
        let mut rest = left / (full + 0.25);
        for _ in 0..12 {
            let w = w_roughly_of(a, rest * g_b);
            let (psi, excess) = (w.atan2(a), -0.5 * (a * a + w * w).ln());
            let mean = if psi < 0.05 {
                psi * psi / 5.0
            } else {
                ((w * w + 3.0 * a * a) * psi - 3.0 * a * w) / (2.0 * (a * a + w * w) * psi - 2.0 * a * w)
            };
            let step = (left - rest * (full + excess + mean)) / (full + excess);
            rest = (rest + step).max(0.25 * rest);
            if step.abs() < 1e-13 * rest {
                break;
            }
        }
        rest
    }

    fn member(&self, flat: &Flat, w: Real, psi: Real, rest: Option<Real>) -> Point {
        let a = &flat.a;
        let c2 = a.square() + w.square();
        let g = rest.as_ref().map_or_else(|| load(a, &w, &psi), |rest| rest * &flat.g);
        let rest = rest.unwrap_or_else(|| &g / &flat.g);
        let tau = 1.0 - &rest;
        let excess = -c2.ln() / 2.0;
        let (b_sum, c_sum) = (b_sum(a, &w, &psi), c_sum(a, &w, &g, &(&flat.ln_a + &excess)));
        let way = (&flat.b_sum - b_sum) / &flat.g;
        let h = &way - &rest * &excess;
        let approach = &self.full_stick * &tau + h;
        let energy = 4.0 * ((&tau - 1.0) * &excess + (2.0 - &tau) * way - (&flat.c_sum - c_sum) / flat.g.square());
        Point {
            left: &self.slip_approach - &approach,
            compliance: &self.full_stick + &excess,
            curvature: &flat.g / (4.0 * &c2 * &psi),
            size: c2.sqrt(),
            tau,
            rest,
            approach,
            energy,
            w,
            psi,
        }
    }

    /// Pressure under the contact of a stick zone (of b: `None`) at x/b, in units of N/(bL), elliptical of N/(b l).
    pub fn pressure(&self, x: &Real, stick: Option<&Point>) -> Real {
        let zero = self.real(0.0);
        let Shape::Flat(flat) = &self.shape else {
            // Hertz' ellipse on its x axis: the stick zone has σ³ of the load on σ² of the area.
            let size = stick.map_or(self.real(1.0), |point| point.size.clone());
            return if x >= &size { zero } else { (size.square() - x.square()).sqrt() * 1.5 / Real::pi(self.bits) };
        };
        let (w, psi) = stick.map_or((&flat.w, &flat.psi), |point| (&point.w, &point.psi));
        let a = &flat.a;
        let c2 = a.square() + w.square();
        let zeta2 = &c2 - x.square();
        if !zeta2.is_positive() {
            return zero;
        }
        let zeta = zeta2.sqrt();
        // Eq. 17 with sin φ = x/c, sin φ0 = a/c; the quotients of both logarithms meet in |x² - a²|.
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
        4.0 / Real::pi(self.bits) * sum / &flat.g
    }

    /// Shear over mu in the same units (Eq. 21).
    pub fn shear(&self, x: &Real, stick: &Point) -> Real {
        let all = self.pressure(x, None);
        if stick.rest.is_zero() { all } else { all - self.pressure(x, Some(stick)) }
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
        if !stick.rest.is_zero() {
            sum = sum - &stick.rest * &flat.g / 2.0 * (x / c2.sqrt()).acosh();
        }
        2.0 * sum / &flat.g
    }
}

impl Flat {
    /// The flat and its half-width b, under the load g = 4RP/E* \[length²\].
    fn new(a: &Real, load: &Real) -> (Flat, Real) {
        let bits = a.bits();
        let (w, psi) = size_of_load(a, load, None);
        let b = (a.square() + w.square()).sqrt();
        let (a, w, g) = (a / &b, &w / &b, load / b.square());
        let ln_a = if a.is_zero() { Real::new(bits, 0.0) } else { a.ln() };
        let flat = Flat {
            b_sum: b_sum(&a, &w, &psi),
            c_sum: c_sum(&a, &w, &g, &ln_a),
            half_pi: Real::pi(bits) / 2.0,
            a,
            w,
            psi,
            g,
            ln_a,
        };
        (flat, b)
    }

    fn psi_of(&self, w: &Real) -> Real {
        if self.a.is_zero() { self.half_pi.clone() } else { (w / &self.a).atan() }
    }
}

/// g = 2 (a² + w²) ψ - 2 a w.
fn load(a: &Real, w: &Real, psi: &Real) -> Real {
    2.0 * (a.square() + w.square()) * psi - 2.0 * a * w
}

/// B = (w² + 3a²) ψ - 3 a w = ∫ g dc/c.
fn b_sum(a: &Real, w: &Real, psi: &Real) -> Real {
    (w.square() + 3.0 * a.square()) * psi - 3.0 * a * w
}

/// C = ∫ g² dc/c, with ln(a/c).
fn c_sum(a: &Real, w: &Real, g: &Real, ln_a_over_c: &Real) -> Real {
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

/// Bits by which a share is below 1.
fn needed(share: &Real) -> i32 {
    (-share.exponent()).clamp(0, 8000)
}

/// ψ after a small step of w, to second order.
fn moved(psi: &Real, a: &Real, w: &Real, c2: &Real, step: &Real) -> Real {
    if a.is_zero() {
        return psi.clone();
    }
    let first = a * step / c2;
    psi + &first * (1.0 - w * step / c2)
}

/// w of a load, in doubles.
fn w_roughly(a: &Real, load: &Real) -> f64 {
    if a.is_zero() {
        return (load.at(64) / Real::pi(64)).sqrt().f64();
    }
    w_roughly_of(a.f64(), load.f64())
}

fn w_roughly_of(a: f64, load: f64) -> f64 {
    let g = |w: f64| {
        let psi = w.atan2(a);
        if psi < 0.2 {
            let t = 4.0 * psi * psi;
            (a * a + w * w) * psi * t / 3.0 * (1.0 - t / 20.0 * (1.0 - t / 42.0 * (1.0 - t / 72.0)))
        } else {
            2.0 * (a * a + w * w) * psi - 2.0 * a * w
        }
    };
    let hertz = load / std::f64::consts::PI;
    let mut w = (hertz * hertz.sqrt() + 0.75 * a * load).cbrt();
    for _ in 0..6 {
        let slope = 4.0 * w * w.atan2(a);
        if slope > 0.0 {
            w = (w - (g(w) - load) / slope).max(0.25 * w);
        }
    }
    w
}

/// w and ψ of the contact of a load: the root of g(w), by Halley's iteration; digits for a difference to b of that share.
fn size_of_load(a: &Real, load: &Real, share: Option<&Real>) -> (Real, Real) {
    let bits = load.bits();
    if a.is_zero() {
        let pi = Real::pi(bits);
        return ((load / &pi).sqrt(), pi / 2.0);
    }
    let scale = a + load.sqrt();
    let mut w = Real::new(bits, w_roughly(&(a / &scale), &(load / scale.square()))) * &scale;
    for _ in 0..400 {
        let psi = (&w / a).atan();
        let c2 = a.square() + w.square();
        let value = 2.0 * &c2 * &psi - 2.0 * a * &w - load;
        let slope = 4.0 * &w * &psi;
        let bend = 4.0 * (&psi + &w * a / &c2);
        let newton = &value / &slope;
        let step = -(&newton / (1.0 - &newton * bend / slope / 2.0));
        let relative = step.exponent() - w.exponent();
        let wanted = share.map_or(bits as i32, |share| KEPT + 8 + 3 * needed(share) + 2 * flatness(a, &w));
        let psi = moved(&psi, a, &w, &c2, &step);
        let next = &w + &step;
        if 3 * relative < -wanted {
            return (next, psi);
        }
        w = if next.is_positive() { next } else { w / 4.0 };
    }
    panic!("no contact of the load {load:?} on the flat {a:?}");
}

/// J = ∫ dθ/W and J_cos = ∫ cos²θ dθ/W, W² = l² cos²θ + b² sin²θ, θ from 0 to π/2, from K and E by the
/// arithmetic-geometric mean.
pub fn cerruti(b: &Real, l: &Real) -> (Real, Real) {
    let bits = b.bits();
    let (small, large) = (b.clone().min(l), b.clone().max(l));
    let half_pi = Real::pi(bits) / 2.0;
    if small == large {
        let all = half_pi / large;
        return (all.clone(), all / 2.0);
    }
    let ratio = &small / &large;
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
    (k / &large, cosine / large)
}
