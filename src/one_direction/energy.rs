//! Energy dissipated in a step.
//!
//! Along the straight path from (S0, u0) to (S1, u1), with λ from 0 to 1, the boundary of the slip zone moves inwards at the rate
//! `dS_c/dλ = (Δu - σ mu ΔS)/(D - σ mu)` through a piece D of the old diagram; a falling contact size may overtake it. While it
//! moves from S_c0 to S_c1,
//!
//! ```text
//! E = mu |mu - σD| ∫ H |dN_c| = mu |mu - σD| ∫∫ (S_b - S) N''(S) dS |dS_c|,      S from S_c to S_b,
//! ```
//!
//! because H, the integral of K_t(c) - K_t(s), is K_t(c) times the remainder of N about S_c after its linear term. Exchanging the
//! order leaves one integral of N'' > 0 with a weight that is quadratic in S between the ends of both boundaries: free of
//! cancellation, never negative.

use crate::element::Element;
use crate::numerics::quadrature::gauss_nodes;
use crate::one_direction::diagram::Knot;

/// The path of a step, straight in (S, u).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    pub shift: [f64; 2],
    /// Displacement covered.
    pub displacement: f64,
}

/// A segment of a path: boundaries of the slip zone and of the contact at both of its ends.
#[derive(Debug, Clone, Copy)]
struct Slip {
    inner: [f64; 2],
    outer: [f64; 2],
}

/// Energy \[J\] dissipated from a closed contact with the diagram `knots`, which must not be empty.
#[inline(never)]
pub(crate) fn dissipated(element: &Element, knots: &[[f64; 4]], path: &Path) -> f64 {
    let mu = element.friction_coefficient;
    let [start, end] = path.shift;
    let contact_rate = end - start;
    if contact_rate == 0.0 && path.displacement == 0.0 {
        return 0.0;
    }
    let mut energy = 0.0;
    // Fraction of the path, size of the contact, boundary of the slip zone, and its direction once there is slip.
    let (mut fraction, mut outer, mut inner) = (0.0, start, start);
    let mut direction = None;
    let mut last = knots.len().saturating_sub(1);
    // Each round ends a piece, the slip, or the step.
    for _ in 0..3 * knots.len() + 4 {
        let Some(&[below, above]) = last.checked_sub(1).and_then(|first| knots.get(first..)?.first_chunk()) else {
            return energy + gross_slip(element, path, direction, fraction, outer);
        };
        let (below, above) = (Knot::from(below), Knot::from(above));
        let (slope, lowest) = (above.slope_from(&below, mu), below.shift(mu));
        let rate = |sign: f64| (path.displacement - sign * contact_rate) / (slope - sign);
        let sign = match direction {
            Some(sign) => sign,
            None => {
                let excess = if contact_rate > 0.0 {
                    if path.displacement.abs() <= mu * contact_rate {
                        return energy;
                    }
                    path.displacement
                } else {
                    path.displacement - slope * contact_rate
                };
                let sign = mu.copysign(excess);
                // The edge of a slip zone is faster than the contact size, but for rounding.
                let slips = excess != 0.0 && (slope == sign || contact_rate >= 0.0 || rate(sign) < contact_rate);
                if !slips {
                    // The contact recedes through the piece without slip, or stays; rounding may place a piece beyond its size.
                    if end >= lowest || contact_rate == 0.0 {
                        return energy;
                    }
                    fraction = ((lowest - start) / contact_rate).clamp(0.0, 1.0);
                    (outer, inner) = (lowest, lowest);
                    last -= 1;
                    continue;
                }
                direction = Some(sign);
                sign
            }
        };
        if slope == sign {
            // In slip in this direction already: the boundary jumps to the end of the piece.
            inner = inner.min(lowest);
            last -= 1;
            continue;
        }
        let rate = rate(sign).min(0.0);
        // Fraction until a distance is covered, if that is within a step.
        let to = |distance: f64, rate: f64| {
            if rate < 0.0 && distance > rate { (distance.min(0.0) / rate).max(0.0) } else { f64::INFINITY }
        };
        let to_piece_end = to(lowest - inner, rate);
        let to_overtaking = to(inner - outer, contact_rate - rate);
        let step = to_piece_end.min(to_overtaking).min(1.0 - fraction);
        let next_inner = if step == to_piece_end { lowest } else { (inner + rate * step).max(lowest) };
        let next_outer = if step == 1.0 - fraction { end } else { outer + contact_rate * step };
        let slip = Slip { inner: [inner, next_inner], outer: [outer, next_outer.max(next_inner)] };
        energy += mu * (mu - slope * sign.signum()) * slip.integral(element);
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
fn gross_slip(element: &Element, path: &Path, direction: Option<f64>, fraction: f64, outer: f64) -> f64 {
    let mu = element.friction_coefficient;
    let contact_rate = path.shift[1] - path.shift[0];
    let sign = direction.unwrap_or(mu.copysign(path.displacement));
    let slip = (path.displacement - sign * contact_rate) * sign.signum();
    // Mean of N along the remaining path.
    let (low, high) = (outer.min(path.shift[1]), outer.max(path.shift[1]));
    let mean = if low == high {
        element.load_at_shift(outer).0
    } else if is_wide(low, high) {
        (element.potential_at_shift(high) - element.potential_at_shift(low.max(0.0))) / (high - low)
    } else {
        quadrature(element, low, high, |s| element.load_at_shift(s).0) / (high - low)
    };
    mu * slip.max(0.0) * (1.0 - fraction) * mean.max(0.0)
}

impl Slip {
    /// `∫∫ (S_b - S) N''(S) dS |dS_c|`.
    fn integral(&self, element: &Element) -> f64 {
        let [inner_start, inner_end] = self.inner;
        let [outer_start, outer_end] = self.outer;
        let swept = inner_start - inner_end;
        if swept <= 0.0 {
            return 0.0;
        }
        let growth = outer_end - outer_start;
        let weight = |s: f64| {
            let mut from = (inner_start - s).max(0.0) / swept;
            let mut to: f64 = 1.0;
            if growth < 0.0 && s > outer_end {
                to = (s - outer_start) / growth;
            } else if growth > 0.0 && s > outer_start {
                from = from.max((s - outer_start) / growth);
            }
            let middle = outer_start + growth * 0.5 * (from + to);
            swept * (to - from).max(0.0) * (middle - s).max(0.0)
        };
        // inner_end is the smallest and inner_start <= outer_start; outer_end may lie anywhere above inner_end.
        let (low, high) = (outer_start.min(outer_end), outer_start.max(outer_end));
        let (first, second) = (inner_start.min(low), inner_start.max(low));
        // Between the boundaries of the slip zone and of the contact the weight is linear.
        integral_between(element, [inner_end, first], false, weight)
            + integral_between(element, [first, second], inner_start <= low, weight)
            + integral_between(element, [second, high], false, weight)
    }
}

/// `∫ W N'' dS` for a quadratic or linear W: exactly by parts if the interval is wide, otherwise by Gauss-Legendre quadrature of the
/// positive integrand.
#[inline(never)]
fn integral_between(element: &Element, [low, high]: [f64; 2], linear: bool, weight: impl Fn(f64) -> f64) -> f64 {
    let width = high - low;
    if width <= 0.0 {
        return 0.0;
    }
    if !is_wide(low, high) {
        // Rounding may make N'' of a nearly flat contact negative.
        return quadrature(element, low, high, |s| weight(s) * element.curvature_at_shift(s).max(0.0));
    }
    let (first, last) = (weight(low), weight(high));
    // width² may underflow.
    let second = if linear { 0.0 } else { 4.0 * (first - 2.0 * weight(low + 0.5 * width) + last) / width / width };
    let slope = (last - first) / width;
    let at = |s: f64, value: f64, slope: f64| {
        let (load, load_slope) = element.load_at_shift(s);
        let potential = if linear { 0.0 } else { element.potential_at_shift(s) };
        load_slope * value - load * slope + potential * second
    };
    (at(high, last, slope + 0.5 * second * width) - at(low, first, slope - 0.5 * second * width)).max(0.0)
}

/// Whether differences over an interval lose at most two binary digits.
fn is_wide(low: f64, high: f64) -> bool {
    high - low > 0.25 * high
}

/// Gauss-Legendre quadrature over an interval that is not wide, of an integrand that is singular at S = 0 and, where the compliance of a
/// short contact vanishes, at least 0.7 % beyond the largest shift. With n nodes the error is of the order ρ^(-2n), where ρ is 14 if
/// the interval is a quarter of the distance to a singularity, and 62 if it is a sixteenth: below the rounding of the sum.
fn quadrature(element: &Element, low: f64, high: f64, integrand: impl Fn(f64) -> f64) -> f64 {
    // Parts that grow towards 0.007 of the largest shift: fewer than 20.
    const PARTS: usize = 32;
    let (mut sum, mut from) = (0.0, low);
    for _ in 0..PARTS {
        let distance_to_end = high.min(1.007 * element.largest_shift - from);
        let width = (high - from).min(0.25 * distance_to_end);
        let nodes = gauss_nodes(if width < 0.0625 * distance_to_end { 1 } else { 2 });
        sum += width * nodes.map(|(node, part)| part * integrand(from + node * width)).sum::<f64>();
        if width >= high - from {
            break;
        }
        from += width;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::parameters;
    use crate::element::{Directions, NormalInput};
    use crate::parameters::{Parameters, RIGID_STRIP};

    #[test]
    fn near_the_largest_size_the_energy_of_a_small_slip_zone_has_no_cancellation() {
        let short = Parameters { length: 1.3e-3, displacement_reference: RIGID_STRIP, ..parameters(1e-3) };
        let element = Element::rounded_flat(&short, Directions::One, NormalInput::Force).unwrap();
        for share in [0.9, 0.99, 0.999] {
            let outer = share * element.largest_shift;
            // Two sizes whose curvature differs little: N'' may be taken out of the integral up to the square of their distance.
            let swept = 1e-4 * (element.largest_shift * 1.007 - outer);
            let slip = Slip { inner: [outer, outer - swept], outer: [outer, outer] };
            let expected = element.curvature_at_shift(outer - 0.5 * swept) * swept.powi(3) / 6.0;
            let found = slip.integral(&element);
            assert!((found / expected - 1.0).abs() < 1e-8, "{share}: {found:e}, not {expected:e}");
            // A wider one at once and in two parts.
            let [start, middle, end] = [outer, 0.999 * outer, 0.998 * outer];
            let integral = |from, to| Slip { inner: [from, to], outer: [outer, outer] }.integral(&element);
            let (whole, parts) = (integral(start, end), integral(start, middle) + integral(middle, end));
            assert!((parts / whole - 1.0).abs() < 1e-12, "{share}: {parts:e}, not {whole:e}");
        }
    }
}
