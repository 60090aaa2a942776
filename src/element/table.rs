//! A smooth, monotone function on (0, ∞) as polynomials on quarters of dyadic intervals, found by the exponent and two leading bits
//! of the mantissa of the argument: neither a root nor a logarithm is evaluated.
//!
//! `f(x) = x p(t)` with one polynomial p for each quarter and t in [-1, 1) the position in it. The functions of a contact are
//! singular at x = 0 only, which lies at least 9 half-lengths from the middle of each quarter: so the Taylor series about the
//! middle has 16 terms, of which Chebyshev economization leaves 12. With a layer they are singular at complex x too, where the
//! compliance is zero; for N_c far below N the nearest ones are 4 half-lengths from the middle.

use crate::numerics::chebyshev::monic_powers;
use crate::numerics::const_math::tabulate;
use crate::numerics::lanes::Lanes;
use crate::numerics::slices::PanicFreeSlice;
use crate::shape::series::{ORDER, Series};

/// Coefficients of a quarter.
const TERMS: usize = 12;
/// Dyadic intervals below the largest argument.
const DYADIC_INTERVALS: usize = 12;
/// Bits of the mantissa that choose the quarter.
const BITS: u32 = 2;
const QUARTERS: usize = 1 << BITS;
const INDEX_BITS: u32 = 52 - BITS;
const QUARTER_COUNT: usize = DYADIC_INTERVALS * QUARTERS + 1;

const EXPONENT_OF_1: u64 = 0x3ff << 52;
/// Half-lengths in the unit of the mantissa: t = 8 (m - 1) - 1 for the part m of the mantissa below the leading bits.
const POSITION: f64 = 8.0;

/// A value for each quarter of a table.
#[repr(transparent)]
#[derive(Debug, Clone, Copy)]
pub(super) struct Quarters<T>(pub [T; QUARTER_COUNT]);

impl<T: Copy + Default> Default for Quarters<T> {
    fn default() -> Self {
        Quarters([T::default(); QUARTER_COUNT])
    }
}

/// A tabulated function.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Table {
    /// Exponent and leading bits of the mantissa of the first quarter.
    base: u64,
    quarters: Quarters<[f64; TERMS]>,
}

impl Table {
    /// Fills tables of several functions of one argument up to (at least) the argument `largest`, a normal number, from their
    /// Taylor series about the middle x of each quarter in powers of ε, for the argument x (1 + ε), in the order of the quarters.
    pub fn fill<const K: usize>(
        tables: [&mut Table; K],
        largest: f64,
        series_about: &mut dyn FnMut(f64) -> [Series; K],
    ) {
        let base = (largest.to_bits() >> INDEX_BITS).saturating_sub(QUARTER_COUNT as u64 - 1);
        let mut tables = tables.map(|table| {
            table.base = base;
            table.quarters.0.iter_mut()
        });
        for number in base..base + QUARTER_COUNT as u64 {
            let [middle, half_length] = middle_and_half_length(number);
            for (series, quarters) in series_about(middle).iter().zip(&mut tables) {
                quarters.next().into_iter().for_each(|quarter| *quarter = economized(series, middle, half_length));
            }
        }
    }

    /// y and, if requested, dy/dx at some arguments; `None` if one is outside.
    #[inline(always)]
    pub fn values<const SLOPES: bool, const L: usize>(&self, x: &[f64; L]) -> Option<([f64; L], [f64; L])> {
        let mut rows = [&[0.0; TERMS]; L];
        for (row, x) in rows.iter_mut().zip(x) {
            *row = self.quarters.0.get((x.to_bits() >> INDEX_BITS).wrapping_sub(self.base) as usize)?;
        }
        // With the blocks P0, P1 and P2 of four coefficients: the cubics P0 + t⁴ P1 + t⁸ P2, and P1 + 2 t⁴ P2.
        let [mut cubics, mut by_blocks] = [[[0.0; 4]; L]; 2];
        let (t, mut t2) = (x.map(position_in), [0.0; L]);
        for k in 0..L {
            t2[k] = t[k] * t[k];
            let power = t2[k] * t2[k];
            for c in 0..4 {
                let last = power * rows[k][8 + c];
                let high = rows[k][4 + c] + last;
                cubics[k][c] = rows[k][c] + power * high;
                by_blocks[k][c] = high + last;
            }
        }
        let (mut values, mut slopes) = ([0.0; L], [0.0; L]);
        for k in 0..L {
            let ([c0, c1, c2, c3], t, t2) = (cubics[k], t[k], t2[k]);
            let q = (c0 + c1 * t) + t2 * (c2 + c3 * t);
            values[k] = x[k] * q;
            if SLOPES {
                // The derivative by t is the derivative of the first cubic plus 4t³ times the second one.
                let [d0, d1, d2, d3] = by_blocks[k];
                let by_blocks = (d0 + d1 * t) + t2 * (d2 + d3 * t);
                let by_cubic = (c1 + (c2 + c2) * t) + 3.0 * (c3 * t2);
                slopes[k] = q + POSITION * mantissa(x[k], 52) * (by_cubic + 4.0 * (t * t2) * by_blocks);
            }
        }
        Some((values, slopes))
    }

    /// The smallest argument inside.
    #[inline(always)]
    pub fn smallest(&self) -> f64 {
        f64::from_bits(self.base << INDEX_BITS)
    }

    /// y'' at four monotone arguments; `None` if one is outside. The quarter of an earlier call is kept.
    #[inline(always)]
    pub fn four_curvatures(&self, x: &[f64; 4], quarter: &mut Curvature) -> Option<[f64; 4]> {
        let &[first, .., last] = x;
        quarter.enter(self, first)?;
        if quarter.number == last.to_bits() >> INDEX_BITS {
            return Some(quarter.values(x));
        }
        let mut values = [0.0; 4];
        for (value, &x) in values.iter_mut().zip(x) {
            quarter.enter(self, x)?;
            [*value] = quarter.values(&[x]);
        }
        Some(values)
    }

    /// Index of the quarter in which x lies, and the integral of y from its middle to x; `None` outside the table.
    #[inline(always)]
    pub fn integral_from_middle(&self, x: f64) -> Option<(usize, f64)> {
        let number = x.to_bits() >> INDEX_BITS;
        let index = number.wrapping_sub(self.base) as usize;
        let coefficients = self.quarters.0.get(index)?.blocks::<4>();
        // The middle follows from the number of the quarter, not from x: compilers may raise x to powers in the same vector as t,
        // which would overflow.
        let ([middle, half_length], t) = (middle_and_half_length(number), position_in(x));
        // Sums of c_k t^k/(k+1) and c_k t^k/(k+2), as two lanes.
        let t2 = t * t;
        let t4 = t2 * t2;
        let mut sums = Lanes::<2>::ZERO;
        for (c, weights) in coefficients.iter().zip(INTEGRAL_WEIGHTS.blocks::<4>()).rev() {
            let term = |k: usize| c[k] * Lanes(weights[k]);
            sums = sums * t4 + ((term(0) + term(1) * t) + t2 * (term(2) + term(3) * t));
        }
        let [zeroth, first] = *sums;
        Some((index, half_length * t * (middle * zeroth + half_length * t * first)))
    }
}

/// The lower bits of the mantissa of an argument as a number from 1 to 2.
#[inline(always)]
fn mantissa(x: f64, bits: u32) -> f64 {
    f64::from_bits((x.to_bits() & ((1 << bits) - 1)) | EXPONENT_OF_1)
}

/// The position t in the quarter of x.
#[inline(always)]
fn position_in(x: f64) -> f64 {
    POSITION * mantissa(x, INDEX_BITS) - (POSITION + 1.0)
}

/// Middle and half-length of the quarter with this exponent and leading bits.
fn middle_and_half_length(number: u64) -> [f64; 2] {
    let lower = f64::from_bits(number << INDEX_BITS);
    let half_length = 0.5 * (f64::from_bits((number + 1) << INDEX_BITS) - lower);
    [lower + half_length, half_length]
}

/// `1/(k+1)` and `1/(k+2)`.
static INTEGRAL_WEIGHTS: [[f64; 2]; TERMS] = tabulate!(TERMS, |k| [1.0 / (k + 1) as f64, 1.0 / (k + 2) as f64]);

/// The polynomial of y'' on the quarter that was used last: `Σ (k+1)(k+2)(c_(k+1) + s c_(k+2)) t^k` over the half-length, with the
/// middle s in half-lengths.
pub(crate) struct Curvature {
    /// Exponent and leading bits of the mantissa.
    number: u64,
    powers: [f64; TERMS],
    per_half_length: f64,
}

impl Curvature {
    /// No quarter yet. With the sign of these zeros compilers do not use an instruction that valgrind does not implement.
    pub const fn new() -> Curvature {
        Curvature { number: 0, powers: [-0.0; TERMS], per_half_length: 0.0 }
    }

    /// Changes to the quarter in which x lies.
    #[inline(always)]
    fn enter(&mut self, table: &Table, x: f64) -> Option<()> {
        let number = x.to_bits() >> INDEX_BITS;
        if number != self.number {
            let c = table.quarters.0.get(number.wrapping_sub(table.base) as usize)?;
            let scaled = POSITION * mantissa(x, 52);
            let middle = scaled - position_in(x);
            for k in 0..TERMS - 2 {
                self.powers[k] = ((k + 1) * (k + 2)) as f64 * (c[k + 1] + middle * c[k + 2]);
            }
            self.powers[TERMS - 2] = ((TERMS - 1) * TERMS) as f64 * c[TERMS - 1];
            (self.number, self.per_half_length) = (number, scaled / x);
        }
        Some(())
    }

    #[inline(always)]
    fn values<const N: usize>(&self, x: &[f64; N]) -> [f64; N] {
        let t = x.map(position_in);
        let mut sum = [0.0; N];
        for &[c0, c1, c2, c3] in self.powers.blocks::<4>().iter().rev() {
            for k in 0..N {
                let (t, t2) = (t[k], t[k] * t[k]);
                sum[k] = sum[k] * (t2 * t2) + ((c0 + c1 * t) + t2 * (c2 + c3 * t));
            }
        }
        sum.map(|value| self.per_half_length * value)
    }
}

/// Coefficients of Q in powers of t.
fn economized(series: &Series, middle: f64, half_length: f64) -> [f64; TERMS] {
    let ratio = half_length / middle;
    // y/x = Σ y_k (ratio t)^k / (middle (1 + ratio t)).
    let mut q = *series;
    let (mut power, mut before) = (1.0 / middle, 0.0);
    for coefficient in &mut q {
        *coefficient = *coefficient * power - ratio * before;
        before = *coefficient;
        power *= ratio;
    }
    // t^k less T_k/2^(k-1) is a polynomial of lower degree, from the highest down.
    for degree in (TERMS..ORDER).rev() {
        let highest = q[degree];
        for (coefficient, lower) in q.iter_mut().zip(&MONIC_CHEBYSHEV[degree - TERMS]) {
            *coefficient -= highest * lower;
        }
    }
    let mut economized = [0.0; TERMS];
    economized.copy_from(&q);
    economized
}

/// Coefficients of T_k/2^(k-1) for k from `TERMS` on.
static MONIC_CHEBYSHEV: [[f64; ORDER]; ORDER - TERMS] = monic_powers(0.0, 1.0);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::parameters;
    use crate::shape::{Geometry, LayerCompliance, Quantity};

    /// The largest errors are at the lower end of a quarter, for flats with short edges. The guide states them.
    #[test]
    fn tables_with_layers_lose_digits_for_the_smallest_stiffening_load() {
        let contacts = [0.0, 50e-6, 1e-3, 3e-3].map(|flat| parameters(flat).shape().unwrap());
        for (ratio, stated) in [(0.1, 3e-15), (0.01, 5e-13), (0.001, 2.5e-10)] {
            let mut worst = 0.0_f64;
            for (shape, k) in contacts.iter().flat_map(|shape| (0..250).map(move |k| (shape, k))) {
                let compliance = 1.02_f64.powi(k) * shape.compliance(Quantity::Approach, shape.at_load(150.0));
                let layer = crate::parameters::Layer {
                    normal_compliance: compliance,
                    tangential_compliance: compliance,
                    stiffening_load: 150.0 * ratio,
                    reference_load: 0.0,
                };
                let mut both = *shape;
                (both.layer, _) = LayerCompliance::new(&layer, 150.0).unwrap();
                let largest = both.value(Quantity::Approach, shape.at_load(150.0));
                let mut table = Table::default();
                let at = |x: f64| both.leg_at(Quantity::Approach, x);
                Table::fill([&mut table], largest, &mut |x| [both.series(at(x), Quantity::Approach)[0]]);
                let mut x = largest;
                while let Some(([load], _)) = table.values::<true, 1>(&[x]) {
                    worst = worst.max((load / shape.load(at(x)) - 1.0).abs());
                    // The lower end, then another quarter.
                    let low = f64::from_bits(x.to_bits() >> INDEX_BITS << INDEX_BITS);
                    x = if x > low { low } else { 0.97 * x };
                }
            }
            assert!(worst < stated && worst > 0.5 * stated, "{ratio} {worst:e}");
        }
    }
}
