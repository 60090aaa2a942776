//! Fourier synthesis and sums over uniformly spaced samples, folded by symmetry.
//!
//! With `t = 2π n/samples`, cosines keep and sines change their sign under n -> samples - n. If their number is even, moreover,
//! even orders keep and odd orders change their sign under n -> n + samples/2. So four (two if it is odd or 4) partial series over
//! the positions 0 <= n <= samples/4 (samples/2) give all samples, and four folded sums of the samples give all Fourier sums. All
//! blocks of four positions are inside the arrays.
//!
//! Arrays of samples have [`sample_length`] values: some beyond the period, where they are continued periodically.

use super::angle;
use super::workspace::{Blocks, Parts, padded};
use crate::error::Error;
use crate::numerics::total::Total;
use core::hint::black_box;

/// Length of an array of samples: whole blocks of four, and at least one value beyond the period.
pub(crate) fn sample_length(samples: usize) -> usize {
    padded(samples + 1)
}

/// Whether the samples are folded twice, to a quarter of the period.
fn folds_twice(samples: usize) -> bool {
    samples.is_multiple_of(2) && samples > 4
}

/// Blocks of four positions.
fn position_blocks(samples: usize) -> usize {
    let positions = if folds_twice(samples) { samples / 4 + 1 } else { samples / 2 + 1 };
    positions.div_ceil(4)
}

/// Cosines of odd orders, sines of odd orders, cosines of even orders, sines of even orders.
const SYMMETRIES: usize = 4;

/// Weight of a position in the folded sums: 1/2 if a fold maps its samples onto themselves, 0 beyond the last position.
fn weight(n: usize, samples: usize) -> f64 {
    let unfolded = if folds_twice(samples) { 4 * n } else { 2 * n };
    if n == 0 || unfolded == samples {
        0.5
    } else if unfolded > samples {
        0.0
    } else {
        1.0
    }
}

/// Tables and scratch memory for a number of samples.
#[derive(Debug)]
pub(crate) struct FoldedFourier<'a> {
    samples: usize,
    /// Orders in the table, an even number.
    orders: usize,
    /// Weights of the positions.
    weights: &'a mut Blocks,
    /// Cosines and sines of two orders each; for each block of positions those of all orders.
    quads: &'a mut [[[f64; 4]; SYMMETRIES]],
    /// Scratch memory: the folded sums at each block of positions, and four partial sums of each function.
    folded: &'a mut [[[f64; 4]; SYMMETRIES]],
    totals: &'a mut Blocks,
}

impl<'a> FoldedFourier<'a> {
    /// For all orders up to an even number.
    pub fn take(parts: &mut Parts<'a>, samples: usize, orders: usize) -> Result<FoldedFourier<'a>, Error> {
        let blocks = position_blocks(samples);
        let weights = parts.take_blocks(blocks)?;
        let quads = parts.take_blocks(2 * orders * blocks)?.as_chunks_mut().0;
        let folded = parts.take_blocks(SYMMETRIES * blocks)?.as_chunks_mut().0;
        Ok(FoldedFourier { samples, orders, weights, quads, folded, totals: parts.take_blocks(1 + 2 * orders)? })
    }

    /// Fills the tables.
    pub fn fill(&mut self) {
        let samples = self.samples;
        let rows = self.quads.as_flattened_mut().chunks_exact_mut((2 * self.orders).max(1));
        for ((first, weights), rows) in (0..).step_by(4).zip(self.weights.iter_mut()).zip(rows) {
            let positions = [first, first + 1, first + 2, first + 3];
            *weights = positions.map(|n| weight(n, samples));
            for (order, [cosines, sines]) in (1..).zip(rows.as_chunks_mut::<2>().0) {
                *cosines = positions.map(|n| angle(order, n, samples).cos());
                *sines = positions.map(|n| angle(order, n, samples).sin());
            }
        }
    }

    /// Evaluates the series with coefficients c0, a1, b1, a2, b2, ... at all samples.
    pub fn synthesise(&self, coefficients: &[f64], values: &mut [f64]) {
        self.synthesis_kernel(coefficients, values);
    }

    pub fn synthesis_kernel(&self, coefficients: &[f64], values: &mut [f64]) {
        let Some((&constant, pairs)) = coefficients.split_first() else { return };
        let (quads, last) = pairs.as_chunks::<4>();
        let (samples, half) = (self.samples, self.samples / 2);
        for (block, row_quads) in self.quads.chunks_exact((self.orders / 2).max(1)).enumerate() {
            let (mut odd_cosines, mut odd_sines) = ([0.0; 4], [0.0; 4]);
            let (mut even_cosines, mut even_sines) = ([constant; 4], [0.0; 4]);
            for (&[a, b, c, d], rows) in quads.iter().zip(row_quads) {
                for k in 0..4 {
                    odd_cosines[k] += a * rows[0][k];
                    odd_sines[k] += b * rows[1][k];
                    even_cosines[k] += c * rows[2][k];
                    even_sines[k] += d * rows[3][k];
                }
            }
            if let (&[a, b], Some(rows)) = (last, row_quads.get(quads.len())) {
                for k in 0..4 {
                    odd_cosines[k] += a * rows[0][k];
                    odd_sines[k] += b * rows[1][k];
                }
            }
            if folds_twice(samples) {
                let (even, odd) = (add(even_cosines, even_sines), add(odd_cosines, odd_sines));
                let (even_mirrored, odd_mirrored) =
                    (subtract(even_cosines, even_sines), subtract(odd_cosines, odd_sines));
                store(values, 0, block, add(even, odd));
                store(values, half, block, subtract(even, odd));
                store_reversed(values, half, block, subtract(even_mirrored, odd_mirrored));
                store_reversed(values, samples, block, add(even_mirrored, odd_mirrored));
            } else {
                let (cosines, sines) = (add(even_cosines, odd_cosines), add(even_sines, odd_sines));
                store(values, 0, block, add(cosines, sines));
                store_reversed(values, samples, block, subtract(cosines, sines));
            }
        }
        continue_periodically(values, samples);
    }

    /// Sums of a function whose samples from `first` on are evaluated, in an array of two periods.
    pub fn sum_from(&mut self, first: usize, half_wave: Option<f64>, values: &mut [f64], sums: &mut [f64]) {
        let samples = self.samples;
        if let Some((period, next)) = values.split_at_mut_checked(samples) {
            period.iter_mut().zip(next).take(first).for_each(|(value, next)| *value = *next);
        }
        self.sum_half_wave(first, half_wave, values.part_mut(..sample_length(samples)), sums);
    }

    /// Sums of a function. Under half-wave symmetry half a period of samples from `first` on is evaluated, after which the function
    /// keeps (+1) or changes (-1) its sign.
    pub fn sum_half_wave(&mut self, first: usize, half_wave: Option<f64>, values: &mut [f64], sums: &mut [f64]) {
        let (samples, half) = (self.samples, self.samples / 2);
        if let Some(sign) = half_wave
            && let Some((one, two)) = values.get_mut(..samples).and_then(|period| period.split_at_mut_checked(half))
        {
            // The evaluated half starts in either half of the period.
            let (one, two, turn) = if first < half { (one, two, first) } else { (two, one, first - half) };
            two.iter_mut().zip(one.iter()).skip(turn).for_each(|(two, one)| *two = sign * one);
            one.iter_mut().zip(two.iter()).take(turn).for_each(|(one, two)| *one = sign * two);
        }
        self.sum(values, sums);
    }

    /// Sums of the samples times 1, cos t, sin t, cos 2t, ..., one for each of `sums`. The first value is repeated after the period.
    pub fn sum(&mut self, values: &mut [f64], sums: &mut [f64]) {
        if let Some(([first, ..], [next, ..])) = values.split_at_mut_checked(self.samples) {
            *next = *first;
        }
        self.fold(values);
        let FoldedFourier { quads, folded, totals, .. } = self;
        let stride = (self.orders / 2).max(1);
        let mut total = [0.0; 4];
        for [_, _, even_cosines, _] in folded.iter() {
            for k in 0..4 {
                total[k] += even_cosines[k];
            }
        }
        let (Some((first, sums)), Some((constant, totals))) = (sums.split_first_mut(), totals.split_first_mut()) else {
            return;
        };
        *constant = total;
        let count = sums.len().div_ceil(4);
        for (quad, totals) in totals.as_chunks_mut::<SYMMETRIES>().0.iter_mut().take(count).enumerate() {
            let [mut a, mut b, mut c, mut d] = [[0.0; 4]; 4];
            for (block, folded) in folded.iter().enumerate() {
                let Some(rows) = quads.get(quad + block * stride) else { break };
                for k in 0..4 {
                    a[k] += folded[0][k] * rows[0][k];
                    b[k] += folded[1][k] * rows[1][k];
                    c[k] += folded[2][k] * rows[2][k];
                    d[k] += folded[3][k] * rows[3][k];
                }
            }
            *totals = [a, b, c, d];
        }
        // Summed from memory, which keeps the loop above vectorised along the positions.
        *first = sum_of(*constant);
        for (sum, total) in sums.iter_mut().zip(totals.iter()) {
            *sum = sum_of(*total);
        }
    }

    /// The folded sums of the samples at each position.
    fn fold(&mut self, values: &[f64]) {
        let (samples, half) = (self.samples, self.samples / 2);
        let upwards = |from: usize| values.part(from..).as_chunks::<4>().0;
        let downwards = |from: usize| values.part(..=from).as_rchunks::<4>().1;
        let [here, opposite] = [upwards(0), upwards(half)];
        let [mirrored, mirrored_opposite] = [downwards(samples), downwards(half)];
        for (block, (weights, folded)) in self.weights.iter().zip(self.folded.iter_mut()).enumerate() {
            let (Some(a), Some(b)) = (here.get(block), mirrored.iter().nth_back(block)) else { return };
            if folds_twice(samples) {
                let (Some(c), Some(d)) = (opposite.get(block), mirrored_opposite.iter().nth_back(block)) else {
                    return;
                };
                // In memory, so that the compiler combines the values in vectors.
                let [a, b, c, d] = *black_box(&[*a, reversed(*b), *c, reversed(*d)]);
                let (e, o, em, om) = (add(a, c), subtract(a, c), add(b, d), subtract(b, d));
                *folded = [
                    times(*weights, add(o, om)),
                    times(*weights, subtract(o, om)),
                    times(*weights, add(e, em)),
                    times(*weights, subtract(e, em)),
                ];
            } else {
                let (a, b) = (*a, reversed(*b));
                let (cosines, sines) = (times(*weights, add(a, b)), times(*weights, subtract(a, b)));
                *folded = [cosines, sines, cosines, sines];
            }
        }
    }
}

/// Fills the values beyond the period.
pub(crate) fn continue_periodically(values: &mut [f64], samples: usize) {
    let (period, beyond) = values.split_at_mut_checked(samples).unwrap_or((&mut [], &mut []));
    for beyond in beyond.chunks_mut(samples.max(1)) {
        if let Some(continued) = period.get(..beyond.len()) {
            beyond.copy_from_slice(continued);
        }
    }
}

fn add(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]]
}

fn subtract(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}

fn times(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]]
}

fn sum_of([a, b, c, d]: [f64; 4]) -> f64 {
    (a + c) + (b + d)
}

fn reversed([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [d, c, b, a]
}

/// Stores a block upwards from a value, after the given number of blocks.
fn store(values: &mut [f64], from: usize, before: usize, block: [f64; 4]) {
    if let Some(place) = values.get_mut(from..).and_then(|values| values.as_chunks_mut().0.get_mut(before)) {
        *place = block;
    }
}

/// Stores a block downwards from a value, after the given number of blocks.
fn store_reversed(values: &mut [f64], from: usize, before: usize, block: [f64; 4]) {
    if let Some(place) =
        values.get_mut(..=from).and_then(|values| values.as_rchunks_mut().1.iter_mut().nth_back(before))
    {
        *place = reversed(block);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;

    #[test]
    fn samples_of_odd_orders_are_exactly_half_wave_symmetric() {
        let mut memory = vec![0.0; Parts::count(|parts| FoldedFourier::take(parts, 22, 6))];
        let mut fourier = FoldedFourier::take(&mut Parts::Taking(&mut memory), 22, 6).unwrap();
        fourier.fill();
        let mut values = vec![0.0; sample_length(22)];
        fourier.synthesise(&[0.0, 0.3, 0.7, 0.0, 0.0, -0.2, 0.1, 0.0, 0.0, 0.35, -0.23], &mut values);
        assert!((0..11).all(|n| values[n] == -values[n + 11]));
    }
}
