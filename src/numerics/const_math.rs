//! Tables that are computed at compile time, and elementary functions for them.

use core::f64::consts::FRAC_PI_2;

/// An array at compile time: `tabulate!(length, |index| entry)`.
macro_rules! tabulate {
    ($length:expr, |$index:ident| $entry:expr) => {{
        let $index = 0;
        let mut table = [$entry; $length];
        let mut index = 0;
        while index < $length {
            let $index = index;
            table[index] = $entry;
            index += 1;
        }
        table
    }};
}

pub(crate) use tabulate;

/// `cos(π/2 m/quarter)`: Taylor series on the first octant, symmetry elsewhere.
pub(crate) const fn cosine(m: usize, quarter: usize) -> f64 {
    let m = m % (4 * quarter);
    if m > 2 * quarter {
        return cosine(4 * quarter - m, quarter);
    }
    if m > quarter {
        return -cosine(2 * quarter - m, quarter);
    }
    let (from_axis, first) = if 2 * m <= quarter { (m, 0) } else { (quarter - m, 1) };
    let angle = FRAC_PI_2 * from_axis as f64 / quarter as f64;
    // Σ (-1)ⁿ x²ⁿ⁺ᶠ/(2n+f)!: the cosine for f = 0, the sine for f = 1.
    let mut sum = 0.0;
    let mut n = 10;
    while n > 0 {
        n -= 1;
        let next = (2 * n + 1 + first) as f64 * (2 * n + 2 + first) as f64;
        sum = 1.0 - angle * angle / next * sum;
    }
    if first == 0 { sum } else { angle * sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosine_agrees_with_the_standard_library_beyond_two_periods() {
        for quarter in [1, 3, 16, 20] {
            for m in 0..=9 * quarter {
                let exact = (FRAC_PI_2 * m as f64 / quarter as f64).cos();
                // The argument of `exact` is rounded: at most 2.25 periods.
                assert!((cosine(m, quarter) - exact).abs() < 3e-15, "{m} {quarter}");
            }
        }
    }
}
