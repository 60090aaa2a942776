//! Evaluation of the monotonic curve at a displacement: force and tangent stiffness, from the interpolant if possible.
//!
//! For an ellipse the curve is elementary. If there is no interpolant, next to gross slip or for Λ near 0, the stick zone is found by
//! iteration.

use crate::constant_load::contact::Contact;
use crate::constant_load::curve::sign_of;
use crate::constant_load::interpolant::{ForceInterpolant, Interval, root_of};
use crate::law::Response;
use crate::shape::stick_zone::Complement;

/// Evaluates force and stiffness on the monotonic curve.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CurveEvaluator<'a> {
    contact: &'a Contact,
    elliptic: bool,
    interpolant: &'a ForceInterpolant,
    slip_force: f64,
    pub slip_displacement: f64,
    initial_stiffness: f64,
    inner_scale: f64,
    outer_scale: f64,
    outer_stiffness: f64,
}

impl Contact {
    /// Force and stiffness at a displacement >= 0; beyond that of gross slip mu N and 0, and 0 and 0 without friction.
    #[inline(always)]
    pub(crate) fn response(&self, displacement: f64) -> Response {
        self.evaluator().at(displacement)
    }

    /// The same, not inlined.
    #[inline(never)]
    pub(crate) fn response_at(&self, displacement: f64) -> Response {
        self.response(displacement)
    }

    /// The evaluator of the curve: the fields of the contact that it needs, loaded once for many displacements.
    #[inline(always)]
    pub(crate) fn evaluator(&self) -> CurveEvaluator<'_> {
        CurveEvaluator {
            contact: self,
            elliptic: self.is_elliptic(),
            interpolant: self.interpolant(),
            slip_force: self.slip_force,
            slip_displacement: self.slip_displacement,
            initial_stiffness: self.initial_stiffness,
            inner_scale: self.inner_scale,
            outer_scale: self.outer_scale,
            outer_stiffness: self.slip_force * self.outer_scale,
        }
    }

    /// Force and stiffness at displacements of either sign.
    #[inline(always)]
    pub(crate) fn responses(&self, displacement: &[f64], force: Option<&mut [f64]>, stiffness: Option<&mut [f64]>) {
        let evaluator = self.evaluator();
        let signed = |displacement: f64| {
            let Response { force, stiffness } = evaluator.at(displacement.abs());
            Response { force: sign_of(displacement) * force, stiffness }
        };
        match (force, stiffness) {
            (Some(force), Some(stiffness)) => {
                for ((force, stiffness), &displacement) in force.iter_mut().zip(stiffness).zip(displacement) {
                    Response { force: *force, stiffness: *stiffness } = signed(displacement);
                }
            }
            (Some(force), None) => {
                for (force, &displacement) in force.iter_mut().zip(displacement) {
                    *force = signed(displacement).force;
                }
            }
            (None, Some(stiffness)) => {
                for (stiffness, &displacement) in stiffness.iter_mut().zip(displacement) {
                    *stiffness = signed(displacement).stiffness;
                }
            }
            (None, None) => {}
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

impl CurveEvaluator<'_> {
    /// At a displacement >= 0.
    #[inline(always)]
    pub fn at(&self, displacement: f64) -> Response {
        let remaining = self.slip_displacement - displacement;
        if remaining < 0.0 {
            return Response { force: self.slip_force, stiffness: 0.0 };
        }
        if self.elliptic {
            return self.elliptic_at(displacement, remaining);
        }
        let y = displacement * self.inner_scale;
        if y <= 1.0 {
            if let Some((secant, tangent)) = self.interpolant.secant_and_tangent(y) {
                let initial = self.initial_stiffness;
                return Response { force: initial * displacement * secant, stiffness: initial * tangent };
            }
        } else if let Some((complement, slope)) = self.interpolant.complement_and_slope(remaining * self.outer_scale) {
            let force = self.slip_force - self.slip_force * complement;
            return Response { force, stiffness: self.outer_stiffness * slope };
        }
        self.contact.solved_response(displacement)
    }

    /// Forces, and stiffnesses if requested, at four displacements up to that of gross slip, with the same bits as at one.
    #[inline(always)]
    pub fn four<const STIFFNESS: bool>(&self, displacement: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
        if self.elliptic {
            return self.four_elliptic(displacement);
        }
        if !self.interpolant.is_converged() {
            return self.one_by_one(displacement);
        }
        let mut y = [0.0; 4];
        for k in 0..4 {
            y[k] = displacement[k] * self.inner_scale;
        }
        let inner = [y[0] <= 1.0, y[1] <= 1.0, y[2] <= 1.0, y[3] <= 1.0];
        let (mut forces, mut stiffnesses) = ([0.0; 4], [0.0; 4]);
        if inner != [false; 4] {
            (forces, stiffnesses) = self.four_inner::<STIFFNESS>(displacement, &y);
        }
        if inner == [true; 4] {
            return (forces, stiffnesses);
        }
        let mut v = [0.0; 4];
        for k in 0..4 {
            v[k] = root_of((self.slip_displacement - displacement[k]) * self.outer_scale);
        }
        let intervals = [Interval::of(v[0]), Interval::of(v[1]), Interval::of(v[2]), Interval::of(v[3])];
        let mut done = inner;
        // Each interval that occurs, along a branch seldom more than two.
        while let Some(next) = done.iter().position(|done| !done) {
            let interval = intervals.get(next).copied().unwrap_or(intervals[0]);
            if !interval.is_covered() {
                return self.one_by_one(displacement);
            }
            let (outer_forces, outer_stiffnesses) = self.four_outer::<STIFFNESS>(interval, &v);
            for k in 0..4 {
                if !inner[k] && intervals[k] == interval {
                    (forces[k], stiffnesses[k]) = (outer_forces[k], outer_stiffnesses[k]);
                    done[k] = true;
                }
            }
        }
        (forces, stiffnesses)
    }

    #[inline(always)]
    fn four_inner<const STIFFNESS: bool>(&self, displacement: &[f64; 4], y: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
        let (mut forces, mut stiffnesses) = self.interpolant.four_secants_and_tangents::<STIFFNESS>(y);
        for k in 0..4 {
            forces[k] *= self.initial_stiffness * displacement[k];
            stiffnesses[k] *= self.initial_stiffness;
        }
        (forces, stiffnesses)
    }

    #[inline(always)]
    fn four_outer<const STIFFNESS: bool>(&self, interval: Interval, v: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
        let (mut forces, mut stiffnesses) = self.interpolant.four_complements_and_slopes::<STIFFNESS>(interval, v);
        for k in 0..4 {
            forces[k] = self.slip_force - self.slip_force * forces[k];
            stiffnesses[k] *= self.outer_stiffness;
        }
        (forces, stiffnesses)
    }

    #[inline(always)]
    fn four_elliptic(&self, displacement: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
        let (mut forces, mut stiffnesses) = ([0.0; 4], [0.0; 4]);
        for k in 0..4 {
            let response = self.elliptic_at(displacement[k], self.slip_displacement - displacement[k]);
            (forces[k], stiffnesses[k]) = (response.force, response.stiffness);
        }
        (forces, stiffnesses)
    }

    #[inline(never)]
    fn one_by_one(&self, displacement: &[f64; 4]) -> ([f64; 4], [f64; 4]) {
        let (mut forces, mut stiffnesses) = ([0.0; 4], [0.0; 4]);
        for ((force, stiffness), displacement) in forces.iter_mut().zip(&mut stiffnesses).zip(displacement) {
            Response { force: *force, stiffness: *stiffness } = self.at(*displacement);
        }
        (forces, stiffnesses)
    }

    /// The load at a displacement up to that of gross slip, with an accurate complement, and the stiffness; `None` for an ellipse, and
    /// if there is no interpolant at this displacement.
    #[inline(always)]
    pub fn load_at(&self, displacement: f64) -> Option<(Complement, f64)> {
        if self.elliptic {
            return None;
        }
        let y = displacement * self.inner_scale;
        if y <= 1.0 {
            let (secant, tangent) = self.interpolant.secant_and_tangent(y)?;
            let consumed = self.initial_stiffness * displacement / self.slip_force.max(f64::MIN_POSITIVE) * secant;
            Some((Complement { consumed, remaining: 1.0 - consumed }, self.initial_stiffness * tangent))
        } else {
            let distance = self.slip_displacement - displacement;
            let (remaining, slope) = self.interpolant.complement_and_slope(distance * self.outer_scale)?;
            Some((Complement { consumed: 1.0 - remaining, remaining }, self.outer_stiffness * slope))
        }
    }

    /// `x/x_s = 1 - σ²` and `τ = 1 - σ³`: τ from x and the root σ, free of cancellation.
    #[inline(always)]
    fn elliptic_at(&self, displacement: f64, remaining: f64) -> Response {
        let size = (remaining * self.outer_scale).max(0.0).sqrt();
        let consumed = displacement * self.outer_scale / (1.0 + size);
        // Next to gross slip rounding must not give more than mu N.
        let load = consumed * (1.0 + size * (1.0 + size));
        let force = self.slip_force * if load > 1.0 { 1.0 } else { load };
        Response { force, stiffness: self.initial_stiffness * size }
    }
}

#[cfg(test)]
mod tests {
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse};

    #[test]
    fn four_displacements_have_the_bits_of_one() {
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let evaluator = contact.evaluator();
            let fractions =
                (0..400).map(|k| f64::from(k) / 400.0).chain([0.4, 0.85, 0.85, 0.9, 0.999, 0.9999, 1.0, 0.3]);
            let displacements = fractions.map(|x| x * contact.slip_displacement).collect::<std::vec::Vec<_>>();
            // Neighbours, and any order.
            for stride in [1, 7, 150] {
                for first in 0..displacements.len() {
                    let four = core::array::from_fn(|k| displacements[(first + k * stride) % displacements.len()]);
                    let (forces, stiffnesses) = evaluator.four::<true>(&four);
                    let one_by_one = four.map(|displacement| evaluator.at(displacement));
                    assert_eq!(forces, one_by_one.map(|response| response.force));
                    assert_eq!(stiffnesses, one_by_one.map(|response| response.stiffness));
                    assert_eq!(evaluator.four::<false>(&four).0, forces);
                }
            }
        }
    }
}
