//! The nested sizes of a contact in absolute terms: N, U, S and M = ∫ N dS of a size, and their inverses.

use crate::law::Change;
use crate::{Input, Real};
use microslip::parameters::CENTRE_POINT;
use microslip::{EllipticParameters, Layer, Material, Parameters};
use std::f64::consts::PI;

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
    pub composite_modulus: Real,
    /// N of the parameters.
    pub load: Real,
    kind: Kind,
    layer: Option<Rough>,
}

/// A layer in series along the force: its compliance under no load, and N_c unless it is infinite.
struct Rough {
    compliance: Real,
    stiffening: Option<Real>,
}

impl Rough {
    /// dS/dN = c N_c/(N_c + N), with the given value under the load of the parameters.
    fn new(layer: &Layer, load: &Real) -> Option<Rough> {
        let stiffening = Real::new(load.bits(), layer.stiffening_load);
        let is_linear = layer.stiffening_load == 0.0 || layer.stiffening_load.is_infinite();
        let factor = if is_linear { Real::new(load.bits(), 1.0) } else { 1.0 + load / &stiffening };
        let compliance = factor * layer.tangential_compliance;
        compliance.is_positive().then(|| Rough { compliance, stiffening: (!is_linear).then_some(stiffening) })
    }

    /// S, M = ∫ N dS and dS/dN under a load.
    fn at(&self, load: &Real) -> [Real; 3] {
        let c = &self.compliance;
        let stiffening = match &self.stiffening {
            Some(stiffening) if load.is_positive() => stiffening,
            _ => return [c * load, c * load.square() / 2.0, c.clone()],
        };
        // M loses as many bits as N is below N_c.
        let bits = load.bits() + (stiffening.exponent() - load.exponent()).clamp(0, 20_000) as u32;
        let share = load.at(bits) / stiffening;
        let logarithm = share.ln_1p();
        let scale = c * stiffening;
        let slope = c / (1.0 + &share);
        [&scale * &logarithm, &scale * stiffening * (share - logarithm), slope].map(|value| value.at(load.bits()))
    }

    /// -d²S/dN².
    fn curvature(&self, load: &Real) -> Real {
        match &self.stiffening {
            None => 0.0 * load,
            Some(stiffening) => &self.compliance * stiffening / (stiffening + load).square(),
        }
    }
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
        Family::changed(input, BITS, &Change::none(BITS))
    }

    /// The family of changed parameters. The bodies of an ellipse keep their shapes, but for a common factor R of their radii.
    pub fn changed(input: &Input, bits: u32, change: &Change) -> Family {
        let (Input::Flat(Parameters { normal_force, friction_coefficient, material, layer, .. })
        | Input::Ellipse(EllipticParameters { normal_force, friction_coefficient, material, layer, .. })) = input;
        let [by_load, _, _, _, by_modulus] = &change.factors;
        let modulus = by_modulus / (compliance_of(bits, &material[0]) + compliance_of(bits, &material[1]));
        let load = by_load * *normal_force;
        let kind = match input {
            Input::Flat(p) => Kind::flat(p, &load, &modulus, change),
            Input::Ellipse(p) => Kind::ellipse(p, &load, change),
        };
        let layer = Rough::new(layer, &load);
        Family { bits, friction: Real::new(bits, *friction_coefficient), composite_modulus: modulus, load, kind, layer }
    }

    pub fn real(&self, value: f64) -> Real {
        Real::new(self.bits, value)
    }

    /// The tangential compliance over its number K; of an ellipse under the load of the parameters.
    pub fn compliance_unit(&self) -> Real {
        match &self.kind {
            Kind::Flat { compliance_scale, .. } => compliance_scale.clone(),
            Kind::Ellipse { compliances: [_, tangential], .. } => tangential.clone(),
        }
    }

    /// N over the area of a size; of an ellipse that of its axes.
    pub fn mean_pressure(&self, size: &Size) -> Real {
        match &self.kind {
            Kind::Flat { length, .. } => &size.load / length / &size.half_width,
            Kind::Ellipse { semi_axis_y, .. } => &size.load / semi_axis_y / &size.half_width,
        }
    }

    /// a and g of a rounded flat, in units of the half-width of a size.
    pub fn flat(&self, size: &Size) -> Option<[Real; 2]> {
        match &self.kind {
            Kind::Flat { a, load_scale, .. } => {
                Some([a / &size.half_width, &size.load / load_scale / size.half_width.square()])
            }
            Kind::Ellipse { .. } => None,
        }
    }

    pub fn has_flat(&self) -> bool {
        matches!(&self.kind, Kind::Flat { a, .. } if !a.is_zero())
    }

    /// Bits that the energy loses under the load of the parameters: eight for each one by which w is below a.
    pub fn lost_bits(&self) -> i32 {
        match &self.kind {
            Kind::Flat { a, .. } => spare(a, &self.find(Given::Load, &self.load).w) as i32,
            Kind::Ellipse { .. } => 0,
        }
    }

    /// dN/dw.
    pub fn load_rate(&self, w: &Real) -> Real {
        match &self.kind {
            Kind::Flat { a, load_scale, .. } => 4.0 * load_scale * w * angle(a, w),
            Kind::Ellipse { semi_axis, load, .. } => 3.0 * load * (w / semi_axis).square() / semi_axis,
        }
    }

    /// The size of w.
    pub fn size(&self, w: &Real) -> Size {
        let mut size = self.without_layer(w);
        if let Some(layer) = &self.layer {
            let [shift, potential, slope] = layer.at(&size.load);
            size.shift = size.shift + shift;
            size.potential = size.potential + potential;
            size.tangential_compliance = size.tangential_compliance + slope;
        }
        size
    }

    fn without_layer(&self, w: &Real) -> Size {
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
        let of_contact = match &self.kind {
            Kind::Flat { a, load_scale, compliance_scale, .. } => {
                let rate = 4.0 * size.half_width.square() * angle(a, &size.w) * load_scale;
                compliance_scale / rate
            }
            Kind::Ellipse { semi_axis, compliances: [_, tangential], .. } => {
                tangential * semi_axis / &size.w / (3.0 * &size.load)
            }
        };
        let of_layer = self.layer.as_ref().map_or(0.0 * &size.load, |layer| layer.curvature(&size.load));
        (of_contact + of_layer) / cubed
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
        if self.layer.is_none() || given != Given::Shift {
            return self.size(&self.find_without_layer(given, value));
        }
        // Newton's iteration for a shift up to that of the parameters, between 0 and w of these.
        let whole = self.find_without_layer(Given::Load, &self.load);
        let mut w = whole.clone();
        for _ in 0..200 {
            let size = self.size(&w);
            let step = (value - &size.shift) / (&size.tangential_compliance * self.load_rate(&w));
            let (next, relative) = (&w + &step, step.exponent() - w.exponent());
            w = if !next.is_positive() {
                w / 4.0
            } else if next > whole {
                (w + &whole) / 2.0
            } else {
                next
            };
            if 2 * relative < -(self.bits as i32) {
                return self.size(&w);
            }
        }
        panic!("no size of the shift {:e}", value.f64());
    }

    /// w of a size of the contact alone.
    fn find_without_layer(&self, given: Given, value: &Real) -> Real {
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
                return semi_axis * ratio;
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
        w_of(a, &scaled, guess, self.bits, |a, w, psi| {
            let [found, slope] = [self::load(a, w, psi), 4.0 * w * psi];
            let Some(constant) = constant else { return [found, slope] };
            let half_width = (a.square() + w.square()).sqrt();
            let compliance = (2.0 * length / half_width).ln() + constant;
            [found * &compliance + b_sum(a, w, psi), slope * compliance]
        })
    }
}

impl Kind {
    fn flat(p: &Parameters, load: &Real, modulus: &Real, change: &Change) -> Kind {
        let bits = load.bits();
        let [_, _, by_radius, by_length, _] = &change.factors;
        let length = by_length * p.length;
        let load_scale = &length * modulus / (by_radius * p.edge_radius) / 4.0;
        let load = load / &load_scale;
        let a = &change.added_flat + p.flat_half_width;
        let ratio = mean(bits, &p.material, |nu| nu / (1.0 - nu));
        let mut constants = [Real::new(bits, 0.0), ratio];
        if p.displacement_reference != CENTRE_POINT {
            let w = w_of(&a, &load, load.f64(), bits, |a, w, psi| [self::load(a, w, psi), 4.0 * w * psi]);
            let half_width = (a.square() + w.square()).sqrt();
            let along = 1.0 - Real::new(bits, 2.0).ln() + Real::parse(bits, "0.093");
            let across = [Real::new(bits, 1.0), mean(bits, &p.material, |nu| (1.0 - 2.0 * nu) / (1.0 - nu))];
            let share = 8.0 / Real::pi(bits).square() * half_width / &length;
            constants = [0, 1].map(|i: usize| &constants[i] - &along + &across[i] * &share);
        }
        let compliance_scale = 2.0 / (Real::pi(bits) * modulus * &length);
        Kind::Flat { a, length, load_scale, compliance_scale, constants, load: load.f64() }
    }

    fn ellipse(p: &EllipticParameters, load: &Real, change: &Change) -> Kind {
        let bits = load.bits();
        let [by_load, _, by_radius, _, by_modulus] = &change.factors;
        let by_size = (by_load * by_radius / by_modulus).cbrt();
        let [b, l] = [p.semi_axis_x, p.semi_axis_y].map(|axis| &by_size * axis);
        let (all, cosine) = cerruti(&b, &l);
        let sum = |term: &dyn Fn(&Real) -> Real| {
            p.material.iter().fold(Real::new(bits, 0.0), |sum, body| {
                let nu = Real::new(bits, body.poisson_ratio);
                sum + (1.0 + &nu) / (Real::pi(bits) * body.young_modulus * by_modulus) * term(&nu)
            })
        };
        let compliances = [sum(&|nu| (1.0 - nu) * &all), sum(&|nu| (1.0 - nu) * &all + nu * &cosine)];
        Kind::Ellipse { semi_axis: b, semi_axis_y: l, load: load.clone(), compliances }
    }
}

/// w of a value of a function of w with a derivative, whose load g is about the given one: Newton's iteration.
fn w_of(a: &Real, value: &Real, guess: f64, bits: u32, of: impl Fn(&Real, &Real, &Real) -> [Real; 2]) -> Real {
    // Lengths over the size of the load keep its powers representable.
    let guess = Real::new(bits, guess);
    let unit = a + guess.sqrt();
    let mut w = Real::new(bits, w_guess((a / &unit).f64(), (guess / unit.square()).f64())) * unit;
    for _ in 0..200 {
        let more = bits + spare(a, &w) / 2;
        let (a, long) = (&a.at(more), &w.at(more));
        let [found, slope] = of(a, long, &angle(a, long));
        let step = ((value - found) / slope).at(bits);
        let next = &w + &step;
        let relative = step.exponent() - w.exponent();
        w = if next.is_positive() { next } else { w / 4.0 };
        if 2 * relative < -(bits as i32) {
            return w;
        }
    }
    panic!("no size of {:e}", value.f64());
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

pub(crate) fn angle(a: &Real, w: &Real) -> Real {
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

/// Bits by which w is below a.
fn flatness(a: &Real, w: &Real) -> i32 {
    if a.is_zero() { 0 } else { (a.exponent() - w.exponent()).max(0) }
}

/// The load g(w) rounded to a double: 4RP/E* of a contact of half-width √(a² + w²).
pub fn load_of_size(a: f64, w: f64) -> f64 {
    let lost = 4.0 * (a / w).max(1.0).log2();
    let [a, w] = [a, w].map(|length| Real::new(128 + lost as u32, length));
    load(&a, &w, &w.atan2(&a)).f64()
}

fn compliance_of(bits: u32, body: &Material) -> Real {
    let nu = Real::new(bits, body.poisson_ratio);
    (1.0 - nu.square()) / body.young_modulus
}

/// Mean over both bodies, weighted by their compliances.
fn mean(bits: u32, material: &[Material; 2], function: impl Fn(&Real) -> Real) -> Real {
    let [one, two] = material.each_ref().map(|body| compliance_of(bits, body));
    let [f, g] = material.each_ref().map(|body| function(&Real::new(bits, body.poisson_ratio)));
    (&one * f + &two * g) / (one + two)
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

/// B/g in doubles.
fn beta(a: f64, w: f64, psi: f64) -> f64 {
    if psi < 0.05 {
        return psi * psi / 5.0;
    }
    ((w * w + 3.0 * a * a) * psi - 3.0 * a * w) / (2.0 * (a * a + w * w) * psi - 2.0 * a * w)
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

/// w of a load, in doubles.
fn w_guess(a: f64, load: f64) -> f64 {
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
