//! The springs of a diagram: the first step that leaves a line starts from them. The springs of another alignment.

use crate::element::Element;
use crate::one_direction::state;
use crate::two_directions::edge::Edge;
use crate::two_directions::spring_state::SpringState;
use crate::two_directions::springs::{Pressed, Springs, Units};
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

/// Springs from their displacements as functions of direction, node and S: tractions and the edge follow.
fn fill<const N: usize>(springs: &Springs<N>, now: &Pressed, at: impl Fn(usize, usize, f64) -> f64) -> SpringState<N> {
    let mut state = SpringState { edge: Edge::new(springs, now), ..SpringState::RELAXED };
    let last = state.edge.last.min(N - 1);
    for k in 0..2 {
        for j in 0..=last {
            state.v[k][j] = at(k, j, springs.shift[k][j]);
        }
    }
    let q = [state.edge.tractions(springs, 0, &state.v[0]), state.edge.tractions(springs, 1, &state.v[1])];
    for i in 0..=last {
        let (x, y) = (q[0][i] / state.edge.pressure[i], q[1][i] / state.edge.pressure[i]);
        let over = (x * x + y * y).max(1.0).sqrt();
        (state.tractions[0][i], state.tractions[1][i]) = (x / over, y / over);
    }
    state
}

/// The springs of a diagram: their displacements are those of the sizes from theirs on.
pub(super) fn from_diagram<const N: usize>(
    element: &Element,
    springs: &Springs<N>,
    units: &Units,
    header: &Header,
    knots: &[[f64; 4]],
) -> SpringState<N> {
    let mu = element.friction_coefficient;
    let [u, _] = header.displacement;
    let now = header.pressed(element);
    fill(springs, &now, |k, _, shift| {
        if k > 0 {
            return 0.0;
        }
        // P(S) of the polygon; beyond its end the displacement is that of the contact.
        let target = shift * units.shift;
        let mut inner = knots.first().copied().unwrap_or([u, u, 0.0, 0.0]);
        for knot in knots {
            let [xi, eta, ..] = *knot;
            let end = 0.5 * (eta - xi) / mu;
            if end > target {
                let start = 0.5 * (inner[1] - inner[0]) / mu;
                let part = ((target - start) / (end - start).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let position = |knot: &[f64; 4]| 0.5 * (knot[0] - u) + 0.5 * (knot[1] - u);
                return -(position(&inner) + part * (position(knot) - position(&inner))) / (mu * units.shift);
            }
            inner = *knot;
        }
        0.0
    })
}

/// The springs of a state in another alignment: they are corners of a polygon over S.
pub(super) fn realigned<const N: usize>(
    [old_springs, springs]: [&Springs<N>; 2],
    old: &SpringState<N>,
    [old_now, now]: [&Pressed; 2],
    ratio: f64,
) -> SpringState<N> {
    let (first, last) = (old_springs.under_flat, old.edge.last.min(N - 1));
    fill(springs, now, |k, j, shift| {
        if j < first && first == springs.under_flat {
            return ratio * old.v[k][j];
        }
        // In the units before.
        let target = shift / ratio;
        let (mut below, mut above) = ([0.0, old.v[k][first.min(N - 1)]], [old_now.shift[k], 0.0]);
        for j in first..=last {
            let corner = [old_springs.shift[k][j], old.v[k][j]];
            if corner[0] > target {
                above = corner;
                break;
            }
            below = corner;
        }
        let width = above[0] - below[0];
        let part = if width > 0.0 { ((target - below[0]) / width).clamp(0.0, 1.0) } else { 0.0 };
        ratio * (below[1] + part * (above[1] - below[1]))
    })
}
