//! Columns 1, cos t, sin t, cos 2t, ... over a uniform grid, Fourier synthesis from them, and operations on rows of coefficients.

use crate::fourier::angle;
use crate::simd::dispatch;

/// Fills the columns 1, cos t, sin t, cos 2t, ... over the first `half` of the samples.
pub(super) fn fill_columns(columns: &mut [f64], samples: usize, half: usize) {
    for (column, values) in columns.chunks_exact_mut(half.max(1)).enumerate() {
        let (order, is_sine) = (column.div_ceil(2), column % 2 == 0 && column > 0);
        for (sample, value) in values.iter_mut().enumerate() {
            let angle = angle(order, sample, samples);
            *value = if is_sine { angle.sin() } else { angle.cos() };
        }
    }
}

/// Adds `a cos + b sin`.
#[inline(always)]
fn add_harmonic(target: &mut [f64], [a, b]: [f64; 2], cosines: &[f64], sines: &[f64]) {
    let (blocks, remainder) = target.as_chunks_mut::<4>();
    let ((cosines, last_cosines), (sines, last_sines)) = (cosines.as_chunks::<4>(), sines.as_chunks::<4>());
    for ((block, cosine), sine) in blocks.iter_mut().zip(cosines).zip(sines) {
        for k in 0..4 {
            block[k] += a * cosine[k] + b * sine[k];
        }
    }
    for ((value, cosine), sine) in remainder.iter_mut().zip(last_cosines).zip(last_sines) {
        *value += a * cosine + b * sine;
    }
}

/// Evaluates a Fourier series at all samples, from [columns](fill_columns) over `half` of them. Returns whether the values are
/// half-wave symmetric: the number of samples is even, and only odd harmonics are present.
#[inline(always)]
pub(super) fn synthesise(columns: &[f64], half: usize, values: &mut [f64], coefficients: &[f64]) -> bool {
    dispatch!(synthesis(columns, half, values, coefficients))
}

#[inline(always)]
fn synthesis(columns: &[f64], half: usize, values: &mut [f64], coefficients: &[f64]) -> bool {
    let half = half.max(1);
    let folds = half < values.len();
    let Some((constant, pairs)) = coefficients.split_first() else { return false };
    // Even orders are summed in the first half of the values and odd orders in the second; all in one if there are no halves.
    let (even, odd) = values.split_at_mut_checked(half).unwrap_or((&mut [], &mut []));
    even.fill(*constant);
    odd.fill(0.0);
    let mut only_odd = *constant == 0.0;
    let harmonics = columns.get(half..).unwrap_or(&[]).chunks_exact((2 * half).max(1));
    for (order, (columns, &[a, b])) in (1..).zip(harmonics.zip(pairs.as_chunks::<2>().0)) {
        if a == 0.0 && b == 0.0 {
            continue;
        }
        let is_odd = order % 2 == 1;
        only_odd &= is_odd;
        let (cosines, sines) = columns.split_at_checked(half).unwrap_or((&[], &[]));
        add_harmonic(if is_odd && folds { odd } else { even }, [a, b], cosines, sines);
    }
    if folds {
        for (even, odd) in even.iter_mut().zip(odd.iter_mut()) {
            (*even, *odd) = (*even + *odd, *even - *odd);
        }
    }
    folds && only_odd
}

/// Clears the rows whose order differs in parity from that of column `c`: under half-wave symmetry they cancel over the period.
#[inline(always)]
pub(super) fn clear_opposite_parity(c: usize, column: &mut [f64]) {
    for (i, value) in column.iter_mut().enumerate() {
        if (c.div_ceil(2) + i.div_ceil(2)) % 2 == 1 {
            *value = 0.0;
        }
    }
}

/// Adds `a x - b y`.
#[inline(always)]
pub(super) fn add_difference(target: &mut [f64], a: f64, x: &[f64], b: f64, y: &[f64]) {
    let (blocks, remainder) = target.as_chunks_mut::<4>();
    let ((x, last_x), (y, last_y)) = (x.as_chunks::<4>(), y.as_chunks::<4>());
    for ((block, x), y) in blocks.iter_mut().zip(x).zip(y) {
        for k in 0..4 {
            block[k] += a * x[k] - b * y[k];
        }
    }
    for ((value, x), y) in remainder.iter_mut().zip(last_x).zip(last_y) {
        *value += a * x - b * y;
    }
}
