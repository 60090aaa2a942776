//! Fourier sums over uniformly spaced samples, from tables over half a period.
//!
//! Even and odd orders have separate tables, because in the second half of the period odd orders only change their sign. A table is
//! made of blocks of four functions, stored sample by sample, so that the sums are vectorised without permutations.

use super::fourier::angle;
use super::workspace::Blocks;

/// Number of blocks of four functions for the orders of one parity up to `max_order`.
pub(super) fn block_count(max_order: usize) -> usize {
    (max_order + 1).div_ceil(4)
}

/// Order of the function at an index: 1, cos 2t, sin 2t, cos 4t, ... (even) or cos t, sin t, cos 3t, ... (odd). The sine of an order
/// has the order as its index, the cosine the index before.
#[inline(always)]
fn order_at(index: usize, parity: usize) -> usize {
    index + (index + parity) % 2
}

/// Fills the table of one parity up to the order `max_order`, over the first `half` of the samples.
pub(super) fn fill_table(table: &mut Blocks, parity: usize, max_order: usize, samples: usize, half: usize) {
    for (first, block) in (0..).step_by(4).zip(table.chunks_exact_mut(half.max(1))) {
        for (sample, row) in block.iter_mut().enumerate() {
            *row = [first, first + 1, first + 2, first + 3].map(|index| {
                let order = order_at(index, parity);
                let angle = angle(order, sample, samples);
                if order > max_order {
                    0.0
                } else if index == order && order > 0 {
                    angle.sin()
                } else {
                    angle.cos()
                }
            });
        }
    }
}

/// Fourier sums of even and of odd orders.
#[derive(Debug)]
pub(super) struct FourierSums<'a>(pub [&'a mut Blocks; 2]);

impl FourierSums<'_> {
    #[inline(always)]
    pub fn clear(&mut self) {
        self.0.iter_mut().for_each(|blocks| blocks.fill([0.0; 4]));
    }

    /// Adds consecutive samples to the sums of one parity.
    #[inline(always)]
    pub fn add(&mut self, tables: &[&Blocks; 2], parity: usize, rows: &TableRows, samples: &[f64]) {
        let (Some(sums), Some(table)) = (self.0.get_mut(parity), tables.get(parity)) else { return };
        let sign = if parity == 1 { rows.sign } else { 1.0 };
        for (sum, block) in sums.iter_mut().zip(table.chunks_exact(rows.half.max(1))) {
            let part = weighted_sum(block.get(rows.first..).unwrap_or(&[]), samples);
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += sign * part);
        }
    }

    #[inline(always)]
    pub fn add_all(&mut self, others: &FourierSums) {
        for (sums, others) in self.0.iter_mut().zip(&others.0) {
            for (sum, other) in sums.iter_mut().zip(others.iter()) {
                sum.iter_mut().zip(other).for_each(|(sum, other)| *sum += other);
            }
        }
    }

    /// Cosine and sine sum of an order; the sine sum of order 0 is 0.
    #[inline(always)]
    pub fn of_order(&self, order: usize) -> (f64, f64) {
        let [even, odd] = &self.0;
        let sums = if order.is_multiple_of(2) { even } else { odd }.as_flattened();
        let at = |index: usize| sums.get(index).copied().unwrap_or(0.0);
        if order == 0 { (at(0), 0.0) } else { (at(order - 1), at(order)) }
    }

    /// Copies the sums up to order H to a row over the coefficients.
    #[inline(always)]
    pub fn copy_to(&self, row: &mut [f64]) {
        let Some((constant, pairs)) = row.split_first_mut() else { return };
        *constant = self.of_order(0).0;
        for (order, pair) in (1..).zip(pairs.as_chunks_mut::<2>().0) {
            *pair = self.of_order(order).into();
        }
    }
}

/// Rows of the tables for consecutive samples in the same half of the period.
#[derive(Debug, Clone, Copy)]
pub(super) struct TableRows {
    half: usize,
    pub first: usize,
    /// Sign of odd orders.
    pub sign: f64,
}

impl TableRows {
    #[inline(always)]
    pub fn at(sample: usize, half: usize) -> TableRows {
        if sample < half {
            TableRows { half, first: sample, sign: 1.0 }
        } else {
            TableRows { half, first: sample - half, sign: -1.0 }
        }
    }
}

/// Sum of rows times weights, in two interleaved sums to shorten the chain of dependent additions.
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
