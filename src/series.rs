//! Power series, summed four terms side by side so that none has to wait for the one before.

/// Coefficients of x⁰, x¹, ... in rows of four.
pub(crate) type Rows<const R: usize> = [[f64; 4]; R];

/// Coefficients in rows.
pub(crate) const fn rows<const N: usize, const R: usize>(terms: &[f64; N]) -> Rows<R> {
    assert!(N == 4 * R);
    let mut rows = [[0.0; 4]; R];
    let mut n = 0;
    while n < N {
        rows[n / 4][n % 4] = terms[n];
        n += 1;
    }
    rows
}

/// The sum at x of a series given by its rows.
#[inline]
pub(crate) fn sum<'a>(rows: impl DoubleEndedIterator<Item = [f64; 4]> + 'a, x: f64) -> f64 {
    let square = x * x;
    let step = square * square;
    let [zero, one, two, three] = rows.rev().fold([0.0; 4], |sums, row| {
        let mut next = row;
        next.iter_mut().zip(sums).for_each(|(next, sum)| *next += sum * step);
        next
    });
    (zero + one * x) + (two + three * x) * square
}

/// A polynomial and its derivative at x.
#[inline(always)]
pub(crate) fn value_and_slope<const R: usize>(rows: &Rows<R>, x: f64) -> (f64, f64) {
    let square = x * x;
    let step = square * square;
    let (mut sums, mut slopes) = ([0.0; 4], [0.0; 4]);
    for row in rows.iter().rev() {
        for ((slope, sum), term) in slopes.iter_mut().zip(&mut sums).zip(row) {
            *slope = *slope * step + *sum;
            *sum = *sum * step + term;
        }
    }
    let [zero, one, two, three] = sums;
    let [rate_0, rate_1, rate_2, rate_3] = slopes;
    let value = (zero + one * x) + (two + three * x) * square;
    // By x directly, and through x⁴.
    let direct = (one + 2.0 * two * x) + 3.0 * three * square;
    let through = (rate_0 + rate_1 * x) + (rate_2 + rate_3 * x) * square;
    (value, direct + 4.0 * (square * x) * through)
}

/// Rows that a series with coefficients near 1 needs for all digits at x, at most those there are.
#[inline]
pub(crate) fn rows_for(x: f64, all: usize) -> usize {
    // (1/16)¹⁶, (1/4)²⁸ and (1/3)³⁶ are below 2⁻⁵³.
    let enough = if x <= 1.0 / 16.0 {
        4
    } else if x <= 0.25 {
        7
    } else if x <= 1.0 / 3.0 {
        9
    } else {
        all
    };
    enough.min(all)
}
