//! Gauss-Legendre rules on (0, 1). All weights are positive: a positive integrand is summed without cancellation.

use super::const_math::cosine;

/// Blocks of four nodes in the largest [`gauss_rule`].
pub(crate) const MAX_GAUSS_BLOCKS: usize = 8;

/// Node i of n, an even number, of the Gauss-Legendre rule on (0, 1), that at the same distance from the other end, and their weight.
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

/// Nodes and weights of the Gauss-Legendre rule of N nodes on (0, 1), an even number.
pub(crate) const fn gauss_legendre<const N: usize>() -> [[f64; N]; 2] {
    let [mut nodes, mut weights] = [[0.0; N]; 2];
    let mut i = 0;
    while i < N / 2 {
        let last = N - 1 - i;
        [nodes[i], nodes[last], weights[i]] = gauss_pair(N, i);
        weights[last] = weights[i];
        i += 1;
    }
    [nodes, weights]
}

/// Gauss-Legendre rules with 4, 8, 12, ... nodes, concatenated.
static GAUSS_RULES: [[[f64; 4]; 2]; MAX_GAUSS_BLOCKS * (MAX_GAUSS_BLOCKS + 1) / 2] = {
    let mut table = [[[0.0; 4]; 2]; _];
    let (mut blocks, mut start) = (1, 0);
    while blocks <= MAX_GAUSS_BLOCKS {
        let mut i = 0;
        while i < 2 * blocks {
            let (one, other, last) = (start + i / 4, start + blocks - 1 - i / 4, 3 - i % 4);
            [table[one][0][i % 4], table[other][0][last], table[one][1][i % 4]] = gauss_pair(4 * blocks, i);
            table[other][1][last] = table[one][1][i % 4];
            i += 1;
        }
        start += blocks;
        blocks += 1;
    }
    table
};

/// Gauss-Legendre rule of 1 to [`MAX_GAUSS_BLOCKS`] blocks of four nodes; each block is [nodes, weights].
#[inline(always)]
pub(crate) const fn gauss_rule(blocks: usize) -> &'static [[[f64; 4]; 2]] {
    let start = blocks * blocks.saturating_sub(1) / 2;
    match GAUSS_RULES.split_at_checked(start) {
        Some((_, rules)) => match rules.split_at_checked(blocks) {
            Some((rule, _)) => rule,
            None => &[],
        },
        None => &[],
    }
}

/// Nodes and weights of a [`gauss_rule`], one after the other.
pub(crate) fn gauss_nodes(blocks: usize) -> impl Iterator<Item = (&'static f64, &'static f64)> {
    gauss_rule(blocks).iter().flat_map(|[nodes, weights]| nodes.iter().zip(weights))
}

/// `∫ f` over (0, length) by 16-point Gauss-Legendre.
pub(crate) fn gauss(length: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    length * gauss_nodes(4).map(|(node, weight)| weight * f(length * node)).sum::<f64>()
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
        // At run time as at compile time.
        let [nodes, weights] = gauss_legendre::<32>();
        assert!(
            gauss_nodes(MAX_GAUSS_BLOCKS).map(|(node, weight)| (*node, *weight)).eq(nodes.into_iter().zip(weights))
        );
        assert!((gauss(2.0, |x| x.powi(31)) / (2f64.powi(32) / 32.0) - 1.0).abs() < 4e-15);
    }
}
