//! The law under a varying normal force, one tangential direction, by its definition: a diagram D(S) with |D| <= mu over the shifts
//! of the sizes, `T = ∫ D dN` and `u = o + ∫ D dS`, as a list of pieces of constant D.
//!
//! A step is straight in (S, u). Its end follows from the slip that is left over once the outer pieces are cut at the new size,
//! and the energy from the events on the edge_rate: ends of pieces, and the contact size overtaking the edge of the slip zone.

use crate::family::{Family, Given, Size};
use crate::{Input, Real};

/// Bits of a difference that are taken as 0: those that rounding leaves.
const ROUNDING: i32 = 40;

/// An element, and what its normal input is.
pub struct Element {
    pub family: Family,
    pub by_force: bool,
}

/// A piece of the diagram: its outer end, and D.
#[derive(Debug, Clone)]
pub struct Piece {
    pub end: Size,
    pub slope: Real,
}

/// Why the force of a step changes as it does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Open,
    /// Nothing slips at the end of the step.
    Stick,
    Slip,
    GrossSlip,
}

/// Result of a step.
#[derive(Debug, Clone)]
pub struct Step {
    pub kind: Kind,
    pub force: Real,
    pub load: Real,
    /// By the displacement, and by the normal input.
    pub tangent: [Real; 2],
    pub load_slope: Real,
    pub dissipated: Real,
    /// N of the smallest stick zone during the step: the slip zone carries the rest.
    pub stick_load: Real,
    /// The edge of the slip zone, and |D - σ mu| of the piece in which it lies.
    pub edge: Option<(Size, Real)>,
}

/// The state after a history from the open contact at displacement and normal input 0.
#[derive(Debug, Clone)]
pub struct State {
    pub displacement: Real,
    pub input: Real,
    /// `None` if open.
    pub size: Option<Size>,
    /// Displacement at the centre of the diagram.
    pub origin: Real,
    pub pieces: Vec<Piece>,
}

impl Element {
    pub fn new(input: &Input, by_force: bool) -> Element {
        Element { family: Family::new(input), by_force }
    }

    pub fn real(&self, value: f64) -> Real {
        self.family.real(value)
    }

    /// The initial state.
    pub fn open(&self) -> State {
        let zero = self.real(0.0);
        State { displacement: zero.clone(), input: zero.clone(), size: None, origin: zero, pieces: vec![] }
    }

    /// The size of zero load.
    fn touch(&self) -> Size {
        self.family.size(&self.real(0.0))
    }

    pub fn size_of_input(&self, input: &Real) -> Size {
        self.family.find(if self.by_force { Given::Load } else { Given::Approach }, input)
    }

    /// Advances a state.
    pub fn step(&self, state: &mut State, displacement: &Real, input: &Real) -> Step {
        let zero = || self.real(0.0);
        // Displacement at which a straight path passes input 0: contact opens or closes there.
        let crossing = || {
            let fraction = &state.input / (&state.input - input);
            &state.displacement + fraction * (displacement - &state.displacement)
        };
        let open = !input.is_positive();
        if open && state.size.is_none() {
            state.origin = displacement.clone();
            (state.displacement, state.input) = (displacement.clone(), input.clone());
            return self.without_force(zero());
        }
        if open {
            let end = crossing();
            let march = self.trace_energy(state, &end, &self.touch());
            *state = State {
                displacement: displacement.clone(),
                input: input.clone(),
                size: None,
                origin: displacement.clone(),
                pieces: vec![],
            };
            return self.without_force(march.energy);
        }
        let size = if *input == state.input
            && let Some(size) = &state.size
        {
            size.clone()
        } else {
            self.size_of_input(input)
        };
        // The input at which the path closed the contact, and the displacement before.
        let mut gap = None;
        if state.size.is_none() {
            let start = if state.input.is_zero() { state.displacement.clone() } else { crossing() };
            gap = Some((state.input.clone(), state.displacement.clone()));
            state.displacement = start.clone();
            state.origin = start;
        }
        let march = self.trace_energy(state, displacement, &size);
        let mut step = self.end(state, displacement, &size);
        if let Some((before, from)) = gap
            && step.kind == Kind::Stick
        {
            // The path starts where it closes the contact, and this moves with its end.
            let distance = input - &before;
            let by_displacement = step.tangent[0].clone();
            step.tangent[1] =
                &step.tangent[1] + &by_displacement * (displacement - from) * -&before / distance.square();
            step.tangent[0] = by_displacement * input / distance;
        }
        step.dissipated = march.energy;
        step.stick_load = march.stick_load;
        state.displacement = displacement.clone();
        state.input = input.clone();
        state.size = Some(size);
        step
    }

    fn without_force(&self, dissipated: Real) -> Step {
        let [force, load, by_displacement, by_input, load_slope, stick_load] = [(); 6].map(|()| self.real(0.0));
        let tangent = [by_displacement, by_input];
        Step { kind: Kind::Open, force, load, tangent, load_slope, dissipated, stick_load, edge: None }
    }

    /// The diagram at the end of a step to a closed contact, force and tangent.
    fn end(&self, state: &mut State, displacement: &Real, size: &Size) -> Step {
        let mu = &self.family.friction;
        let zero = || self.real(0.0);
        // Derivatives of the load and of the shift by the input.
        let (load_slope, shift_slope) = if self.by_force {
            (self.real(1.0), size.tangential_compliance.clone())
        } else {
            (1.0 / &size.normal_compliance, &size.tangential_compliance / &size.normal_compliance)
        };
        let step = |kind, force: Real, by_displacement: Real, by_input: Real| Step {
            kind,
            force,
            load: size.load.clone(),
            tangent: [by_displacement, by_input],
            load_slope: load_slope.clone(),
            ..self.without_force(zero())
        };
        let old = state.size.clone().unwrap_or_else(|| self.touch());
        let stiffness = 1.0 / &size.tangential_compliance;
        if size.shift > old.shift {
            let rise = &size.shift - &old.shift;
            let rate = (displacement - &state.displacement) / &rise;
            let slope = rate.clone().max(&-mu).min(mu);
            state.pieces.push(Piece { end: size.clone(), slope });
            if rate.abs() <= *mu {
                let secant = (&size.load - &old.load) / rise;
                let by_input = rate * (stiffness - &secant) * shift_slope;
                return step(Kind::Stick, self.force(&state.pieces), secant, by_input);
            }
        } else {
            cut(&mut state.pieces, size);
        }
        let slip = displacement - &state.origin - self.covered(&state.pieces);
        let scale = displacement.abs() + state.origin.abs() + mu * &size.shift;
        if slip.is_zero() || slip.exponent() < scale.exponent() - self.family.bits as i32 + ROUNDING {
            return step(Kind::Stick, self.force(&state.pieces), stiffness, zero());
        }
        let sign = if slip.is_positive() { mu.clone() } else { -mu };
        let mut left = slip.abs();
        while let Some(piece) = state.pieces.pop() {
            let inner = state.pieces.last().map_or(zero(), |piece| piece.end.shift.clone());
            let rate = (&piece.slope - &sign).abs();
            let most = &rate * (&piece.end.shift - inner);
            if most > left {
                let edge = self.family.find(Given::Shift, &(&piece.end.shift - left / &rate));
                let by_displacement = 1.0 / &edge.tangential_compliance;
                let by_input = &sign * (stiffness - &by_displacement) * shift_slope;
                state.pieces.push(Piece { end: edge.clone(), slope: piece.slope });
                state.pieces.push(Piece { end: size.clone(), slope: sign });
                let force = self.force(&state.pieces);
                return Step { edge: Some((edge, rate)), ..step(Kind::Slip, force, by_displacement, by_input) };
            }
            left = left - most;
        }
        state.origin = displacement - &sign * &size.shift;
        let by_input = &sign * load_slope.clone();
        state.pieces = vec![Piece { end: size.clone(), slope: sign }];
        step(Kind::GrossSlip, self.force(&state.pieces), zero(), by_input)
    }

    /// Σ D ΔN.
    fn force(&self, pieces: &[Piece]) -> Real {
        self.sum(pieces, |size| &size.load)
    }

    /// Σ D ΔS.
    fn covered(&self, pieces: &[Piece]) -> Real {
        self.sum(pieces, |size| &size.shift)
    }

    fn sum(&self, pieces: &[Piece], of: impl Fn(&Size) -> &Real) -> Real {
        let (mut sum, mut inner) = (self.real(0.0), self.real(0.0));
        for piece in pieces {
            sum = sum + &piece.slope * (of(&piece.end) - inner);
            inner = of(&piece.end).clone();
        }
        sum
    }

    /// Tangential energy stored in a state.
    pub fn stored(&self, state: &State) -> Real {
        let mut inner = self.touch();
        let (mut energy, mut force) = (self.real(0.0), self.real(0.0));
        for Piece { end, slope } in &state.pieces {
            let constant = &force - slope * &inner.load;
            energy =
                energy + slope * (constant * (&end.shift - &inner.shift) + slope * (&end.potential - &inner.potential));
            force = force + slope * (&end.load - &inner.load);
            inner = end.clone();
        }
        energy
    }

    /// Pressure \[Pa\] and shear traction at a point |x| along the width.
    pub fn tractions(&self, state: &State, x: &Real) -> [Real; 2] {
        let pressure = |size: &Size| self.family.pressure(size, x);
        let all = state.size.as_ref().map_or(self.real(0.0), pressure);
        let (mut shear, mut inner) = (self.real(0.0), self.real(0.0));
        for Piece { end, slope } in &state.pieces {
            let outer = pressure(end);
            shear = shear + slope * (&outer - inner);
            inner = outer;
        }
        [all, shear]
    }

    /// Follows the events of a step from a closed contact, or from first touch, for its energy. Along the step, λ from 0 to 1, the
    /// contact size changes by `rise` and the edge of the slip zone by `edge_rate` per unit λ, both in S.
    fn trace_energy(&self, state: &State, displacement: &Real, end: &Size) -> March {
        let mu = &self.family.friction;
        let (zero, one) = (self.real(0.0), self.real(1.0));
        let start = state.size.clone().unwrap_or_else(|| self.touch());
        let mut pieces = state.pieces.clone();
        let motion = displacement - &state.displacement;
        let rise = &end.shift - &start.shift;
        let mut march = March { energy: zero.clone(), stick_load: end.load.clone().min(&start.load) };
        if rise.is_positive() && motion.abs() <= mu * &rise {
            return march;
        }
        let rounding = displacement.abs().max(&state.displacement.abs()).max(&(mu * &start.shift)).exponent()
            - self.family.bits as i32
            + ROUNDING;
        let at_shift =
            |shift: Real| if shift.is_positive() { self.family.find(Given::Shift, &shift) } else { self.touch() };
        // λ, contact size and edge of the slip zone there, and the direction while there is slip.
        let (mut lambda, mut outer, mut edge) = (zero.clone(), start.clone(), start.clone());
        let mut sign: Option<Real> = None;
        while let Some(Piece { slope, .. }) = pieces.last() {
            let inner = pieces.len().checked_sub(2).map_or_else(|| self.touch(), |below| pieces[below].end.clone());
            let direction = match &sign {
                Some(sign) => sign.clone(),
                None => {
                    let excess = if rise.is_positive() { motion.clone() } else { &motion - slope * &rise };
                    if excess.is_zero() || excess.exponent() < rounding {
                        // The contact recedes through the piece without slip.
                        if end.shift >= inner.shift {
                            return march;
                        }
                        lambda = (&inner.shift - &start.shift) / &rise;
                        (outer, edge) = (inner.clone(), inner);
                        pieces.pop();
                        continue;
                    }
                    if excess.is_positive() { mu.clone() } else { -mu }
                }
            };
            sign = Some(direction.clone());
            let speed = slope - &direction;
            let edge_rate = if speed.is_zero() { zero.clone() } else { (&motion - &direction * &rise) / &speed };
            if speed.is_zero() {
                // In slip in this direction already.
                march.stick_load = march.stick_load.min(&inner.load);
                edge = inner;
                pieces.pop();
                continue;
            }
            if edge_rate >= zero {
                return march;
            }
            let to_inner = &lambda + (&inner.shift - &edge.shift) / &edge_rate;
            // A step that returns to a reversal ends there.
            let returns = (&to_inner - &one).exponent() < ROUNDING - self.family.bits as i32;
            let mut next = if returns { one.clone() } else { to_inner.clone().min(&one) };
            let overtaken = (edge_rate > rise).then(|| &lambda + (&edge.shift - &outer.shift) / (&rise - &edge_rate));
            next = overtaken.iter().fold(next, Real::min);
            let next_edge =
                if next == to_inner { inner } else { at_shift(&edge.shift + (&next - &lambda) * &edge_rate) };
            let meets = overtaken.is_some_and(|overtaken| overtaken == next);
            let next_outer = if next == one {
                end.clone()
            } else if meets {
                next_edge.clone()
            } else {
                at_shift(&start.shift + &next * &rise)
            };
            let slip = Slip { edge: [&edge, &next_edge], outer: [&outer, &next_outer] };
            march.energy = &march.energy + &direction * speed * slip.integral(&rise, &edge_rate);
            march.stick_load = march.stick_load.min(&next_edge.load);
            if next == one {
                return march;
            }
            if next == to_inner {
                pieces.pop();
            }
            if meets {
                sign = None;
            }
            (lambda, edge, outer) = (next, next_edge, next_outer);
        }
        // Gross slip for the rest of the step.
        let direction = sign.unwrap_or_else(|| if motion.is_positive() { mu.clone() } else { -mu });
        let mean =
            if rise.is_zero() { &end.load * (1.0 - &lambda) } else { (&end.potential - &outer.potential) / &rise };
        march.energy = march.energy + &direction * (motion - &direction * rise) * mean;
        march.stick_load = zero;
        march
    }
}

struct March {
    energy: Real,
    stick_load: Real,
}

/// A segment of a step: edge of the slip zone and contact size at both ends.
struct Slip<'a> {
    edge: [&'a Size; 2],
    outer: [&'a Size; 2],
}

impl Slip<'_> {
    /// `∫ (N_b dS_c - S_b dN_c) - ∫ (N_c dS_c - S_c dN_c)` in closed form, for rates of S_b and S_c.
    fn integral(&self, rise: &Real, edge_rate: &Real) -> Real {
        let ([from, to], [outer_from, outer_to]) = (self.edge, self.outer);
        let potential = &to.potential - &from.potential;
        let own = &to.shift * &to.load - &from.shift * &from.load - &potential;
        if rise.is_zero() {
            let first = &outer_to.load * (&to.shift - &from.shift) - potential;
            return first - (&outer_to.shift * (&to.load - &from.load) - own);
        }
        let rate = edge_rate / rise;
        let first = &rate * (&outer_to.potential - &outer_from.potential) - &potential;
        let product = &outer_to.shift * &to.load - &outer_from.shift * &from.load;
        first - (product - potential / rate - own)
    }
}

/// Cuts the pieces at a size.
fn cut(pieces: &mut Vec<Piece>, size: &Size) {
    while let Some(piece) = pieces.pop() {
        let inner = pieces.last().map_or(0.0 * &size.shift, |piece| piece.end.shift.clone());
        if inner < size.shift {
            pieces.push(Piece { end: size.clone(), ..piece });
            return;
        }
    }
}
