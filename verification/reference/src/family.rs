//! The nested sizes of a contact in absolute terms: N, U, S and M = ∫ N dS of a size, and their inverses.
//!
//! A size of half-width s has w² = s² - a², ψ = atan(w/a), and under a flat with rounded edges the load N = E* L/(4R) g with
//! g = 2 (a² + w²) ψ - 2 a w. A layer in series adds `c N_c ln(1 + N/N_c)` to U and S, c its compliance without load.

use crate::{Input, Real};
use microslip::parameters::{CENTRE_POINT, Layer};
use microslip::{EllipticParameters, Material, Parameters};

/// Bits of the functions of a size after cancellation. Differences of energies lose up to 210: a slip of one rounding error, cubed,
/// and a change of the load by one.
const BITS: u32 = 320;

/// Changes of the parameters N, mu, a, R, L and E*: factors, but of a, to which a length is added.
pub type Change = [Real; 6];
pub const ADDED: usize = 2;

pub fn unchanged(bits: u32) -> Change {
    [1.0, 1.0, 0.0, 1.0, 1.0, 1.0].map(|value| Real::new(bits, value))
}

/// A size, and what it carries.
#[derive(Debug, Clone)]
pub struct Size {
    pub w: Real,
    pub half_width: Real,
    pub load: Real,
    pub approach: Real,
    pub shift: Real,
    pub potential: Real,
    /// K_n = dU/dN and K_t = dS/dN; infinite for the size of no load of a cylinder or an ellipse.
    pub normal_compliance: Real,
    pub tangential_compliance: Real,
    /// -dK_t/dN, and dN/dw.
    pub stiffening: Real,
    pub rate: Real,
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
    pub composite_modulus: Real,
    /// N of the parameters.
    pub load: Real,
    kind: Kind,
    /// Compliances without load, of U and S, and N_c.
    layer: Option<([Real; 2], Real)>,
}

enum Kind {
    Flat {
        a: Real,
        length: Real,
        /// a, or 2L of a cylinder.
        unit: Real,
        /// N/g and K_t/K.
        load_scale: Real,
        compliance_scale: Real,
        /// K less ln(unit/s), of U and of S.
        constants: [Real; 2],
    },
    Ellipse {
        semi_axes: [Real; 2],
        compliances: [Real; 2],
    },
}

/// (1 - ν²)/E of each body.
fn compliances(bits: u32, material: &[Material; 2]) -> [Real; 2] {
    material.each_ref().map(|body| (1.0 - Real::new(bits, body.poisson_ratio).square()) / body.young_modulus)
}

/// E*.
fn modulus_of(bits: u32, material: &[Material; 2]) -> Real {
    let [one, two] = compliances(bits, material);
    1.0 / (one + two)
}

/// Mean over both bodies, weighted by their compliances.
fn mean(bits: u32, material: &[Material; 2], function: impl Fn(&Real) -> Real) -> Real {
    let [one, two] = compliances(bits, material);
    let [f, g] = material.each_ref().map(|body| function(&Real::new(bits, body.poisson_ratio)));
    (&one * f + &two * g) / (one + two)
}

impl Family {
    pub fn new(input: &Input) -> Family {
        Family::changed(input, &unchanged(BITS))
    }

    /// The family of changed parameters. The bodies of an ellipse keep their shapes, but for a common factor R of their radii.
    pub fn changed(input: &Input, change: &Change) -> Family {
        match input {
            Input::Flat(parameters) => Family::flat(parameters, change),
            Input::Ellipse(parameters) => Family::ellipse(parameters, change),
        }
    }

    fn flat(p: &Parameters, [by_load, by_friction, added_flat, by_radius, by_length, by_modulus]: &Change) -> Family {
        let bits = by_load.bits();
        let composite_modulus = by_modulus * modulus_of(bits, &p.material);
        let length = by_length * p.length;
        let (a, twice) = (added_flat + p.flat_half_width, 2.0 * &length);
        let unit = if a.is_zero() { twice.clone() } else { a.clone() };
        let normal = (twice / &unit).ln();
        let constants = [normal.clone(), normal + mean(bits, &p.material, |nu| nu / (1.0 - nu))];
        let mut family = Family {
            bits,
            friction: by_friction * p.friction_coefficient,
            load: by_load * p.normal_force,
            kind: Kind::Flat {
                a,
                unit,
                load_scale: &length * &composite_modulus / p.edge_radius / by_radius / 4.0,
                compliance_scale: 2.0 / (Real::pi(bits) * &composite_modulus * &length),
                constants,
                length,
            },
            composite_modulus,
            layer: layer_of(bits, &p.layer, p.normal_force),
        };
        if p.displacement_reference != CENTRE_POINT {
            let half_width = family.find(Given::Load, &family.load).half_width;
            if let Kind::Flat { constants, length, .. } = &mut family.kind {
                let along = 1.0 - Real::new(bits, 2.0).ln() + Real::parse(bits, "0.093");
                let across = [Real::new(bits, 1.0), mean(bits, &p.material, |nu| (1.0 - 2.0 * nu) / (1.0 - nu))];
                let share = 8.0 / Real::pi(bits).square() * half_width / &*length;
                *constants = [0, 1].map(|i: usize| &constants[i] - &along + &across[i] * &share);
            }
        }
        family
    }

    fn ellipse(p: &EllipticParameters, [by_load, by_friction, _, by_radius, _, by_modulus]: &Change) -> Family {
        let bits = by_load.bits();
        let by_size = (by_load * by_radius / by_modulus).cbrt();
        let semi_axes = [p.semi_axis_x, p.semi_axis_y].map(|axis| &by_size * axis);
        let (all, cosine) = cerruti(&semi_axes[0], &semi_axes[1]);
        let sum = |term: &dyn Fn(&Real) -> Real| {
            p.material.iter().fold(Real::new(bits, 0.0), |sum, body| {
                let nu = Real::new(bits, body.poisson_ratio);
                sum + (1.0 + &nu) / (Real::pi(bits) * body.young_modulus * by_modulus) * term(&nu)
            })
        };
        let compliances = [sum(&|nu| (1.0 - nu) * &all), sum(&|nu| (1.0 - nu) * &all + nu * &cosine)];
        Family {
            bits,
            friction: by_friction * p.friction_coefficient,
            load: by_load * p.normal_force,
            composite_modulus: by_modulus * modulus_of(bits, &p.material),
            kind: Kind::Ellipse { semi_axes, compliances },
            layer: layer_of(bits, &p.layer, p.normal_force),
        }
    }

    pub fn real(&self, value: f64) -> Real {
        Real::new(self.bits, value)
    }

    /// Bits that the energy of a cycle of a size loses: that of a nearly flat contact is small.
    pub fn lost(&self, size: &Size) -> i32 {
        if let Kind::Flat { a, .. } = &self.kind { 4 * flatness(a, &size.w) as i32 } else { 0 }
    }

    /// The unit of compliances: that of K, for an ellipse K_t of the size of the parameters.
    pub fn compliance_unit(&self) -> &Real {
        match &self.kind {
            Kind::Flat { compliance_scale, .. } => compliance_scale,
            Kind::Ellipse { compliances: [_, tangential], .. } => tangential,
        }
    }

    /// N/(bL), for an ellipse N/(b l).
    pub fn pressure_unit(&self, half_width: &Real) -> Real {
        let (Kind::Flat { length, .. } | Kind::Ellipse { semi_axes: [_, length], .. }) = &self.kind;
        &self.load / half_width / length
    }

    /// The size of w.
    pub fn size(&self, w: &Real) -> Size {
        let size = match &self.kind {
            Kind::Flat { a, unit, load_scale, compliance_scale, constants, .. } => {
                let bits = self.bits + spare(a, w);
                let (a, w) = (&a.at(bits), &w.at(bits));
                let half_width = (a.square() + w.square()).sqrt();
                let psi = angle(a, w);
                let g = load(a, w, &psi);
                let ln_unit_over_s = (unit / &half_width).ln();
                let [normal, tangential] = constants.each_ref().map(|constant| &ln_unit_over_s + constant);
                let first = b_sum(a, w, &psi);
                let second =
                    if a.is_zero() || w.is_zero() { g.square() / 4.0 } else { c_sum(a, w, &g, &ln_unit_over_s) };
                // Without load an infinite K carries nothing.
                let carried = |compliance: &Real| if g.is_zero() { 0.0 * &g } else { &g * compliance };
                let [approach, shift] =
                    [&normal, &tangential].map(|k| load_scale * compliance_scale * (carried(k) + &first));
                let [normal_compliance, tangential_compliance] = [normal, tangential].map(|k| compliance_scale * k);
                let potential = carried(&(&g * &tangential_compliance)) + compliance_scale * second;
                Size {
                    load: load_scale * &g,
                    approach,
                    shift,
                    potential: load_scale.square() / 2.0 * potential,
                    normal_compliance,
                    tangential_compliance,
                    stiffening: compliance_scale / (4.0 * half_width.square() * &psi * load_scale),
                    rate: 4.0 * w * psi * load_scale,
                    half_width,
                    w: w.clone(),
                }
            }
            Kind::Ellipse { semi_axes: [semi_axis, _], compliances: [normal, tangential] } => {
                let ratio = w / semi_axis;
                let square = ratio.square();
                let load = &self.load * &square * &ratio;
                let [approach, shift] = [normal, tangential].map(|compliance| 1.5 * compliance * &self.load * &square);
                Size {
                    potential: 2.0 * &load * &shift / 5.0,
                    approach,
                    shift,
                    normal_compliance: normal / &ratio,
                    tangential_compliance: tangential / &ratio,
                    stiffening: tangential / (3.0 * &load * &ratio),
                    rate: 3.0 * &self.load * square / semi_axis,
                    load,
                    half_width: w.clone(),
                    w: w.clone(),
                }
            }
        };
        self.with_layer(size)
    }

    fn with_layer(&self, size: Size) -> Size {
        let Some(([normal, tangential], knee)) = &self.layer else { return size };
        // M is a difference of both terms.
        let lost = (knee.exponent() - size.load.exponent()).clamp(0, 1 << 16) as u32;
        let load = size.load.at(size.load.bits() + lost);
        let (extent, slope, bend, work) = if knee.f64().is_infinite() {
            (load.clone(), self.real(1.0), self.real(0.0), load.square() / 2.0)
        } else {
            let (extent, slope) = (knee * (&load / knee).ln_1p(), knee / (knee + &load));
            let work = knee * (load - &extent);
            (extent, slope.clone(), slope.square() / knee, work)
        };
        Size {
            approach: size.approach + normal * &extent,
            shift: size.shift + tangential * extent,
            potential: size.potential + tangential * work,
            normal_compliance: size.normal_compliance + normal * &slope,
            tangential_compliance: size.tangential_compliance + tangential * slope,
            stiffening: size.stiffening + tangential * bend,
            ..size
        }
    }

    /// Pressure \[Pa\] of a size at |x| (of an ellipse on the x axis).
    pub fn pressure(&self, size: &Size, x: &Real) -> Real {
        if size.half_width <= *x {
            return self.real(0.0);
        }
        match &self.kind {
            Kind::Flat { a, length, load_scale, .. } => {
                let bits = self.bits + spare(a, &size.w);
                let (a, w) = (&a.at(bits), &size.w.at(bits));
                4.0 / Real::pi(self.bits) * load_scale / length * punch_pressure(a, w, &angle(a, w), x)
            }
            Kind::Ellipse { semi_axes: [b, l], .. } => {
                let height = (size.half_width.square() - x.square()).sqrt();
                3.0 * &self.load / (2.0 * Real::pi(self.bits) * b.square() * l) * height
            }
        }
    }

    /// Slip at x (Eq. 15) over mu, of the stick zone of a size in a contact that sticks nowhere else; beyond the contact its
    /// continuation.
    pub fn slip(&self, size: &Size, x: &Real) -> Real {
        let Kind::Flat { a, load_scale, compliance_scale, .. } = &self.kind else { panic!("no slip of an ellipse") };
        let (w, psi) = (&size.w, angle(a, &size.w));
        let xi2 = x.square() - size.half_width.square();
        if !xi2.is_positive() {
            return self.real(0.0);
        }
        let xi = xi2.sqrt();
        let mut sum = x * psi * &xi + (x.square() + a.square()) * (a * &xi).atan2(&(x * w)) - 2.0 * a * x * xi.atan2(w);
        if !size.load.is_zero() {
            sum = sum - &size.load / load_scale / 2.0 * (x / &size.half_width).acosh();
        }
        2.0 * sum * load_scale * compliance_scale
    }

    /// d²N/dS², the growth of the stiffness 1/K_t with S.
    pub fn curvature(&self, size: &Size) -> Real {
        &size.stiffening / (size.tangential_compliance.square() * &size.tangential_compliance)
    }

    /// K = ln(2L/s) less its constant, of the approach and of the shift; 1 for an ellipse. The logarithm is known to rounding only,
    /// in absolute terms.
    pub fn log_compliances(&self, size: &Size) -> [f64; 2] {
        match &self.kind {
            Kind::Flat { compliance_scale, .. } => {
                [&size.normal_compliance, &size.tangential_compliance].map(|k| (k / compliance_scale).f64())
            }
            Kind::Ellipse { .. } => [1.0, 1.0],
        }
    }

    /// The size of a positive load, approach or shift: Newton's iteration of logarithms, which are concave functions of ln w.
    pub fn find(&self, given: Given, value: &Real) -> Size {
        let mut size = self.size(&self.guess(given, value));
        for _ in 0..400 {
            let (found, compliance) = match given {
                Given::Load => (&size.load, self.real(1.0)),
                Given::Approach => (&size.approach, size.normal_compliance.clone()),
                Given::Shift => (&size.shift, size.tangential_compliance.clone()),
            };
            let slope = compliance * &size.rate * &size.w;
            if !slope.is_positive() {
                size = self.size(&(size.w / 2.0));
                continue;
            }
            let mut step = (value - found) / &slope;
            if step.abs().f64() < 1e-6 {
                size = self.size(&(&size.w * (1.0 + &step)));
            } else {
                step = ((value / found).ln() * found / slope).max(&self.real(-1.0));
                size = self.size(&(&size.w * step.exp()));
            }
            if 2 * step.exponent() < -(self.bits as i32) {
                return size;
            }
        }
        panic!("no size of {given:?} {:e}", value.f64());
    }

    /// A first w, of the right size: that of a compliance K = 1 by the larger one of the asymptotes g = πw² and g = 4w³/(3a).
    fn guess(&self, given: Given, value: &Real) -> Real {
        match &self.kind {
            Kind::Flat { a, load_scale, compliance_scale, .. } => {
                let g = value / load_scale;
                let g = if given == Given::Load { g } else { g / compliance_scale };
                (&g / Real::pi(self.bits)).sqrt().max(&(0.75 * a * g).cbrt())
            }
            Kind::Ellipse { semi_axes: [semi_axis, _], .. } => semi_axis.clone(),
        }
    }
}

/// The layer of parameters for a load.
fn layer_of(bits: u32, layer: &Layer, load: f64) -> Option<([Real; 2], Real)> {
    let compliances = [layer.normal_compliance, layer.tangential_compliance];
    let reference = if layer.reference_load > 0.0 { layer.reference_load } else { load };
    let knee = Real::new(bits, if layer.stiffening_load > 0.0 { layer.stiffening_load } else { f64::INFINITY });
    let unloaded = compliances.map(|compliance| compliance * (1.0 + reference / &knee));
    (compliances != [0.0; 2]).then_some((unloaded, knee))
}

/// Bits that M loses to cancellation: eight for each one by which w is below a. N, U and S lose half as many.
fn spare(a: &Real, w: &Real) -> u32 {
    8 * flatness(a, w)
}

/// Bits by which w is below a.
fn flatness(a: &Real, w: &Real) -> u32 {
    if a.is_zero() || w.is_zero() { 0 } else { (a.exponent() - w.exponent()).max(0) as u32 }
}

fn angle(a: &Real, w: &Real) -> Real {
    if a.is_zero() { Real::pi(w.bits()) / 2.0 } else { w.atan2(a) }
}

/// The load g(w) rounded to a double: 4RP/E* of a contact of half-width √(a² + w²).
pub fn load_of_size(a: f64, w: f64) -> f64 {
    let lost = 4.0 * (a / w).max(1.0).log2();
    let [a, w] = [a, w].map(|length| Real::new(128 + lost as u32, length));
    load(&a, &w, &w.atan2(&a)).f64()
}

/// The pressure of Eq. 17 at x, with sin φ = x/c, sin φ0 = a/c; the quotients of both logarithms meet in |x² - a²|.
fn punch_pressure(a: &Real, w: &Real, psi: &Real, x: &Real) -> Real {
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
fn load(a: &Real, w: &Real, psi: &Real) -> Real {
    2.0 * (a.square() + w.square()) * psi - 2.0 * a * w
}

/// B = (w² + 3a²) ψ - 3 a w = ∫ g dc/c.
fn b_sum(a: &Real, w: &Real, psi: &Real) -> Real {
    (w.square() + 3.0 * a.square()) * psi - 3.0 * a * w
}

/// C = ∫ g² dc/c, with ln(a/c).
fn c_sum(a: &Real, w: &Real, g: &Real, ln_a_over_c: &Real) -> Real {
    let (a2, w2) = (a.square(), w.square());
    let c2 = &a2 + &w2;
    let a4 = a2.square();
    let second = 2.0 * a * g * w2 * w / (3.0 * &c2);
    let third = 4.0 * (&a2 * &c2 - &a4 * &a2 / &c2) + 16.0 * a4 * ln_a_over_c;
    g.square() / 4.0 - second + third / 3.0
}

/// J = ∫ dθ/W and J_cos = ∫ cos²θ dθ/W, W² = l² cos²θ + b² sin²θ, θ from 0 to π/2, from K and E by the
/// arithmetic-geometric mean.
fn cerruti(b: &Real, l: &Real) -> (Real, Real) {
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
