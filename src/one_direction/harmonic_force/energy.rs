//! Energy dissipated along a period: the sum over the steps between its samples.

use crate::element::{Element, Normal};
use crate::one_direction::diagram::{self, Diagram, Knot, Polygon};
use crate::one_direction::harmonic_force::samples::{Part, Samples, at, ranges};
use crate::one_direction::step::{Point, step};

/// Energy \[J\] dissipated in the steps of a part of a period, from the sample at which it starts. The diagram is kept in `knots`, one
/// for each sample and a few more.
#[inline(never)]
pub(super) fn dissipated_in(element: &Element, samples: &Samples, part: &Part, knots: &mut [[f64; 4]]) -> f64 {
    let Part { start, opens, .. } = *part;
    let mut diagram = Polygon::new(element.friction_coefficient, knots.as_flattened_mut(), 0);
    let [displacement, input] = samples.motion(start);
    let normal = if opens { Normal::OPEN } else { element.normal(input) };
    if opens {
        diagram.replace(0, [Knot::centre(displacement)]);
    } else {
        // The steady state at the first sample: the part with D = 0, and slip or gross slip beyond.
        let mu = element.friction_coefficient;
        let shift = at(samples.xi, start).max(-at(samples.eta, start)).min(0.0) / -mu;
        let (load, _) = element.load_at_shift(shift.max(0.0));
        diagram.replace(0, [Knot::centre(0.0)]);
        if shift > 0.0 {
            diagram.replace(1, [Knot { xi: -mu * shift, eta: mu * shift, load, force: 0.0 }]);
        }
        diagram::step(element, &mut diagram, displacement, &normal);
    }
    let mut point = Point { displacement, input, normal, error: 0.0 };
    let mut energy = 0.0;
    // The step to the first sample (or to its counterpart half a period later) is the last.
    for sample in ranges(&Part { start: start + 1, ..*part }, samples.count).into_iter().flatten() {
        let (result, next) = step(element, &point, &mut diagram, samples.motion(sample), true);
        energy += result.dissipated;
        point = next;
    }
    energy
}
