//! Rows over the coefficients at uniformly spaced samples, and sums of outer products of rows.
//!
//! φ is the row 1, cos t, sin t, cos 2t, ... at a sample. The sum of φ over consecutive samples is a difference of antiderivatives.
//! The rows of many harmonics are divided into strips whose length is known to the compiler, and that stay in registers.

use super::workspace::{Blocks, Parts};
use super::{angle, basis};
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;
use core::f64::consts::PI;

/// Blocks of four in a row over the coefficients 1, cos t, sin t, cos 2t, ...
pub(crate) fn row_blocks(harmonics: usize) -> usize {
    let blocks = (2 * harmonics + 1).div_ceil(4);
    if blocks <= 5 { blocks | 1 } else { blocks.next_multiple_of(5) }
}

/// A strip of a row.
pub(crate) type Strip<const N: usize> = [[f64; 4]; N];

pub(crate) fn add_scaled<const N: usize>(target: &mut Strip<N>, scale: f64, row: &Strip<N>) {
    for block in 0..N {
        target[block] = (Lanes(target[block]) + scale * Lanes(row[block])).0;
    }
}

pub(crate) fn scaled<const N: usize>(scale: f64, row: &Strip<N>) -> Strip<N> {
    row.map(|block| (scale * Lanes(block)).0)
}

/// Tables of φ at all samples, and of the antiderivatives A, which are 0 for the constant and otherwise
/// `A(n) - A(m) = φ(m) + ... + φ(n-1)`. The first strips of all samples come first.
pub(crate) struct Rows<'a> {
    pub harmonics: usize,
    samples: usize,
    phi: &'a mut Blocks,
    antiderivatives: &'a mut Blocks,
}

/// One strip of all rows.
pub(crate) struct RowStrips<'a, const N: usize> {
    /// Whether the strips hold the constant.
    is_first: bool,
    pub phi: &'a [Strip<N>],
    antiderivatives: &'a [Strip<N>],
}

impl<'a> Rows<'a> {
    pub fn take(parts: &mut Parts<'a>, harmonics: usize, samples: usize) -> Rows<'a> {
        let blocks = row_blocks(harmonics) * samples;
        let (phi, antiderivatives) = (parts.take_blocks(blocks), parts.take_blocks(blocks));
        Rows { harmonics, samples, phi, antiderivatives }
    }

    /// Fills the tables.
    pub fn fill(&mut self) {
        let Rows { harmonics, samples, .. } = *self;
        let width = 4 * row_blocks(harmonics).min(5);
        let fill = |values: &mut Blocks, function: &dyn Fn(usize, usize) -> f64| {
            for (index, strip) in values.as_flattened_mut().chunks_exact_mut(width.max(4)).enumerate() {
                let (first, n) = (index / samples.max(1) * width, index % samples.max(1));
                for (c, value) in (first..=2 * harmonics).zip(strip) {
                    *value = function(c, n);
                }
            }
        };
        fill(self.phi, &|c, n| basis(c, n, samples));
        fill(self.antiderivatives, &|c, n| {
            let order = c.div_ceil(2);
            if order == 0 {
                return 0.0;
            }
            // Sums of a geometric series: the angle half a step before the sample.
            let angle = angle(order, 2 * n + 2 * samples - 1, 2 * samples);
            let scale = 0.5 / (PI * order as f64 / samples as f64).sin();
            scale * if c.is_multiple_of(2) { -angle.cos() } else { angle.sin() }
        });
    }

    /// The strips of all samples; N is that of [`with_strips`].
    pub fn strips<const N: usize>(&self, strip: usize) -> RowStrips<'_, N> {
        let range = strip * self.samples..(strip + 1) * self.samples;
        RowStrips {
            is_first: strip == 0,
            phi: self.phi.blocks().part(range.clone()),
            antiderivatives: self.antiderivatives.blocks().part(range),
        }
    }
}

impl<const N: usize> RowStrips<'_, N> {
    /// The sum of φ over `count` samples, from sample `from` to the one before `to`.
    pub fn sum_between(&self, from: usize, to: usize, count: usize) -> Strip<N> {
        let mut sum = self.antiderivatives.or_zero(to);
        add_scaled(&mut sum, -1.0, &self.antiderivatives.or_zero(from));
        if self.is_first {
            sum.as_flattened_mut().set(0, count as f64);
        }
        sum
    }
}

/// Calls a function with the number of blocks in each strip of a row as its generic parameter.
macro_rules! with_strips {
    ($row_blocks:expr, $object:ident.$function:ident($($argument:expr),*)) => {
        match $row_blocks {
            1 => $object.$function::<1>($($argument),*),
            3 => $object.$function::<3>($($argument),*),
            _ => $object.$function::<5>($($argument),*),
        }
    };
}

pub(crate) use with_strips;

/// `Σ Y_j ⊗ φ_j` over some samples j, with a number of rows Y_j of each. Of all rows, the first strips come first.
pub(crate) struct OuterProducts<'a> {
    row_blocks: usize,
    capacity: usize,
    count: usize,
    of_each: usize,
    y: &'a mut Blocks,
    phi: &'a mut Blocks,
}

/// One strip of the rows of [`OuterProducts`].
pub(crate) struct StripTerms<'a, const N: usize, const D: usize> {
    pub count: &'a mut usize,
    pub y: &'a mut [[Strip<N>; D]],
    phi: &'a mut [Strip<N>],
}

impl<const N: usize, const D: usize> StripTerms<'_, N, D> {
    /// Appends a term.
    pub fn push(&mut self, y: [Strip<N>; D], phi: &Strip<N>) {
        self.y.set(*self.count, y);
        *self.count += usize::from(self.phi.set(*self.count, *phi));
    }
}

impl<'a> OuterProducts<'a> {
    pub fn take(parts: &mut Parts<'a>, harmonics: usize, capacity: usize, of_each: usize) -> OuterProducts<'a> {
        let row_blocks = row_blocks(harmonics);
        let [y, phi] = [of_each, 1].map(|rows| parts.take_blocks(rows * row_blocks * capacity));
        OuterProducts { row_blocks, capacity, count: 0, of_each, y, phi }
    }

    /// Number of strips of N blocks.
    pub fn strips<const N: usize>(&self) -> usize {
        (self.row_blocks / N).max(1)
    }

    /// A strip of the terms with D rows of each, emptied: the same number must be appended to each strip.
    pub fn terms<const N: usize, const D: usize>(&mut self, strip: usize) -> StripTerms<'_, N, D> {
        let range = strip * self.capacity..(strip + 1) * self.capacity;
        self.count = 0;
        StripTerms {
            count: &mut self.count,
            y: self.y.blocks_mut::<N>().blocks_mut().part_mut(range.clone()),
            phi: self.phi.blocks_mut().part_mut(range),
        }
    }

    /// `Σ Y_j ⊗ φ_j` with the rows Y of an index.
    pub fn sum(&self, index: usize, products: &mut Blocks) {
        with_strips!(self.row_blocks, self.sum_of(index, products));
    }

    fn sum_of<const N: usize>(&self, index: usize, products: &mut Blocks) {
        let (y_rows, phi_rows) = (self.y.blocks::<N>(), self.phi.blocks::<N>());
        let (strips, of_each) = (self.strips::<N>(), self.of_each.max(1));
        let terms = |strip: usize| strip * self.capacity..strip * self.capacity + self.count;
        for (strip, columns) in products.blocks_mut::<N>().chunks_mut((4 * N * strips).max(1)).enumerate() {
            let phi = phi_rows.part(terms(strip));
            for row_strip in 0..strips {
                let terms = terms(row_strip);
                let y_rows = y_rows.part(of_each * terms.start..of_each * terms.end);
                for pair in 0..2 * N {
                    let (mut one, mut two) = ([[0.0; 4]; N], [[0.0; 4]; N]);
                    for (y, phi) in y_rows.chunks_exact(of_each).zip(phi) {
                        let (row, phi) = (y.or_zero(index), phi.as_flattened());
                        add_scaled(&mut one, phi[2 * pair], &row);
                        add_scaled(&mut two, phi[2 * pair + 1], &row);
                    }
                    columns.set(2 * pair * strips + row_strip, one);
                    columns.set((2 * pair + 1) * strips + row_strip, two);
                }
            }
        }
    }
}
