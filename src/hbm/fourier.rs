//! Waves at equidistant instants, and what both rules of the harmonic force make of their sums.

use core::f64::consts::PI;

/// The angle of an order at a sample; the turn is reduced before it meets π.
pub(super) fn angle(order: usize, sample: usize, samples: usize) -> f64 {
    let turn = (order * sample % samples.max(1)) as f64 / samples.max(1) as f64;
    2.0 * PI * turn
}

/// Columns over half a period of samples, or over all of it where it has no middle: 1, cos t, sin t, cos 2t, ...
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
fn add_wave(target: &mut [f64], [a, b]: [f64; 2], cosines: &[f64], sines: &[f64]) {
    let (targets, last) = target.as_chunks_mut::<4>();
    let ((cosines, last_cosines), (sines, last_sines)) = (cosines.as_chunks::<4>(), sines.as_chunks::<4>());
    for ((target, cosine), sine) in targets.iter_mut().zip(cosines).zip(sines) {
        for k in 0..4 {
            target[k] += a * cosine[k] + b * sine[k];
        }
    }
    for ((target, cosine), sine) in last.iter_mut().zip(last_cosines).zip(last_sines) {
        *target += a * cosine + b * sine;
    }
}

/// A sum of waves at the samples, from the columns of half a period; whether it has odd harmonics only, on an even number of
/// samples.
#[inline(always)]
pub(super) fn sample(columns: &[f64], half: usize, values: &mut [f64], coefficients: &[f64]) -> bool {
    let half = half.max(1);
    let folds = half < values.len();
    let Some((constant, pairs)) = coefficients.split_first() else { return false };
    // Even and odd orders in the halves of the same memory, or all in one.
    let (even, odd) = values.split_at_mut_checked(half).unwrap_or((&mut [], &mut []));
    even.fill(*constant);
    odd.fill(0.0);
    let mut only_odd = *constant == 0.0;
    let waves = columns.get(half..).unwrap_or(&[]).chunks_exact((2 * half).max(1));
    for (order, (columns, &[a, b])) in (1..).zip(waves.zip(pairs.as_chunks::<2>().0)) {
        if a == 0.0 && b == 0.0 {
            continue;
        }
        let is_odd = order % 2 == 1;
        only_odd &= is_odd;
        let (cosines, sines) = columns.split_at_checked(half).unwrap_or((&[], &[]));
        add_wave(if is_odd && folds { odd } else { even }, [a, b], cosines, sines);
    }
    if folds {
        for (even, odd) in even.iter_mut().zip(odd.iter_mut()) {
            (*even, *odd) = (*even + *odd, *even - *odd);
        }
    }
    folds && only_odd
}

/// From sums to coefficients: the mean, and twice the mean for waves.
#[inline(always)]
pub(super) fn scale(sums: &mut [f64], mean: f64) {
    sums.iter_mut().for_each(|sum| *sum *= 2.0 * mean);
    if let Some(constant) = sums.first_mut() {
        *constant *= 0.5;
    }
}

/// In the sum of half a period and its mirror image, what couples even with odd orders cancels.
#[inline(always)]
pub(super) fn clear_other_parity(c: usize, column: &mut [f64]) {
    for (i, value) in column.iter_mut().enumerate() {
        if (c.div_ceil(2) + i.div_ceil(2)) % 2 == 1 {
            *value = 0.0;
        }
    }
}

/// Adds `Σ k φ ⊗ φ`, from the sums of k with cos and sin of every order up to 2H: products of waves are waves of the sum and
/// of the difference of their orders.
#[inline(always)]
fn add_products(jacobian: &mut [f64], harmonics: usize, sums: impl Fn(usize) -> (f64, f64)) {
    let mut columns = jacobian.chunks_exact_mut((2 * harmonics + 1).max(1));
    for q in 0..=harmonics {
        let (Some(by_cosine), by_sine) = (columns.next(), if q > 0 { columns.next() } else { None }) else {
            return;
        };
        let by_sine = by_sine.unwrap_or(&mut []);
        for p in 0..=harmonics {
            let (c_sum, s_sum) = sums(p + q);
            let (c_difference, s_difference) = sums(p.abs_diff(q));
            let s_difference = if p < q { -s_difference } else { s_difference };
            let add = |column: &mut [f64], row: usize, value: f64| {
                if let Some(j) = column.get_mut(row) {
                    *j += 0.5 * value;
                }
            };
            let cosine_row = (2 * p).saturating_sub(1);
            add(by_cosine, cosine_row, c_difference + c_sum);
            add(by_sine, cosine_row, s_sum - s_difference);
            if p > 0 {
                add(by_cosine, 2 * p, s_sum + s_difference);
                add(by_sine, 2 * p, c_difference - c_sum);
            }
        }
    }
}

/// The Jacobian from what reversals gave it and the sums of the stiffness; of a half and its mirror image, if `half_wave_symmetric`.
#[inline(always)]
pub(super) fn complete_jacobian(
    jacobian: &mut [f64],
    harmonics: usize,
    sums: impl Fn(usize) -> (f64, f64),
    mean: f64,
    half_wave_symmetric: bool,
) {
    add_products(jacobian, harmonics, sums);
    for (c, column) in jacobian.chunks_exact_mut((2 * harmonics + 1).max(1)).enumerate() {
        scale(column, mean);
        if half_wave_symmetric {
            clear_other_parity(c, column);
        }
    }
}
