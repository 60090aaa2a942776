//! Fourier sums over samples, from tables: cosines and sines of each sample stand side by side, four orders of one parity
//! together, so that a sum needs no rearranging and half a period is enough for both.

use super::fourier::angle;
use super::workspace::Blocks;

/// Blocks of four numbers for the orders of one parity up to `largest`.
pub(super) fn blocks(largest: usize) -> usize {
    (largest + 1).div_ceil(4)
}

/// The orders of one parity stand side by side, cosines before sines: 1, cos 2t, sin 2t, cos 4t, ... and cos t, sin t, cos 3t,
/// ... The sine of an order has the order's own number, the cosine the one before; the order 0 has no sine.
#[inline(always)]
fn order_at(place: usize, parity: usize) -> usize {
    place + (place + parity) % 2
}

/// Makes the table of one parity up to the order `largest`, over the first `half` of the samples.
pub(super) fn fill_table(table: &mut Blocks, parity: usize, largest: usize, samples: usize, half: usize) {
    for (first, block) in (0..).step_by(4).zip(table.chunks_exact_mut(half.max(1))) {
        for (sample, row) in block.iter_mut().enumerate() {
            *row = [first, first + 1, first + 2, first + 3].map(|place| {
                let order = order_at(place, parity);
                let angle = angle(order, sample, samples);
                if order > largest {
                    0.0
                } else if place == order && order > 0 {
                    angle.sin()
                } else {
                    angle.cos()
                }
            });
        }
    }
}

/// Fourier sums over even and over odd orders.
#[derive(Debug)]
pub(super) struct Sums<'a>(pub [&'a mut Blocks; 2]);

impl Sums<'_> {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.0.iter_mut().for_each(|blocks| blocks.fill([0.0; 4]));
    }

    /// Adds consecutive samples to the sums over one parity.
    #[inline(always)]
    pub fn add(&mut self, tables: &[&Blocks; 2], parity: usize, rows: &Rows, samples: &[f64]) {
        let (Some(sums), Some(table)) = (self.0.get_mut(parity), tables.get(parity)) else { return };
        let sign = if parity == 1 { rows.sign } else { 1.0 };
        for (sum, block) in sums.iter_mut().zip(table.chunks_exact(rows.half.max(1))) {
            let part = weighted_sum(block.get(rows.first..).unwrap_or(&[]), samples);
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += sign * part);
        }
    }

    #[inline(always)]
    pub fn add_all(&mut self, others: &Sums) {
        for (sums, others) in self.0.iter_mut().zip(&others.0) {
            for (sum, other) in sums.iter_mut().zip(others.iter()) {
                sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
            }
        }
    }

    /// Cosine and sine sum of an order; the order 0 has no sine.
    #[inline(always)]
    pub fn of_order(&self, order: usize) -> (f64, f64) {
        let [even, odd] = &self.0;
        let sums = if order.is_multiple_of(2) { even } else { odd }.as_flattened();
        let at = |place: usize| sums.get(place).copied().unwrap_or(0.0);
        if order == 0 { (at(0), 0.0) } else { (at(order - 1), at(order)) }
    }

    /// All sums up to order H as a row over the coefficients.
    #[inline(always)]
    pub fn copy_to(&self, row: &mut [f64]) {
        let Some((constant, pairs)) = row.split_first_mut() else { return };
        *constant = self.of_order(0).0;
        for (order, pair) in (1..).zip(pairs.as_chunks_mut::<2>().0) {
            *pair = self.of_order(order).into();
        }
    }
}

/// Where consecutive samples, all in one half of the period, have their rows of the tables.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rows {
    half: usize,
    pub first: usize,
    /// Of odd orders.
    pub sign: f64,
}

impl Rows {
    #[inline(always)]
    pub fn of(sample: usize, half: usize) -> Rows {
        if sample < half {
            Rows { half, first: sample, sign: 1.0 }
        } else {
            Rows { half, first: sample - half, sign: -1.0 }
        }
    }
}

/// The sum of rows, each times its weight: two sums, so that one need not wait for the other.
#[inline(always)]
fn weighted_sum(rows: &Blocks, weights: &[f64]) -> [f64; 4] {
    let (mut one, mut two) = ([0.0; 4], [0.0; 4]);
    let rows = rows.get(..weights.len()).unwrap_or(&[]);
    let (row_pairs, last_row) = rows.as_chunks::<2>();
    let (weight_pairs, last_weight) = weights.as_chunks::<2>();
    for ([first, second], [a, b]) in row_pairs.iter().zip(weight_pairs) {
        for k in 0..4 {
            one[k] += a * first[k];
            two[k] += b * second[k];
        }
    }
    if let (&[row], &[weight]) = (last_row, last_weight) {
        for k in 0..4 {
            one[k] += weight * row[k];
        }
    }
    for k in 0..4 {
        one[k] += two[k];
    }
    one
}
