//! Harmonic coefficients of the steady force under u(t) = u0 + Σ (u_c cos kt + u_s sin kt), in units; order [0, c1, s1, c2, ...].

use crate::history::{Dissipated, History};
use crate::{Law, Real};
use std::rc::Rc;

/// 1, cos t, sin t, cos 2t, ...
fn basis(harmonics: usize, t: &Real) -> Vec<Real> {
    let waves = (1..=harmonics).flat_map(|k| {
        let (sine, cosine) = (t * k as f64).sin_cos();
        [cosine, sine]
    });
    [Real::new(t.bits(), 1.0)].into_iter().chain(waves).collect()
}

fn basis_at_samples(bits: u32, harmonics: usize, samples: usize) -> Vec<Vec<Real>> {
    let angle = |i: usize| 2.0 * Real::pi(bits) * (i as f64) / samples as f64;
    (0..samples).map(|i| basis(harmonics, &angle(i))).collect()
}

fn dot(one: &[Real], two: &[Real]) -> Real {
    one.iter().zip(two).fold(Real::new(one[0].bits(), 0.0), |sum, (a, b)| sum + a * b)
}

/// The result of the alternating frequency/time procedure.
pub struct Sampled {
    pub force: Vec<Real>,
    /// By columns.
    pub jacobian: Vec<Real>,
    pub dissipated: Dissipated,
    /// Largest sum of the sizes of the terms of a force.
    pub size: f64,
}

/// By its definition: the second period from the unloaded state at uniformly spaced samples, each of which is passed on.
pub fn sampled(law: &Rc<Law>, coefficients: &[Real], samples: usize, mut each: impl FnMut(&History)) -> Sampled {
    let width = coefficients.len();
    let rows = basis_at_samples(law.bits, width / 2, samples);
    let zero = || law.real(0.0);
    let mut history = History::new(law.clone());
    let mut sums = Sampled {
        force: vec![zero(); width],
        jacobian: vec![zero(); width * width],
        dissipated: Dissipated { energy: zero(), size: zero() },
        size: 0.0,
    };
    for (i, row) in rows.iter().enumerate() {
        history.go(&dot(row, coefficients), i);
    }
    for (i, row) in rows.iter().enumerate() {
        let Dissipated { energy, size } = history.go_with_energy(&dot(row, coefficients), i);
        sums.dissipated = Dissipated { energy: sums.dissipated.energy + energy, size: sums.dissipated.size + size };
        let [force, size] = history.force();
        sums.size = sums.size.max(size.f64());
        let mut slope = vec![zero(); width];
        for (n, reversal) in history.reversals.iter().enumerate() {
            let stiffness = reversal.point.stiffness();
            for (j, slope) in slope.iter_mut().enumerate() {
                let before = if n == 0 { zero() } else { rows[history.reversals[n - 1].sample][j].clone() };
                *slope = &*slope + &stiffness * (&rows[reversal.sample][j] - before);
            }
        }
        for (l, wave) in row.iter().enumerate() {
            let weight = wave * if l == 0 { 1.0 } else { 2.0 } / samples as f64;
            sums.force[l] = &sums.force[l] + &weight * &force;
            for (j, slope) in slope.iter().enumerate() {
                sums.jacobian[l + width * j] = &sums.jacobian[l + width * j] + &weight * slope;
            }
        }
        each(&history);
    }
    sums
}
