//! The springs of a diagram: the first step that leaves a line starts from them. The springs of another alignment.

use crate::element::Element;
use crate::one_direction::state;
use crate::shape::TINY;
use crate::two_directions::edge::Edge;
use crate::two_directions::spring_state::SpringState;
use crate::two_directions::springs::{Both, Fine, PARTS, Pressed, Springs, Units};
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

/// Tractions over the pressure as a function of N: constant in intervals, given by their upper ends from the smallest on; 0 beyond.
struct Intervals<I> {
    rest: I,
    load: f64,
    upper: f64,
    density: Both<f64>,
}

impl<I: Iterator<Item = (f64, Both<f64>)>> Intervals<I> {
    fn new(rest: I) -> Intervals<I> {
        Intervals { rest, load: 0.0, upper: 0.0, density: [0.0; 2] }
    }

    /// The integral by N from the last load to this one.
    fn force_to(&mut self, load: f64) -> Both<f64> {
        let mut force = [0.0; 2];
        loop {
            let end = load.min(self.upper);
            for k in 0..2 {
                force[k] += self.density[k] * (end - self.load).max(0.0);
            }
            self.load = self.load.max(end);
            if self.upper >= load {
                return force;
            }
            (self.upper, self.density) = self.rest.next().unwrap_or((f64::MAX, [0.0; 2]));
        }
    }
}

/// The displacements of springs, at the first nodes of all shells or at those of all parts of them, that have the force of intervals in
/// each shell or part: the force of a contact remains when its springs are replaced.
fn distribute<const N: usize, I: Iterator<Item = (f64, Both<f64>)>>(
    springs: &Springs<N>,
    edge: &Edge<N>,
    now: &Pressed,
    parts: usize,
    mut intervals: Intervals<I>,
) -> Both<Fine<N>> {
    let (first, last) = (springs.under_flat, edge.last.min(N - 1));
    let mut v = [[[0.0; N]; PARTS]; 2];
    // From inside: the rise of v over a shell. From outside: its sum.
    let nodes = |j: usize| if j == last { parts.min(edge.part + 1) } else { parts };
    let node = |j: usize, r: usize| {
        let (j, r) = if r < nodes(j) { (j, r) } else { (j + 1, 0) };
        if j > last {
            return [now.load, now.shift[0], now.shift[1]];
        }
        [springs.fine_load[r][j], springs.fine_shift[0][r][j], springs.fine_shift[1][r][j]]
    };
    for j in first..=last {
        for r in 0..nodes(j) {
            let ([load, x, y], [upper, upper_x, upper_y]) = (node(j, r), node(j, r + 1));
            let per_load = 1.0 / (upper - load).max(TINY);
            let force = intervals.force_to(upper);
            v[0][r][j] = force[0] * per_load * (upper_x - x);
            v[1][r][j] = force[1] * per_load * (upper_y - y);
        }
    }
    for rows in &mut v {
        let mut sum = 0.0;
        for j in (first..=last).rev() {
            for r in (0..nodes(j)).rev() {
                sum += rows[r][j];
                rows[r][j] = sum;
            }
        }
    }
    v
}

/// The springs of intervals, those of the law and those of the fine correction: tractions and the edge follow.
fn springs_of<const N: usize>(
    springs: &Springs<N>,
    now: &Pressed,
    law: impl Iterator<Item = (f64, Both<f64>)>,
    fine: impl Iterator<Item = (f64, Both<f64>)>,
    under_flat: impl Fn(usize, usize) -> f64,
) -> SpringState<N> {
    let edge = Edge::new(springs, now);
    let (first, last) = (springs.under_flat, edge.last.min(N - 1));
    let [[x, ..], [y, ..]] = distribute(springs, &edge, now, 1, Intervals::new(law));
    let mut v = [x, y];
    for k in 0..2 {
        for j in 0..first {
            v[k][j] = v[k][first] + under_flat(k, j);
        }
    }
    let fine = distribute(springs, &edge, now, PARTS, Intervals::new(fine));
    let mut state = SpringState { v, fine, edge, ..SpringState::RELAXED };
    let q = [state.edge.tractions(springs, 0, &v[0]), state.edge.tractions(springs, 1, &v[1])];
    for i in 0..=last {
        let (x, y) = (q[0][i] / state.edge.pressure[i], q[1][i] / state.edge.pressure[i]);
        let over = (x * x + y * y).max(1.0).sqrt();
        (state.tractions[0][i], state.tractions[1][i]) = (x / over, y / over);
    }
    state
}

/// The springs of a diagram.
pub(super) fn from_diagram<const N: usize>(
    element: &Element,
    springs: &Springs<N>,
    header: &Header,
    knots: &[[f64; 4]],
) -> SpringState<N> {
    let intervals = || {
        knots.array_windows().map(|[[xi, eta, ..], [outer_xi, outer_eta, load, _]]| {
            let (left, right) = (outer_xi - xi, outer_eta - eta);
            (load / header.units.load, [(left + right) / (right - left).max(f64::MIN_POSITIVE), 0.0])
        })
    };
    springs_of(springs, &header.pressed(element), intervals(), intervals(), |_, _| 0.0)
}

/// The springs of a state in another alignment.
pub(super) fn realigned<const N: usize>(
    [old_springs, springs]: [&Springs<N>; 2],
    old: &SpringState<N>,
    [from, to]: [&Units; 2],
    [old_now, now]: [&Pressed; 2],
) -> SpringState<N> {
    let (first, last) = (old_springs.under_flat, old.edge.last.min(N - 1));
    let (per_load, ratio) = (from.load / to.load, from.shift / to.shift);
    let intervals = |parts: usize, v: Both<Fine<N>>| {
        let nodes = move |j: usize| if j == last { parts.min(old.edge.part + 1) } else { parts };
        (first..=last).flat_map(move |j| (0..nodes(j)).map(move |r| (j, r))).map(move |(j, r)| {
            let (upper, r_upper) = if r + 1 < nodes(j) { (j, r + 1) } else { (j + 1, 0) };
            let inside = upper <= last;
            let load = if inside { old_springs.fine_load[r_upper][upper.min(N - 1)] } else { old_now.load };
            let density = [0, 1].map(|k| {
                let at = |shift: &Fine<N>, v: &Fine<N>| {
                    let i = upper.min(N - 1);
                    if inside { [shift[r_upper][i], v[r_upper][i]] } else { [old_now.shift[k], 0.0] }
                };
                let [shift, outer] = at(old_springs.fine_shift[k], &v[k]);
                (v[k][r][j] - outer) / (shift - old_springs.fine_shift[k][r][j]).max(TINY)
            });
            (load * per_load, density)
        })
    };
    let law = old.v.map(|row| {
        let mut rows = [[0.0; N]; PARTS];
        rows[0] = row;
        rows
    });
    let under_flat = |k: usize, j: usize| ratio * (old.v[k][j] - old.v[k][first.min(N - 1)]);
    springs_of(springs, now, intervals(1, law), intervals(PARTS, old.fine), under_flat)
}
