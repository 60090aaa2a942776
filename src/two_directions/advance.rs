//! A step of a state: of the diagram on a line, of the springs without slip, or of the springs.

use crate::element::Element;
use crate::one_direction::state;
use crate::two_directions::from_diagram::{from_diagram, header_of, realigned};
use crate::two_directions::load_path::advance_springs;
use crate::two_directions::spring_state::{LONGEST, SpringState};
use crate::two_directions::springs::{Both, Springs, TABLES, Units, fill, under_flat};
use crate::two_directions::state::{
    Header, LENGTH, copy_used, line_mut, line_of, move_springs, read_header, state_init, stored, tables, write,
    write_tables,
};
use crate::two_directions::stick::{self, Stuck};
use crate::two_directions::{Requested, Step};

/// A step whose new state is discarded, with a state and a displacement that were checked.
pub(super) fn trial(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
    match element.springs {
        8 => trial_of::<8>(element, old, displacement, requested),
        12 => trial_of::<12>(element, old, displacement, requested),
        _ => trial_of::<16>(element, old, displacement, requested),
    }
}

/// A step in place, with a state and a displacement that were checked.
pub(super) fn advance(element: &Element, state: &mut [f64], displacement: [f64; 3], requested: Requested) -> Step {
    match element.springs {
        8 => advance_of::<8>(element, state, displacement, requested),
        12 => advance_of::<12>(element, state, displacement, requested),
        _ => advance_of::<16>(element, state, displacement, requested),
    }
}

/// The springs of a state are aligned with powers of this ratio times the normal force of the parameters: present loads down to that part
/// of the aligned one are as accurate, and derivatives of a step need none of the alignment.
const LEVEL: f64 = 1.25;

/// The least power: loads that rise to the normal force of the parameters in few steps find nodes.
const LEAST_LEVEL: f64 = -6.0;

/// A load over that of the alignment from which on the springs are aligned anew.
const OUTGROWN: f64 = 1.02;

fn is_aligned(element: &Element, header: &Header, load: f64) -> bool {
    header.belongs_to(element) && load <= OUTGROWN * header.units.load
}

/// The larger load of both ends of a step.
#[inline(never)]
fn largest_load(element: &Element, header: &Header, input: f64) -> f64 {
    if input.to_bits() == header.input.to_bits() || !element.is_closed(input) {
        return header.load;
    }
    header.load.max(element.normal(input).load)
}

fn trial_of<const N: usize>(element: &Element, old: &[f64], displacement: [f64; 3], requested: Requested) -> Step {
    if line_of(old).is_none() {
        let header = read_header(old);
        if is_aligned(element, &header, largest_load(element, &header, displacement[2]))
            && let (Some(stored), Some(springs)) = (stored::<N>(old), tables(&header, old))
        {
            if let Some((step, _)) = without_slip::<N>(element, &header, &springs, old, displacement, requested) {
                return step;
            }
            let mut state = stored.copied();
            return advance_springs(element, &header, &springs, &mut state, displacement, requested).0;
        }
    }
    let mut copy = [0.0; LENGTH];
    copy_used(old, &mut copy);
    advance_of::<N>(element, &mut copy, displacement, requested)
}

fn advance_of<const N: usize>(
    element: &Element,
    state: &mut [f64],
    displacement: [f64; 3],
    requested: Requested,
) -> Step {
    let (from, mut springs) = if let Some(line) = line_of(state) {
        let (v, there) = (state.get(1).copied().unwrap_or(0.0), state::view(line));
        // Without friction, or open before and after, only the position changes.
        let closes = element.is_closed(displacement[2]);
        let free = element.friction_coefficient == 0.0 || (there.load == 0.0 && !closes);
        let on_line = v == displacement[1] || free;
        if on_line && (!requested.tangent || free || !closes) {
            return advance_on_line(element, state, displacement, requested, 0.0);
        }
        let from = header_of(&there, v);
        let from = aligned_state(element, &from, largest_load(element, &from, displacement[2]));
        if on_line {
            let lateral = lateral_stiffness::<N>(element, &from, there.knots, displacement);
            return advance_on_line(element, state, displacement, requested, lateral);
        }
        let from_line = leave_line::<N>(element, state, &from);
        (from, from_line)
    } else {
        let header = read_header(state);
        let load = largest_load(element, &header, displacement[2]);
        if is_aligned(element, &header, load) {
            return advance_of_aligned::<N>(element, state, &header, displacement, requested);
        }
        align::<N>(element, state, &header, load)
    };
    advance_in_place(element, state, &from, &mut springs, displacement, requested)
}

/// The springs of a state on a line, whose tables take the place of the diagram.
#[inline(never)]
fn leave_line<const N: usize>(element: &Element, state: &mut [f64], from: &Header) -> SpringState<N> {
    let mut memory = [0.0; TABLES];
    fill(&mut memory, element, &from.units, 1.0);
    let mut springs = SpringState::RELAXED;
    if let (Some(view), Some(line)) = (Springs::new(from.under_flat, &memory), line_of(state))
        && from.load > 0.0
    {
        springs = from_diagram(element, &view, &from.units, from, state::view(line).knots);
    }
    write_tables(state, &memory);
    springs
}

/// The stiffness along y of a diagram, which has none: that of the springs.
#[inline(never)]
fn lateral_stiffness<const N: usize>(element: &Element, from: &Header, knots: &[[f64; 4]], to: [f64; 3]) -> f64 {
    let mut memory = [0.0; TABLES];
    fill(&mut memory, element, &from.units, 1.0);
    let Some(springs) = Springs::new(from.under_flat, &memory) else { return 0.0 };
    let mut state = SpringState::<N>::RELAXED;
    if from.load > 0.0 {
        state = from_diagram(element, &springs, &from.units, from, knots);
    }
    let (step, _) =
        advance_springs(element, from, &springs, &mut state, to, Requested { tangent: true, energy: false });
    step.tangent[4]
}

/// Of springs that are aligned.
fn advance_of_aligned<const N: usize>(
    element: &Element,
    state: &mut [f64],
    header: &Header,
    displacement: [f64; 3],
    requested: Requested,
) -> Step {
    let Some(springs) = tables(header, state) else { return Step::NONE };
    if let Some((step, offset)) = without_slip::<N>(element, header, &springs, state, displacement, requested) {
        let [u, v, _] = displacement;
        move_springs(state, [u, v], offset);
        return step;
    }
    let Some(mut springs) = stored::<N>(state).map(|stored| stored.copied()) else { return Step::NONE };
    advance_in_place(element, state, header, &mut springs, displacement, requested)
}

fn advance_in_place<const N: usize>(
    element: &Element,
    state: &mut [f64],
    from: &Header,
    springs: &mut SpringState<N>,
    displacement: [f64; 3],
    requested: Requested,
) -> Step {
    let Some(view) = tables(from, state) else { return Step::NONE };
    let (step, to) = advance_springs(element, from, &view, springs, displacement, requested);
    if to.load > 0.0 {
        write(state, &to, springs);
    } else {
        // Separated: the line of the next contact begins here.
        let _ = state_init(state);
        advance_on_line(element, state, displacement, Requested { tangent: false, energy: false }, 0.0);
    }
    step
}

/// The same for a state.
fn aligned_state(element: &Element, header: &Header, load: f64) -> Header {
    // Above 0, whose logarithm is no number.
    let level = (load / (OUTGROWN * element.normal_force)).max(0.1).ln() / LEVEL.ln();
    let level = if level > LEAST_LEVEL { level.ceil() } else { LEAST_LEVEL };
    let load = element.normal_force * LEVEL.powi(level as i32);
    aligned(element, header, load.min(element.largest_load))
}

/// A header with the units of springs that are aligned with a load.
pub(super) fn aligned(element: &Element, header: &Header, load: f64) -> Header {
    let units = Units::of(element, load);
    let under_flat = under_flat(element, &units);
    let size = if header.load > 0.0 { units.size_under(element, header.load) } else { 0.0 };
    Header {
        key: element.key,
        units,
        springs: element.springs,
        under_flat,
        size,
        offset: [0.0; 2],
        sum: [0.0; 2],
        ..*header
    }
}

/// Aligns the springs of a state with a load. Those of another element are relaxed.
#[inline(never)]
fn align<const N: usize>(element: &Element, state: &mut [f64], header: &Header, load: f64) -> (Header, SpringState<N>) {
    let to = aligned_state(element, header, load);
    let mut memory = [0.0; TABLES];
    fill(&mut memory, element, &to.units, 1.0);
    let Some(springs) = Springs::new(to.under_flat, &memory) else { return (to, SpringState::RELAXED) };
    let now = to.pressed(element);
    let mut new = SpringState::RELAXED;
    if header.belongs_to(element)
        && let (Some(stored), Some(old_springs)) = (stored::<N>(state), tables(header, state))
    {
        let mut old = stored.copied();
        stick::settle(&old_springs, &mut old, &header.offset);
        let old_now = header.pressed(element);
        let ratio = header.units.shift / to.units.shift;
        new = realigned([&old_springs, &springs], &old, [&old_now, &now], ratio);
    } else {
        new.edge = super::edge::Edge::new(&springs, &now);
    }
    write_tables(state, &memory);
    (to, new)
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
fn without_slip<const N: usize>(
    element: &Element,
    header: &Header,
    springs: &Springs,
    state: &[f64],
    [u, v, input]: [f64; 3],
    requested: Requested,
) -> Option<(Step, Both<f64>)> {
    if input.to_bits() != header.input.to_bits() {
        return None;
    }
    let per_unit = 1.0 / (element.friction_coefficient * header.units.shift);
    let by = [u - header.displacement[0], v - header.displacement[1]];
    let offset = [header.offset[0] + by[0] * per_unit, header.offset[1] + by[1] * per_unit];
    // Far beyond all limits the squares overflow.
    if offset[0].abs().max(offset[1].abs()) > LONGEST {
        return None;
    }
    let now = header.pressed(element);
    let stuck = stick::stuck(springs, &stored::<N>(state)?, &now, &offset)?;
    Some((step_without_slip(element, header, &stuck, &offset, input, requested)?, offset))
}

/// The step with the offset, unless points at their limits or the sum of all forces slip.
#[inline(never)]
fn step_without_slip(
    element: &Element,
    header: &Header,
    stuck: &Stuck,
    offset: &Both<f64>,
    input: f64,
    requested: Requested,
) -> Option<Step> {
    // Another load makes a point at its limit slip: the derivative is that of a step, and so is the step, whatever is requested.
    if stuck.at_limit {
        return None;
    }
    let Stuck { stiffness: [k_x, k_y], .. } = *stuck;
    let sum = [header.sum[0] + k_x * offset[0], header.sum[1] + k_y * offset[1]];
    let limit = header.load / header.units.load;
    if sum[0] * sum[0] + sum[1] * sum[1] > limit * limit {
        return None;
    }
    let per_unit = 1.0 / (element.friction_coefficient * header.units.shift);
    let unit = element.friction_coefficient * header.units.load;
    let mut step = Step { force: [unit * sum[0], unit * sum[1], header.load], ..Step::NONE };
    if requested.tangent {
        let normal = element.normal(input);
        let slopes = header.units.slopes(element, &normal, header.size);
        step.tangent[8] = normal.load_slope;
        for k in 0..2 {
            step.tangent[4 * k] = unit * stuck.stiffness[k] * per_unit;
            step.tangent[6 + k] = unit * (stuck.per_load[k] * slopes.load + stuck.per_shift[k] * slopes.shift[k]);
        }
    }
    Some(step)
}
