//! Fourier synthesis and sums over uniformly spaced samples, folded by symmetry.
//!
//! With `t = 2π n/samples`, cosines keep and sines change their sign under n -> samples - n. If their number is even, moreover,
//! even orders keep and odd orders change their sign under n -> n + samples/2. So four partial series over
//! the positions 0 <= n <= samples/4 give all samples, and four folded sums of the samples give all Fourier sums. An odd number,
//! and 4, are not folded. All blocks of four positions are inside the arrays.
//!
//! Arrays of samples have [`sample_length`] values: some beyond the period, where they are continued periodically.

use super::angle;
use super::workspace::{Blocks, Parts, padded};
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;

/// Values of four orders, or at four positions.
type Four = Lanes<4>;

/// Length of an array of samples: whole blocks of four, and at least one value beyond the period.
pub(crate) fn sample_length(samples: usize) -> usize {
    padded(samples + 1)
}

/// Whether the samples are folded to a quarter of the period.
fn folds(samples: usize) -> bool {
    samples.is_multiple_of(2) && samples > 4
}

/// Blocks of four positions.
fn position_blocks(samples: usize) -> usize {
    let positions = if folds(samples) { samples / 4 + 1 } else { samples };
    positions.div_ceil(4)
}

/// Cosines of odd orders, sines of odd orders, cosines of even orders, sines of even orders.
const SYMMETRIES: usize = 4;

/// Weight of a position in the folded sums: 1/2 if a fold maps its samples onto themselves, 0 beyond the last position.
fn weight(n: usize, samples: usize) -> f64 {
    let folds = folds(samples);
    let unfolded = if folds { 4 * n } else { n };
    if folds && (n == 0 || unfolded == samples) {
        0.5
    } else if unfolded >= samples {
        0.0
    } else {
        1.0
    }
}

/// Tables and scratch memory for a number of samples.
pub(crate) struct FoldedFourier<'a> {
    samples: usize,
    /// Orders in the table, an even number.
    orders: usize,
    /// Weights of the positions.
    weights: &'a mut Blocks,
    /// Cosines and sines of two orders each; for each block of positions those of all orders.
    quads: &'a mut [[[f64; 4]; SYMMETRIES]],
    /// Scratch memory: the folded sums at each block of positions.
    folded: &'a mut [[[f64; 4]; SYMMETRIES]],
}

impl<'a> FoldedFourier<'a> {
    /// For all orders up to an even number.
    pub fn take(parts: &mut Parts<'a>, samples: usize, orders: usize) -> FoldedFourier<'a> {
        let blocks = position_blocks(samples);
        let weights = parts.take_blocks(blocks);
        let quads = parts.take_blocks(2 * orders * blocks).blocks_mut();
        let folded = parts.take_blocks(SYMMETRIES * blocks).blocks_mut();
        FoldedFourier { samples, orders, weights, quads, folded }
    }

    /// Fills the tables.
    pub fn fill(&mut self) {
        let samples = self.samples;
        let rows = self.quads.as_flattened_mut().chunks_exact_mut((2 * self.orders).max(1));
        for ((first, weights), rows) in (0..).step_by(4).zip(self.weights.iter_mut()).zip(rows) {
            let positions = [first, first + 1, first + 2, first + 3];
            *weights = positions.map(|n| weight(n, samples));
            for (order, [cosines, sines]) in (1..).zip(rows.blocks_mut::<2>()) {
                *cosines = positions.map(|n| angle(order, n, samples).cos());
                *sines = positions.map(|n| angle(order, n, samples).sin());
            }
        }
    }

    /// Evaluates the series with coefficients c0, a1, b1, a2, b2, ... at all samples.
    pub fn synthesise(&self, coefficients: &[f64], values: &mut [f64]) {
        let Some((&constant, pairs)) = coefficients.split_first() else { return };
        let (quads, last) = pairs.as_chunks::<4>();
        let (samples, half) = (self.samples, self.samples / 2);
        for (block, row_quads) in self.quads.chunks_exact((self.orders / 2).max(1)).enumerate() {
            let (mut odd_cosines, mut odd_sines) = (Four::ZERO, Four::ZERO);
            let (mut even_cosines, mut even_sines) = (Lanes([constant; 4]), Four::ZERO);
            for (&[a, b, c, d], rows) in quads.iter().zip(row_quads) {
                odd_cosines += a * Lanes(rows[0]);
                odd_sines += b * Lanes(rows[1]);
                even_cosines += c * Lanes(rows[2]);
                even_sines += d * Lanes(rows[3]);
            }
            if let (&[a, b], Some(rows)) = (last, row_quads.get(quads.len())) {
                odd_cosines += a * Lanes(rows[0]);
                odd_sines += b * Lanes(rows[1]);
            }
            if folds(samples) {
                let (even, odd) = (even_cosines + even_sines, odd_cosines + odd_sines);
                let (even_mirrored, odd_mirrored) = (even_cosines - even_sines, odd_cosines - odd_sines);
                store(values, 0, block, even + odd);
                store(values, half, block, even - odd);
                store_reversed(values, half, block, even_mirrored - odd_mirrored);
                store_reversed(values, samples, block, even_mirrored + odd_mirrored);
            } else {
                store(values, 0, block, (even_cosines + odd_cosines) + (even_sines + odd_sines));
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

    /// Sums of the samples times 1, cos t, sin t, cos 2t, ..., one for each of `sums`. The first value is repeated after the
    /// period.
    pub fn sum(&mut self, values: &mut [f64], sums: &mut [f64]) {
        if let Some(([first, ..], [next, ..])) = values.split_at_mut_checked(self.samples) {
            *next = *first;
        }
        self.fold(values);
        let FoldedFourier { quads, folded, .. } = self;
        let stride = (self.orders / 2).max(1);
        let Some((constant, sums)) = sums.split_first_mut() else { return };
        let mut total = Four::ZERO;
        for [_, _, even_cosines, _] in folded.iter() {
            total += Lanes(*even_cosines);
        }
        *constant = total.sum();
        for (quad, sums) in sums.chunks_mut(SYMMETRIES).enumerate() {
            let mut totals = [Four::ZERO; SYMMETRIES];
            for (folded, rows) in folded.iter().zip(quads.part(quad..).iter().step_by(stride)) {
                for ((total, folded), row) in totals.iter_mut().zip(folded).zip(rows) {
                    *total += Lanes(*folded) * Lanes(*row);
                }
            }
            sums.iter_mut().zip(totals).for_each(|(sum, total)| *sum = total.sum());
        }
    }

    /// The folded sums of the samples at each position.
    fn fold(&mut self, values: &[f64]) {
        let (samples, half) = (self.samples, self.samples / 2);
        let upwards = |from: usize| values.part(from..).blocks::<4>();
        let downwards = |from: usize| values.part(..=from).as_rchunks::<4>().1;
        let [here, opposite] = [upwards(0), upwards(half)];
        let [mirrored, mirrored_opposite] = [downwards(samples), downwards(half)];
        for (block, (weights, folded)) in self.weights.iter().zip(self.folded.iter_mut()).enumerate() {
            let Some(a) = here.get(block) else { return };
            if folds(samples) {
                let opposite = opposite.get(block);
                let [b, d] = [mirrored, mirrored_opposite].map(|mirrored| mirrored.iter().nth_back(block));
                let (Some(b), Some(c), Some(d)) = (b, opposite, d) else { return };
                let [a, b, c, d] = [*a, reversed(*b), *c, reversed(*d)].map(Lanes);
                let (e, o, em, om) = (a + c, a - c, b + d, b - d);
                *folded = [o + om, o - om, e + em, e - em].map(|sum| (Lanes(*weights) * sum).0);
            } else {
                *folded = [(Lanes(*weights) * Lanes(*a)).0; SYMMETRIES];
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

fn reversed([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [d, c, b, a]
}

/// Stores a block upwards from a value, after the given number of blocks.
fn store(values: &mut [f64], from: usize, before: usize, block: Four) {
    values.part_mut(from..).blocks_mut().set(before, block.0);
}

/// Stores a block downwards from a value, after the given number of blocks.
fn store_reversed(values: &mut [f64], from: usize, before: usize, block: Four) {
    if let Some(place) =
        values.get_mut(..=from).and_then(|values| values.as_rchunks_mut().1.iter_mut().nth_back(before))
    {
        *place = reversed(block.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec;

    #[test]
    fn samples_of_odd_orders_are_exactly_half_wave_symmetric() {
        let mut parts = Parts::new(&mut []);
        FoldedFourier::take(&mut parts, 22, 6);
        let mut memory = vec![0.0; parts.doubles];
        let mut fourier = FoldedFourier::take(&mut Parts::new(&mut memory), 22, 6);
        fourier.fill();
        let mut values = vec![0.0; sample_length(22)];
        fourier.synthesise(&[0.0, 0.3, 0.7, 0.0, 0.0, -0.2, 0.1, 0.0, 0.0, 0.35, -0.23], &mut values);
        assert!((0..11).all(|n| values[n] == -values[n + 11]));
    }
}
