//! Energy dissipated along a period: the sum over its steps.

use crate::varying_load::diagram::{self, Diagram, Knot};
use crate::varying_load::element::{Element, Normal};
use crate::varying_load::energy::{Path, dissipated};
use crate::varying_load::harmonic_force::samples::{Part, Samples, at, ranges};
use crate::varying_load::harmonic_force::walk::closing;

/// The diagram, in the memory of the workspace.
struct Polygon<'a> {
    knots: &'a mut [[f64; 4]],
    count: usize,
}

impl Polygon<'_> {
    fn restart<const N: usize>(&mut self, knots: [Knot; N]) {
        self.replace(0, knots);
    }
}

impl Diagram for Polygon<'_> {
    fn knots(&self) -> &[[f64; 4]] {
        self.knots.get(..self.count).unwrap_or(self.knots)
    }

    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]) {
        self.count = kept;
        for knot in new {
            if let Some(place) = self.knots.get_mut(self.count) {
                *place = knot.into();
                self.count += 1;
            }
        }
    }
}

/// The centre at no displacement.
const CENTRE: Knot = Knot::centre(0.0);

/// Energy \[J\] dissipated in the steps of a part of a period, from the sample at which it starts.
#[inline(never)]
pub(super) fn dissipated_in(element: &Element, samples: &Samples, part: &Part, knots: &mut [[f64; 4]]) -> f64 {
    let mu = element.friction_coefficient;
    let normal = |sample| Normal {
        load: at(samples.load, sample),
        shift: at(samples.shift, sample),
        load_slope: at(samples.load_slope, sample),
        shift_slope: at(samples.shift_slope, sample),
    };
    let mut diagram = Polygon { knots, count: 0 };
    let [xi, eta] = [at(samples.xi, part.start), at(samples.eta, part.start)];
    if part.opens {
        diagram.restart([Knot::centre(at(samples.displacement, part.start))]);
    } else {
        // The steady state at the first sample: the part with D = 0, and slip or gross slip beyond.
        let shift_without_slip = xi.max(-eta).min(0.0) / -mu;
        let (load, _) = element.load_at_shift(shift_without_slip.max(0.0));
        let core = Knot { xi: -mu * shift_without_slip, eta: mu * shift_without_slip, load, force: 0.0 };
        let knots = [CENTRE, core];
        if shift_without_slip > 0.0 {
            diagram.restart(knots);
        } else {
            diagram.restart([knots[0]]);
        }
        diagram::step(element, &mut diagram, at(samples.displacement, part.start), &normal(part.start));
    }
    // All steps of the part, the one to its first sample (or its counterpart half a period later) last.
    let [first, second] = ranges(&Part { start: part.start + 1, ..*part }, samples.count);
    let mut energy = 0.0;
    for sample in first.chain(second) {
        let before = samples.before(sample);
        let displacement = at(samples.displacement, sample);
        let (open, was_open) = (samples.is_open(sample), samples.is_open(before));
        let shift_before = if was_open { 0.0 } else { at(samples.shift, before) };
        if open {
            if !was_open {
                let start = at(samples.displacement, before);
                let end = opening(element, samples, before, sample);
                let path = Path { shift: [shift_before, 0.0], displacement: end - start };
                energy += dissipated(element, diagram.knots(), &path);
            }
            diagram.restart([Knot::centre(displacement)]);
            continue;
        }
        let start = if was_open {
            let start = closing(samples, element.by_approach(), sample).displacement;
            diagram.restart([Knot::centre(start)]);
            start
        } else {
            at(samples.displacement, before)
        };
        let path = Path { shift: [shift_before, at(samples.shift, sample)], displacement: displacement - start };
        energy += dissipated(element, diagram.knots(), &path);
        diagram::step(element, &mut diagram, displacement, &normal(sample));
    }
    energy
}

/// Displacement at which the path from a closed to an open sample opens the contact.
fn opening(element: &Element, samples: &Samples, before: usize, sample: usize) -> f64 {
    let [u0, u1] = [before, sample].map(|sample| at(samples.displacement, sample));
    let [w0, w1] = [before, sample].map(|sample| at(samples.input, sample));
    if element.by_approach() { u0 + w0 / (w0 - w1) * (u1 - u0) } else { u1 }
}
