//! The springs of a diagram: the first step that leaves a line starts from them.

use crate::element::Element;
use crate::element::springs::{FINE, SPRINGS};
use crate::one_direction::state;
use crate::two_directions::edge::{Edge, Map};
use crate::two_directions::spring_state::SpringState;
use crate::two_directions::state::Header;

/// The header of a diagram.
pub(super) fn header_of(view: &state::View, v: f64) -> Header {
    Header {
        displacement: [view.displacement, v],
        input: view.input,
        load: view.load,
        shift: view.shift,
        ..Header::NONE
    }
}

/// Writes the springs of a diagram to a relaxed state: their displacements are those of the sizes from theirs on.
pub(super) fn fill_from_diagram(state: &mut SpringState, element: &Element, header: &Header, knots: &[[f64; 4]]) {
    if header.load <= 0.0 {
        return;
    }
    let springs = &element.springs;
    let (unit, now) = (element.shift_unit(), element.pressed(header.load, header.shift));
    let mu = element.friction_coefficient;
    let [u, _] = header.displacement;
    let at = |shift: f64| {
        // P(S) of the polygon; beyond its end the displacement is that of the contact.
        let target = shift * unit;
        let mut inner = knots.first().copied().unwrap_or([u, u, 0.0, 0.0]);
        for knot in knots {
            let [xi, eta, ..] = *knot;
            let end = 0.5 * (eta - xi) / mu;
            if end > target {
                let start = 0.5 * (inner[1] - inner[0]) / mu;
                let part = ((target - start) / (end - start).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let position = |knot: &[f64; 4]| 0.5 * (knot[0] - u) + 0.5 * (knot[1] - u);
                return -(position(&inner) + part * (position(knot) - position(&inner))) / (mu * unit);
            }
            inner = *knot;
        }
        0.0
    };
    let edge = Edge::new(springs, &now, None);
    for j in 0..SPRINGS {
        if j <= edge.last {
            state.springs[0][j] = at(springs.shift[0][j]);
        }
    }
    for j in 0..FINE {
        if springs.fine_shift[0][j] < now.shift[0] {
            state.fine[0][j] = at(springs.fine_shift[0][j]);
        }
    }
    let map = Map::new(springs, &edge);
    let mut scaled = state.springs;
    for j in 0..SPRINGS {
        scaled[0][j] *= map.root[0][j];
    }
    let mut tractions = [[0.0; SPRINGS]; 2];
    map.tractions(&scaled, &[false; SPRINGS], &mut tractions);
    let [tractions, _] = tractions;
    for i in 0..SPRINGS {
        if i <= edge.last {
            state.tractions[0][i] = (tractions[i] / edge.pressure[i]).clamp(-1.0, 1.0);
        }
    }
    (state.shell_pressure, state.pressure) = (edge.shell_pressure, edge.pressure);
}
