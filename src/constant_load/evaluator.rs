//! Evaluation of the monotonic curve at a displacement: force and tangent stiffness, from the interpolant if possible.
//!
//! If there is no interpolant, next to gross slip, for Λ near 0, or with a layer
//! that bends the curve strongly, the stick zone is found by iteration.

use crate::constant_load::contact::Contact;
use crate::constant_load::interpolant::{END_OF_PIECES, Interval, last_root_of, root_of};
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::values_and_slopes;
use crate::numerics::total::Total;
use crate::shape::Complement;

/// Force \[N\] and tangent stiffness \[N/m\] at a displacement.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Response {
    pub force: f64,
    pub stiffness: f64,
}

pub(super) fn sign_of(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

/// Values behind those that are evaluated, so that whole blocks of four can be read and written from any value on.
pub(crate) const BEYOND: usize = 6;

impl Contact {
    /// Force and stiffness at a displacement >= 0; beyond that of gross slip mu N and 0, and 0 and 0 without friction.
    pub(crate) fn response(&self, displacement: f64) -> Response {
        self.interpolated(displacement).unwrap_or_else(|| self.solved_response(displacement))
    }

    /// Force and stiffness at displacements of either sign.
    pub(crate) fn responses(&self, displacement: &[f64], force: Option<&mut [f64]>, stiffness: Option<&mut [f64]>) {
        if force.is_none() && stiffness.is_none() {
            return;
        }
        let mut forces = force.unwrap_or(&mut []).iter_mut();
        let mut stiffnesses = stiffness.unwrap_or(&mut []).iter_mut();
        for &displacement in displacement {
            let Response { force, stiffness } = self.response(displacement.abs());
            forces.next().into_iter().for_each(|place| *place = sign_of(displacement) * force);
            stiffnesses.next().into_iter().for_each(|place| *place = stiffness);
        }
    }

    /// Force and stiffness from the stick zone, without the interpolant.
    #[cold]
    #[inline(never)]
    fn solved_response(&self, displacement: f64) -> Response {
        if self.is_frictionless() {
            return Response { force: 0.0, stiffness: 0.0 };
        }
        let zone = self.stick_zone_at_displacement(displacement);
        Response { force: self.force_of(&zone), stiffness: self.stiffness_of(&zone) }
    }
}

/// The polynomial on which a displacement is, for integrals: near gross slip one that the force has not.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Inner,
    Outer(Interval),
    Last(Interval),
}

/// Four values from an index on.
fn block(values: &[f64], first: usize) -> Option<&[f64; 4]> {
    values.get(first..first + 4)?.first_chunk()
}

/// Number of leading values, the first included, for which a condition holds that is monotone: seldom fewer than all.
fn leading(values: &[f64; 4], condition: impl Fn(f64) -> bool) -> usize {
    let [_, second, third, fourth] = *values;
    if condition(fourth) { 4 } else { 1 + usize::from(condition(second)) + usize::from(condition(third)) }
}

/// Stores results from an index on.
fn store<const STIFFNESS: bool>(
    forces: &mut [f64],
    stiffnesses: &mut [f64],
    first: usize,
    force: [f64; 4],
    stiffness: [f64; 4],
) {
    let put = |values: &mut [f64], block: [f64; 4]| {
        if let Some(place) = values.get_mut(first..first + 4).and_then(|rest| rest.first_chunk_mut()) {
            *place = block;
        }
    };
    put(forces, force);
    if STIFFNESS {
        put(stiffnesses, stiffness);
    }
}

impl Contact {
    /// [`Contact::response`]; `None` if there is no interpolant at this displacement.
    pub(crate) fn interpolated(&self, displacement: f64) -> Option<Response> {
        let remaining = self.slip_displacement - displacement;
        if remaining < 0.0 {
            return Some(Response { force: self.slip_force, stiffness: 0.0 });
        }
        if !self.interpolant().is_converged() {
            return None;
        }
        let (Lanes([force]), Lanes([stiffness])) = if displacement * self.inner_scale <= 1.0 {
            self.inner::<1, true>(Lanes([displacement]))
        } else {
            let v = root_of(remaining * self.outer_scale);
            let interval = Interval::new(v);
            if !interval.is_covered() {
                return None;
            }
            self.outer::<1, true>(interval, Lanes([v]))
        };
        Some(Response { force, stiffness })
    }

    /// Forces, and stiffnesses if requested, at rising displacements up to that of gross slip, with the same bits as at one. Four are
    /// evaluated at once: the arrays have at least [`BEYOND`] more values than the `count` displacements, those of displacements not
    /// below the last; `roots` is scratch memory.
    pub(crate) fn along<const STIFFNESS: bool>(
        &self,
        count: usize,
        displacement: &[f64],
        roots: &mut [f64],
        forces: &mut [f64],
        stiffnesses: &mut [f64],
    ) {
        let mut next = 0;
        if self.interpolant().is_converged() {
            while next < count
                && let Some(x) = block(displacement, next)
                && x[0] * self.inner_scale <= 1.0
            {
                let (force, stiffness) = self.inner::<4, STIFFNESS>(Lanes(*x));
                store::<STIFFNESS>(forces, stiffnesses, next, force.0, stiffness.0);
                next += leading(x, |x| x * self.inner_scale <= 1.0);
            }
            if let (Some(roots), Some(displacement)) = (roots.get_mut(next..), displacement.get(next..)) {
                let blocks = roots.blocks_mut::<4>().iter_mut().zip(displacement.blocks::<4>());
                for (root, &x) in blocks.take((count + BEYOND).saturating_sub(next) / 4) {
                    let mut roots = [0.0; 4];
                    for k in 0..4 {
                        roots[k] = root_of((self.slip_displacement - x[k]) * self.outer_scale);
                    }
                    *root = roots;
                }
            }
            while next < count
                && let Some(v) = block(roots, next)
            {
                let interval = Interval::new(v[0]);
                if !interval.is_covered() {
                    break;
                }
                let (force, stiffness) = self.outer::<4, STIFFNESS>(interval, Lanes(*v));
                store::<STIFFNESS>(forces, stiffnesses, next, force.0, stiffness.0);
                next += leading(v, |v| Interval::new(v) == interval);
            }
        }
        if next < count {
            self.one_by_one(next..count, displacement, forces, stiffnesses);
        }
    }

    /// Tangent stiffnesses over the initial one, for integrals, at four x and remaining ρ = 1 - x over the displacement of gross slip.
    /// Without an interpolant the stick zones are found.
    pub(crate) fn relative_stiffnesses(&self, x: Lanes<4>, rho: Lanes<4>) -> Lanes<4> {
        let mut stiffnesses = Lanes::ZERO;
        if self.interpolant().is_converged() {
            let (displacement, remaining) =
                (x * self.slip_displacement, rho * self.slip_displacement * self.outer_scale);
            let (roots, last_roots) = (remaining.map(root_of), remaining.map(last_root_of));
            let parts: [Part; 4] = core::array::from_fn(|k| {
                if remaining[k] < END_OF_PIECES {
                    Part::Last(Interval::new(last_roots[k]))
                } else if displacement[k] * self.inner_scale <= 1.0 {
                    Part::Inner
                } else {
                    Part::Outer(Interval::new(roots[k]))
                }
            });
            for k in 0..4 {
                // All four are evaluated on a polynomial for those that are on it: in most cases all.
                if k > 0 && parts[..k].contains(&parts[k]) {
                    continue;
                }
                let values = match parts[k] {
                    Part::Inner => self.inner::<4, true>(displacement).1,
                    Part::Outer(interval) => self.outer::<4, true>(interval, roots).1,
                    Part::Last(interval) => {
                        self.interpolant().last_slopes(interval, last_roots) * self.outer_stiffness()
                    }
                };
                for j in k..4 {
                    stiffnesses[j] = if parts[j] == parts[k] { values[j] } else { stiffnesses[j] };
                }
            }
        } else {
            let (zones, slip) = (self.stick_zones(), self.stick_zones().slip_shift);
            for k in 0..4 {
                let place = Complement { consumed: x[k] * slip, remaining: rho[k] * slip };
                stiffnesses[k] = self.stiffness_of(&zones.at_shift(place));
            }
        }
        stiffnesses * (1.0 / self.initial_stiffness)
    }

    /// Forces and, if requested, stiffnesses at displacements in the range of the first polynomial.
    fn inner<const L: usize, const STIFFNESS: bool>(&self, displacement: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
        let y = displacement * self.inner_scale;
        let (secant, slope) = values_and_slopes::<_, L, STIFFNESS>(self.interpolant().secant(), y);
        let stiffness = if STIFFNESS { (secant + slope * y) * self.initial_stiffness } else { slope };
        (secant * (self.initial_stiffness * displacement), stiffness)
    }

    /// Forces and, if requested, stiffnesses at places v of one interval.
    fn outer<const L: usize, const STIFFNESS: bool>(&self, interval: Interval, v: Lanes<L>) -> (Lanes<L>, Lanes<L>) {
        let (remaining, slope) = self.interpolant().complements_and_slopes::<L, STIFFNESS>(interval, v);
        (self.slip_force - self.slip_force * remaining, slope * self.outer_stiffness())
    }

    #[inline(never)]
    fn one_by_one(
        &self,
        range: core::ops::Range<usize>,
        displacement: &[f64],
        forces: &mut [f64],
        stiffnesses: &mut [f64],
    ) {
        let values = forces.iter_mut().zip(stiffnesses).zip(displacement).take(range.end).skip(range.start);
        for ((force, stiffness), &x) in values {
            Response { force: *force, stiffness: *stiffness } = self.response(x);
        }
    }

    /// The load at a displacement up to that of gross slip, with an accurate complement, and the stiffness; `None` if there is no
    /// interpolant at this displacement.
    pub(crate) fn load_at(&self, displacement: Complement) -> Option<(Complement, f64)> {
        if !self.interpolant().is_converged() {
            return None;
        }
        if displacement.consumed * self.inner_scale <= 1.0 {
            let (Lanes([force]), Lanes([stiffness])) = self.inner::<1, true>(Lanes([displacement.consumed]));
            let consumed = force / self.slip_force.max(f64::MIN_POSITIVE);
            return Some((Complement { consumed, remaining: 1.0 - consumed }, stiffness));
        }
        let v = root_of(displacement.remaining * self.outer_scale);
        let interval = Interval::new(v);
        let (Lanes([remaining]), Lanes([slope])) =
            self.interpolant().complements_and_slopes::<1, true>(interval, Lanes([v]));
        interval
            .is_covered()
            .then_some((Complement { consumed: 1.0 - remaining, remaining }, self.outer_stiffness() * slope))
    }

    /// Stiffness for a derivative by ρ of 1.
    fn outer_stiffness(&self) -> f64 {
        self.slip_force * self.outer_scale
    }
}

#[cfg(test)]
mod tests {
    use super::BEYOND;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};
    use std::vec;
    use std::vec::Vec;

    #[test]
    fn many_displacements_have_the_bits_of_one() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let fractions = (0..200).map(|k| f64::from(k) / 200.0).chain([0.9991, 0.9999, 1.0]);
            let displacements: Vec<f64> = fractions.map(|x| x * contact.slip_displacement).collect();
            for (first, stride) in [(0, 1), (3, 1), (0, 7), (0, 60), (100, 40), (199, 1), (80, 200)] {
                let mut along: Vec<f64> = displacements.iter().skip(first).step_by(stride).copied().collect();
                let n = along.len();
                along.extend([contact.slip_displacement; BEYOND]);
                let [mut roots, mut forces, mut stiffnesses] = [(); 3].map(|()| vec![0.0; n + BEYOND]);
                contact.along::<true>(n, &along, &mut roots, &mut forces, &mut stiffnesses);
                for ((&x, &force), &stiffness) in along.iter().zip(&forces).zip(&stiffnesses).take(n) {
                    let response = contact.response(x);
                    assert_eq!([response.force, response.stiffness], [force, stiffness], "{x}");
                }
                let with_stiffness = forces.clone();
                contact.along::<false>(n, &along, &mut roots, &mut forces, &mut stiffnesses);
                assert_eq!(forces[..n], with_stiffness[..n]);
            }
        }
    }
}
