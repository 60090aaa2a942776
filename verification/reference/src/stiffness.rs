//! Energy of a cycle and complex stiffness K' + iK'' at a displacement amplitude.

use crate::law::bits_for;
use crate::quadrature::integrals;
use crate::{Law, Point, Real, Reference};

/// Energy of the cycle of amplitude x and its derivative; `point` is that of x.
pub fn cycle_energy(law: &Law, x: &Real, point: &Point) -> (Real, Real) {
    if point.slips() {
        (&point.energy + 4.0 * (x - &law.x_slip), law.real(4.0))
    } else {
        (point.energy.clone(), 4.0 * (&point.tau - x / &point.compliance))
    }
}

/// K'' and its derivative in units, from the energy: E = π K'' x².
pub fn imaginary_part(law: &Law, x: &Real, point: &Point) -> [Real; 2] {
    let (energy, rate) = cycle_energy(law, x, point);
    let pi = Real::pi(law.bits);
    let imaginary = energy / x.square() / &pi;
    let slope = (rate / x / pi - 2.0 * &imaginary) / x;
    [imaginary, slope]
}

/// K' and its derivative in units, from Eq. 10 and the first harmonic of Eq. 11: with X the displacement of a stick zone over the
/// amplitude, K' x = (8/π) ∫ √(X (1-X)) dτ over the stick zones up to the amplitude.
pub fn real_part(contact: &Reference, x: &Real) -> [Real; 2] {
    let share = x / &contact.law(0).x_slip;
    let law = contact.law(64 + bits_for(&share) + bits_for(&(1.0 - &share).abs()));
    let x = &x.at(law.bits);
    let from = law.at_x(x).w;
    // The amplitude of that stick zone to all bits, so that 1 - X keeps its digits near it.
    let x = &if from.is_zero() { x.clone() } else { law.at_w(&from).x };
    let [root_sum, slope_sum] = integrals(&from, &law.w_range(), |w| {
        let point = law.at_w(w);
        let share = &point.x / x;
        let rest = 1.0 - &share;
        if !rest.is_positive() || !share.is_positive() {
            return [law.real(0.0), law.real(0.0)]; // rounding at the ends
        }
        let (rate, root) = (&point.load_rate, (&share * &rest).sqrt());
        [&root * rate, (&rest - &share) * share * rate / root]
    });
    let factor = 4.0 / Real::pi(law.bits) / x;
    let real = 2.0 * &factor * root_sum;
    // d(K' x)/dx = -(4/π) ∫ X (1-2X)/√(X (1-X)) dτ/x.
    let slope = (-(factor * slope_sum) - &real) / x;
    [real, slope]
}
