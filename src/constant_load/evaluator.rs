//! Evaluation of the monotonic curve at a displacement: force and tangent stiffness, from the interpolant if possible.
//!
//! For an ellipse the curve is elementary. If there is no interpolant, next to gross slip or for Λ near 0, the stick zone is found by
//! iteration.

use crate::constant_load::contact::Contact;
use crate::constant_load::curve::sign_of;
use crate::constant_load::interpolant::ForceInterpolant;
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
        self.interpolated(displacement).unwrap_or_else(|| self.contact.solved_response(displacement))
    }

    /// The same; `None` if there is no interpolant at this displacement.
    #[inline(always)]
    pub fn interpolated(&self, displacement: f64) -> Option<Response> {
        let remaining = self.slip_displacement - displacement;
        if remaining < 0.0 {
            return Some(Response { force: self.slip_force, stiffness: 0.0 });
        }
        if self.elliptic {
            return Some(self.elliptic_at(displacement, remaining));
        }
        let y = displacement * self.inner_scale;
        if y <= 1.0 {
            let (secant, tangent) = self.interpolant.secant_and_tangent(y)?;
            let initial = self.initial_stiffness;
            Some(Response { force: initial * displacement * secant, stiffness: initial * tangent })
        } else {
            let (complement, slope) = self.interpolant.complement_and_slope(remaining * self.outer_scale)?;
            let force = self.slip_force - self.slip_force * complement;
            Some(Response { force, stiffness: self.outer_stiffness * slope })
        }
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
