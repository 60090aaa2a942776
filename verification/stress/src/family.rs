//! The family of contact sizes, written down anew and without the library: a rounded flat of half-width c carries
//! `P(c) = E*/(4R) ∫ 4 w ψ dw` with `w² = c² - a²` and `ψ = atan(w/a)`, and each increment of load dP spreads over a flat punch of
//! half-width c, whose compliance is `(2/(π E*)) (ln(2L/c) + ν/(1-ν))`. Integrands are positive and quadrature adds them
//! up, so nothing cancels however flat the contact is.

use microslip::parameters::CENTRE_POINT;
use microslip::{Material, Parameters};
use quadrature::clenshaw_curtis::integrate;
use std::f64::consts::{LN_2, PI};

/// 1/E* = Σ (1 - ν²)/E.
pub fn composite_modulus(material: &[Material; 2]) -> f64 {
    1.0 / material.iter().map(|body| (1.0 - body.poisson_ratio.powi(2)) / body.young_modulus).sum::<f64>()
}

/// The load of a size over E*/(4R): ∫ 4 w ψ dw, in closed form where that loses no more than a bit.
pub fn load(flat: f64, w: f64) -> f64 {
    if w > flat {
        return 2.0 * (flat * flat + w * w) * w.atan2(flat) - 2.0 * flat * w;
    }
    w * w * integrate(|x| 4.0 * x * (w * x).atan2(flat), 0.0, 1.0, 1e-16).integral
}

/// A point of the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub struct CurvePoint {
    pub displacement: f64,
    pub force: f64,
}

/// Points of the monotonic curve from rest to gross slip, the stick zone shrinking from one to the next. Their number, less one,
/// divides the curve so finely that chords err by about 1/(4 Λ n²) of mu N: x = w/w_b falls as a cosine, so that steps are small
/// where the compliance of a short contact grows from next to nothing.
pub fn flat_curve(parameters: &Parameters, pieces: usize) -> Vec<CurvePoint> {
    let modulus = composite_modulus(&parameters.material);
    let flat = parameters.flat_half_width;
    let target = 4.0 * parameters.edge_radius * (parameters.normal_force / parameters.length) / modulus;
    let w_b = half_width(flat, target);
    let b2 = flat * flat + w_b * w_b;
    // Each body by itself: for unlike ones E* weighs their Poisson's ratios.
    let mean = |of: &dyn Fn(f64) -> f64| {
        let share = |body: &Material| (1.0 - body.poisson_ratio.powi(2)) / body.young_modulus;
        parameters.material.iter().map(|body| share(body) * of(body.poisson_ratio)).sum::<f64>() * modulus
    };
    let mut full_stick = (2.0 * parameters.length / b2.sqrt()).ln() + mean(&|nu| nu / (1.0 - nu));
    if parameters.displacement_reference != CENTRE_POINT {
        let across = 8.0 / (PI * PI) * mean(&|nu| (1.0 - 2.0 * nu) / (1.0 - nu)) * b2.sqrt() / parameters.length;
        full_stick -= (1.0 - LN_2) + 0.093 - across;
    }
    let rate = |x: f64| 4.0 * x * (w_b * x).atan2(flat) * w_b * w_b / target;
    // ln(b/c), from what b² has above c².
    let compliance = |x: f64| {
        let c2 = flat * flat + (w_b * x).powi(2);
        full_stick + 0.5 * (w_b * w_b * (1.0 - x) * (1.0 + x) / c2.max(f64::MIN_POSITIVE)).ln_1p()
    };
    let limit = parameters.friction_coefficient * parameters.normal_force;
    let unit = 2.0 * limit / (PI * modulus * parameters.length);
    let place = |k: usize| (0.5 * PI * (1.0 - k as f64 / pieces as f64)).sin();
    let mut point = CurvePoint { displacement: 0.0, force: 0.0 };
    let mut curve = vec![point];
    for k in 1..=pieces {
        let (from, to) = (place(k), place(k - 1));
        // A hundredth of a unit of rounding is as good as nothing.
        let nothing = 1e-18 * rate(to) * (to - from);
        let force = integrate(rate, from, to, nothing).integral;
        let displacement = integrate(|x| rate(x) * compliance(x), from, to, nothing * full_stick).integral;
        point =
            CurvePoint { displacement: point.displacement + unit * displacement, force: point.force + limit * force };
        curve.push(point);
    }
    curve
}

/// w_b, by bisection of the load in the logarithm.
fn half_width(flat: f64, target: f64) -> f64 {
    let (mut low, mut high) = (0.0, (target / PI).sqrt().max((target * flat).cbrt()) * 2.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if load(flat, middle) < target { low = middle } else { high = middle }
    }
}

/// The curve of Hertz' ellipse, `x/x_s = 1 - σ²` and `τ = 1 - σ³`, from its first stiffness.
pub fn elliptic_curve(limit: f64, stiffness: f64, pieces: usize) -> Vec<CurvePoint> {
    let slip = 1.5 * limit / stiffness;
    (0..=pieces)
        .map(|k| {
            let done = k as f64 / pieces as f64;
            let size = 1.0 - done;
            CurvePoint { displacement: slip * done * (1.0 + size), force: limit * done * (1.0 + size * (1.0 + size)) }
        })
        .collect()
}
