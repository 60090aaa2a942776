//! Matrices of derivatives: a row per value, a column per parameter.

/// Row r of a matrix with rows of n columns.
#[inline(always)]
pub(crate) fn row(matrix: &[f64], n: usize, r: usize) -> &[f64] {
    matrix.get(r * n..(r + 1) * n).unwrap_or(&[])
}

#[inline(always)]
pub(crate) fn row_mut(matrix: &mut [f64], n: usize, r: usize) -> &mut [f64] {
    matrix.get_mut(r * n..(r + 1) * n).unwrap_or(&mut [])
}

/// y += a x.
#[inline(always)]
pub(crate) fn add(y: &mut [f64], a: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += a * x;
    }
}

/// y *= a.
#[inline(always)]
pub(crate) fn scale(y: &mut [f64], a: f64) {
    y.iter_mut().for_each(|y| *y *= a);
}

/// Row `to` += a × row `from`, another one.
#[inline(always)]
pub(crate) fn add_row(matrix: &mut [f64], n: usize, to: usize, a: f64, from: usize) {
    let (low, high) = matrix.split_at_mut((to.max(from) * n).min(matrix.len()));
    if to > from {
        add(row_mut(high, n, 0), a, row(low, n, from));
    } else {
        add(row_mut(low, n, to), a, row(high, n, 0));
    }
}
