//! Fixed rules on the unit interval: Gauss-Legendre for integrands that are smooth, tanh-sinh for those that are not at
//! the ends. Both have positive weights, so that a positive integrand is summed without cancellation.

/// Nodes and weights of 16-point Gauss-Legendre on (0, 1).
pub(crate) static GAUSS: [(f64, f64); 16] = [
    (0.005299532504175033, 0.013576229705877046),
    (0.02771248846338371, 0.031126761969323947),
    (0.06718439880608412, 0.04757925584124639),
    (0.12229779582249849, 0.06231448562776694),
    (0.19106187779867814, 0.07479799440828837),
    (0.2709916111713863, 0.08457825969750127),
    (0.35919822461037054, 0.09130170752246179),
    (0.4524937450811813, 0.09472530522753425),
    (0.5475062549188188, 0.09472530522753425),
    (0.6408017753896295, 0.09130170752246179),
    (0.7290083888286137, 0.08457825969750127),
    (0.8089381222013219, 0.07479799440828837),
    (0.8777022041775016, 0.06231448562776694),
    (0.9328156011939158, 0.04757925584124639),
    (0.9722875115366163, 0.031126761969323947),
    (0.994700467495825, 0.013576229705877046),
];

/// The largest of the [`gauss_rule`]s has four times as many nodes.
pub(crate) const GAUSS_FOURS: usize = 8;

/// Nodes and weights of Gauss-Legendre on (0, 1) with 4, 8, 12, ... nodes, one rule after the other.
static GAUSS_RULES: [[[f64; 4]; 2]; GAUSS_FOURS * (GAUSS_FOURS + 1) / 2] = {
    let mut table = [[[0.0; 4]; 2]; _];
    let (mut fours, mut start) = (1, 0);
    while fours <= GAUSS_FOURS {
        let n = 4 * fours;
        let mut i = 0;
        while i < n {
            // Newton's method for a root of P_n, from Tricomi's estimate; P_n and P_(n-1) by their recurrence.
            let mut x = -cos(core::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5));
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
            table[start + i / 4][0][i % 4] = 0.5 * (1.0 + x);
            table[start + i / 4][1][i % 4] = weight;
            i += 1;
        }
        start += fours;
        fours += 1;
    }
    table
};

/// cos for the compiler, of an angle from 0 to π.
const fn cos(x: f64) -> f64 {
    let square = x * x;
    let (mut sum, mut n) = (1.0, 28);
    while n > 0 {
        sum = 1.0 - sum * square / (n * (n - 1)) as f64;
        n -= 2;
    }
    sum
}

/// Nodes and weights of Gauss-Legendre on (0, 1) in fours: [nodes, weights]. From 1 to [`GAUSS_FOURS`] of them.
#[inline(always)]
pub(crate) fn gauss_rule(fours: usize) -> &'static [[[f64; 4]; 2]] {
    let start = fours * fours.saturating_sub(1) / 2;
    GAUSS_RULES.get(start..start + fours).unwrap_or(&[])
}

/// A node of the tanh-sinh rule, its distance from the end at 0 (accurate where it is small), and its weight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub from_0: f64,
    pub weight: f64,
}

/// Step of the trapezoidal rule under the tanh-sinh map.
///
/// A logarithm or a root at an end costs `exp(-π²/h)`, nothing. What counts are branch points near an end: of ln c at
/// w = ±ia for a slightly flattened cylinder, of 1-X near gross slip. Against a step of 1/64 the complex stiffness of
/// cylinders to flats errs by 2e-15 at 1/16, and its derivative, the more demanding, by 4e-13 of K/amplitude at 1/20.
const STEP: f64 = 1.0 / 20.0;
/// The last node is `exp(-π sinh 3.2)` = 2e-17 from its end.
const HALF: usize = 64;

/// exp for the compiler: Taylor series after halving the argument by powers of two of the result.
const fn exp(x: f64) -> f64 {
    let twos = (x / core::f64::consts::LN_2) as i32;
    let small = x - twos as f64 * core::f64::consts::LN_2;
    let mut sum = 1.0;
    let mut n = 24;
    while n > 0 {
        sum = 1.0 + sum * small / n as f64;
        n -= 1;
    }
    let mut k = 0;
    while k < twos.abs() {
        sum *= if twos > 0 { 2.0 } else { 0.5 };
        k += 1;
    }
    sum
}

/// `p = 1/(1 + exp(-π sinh t))`, t in steps of [`STEP`].
pub(crate) static TANH_SINH: [Node; 2 * HALF + 1] = {
    let mut table = [Node { from_0: 0.5, weight: 0.0 }; 2 * HALF + 1];
    let mut k = 0;
    while k <= HALF {
        let t = k as f64 * STEP;
        let (up, down) = (exp(t), exp(-t));
        let near = exp(-core::f64::consts::PI * 0.5 * (up - down));
        let (far_end, near_end) = (1.0 / (1.0 + near), near / (1.0 + near));
        let weight = STEP * core::f64::consts::PI * 0.5 * (up + down) * far_end * near_end;
        table[HALF + k] = Node { from_0: far_end, weight };
        table[HALF - k] = Node { from_0: near_end, weight };
        k += 1;
    }
    table
};

/// `∫ f` over (0, length), f smooth on it.
pub(crate) fn gauss(length: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    length * GAUSS.iter().map(|(node, weight)| weight * f(length * node)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rules_integrate_what_they_are_for() {
        // Degree 31 exactly; 4e-16 is two units of rounding.
        assert!((gauss(1.0, |x| x.powi(31)) * 32.0 - 1.0).abs() < 4e-16);
        for fours in 1..=GAUSS_FOURS {
            for degree in [0, 1, 2, 8 * fours as i32 - 1] {
                let nodes = gauss_rule(fours).iter().flat_map(|[nodes, weights]| nodes.iter().zip(weights));
                let sum: f64 = nodes.map(|(node, weight)| weight * node.powi(degree)).sum();
                assert!((sum * f64::from(degree + 1) - 1.0).abs() < 4e-15, "{fours} {degree} {sum}");
            }
        }
        let root: f64 = TANH_SINH.iter().map(|n| n.weight * (n.from_0 * (1.0 - n.from_0)).sqrt()).sum();
        assert!((root * 8.0 / core::f64::consts::PI - 1.0).abs() < 2e-15, "{root}");
        let log: f64 = TANH_SINH.iter().map(|n| n.weight * n.from_0 * n.from_0.ln()).sum();
        assert!((log * -4.0 - 1.0).abs() < 2e-15, "{log}");
    }

    #[test]
    fn functions_for_the_compiler_are_those_of_the_library() {
        for k in 0..=64 {
            let angle = core::f64::consts::PI * f64::from(k) / 64.0;
            // Terms of up to 9 add up.
            assert!((cos(angle) - angle.cos()).abs() < 4e-15, "{k}");
            let x = -40.0 + 0.7 * f64::from(k);
            // A unit of rounding for each power of two in it.
            assert!((exp(x) / x.exp() - 1.0).abs() < 64.0 * f64::EPSILON, "{x}");
        }
    }
}
