//! The Jacobian of a force at uniformly spaced samples: Fourier sums of weights, `Σ weight φ ⊗ φ`, and outer products
//! `Σ Y_j ⊗ φ_j`.
//!
//! A product of two harmonics is composed of the sum and the difference of their orders. With the pairs
//! `Z_k = Σ weight (cos kt, sin kt)` for all orders k of either sign, and `X_k = Σ weight (sin kt, -cos kt)` of the same sums, the
//! rows of the pair p of `Σ weight φ ⊗ φ` are
//!
//! ```text
//! column cos qt:  (Z_{p+q} + Z_{p-q})/2        column sin qt:  (X_{p+q} - X_{p-q})/2
//! ```

use super::rows::{OuterProducts, row_blocks};
use super::workspace::{Blocks, Parts};
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;

pub(crate) struct Assembly<'a> {
    harmonics: usize,
    /// Weight of the sums: 1 over the number of samples.
    weight: f64,
    /// Fourier sums of the weights up to the order 2H.
    pub sums: &'a mut [f64],
    /// Z of the orders from -H to 2H, times the weight.
    pairs: &'a mut [[f64; 2]],
    /// Columns of the outer products.
    products: &'a mut Blocks,
}

impl<'a> Assembly<'a> {
    pub fn take(parts: &mut Parts<'a>, harmonics: usize, weight: f64) -> Assembly<'a> {
        let sums = parts.take(4 * harmonics + 1);
        let pairs = parts.take(2 * (3 * harmonics + 1)).blocks_mut();
        let products = parts.take_blocks(row_blocks(harmonics) * (2 * harmonics + 2));
        Assembly { harmonics, weight, sums, pairs, products }
    }

    /// Sets sums and outer products to 0.
    pub fn clear(&mut self) {
        self.sums.fill(0.0);
        self.products.fill([0.0; 4]);
    }

    /// Extends the sums to the pairs of all orders.
    fn extend(&mut self) {
        let Assembly { harmonics, weight, .. } = *self;
        let Some((constant, sums)) = self.sums.split_first() else { return };
        let (negative, pairs) = self.pairs.split_at_mut_checked(harmonics).unwrap_or((&mut [], &mut []));
        let Some((pair_0, positive)) = pairs.split_first_mut() else { return };
        *pair_0 = [weight * constant, 0.0];
        let sums = sums.blocks::<2>();
        for (pair, [cosine, sine]) in positive.iter_mut().zip(sums) {
            *pair = [weight * cosine, weight * sine];
        }
        for (pair, [cosine, sine]) in negative.iter_mut().rev().zip(sums) {
            *pair = [weight * cosine, -weight * sine];
        }
    }

    /// Writes `Σ weight φ ⊗ φ`, normalised, to the rows from `offset` on of columns that are `stride` apart.
    pub fn write_sums(&mut self, columns: &mut [f64], stride: usize, offset: usize) {
        let length = 2 * self.harmonics + 1;
        let columns = columns.chunks_exact_mut(stride.max(1)).map(|column| column.part_mut(offset..offset + length));
        self.extend();
        let harmonics = self.harmonics;
        for (index, column) in columns.enumerate() {
            let (order, is_sine) = (index.div_ceil(2), index % 2 == 0 && index > 0);
            let from = |order: usize| self.pairs.part(order..);
            let Some((constant, rows)) = column.split_first_mut() else { continue };
            let [cosine, sine] = from(order + harmonics).or_zero(0);
            *constant = if is_sine { sine } else { cosine };
            let (sums, differences) = (from(harmonics + 1 + order), from(harmonics + 1 - order.min(harmonics)));
            for ((row, [c, s]), [d, t]) in rows.blocks_mut::<2>().iter_mut().zip(sums).zip(differences) {
                *row = if is_sine { [s - t, d - c] } else { [c + d, s + t] };
            }
        }
    }

    /// Writes `Σ weight φ ⊗ φ` and the outer products to the first rows of the columns. Under half-wave symmetry the products are
    /// those of half a period, and only rows and columns of equal (+1) or opposite (-1) parity remain.
    pub fn write(&mut self, symmetry: Option<f64>, columns: &mut [f64], stride: usize) {
        self.write_sums(columns, stride, 0);
        self.write_products(symmetry, columns, stride);
    }

    /// Sets the outer products to those with the rows Y of an index.
    pub fn set_products(&mut self, outer: &OuterProducts, index: usize) {
        outer.sum(index, self.products);
    }

    /// Adds two products, the second with the opposite sign, of rows with columns, to the outer products.
    pub fn add_products(&mut self, [a, b]: [&[f64]; 2], [x, y]: [&Blocks; 2]) {
        for ((column, &a), &b) in self.products.chunks_exact_mut(x.len().max(1)).zip(a).zip(b) {
            for ((block, x), y) in column.iter_mut().zip(x).zip(y) {
                *block = (Lanes(*block) + a * Lanes(*x) - b * Lanes(*y)).0;
            }
        }
    }

    fn write_products(&mut self, symmetry: Option<f64>, columns: &mut [f64], stride: usize) {
        let rows = 2 * self.harmonics + 1;
        let columns = columns.chunks_exact_mut(stride.max(1)).map(|column| column.part_mut(..rows));
        let weight = self.weight;
        let length = row_blocks(self.harmonics).max(1);
        for (c, column) in columns.enumerate() {
            let Some(product) = self.products.get(c * length..(c + 1) * length) else { return };
            // Rows 0, then pairs of equal order: even, odd, odd, even, and so on.
            let parity = if c.div_ceil(2).is_multiple_of(2) { 1.0 } else { -1.0 };
            let [even, odd] = match symmetry {
                Some(symmetry) => [1.0 + symmetry * parity, 1.0 - symmetry * parity],
                None => [1.0; 2],
            };
            let factors = [even, odd, odd, even].map(|repeated| 2.0 * weight * repeated);
            let constant = column.or_zero(0);
            let (blocks, rest) = column.as_chunks_mut::<4>();
            if let Some(last) = product.get(blocks.len()) {
                rest.iter_mut().zip(last).zip(factors).for_each(|((value, last), factor)| *value += factor * last);
            }
            for (block, product) in blocks.iter_mut().zip(product) {
                *block = (Lanes(*block) + Lanes(factors) * Lanes(*product)).0;
            }
            column.set(0, constant + 0.5 * factors[0] * product.or_zero(0)[0]);
        }
    }
}
