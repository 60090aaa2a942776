//! Midpoint rules under the map `t = sn²(u|m)`, for the complex stiffness of a cycle close to gross slip.
//!
//! With displacement δ0 t and ξ = δ0/δ_slip < 1, the tangent stiffness is singular at t = 1/ξ. Jacobi's sn with m >= ξ maps this point
//! to the line Im u = K'(m), and `sqrt(t (1-t)) dt` becomes periodic and smooth: the midpoint rule in u with n nodes has an error
//! of `exp(-2π n K'/K)`, where K'/K decreases only logarithmically in 1-m.

/// A node: t, its weight in K' (sum 1), and its weight in δ0 dK'/dδ0 (sum 0).
pub(crate) type Node = (f64, f64, f64);

/// A rule for amplitudes up to `largest` times the displacement at gross slip.
#[derive(Debug)]
pub(crate) struct Rule {
    pub largest: f64,
    pub nodes: &'static [Node],
}

/// m is the largest ξ. The error is below 1e-15 for cylinders with 2L near b, the worst case.
pub(crate) static RULES: [Rule; 3] = include!("sn_midpoint/rules.in");

/// Nodes and weights of 40-point Gauss-Legendre on (0, 1).
pub(crate) static GAUSS: [(f64, f64); 40] = include!("sn_midpoint/gauss.in");

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// `8/π ∫ sqrt(t (1-t))/(A-t) dt = 4 (2A - 1 - 2 sqrt(A ))`.
    #[test]
    fn a_pole_beyond_gross_slip_is_integrated() {
        for (rule, ratio) in RULES.iter().zip([1.0_f64, 0.8, 0.97]) {
            for part in [ratio.min(rule.largest), rule.largest] {
                // A pole is a stronger singularity than that of any curve at gross slip.
                let a = 1.0 / (0.9 * part);
                let sum: f64 = rule.nodes.iter().map(|(t, weight, _)| weight / (a - t)).sum();
                let exact = 4.0 * (2.0 * a - 1.0 - 2.0 * (a * (a - 1.0)).sqrt());
                assert!((sum / exact - 1.0).abs() < 1e-13, "{part} {sum} {exact}");
            }
            let [weights, slopes] = rule.nodes.iter().fold([0.0; 2], |[w, s], node| [w + node.1, s + node.2]);
            assert!((weights - 1.0).abs() < 4e-16 && slopes.abs() < 1e-15, "{weights} {slopes}");
        }
    }

    #[test]
    fn the_40_point_rule_integrates_a_sine() {
        let sum: f64 = GAUSS.iter().map(|(x, weight)| weight * (PI * x).sin()).sum();
        assert!((sum * PI / 2.0 - 1.0).abs() < 4e-16);
    }
}
