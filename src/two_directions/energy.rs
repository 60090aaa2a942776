//! Energy that a step dissipates.

use super::nodes::{Nodes, PerAxis, by_axis};
use super::path::ContactPath;
use super::shells::ScaledNormalState;
use super::step::{Displacements, LoadedContact, SMALLEST_LENGTH, SolvedStep};
use crate::numerics::guard::{TINY, quotient, root};

/// Energy that the springs dissipate in a step: the sum of k times slip times the mean displacement over the springs,
/// without that at the edge.
///
/// A spring contributes `k (v_c + v)·(v* - v)/2`. v_c is the first point of the straight path from v_0 to v* with |v| =
/// m l: the limit moves evenly from its value at the start to that at the end, and m = |v|/l at the end of the
/// step, less than 1 if neighbours turn the tractions. Towards gross slip v_c is blended, by `gross_slip`, with v: the
/// spring slips in its final direction from the beginning.
#[inline(never)]
pub(crate) fn dissipated(
    nodes: &Nodes,
    [from, to]: [&LoadedContact; 2],
    path: &ContactPath,
    solved: &SolvedStep,
    new: &Displacements,
) -> f64 {
    let mut energy = if to.normal.shift[0] < from.normal.shift[0] {
        separated(nodes, from, &to.normal, path.displacement, &solved.old)
    } else {
        0.0
    };
    if solved.slips.iter().any(|slip| slip.points.set != 0) || solved.gross_slip > 0.0 {
        let limits = to.limits(nodes);
        let follow = &solved.follow;
        for j in to.shells.range() {
            let per_limit = by_axis(|axis| 1.0 / limits[axis][j].max(SMALLEST_LENGTH));
            let limit_ratio = (from.normal.shift[0] - nodes.shift[0][j]).max(0.0) * per_limit[0];
            let old = by_axis(|axis| solved.old.v[axis][j] * per_limit[axis]);
            let trial = by_axis(|axis| follow[axis][j] * per_limit[axis]);
            let end = by_axis(|axis| new.v[axis][j] * per_limit[axis]);
            let (change, limit_drop) = ([trial[0] - old[0], trial[1] - old[1]], limit_ratio - 1.0);
            let m_squared = end[0] * end[0] + end[1] * end[1];
            // |v|² = m² l² along the path: a quadratic equation.
            let part = first_exceedance(
                change[0] * change[0] + change[1] * change[1] - m_squared * limit_drop * limit_drop,
                old[0] * change[0] + old[1] * change[1] + m_squared * limit_ratio * limit_drop,
                old[0] * old[0] + old[1] * old[1] - m_squared * limit_ratio * limit_ratio,
            );
            for axis in 0..2 {
                let v = new.v[axis][j];
                let leaves = solved.old.v[axis][j] + part * (follow[axis][j] - solved.old.v[axis][j]);
                let leaves = leaves + solved.gross_slip * ((limit_ratio - limit_drop * part) * v - leaves);
                energy += 0.5 * solved.end_springs.stiffness[axis][j] * (leaves + v) * (follow[axis][j] - v);
            }
        }
    }
    energy.max(0.0)
}

/// Energy of springs that lose contact in a step to a lower load: each slips from where it reaches its limit to
/// nothing. Its limit falls to 0 within the part `limit/limit_drop` of the motion.
pub(crate) fn separated(
    nodes: &Nodes,
    from: &LoadedContact,
    now: &ScaledNormalState,
    displacement: PerAxis<f64>,
    old: &Displacements,
) -> f64 {
    let mut energy = 0.0;
    let limit_drop = by_axis(|axis| from.normal.shift[axis] - now.shift[axis]);
    let limits = from.limits(nodes);
    let stiffness = by_axis(|axis| from.shells.stiffness(axis, &quotient(1.0, from.shells.delta_shift[axis])));
    for j in from.shells.range() {
        if now.load > 0.0 && nodes.shift[0][j] < now.shift[0] {
            continue;
        }
        let limit = by_axis(|axis| limits[axis][j].max(SMALLEST_LENGTH));
        let in_contact = by_axis(|axis| limit[axis] / limit_drop[axis].max(limit[axis]) * displacement[axis]);
        let v = by_axis(|axis| old.v[axis][j]);
        let (x, y, dx, dy) = (v[0] / limit[0], v[1] / limit[1], in_contact[0] / limit[0], in_contact[1] / limit[1]);
        let part = first_exceedance(dx * dx + dy * dy - 1.0, x * dx + y * dy + 1.0, x * x + y * y - 1.0);
        for axis in 0..2 {
            let leaves = v[axis] + part * in_contact[axis];
            energy += 0.5 * stiffness[axis][j] * leaves * ((1.0 - part) * in_contact[axis] + leaves);
        }
    }
    energy.max(0.0)
}

/// The first x in [0, 1] at which `a x² + 2 b x + c` becomes positive; otherwise 1.
fn first_exceedance(a: f64, b: f64, c: f64) -> f64 {
    let root = root(b * b - a * c);
    // Quotients are at most 1 by their divisors: others may overflow.
    let fraction = |x: f64, divisor: f64| x.max(TINY) / divisor.max(x.max(TINY));
    let outwards = if c < 0.0 { fraction(-c, b + root) } else { 0.0 };
    let inwards = if a > 0.0 { fraction(root - b, a) } else { 1.0 };
    (if b >= 0.0 { outwards } else { inwards }).max(0.0)
}
