//! The nested sizes of a contact in absolute terms: N, U, S and M = ∫ N dS of a size, and their inverses.

use crate::law::*;
use crate::{Input, Real};
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Parameters};

/// Bits of the functions of a size after cancellation. Differences of energies lose up to 210: a slip of one rounding error, cubed, and
/// a change of the load by one.
const BITS: u32 = 320;

/// A size, and what it carries.
#[derive(Debug, Clone)]
pub struct Size {
    pub w: Real,
    pub half_width: Real,
    pub load: Real,
    pub approach: Real,
    pub shift: Real,
    pub potential: Real,
    /// K_n = dU/dN and K_t = dS/dN.
    pub normal_compliance: Real,
    pub tangential_compliance: Real,
}

/// What a size is given by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Given {
    Load,
    Approach,
    Shift,
}

pub struct Family {
    pub bits: u32,
    pub friction: Real,
    kind: Kind,
}

enum Kind {
    Flat {
        a: Real,
        length: Real,
        /// N/g and K_t/K.
        load_scale: Real,
        compliance_scale: Real,
        /// K less ln(2L/s), of U and of S.
        constants: [Real; 2],
        /// g under the load of the parameters.
        load: f64,
    },
    Ellipse {
        semi_axis: Real,
        semi_axis_y: Real,
        load: Real,
        compliances: [Real; 2],
    },
}

impl Family {
    pub fn new(input: &Input) -> Family {
        match input {
            Input::Flat(parameters) => Family::flat(parameters),
            Input::Ellipse(parameters) => Family::ellipse(parameters),
        }
    }

    fn flat(p: &Parameters) -> Family {
        let bits = BITS;
        let modulus = 1.0 / compliance_of(bits, &p.material);
        let load_scale = Real::new(bits, p.length) * &modulus / p.edge_radius / 4.0;
        let load = p.normal_force / &load_scale;
        let a = Real::new(bits, p.flat_half_width);
        let length = Real::new(bits, p.length);
        let ratio = mean(bits, &p.material, |nu| nu / (1.0 - nu));
        let mut constants = [Real::new(bits, 0.0), ratio];
        if p.displacement_reference != CENTRE_POINT {
            let w = size_of_load(&a, &load, Some(&Real::new(bits, 1.0))).0;
            let half_width = (a.square() + w.square()).sqrt();
            let along = 1.0 - Real::new(bits, 2.0).ln() + Real::parse(bits, "0.093");
            let across = [Real::new(bits, 1.0), mean(bits, &p.material, |nu| (1.0 - 2.0 * nu) / (1.0 - nu))];
            let share = 8.0 / Real::pi(bits).square() * half_width / &length;
            constants = [0, 1].map(|i: usize| &constants[i] - &along + &across[i] * &share);
        }
        let compliance_scale = 2.0 / (Real::pi(bits) * &modulus * &length);
        let load = load.f64();
        let kind = Kind::Flat { a, length, load_scale, compliance_scale, constants, load };
        Family { bits, friction: Real::new(bits, p.friction_coefficient), kind }
    }

    fn ellipse(p: &EllipticParameters) -> Family {
        let bits = BITS;
        let [b, l] = [p.semi_axis_x, p.semi_axis_y].map(|axis| Real::new(bits, axis));
        let (all, cosine) = cerruti(&b, &l);
        let sum = |term: &dyn Fn(&Real) -> Real| {
            p.material.iter().fold(Real::new(bits, 0.0), |sum, body| {
                let nu = Real::new(bits, body.poisson_ratio);
                sum + (1.0 + &nu) / (Real::pi(bits) * body.young_modulus) * term(&nu)
            })
        };
        let compliances = [sum(&|nu| (1.0 - nu) * &all), sum(&|nu| (1.0 - nu) * &all + nu * &cosine)];
        let kind = Kind::Ellipse { semi_axis: b, semi_axis_y: l, load: Real::new(bits, p.normal_force), compliances };
        Family { bits, friction: Real::new(bits, p.friction_coefficient), kind }
    }

    pub fn real(&self, value: f64) -> Real {
        Real::new(self.bits, value)
    }

    /// The size of w.
    pub fn size(&self, w: &Real) -> Size {
        match &self.kind {
            Kind::Flat { a, length, load_scale, compliance_scale, constants, .. } => {
                let bits = self.bits + spare(a, w);
                let (a, w) = (&a.at(bits), &w.at(bits));
                let psi = angle(a, w);
                let half_width = (a.square() + w.square()).sqrt();
                let g = load(a, w, &psi);
                let logarithm = (2.0 * length / &half_width).ln();
                let [normal, tangential] = constants.each_ref().map(|constant| &logarithm + constant);
                let first = b_sum(a, w, &psi);
                let second = if a.is_zero() { g.square() / 4.0 } else { c_sum(a, w, &g, &(a / &half_width).ln()) };
                let [normal, tangential] = [normal, tangential].map(|compliance| compliance_scale * compliance);
                let potential = load_scale.square() / 2.0 * (g.square() * &tangential + compliance_scale * second);
                Size {
                    load: load_scale * &g,
                    approach: load_scale * (&g * &normal + compliance_scale * &first),
                    shift: load_scale * (&g * &tangential + compliance_scale * first),
                    potential,
                    normal_compliance: normal,
                    tangential_compliance: tangential,
                    half_width,
                    w: w.clone(),
                }
                .at(self.bits)
            }
            Kind::Ellipse { semi_axis, load, compliances: [normal, tangential], .. } => {
                let ratio = w / semi_axis;
                let square = ratio.square();
                let load = load * &square * &ratio;
                let shift = 1.5 * tangential * &load / &ratio;
                Size {
                    approach: 1.5 * normal * &load / &ratio,
                    potential: 2.0 * &load * &shift / 5.0,
                    load,
                    shift,
                    normal_compliance: normal / &ratio,
                    tangential_compliance: tangential / &ratio,
                    half_width: w.clone(),
                    w: w.clone(),
                }
            }
        }
    }

    /// Pressure \[Pa\] of a size at |x| (of an ellipse on the x axis).
    pub fn pressure(&self, size: &Size, x: &Real) -> Real {
        if size.half_width <= *x {
            return self.real(0.0);
        }
        match &self.kind {
            // Eq. 17, as that of the constant load.
            Kind::Flat { a, length, load_scale, .. } => {
                let bits = self.bits + spare(a, &size.w);
                let (a, w) = (&a.at(bits), &size.w.at(bits));
                let unit = 4.0 / Real::pi(self.bits) * load_scale / length;
                unit * punch_pressure(a, w, &angle(a, w), x)
            }
            Kind::Ellipse { semi_axis, semi_axis_y, load, .. } => {
                let height = (size.half_width.square() - x.square()).sqrt();
                3.0 * load / (2.0 * Real::pi(self.bits) * semi_axis.square() * semi_axis_y) * height
            }
        }
    }

    /// d²N/dS², the growth of the stiffness 1/K_t with S.
    pub fn curvature(&self, size: &Size) -> Real {
        let cubed = size.tangential_compliance.square() * &size.tangential_compliance;
        match &self.kind {
            Kind::Flat { a, load_scale, compliance_scale, .. } => {
                let rate = 4.0 * size.half_width.square() * angle(a, &size.w) * load_scale;
                compliance_scale / rate / cubed
            }
            Kind::Ellipse { .. } => &size.tangential_compliance / (3.0 * &size.load) / cubed,
        }
    }

    /// K = ln(2L/s) less its constant, of the approach and of the shift; 1 for an ellipse. The logarithm is known to rounding only, in
    /// absolute terms.
    pub fn log_compliances(&self, size: &Size) -> [f64; 2] {
        match &self.kind {
            Kind::Flat { compliance_scale, .. } => {
                [&size.normal_compliance, &size.tangential_compliance].map(|k| (k / compliance_scale).f64())
            }
            Kind::Ellipse { .. } => [1.0, 1.0],
        }
    }

    /// The size of a positive load, approach or shift: Newton's iteration.
    pub fn find(&self, given: Given, value: &Real) -> Size {
        let (a, length, load_scale, compliance_scale, constants, reference) = match &self.kind {
            Kind::Flat { a, length, load_scale, compliance_scale, constants, load } => {
                (a, length, load_scale, compliance_scale, constants, *load)
            }
            Kind::Ellipse { semi_axis, load, compliances: [normal, tangential], .. } => {
                let ratio = match given {
                    Given::Load => (value / load).cbrt(),
                    Given::Approach => (value / (1.5 * normal * load)).sqrt(),
                    Given::Shift => (value / (1.5 * tangential * load)).sqrt(),
                };
                return self.size(&(semi_axis * ratio));
            }
        };
        let constant = match given {
            Given::Load => None,
            Given::Approach => Some(&constants[0]),
            Given::Shift => Some(&constants[1]),
        };
        let scaled = match constant {
            None => value / load_scale,
            Some(_) => value / (load_scale * compliance_scale),
        };
        let guess = match constant {
            None => scaled.f64(),
            Some(constant) => load_guess(a.f64(), length.f64(), constant.f64(), reference, scaled.f64()),
        };
        // Lengths over the size of the load keep its powers representable.
        let unit = a + self.real(guess).sqrt();
        let mut w = self.real(w_guess((a / &unit).f64(), (self.real(guess) / unit.square()).f64())) * unit;
        for _ in 0..200 {
            let bits = self.bits + spare(a, &w) / 2;
            let (a, long) = (&a.at(bits), &w.at(bits));
            let psi = angle(a, long);
            let mut found = load(a, long, &psi);
            let mut slope = 4.0 * long * &psi;
            if let Some(constant) = constant {
                let half_width = (a.square() + long.square()).sqrt();
                let compliance = (2.0 * length / half_width).ln() + constant;
                found = found * &compliance + b_sum(a, long, &psi);
                slope = slope * compliance;
            }
            let step = ((&scaled - found) / slope).at(self.bits);
            let next = &w + &step;
            let relative = step.exponent() - w.exponent();
            w = if next.is_positive() { next } else { w / 4.0 };
            if 2 * relative < -(self.bits as i32) {
                return self.size(&w);
            }
        }
        panic!("no size of {given:?} {:e}", value.f64());
    }
}

impl Size {
    fn of(
        [w, half_width, load, approach, shift, potential, normal_compliance, tangential_compliance]: [Real; 8],
    ) -> Size {
        Size { w, half_width, load, approach, shift, potential, normal_compliance, tangential_compliance }
    }

    /// The size of zero load.
    pub fn zero(bits: u32) -> Size {
        Size::of([(); 8].map(|()| Real::new(bits, 0.0)))
    }

    /// Rounded to another precision.
    fn at(&self, bits: u32) -> Size {
        let Size { w, half_width, load, approach, shift, potential, normal_compliance, tangential_compliance } = self;
        let [normal, tangential] = [normal_compliance, tangential_compliance];
        Size::of([w, half_width, load, approach, shift, potential, normal, tangential].map(|value| value.at(bits)))
    }
}

/// Bits that M loses to cancellation; N, U and S lose half as many.
fn spare(a: &Real, w: &Real) -> u32 {
    if w.is_zero() { 0 } else { 8 * flatness(a, w) as u32 }
}

fn angle(a: &Real, w: &Real) -> Real {
    if a.is_zero() { Real::pi(w.bits()) / 2.0 } else { w.atan2(a) }
}

/// g of `g (ln(2L/s) + constant + B/g) = value` in doubles: Newton's iteration from below, where it is monotone.
fn load_guess(a: f64, length: f64, constant: f64, reference: f64, value: f64) -> f64 {
    let unit = a + reference.sqrt();
    let (a, length, value) = (a / unit, length / unit, value / unit / unit);
    let mut g = value / (1.0 + (2.0 * length).ln().max(0.0) + constant.abs() + (1.0 / value).ln().max(0.0));
    for _ in 0..100 {
        let w = w_guess(a, g);
        let (psi, half_width) = (w.atan2(a), (a * a + w * w).sqrt());
        let compliance = (2.0 * length / half_width).ln() + constant;
        let step = (value - g * (compliance + beta(a, w, psi))) / compliance;
        if compliance <= 0.0 {
            g *= 0.5;
            continue;
        }
        g = (g + step).max(0.25 * g);
        if step.abs() < 1e-12 * g {
            break;
        }
    }
    g * unit * unit
}
