//! A periodic displacement in time: where it turns, and where it crosses a level.

use super::fourier::sample;
use crate::numerics::roots::bracketed_newton;
use core::f64::consts::PI;

/// An instant, and the displacement there.
#[derive(Debug, Clone, Copy)]
pub(super) struct Instant {
    pub t: f64,
    pub displacement: f64,
}

/// Where reversals are looked for.
pub(super) struct Grid<'a> {
    /// Over the grid's first half, for each coefficient: 1, cos t, sin t, cos 2t, ...
    pub columns: &'a [f64],
    /// Becomes the displacement's rate on the grid.
    pub rate: &'a mut [f64],
    /// Becomes the coefficients of the rate.
    pub row: &'a mut [f64],
}

/// A periodic displacement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion<'a> {
    pub mean: f64,
    pub pairs: &'a [[f64; 2]],
}

impl<'a> Motion<'a> {
    /// The displacement of these coefficients: its mean, and a cosine and a sine of every order.
    pub fn of(coefficients: &'a [f64]) -> Motion<'a> {
        let (mean, pairs) = coefficients.split_first().unwrap_or((&0.0, &[]));
        Motion { mean: *mean, pairs: pairs.as_chunks().0 }
    }

    /// The displacement and its first three derivatives.
    pub fn at(&self, t: f64) -> [f64; 4] {
        let (sine, cosine) = t.sin_cos();
        let (mut c, mut s, mut k) = (cosine, sine, 1.0);
        let [mut u, mut rate, mut second, mut third] = [self.mean, 0.0, 0.0, 0.0];
        for [a, b] in self.pairs {
            let (along, across) = (a * c + b * s, k * (b * c - a * s));
            u += along;
            rate += across;
            second -= k * k * along;
            third -= k * k * across;
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            k += 1.0;
        }
        [u, rate, second, third]
    }

    /// Finds the reversals in the order of time: their number, and whether they are those of half a period, because there
    /// are odd harmonics only.
    #[inline(always)]
    pub fn find_reversals(&self, grid: Grid, turns: &mut [[f64; 2]]) -> (usize, bool) {
        let Grid { columns, rate, row } = grid;
        let Some((constant, pairs)) = row.split_first_mut() else { return (0, false) };
        *constant = 0.0;
        let mut k = 1.0;
        for (pair, &[a, b]) in pairs.as_chunks_mut::<2>().0.iter_mut().zip(self.pairs) {
            *pair = [k * b, -k * a];
            k += 1.0;
        }
        let half = rate.len() / 2;
        let half_wave_symmetric = sample(columns, half, rate, row) && self.mean == 0.0;
        let points = if half_wave_symmetric { half } else { 2 * half };
        // A rate of 0 counts as positive. At the seam of a mirrored half it is minus itself on the other side: with a rate of
        // exactly 0 there, the other half's has to count as negative where this half ends positive.
        if half_wave_symmetric
            && rate.first() == Some(&0.0)
            && half.checked_sub(1).and_then(|last| rate.get(last)).is_some_and(|rate| *rate > 0.0)
            && let Some(opposite) = rate.get_mut(half)
        {
            *opposite = -f64::MIN_POSITIVE;
        }
        let step = PI / half.max(1) as f64;
        let mut turns = Turns { motion: self, places: turns, count: 0 };
        let (Some(&last), Some(&first)) = (rate.last(), rate.first()) else { return (0, false) };
        let nexts = rate.iter().skip(1).chain([&first]);
        let mut before = last;
        for (j, (&here, &next)) in rate.iter().zip(nexts).enumerate().take(points) {
            let t = j as f64 * step;
            let sign = if here < 0.0 { -1.0 } else { 1.0 };
            if (next < 0.0) != (here < 0.0) {
                let part = here.abs() / (here.abs() + next.abs()).max(f64::MIN_POSITIVE);
                turns.add(t, t + step, t + part * step, -sign);
            } else if (before < 0.0) == (here < 0.0) {
                let (left, middle, right) = (before.abs(), here.abs(), next.abs());
                // A parabola through the three dips below the middle one by an eighth of this bend at most.
                let second_derivative = left + right - 2.0 * middle;
                if middle < left && middle <= right && middle <= 0.25 * second_derivative {
                    turns.add_two(t - step, t, t + step, sign);
                }
            }
            before = here;
        }
        (turns.count, half_wave_symmetric)
    }

    /// When a swing crosses a displacement, not before it is `at`.
    pub fn crossing(&self, at: Instant, from: Instant, to: Instant, level: f64) -> f64 {
        let half_range = (level - from.displacement).abs();
        let part = half_range / (to.displacement - from.displacement).abs().max(half_range).max(f64::MIN_POSITIVE);
        // As if the swing were half a wave.
        let start = from.t + (to.t - from.t) * ((1.0 - 2.0 * part).acos() / PI);
        let sign = if to.displacement < from.displacement { -1.0 } else { 1.0 };
        bracketed_newton(at.t, to.t, if start < at.t { at.t } else { start }, |t| {
            let [u, rate, ..] = self.at(t);
            (sign * (u - level), sign * rate)
        })
    }
}

/// Turning points as they are found.
struct Turns<'a> {
    motion: &'a Motion<'a>,
    /// Instant and displacement of each.
    places: &'a mut [[f64; 2]],
    count: usize,
}

impl Turns<'_> {
    /// One between two instants, where the rate times `sign` rises through zero.
    fn add(&mut self, low: f64, high: f64, start: f64, sign: f64) {
        let t = bracketed_newton(low, high, start, |t| {
            let [_, rate, second, _] = self.motion.at(t);
            (sign * rate, sign * second)
        });
        let [displacement, ..] = self.motion.at(t);
        if let Some(place) = self.places.get_mut(self.count) {
            *place = [t, displacement];
            self.count += 1;
        }
    }

    /// Two of them, if the rate times `sign`, positive at `low` and `high`, dips below zero between them.
    #[cold]
    fn add_two(&mut self, low: f64, middle: f64, high: f64, sign: f64) {
        let bottom = bracketed_newton(low, high, middle, |t| {
            let [_, _, second, third] = self.motion.at(t);
            (sign * second, sign * third)
        });
        let [_, rate, ..] = self.motion.at(bottom);
        if sign * rate < 0.0 {
            self.add(low, bottom, 0.5 * (low + bottom), -sign);
            self.add(bottom, high, 0.5 * (bottom + high), sign);
        }
    }
}

/// φ of an instant.
#[inline(always)]
pub(super) fn fill_phi(row: &mut [f64], t: f64) {
    let (sine, cosine) = t.sin_cos();
    let (mut c, mut s) = (cosine, sine);
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = 1.0;
    for pair in pairs.as_chunks_mut::<2>().0 {
        *pair = [c, s];
        (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
    }
}

/// ∫ φ dt from one instant to another.
#[inline(always)]
pub(super) fn fill_integrals(row: &mut [f64], from: f64, to: f64) {
    let ((sine0, cosine0), (sine1, cosine1)) = (from.sin_cos(), to.sin_cos());
    let (mut c0, mut s0, mut c1, mut s1, mut k) = (cosine0, sine0, cosine1, sine1, 1.0);
    let Some((constant, pairs)) = row.split_first_mut() else { return };
    *constant = to - from;
    for pair in pairs.as_chunks_mut::<2>().0 {
        *pair = [(s1 - s0) / k, (c0 - c1) / k];
        (c0, s0) = (c0 * cosine0 - s0 * sine0, s0 * cosine0 + c0 * sine0);
        (c1, s1) = (c1 * cosine1 - s1 * sine1, s1 * cosine1 + c1 * sine1);
        k += 1.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hbm::fourier::fill_columns;
    use std::vec;

    /// Two reversals between neighbours of the grid, which sees the same sign on both sides.
    #[test]
    fn turns_between_the_points_of_the_grid_are_found() {
        let (harmonics, grid) = (4, 64);
        let n = 2 * harmonics + 1;
        let (mut columns, mut rate, mut row) = (vec![0.0; n * grid / 2], vec![0.0; grid], vec![0.0; n]);
        fill_columns(&mut columns, grid, grid / 2);
        for by in [0.0, 0.02, 0.05, 0.1, 0.5] {
            // Its rate cos t + 1.001 cos 2t dips through zero for 0.05 about t = π; the grid's step is 0.1.
            let [[s1, c1], [s2, c2]] = [by, 2.0 * by].map(|angle: f64| <[f64; 2]>::from(angle.sin_cos()));
            let mut coefficients = vec![0.0; n];
            coefficients[1..5].copy_from_slice(&[s1, c1, 0.5005 * s2, 0.5005 * c2]);
            let mut turns = vec![[0.0; 2]; grid];
            let looked_for = Grid { columns: &columns, rate: &mut rate, row: &mut row };
            assert_eq!(Motion::of(&coefficients).find_reversals(looked_for, &mut turns), (4, false), "{by}");
            for [t, displacement] in &turns[..4] {
                let [u, rate, ..] = Motion::of(&coefficients).at(*t);
                assert!(rate.abs() < 1e-12 && u == *displacement, "{by} {t} {rate}");
            }
        }
    }
}
