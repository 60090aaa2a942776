//! Periodic displacement in continuous time: instants of reversal, and of crossing a given displacement.

use crate::fourier::folded::FoldedFourier;
use crate::numerics::record::record;
use crate::numerics::roots::bracketed_newton;
use crate::numerics::slices::PanicFreeSlice;
use core::f64::consts::PI;
use core::iter::successors;
use core::ops::{Add, Mul, Sub};

record! {
    /// An instant and its displacement.
    #[derive(Default)]
    pub(super) struct Instant {
        pub t: f64,
        pub displacement: f64,
    }
}

/// Uniform grid on which reversals are searched.
pub(super) struct Grid<'a> {
    /// Number of points, even.
    pub points: usize,
    pub fourier: FoldedFourier<'a>,
    /// Coefficients of the rate of the displacement, and its values at the points.
    pub coefficients: &'a mut [f64],
    pub rate: &'a mut [f64],
}

/// A periodic displacement.
pub(super) struct Motion<'a> {
    pub mean: f64,
    pub pairs: &'a [[f64; 2]],
}

impl<'a> Motion<'a> {
    /// The motion with the given coefficients: the mean, then a cosine and a sine of each order.
    pub fn new(coefficients: &'a [f64]) -> Motion<'a> {
        let (mean, pairs) = coefficients.split_first().unwrap_or((&0.0, &[]));
        Motion { mean: *mean, pairs: pairs.blocks() }
    }

    /// Displacement and its first three derivatives.
    pub fn derivatives(&self, t: f64) -> [f64; 4] {
        let [mut u, mut rate, mut second, mut third] = [self.mean, 0.0, 0.0, 0.0];
        for ((k, [c, s]), [a, b]) in (1..).map(f64::from).zip(harmonics(t.cos(), t.sin())).zip(self.pairs) {
            let (value, slope) = (a * c + b * s, k * (b * c - a * s));
            u += value;
            rate += slope;
            second -= k * k * value;
            third -= k * k * slope;
        }
        [u, rate, second, third]
    }

    /// Finds the reversals in chronological order. Returns their number, and whether the displacement is half-wave symmetric; then
    /// only half a period is searched.
    pub fn find_reversals(&self, grid: &mut Grid, instants: &mut [Instant]) -> (usize, bool) {
        let Grid { points, fourier, coefficients, rate } = grid;
        let Some((constant, pairs)) = coefficients.split_first_mut() else { return (0, false) };
        *constant = 0.0;
        for ((pair, [a, b]), k) in pairs.blocks_mut::<2>().iter_mut().zip(self.pairs).zip((1..).map(f64::from)) {
            *pair = [k * b, -k * a];
        }
        fourier.synthesise(coefficients, rate);
        let half = *points / 2;
        let rate = rate.part_mut(..2 * half);
        let half_wave_symmetric =
            self.mean == 0.0 && self.pairs.iter().skip(1).step_by(2).all(|pair| *pair == [0.0; 2]);
        let searched = if half_wave_symmetric { half } else { 2 * half };
        // A rate of 0 counts as positive. Under half-wave symmetry the rates at 0 and at π have opposite signs. If both are exactly
        // 0 and the rate is positive before π, it must count as negative at π, or the reversal there is missed.
        if half_wave_symmetric && rate.or_zero(0) == 0.0 && rate.or_zero(half.wrapping_sub(1)) > 0.0 {
            rate.set(half, -f64::MIN_POSITIVE);
        }
        let step = PI / half.max(1) as f64;
        let mut search = ReversalSearch { motion: self, instants, count: 0 };
        let (Some(&last), Some(&first)) = (rate.last(), rate.first()) else { return (0, false) };
        let successors = rate.iter().skip(1).chain([&first]);
        let mut before = last;
        for (j, (&here, &next)) in rate.iter().zip(successors).enumerate().take(searched) {
            let t = j as f64 * step;
            let sign = if here < 0.0 { -1.0 } else { 1.0 };
            if (next < 0.0) != (here < 0.0) {
                let fraction = here.abs() / (here.abs() + next.abs()).max(f64::MIN_POSITIVE);
                search.add(t, t + step, t + fraction * step, -sign);
            } else if (before < 0.0) == (here < 0.0) {
                let (left, middle, right) = (before.abs(), here.abs(), next.abs());
                // The minimum of the parabola through the three is below the middle one by at most an eighth of this difference.
                let second_difference = left + right - 2.0 * middle;
                if middle < left && middle <= right && middle <= 0.25 * second_difference {
                    search.add_pair(t - step, t, t + step, sign);
                }
            }
            before = here;
        }
        (search.count, half_wave_symmetric)
    }

    /// Instant after `at` at which the displacement crosses `level`; it is monotonic between the reversals `from` and `to`.
    pub fn crossing(&self, at: Instant, from: Instant, to: Instant, level: f64) -> f64 {
        let distance = (level - from.displacement).abs();
        let fraction = distance / (to.displacement - from.displacement).abs().max(distance).max(f64::MIN_POSITIVE);
        // First estimate: half a period of a cosine.
        let start = from.t + (to.t - from.t) * ((1.0 - 2.0 * fraction).acos() / PI);
        let sign = if to.displacement < from.displacement { -1.0 } else { 1.0 };
        bracketed_newton(at.t, to.t, if start < at.t { at.t } else { start }, |t| {
            let [u, rate, ..] = self.derivatives(t);
            (sign * (u - level), sign * rate)
        })
    }
}

/// Reversals found so far.
struct ReversalSearch<'a> {
    motion: &'a Motion<'a>,
    instants: &'a mut [Instant],
    count: usize,
}

impl ReversalSearch<'_> {
    /// Adds the reversal between two instants at which the rate times `sign` increases through zero.
    fn add(&mut self, low: f64, high: f64, start: f64, sign: f64) {
        let t = bracketed_newton(low, high, start, |t| {
            let [_, rate, second, _] = self.motion.derivatives(t);
            (sign * rate, sign * second)
        });
        let [displacement, ..] = self.motion.derivatives(t);
        self.count += usize::from(self.instants.set(self.count, Instant { t, displacement }));
    }

    /// Adds two reversals if the rate times `sign`, positive at `low` and `high`, has a negative minimum between them.
    #[cold]
    fn add_pair(&mut self, low: f64, middle: f64, high: f64, sign: f64) {
        let minimum = bracketed_newton(low, high, middle, |t| {
            let [_, _, second, third] = self.motion.derivatives(t);
            (sign * second, sign * third)
        });
        let [_, rate, ..] = self.motion.derivatives(minimum);
        if sign * rate < 0.0 {
            self.add(low, minimum, 0.5 * (low + minimum), -sign);
            self.add(minimum, high, 0.5 * (minimum + high), sign);
        }
    }
}

/// Pairs cos kt, sin kt of the orders k from 1 on.
pub(super) fn harmonics<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>>(
    cosine: T,
    sine: T,
) -> impl Iterator<Item = [T; 2]> {
    successors(Some([cosine, sine]), move |&[c, s]| Some([c * cosine - s * sine, s * cosine + c * sine]))
}

/// φ at an instant: the row 1, cos t, sin t, cos 2t, ...
pub(super) fn fill_phi(row: &mut [f64], t: f64) {
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = 1.0;
    pairs.blocks_mut().iter_mut().zip(harmonics(t.cos(), t.sin())).for_each(|(pair, harmonic)| *pair = harmonic);
}

/// ∫ φ dt between two instants.
pub(super) fn fill_integrals(row: &mut [f64], from: f64, to: f64) {
    let harmonics = harmonics(from.cos(), from.sin()).zip(harmonics(to.cos(), to.sin()));
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = to - from;
    for ((pair, ([c0, s0], [c1, s1])), k) in pairs.blocks_mut().iter_mut().zip(harmonics).zip((1..).map(f64::from)) {
        *pair = [(s1 - s0) / k, (c0 - c1) / k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fourier::folded::sample_length;
    use crate::fourier::workspace::Parts;
    use std::vec;

    /// Two reversals between adjacent grid points: the rate has the same sign at both.
    #[test]
    fn pairs_of_reversals_between_grid_points_are_found() {
        let (harmonics, points) = (4, 64);
        let n = 2 * harmonics + 1;
        let (mut rate, mut row) = (vec![0.0; sample_length(points)], vec![0.0; n]);
        let mut parts = Parts::new(&mut []);
        FoldedFourier::take(&mut parts, points, harmonics);
        let mut memory = vec![0.0; parts.doubles];
        let mut fourier = FoldedFourier::take(&mut Parts::new(&mut memory), points, harmonics);
        fourier.fill();
        let mut grid = Grid { points, fourier, coefficients: &mut row, rate: &mut rate };
        for shift in [0.0, 0.02, 0.05, 0.1, 0.5] {
            // The rate cos t + 1.001 cos 2t is negative over an interval of 0.05 about t = π; the grid step is 0.1.
            let [[s1, c1], [s2, c2]] = [shift, 2.0 * shift].map(|angle: f64| <[f64; 2]>::from(angle.sin_cos()));
            let mut coefficients = vec![0.0; n];
            coefficients[1..5].copy_from_slice(&[s1, c1, 0.5005 * s2, 0.5005 * c2]);
            let mut instants = vec![Instant::default(); points];
            assert_eq!(Motion::new(&coefficients).find_reversals(&mut grid, &mut instants), (4, false), "{shift}");
            for Instant { t, displacement } in &instants[..4] {
                let [u, rate, ..] = Motion::new(&coefficients).derivatives(*t);
                assert!(rate.abs() < 1e-12 && u == *displacement, "{shift} {t} {rate}");
            }
        }
    }
}
