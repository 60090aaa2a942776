//! Evaluation of the monotonic curve at a displacement: force and tangent stiffness, from the interpolant if possible.
//!
//! The stick zone is found by iteration next to gross slip, and everywhere if the interpolant has not converged: for Λ near 0, or
//! with a layer that bends the curve strongly.

use crate::constant_load::contact::Contact;
use crate::constant_load::interpolant::{INNER, PIECES, piece_in_integral, piece_of, root_of};
use crate::numerics::lanes::Lanes;
use crate::numerics::polynomial::values_and_slopes;
use crate::shape::Complement;

/// Force \[N\] and tangent stiffness \[N/m\] at a displacement.
#[derive(Clone, Copy, Default)]
pub(crate) struct Response {
    pub force: f64,
    pub stiffness: f64,
}

pub(super) fn sign_of(value: f64) -> f64 {
    if value < 0.0 { -1.0 } else { 1.0 }
}

impl Contact {
    /// Force and stiffness at a displacement >= 0; beyond that of gross slip mu N and 0, and 0 and 0 without friction.
    pub(crate) fn response(&self, displacement: f64) -> Response {
        if self.is_frictionless() || displacement > self.slip_displacement {
            return Response { force: self.slip_force, stiffness: 0.0 };
        }
        let [force, _, stiffness] = self.at_one(self.before_slip(displacement));
        Response { force, stiffness }
    }

    /// The load τ at a displacement up to that of gross slip, with 1 - τ accurate to rounding, and the compliance increase λ.
    pub(crate) fn load_at(&self, displacement: Complement) -> (Complement, f64) {
        let [force, remaining, stiffness] = self.at_one(displacement);
        self.load_of(Complement { consumed: force / self.slip_force.max(f64::MIN_POSITIVE), remaining }, stiffness)
    }

    /// The load and λ for the energy of a cycle. Next to gross slip the polynomials for integrals are accurate enough for both,
    /// because the energy hardly depends on 1 - τ there.
    pub(crate) fn load_of_energy(&self, displacement: Complement) -> (Complement, f64) {
        let roots = self.roots(Lanes([displacement.remaining]));
        let piece = piece_in_integral(roots[0]);
        if piece <= PIECES || !self.interpolant.is_converged() {
            return self.load_at(displacement);
        }
        let [rest, slope] = self.interpolant.last_values_and_slopes(piece, roots);
        let remaining = rest[0] * (displacement.remaining * self.outer_scale);
        self.load_of(Complement::of_remaining(remaining), slope[0] * self.outer_stiffness())
    }

    fn load_of(&self, load: Complement, stiffness: f64) -> (Complement, f64) {
        // At most 1e100 instead of infinite.
        let compliance = self.stiffness_scale / stiffness.max(1e-100 * self.stiffness_scale);
        (load, compliance - self.zones.small_load.compliance)
    }

    /// Force, 1 - τ and stiffness at one displacement. Not inlined: steps and harmonic forces would take longer.
    #[inline(never)]
    fn at_one(&self, Complement { consumed, remaining }: Complement) -> [f64; 3] {
        let roots = self.roots(Lanes([remaining]));
        self.on_piece::<1, true>(piece_of(roots[0]), roots, Lanes([consumed]), Lanes([remaining])).map(|value| value[0])
    }

    /// The roots √ρ, arguments of the interpolant, at remaining displacements.
    #[inline(always)]
    pub(crate) fn roots<const L: usize>(&self, remaining: Lanes<L>) -> Lanes<L> {
        (remaining * self.outer_scale).map(root_of)
    }

    /// Tangent stiffnesses over the initial stiffness, accurate enough for integrals, at four displacements x over that of gross
    /// slip and at their complements ρ = 1 - x.
    pub(crate) fn relative_stiffnesses(&self, x: Lanes<4>, rho: Lanes<4>) -> Lanes<4> {
        let (displacement, remaining) = (x * self.slip_displacement, rho * self.slip_displacement);
        let roots = self.roots(remaining);
        let pieces = roots.0.map(piece_in_integral);
        let mut stiffnesses = Lanes::ZERO;
        for k in 0..4 {
            let piece = pieces[k];
            // Each polynomial is evaluated at all four, and the values at those on its piece are taken: in most cases at all of
            // them.
            if k > 0 && pieces[..k].contains(&piece) {
                continue;
            }
            let values = if piece > PIECES && self.interpolant.is_converged() {
                self.interpolant.last_values_and_slopes(piece, roots)[1] * self.outer_stiffness()
            } else {
                self.on_piece::<4, true>(piece, roots, displacement, remaining)[2]
            };
            for j in k..4 {
                stiffnesses[j] = if pieces[j] == piece { values[j] } else { stiffnesses[j] };
            }
        }
        stiffnesses * (1.0 / self.initial_stiffness)
    }

    /// Stiffness for a derivative of 1 - τ with respect to ρ of 1.
    fn outer_stiffness(&self) -> f64 {
        self.slip_force * self.outer_scale
    }

    /// Force, 1 - τ and, if requested, stiffness at displacements on one piece of the curve, up to gross slip, of a contact with
    /// friction. At displacements on other pieces the results have no meaning.
    #[inline(always)]
    pub(crate) fn on_piece<const L: usize, const STIFFNESS: bool>(
        &self,
        piece: u64,
        roots: Lanes<L>,
        displacement: Lanes<L>,
        remaining: Lanes<L>,
    ) -> [Lanes<L>; 3] {
        let interpolant = &self.interpolant;
        if !interpolant.is_converged() || piece > PIECES {
            let mut values = [Lanes::ZERO; 3];
            for k in 0..L {
                let is_new = k == 0 || displacement[k] != displacement[k - 1];
                let zone =
                    if is_new { self.at_zone(displacement[k], remaining[k]) } else { values.map(|value| value[k - 1]) };
                [values[0][k], values[1][k], values[2][k]] = zone;
            }
            return values;
        }
        if piece == INNER {
            let y = displacement * self.inner_scale;
            let (secant, slope) = values_and_slopes::<L, STIFFNESS>(interpolant.secant(), y);
            let force = secant * (self.initial_stiffness * displacement);
            let rest = 1.0 - force * (1.0 / self.slip_force.max(f64::MIN_POSITIVE));
            [force, rest, (secant + slope * y) * self.initial_stiffness]
        } else {
            let (rest, slope) = interpolant.complements_and_slopes::<L, STIFFNESS>(piece, roots);
            [self.slip_force - self.slip_force * rest, rest, slope * self.outer_stiffness()]
        }
    }

    /// Force, 1 - τ and stiffness from the stick zone.
    #[cold]
    #[inline(never)]
    fn at_zone(&self, consumed: f64, remaining: f64) -> [f64; 3] {
        let zone = self.stick_zone_before_slip(Complement { consumed, remaining });
        [self.force_of(&zone), zone.load.remaining, self.stiffness_of(&zone)]
    }
}
