//! The Jacobian from Fourier sums of weights, and from the derivatives gathered by pieces.
//!
//! A product of two harmonics is composed of the sum and the difference of their orders. With the pairs `Z_k = Σ w (cos kt, sin kt)` and
//! `W_k = Σ w (sin kt, -cos kt)` for all orders k of either sign, the rows of the pair p of `Σ w φ ⊗ φ` are
//!
//! ```text
//! column cos qt:  (Z_{p+q} + Z_{p-q})/2        column sin qt:  (W_{p+q} - W_{p-q})/2
//! ```

use crate::error::Error;
use crate::hbm::workspace::{Blocks, Parts, Size, padded};
use crate::varying_load::harmonic_force::sensitivity::{Sensitivity, row_blocks};

/// Doubles for the pairs of the orders from -H to 2H.
fn pairs_length(harmonics: usize) -> usize {
    2 * (3 * harmonics + 1)
}

/// Doubles of an [`Assembly`].
pub(super) fn memory_length(harmonics: usize) -> usize {
    padded(4 * harmonics + 1) + 2 * padded(pairs_length(harmonics)) + 4 * row_blocks(harmonics) * (2 * harmonics + 2)
}

#[derive(Debug)]
pub(super) struct Assembly<'a> {
    size: Size,
    /// Fourier sums of the weights up to the order 2H.
    pub sums: &'a mut [f64],
    /// Z and W over the number of samples.
    pairs: [&'a mut [f64]; 2],
    /// Columns of the derivatives gathered by pieces, with respect to u or to the input.
    products: &'a mut Blocks,
}

impl<'a> Assembly<'a> {
    /// # Errors
    /// `BadWorkspace` if fewer doubles remain.
    pub fn take(parts: &mut Parts<'a>, size: Size) -> Result<Assembly<'a>, Error> {
        let sums = parts.take(4 * size.harmonics + 1)?;
        let mut pairs = || parts.take(pairs_length(size.harmonics));
        let pairs = [pairs()?, pairs()?];
        let products = parts.take_blocks(row_blocks(size.harmonics) * (2 * size.harmonics + 2))?;
        Ok(Assembly { size, sums, pairs, products })
    }

    /// Extends the sums to the pairs of all orders.
    #[inline(always)]
    fn extend(&mut self) {
        let Size { harmonics, samples } = self.size;
        let weight = 1.0 / samples as f64;
        let Some((constant, sums)) = self.sums.split_first() else { return };
        let [z, w] = &mut self.pairs;
        let (z, w) = (z.as_chunks_mut::<2>().0, w.as_chunks_mut::<2>().0);
        let (z_negative, z) = z.split_at_mut_checked(harmonics).unwrap_or((&mut [], &mut []));
        let (w_negative, w) = w.split_at_mut_checked(harmonics).unwrap_or((&mut [], &mut []));
        let (Some((z_0, z)), Some((w_0, w))) = (z.split_first_mut(), w.split_first_mut()) else { return };
        (*z_0, *w_0) = ([weight * constant, 0.0], [0.0, -weight * constant]);
        let sums = sums.as_chunks::<2>().0;
        for ((z, w), [cosine, sine]) in z.iter_mut().zip(w).zip(sums) {
            (*z, *w) = ([weight * cosine, weight * sine], [weight * sine, -weight * cosine]);
        }
        for ((z, w), [cosine, sine]) in z_negative.iter_mut().rev().zip(w_negative.iter_mut().rev()).zip(sums) {
            (*z, *w) = ([weight * cosine, -weight * sine], [-weight * sine, -weight * cosine]);
        }
    }

    /// Writes `Σ w φ ⊗ φ` to the columns, normalised.
    #[inline(always)]
    pub fn write_sums<'c>(&mut self, columns: impl Iterator<Item = &'c mut [f64]>) {
        self.extend();
        let harmonics = self.size.harmonics;
        for (index, column) in columns.enumerate() {
            let (order, is_sine) = (index.div_ceil(2), index % 2 == 0 && index > 0);
            let [z, w] = &self.pairs;
            let (pairs, sign) = if is_sine { (w, -1.0) } else { (z, 1.0) };
            let from = |order: usize| pairs.get(2 * order..).unwrap_or(&[]);
            let Some((constant, rows)) = column.split_first_mut() else { continue };
            *constant = from(order + harmonics).first().copied().unwrap_or(0.0);
            let (sums, differences) = (from(harmonics + 1 + order), from(harmonics + 1 - order.min(harmonics)));
            for ((row, sum), difference) in rows.iter_mut().zip(sums).zip(differences) {
                *row = sum + sign * difference;
            }
        }
    }

    /// Adds the derivatives gathered by pieces, with respect to u (0) or to the input (1). Under half-wave symmetry they are those of
    /// half a period, and only rows and columns of equal (+1) or opposite (-1) parity remain.
    #[inline(always)]
    pub fn add_products<'c>(
        &mut self,
        sensitivity: &Sensitivity,
        index: usize,
        symmetry: Option<f64>,
        columns: impl Iterator<Item = &'c mut [f64]>,
    ) {
        if sensitivity.touched == 0 {
            return;
        }
        sensitivity.products(index, self.products);
        let weight = 1.0 / self.size.samples as f64;
        let length = row_blocks(self.size.harmonics).max(1);
        for ((c, column), product) in columns.enumerate().zip(self.products.chunks_exact(length)) {
            let mut factor = 1.0;
            for (r, (value, product)) in column.iter_mut().zip(product.as_flattened()).enumerate() {
                let parity = if (r.div_ceil(2) + c.div_ceil(2)).is_multiple_of(2) { 1.0 } else { -1.0 };
                let repeated = symmetry.map_or(1.0, |symmetry| 1.0 + symmetry * parity);
                *value += factor * repeated * weight * product;
                factor = 2.0;
            }
        }
    }
}
