//! Complex stiffness: the reference by quadrature, and for very many amplitudes of one contact by Chebyshev interpolants of that.
//! The equivalent spring-slider, and the event-driven harmonic force of one harmonic.

use crate::bounds::find;
use crate::call;
use crate::curve::{half_share, share_of_slip};
use crate::sampler::{Case, Sampler, text};
use crate::tally::Tally;
use microslip::ffi::MSLIP_EVENT_DRIVEN;
use reference::Real;
use reference::law::bits_for;
use reference::quadrature::Quadrature;
use reference::stiffness::{cycle_energy, imaginary_part, real_part};

struct Piece {
    low: f64,
    high: f64,
    coefficients: Vec<Real>,
}

const TERMS: usize = 36;

impl Piece {
    /// Appends pieces of an interval, halved until the last terms are below 23 digits.
    fn cover(low: f64, high: f64, bits: u32, f: &dyn Fn(&Real) -> Real, pieces: &mut Vec<Piece>) {
        let (centre, half) = ((Real::new(bits, low) + high) / 2.0, (Real::new(bits, high) - low) / 2.0);
        let cosines: Vec<Real> =
            (0..4 * TERMS).map(|i| (Real::pi(bits) * i as f64 / (2.0 * TERMS as f64)).sin_cos().1).collect();
        let values: Vec<Real> = (0..TERMS).map(|k| f(&(&centre + &half * &cosines[2 * k + 1]))).collect();
        let coefficients: Vec<Real> = (0..TERMS)
            .map(|j| {
                let sum = values.iter().enumerate().fold(Real::new(bits, 0.0), |sum, (k, value)| {
                    sum + value * &cosines[(2 * k + 1) * j % (4 * TERMS)]
                });
                sum * (if j == 0 { 1.0 } else { 2.0 }) / TERMS as f64
            })
            .collect();
        let size = |c: &[Real]| c.iter().map(|c| c.abs().f64()).fold(0.0, f64::max);
        if size(&coefficients[TERMS - 3..]) > 1e-23 * size(&coefficients) && high - low > 1e-3 * high {
            let middle = 0.5 * (low + high);
            Piece::cover(low, middle, bits, f, pieces);
            Piece::cover(middle, high, bits, f, pieces);
        } else {
            pieces.push(Piece { low, high, coefficients });
        }
    }

    /// Value and derivative.
    fn at(&self, x: &Real) -> (Real, Real) {
        let bits = x.bits();
        let scale = 2.0 / (Real::new(bits, self.high) - self.low);
        let z = (x - self.low) * &scale - 1.0;
        let twice = 2.0 * &z;
        let zero = || Real::new(bits, 0.0);
        // Clenshaw for the sum and for its derivative.
        let (mut b1, mut b2, mut d1, mut d2) = (zero(), zero(), zero(), zero());
        for c in self.coefficients.iter().skip(1).rev() {
            let d = &twice * &d1 - d2 + 2.0 * &b1;
            let b = &twice * &b1 - b2 + c;
            (d2, d1, b2, b1) = (d1, d, b1, b);
        }
        (&z * &b1 - b2 + &self.coefficients[0], (&z * d1 - d2 + b1) * scale)
    }
}

/// K' of one contact over all amplitudes.
pub struct Amplitudes {
    pub case: Case,
    half: f64,
    slip: f64,
    /// Over the amplitude up to twice that of gross slip, then over its inverse; none for few amplitudes or if the curve bends sharply.
    near: Vec<Piece>,
    far: Vec<Piece>,
}

/// Distance from gross slip within which there are no interpolants, as a share.
const NEAREST: f64 = 1.0 / 512.0;

impl Amplitudes {
    pub fn new(case: Case, interpolate: bool) -> Amplitudes {
        let law = case.reference.law(64);
        let rule = Quadrature::new(law.bits);
        let k = |x: &Real| real_part(&law, &rule, x).into_iter().next().unwrap();
        let slip = law.x_slip.f64();
        let half = half_share(&case);
        let (mut near, mut far) = (Vec::new(), Vec::new());
        if !interpolate || law.full_stick.f64() < 0.3 {
            return Amplitudes { half, slip, near, far, case };
        }
        let mut cover = |low: f64, high: f64| Piece::cover(low * slip, high * slip, 128, &k, &mut near);
        cover(0.0, 0.5);
        let mut share = 0.5;
        while share > NEAREST {
            cover(1.0 - share, 1.0 - 0.5 * share);
            share *= 0.5;
        }
        while share < 1.0 {
            cover(1.0 + share, 1.0 + 2.0 * share);
            share *= 2.0;
        }
        // K' scales as the amplitude to the power -3/2.
        Piece::cover(0.0, 0.5 / slip, 128, &|u| k(&(1.0 / u)) / (u * u.sqrt()), &mut far);
        Amplitudes { half, slip, near, far, case }
    }

    /// K' and its derivative in units, from the interpolants if there are any.
    fn real(&self, x: &Real) -> Option<(Real, Real)> {
        let place = x.f64();
        if (place / self.slip - 1.0).abs() <= NEAREST {
            return None;
        }
        if place < 2.0 * self.slip {
            let piece = self.near.iter().find(|piece| piece.low <= place && place <= piece.high)?;
            return Some(piece.at(x));
        }
        let u = 1.0 / x;
        let place = u.f64();
        let piece = self.far.iter().find(|piece| piece.low <= place && place <= piece.high)?;
        let (value, slope) = piece.at(&u);
        let root = u.sqrt();
        let slope = -(slope * &u * &root + 1.5 * &value * &root) * u.square();
        Some((value * u * root, slope))
    }

    /// The same by quadrature.
    fn direct(&self, x: &Real) -> (Real, Real) {
        let law = self.case.reference.law(64 + bits_for(&(x / self.slip)));
        let [real, slope] = real_part(&law, &Quadrature::new(law.bits), x);
        (real, slope)
    }

    /// The largest relative difference of interpolants and quadrature at some amplitudes.
    pub fn spot_check(&self, sampler: &mut Sampler) -> f64 {
        if self.near.is_empty() {
            return 0.0;
        }
        let law = self.case.reference.law(64);
        let rule = Quadrature::new(law.bits);
        let mut worst: f64 = 0.0;
        for _ in 0..8 {
            let share = if sampler.chance(0.5) { sampler.between(0.001, 0.99) } else { sampler.power(0.01, 2.0) };
            let x = law.real(share) * self.slip;
            let Some((found, _)) = self.real(&x.at(128)) else { continue };
            let [direct, _] = real_part(&law, &rule, &x);
            worst = worst.max(((found - &direct) / direct).abs().f64());
        }
        worst
    }

    pub fn at_amplitudes(&self, sampler: &mut Sampler, count: usize, tally: &mut Tally) {
        // A quadrature takes a thousand times as long as an interpolant.
        let count = if self.near.is_empty() { count.div_ceil(100).min(500) } else { count };
        for _ in 0..count {
            if self.near.is_empty() || sampler.chance(2e-4) {
                let share = 1.0 + sampler.power(-5.0, -2.0) * if sampler.chance(0.5) { 1.0 } else { -1.0 };
                let share = if self.near.is_empty() && sampler.chance(0.8) { sampler.power(-4.0, 1.0) } else { share };
                self.at_amplitude(share * self.case.contact.slip_displacement, "by quadrature", tally);
                continue;
            }
            let (share, range) = match sampler.below(4) {
                0 => (sampler.between(1.0, 3.0), "beyond slip"),
                1 if sampler.chance(0.5) => (sampler.power(0.0, 12.0), "beyond slip"),
                2 if sampler.chance(0.2) => (sampler.near(1.05, 64), "switches"),
                _ => share_of_slip(sampler, self.half),
            };
            if (share - 1.0).abs() > NEAREST {
                self.at_amplitude(share * self.case.contact.slip_displacement, range, tally);
            }
        }
    }

    fn at_amplitude(&self, amplitude: f64, range: &'static str, tally: &mut Tally) {
        let Case { contact, reference, kind } = &self.case;
        let got = call::complex_stiffness(contact, amplitude);
        let (law, point) = reference.at_displacement(amplitude);
        let place = || format!("{} A {amplitude:e}", text(&reference.input));
        let x = law.x(amplitude);
        let energy = cycle_energy(&law, &x, &point).0;
        let [imaginary, imaginary_rate] = imaginary_part(&law, &x, &point);
        let soft = 1.0 / law.full_stick.f64();
        let unit = &law.stiffness_unit;
        let slope_unit = unit / &law.displacement_unit;
        let exact = unit * &imaginary;
        // Beyond gross slip E = E_slip + 4 (x - x_s), with the promised error of x_s.
        let slips = amplitude > contact.slip_displacement;
        let slip =
            if slips { find("slip_displacement").k / find("k_imag").k * (4.0 * &x / &energy).f64() } else { 0.0 };
        tally.check(("k_imag", kind, range), got[1], &exact, 3.0 * soft + slip, place);
        let (real, real_rate) = self.real(&x.at(128)).unwrap_or_else(|| self.direct(&x));
        let scale = (real.square() + imaginary.square()).sqrt() / &x * &slope_unit;
        tally.check_scaled(("dk_real", kind, range), got[2], &(&slope_unit * real_rate), &scale, soft, place);
        let exact = &slope_unit * imaginary_rate;
        tally.check_scaled(("dk_imag", kind, range), got[3], &exact, &scale, 3.0 * soft, place);
        let exact = unit * &real;
        tally.check(("k_real", kind, range), got[0], &exact, soft, place);
        let (stiffness, force) = spring_slider(&real, &imaginary, &x);
        let got = call::jenkins(contact, amplitude);
        tally.check(("jenkins_stiffness", kind, range), got[0], &(unit * stiffness), 3.0 * soft, place);
        let exact = &law.slip_force * force;
        tally.check(("jenkins_slip_force", kind, range), got[1], &exact, 3.0 * soft, place);
    }
}

impl Amplitudes {
    pub fn event_driven(&self, sampler: &mut Sampler, count: usize, tally: &mut Tally) {
        let count = count.div_ceil(if self.near.is_empty() { 250 } else { 30 });
        (0..count).for_each(|i| self.one_harmonic(sampler, if i % 2 == 0 { 64 } else { 512 }, tally));
    }

    /// The event-driven harmonic force of a cosine about a mean, by K', K'' and the curve.
    fn one_harmonic(&self, sampler: &mut Sampler, samples: usize, tally: &mut Tally) {
        let Case { contact, reference, kind } = &self.case;
        let (names, range) = if samples < 100 {
            (["event_driven_64_force", "event_driven_64_jacobian", "event_driven_dissipated"], "64 nodes")
        } else {
            (["event_driven_force", "event_driven_jacobian", "event_driven_dissipated"], "512 nodes")
        };
        let share = if sampler.chance(0.3) { sampler.power(0.003, 1.0) } else { sampler.power(-2.0, -0.005) };
        let (sine, cosine) = sampler.between(-3.2, 3.2).sin_cos();
        let mean = if sampler.chance(0.3) { 0.0 } else { share * sampler.between(-1.0, 1.0) };
        let slip = contact.slip_displacement;
        let u = [mean * slip, share * slip * cosine, share * slip * sine];
        let mut workspace = call::workspace(1, samples, MSLIP_EVENT_DRIVEN);
        let (force, jacobian, dissipated) = call::harmonic(contact, &mut workspace, &u);
        let law = reference.law(64);
        let v = u.map(|u| law.x(u));
        let amplitude = (v[1].square() + v[2].square()).sqrt();
        let (one, farthest) = (law.at_x(&amplitude), law.at_x(&(v[0].abs() + &amplitude)));
        let (real, real_rate) = self.real(&amplitude.at(128)).unwrap_or_else(|| self.direct(&amplitude));
        if ((v[0].abs() + &amplitude) / &law.x_slip - 1.0).abs().f64() < 1e-9 {
            return;
        }
        let energy = cycle_energy(&law, &amplitude, &one).0;
        let [imaginary, imaginary_rate] = imaginary_part(&law, &amplitude, &one);
        let sign = if mean == 0.0 { 0.0 } else { mean.signum() };
        let exact =
            [(&farthest.tau - &one.tau) * sign, &real * &v[1] + &imaginary * &v[2], &real * &v[2] - &imaginary * &v[1]];
        let soft = 1.0 / law.full_stick.f64();
        let place = || format!("{} samples {samples} u {u:?}", text(&reference.input));
        let scale = &law.slip_force * (farthest.tau.f64() + soft * (v[0].abs() + &amplitude).f64());
        for (got, exact) in force.iter().zip(&exact) {
            tally.check_scaled((names[0], kind, range), *got, &(&law.slip_force * exact), &scale, soft, place);
        }
        let unit = law.energy_unit();
        let exact = &unit * &energy;
        let loose = &unit * (&energy + if share > 0.5 { 4.0 * amplitude.f64() } else { 0.0 });
        tally.check_scaled((names[2], kind, range), dissipated, &exact, &loose, 3.0 * soft, place);
        if mean == 0.0 {
            return; // the derivative by the mean is one-sided
        }
        let direction = [&v[1] / &amplitude, &v[2] / &amplitude];
        let slope = [&real_rate * &v[1] + &imaginary_rate * &v[2], &real_rate * &v[2] - &imaginary_rate * &v[1]];
        let (far, near) = (farthest.stiffness(), one.stiffness());
        let scale = &law.stiffness_unit / &law.full_stick;
        for j in 0..3 {
            for i in 0..3 {
                let exact = match (i, j) {
                    (0, 0) => far.clone(),
                    (0, j) => (&far - &near) * sign * &direction[j - 1],
                    (_, 0) => law.real(0.0),
                    (i, j) => {
                        let own = if i == j {
                            real.clone()
                        } else if i == 1 {
                            imaginary.clone()
                        } else {
                            -&imaginary
                        };
                        own + &slope[i - 1] * &direction[j - 1]
                    }
                };
                let rate = [&one, &farthest].map(|point| match point.slips() {
                    true => 0.0,
                    false => (&point.x * &point.curvature / point.compliance.square()).f64(),
                });
                let condition = soft + rate[0].max(rate[1]);
                let exact = &law.stiffness_unit * exact;
                tally.check_scaled((names[1], kind, range), jacobian[i + 3 * j], &exact, &scale, condition, place);
            }
        }
    }
}

/// Stiffness and slip force of the spring-slider with K' and K'' at an amplitude: sin²Θ = ratio (Θ - sin Θ cos Θ).
fn spring_slider(real: &Real, imaginary: &Real, amplitude: &Real) -> (Real, Real) {
    let bits = 256;
    let ratio = (imaginary / real).at(bits);
    let f = |t: f64, ratio: f64| t.sin().powi(2) - ratio * (t - t.sin() * t.cos());
    // Θ in doubles by bisection, coarsely for small ones; then Newton.
    let approximate = ratio.f64();
    let start = if approximate > 30.0 {
        1.5 / approximate
    } else if approximate < 1e-6 {
        std::f64::consts::PI - (std::f64::consts::PI * approximate).sqrt()
    } else {
        let (mut low, mut high) = (1e-3, std::f64::consts::PI);
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if f(middle, approximate) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let pi = Real::pi(bits);
    // η = π - Θ is small where the ratio is.
    let small = approximate < 1e-6;
    let mut eta = if small { (&pi * &ratio).sqrt() } else { &pi - start };
    for _ in 0..60 {
        let (sine, cosine) = eta.sin_cos();
        let value = sine.square() - &ratio * (&pi - &eta + &sine * &cosine);
        let slope = 2.0 * &sine * (&cosine + &ratio * &sine);
        let step = value / slope;
        eta = eta - &step;
        if step.is_zero() || step.exponent() < eta.clone().min(&(&pi - &eta)).exponent() - 60 {
            break;
        }
    }
    let sine = eta.sin_cos().0;
    let stiffness = &pi * imaginary / sine.square();
    let half = (eta / 2.0).sin_cos().1;
    let force = &stiffness * amplitude * half.square();
    (stiffness, force)
}
