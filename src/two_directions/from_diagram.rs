//! The springs of a diagram: the first step that leaves a line starts from them. The springs of another alignment.

use crate::element::Element;
use crate::one_direction::state;
use crate::two_directions::edge::Edge;
use crate::two_directions::spring_state::SpringState;
use crate::two_directions::springs::{PARTS, Pressed, Springs, Units};
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

/// Springs from their displacements as functions of direction, node and S, those of the law and those of the fine correction: tractions
/// and the edge follow.
fn fill<const N: usize>(
    springs: &Springs,
    now: &Pressed,
    law: impl Fn(usize, usize, f64) -> f64,
    fine: impl Fn(usize, f64) -> f64,
) -> SpringState<N> {
    let mut state = SpringState { edge: Edge::new(springs, now), ..SpringState::RELAXED };
    for k in 0..2 {
        for j in 0..=state.edge.last.min(N - 1) {
            state.v[k][j] = law(k, j, springs.shift[k][j]);
            for r in 0..PARTS {
                if j >= springs.under_flat && (j < state.edge.last || r <= state.edge.part) {
                    state.fine[k][r][j] = fine(k, springs.fine_shift[k][r][j]);
                }
            }
        }
    }
    let q = [state.edge.tractions(springs, 0, &state.v[0]), state.edge.tractions(springs, 1, &state.v[1])];
    for i in 0..=state.edge.last.min(N - 1) {
        let (x, y) = (q[0][i] / state.edge.pressure[i], q[1][i] / state.edge.pressure[i]);
        let over = (x * x + y * y).max(1.0).sqrt();
        (state.tractions[0][i], state.tractions[1][i]) = (x / over, y / over);
    }
    state
}

/// The springs of a diagram: their displacements are those of the sizes from theirs on.
pub(super) fn from_diagram<const N: usize>(
    element: &Element,
    springs: &Springs,
    units: &Units,
    header: &Header,
    knots: &[[f64; 4]],
) -> SpringState<N> {
    let mu = element.friction_coefficient;
    let [u, _] = header.displacement;
    let now = header.pressed(element);
    let at = |k: usize, shift: f64| {
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
                let place = (position(&inner) + part * (position(knot) - position(&inner))) / (mu * units.shift);
                // Far from the origin the rounding of positions exceeds the limits.
                let limit = (now.shift[0] - shift).max(0.0);
                return -place.min(limit).max(-limit);
            }
            inner = *knot;
        }
        0.0
    };
    fill(springs, &now, |k, _, shift| at(k, shift), at)
}

/// The springs of a state in another alignment: the fine springs are the corners of a polygon over S, and so are the differences of those of
/// the law from them.
pub(super) fn realigned<const N: usize>(
    [old_springs, springs]: [&Springs; 2],
    old: &SpringState<N>,
    [old_now, now]: [&Pressed; 2],
    ratio: f64,
) -> SpringState<N> {
    let (first, last) = (old_springs.under_flat.min(N - 1), old.edge.last.min(N - 1));
    let between = |below: [f64; 2], above: [f64; 2], target: f64| {
        let width = above[0] - below[0];
        let part = if width > 0.0 { ((target - below[0]) / width).clamp(0.0, 1.0) } else { 0.0 };
        below[1] + part * (above[1] - below[1])
    };
    // Bounds that are news to the compiler only, which then checks no index.
    let polygon = |k: usize, target: f64, parts: usize, value: &dyn Fn(usize, usize) -> f64| {
        let (k, parts) = (k.min(1), parts.min(PARTS));
        let mut below = [0.0, value(first, 0)];
        for j in first..=last {
            for r in 0..if j == last { parts.min(old.edge.part + 1) } else { parts } {
                let corner = [old_springs.fine_shift[k][r][j.min(N - 1)], value(j, r)];
                if corner[0] > target {
                    return between(below, corner, target);
                }
                below = corner;
            }
        }
        between(below, [old_now.shift[k], 0.0], target)
    };
    let of_fine = |k: usize, j: usize, r: usize| old.fine[k.min(1)][r.min(PARTS - 1)][j.min(N - 1)];
    let of_law = |k: usize, j: usize| old.v[k.min(1)][j.min(N - 1)];
    let fine = |k: usize, shift: f64| ratio * polygon(k, shift / ratio, PARTS, &|j, r| of_fine(k, j, r));
    let law = |k: usize, j: usize, shift: f64| {
        if j < first && first == springs.under_flat {
            return ratio * of_law(k, j);
        }
        fine(k, shift) + ratio * polygon(k, shift / ratio, 1, &|j, _| of_law(k, j) - of_fine(k, j, 0))
    };
    fill(springs, now, law, fine)
}
