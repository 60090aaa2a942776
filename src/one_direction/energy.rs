//! Energy dissipated in a step.
//!
//! Along the straight path from (S0, u0) to (S1, u1), with t from 0 to 1, the boundary of the slip zone moves inwards at the rate
//! `dS_c/dt = (Δu - σ mu ΔS)/(D - σ mu)` through a piece D of the old diagram; a falling contact size may overtake it. While it
//! moves from S_c0 to S_c1,
//!
//! ```text
//! W = mu |mu - σD| ∫ [N(S_b) - N(S_c) - N'(S_c)(S_b - S_c)] |dS_c|,
//! ```
//!
//! because the integral of K_t(c) - K_t(s) over N from c to b is K_t(c) times the remainder in brackets.

use crate::element::{Curvature, Element};
use crate::numerics::lanes::Lanes;
use crate::numerics::quadrature::{Block, MAX_GAUSS_BLOCKS, gauss_legendre, gauss_rule};
use crate::one_direction::diagram::Knot;

/// The path of a step, straight in (S, u).
#[derive(Clone, Copy)]
pub(crate) struct StepPath {
    pub shift: [f64; 2],
    /// Change of the displacement.
    pub displacement: f64,
}

impl StepPath {
    fn contact_rate(&self) -> f64 {
        self.shift[1] - self.shift[0]
    }

    /// Rate of the boundary of a slip zone through a piece of slope D, of slip in the direction ±mu.
    fn rate(&self, slope: f64, slip_slope: f64) -> f64 {
        (self.displacement - slip_slope * self.contact_rate()) / (slope - slip_slope)
    }

    /// The direction ±mu in which slip starts at the edge of a piece of slope D; `None` if it does not.
    fn direction_of_slip(&self, mu: f64, slope: f64) -> Option<f64> {
        let contact_rate = self.contact_rate();
        let grows = contact_rate > 0.0;
        let excess = if grows { self.displacement } else { self.displacement - slope * contact_rate };
        let sticks = excess == 0.0 || (grows && excess.abs() <= mu * contact_rate);
        let slip_slope = mu.copysign(excess);
        // A slip zone exists if its boundary recedes faster than the contact size; rounding must not start one.
        let slips =
            !sticks && (slope == slip_slope || contact_rate >= 0.0 || self.rate(slope, slip_slope) < contact_rate);
        slips.then_some(slip_slope)
    }
}

/// A segment of a path: boundaries of the slip zone and of the contact at both of its ends.
struct SlipPiece {
    inner: [f64; 2],
    outer: [f64; 2],
}

/// Energy \[J\] dissipated from a closed contact with the diagram `knots`, which must not be empty.
#[inline(never)]
pub(crate) fn dissipated(element: &Element, knots: &[Knot], path: &StepPath) -> f64 {
    let mu = element.friction_coefficient;
    let ([start, end], contact_rate) = (path.shift, path.contact_rate());
    if contact_rate == 0.0 && path.displacement == 0.0 {
        return 0.0;
    }
    // Fraction of the path, size of the contact, boundary of the slip zone, and its direction once there is slip.
    let (mut energy, mut fraction, mut outer, mut inner, mut direction) = (0.0, 0.0, start, start, None);
    let mut last = knots.len().saturating_sub(1);
    // Each round ends a piece, the slip, or the step.
    for _ in 0..3 * knots.len() + 4 {
        let Some(&[below, above]) = last.checked_sub(1).and_then(|first| knots.get(first..)?.first_chunk()) else {
            return energy + gross_slip(element, path, direction, fraction, outer);
        };
        let (slope, lowest) = (above.slope_from(&below, mu), below.shift(mu));
        direction = direction.or_else(|| path.direction_of_slip(mu, slope));
        let Some(slip_slope) = direction else {
            // Nothing slips in this piece: the contact grows, stays, or recedes through it. Rounding may place a piece beyond the
            // size.
            if contact_rate >= 0.0 || end >= lowest {
                return energy;
            }
            fraction = ((lowest - start) / contact_rate).clamp(0.0, 1.0);
            (outer, inner) = (lowest, lowest);
            last -= 1;
            continue;
        };
        if slope == slip_slope {
            // The piece is a slip zone of this direction: the boundary jumps to its inner end.
            inner = inner.min(lowest);
            last -= 1;
            continue;
        }
        let rate = path.rate(slope, slip_slope).min(0.0);
        // Fraction of the path until a distance is covered; infinite if that exceeds the whole path.
        let to = |distance: f64, rate: f64| {
            if rate < 0.0 && distance > rate { (distance.min(0.0) / rate).max(0.0) } else { f64::INFINITY }
        };
        let to_piece_end = to(lowest - inner, rate);
        let to_overtaking = to(inner - outer, contact_rate - rate);
        let step = to_piece_end.min(to_overtaking).min(1.0 - fraction);
        let next_inner = if step == to_piece_end { lowest } else { (inner + rate * step).max(lowest) };
        let next_outer = if step == 1.0 - fraction { end } else { outer + contact_rate * step };
        let slip = SlipPiece { inner: [inner, next_inner], outer: [outer, next_outer.max(next_inner)] };
        energy += mu * (mu - slope * slip_slope.signum()) * slip.integral(element);
        fraction += step;
        (inner, outer) = (next_inner, next_outer);
        if fraction >= 1.0 {
            return energy;
        }
        if step == to_overtaking {
            direction = None;
            outer = inner;
        }
        if step == to_piece_end {
            last -= 1;
        }
    }
    energy
}

/// Gross slip, from a fraction of the path and a size of the contact to the end of the path.
fn gross_slip(element: &Element, path: &StepPath, direction: Option<f64>, fraction: f64, outer: f64) -> f64 {
    let mu = element.friction_coefficient;
    let slip_slope = direction.unwrap_or(mu.copysign(path.displacement));
    let slip = (path.displacement - slip_slope * path.contact_rate()) * slip_slope.signum();
    mu * slip.max(0.0) * (1.0 - fraction) * mean_load(element, [outer, path.shift[1]]).max(0.0)
}

/// The mean of N between two shifts S >= 0.
fn mean_load(element: &Element, [from, to]: [f64; 2]) -> f64 {
    let width = to - from;
    if width == 0.0 {
        return element.load_under(from);
    }
    let (low, high) = (from.min(to), from.max(to));
    let part = |[places, weights]: Block| {
        let (loads, _) = element.loads_at::<false, 4>(&places.map(|t| high - t * (high - low)));
        (Lanes(weights) * Lanes(loads)).sum()
    };
    if 16.0 * width.abs() < distance_to_singularity(element, low, high) {
        return part(PATH_RULE);
    }
    if 16.0 * width.abs() < low {
        // Near the size at which the compliance of a short contact vanishes.
        return LARGEST_RULE.iter().map(|block| part(squared(*block))).sum();
    }
    (element.potential_at_shift(to.max(0.0)) - element.potential_at_shift(from.max(0.0))) / width
}

impl SlipPiece {
    /// `∫∫ (S_b - S) N''(S) dS |dS_c|`.
    ///
    /// The inner integral is the remainder `N(S_b) - N(S_c) - N'(S_c)(S_b - S_c)`. Unless the slip zone is too narrow for this
    /// difference, the mean of the remainder along the path follows from N and N', or by parts from N and M.
    fn integral(&self, element: &Element) -> f64 {
        let [c0, c1] = self.inner;
        let [b0, b1] = self.outer;
        let (growth, swept) = (b1 - b0, c0 - c1);
        if swept <= 0.0 {
            return 0.0;
        }
        let widest = b0.max(b1);
        let width = widest - c1;
        if 2.5 * width < widest {
            let distance_to_singularity = distance_to_singularity(element, c1, widest);
            let rule = |length: f64| gauss_rule(if 16.0 * length < distance_to_singularity { 1 } else { 2 });
            if 1.5 * width < distance_to_singularity {
                return self.integral_of_curvature(element, [rule(swept.max(growth.abs())), rule(width)]);
            }
            if 8.0 * width < widest {
                // A wider zone loses few digits, because N'' is large there.
                let [path_rule, zone_rule] = &rules_near_the_largest_size();
                return self.integral_of_curvature(element, [path_rule, zone_rule]);
            }
        }
        let inner = if 16.0 * swept < distance_to_singularity(element, c1, c0) {
            let [nodes, weights] = PATH_RULE;
            let (loads, slopes) = element.loads_at::<true, 4>(&nodes.map(|node| c0 - node * swept));
            (Lanes(weights) * (Lanes(loads) + Lanes(slopes) * self.width(Lanes(nodes)))).sum()
        } else {
            let at = |s: f64, width: f64| element.load_under(s) * width;
            let ends = at(c0, b0 - c0) - at(c1, b1 - c1);
            ((growth + 2.0 * swept) * mean_load(element, [c0, c1]) + ends) / swept
        };
        swept * (mean_load(element, self.outer) - inner).max(0.0)
    }

    /// Width of the slip zone after a fraction of the segment.
    fn width<const L: usize>(&self, fraction: Lanes<L>) -> Lanes<L> {
        let ([c0, c1], [b0, b1]) = (self.inner, self.outer);
        (b0 - c0) + fraction * ((b1 - b0) + (c0 - c1))
    }

    /// The integral with the remainder as an integral of N'' > 0, free of cancellation: the square of the width of the slip zone
    /// times `∫ t N''(S_b - width t) dt`, t from 0 to 1.
    fn integral_of_curvature(&self, element: &Element, [path_rule, zone_rule]: [&[Block]; 2]) -> f64 {
        let [b0, b1] = self.outer;
        let (mut sum, mut quarter) = (0.0, Curvature::new());
        for [fractions, parts] in path_rule {
            let (edges, widths) = (b0 + Lanes(*fractions) * (b1 - b0), self.width(Lanes(*fractions)));
            let weights = Lanes(*parts) * (widths * widths);
            let mut remainders = Lanes::ZERO;
            for [places, parts] in zone_rule {
                for (t, part) in places.iter().zip(parts) {
                    let curvatures = Lanes(element.four_curvatures(&(edges - *t * widths), &mut quarter));
                    // Rounding may make N'' of a nearly flat contact negative.
                    remainders += (*t * *part) * curvatures.max(0.0);
                }
            }
            sum += (weights * remainders).sum();
        }
        (self.inner[0] - self.inner[1]) * sum
    }
}

/// Rules for the path and for the slip zone near the size at which the compliance of a short contact vanishes. N'' is singular at
/// that size, just beyond the outer end of the zone: the substitution t = z² moves nodes there. As a function of the fraction of
/// the path the integral is then singular just beyond both ends of the path: the fraction z² (3 - 2z) moves nodes to both.
#[cold]
#[inline(never)]
fn rules_near_the_largest_size() -> [[Block; MAX_GAUSS_BLOCKS]; 2] {
    let path_rule = LARGEST_RULE.map(|block| substituted(block, |z| [z * z * (3.0 - 2.0 * z), 6.0 * z * (1.0 - z)]));
    [path_rule, LARGEST_RULE.map(squared)]
}

/// Gauss's rule with the largest number of nodes.
static LARGEST_RULE: [Block; MAX_GAUSS_BLOCKS] = gauss_legendre(MAX_GAUSS_BLOCKS);

/// Gauss's rule with four nodes.
const PATH_RULE: Block = gauss_legendre(1)[0];

/// The rule for `∫ f(t) dt` from one for z and the substitution t(z), given by t and dt/dz.
fn substituted([nodes, weights]: Block, of: impl Fn(f64) -> [f64; 2]) -> Block {
    let mut rule = [[0.0; 4]; 2];
    for k in 0..4 {
        let [t, slope] = of(nodes[k]);
        rule[0][k] = t;
        rule[1][k] = slope * weights[k];
    }
    rule
}

fn squared(block: Block) -> Block {
    substituted(block, |z| [z * z, 2.0 * z])
}

/// Distance of an interval to the singularities of N(S): S = 0 and, where the compliance of a short contact vanishes, at least 0.7
/// % beyond the largest shift.
fn distance_to_singularity(element: &Element, low: f64, high: f64) -> f64 {
    low.min(1.007 * element.largest_shift - high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::parameters;
    use crate::element::{Directions, NormalInput};
    use crate::parameters::{Material, Parameters, RIGID_STRIP};

    #[test]
    fn near_the_largest_size_the_energy_of_a_small_slip_zone_has_no_cancellation() {
        let flat = Parameters { length: 1.3e-3, displacement_reference: RIGID_STRIP, ..parameters(1e-3) };
        let soft = Material { young_modulus: 1.5e9, poisson_ratio: 0.0 };
        let cylinder = Parameters {
            edge_radius: 24e-3,
            length: 0.38e-3,
            normal_force: 4.0,
            material: [soft; 2],
            ..parameters(0.0)
        };
        for short in [flat, cylinder] {
            let element = Element::rounded_flat(&short, Directions::One, NormalInput::Force).unwrap();
            for share in [0.9, 0.99, 0.999] {
                let outer = share * element.largest_shift;
                // A zone that grows from nothing to any width, at once and in parts.
                for (width, growth) in [(0.1, 0.0), (0.12, 0.05), (0.2, -0.02), (0.39, 0.01), (0.39, 0.09), (0.6, 0.05)]
                {
                    let growth = if growth > 0.0 { growth * (1.0 - share) } else { growth };
                    let at = |k: u32| {
                        let fraction = f64::from(k) / 16.0;
                        [outer * (1.0 - width * fraction), outer * (1.0 + growth * fraction)]
                    };
                    let integral = |from: u32, to: u32| {
                        let ([c0, b0], [c1, b1]) = (at(from), at(to));
                        SlipPiece { inner: [c0, c1], outer: [b0, b1] }.integral(&element)
                    };
                    let (whole, parts) = (integral(0, 16), (0..16).map(|k| integral(k, k + 1)).sum::<f64>());
                    // The load has a few roundings over its logarithmic compliance, here down to 0.02, and a wide zone loses six
                    // bits.
                    assert!(
                        (parts / whole - 1.0).abs() < 1e-11,
                        "{share}, {width}, {growth}: {parts:e}, not {whole:e}"
                    );
                }
            }
        }
    }
}
