//! Table of the complex stiffness over the displacement amplitude: a few polynomials, for all amplitudes.
//!
//! In units of the initial stiffness and of the displacement of gross slip, with amplitude x_0, `ρ_0 = 1 - x_0`, and F, W those of
//! a cycle,
//!
//! ```text
//! K'  = (8/(π x_0²)) (F(1) - ρ_0 G(ρ_0))        G = (1/ρ_0) ∫ dF/dx_0 dρ_0'      from 0 to ρ_0
//! K'' = (1/(π x_0²)) (W(1) - ρ_0 V(ρ_0))        V = (1/ρ_0) ∫ dW/dx_0 dρ_0'
//! ```
//!
//! Both are singular at gross slip: a power 3/2 of |ρ_0| times a series in ρ_0^(2/3) (flat) or in 1/ln ρ_0 (cylinder). In this form
//! no digit is lost next to gross slip, and one polynomial in `z = (|ρ_0|/0.6)^(1/8)` represents G or V on each dyadic interval of
//! z, down to the rounding of x_0:
//!
//! - x_0 <= 2/5: the first polynomial of the curve, integrated for each power;
//! - 2/5 < x_0 <= 1: G and V in z; 1 < x_0 <= 1.56: G in z, with |ρ_0| and its sign;
//! - beyond: `K' x_0^(3/2)` as a polynomial in 1/x_0. W is linear beyond 1.
//!
//! dF/dx_0 and dW/dx_0, those of a single call, are interpolated first.

use crate::constant_load::complex_stiffness::{StiffnessOutputs, ValueAndSlope, requested, write_values};
use crate::constant_load::contact::Contact;
use crate::constant_load::interpolant::{CYCLE_WEIGHTS, INNER_FRACTION};
use crate::constant_load::interpolant::{DyadicPlace, ENERGY_WEIGHTS, eighth_root, weighted};
use crate::numerics::chebyshev::{Interpolant, Polynomial, powers};
use crate::numerics::polynomial::{Rows, rows, sum, value_and_slope};
use crate::numerics::quadrature::gauss;
use crate::shape::Complement;
use crate::tag::Kind;
use core::f64::consts::PI;

/// Dyadic intervals of z: the last ends below the distance of any other amplitude from that of gross slip.
const PIECES: usize = 7;
/// Interpolation points.
const POINTS: usize = 32;
/// Rows of G below and beyond gross slip and of V on all pieces but the first, which is the closest to singularities beyond zero
/// displacement.
const ROWS_BELOW: usize = 5;
const ROWS_ABOVE: usize = 4;
const ROWS_OF_ENERGY: usize = 6;
/// Largest ρ_0 of the first piece.
const TOP: f64 = 1.0 - INNER_FRACTION;
/// Λ from which the polynomials are accurate: a singularity at a displacement of about -Λ² approaches the first ones.
const SMALLEST_COMPLIANCE: f64 = 0.9;
/// Smallest x_0 of the last polynomial, and its terms: the derivative of those that are left out is n² times as large.
const FAR: f64 = 1.5;
const FAR_TERMS: usize = 24;
/// The first polynomial is used somewhat beyond its interval, where its error has hardly grown, the last one from within its own: at
/// the end of a piece, the derivative is least accurate, by up to n² times the error of the interpolated values.
const OVERLAP: f64 = 0.02;
/// Largest x_0 of the pieces beyond gross slip.
const NEAR: f64 = 1.0 + TOP - 2.0 * OVERLAP;

/// The polynomials of one shape.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct StiffnessTable {
    /// With count 0 if there are no polynomials.
    tag: f64,
    /// The shape: Λ and the shift of gross slip.
    shape: [f64; 2],
    /// (8/π) F(1) and (8/π) G(0).
    moment: f64,
    slope_at_slip: f64,
    /// W(1)/π and 4 T(1)/π.
    slip_energy: f64,
    gross_slip_rate: f64,
    /// K' and K'' over x_0/(2/5).
    inner: [Polynomial; 2],
    /// K' x_0^(3/2) over 1.5/x_0.
    far: Rows<{ FAR_TERMS / 4 }>,
    /// (8/π) G over 4 2ʲ z - 3.
    below: Pieces<ROWS_BELOW>,
    above: Pieces<ROWS_ABOVE>,
    /// V/π.
    energy: Pieces<ROWS_OF_ENERGY>,
}

/// Length of a table in doubles.
pub(crate) const TABLE_LENGTH: usize = size_of::<StiffnessTable>() / size_of::<f64>();

/// Rows of the first polynomial that are enough unless Λ is near 1.
const FEW_ROWS: usize = 6;

/// Polynomials on the dyadic intervals: the function is nearly constant on all but the first.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
struct Pieces<const R: usize> {
    /// Rows of the first polynomial that are not 0.
    rows_of_first: f64,
    first: Rows<{ POINTS / 4 }>,
    others: [Rows<R>; PIECES - 1],
}

impl<const R: usize> Default for Pieces<R> {
    fn default() -> Self {
        Pieces { rows_of_first: 0.0, first: [[0.0; 4]; _], others: [[[0.0; 4]; R]; _] }
    }
}

impl<const R: usize> Pieces<R> {
    /// The mean over (0, d) of a function of a distance d up to TOP, which is interpolated on some pieces first. It is a sum over pieces:
    /// for a small a/b, one of them contains singularities close to the real axis, to which a rule over (0, d) would not converge.
    fn mean_of(more: usize, rate: &dyn Fn(f64) -> f64) -> Pieces<R> {
        let (mut pieces, mut mean_below) = (Pieces::default(), None);
        for piece in (0..more).rev() {
            let mean = mean_on(piece, &mut mean_below, rate);
            match pieces.others.get_mut(piece.wrapping_sub(1)) {
                Some(rows) => *rows = powers(mean.terms()),
                None if piece == 0 => pieces.first = powers(mean.terms()),
                None => {}
            }
        }
        let used = pieces.first.iter().rposition(|row| row.iter().any(|power| *power != 0.0));
        pieces.rows_of_first = used.map_or(0.0, |last| (last + 1) as f64);
        pieces
    }

    #[inline(always)]
    fn value_and_slope(&self, place: &DyadicPlace) -> (f64, f64) {
        match self.others.get(place.piece.wrapping_sub(1)) {
            Some(rows) => value_and_slope(rows, place.z),
            None => match self.first.first_chunk::<FEW_ROWS>() {
                Some(rows) if self.rows_of_first <= FEW_ROWS as f64 => value_and_slope(rows, place.z),
                _ => value_and_slope(&self.first, place.z),
            },
        }
    }
}

/// [`Pieces::mean_of`] on a piece; the mean over all pieces below becomes that of the piece besides.
#[inline(never)]
fn mean_on(piece: usize, mean_below: &mut Option<f64>, rate: &dyn Fn(f64) -> f64) -> Interpolant<POINTS> {
    let rates = Interpolant::<POINTS>::at_points(|z| rate(TOP * DyadicPlace { piece, z }.distance()));
    let rates: Rows<{ POINTS / 4 }> = powers(Interpolant::<POINTS>::through(&rates).terms());
    let rate = |z| sum(rates.into_iter(), z);
    let below = mean_below.unwrap_or_else(|| rate(-1.0));
    // The part below the piece, and ∫ 8 t⁷ f(d t⁸) dt from its end to 1.
    let mean = Interpolant::<POINTS>::through(&Interpolant::<POINTS>::at_points(|z| {
        let end = 2.0 / (3.0 + z);
        let on_piece = |t: f64| 8.0 * (t * (t * t) * (t * t) * (t * t)) * rate((3.0 + z) * t - 3.0);
        end.powi(8) * below + gauss(1.0 - end, |from_end| on_piece(end + from_end))
    }));
    *mean_below = Some(mean.terms().iter().sum());
    mean
}

impl StiffnessTable {
    /// Initialises the table of the shape of a contact, in place.
    #[inline(never)]
    pub fn init(&mut self, contact: &Contact) {
        *self = StiffnessTable::default();
        self.tag = Kind::StiffnessTable.tag(0);
        self.shape = shape_of(contact);
        let [compliance, _] = self.shape;
        if !contact.is_frictionless() && compliance >= SMALLEST_COMPLIANCE && !contact.has_knee() {
            self.tag = Kind::StiffnessTable.tag(1);
            self.fill(contact);
        }
    }

    fn fill(&mut self, contact: &Contact) {
        let (slip, initial) = (contact.slip_displacement, contact.initial_stiffness);
        let integrals =
            |rho_0: f64| contact.real_stiffness_integrals(1.0 - rho_0, rho_0).map(|integral| 8.0 / PI * integral);
        let amplitude = |rho_0: f64| Complement { consumed: slip * (1.0 - rho_0), remaining: slip * rho_0 };
        let energy_rate = |rho_0: f64| contact.cycle_energy(amplitude(rho_0)).1 / (PI * initial * slip);
        let secant = *contact.interpolant().secant();
        self.inner = [weighted(&secant, &CYCLE_WEIGHTS), weighted(&secant, &ENERGY_WEIGHTS)];
        self.inner[1].as_flattened_mut().iter_mut().for_each(|power| *power /= PI);
        [self.moment, self.slope_at_slip] = integrals(0.0);
        self.slip_energy = contact.slip_energy / (PI * initial * slip * slip);
        self.gross_slip_rate = 4.0 / PI * contact.slip_force / (initial * slip);
        let far = Interpolant::<POINTS>::through(&Interpolant::<POINTS>::at_points(|z| {
            let x_0 = 2.0 * FAR / (1.0 + z);
            integrals(1.0 - x_0)[0] / x_0.sqrt()
        }));
        self.far = rows(far.powers_from_end().first_chunk::<FAR_TERMS>().unwrap_or(&[0.0; _]));
        self.below = Pieces::mean_of(PIECES, &|rho_0| integrals(rho_0)[1]);
        // Beyond the last piece, this rate changes like the root of the distance, that of the energy of a cylinder like 1/ln.
        self.above = Pieces::mean_of(PIECES + 1, &|rho_0| integrals(-rho_0)[1]);
        self.energy = Pieces::mean_of(PIECES + 4, &energy_rate);
    }

    /// Whether the first double is that of a table, with polynomials or without.
    pub fn is_tag(tag: f64) -> bool {
        Kind::StiffnessTable.count(tag).is_some()
    }

    /// Whether it was made of a contact of this shape, up to the rounding of its parameters.
    #[inline(always)]
    pub fn is_of(&self, contact: &Contact) -> bool {
        let [one, other] = [self.shape, shape_of(contact)];
        (0..2).all(|i| (one[i] - other[i]).abs() <= 1e-13 * one[i].abs())
    }

    #[inline(always)]
    pub fn has_polynomials(&self) -> bool {
        Kind::StiffnessTable.count(self.tag) == Some(1)
    }

    /// Writes what is requested of K', K'' and their derivatives at checked amplitudes \[m\] of a contact of this shape.
    pub fn write(&self, contact: &Contact, amplitude: &[f64], mut outputs: StiffnessOutputs) {
        if !self.has_polynomials() || contact.is_frictionless() {
            let requested = requested(&outputs);
            let values = amplitude.iter().map(|&amplitude| contact.stiffness_of_cycle(amplitude, requested));
            values.enumerate().for_each(|(i, values)| write_values(values, i, &mut outputs));
            return;
        }
        let (fours, rest) = amplitude.as_chunks::<4>();
        (0..).step_by(4).zip(fours).for_each(|(i, four)| self.write_some(contact, four, i, &mut outputs));
        (4 * fours.len()..).zip(rest).for_each(|(i, one)| self.write_some(contact, &[*one], i, &mut outputs));
    }

    #[inline(always)]
    fn write_some<const N: usize>(
        &self,
        contact: &Contact,
        amplitude: &[f64; N],
        first: usize,
        outputs: &mut StiffnessOutputs,
    ) {
        let (requested, unit, per_slip) =
            (requested(outputs), contact.initial_stiffness, contact.per_slip_displacement);
        let rho_0 = amplitude.map(|amplitude| (contact.slip_displacement - amplitude) * per_slip);
        // Roots of several take the time of one.
        let roots = rho_0.map(|rho_0| eighth_root(rho_0.abs() * (1.0 / TOP)));
        for i in 0..N {
            let [real, imaginary] = self.at_fraction(requested, amplitude[i] * per_slip, rho_0[i], roots[i]);
            let scaled = |(value, slope): ValueAndSlope| (unit * value, unit * per_slip * slope);
            write_values([scaled(real), scaled(imaginary)], first + i, outputs);
        }
    }

    /// At x_0 = 1 - ρ_0, in units of the initial stiffness.
    #[inline(always)]
    fn at_fraction(&self, [has_real, has_imaginary]: [bool; 2], x_0: f64, rho_0: f64, root: f64) -> [ValueAndSlope; 2] {
        if x_0 <= 1.0 - TOP + OVERLAP {
            let scale = const { 1.0 / (1.0 - TOP) };
            let part = |requested: bool, polynomial: &Polynomial| {
                if !requested {
                    return (0.0, 0.0);
                }
                let (value, slope) = value_and_slope(polynomial, scale * x_0);
                (value, scale * slope)
            };
            let [real, imaginary] = &self.inner;
            [part(has_real, real), part(has_imaginary, imaginary)]
        } else {
            // The compiler may divide before the comparison.
            let (per_x_0, place) = (1.0 / x_0.max(1.0 - TOP), DyadicPlace::of(root, PIECES));
            let real = if has_real { self.outer_real(x_0, per_x_0, rho_0, &place) } else { (0.0, 0.0) };
            [real, if has_imaginary { self.outer_imaginary(per_x_0, rho_0, &place) } else { (0.0, 0.0) }]
        }
    }

    /// K' beyond the first polynomial.
    #[inline(always)]
    fn outer_real(&self, x_0: f64, per_x_0: f64, rho_0: f64, place: &DyadicPlace) -> ValueAndSlope {
        if x_0 > NEAR {
            let (value, slope) = value_and_slope(&self.far, FAR * per_x_0);
            let factor = per_x_0 * per_x_0.sqrt();
            return (factor * value, -factor * per_x_0 * (1.5 * value + FAR * per_x_0 * slope));
        }
        let g = if rho_0 > 0.0 { self.below.value_and_slope(place) } else { self.above.value_and_slope(place) };
        let (value, rate) = if rho_0 == 0.0 { (0.0, self.slope_at_slip) } else { (g.0, place.product_slope(g)) };
        let real = (self.moment - rho_0 * value) * per_x_0 * per_x_0;
        (real, (rate * per_x_0 - 2.0 * real) * per_x_0)
    }

    /// K'' beyond the first polynomial.
    #[inline(always)]
    fn outer_imaginary(&self, per_x_0: f64, rho_0: f64, place: &DyadicPlace) -> ValueAndSlope {
        let (value, rate) = if rho_0 > 0.0 {
            let r = self.energy.value_and_slope(place);
            (r.0, place.product_slope(r))
        } else {
            (self.gross_slip_rate, self.gross_slip_rate)
        };
        let imaginary = (self.slip_energy - rho_0 * value) * per_x_0 * per_x_0;
        (imaginary, (rate * per_x_0 - 2.0 * imaginary) * per_x_0)
    }
}

fn shape_of(contact: &Contact) -> [f64; 2] {
    let zones = contact.stick_zones();
    [zones.small_load.compliance, zones.slip_shift]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, ellipse, layered, parameters};
    use crate::parameters::Parameters;

    /// K' and K'' with their derivatives.
    fn values(table: &StiffnessTable, contact: &Contact, amplitude: f64) -> [f64; 4] {
        let mut values = [[0.0]; 4];
        table.write(contact, &[amplitude], values.each_mut().map(|value| Some(value.as_mut_slice())));
        values.map(|[value]| value)
    }

    fn table_of(contact: &Contact) -> StiffnessTable {
        let mut table = StiffnessTable::default();
        table.init(contact);
        table
    }

    /// Also against quadrature; with a small N_c there are no polynomials.
    #[test]
    fn tables_with_layers_agree_with_quadrature() {
        for (share, ratio) in [(0.3, 0.0), (10.0, 0.0), (0.1, 0.26), (1.0, 0.3), (3.0, 1.0)] {
            for contact in layered(share, ratio) {
                let table = table_of(&contact);
                assert!(table.has_polynomials());
                for fraction in (0..40).map(|k| 0.0625 * f64::from(k) + 1e-3).chain([0.9999, 1.001, 20.0]) {
                    let amplitude = fraction * contact.slip_displacement;
                    let [real, imaginary, d_real, d_imaginary] = values(&table, &contact, amplitude);
                    let exact = contact.complex_stiffness(amplitude).unwrap();
                    let (exact_real, exact_d_real) = (exact.real, exact.d_real);
                    let (exact_imaginary, exact_d_imaginary) = (exact.imaginary, exact.d_imag);
                    let unit = exact_real.hypot(exact_imaginary);
                    assert!((real - exact_real).abs() < 4e-14 * unit, "{share} {ratio} {fraction}");
                    assert!((imaginary - exact_imaginary).abs() < 1e-14 * unit, "{share} {ratio} {fraction}");
                    let slopes = [d_real - exact_d_real, d_imaginary - exact_d_imaginary];
                    assert!(
                        slopes.iter().all(|slope| (amplitude * slope).abs() < 2e-12 * unit),
                        "{share} {ratio} {fraction}"
                    );
                }
            }
        }
        assert!(layered(1.0, 0.2).iter().all(|contact| !table_of(contact).has_polynomials()));
    }

    #[test]
    fn pieces_join() {
        fn check<const R: usize>(pieces: &Pieces<R>) {
            for piece in 1..PIECES {
                let [end, start] = [DyadicPlace { piece, z: 1.0 }, DyadicPlace { piece: piece - 1, z: -1.0 }];
                let [one, other] = [end, start].map(|place| {
                    let values = pieces.value_and_slope(&place);
                    (values.0, place.product_slope(values))
                });
                // Functions of order 1, of which K' and K'' contain ρ_0 times the value and, from 20 terms, the derivative.
                let value = TOP * 256f64.powi(-(piece as i32)) * (one.0 - other.0);
                assert!(value.abs() < 1e-16 && (one.1 - other.1).abs() < 4e-13, "{piece} {one:?} {other:?}");
            }
        }
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4)]) {
            let table = table_of(&contact);
            check(&table.below);
            check(&table.above);
            check(&table.energy);
            // G is continuous at gross slip.
            let last = DyadicPlace { piece: PIECES - 1, z: -1.0 };
            let (below, above) = (table.below.value_and_slope(&last).0, table.above.value_and_slope(&last).0);
            assert!((below - table.slope_at_slip).abs() < 1e-8 && (above - table.slope_at_slip).abs() < 1e-8);
        }
    }

    #[test]
    fn contacts_that_differ_in_friction_or_scale_share_a_table() {
        let one = contact(50e-6);
        let table = table_of(&one);
        let of = |change: &dyn Fn(&mut Parameters)| {
            let mut changed = parameters(50e-6);
            change(&mut changed);
            Contact::rounded_flat(&changed).unwrap()
        };
        assert!(table.is_of(&one) && table.is_of(&of(&|changed| changed.friction_coefficient = 0.7)));
        assert!(table.is_of(&of(&|changed| {
            (changed.flat_half_width, changed.edge_radius) = (150e-6, 15e-3);
            (changed.length, changed.normal_force) = (30e-3, 9.0 * changed.normal_force);
        })));
        assert!(!table.is_of(&of(&|changed| changed.normal_force *= 1.001)) && !table.is_of(&ellipse(1e-4, 1e-4)));
        assert!(table_of(&ellipse(1e-4, 1e-4)).is_of(&ellipse(1e-4, 5e-4)));
        // The compliances agree, or the shifts: c (1 + σ) ln(1 + σ)/σ with the same sum.
        let (table, of_same_shift) = (table_of(&layered(1.0, 1.0)[0]), 2.0 * 2f64.ln() / (3.0 * 1.5f64.ln()));
        assert!([1.0, of_same_shift].iter().all(|share| !table.is_of(&layered(*share, 2.0)[0])));
        // Too short for polynomials, and without friction.
        let wide = (0.02 / 1.2 / contact(0.0).half_width).powi(2);
        let short = of(&|changed| (changed.flat_half_width, changed.normal_force) = (0.0, wide * changed.normal_force));
        assert!(!table_of(&short).has_polynomials());
        assert!(!table_of(&of(&|changed| changed.friction_coefficient = 0.0)).has_polynomials());
    }
}
