//! Histories: return-point memory by its definition, and the law as a Prandtl-Ishlinskii operator over it.

use crate::Real;
use crate::law::{Law, Point};
use crate::stiffness::cycle_energy;
use std::rc::Rc;

/// The number of displacements before the present one that are not wiped out: the one farthest from the origin, after it the
/// farthest in the other direction, and so on to the present one; of equal ones the last.
fn number_of_reversals(history: &[Real]) -> usize {
    // The last of the largest from each index on, upwards or downwards.
    let largest_from = |upwards: bool| {
        let mut found: Vec<usize> = (0..history.len()).collect();
        for i in (0..history.len() - 1).rev() {
            let (here, after) = (&history[i], &history[found[i + 1]]);
            if if upwards { after >= here } else { after <= here } {
                found[i] = found[i + 1];
            }
        }
        found
    };
    let (highest, lowest) = (largest_from(true), largest_from(false));
    let (high, low) = (&history[highest[0]], -&history[lowest[0]]);
    let mut upwards = if *high == low { highest[0] > lowest[0] } else { *high > low };
    let (mut last, mut number) = (if upwards { highest[0] } else { lowest[0] }, 0);
    while last + 1 < history.len() {
        upwards = !upwards;
        last = if upwards { highest[last + 1] } else { lowest[last + 1] };
        number += 1;
    }
    number
}

/// A displacement that is not wiped out, and the curve at half its distance from the one before (from the origin: all of it).
#[derive(Clone)]
pub struct Reversal {
    pub displacement: Real,
    pub rises: bool,
    pub half_range: Real,
    pub point: Point,
    /// Index that the caller gave.
    pub sample: usize,
}

impl Reversal {
    fn new(law: &Law, displacement: Real, before: Option<&Reversal>, sample: usize) -> Reversal {
        let (range, scale) = match before {
            Some(before) => (&displacement - &before.displacement, 2.0),
            None => (displacement.clone(), 1.0),
        };
        let half_range = range.abs() / scale;
        Reversal { rises: range.is_positive(), point: law.at_x(&half_range), displacement, half_range, sample }
    }

    /// ∫ r ρ and ∫ r² ρ over the thresholds r of the sliders that slip in this half range, ρ = -d²τ/dr²; energy of its cycle.
    fn moments(&self, law: &Law) -> [Real; 3] {
        let energy = cycle_energy(law, &self.half_range, &self.point).0;
        let first = &self.point.tau - &self.half_range * self.point.stiffness();
        let second = &self.half_range * &first - &energy / 4.0;
        [first, second, energy]
    }
}

/// Energy dissipated by a step, and the sum of the energies of which it is a difference by Masing's rule.
pub struct Dissipated {
    pub energy: Real,
    pub size: Real,
}

/// A history from the unloaded state, all in units.
#[derive(Clone)]
pub struct History {
    pub law: Rc<Law>,
    pub reversals: Vec<Reversal>,
}

impl History {
    pub fn new(law: Rc<Law>) -> History {
        let start = Reversal::new(&law, law.real(0.0), None, usize::MAX);
        History { law, reversals: vec![start] }
    }

    pub fn now(&self) -> &Reversal {
        &self.reversals[self.reversals.len() - 1]
    }

    /// Advances to a displacement.
    pub fn go(&mut self, to: &Real, sample: usize) {
        let displacements = self.reversals.iter().map(|one| &one.displacement).chain([to]);
        self.reversals.truncate(number_of_reversals(&displacements.cloned().collect::<Vec<_>>()));
        self.reversals.push(Reversal::new(&self.law, to.clone(), self.reversals.last(), sample));
    }

    /// Advances to a displacement, with the energy dissipated by all sliders: those that last slipped at a reversal in this
    /// direction slip again when the motion passes it, the others when it is twice their threshold away.
    pub fn go_with_energy(&mut self, to: &Real, sample: usize) -> Dissipated {
        let old = self.reversals.clone();
        self.go(to, sample);
        let law = &*self.law;
        let zero = || law.real(0.0);
        let rises = *to > old[old.len() - 1].displacement;
        let reached = self.now().moments(law);
        let mut dissipated = Dissipated { energy: zero(), size: zero() };
        let mut add = |slip: &Real, scale: f64, from: &[Real; 3], to: &[Real; 3]| {
            dissipated.energy = &dissipated.energy + scale * (slip * (&to[0] - &from[0]) - (&to[1] - &from[1]));
            dissipated.size = &dissipated.size + &to[2] * (scale / 4.0);
        };
        let (mut below, mut range_below) = ([zero(), zero(), zero()], zero());
        let mut same_direction = zero();
        for reversal in old.iter().rev() {
            let own = reversal.moments(law);
            let distance = if rises { to - &reversal.displacement } else { &reversal.displacement - to };
            let half = &distance / 2.0;
            if distance.is_positive() && reversal.rises == rises {
                same_direction = same_direction + distance * (&own[0] - &below[0]);
            } else if half > range_below {
                add(&half, 2.0, &below, if half < reversal.half_range { &reached } else { &own });
            }
            (below, range_below) = (own, reversal.half_range.clone());
        }
        // Sliders that have never slipped.
        if to.abs() > range_below {
            add(&to.abs(), 1.0, &below, &reached);
        }
        dissipated.energy = dissipated.energy + same_direction;
        dissipated
    }

    /// Force, and the sum of the sizes of its terms: T = M(v1) + 2 M((v2-v1)/2) + ..., M odd.
    pub fn force(&self) -> [Real; 2] {
        let mut sums = [self.law.real(0.0), self.law.real(0.0)];
        for (i, reversal) in self.reversals.iter().enumerate() {
            let term = &reversal.point.tau * if i == 0 { 1.0 } else { 2.0 };
            sums = [if reversal.rises { &sums[0] + &term } else { &sums[0] - &term }, &sums[1] + term];
        }
        sums
    }
}
