//! A step from the current displacement and its diagram; the contact may open or close in it.

use crate::element::{Element, NormalState};
use crate::law::{LawStep, StepResult};
use crate::one_direction::OneDirection;
use crate::one_direction::diagram::{self, Diagram, Knot};
use crate::one_direction::energy::{self, StepPath};

/// The point from which a step starts, as the header of a state stores it: displacements, normal state, and the bound on the error
/// of the force from merged pieces.
#[derive(Clone, Copy)]
pub(crate) struct StepStart {
    pub displacement: f64,
    pub input: f64,
    pub normal: NormalState,
    pub error: f64,
}

/// Where a straight path crosses zero load.
pub(crate) struct Crossing {
    pub displacement: f64,
    /// Fractions of the path before and after the crossing: the derivatives of its displacement by those of the end and of the
    /// start of the path.
    pub before: f64,
    pub after: f64,
    /// Change of the displacement along the path over the change of the approach. It is 0 with the normal force as input, where the
    /// crossing is at the open end of the path.
    pub slope: f64,
}

impl Crossing {
    /// The crossing between two displacements, of which one closes the contact.
    pub fn between(element: &Element, [u0, w0]: [f64; 2], [u1, w1]: [f64; 2]) -> Crossing {
        let before = element.crossing(w0, w1);
        let displacement = u0 + before * (u1 - u0);
        if !element.by_approach() {
            return Crossing { displacement, before, after: 1.0 - before, slope: 0.0 };
        }
        let distance = w1 - w0;
        Crossing { displacement, before, after: w1 / distance, slope: (u1 - u0) / distance }
    }
}

/// A step to a displacement that was checked, from a point and its diagram. Returns the step and the new point.
pub(crate) fn step(
    element: &Element,
    from: &StepStart,
    diagram: &mut impl Diagram,
    [displacement, input]: [f64; 2],
    with_energy: bool,
) -> (LawStep<OneDirection>, StepStart) {
    if !(element.is_closed(input) && from.normal.load > 0.0 && element.friction_coefficient > 0.0) {
        return opening_or_closing(element, from, diagram, [displacement, input], with_energy);
    }
    let moves = input.to_bits() != from.input.to_bits();
    // Inlined, unlike `Element::normal`: the call would take some per cent of a step.
    let normal = if moves { NormalState::from(element.normals::<true, 1>(&[input])) } else { from.normal };
    let dissipated = if with_energy {
        let shift = [from.normal.shift, normal.shift];
        energy::dissipated(
            element,
            diagram.knots(),
            &StepPath { shift, displacement: displacement - from.displacement },
        )
    } else {
        0.0
    };
    let [force, by_displacement, by_input] = diagram::step(element, diagram, displacement, &normal);
    let tangent = [by_displacement, 0.0, by_input, normal.load_slope];
    let step = StepResult { force: [force, normal.load], tangent, dissipated };
    (step, StepStart { displacement, input, normal, error: from.error })
}

/// A step from or to an open contact, or without friction: the diagram starts anew.
#[inline(never)]
fn opening_or_closing(
    element: &Element,
    from: &StepStart,
    diagram: &mut impl Diagram,
    [displacement, input]: [f64; 2],
    with_energy: bool,
) -> (LawStep<OneDirection>, StepStart) {
    let friction = element.friction_coefficient > 0.0;
    let (was_closed, closed) = (from.normal.load > 0.0, element.is_closed(input));
    let normal = if closed { element.normal(input) } else { NormalState::OPEN };
    let to = StepStart { displacement, input, normal, error: 0.0 };
    let mut step =
        StepResult { force: [0.0, normal.load], tangent: [0.0, 0.0, 0.0, normal.load_slope], dissipated: 0.0 };
    if !closed || !friction {
        if with_energy && was_closed && friction {
            let end = Crossing::between(element, [from.displacement, from.input], [displacement, input.min(0.0)]);
            let path = StepPath { shift: [from.normal.shift, 0.0], displacement: end.displacement - from.displacement };
            step.dissipated = energy::dissipated(element, diagram.knots(), &path);
        }
        diagram.replace(0, [Knot::centre(displacement)]);
        return (step, to);
    }
    let start = [from.displacement, from.input.min(0.0)];
    let crossing = Crossing::between(element, start, [displacement, input]);
    let centre = Knot::centre(crossing.displacement);
    let mut touching = Touching { knots: [centre], sticks: false, diagram };
    if with_energy {
        let path = StepPath { shift: [0.0, normal.shift], displacement: displacement - crossing.displacement };
        step.dissipated = energy::dissipated(element, &touching.knots, &path);
    }
    let [force, mut by_displacement, mut by_input] = diagram::step(element, &mut touching, displacement, &normal);
    if touching.sticks {
        // The displacement at which the contact closes, and sticks, moves with the end of the path.
        by_input += by_displacement * crossing.slope * crossing.before;
        by_displacement *= crossing.after;
    }
    step.force[0] = force;
    (step.tangent[0], step.tangent[2]) = (by_displacement, by_input);
    (step, to)
}

/// The diagram of a contact that has just closed: one knot, which is not yet stored in the diagram of the state.
struct Touching<'a, D> {
    knots: [Knot; 1],
    /// Whether the contact sticks to the displacement at which it closed.
    sticks: bool,
    diagram: &'a mut D,
}

impl<D: Diagram> Diagram for Touching<'_, D> {
    fn knots(&self) -> &[Knot] {
        &self.knots
    }

    fn replace<const N: usize>(&mut self, kept: usize, new: [Knot; N]) {
        self.sticks = kept > 0;
        match new[..] {
            [end] if self.sticks => self.diagram.replace(0, [self.knots[0], end]),
            _ => self.diagram.replace(0, new),
        }
    }
}
