//! A step of a state: of the diagram on a line, of the springs without slip, or of the springs.

use crate::element::Element;
use crate::element::springs::Both;
use crate::one_direction::state;
use crate::two_directions::from_diagram::{fill_from_diagram, header_of};
use crate::two_directions::load_path::advance_springs;
use crate::two_directions::slip::product;
use crate::two_directions::spring_state::{LONGEST, SpringState};
use crate::two_directions::state::{
    LENGTH, copy_used, line_mut, line_of, move_springs, read_header, state_init, stored, write,
};
use crate::two_directions::stick::{self, Stuck};
use crate::two_directions::{Requested, Step};

/// A step whose new state is discarded, with a state and a displacement that were checked.
pub(super) fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
    if line_of(old).is_none()
        && let Some((step, _)) = without_slip(element, old, displacement, requested)
    {
        return step;
    }
    let mut copy = [0.0; LENGTH];
    copy_used(old, &mut copy);
    advance(element, &mut copy, displacement, requested)
}

/// A step in place, with a state and a displacement that were checked.
pub(super) fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3], requested: Requested) -> Step {
    // In one place for all cases: it is large.
    let mut springs;
    let from = if let Some(line) = line_of(state) {
        let (v, there) = (state.get(1).copied().unwrap_or(0.0), state::view(line));
        // Without friction, or open before and after, only the position changes.
        let from = header_of(&there, v);
        let closes = element.is_closed(displacement[2]);
        let free = element.friction_coefficient == 0.0 || (there.load == 0.0 && !closes);
        if v == displacement[1] || free {
            // Of the third component, the diagram has no stiffness: that of the springs.
            let lateral = if requested.tangent && !free && closes {
                springs = SpringState::RELAXED;
                fill_from_diagram(&mut springs, element, &from, there.knots);
                let requested = Requested { tangent: true, energy: false };
                advance_springs(element, &from, &mut springs, displacement, requested).0.tangent[4]
            } else {
                0.0
            };
            return advance_on_line(element, state, displacement, requested, lateral);
        }
        springs = SpringState::RELAXED;
        fill_from_diagram(&mut springs, element, &from, there.knots);
        from
    } else {
        if let Some((step, offset)) = without_slip(element, state, displacement, requested) {
            let [u, v, _] = displacement;
            move_springs(state, [u, v], offset);
            return step;
        }
        springs = SpringState::RELAXED;
        if let Some(stored) = stored(state) {
            stored.copy_to(&mut springs);
        }
        read_header(state)
    };
    let (step, to) = advance_springs(element, &from, &mut springs, displacement, requested);
    if to.load > 0.0 {
        write(state, &to, &springs);
    } else {
        // Separated: the line of the next contact begins here.
        let _ = state_init(state);
        advance_on_line(element, state, displacement, Requested { tangent: false, energy: false }, 0.0);
    }
    step
}

/// A step of the diagram, to a v that does not change it; `lateral` is the stiffness along y.
fn advance_on_line(
    element: &Element,
    state: &mut [f64],
    [u, v, input]: [f64; 3],
    requested: Requested,
    lateral: f64,
) -> Step {
    let Some((v_place, line)) = line_mut(state) else { return Step::NONE };
    *v_place = v;
    let step = state::advance_checked(element, line, [u, input], requested.energy);
    let ([x, normal], [xx, _, xw, ww]) = (step.force, step.tangent);
    Step {
        force: [x, 0.0, normal],
        tangent: [xx, 0.0, 0.0, 0.0, lateral, 0.0, xw, 0.0, ww],
        dissipated: step.dissipated,
    }
}

/// A step under the load of the state in which nothing slips, and the offset at its end.
#[inline(always)]
fn without_slip(
    element: &Element,
    state: &[f64],
    [u, v, input]: [f64; 3],
    requested: Requested,
) -> Option<(Step, Both<f64>)> {
    let header = read_header(state);
    if input.to_bits() != header.input.to_bits() {
        return None;
    }
    let per_unit = 1.0 / (element.friction_coefficient * element.shift_unit());
    let by = [u - header.displacement[0], v - header.displacement[1]];
    let offset = [header.offset[0] + by[0] * per_unit, header.offset[1] + by[1] * per_unit];
    // Far beyond all limits the squares overflow.
    if offset[0].abs().max(offset[1].abs()) > LONGEST {
        return None;
    }
    let now = element.pressed_without_size(header.load, header.shift);
    let stuck = stick::stuck(&element.springs, &stored(state)?, &now, &offset)?;
    let Stuck { stiffness: [k_x, k_y], .. } = stuck;
    let sum = [header.sum[0] + k_x * offset[0], header.sum[1] + k_y * offset[1]];
    if product(&sum, &sum) > now.load * now.load {
        return None;
    }
    let unit = element.friction_coefficient * element.normal_force;
    let mut step = Step { force: [unit * sum[0], unit * sum[1], header.load], ..Step::NONE };
    if requested.tangent {
        let normal = element.normal(input);
        let slopes = element.pressed_slopes(&normal);
        step.tangent[8] = normal.load_slope;
        for k in 0..2 {
            step.tangent[4 * k] = unit * stuck.stiffness[k] * per_unit;
            step.tangent[6 + k] = unit * (stuck.per_load[k] * slopes.load + stuck.per_shift[k] * slopes.shift[k]);
        }
    }
    Some((step, offset))
}
