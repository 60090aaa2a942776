//! Table of the complex stiffness over the displacement amplitude: a few polynomials, for all amplitudes.
//!
//! In units of the initial stiffness and of the displacement of gross slip, with amplitude ξ, displacement x, `ρ = 1 - x` and the
//! tangent stiffness k,
//!
//! ```text
//! K'  = (8/(π ξ²)) ∫ sqrt(ρ - e) φ dρ,     e = 1 - ξ,     φ = sqrt(1 - ρ) k,     from max(e, 0) to 1
//! K'' = E/(π ξ²),                          E = 4 ∫ (ξ - 2x) k dx
//! ```
//!
//! Both are singular at gross slip: a power 3/2 of |e| times a series in e^(2/3) (flat) or in 1/ln e (cylinder). With
//!
//! ```text
//! K'  = (8/π) (I - e G(e))/ξ²              I = ∫ sqrt(ρ) φ dρ
//! G   = ∫ φ/(sqrt(ρ) + sqrt(ρ - e)) dρ + (1/e) ∫ sqrt(ρ) φ dρ      beyond e, and up to e if e > 0
//! E   = E_s - e R(e)                       R = 4 [C(e) (1 + e)/e - (2/e) ∫ ρ (1-k) dρ - C(1)],     C = ∫ (1-k) dρ     up to e
//! ```
//!
//! no digit is lost next to gross slip, and one polynomial in `u = (|e|/0.6)^(1/8)` represents G or R on each dyadic interval of u,
//! down to the rounding of ξ:
//!
//! - ξ <= 2/5: the first polynomial of the curve, integrated for each power;
//! - 2/5 < ξ <= 1: G and R in u; 1 < ξ <= 1.6: G in u, with |e| and its sign;
//! - beyond: `K' ξ^(3/2)` as a polynomial in 1/ξ. E is linear beyond 1.
//!
//! All are linear in k. Its values at Chebyshev points of the same intervals give all coefficients by constant matrices (`operators`).

mod operators;

use crate::constant_load::contact::Contact;
use crate::constant_load::interpolant::CYCLE_WEIGHTS;
use crate::numerics::chebyshev::{Interpolant, MORE_AROUND_MIDDLE, MORE_FROM_END, Polynomial, TERMS};
use crate::numerics::polynomial::{Rows, rows, value_and_slope};
use crate::shape::stick_zone::Complement;
use crate::simd::{dispatch, plus};
use crate::tag::Kind;
use core::array::from_fn;
use core::f64::consts::PI;
use operators::{FAR_TERMS, FIRST, Functionals, INNER_TAYLOR, OPERATORS, Operators, POINTS, TAYLOR, TOP};

/// Dyadic intervals of u: the last ends below the distance of any other amplitude from that of gross slip. The stiffness is needed on
/// one more.
const PIECES: usize = 7;
/// Rows of G below and beyond gross slip on all pieces but the first, on which it is nearly constant.
const ROWS_BELOW: usize = 5;
const ROWS_ABOVE: usize = 4;
/// Λ from which the polynomials are accurate: a singularity at a displacement of about -Λ² approaches the first ones.
const SMALLEST_COMPLIANCE: f64 = 0.9;
/// Smallest ξ of the last polynomial.
const FAR: f64 = 1.0 + TOP;
/// The first polynomial is used somewhat beyond its interval, where its error has hardly grown: at the end of the first piece, the
/// derivative is least accurate.
const OVERLAP: f64 = 0.02;

/// The polynomials of one shape.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub(crate) struct StiffnessTable {
    /// With count 0 if there are no polynomials.
    tag: f64,
    /// The shape: Λ and the shift of gross slip.
    shape: [f64; 2],
    /// (8/π) I and (8/π) G(0).
    moment: f64,
    slope_at_slip: f64,
    /// E_s/π, R(0)/π and 4 T(1)/π.
    slip_energy: f64,
    energy_slope_at_slip: f64,
    gross_slip_rate: f64,
    /// K' and K'' over y = ξ/(2/5).
    inner: [Polynomial; 2],
    /// K' ξ^(3/2) over 1.6/ξ.
    far: Rows<{ FAR_TERMS / 4 }>,
    /// (8/π) G over z = 4 2ʲ u - 3.
    below: Pieces<ROWS_BELOW>,
    above: Pieces<ROWS_ABOVE>,
    /// R/π.
    energy: Pieces<{ POINTS / 4 }>,
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
    first: Rows<{ FIRST / 4 }>,
    others: [Rows<R>; PIECES - 1],
}

impl<const R: usize> Pieces<R> {
    const NONE: Pieces<R> = Pieces { rows_of_first: 0.0, first: [[0.0; 4]; _], others: [[[0.0; 4]; R]; PIECES - 1] };

    #[inline(always)]
    fn value_and_slope(&self, place: &Place) -> (f64, f64) {
        match self.others.get(place.piece.wrapping_sub(1)) {
            Some(rows) => value_and_slope(rows, place.z),
            None => match self.first.first_chunk::<FEW_ROWS>() {
                Some(rows) if self.rows_of_first <= FEW_ROWS as f64 => value_and_slope(rows, place.z),
                _ => value_and_slope(&self.first, place.z),
            },
        }
    }

    #[inline(always)]
    fn set_first(&mut self, factor: f64, series: &[f64; FIRST]) {
        self.first = powers(&series.map(|term| factor * term));
        let used = self.first.iter().rposition(|row| row.iter().any(|power| *power != 0.0));
        self.rows_of_first = used.map_or(0.0, |last| (last + 1) as f64);
    }
}

/// Piece and argument of a distance |e| from gross slip.
struct Place {
    piece: usize,
    z: f64,
}

impl Place {
    /// The place of `u = (|e|/0.6)^(1/8)`; `None` at gross slip itself.
    #[inline(always)]
    fn of(u: f64) -> Option<Place> {
        let exponent = (u.to_bits() >> 52).min(1022);
        let piece = (1022 - exponent) as usize;
        let scale = f64::from_bits((2047 - 2 - exponent) << 52);
        (piece < PIECES).then_some(Place { piece, z: 4.0 * (scale * u) - 3.0 })
    }

    /// `d(|e| f)/d|e|` of a function f of z with that value and slope.
    #[inline(always)]
    fn product_slope(&self, (value, slope): (f64, f64)) -> f64 {
        value + 0.125 * (self.z + 3.0) * slope
    }
}

/// K', K'' and their derivatives, each if it is requested.
pub(crate) type StiffnessOutputs<'a> = [Option<&'a mut [f64]>; 4];

#[inline(always)]
fn write_values<const N: usize>(values: [[ValueAndSlope; 2]; N], first: usize, outputs: &mut StiffnessOutputs) {
    for (i, [(real, d_real), (imaginary, d_imaginary)]) in values.into_iter().enumerate() {
        for (output, value) in outputs.iter_mut().zip([real, imaginary, d_real, d_imaginary]) {
            if let Some(place) = output.as_deref_mut().and_then(|values| values.get_mut(first + i)) {
                *place = value;
            }
        }
    }
}

/// K' or K'' and its derivative with respect to the amplitude.
type ValueAndSlope = (f64, f64);

impl StiffnessTable {
    pub const EMPTY: StiffnessTable = StiffnessTable {
        tag: Kind::StiffnessTable.tag(0),
        shape: [0.0; 2],
        moment: 0.0,
        slope_at_slip: 0.0,
        slip_energy: 0.0,
        energy_slope_at_slip: 0.0,
        gross_slip_rate: 0.0,
        inner: [[[0.0; 4]; 5]; 2],
        far: [[0.0; 4]; FAR_TERMS / 4],
        below: Pieces::NONE,
        above: Pieces::NONE,
        energy: Pieces::NONE,
    };

    /// Initialises the table of the shape of a contact, in place.
    #[inline(never)]
    pub fn init(&mut self, contact: &Contact) {
        *self = StiffnessTable::EMPTY;
        self.shape = shape_of(contact);
        let mut curve = Curve::EMPTY;
        if curve.init(contact) {
            self.tag = Kind::StiffnessTable.tag(1);
            self.fill(contact, &curve);
        }
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

    /// K' and K'' at N amplitudes \[m\] of a contact with friction of this shape, each if it is requested.
    #[inline(always)]
    pub fn at<const REAL: bool, const IMAGINARY: bool, const N: usize>(
        &self,
        contact: &Contact,
        amplitude: &[f64; N],
    ) -> [[ValueAndSlope; 2]; N] {
        let (unit, per_slip) = (contact.initial_stiffness, contact.per_slip_displacement());
        let e = amplitude.map(|amplitude| (contact.slip_displacement - amplitude) * per_slip);
        // Roots of several take the time of one.
        let u = e.map(|e| (e.abs() * (1.0 / TOP)).sqrt().sqrt().sqrt());
        from_fn(|i| {
            let values = self.at_fraction::<REAL, IMAGINARY>(amplitude[i] * per_slip, e[i], u[i]);
            values.map(|(value, slope)| (unit * value, unit * per_slip * slope))
        })
    }

    /// Writes what is requested of K', K'' and their derivatives at amplitudes \[m\] of a contact with friction of this shape.
    #[inline(always)]
    pub fn write(&self, contact: &Contact, amplitude: &[f64], outputs: StiffnessOutputs) {
        let table = self;
        dispatch!(
            StiffnessTable::write_kernel,
            table: &StiffnessTable,
            contact: &Contact,
            amplitude: &[f64],
            outputs: StiffnessOutputs => ()
        );
    }

    #[inline(always)]
    fn write_kernel(&self, contact: &Contact, amplitude: &[f64], mut outputs: StiffnessOutputs) {
        let requested = [outputs[0].is_some() || outputs[2].is_some(), outputs[1].is_some() || outputs[3].is_some()];
        let (fours, rest) = amplitude.as_chunks::<4>();
        for (i, four) in fours.iter().enumerate() {
            write_values(self.parts(contact, four, requested), 4 * i, &mut outputs);
        }
        for (i, one) in rest.as_chunks::<1>().0.iter().enumerate() {
            write_values(self.parts(contact, one, requested), 4 * fours.len() + i, &mut outputs);
        }
    }

    #[inline(always)]
    fn parts<const N: usize>(
        &self,
        contact: &Contact,
        amplitude: &[f64; N],
        requested: [bool; 2],
    ) -> [[ValueAndSlope; 2]; N] {
        match requested {
            [true, true] => self.at::<true, true, N>(contact, amplitude),
            [true, false] => self.at::<true, false, N>(contact, amplitude),
            _ => self.at::<false, true, N>(contact, amplitude),
        }
    }

    /// At ξ = 1 - e, in units of the initial stiffness.
    #[inline(always)]
    fn at_fraction<const REAL: bool, const IMAGINARY: bool>(&self, xi: f64, e: f64, u: f64) -> [ValueAndSlope; 2] {
        if xi <= 1.0 - TOP + OVERLAP {
            let scale = const { 1.0 / (1.0 - TOP) };
            let part = |requested: bool, polynomial: &Polynomial| {
                if !requested {
                    return (0.0, 0.0);
                }
                let (value, slope) = value_and_slope(polynomial, scale * xi);
                (value, scale * slope)
            };
            let [real, imaginary] = &self.inner;
            [part(REAL, real), part(IMAGINARY, imaginary)]
        } else {
            let (per_xi, place) = (1.0 / xi, Place::of(u));
            let real = if REAL { self.outer_real(xi, per_xi, e, place.as_ref()) } else { (0.0, 0.0) };
            [real, if IMAGINARY { self.outer_imaginary(per_xi, e, place.as_ref()) } else { (0.0, 0.0) }]
        }
    }

    /// K' beyond the first polynomial.
    #[inline(always)]
    fn outer_real(&self, xi: f64, per_xi: f64, e: f64, place: Option<&Place>) -> ValueAndSlope {
        if xi > FAR {
            let (value, slope) = value_and_slope(&self.far, FAR * per_xi);
            let factor = per_xi * per_xi.sqrt();
            return (factor * value, -factor * per_xi * (1.5 * value + FAR * per_xi * slope));
        }
        let (value, rate) = match place {
            Some(place) => {
                let g = if e > 0.0 { self.below.value_and_slope(place) } else { self.above.value_and_slope(place) };
                (g.0, place.product_slope(g))
            }
            None => (self.slope_at_slip, self.slope_at_slip),
        };
        let real = (self.moment - e * value) * per_xi * per_xi;
        (real, (rate * per_xi - 2.0 * real) * per_xi)
    }

    /// K'' beyond the first polynomial.
    #[inline(always)]
    fn outer_imaginary(&self, per_xi: f64, e: f64, place: Option<&Place>) -> ValueAndSlope {
        let (value, rate) = match place {
            _ if e <= 0.0 => (self.gross_slip_rate, self.gross_slip_rate),
            Some(place) => {
                let r = self.energy.value_and_slope(place);
                (r.0, place.product_slope(r))
            }
            None => (self.energy_slope_at_slip, self.energy_slope_at_slip),
        };
        let imaginary = (self.slip_energy - e * value) * per_xi * per_xi;
        (imaginary, (rate * per_xi - 2.0 * imaginary) * per_xi)
    }
}

/// Powers of z of the first terms of a Chebyshev series, without those at its end that are rounding errors: their derivatives would
/// be n² times as large.
fn powers<const N: usize, const R: usize>(series: &[f64; N]) -> Rows<R> {
    let size = series.iter().fold(0.0, |size: f64, term| size.max(term.abs()));
    let used = series.iter().rposition(|term| term.abs() > f64::EPSILON * size).map_or(0, |last| last + 1);
    let mut sums = [0.0; FIRST];
    let used = series.get(..used.min(4 * R)).unwrap_or(&[]);
    apply_columns(&mut sums, 1.0, MORE_AROUND_MIDDLE.as_flattened(), used, FIRST);
    let mut result = [[0.0; 4]; R];
    result.iter_mut().zip(sums.as_chunks().0).for_each(|(row, sum)| *row = *sum);
    result
}

/// Adds the first terms of a constant series times a factor.
#[inline(never)]
fn add(series: &mut [f64], factor: f64, term: &[f64]) {
    series.iter_mut().zip(term).for_each(|(sum, term)| *sum += factor * term);
}

/// Adds an operator applied to inputs, times a factor.
fn apply<const M: usize, const N: usize>(series: &mut [f64], factor: f64, operator: &[[f64; N]; M], inputs: &[f64; M]) {
    apply_columns(series, factor, operator.as_flattened(), inputs, N);
}

/// One function for operators of all sizes; the rows of all are multiples of four.
#[inline(always)]
fn apply_columns(series: &mut [f64], factor: f64, operator: &[f64], inputs: &[f64], rows: usize) {
    dispatch!(columns_kernel, series: &mut [f64], factor: f64, operator: &[f64], inputs: &[f64], rows: usize => ());
}

#[inline(always)]
fn columns_kernel(series: &mut [f64], factor: f64, operator: &[f64], inputs: &[f64], rows: usize) {
    let (strips, rest) = series.as_chunks_mut::<4>().0.as_chunks_mut::<4>();
    let done = 4 * strips.len();
    for (strip, sums) in strips.iter_mut().enumerate() {
        add_columns(sums, 4 * strip, factor, operator, inputs, rows);
    }
    for (block, sums) in rest.as_chunks_mut::<1>().0.iter_mut().enumerate() {
        add_columns(sums, done + block, factor, operator, inputs, rows);
    }
}

/// Blocks of four rows, which stay in registers.
#[inline(always)]
fn add_columns<const BLOCKS: usize>(
    sums: &mut [[f64; 4]; BLOCKS],
    first: usize,
    factor: f64,
    operator: &[f64],
    inputs: &[f64],
    rows: usize,
) {
    let mut strip = *sums;
    for (column, input) in operator.chunks_exact(rows.max(1)).zip(inputs) {
        let scale = factor * input;
        if let Some(terms) = column.as_chunks::<4>().0.get(first..).and_then(<[_]>::first_chunk::<BLOCKS>) {
            for block in 0..BLOCKS {
                strip[block] = plus(strip[block], scale, terms[block]);
            }
        }
    }
    *sums = strip;
}

/// Products of the rows of a matrix with the values.
#[inline(always)]
fn dots(matrix: &[f64], values: &[f64], products: &mut [f64]) {
    dispatch!(dots_kernel, matrix: &[f64], values: &[f64], products: &mut [f64] => ());
}

#[inline(always)]
fn dots_kernel(matrix: &[f64], values: &[f64], products: &mut [f64]) {
    for (product, row) in products.iter_mut().zip(matrix.chunks_exact(values.len().max(1))) {
        *product = dot(row, values);
    }
}

#[inline(always)]
fn dot(weights: &[f64], values: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (weights, values) in weights.as_chunks::<4>().0.iter().zip(values.as_chunks::<4>().0) {
        for lane in 0..4 {
            sums[lane] += weights[lane] * values[lane];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3])
}

/// What a table needs of a piece of the curve, with `ρ = scale s`.
struct Input<const N: usize> {
    scale: f64,
    root: f64,
    /// φ (on the first piece k) and 1 - k at the points.
    phi: [f64; N],
    decrease: [f64; N],
}

/// The curve in units of the initial stiffness and of the displacement of gross slip.
struct Curve {
    /// Secant stiffness over y: coefficients of its powers.
    secant: [f64; TERMS],
    first: Input<FIRST>,
    others: [Input<POINTS>; PIECES],
}

fn shape_of(contact: &Contact) -> [f64; 2] {
    let zones = contact.stick_zones();
    [zones.small_load().compliance, zones.slip_shift()]
}

impl Curve {
    const EMPTY: Curve = Curve { secant: [0.0; TERMS], first: Input::EMPTY, others: [Input::EMPTY; PIECES] };

    /// `false` without friction, for small Λ, and with a layer whose N_c is small.
    #[inline(never)]
    fn init(&mut self, contact: &Contact) -> bool {
        let [compliance, slip_shift] = shape_of(contact);
        if contact.is_frictionless() || compliance < SMALLEST_COMPLIANCE || contact.has_knee() {
            return false;
        }
        let series = contact.stick_zones().small_load();
        let layered = contact.layered_zones();
        let (mut with_layer, mut without) = (layered.sequence(), layered.flat.sequence());
        let mut sequence =
            |remaining: f64| if contact.is_layered() { with_layer(remaining) } else { without(remaining) };
        // 1 - k where x and ρ are given.
        let mut decrease_at = |consumed: f64, remaining: f64| {
            if contact.is_elementary() {
                return consumed / (1.0 + remaining.sqrt());
            }
            let shift = Complement { consumed: slip_shift * consumed, remaining: slip_shift * remaining };
            let increase = if shift.consumed <= series.half_shift {
                series.at_shift(shift).compliance_increase
            } else {
                sequence(shift.remaining).compliance_increase
            };
            increase / (compliance + increase)
        };
        let decrease = Interpolant::<TERMS>::through(|z| {
            let x = 0.5 * (1.0 + z) * (1.0 - TOP);
            decrease_at(x, 1.0 - x)
        });
        self.secant.iter_mut().zip(decrease.mean_from_end().as_flattened()).for_each(|(to, from)| *to = -from);
        if let Some(first) = self.secant.first_mut() {
            *first = 1.0;
        }
        let mut scale = TOP;
        self.first.init(scale, &mut decrease_at);
        for other in &mut self.others {
            scale *= 1.0 / 256.0;
            other.init(scale, &mut decrease_at);
        }
        true
    }
}

impl<const N: usize> Input<N> {
    const EMPTY: Input<N> = Input { scale: 0.0, root: 0.0, phi: [0.0; N], decrease: [0.0; N] };

    fn init(&mut self, scale: f64, decrease_at: &mut impl FnMut(f64, f64) -> f64) {
        (self.scale, self.root) = (scale, scale.sqrt());
        let points = const { &Interpolant::<N>::POINTS };
        for ((phi, decrease), z) in self.phi.iter_mut().zip(&mut self.decrease).zip(points) {
            let v = 0.25 * (3.0 + z);
            let square = v * v;
            let rho = scale * ((square * square) * (square * square));
            *decrease = decrease_at(1.0 - rho, rho);
            *phi = if scale < TOP { (1.0 - rho).sqrt() } else { 1.0 } * (1.0 - *decrease);
        }
    }

    fn moments(&self, functionals: &Functionals<N>) -> Moments {
        let Input { scale, root, phi, decrease } = self;
        let mut moments = Moments { root: 0.0, roots: [0.0; _], powers: [[0.0; _]; 2] };
        let [mut per_scale, mut power] = [*root, 1.0];
        dots(functionals.root_moments.as_flattened(), phi, &mut moments.roots);
        for product in &mut moments.roots {
            *product *= per_scale;
            per_scale /= scale;
        }
        let [of_phi, of_decrease] = &mut moments.powers;
        dots(functionals.moments.as_flattened(), phi, of_phi);
        dots(functionals.moments.as_flattened(), decrease, of_decrease);
        for (of_phi, of_decrease) in of_phi.iter_mut().zip(of_decrease) {
            power *= scale;
            *of_phi *= power;
            *of_decrease *= power;
        }
        moments.root = scale * root * dot(&functionals.root_moment, phi);
        moments
    }
}

/// Integrals over a piece, of φ or for the last of φ and 1 - k.
#[derive(Clone, Copy)]
struct Moments {
    /// Times `sqrt(ρ)` and `ρ^(-1/2-k)`, and both times `ρ^k`.
    root: f64,
    roots: [f64; TAYLOR],
    powers: [[f64; INNER_TAYLOR]; 2],
}

/// `|binomial(1/2, k + 1)|`: coefficients of `1/(sqrt(s) + sqrt(s - e))` in `e^k s^(-1/2-k)`.
const DIFFERENCES: [f64; TAYLOR] = {
    let mut table = [0.5; TAYLOR];
    let mut k = 1;
    while k < TAYLOR {
        table[k] = table[k - 1] * (k as f64 - 0.5) / (k as f64 + 1.0);
        k += 1;
    }
    table
};

impl StiffnessTable {
    fn fill(&mut self, contact: &Contact, curve: &Curve) {
        let Curve { secant, first, others } = curve;
        let n = from_fn::<f64, TERMS, _>(|n| n as f64);
        let mut tangent = *secant;
        tangent.iter_mut().zip(n).for_each(|(power, n)| *power *= n + 1.0);
        let mut inner = [*secant; 2];
        inner[0].iter_mut().zip(CYCLE_WEIGHTS.as_flattened()).for_each(|(power, weight)| *power *= weight);
        inner[1].iter_mut().zip(n).for_each(|(power, n)| *power *= -4.0 / PI * n / (n + 2.0));
        self.inner = inner.each_ref().map(rows);

        // Those of the first piece, of the others, and of what remains, where the stiffness is constant.
        let mut moments = [first.moments(&OPERATORS.of_first); PIECES + 2];
        moments
            .iter_mut()
            .skip(1)
            .zip(others)
            .for_each(|(moments, other)| *moments = other.moments(&OPERATORS.of_others));
        {
            let [.., rest] = &mut moments;
            let [.., Input { scale, phi: [.., phi], decrease: [.., decrease], .. }] = others;
            let size = scale * (1.0 / 256.0);
            *rest = Moments { root: 0.0, roots: [0.0; _], powers: [[0.0; _]; 2] };
            rest.roots[0] = 2.0 * size.sqrt() * phi;
            (rest.powers[0][0], rest.powers[1][0]) = (size * phi, size * decrease);
        }
        // From the smallest piece on.
        let sum = |from: usize, of: &dyn Fn(&Moments) -> f64| moments.iter().skip(from).rev().map(of).sum::<f64>();
        let mut outer = [0.0; TAYLOR];
        dots(OPERATORS.outer_root_moments.as_flattened(), &tangent, &mut outer);
        self.moment = 8.0 / PI * (dot(&OPERATORS.outer_root_moment, &tangent) + sum(0, &|of| of.root));
        self.slope_at_slip = 4.0 / PI * (outer[0] + sum(0, &|of| of.roots[0]));
        let decrease = sum(0, &|of| of.powers[1][0]) - (1.0 - TOP) * secant.iter().skip(1).sum::<f64>();
        let slip_force = self.shape[0] / self.shape[1];
        self.slip_energy = contact.slip_energy / contact.slip_force / contact.slip_displacement * slip_force / PI;
        self.energy_slope_at_slip = 4.0 / PI * (1.0 - contact.stiffness_at_slip() - decrease);
        self.gross_slip_rate = 4.0 / PI * slip_force;

        let mut far = [0.0; FAR_TERMS];
        apply(&mut far, 1.0, &OPERATORS.far, &tangent);
        apply(&mut far, first.scale, &OPERATORS.far_first, &first.phi);
        let [second, ..] = others;
        apply(&mut far, second.scale, &OPERATORS.far_second, &second.phi);
        for (k, series) in OPERATORS.far_roots.iter().enumerate() {
            add(&mut far, sum(2, &|of| of.powers[0][k]), series);
        }
        let mut far_powers = [0.0; FAR_TERMS];
        apply(&mut far_powers, 8.0 / PI, &MORE_FROM_END, &far);
        self.far = rows(&far_powers);

        let closer_than = |j: usize| moments.get(j + 1..).unwrap_or(&[]);
        let (mut below, mut above, energy) =
            own_terms::<FIRST, FIRST>(first, second, &OPERATORS.to_first, closer_than(0), decrease);
        apply(&mut below, 1.0, &OPERATORS.outer_below, &tangent);
        apply(&mut above, 1.0, &OPERATORS.outer_above, &tangent);
        self.below.set_first(8.0 / PI, &below);
        self.above.set_first(8.0 / PI, &above);
        self.energy.set_first(4.0 / PI, &energy);

        // Coefficients of e^k of all beyond the next piece.
        let mut distant = outer;
        let mut next: Option<&Input<POINTS>> = None;
        let targets = self.below.others.iter_mut().zip(&mut self.above.others).zip(&mut self.energy.others);
        for (j, (own, before), ((below_rows, above_rows), energy_rows)) in
            others.windows(2).zip(targets).enumerate().filter_map(|(i, (pair, targets))| match pair {
                [own, before] => Some((i + 1, (own, before), targets)),
                _ => None,
            })
        {
            let (mut below, mut above, energy) =
                own_terms::<POINTS, { 4 * ROWS_ABOVE }>(own, before, &OPERATORS.to_others, closer_than(j), decrease);
            match next {
                None => {
                    apply(&mut below, first.root, &OPERATORS.of_first.below_next, &first.phi);
                    apply(&mut above, first.root, &OPERATORS.of_first.above_next, &first.phi);
                }
                Some(next) => {
                    apply(&mut below, next.root, &OPERATORS.of_others.below_next, &next.phi);
                    apply(&mut above, next.root, &OPERATORS.of_others.above_next, &next.phi);
                    if let Some(farther) = moments.get(j - 2) {
                        add(&mut distant, 1.0, &farther.roots);
                    }
                }
            }
            let mut power = 1.0;
            for ((k, series), (difference, sum)) in
                OPERATORS.powers.iter().enumerate().zip(DIFFERENCES.iter().zip(&distant))
            {
                add(&mut below, difference * power * sum, series);
                add(&mut above, if k % 2 == 0 { difference * power * sum } else { -difference * power * sum }, series);
                power *= own.scale;
            }
            *below_rows = powers(&below.map(|term| 8.0 / PI * term));
            *above_rows = powers(&above.map(|term| 8.0 / PI * term));
            *energy_rows = powers(&energy.map(|term| 4.0 / PI * term));
            next = Some(own);
        }
    }
}

/// Series of G below and beyond gross slip and of R/4 on a piece: what the piece itself and all closer to gross slip give, and all of
/// R/4.
fn own_terms<const N: usize, const M: usize>(
    own: &Input<N>,
    before: &Input<POINTS>,
    operators: &Operators<N>,
    closer: &[Moments],
    total_decrease: f64,
) -> ([f64; N], [f64; M], [f64; N]) {
    let sum = |from: usize, of: &dyn Fn(&Moments) -> f64| closer.iter().skip(from).rev().map(of).sum::<f64>();
    let per_scale = 1.0 / own.scale;
    let (mut below, mut above, mut energy) = ([0.0; N], [0.0; M], [0.0; N]);
    apply(&mut below, own.root, &operators.below, &own.phi);
    add(&mut below, per_scale * sum(0, &|of| of.root), &operators.inverse);

    apply(&mut above, own.root, &operators.above, &own.phi);
    apply(&mut above, before.root, &operators.above_before, &before.phi);
    add(&mut above, -per_scale * sum(1, &|of| of.root), &operators.inverse);
    let mut binomial = 1.0 / own.root;
    for (k, series) in operators.inverse_roots.iter().enumerate() {
        add(&mut above, binomial * sum(1, &|of| of.powers[0][k]), series);
        binomial *= (0.5 - k as f64) / (k as f64 + 1.0) * per_scale;
    }

    apply(&mut energy, 1.0, &operators.mean, &own.decrease);
    apply(&mut energy, own.scale, &operators.energy, &own.decrease);
    let [zeroth, first] = [0, 1].map(|k| sum(0, &|of| of.powers[1][k]));
    add(&mut energy, per_scale * (zeroth - 2.0 * first), &operators.inverse);
    if let Some(constant) = energy.first_mut() {
        *constant += zeroth - total_decrease;
    }
    (below, above, energy)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constant_load::contact::tests::{FLATS, contact, cylinder, ellipse, parameters};
    use crate::parameters::{CENTRE_POINT, Parameters};

    fn table_of(contact: &Contact) -> StiffnessTable {
        let mut table = StiffnessTable::EMPTY;
        table.init(contact);
        table
    }

    /// Against the rules and the quadrature over the curve, whose derivative is off by up to 2e-12 just beyond gross slip.
    #[test]
    fn table_agrees_with_quadrature_at_all_amplitudes() {
        let short = cylinder(2.5, 0.0, CENTRE_POINT).unwrap();
        for contact in FLATS.map(contact).into_iter().chain([ellipse(1e-4, 2e-4), short]) {
            let table = table_of(&contact);
            assert!(table.has_polynomials());
            let near = (1..16).map(|k| 0.1f64.powi(k));
            let fractions = (0..80).map(|k| 0.03125 * f64::from(k) + 1e-3).chain([3.0, 20.0, 1e6, 1e100]);
            for fraction in fractions.chain(near.flat_map(|e| [1.0 - e, 1.0 + e])) {
                let amplitude = fraction * contact.slip_displacement;
                let [[(real, d_real), (imaginary, d_imaginary)]] = table.at::<true, true, 1>(&contact, &[amplitude]);
                let exact = contact.complex_stiffness(amplitude).unwrap();
                let (exact_real, exact_d_real) = exact.real_with_derivative();
                let (exact_imaginary, exact_d_imaginary) = exact.imaginary_with_derivative();
                let unit = exact_real.hypot(exact_imaginary);
                assert!((real - exact_real).abs() < 1e-14 * exact_real, "{fraction}");
                assert!((imaginary - exact_imaginary).abs() < 1e-13 * exact_imaginary, "{fraction}");
                let (slope, d_slope) =
                    (amplitude * (d_real - exact_d_real), amplitude * (d_imaginary - exact_d_imaginary));
                let just_beyond = (1.0..1.0 + 1e-9).contains(&fraction);
                assert!(slope.abs() < if just_beyond { 2e-12 } else { 3e-13 } * unit, "{fraction} {}", slope / unit);
                assert!(d_slope.abs() < 2e-13 * unit, "{fraction} {}", d_slope / unit);
            }
        }
    }

    /// Also against quadrature; with a small N_c there are no polynomials.
    #[test]
    fn tables_with_layers_agree_with_quadrature() {
        use crate::constant_load::contact::tests::layered;
        for (share, ratio) in [(0.3, 0.0), (10.0, 0.0), (0.1, 0.26), (1.0, 0.3), (3.0, 1.0)] {
            for contact in layered(share, ratio) {
                let table = table_of(&contact);
                assert!(table.has_polynomials() && !table.is_of(&layered(1.01 * share, ratio)[0]));
                for fraction in (0..40).map(|k| 0.0625 * f64::from(k) + 1e-3).chain([0.9999, 1.001, 20.0]) {
                    let amplitude = fraction * contact.slip_displacement;
                    let [[(real, d_real), (imaginary, d_imaginary)]] =
                        table.at::<true, true, 1>(&contact, &[amplitude]);
                    let exact = contact.complex_stiffness(amplitude).unwrap();
                    let (exact_real, exact_d_real) = exact.real_with_derivative();
                    let (exact_imaginary, exact_d_imaginary) = exact.imaginary_with_derivative();
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
                let [end, start] = [Place { piece, z: 1.0 }, Place { piece: piece - 1, z: -1.0 }];
                let [one, other] = [end, start].map(|place| {
                    let values = pieces.value_and_slope(&place);
                    (values.0, place.product_slope(values))
                });
                // Functions of order 1, of which K' and K'' contain e times the value and, from 20 terms, the derivative.
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
            let last = Place { piece: PIECES - 1, z: -1.0 };
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
        // Too short for polynomials, and without friction.
        let short = cylinder(1.0 + 1e-6, 0.0, CENTRE_POINT).unwrap();
        assert!(!table_of(&short).has_polynomials());
        assert!(!table_of(&of(&|changed| changed.friction_coefficient = 0.0)).has_polynomials());
    }
}
