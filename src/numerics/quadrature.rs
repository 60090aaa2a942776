//! Gauss-Legendre rules on (0, 1). All weights are positive: a positive integrand is summed without cancellation.

use super::const_math::{cosine, tabulate};

/// Blocks of four nodes in the largest [`gauss_rule`].
pub(crate) const MAX_GAUSS_BLOCKS: usize = 8;

/// Node i of the Gauss-Legendre rule on (0, 1) with an even number n of nodes, the node at the same distance from the
/// other end, and the weight of both.
const fn gauss_pair(n: usize, i: usize) -> [f64; 3] {
    // Newton's method for a root of P_n from Tricomi's estimate -cos(π (i + 3/4)/(n + 1/2)), P_n by recurrence.
    let mut x = -cosine(4 * i + 3, 2 * n + 1);
    let (mut rounds, mut weight) = (0, 0.0);
    while rounds < 6 {
        let (mut before, mut p, mut k) = (1.0, x, 2);
        while k <= n {
            let next = ((2 * k - 1) as f64 * x * p - (k - 1) as f64 * before) / k as f64;
            (before, p) = (p, next);
            k += 1;
        }
        let slope = n as f64 * (before - x * p) / (1.0 - x * x);
        x -= p / slope;
        weight = 1.0 / ((1.0 - x * x) * slope * slope);
        rounds += 1;
    }
    [0.5 * (1.0 + x), 0.5 * (1.0 - x), weight]
}

/// Four nodes and their weights.
pub(crate) type Block = [[f64; 4]; 2];

/// The Gauss-Legendre rule on (0, 1) of the given number of blocks.
pub(crate) const fn gauss_legendre(blocks: usize) -> [Block; MAX_GAUSS_BLOCKS] {
    let mut rule = [[[0.0; 4]; 2]; _];
    let mut i = 0;
    while i < 2 * blocks {
        let (one, other, last) = (i / 4, blocks - 1 - i / 4, 3 - i % 4);
        [rule[one][0][i % 4], rule[other][0][last], rule[one][1][i % 4]] = gauss_pair(4 * blocks, i);
        rule[other][1][last] = rule[one][1][i % 4];
        i += 1;
    }
    rule
}

/// The rule on (0, 1) for even functions: the positive half of the Gauss-Legendre rule on (-1, 1), of twice as many
/// nodes.
pub(crate) const fn gauss_even<const B: usize>() -> [Block; B] {
    let mut rule = [[[0.0; 4]; 2]; B];
    let mut i = 0;
    while i < 4 * B {
        let [one, other, weight] = gauss_pair(8 * B, 4 * B - 1 - i);
        [rule[i / 4][0][i % 4], rule[i / 4][1][i % 4]] = [(one - other).abs(), 2.0 * weight];
        i += 1;
    }
    rule
}

/// The Gauss-Legendre rule on (0, 1) of up to [`MAX_GAUSS_BLOCKS`] blocks.
pub(crate) fn gauss_rule(blocks: usize) -> &'static [Block] {
    static RULES: [[Block; MAX_GAUSS_BLOCKS]; MAX_GAUSS_BLOCKS + 1] =
        tabulate!(MAX_GAUSS_BLOCKS + 1, |blocks| gauss_legendre(blocks));
    RULES.get(blocks).and_then(|rule| rule.get(..blocks)).unwrap_or(&[])
}

/// Nodes and weights of a [`gauss_rule`], one after the other.
pub(crate) fn gauss_nodes(blocks: usize) -> impl Iterator<Item = (&'static f64, &'static f64)> {
    gauss_rule(blocks).iter().flat_map(|[nodes, weights]| nodes.iter().zip(weights))
}

/// Integral of a function over (0, length) by 16-point Gauss-Legendre quadrature.
pub(crate) fn gauss(length: f64, mut function: impl FnMut(f64) -> f64) -> f64 {
    length * gauss_nodes(4).map(|(node, weight)| weight * function(length * node)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_rules_are_exact_for_polynomials() {
        for blocks in 1..=MAX_GAUSS_BLOCKS {
            for degree in [0, 1, 2, 8 * blocks as i32 - 1] {
                let sum: f64 = gauss_nodes(blocks).map(|(node, weight)| weight * node.powi(degree)).sum();
                assert!((sum * f64::from(degree + 1) - 1.0).abs() < 4e-15, "{blocks} {degree} {sum}");
            }
        }
        for degree in [0, 2, 30] {
            let rule = gauss_even::<3>();
            let terms = rule.iter().flat_map(|[nodes, weights]| nodes.iter().zip(weights));
            let sum: f64 = terms.map(|(node, weight)| weight * node.powi(degree)).sum();
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 4e-15, "{degree} {sum}");
        }
        assert!((gauss(2.0, |x| x.powi(31)) / (2f64.powi(32) / 32.0) - 1.0).abs() < 4e-15);
    }
}
