//! A friction contact element: the laws of a shape in tables that are independent of the load, so that one element serves all
//! contact points of a geometry.

mod table;

use crate::error::{Error, ensure};
use crate::limits::{MAX_DISPLACEMENT, check_force, in_range};
use crate::numerics::fp_class::{abs_le, in_0_to, le};
use crate::numerics::guard::quotient;
use crate::numerics::quadrature::gauss_nodes;
use crate::numerics::slices::PanicFreeSlice;
use crate::parameters::{Common, EllipticParameters, Parameters};
use crate::shape::{Geometry, LARGEST, LayerCompliance, Quantity, Shape};
use crate::tag::LAYOUT;
use core::array::from_fn;
pub(crate) use table::Curvature;
use table::{Quarters, Table};

/// Quantity that the normal component of a displacement gives: the approach w \[m\] or the normal force N \[N\].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NormalInput {
    /// The normal approach; not positive if the contact is open.
    Approach = 16,
    /// The normal force.
    Force = 17,
}

/// Number of tangential directions: a displacement is `[u, w]` or `[u, v, w]`, a force `[T, N]` or `[Tx, Ty, N]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Directions {
    /// The x direction.
    One = 1,
    /// The x and the y direction.
    Two = 2,
}

/// Components of a displacement of an element: the number of its tangential directions, and the quantity of its normal component.
pub(crate) type Components = (Directions, NormalInput);

/// An initialised element: plain data of fixed size that may be copied, stored and sent.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Element {
    /// E* of Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Coulomb's friction coefficient.
    pub friction_coefficient: f64,
    /// The largest normal force that the tables cover \[N\].
    pub normal_force: f64,
    /// Half-width under `normal_force` \[m\]; elliptical: the semi-axis x. The approach and both stiffnesses are those under
    /// `normal_force` too.
    pub half_width: f64,
    /// Normal approach \[m\].
    pub approach: f64,
    /// dN/d(approach) \[N/m\].
    pub normal_stiffness: f64,
    /// dT/d(displacement) of a fully stuck contact, x direction \[N/m\].
    pub tangential_stiffness: f64,
    /// [`Directions`] as an integer.
    pub directions: i32,
    /// [`NormalInput`] as an integer.
    pub normal_input: i32,
    tag: u64,
    /// Set by the C interface.
    pub(crate) checksum: u64,
    /// 1/(2 mu); 0 without friction.
    pub(crate) per_two_mu: f64,
    /// The largest normal force, approach and shift for which the laws hold.
    pub(crate) largest_load: f64,
    largest_approach: f64,
    pub(crate) largest_shift: f64,
    /// The contact counts as open up to this input, [`SMALLEST_LOAD`] or [`SMALLEST_OF_SPRINGS`] of that of the tables.
    smallest_input: f64,
    /// N, U and S under [`SMALLEST_LOAD`] of the normal force.
    smallest: [f64; 3],
    shape: Shape,
    /// The quantity of the normal law that is not the input: N(U) or U(N).
    of_input: Table,
    /// S as a function of the input.
    shift: Table,
    /// Coefficients of U and N in the linear relation that gives S; 0 with a layer, or if the input is the load: S is then
    /// interpolated in `shift`.
    shift_coefficients: [f64; 2],
    /// N(S).
    load_of_shift: Table,
    /// M at the middle of each quarter of `load_of_shift`.
    potential: Quarters<f64>,
    /// Coefficients of S along x and of N in the linear relation that gives S along y. If a layer is not linear, the relation
    /// holds without the shift of the layer, which is the same along x and y.
    shift_y_coefficients: [f64; 2],
    /// Hash of the shape and its load, by which a state detects another element.
    pub(crate) key: f64,
}

const TAG: u64 = (0x6d73_6c69_7065 << 16) | (LAYOUT << 8);

/// 2^40: loads of an element with a layer are at most this many times the normal force of the parameters.
const MOST_LOAD_WITH_LAYER: f64 = f64::from_bits((1023 + 40) << 52);

/// Units of rounding by which a sample of the normal force may be negative, over the sum of the magnitudes of its coefficients.
pub(crate) const NORMAL_FORCE_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// 2^-150: sizes of loads below this part of the normal force of the parameters are not distinguished, and a contact whose input is
/// below this part of that of the tables counts as open in a step. There squares and products would underflow.
pub(crate) const SMALLEST_LOAD: f64 = f64::from_bits((1023 - 150) << 52);

/// 2^-80: the part of the input below which a contact with two directions counts as open. At 1e-8 of the size of the parameters the
/// shell at the edge of a flat is 1e8 times as stiff as the others, and derivatives, which contain its square, would lose 16
/// digits.
const SMALLEST_OF_SPRINGS: f64 = f64::from_bits((1023 - 80) << 52);

/// 2^100: the largest approach with two directions, relative to that of the parameters; the largest force is 2^150 times theirs.
/// Squares in the units of the springs do not overflow then.
const MOST_APPROACH: f64 = f64::from_bits((1023 + 100) << 52);

/// A point of the normal law: the normal force at a given approach or the approach under a given normal force, and its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalPoint {
    /// The normal force \[N\] at a given approach, the approach \[m\] at a given force.
    pub value: f64,
    /// The normal stiffness \[N/m\] or compliance \[m/N\].
    pub slope: f64,
}

/// The normal state of a contact that is closed: load, tangential shift, and their derivatives with respect to the input.
#[derive(Clone, Copy)]
pub(crate) struct NormalState {
    pub load: f64,
    pub shift: f64,
    pub load_slope: f64,
    pub shift_slope: f64,
}

impl NormalState {
    pub const OPEN: NormalState = NormalState { load: 0.0, shift: 0.0, load_slope: 0.0, shift_slope: 0.0 };
}

impl From<[[f64; 1]; 4]> for NormalState {
    #[inline(always)]
    fn from([[load], [shift], [load_slope], [shift_slope]]: [[f64; 1]; 4]) -> NormalState {
        NormalState { load, shift, load_slope, shift_slope }
    }
}

impl Element {
    /// The element of a flat with rounded edges, or of a cylinder.
    /// Errors: the error of the first parameter that is not allowed; `BadNormalForce` also for 0; otherwise as for a contact.
    pub fn rounded_flat(parameters: &Parameters, directions: Directions, input: NormalInput) -> Result<Element, Error> {
        let mut element = Element::default();
        element.init(parameters, (directions, input)).map(|()| element)
    }

    /// The element of an elliptical Hertz contact; a sphere if both semi-axes are equal.
    /// Errors: the error of the first parameter that is not allowed; `BadNormalForce` also for 0; otherwise as for a contact.
    pub fn elliptic(
        parameters: &EllipticParameters,
        directions: Directions,
        input: NormalInput,
    ) -> Result<Element, Error> {
        let mut element = Element::default();
        element.init(parameters, (directions, input)).map(|()| element)
    }

    /// Initialises an element in place; unchanged on an error. Checks all ranges before it writes.
    pub(crate) fn init(&mut self, geometry: &impl Geometry, (directions, input): Components) -> Result<(), Error> {
        let parameters = geometry.checked()?;
        parameters.composite_modulus()?;
        if parameters.normal_force <= 0.0 {
            return Err(Error::BadNormalForce);
        }
        let mut shape = geometry.shape()?;
        (shape.layer, _) = LayerCompliance::new(&parameters.layer, parameters.normal_force)?;
        shape.largest = geometry.largest_size(&shape, directions as usize)?;
        let Common { normal_force, friction_coefficient, .. } = parameters;
        let layer = &shape.layer;
        let [size, largest] = sizes(&shape, normal_force)?;
        let [[approach, normal_compliance], [shift, tangential_compliance]] =
            [Quantity::Approach, Quantity::Shift].map(|quantity| shape.value_and_compliance(quantity, size));
        for value in [approach, shift, normal_force] {
            // The load and the approach of the parameters are valid inputs of the element.
            ensure(in_0_to(value, MAX_DISPLACEMENT), Error::OutOfRange)?;
            in_range(&[value])?;
            if friction_coefficient > 0.0 {
                in_range(&[value, friction_coefficient])?;
            }
        }
        self.largest_load = shape.load(largest);
        [self.largest_approach, self.largest_shift] =
            [Quantity::Approach, Quantity::Shift].map(|quantity| shape.value(quantity, largest));
        if directions == Directions::Two {
            self.largest_load = self.largest_load.min(normal_force / SMALLEST_LOAD);
            self.largest_approach = self.largest_approach.min(approach * MOST_APPROACH);
        }
        let least = shape.at_load(SMALLEST_LOAD * normal_force);
        self.smallest = Quantity::ALL.map(|quantity| shape.value(quantity, least));
        let smallest = if directions == Directions::Two { SMALLEST_OF_SPRINGS } else { SMALLEST_LOAD };
        self.smallest_input = smallest * if input == NormalInput::Force { normal_force } else { approach };
        self.friction_coefficient = friction_coefficient;
        self.per_two_mu = if friction_coefficient > 0.0 { quotient(0.5, friction_coefficient) } else { 0.0 };
        self.normal_force = normal_force;
        self.half_width = shape.half_width(size);
        self.approach = approach;
        (self.normal_stiffness, self.tangential_stiffness) = (1.0 / normal_compliance, 1.0 / tangential_compliance);
        (self.directions, self.normal_input) = (directions as i32, input as i32);
        (self.tag, self.checksum) = (TAG, 0);
        (self.composite_modulus, self.shape) = (shape.composite_modulus, shape);
        let [ratio, own] = shape.compliance_in_terms_of(2, 1);
        let per_load = if layer.is_linear() { own + (1.0 - ratio) * layer.compliance(0.0) } else { own };
        self.shift_y_coefficients = [ratio, per_load];
        self.key = key_of(&[normal_force, friction_coefficient, size, approach, shift, shape.flat, ratio, per_load]);
        self.fill_tables(&shape, input, [normal_force, approach, shift]);
        Ok(())
    }

    /// Fills the tables up to N, U and S of the parameters.
    fn fill_tables(&mut self, shape: &Shape, input: NormalInput, [normal_force, approach, shift]: [f64; 3]) {
        // The approach and the shift of a short contact have a maximum just beyond the largest size, where their inverses are
        // singular. Where that is at less than 2.25 times the argument, it would lie within 9 half-lengths of a quarter.
        let regular = |value: f64, largest: f64| value.min(largest / 2.25);
        let mut potentials = self.potential.0.iter_mut();
        Table::fill([&mut self.load_of_shift], regular(shift, self.largest_shift), &mut |x| {
            let size = shape.leg_at(Quantity::Shift, x);
            potentials.next().into_iter().for_each(|value| *value = shape.potential(size));
            let [load, ..] = shape.series(size, Quantity::Shift);
            [load]
        });
        // The load is that of the parameters, free of the rounding error of a size that is computed from it.
        let (argument, largest) = match input {
            NormalInput::Approach => (Quantity::Approach, regular(approach, self.largest_approach)),
            NormalInput::Force => (Quantity::Load, normal_force),
        };
        let is_sum = shape.layer.is_none() && input == NormalInput::Approach;
        self.shift_coefficients = if is_sum { shape.compliance_in_terms_of(1, 0) } else { [0.0; 2] };
        Table::fill([&mut self.of_input, &mut self.shift], largest, &mut |x| {
            let [load, approach, shift] = shape.series(shape.leg_at(argument, x), argument);
            [if input == NormalInput::Force { approach } else { load }, shift]
        });
    }

    /// S along y and its derivative, from N and S along x and theirs.
    #[inline(always)]
    pub(crate) fn shift_y(&self, normal: &NormalState) -> [f64; 2] {
        let ([ratio, per_load], layer) = (self.shift_y_coefficients, &self.shape.layer);
        let NormalState { load, shift, load_slope, shift_slope } = *normal;
        let linear = [ratio * shift + per_load * load, ratio * shift_slope + per_load * load_slope];
        if layer.is_linear() {
            return linear;
        }
        let rest = 1.0 - ratio;
        [linear[0] + rest * layer.shift(load), linear[1] + rest * (layer.compliance(load) * load_slope)]
    }

    /// Whether this version of the library initialised the element.
    pub(crate) fn is_initialised(&self) -> bool {
        self.tag == TAG
    }

    /// Checks the tag of an element that is used with the given number of directions.
    /// Errors: `BadElement` unless it was initialised by this version; `BadDirections` for the other number of directions.
    #[inline(always)]
    pub(crate) fn check_directions(&self, directions: Directions) -> Result<(), Error> {
        ensure(self.is_initialised(), Error::BadElement)?;
        ensure(self.directions == directions as i32, Error::BadDirections)
    }

    /// The number of tangential directions.
    #[inline(always)]
    pub(crate) fn tangential_directions(&self) -> Directions {
        if self.directions == Directions::Two as i32 { Directions::Two } else { Directions::One }
    }

    /// Values and slopes of a quantity at several arguments, of which some are outside the table of the quantity.
    #[cold]
    #[inline(never)]
    fn one_by_one<const L: usize>(
        &self,
        table: Option<&Table>,
        quantities: [Quantity; 2],
        x: [f64; L],
    ) -> ([f64; L], [f64; L]) {
        let results = x.map(|x| self.one(table, quantities, x));
        (results.map(|point| point.value), results.map(|point| point.slope))
    }

    #[inline(never)]
    fn one(&self, table: Option<&Table>, quantities: [Quantity; 2], x: f64) -> NormalPoint {
        match table.and_then(|table| table.values::<true, 1>(&[x])) {
            Some(([value], [slope])) => NormalPoint { value, slope },
            None => self.outside(quantities, x),
        }
    }

    /// A quantity as a function of another one, the argument x >= 0, from the shape. Below the smallest size N, U and S are
    /// proportional to each other.
    fn outside(&self, [quantity, argument]: [Quantity; 2], x: f64) -> NormalPoint {
        let shape = self.shape();
        if x > 0.0 && x < self.smallest(argument) {
            let slope = self.smallest(quantity) / self.smallest(argument);
            return NormalPoint { value: slope * x, slope };
        }
        if x <= 0.0 && shape.half_width(0.0) <= 0.0 {
            // A contact without a flat touches at a point, whose compliance is infinite.
            return NormalPoint { value: 0.0, slope: if argument == Quantity::Load { f64::INFINITY } else { 0.0 } };
        }
        let size = if x > 0.0 { shape.leg_at(argument, x) } else { 0.0 };
        let [value, compliance] = shape.value_and_compliance(quantity, size);
        NormalPoint { value, slope: compliance / shape.compliance(argument, size) }
    }

    /// N, U or S of the smallest size that is distinguished.
    fn smallest(&self, quantity: Quantity) -> f64 {
        self.smallest.or_zero(quantity as usize)
    }

    /// The normal force at an approach \[m\] that [`Element::check_approach`] accepts; 0 for an approach <= 0, an open contact.
    #[inline(always)]
    pub fn normal_force_at(&self, approach: f64) -> NormalPoint {
        let table = self.by_approach().then_some(&self.of_input);
        let point = self.one(table, [Quantity::Load, Quantity::Approach], approach);
        NormalPoint { slope: if approach > 0.0 { point.slope } else { 0.0 }, ..point }
    }

    /// The approach under a normal force \[N\] that [`Element::check_normal_force`] accepts. Its derivative at 0 is infinite for a
    /// cylinder or an ellipse.
    #[inline(always)]
    pub fn approach_under(&self, normal_force: f64) -> NormalPoint {
        let table = (!self.by_approach()).then_some(&self.of_input);
        self.one(table, [Quantity::Approach, Quantity::Load], normal_force)
    }

    /// Errors: `BadDirections` unless the element has this tangential direction, 0 or 1.
    pub fn check_direction(&self, direction: usize) -> Result<(), Error> {
        ensure(direction < self.tangential_directions() as usize, Error::BadDirections)
    }

    /// Checks a static force at a constant normal force.
    /// Errors: those of [`Element::check_normal_force`]; `BadForce` if the force is not finite, `ForceExceedsSlip` if it exceeds mu
    /// N by more than rounding.
    pub fn check_static(&self, force: f64, normal_force: f64) -> Result<(), Error> {
        self.check_normal_force(normal_force)?;
        check_force(force, self.friction_coefficient * normal_force)
    }

    /// The displacement \[m\] that carries a tangential force \[N\] at a constant normal force \[N\], from the unloaded contact in
    /// x (0) or y direction (1), and the compliance \[m/N\] there; infinite at mu N if the stick zone shrinks to a point, without
    /// friction, and without a normal force.
    pub fn displacement_under(&self, direction: usize, force: f64, normal_force: f64) -> NormalPoint {
        let (size, mu) = (force.abs(), self.friction_coefficient);
        let limit = mu * normal_force;
        if limit <= 0.0 {
            return NormalPoint { value: 0.0, slope: f64::INFINITY };
        }
        // The load of the stick zone, without the rounding of mu N.
        let stuck = if size < limit { mu.mul_add(normal_force, -size).max(0.0) / mu } else { 0.0 };
        let [end, start] = [normal_force, stuck].map(|load| self.tangential_shift(direction, load));
        let shift = if stuck < 0.75 * normal_force {
            end.value - start.value
        } else {
            // The difference of both shifts would lose digits to cancellation, so the compliance is integrated: its singularities
            // are at N = 0 and below.
            let consumed = size / mu;
            let nodes = gauss_nodes(2);
            nodes
                .map(|(x, part)| consumed * part * self.tangential_shift(direction, normal_force - x * consumed).slope)
                .sum()
        };
        NormalPoint { value: mu.copysign(force) * shift, slope: start.slope }
    }

    /// S in a direction and its derivative by the normal force, from the shape.
    fn tangential_shift(&self, direction: usize, load: f64) -> NormalPoint {
        let point = self.outside([Quantity::Shift, Quantity::Load], load);
        if direction == 0 {
            return point;
        }
        let [value, slope] =
            self.shift_y(&NormalState { load, shift: point.value, load_slope: 1.0, shift_slope: point.slope });
        NormalPoint { value, slope }
    }

    /// Half-width of the contact \[m\] (elliptical: the semi-axis x) under a normal force \[N\]; 0 if that is 0.
    pub fn half_width_under(&self, normal_force: f64) -> f64 {
        let shape = self.shape();
        let load = normal_force.max(SMALLEST_LOAD * self.normal_force);
        if normal_force > 0.0 { shape.half_width(shape.at_load(load)) } else { 0.0 }
    }

    /// The tangential shift S \[m\] under a normal force \[N\]; 0 if that is 0.
    pub fn shift_under(&self, load: f64) -> f64 {
        self.outside([Quantity::Shift, Quantity::Load], load).value
    }

    /// The normal force \[N\] at a tangential shift \[m\].
    #[inline(always)]
    pub fn load_under(&self, shift: f64) -> f64 {
        let ([load], _) = self.loads_at::<false, 1>(&[shift]);
        load
    }

    /// The scale of the normal component of a displacement: N over the normal stiffness, or N, of the parameters. The squares of
    /// derivatives by the component over this scale are representable.
    pub(crate) fn input_scale(&self) -> f64 {
        if self.by_approach() { self.normal_force / self.normal_stiffness } else { self.normal_force }
    }

    /// Whether the normal component of a displacement is the approach.
    pub(crate) fn by_approach(&self) -> bool {
        self.normal_input == NormalInput::Approach as i32
    }

    /// The family of sizes.
    pub(crate) fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Checks a normal approach.
    /// Errors: `BadDisplacement` unless it is finite and at most 1e150 in magnitude; `LengthTooShort` if the contact would become
    /// too wide for its length.
    #[inline(always)]
    pub fn check_approach(&self, approach: f64) -> Result<(), Error> {
        ensure(abs_le(approach, MAX_DISPLACEMENT), Error::BadDisplacement)?;
        ensure(le(approach, self.largest_approach), Error::LengthTooShort)
    }

    /// Checks a normal force.
    /// Errors: `BadNormalForce` unless it is finite, not negative, and at most 1e150; `LengthTooShort` if the contact would become
    /// too wide for its length.
    #[inline(always)]
    pub fn check_normal_force(&self, normal_force: f64) -> Result<(), Error> {
        ensure(in_0_to(normal_force, MAX_DISPLACEMENT), Error::BadNormalForce)?;
        ensure(le(normal_force, self.largest_load), Error::LengthTooShort)
    }

    /// Whether a normal component with these Fourier coefficients is allowed whatever the phases of its harmonics.
    pub(crate) fn accepts_all_phases(&self, input: &[f64]) -> bool {
        let (mean, harmonics) = input.split_first().unwrap_or((&0.0, &[]));
        let amplitude: f64 = harmonics.iter().map(|value| value.abs()).sum();
        (self.by_approach() || *mean >= amplitude) && self.check_input(mean + amplitude).is_ok()
    }

    /// Checks the normal component of a displacement, an approach or a normal force.
    #[inline(always)]
    pub(crate) fn check_input(&self, input: f64) -> Result<(), Error> {
        if self.by_approach() { self.check_approach(input) } else { self.check_normal_force(input) }
    }

    /// Whether the contact is closed at an input that was checked.
    #[inline(always)]
    pub(crate) fn is_closed(&self, input: f64) -> bool {
        input > self.smallest_input
    }

    /// The fraction of a straight path between two inputs at which it crosses zero load, if the contact is closed at one of its
    /// ends. With the normal force as input the contact opens or closes at the open end.
    pub fn crossing(&self, from: f64, to: f64) -> f64 {
        if self.by_approach() {
            from / (from - to)
        } else if from > 0.0 {
            1.0
        } else {
            0.0
        }
    }

    /// The normal state at an input that closes the contact.
    #[inline(never)]
    pub(crate) fn normal(&self, input: f64) -> NormalState {
        NormalState::from(self.normals::<true, 1>(&[input]))
    }

    /// N, S and, if requested, their derivatives at four inputs; zeros for an open contact.
    #[inline(always)]
    pub(crate) fn four_normals<const SLOPES: bool>(&self, input: &[f64; 4]) -> [[f64; 4]; 4] {
        // Open contacts are evaluated at the smallest argument of the table, and their results are set to 0.
        let substitute = self.of_input.smallest();
        let mut states = self.normals::<SLOPES, 4>(&input.map(|input| if input > 0.0 { input } else { substitute }));
        for values in &mut states {
            for k in 0..4 {
                values[k] = if input[k] > 0.0 { values[k] } else { 0.0 };
            }
        }
        states
    }

    /// N, S and, if requested, their derivatives at inputs that close the contact.
    #[inline(always)]
    pub(crate) fn normals<const SLOPES: bool, const L: usize>(&self, input: &[f64; L]) -> [[f64; L]; 4] {
        let ([per_approach, per_load], is_sum) = (self.shift_coefficients, self.shift_coefficients[0] > 0.0);
        let (of_input, shift) = (Some(&self.of_input), Some(&self.shift));
        let outside = |table, quantities| self.one_by_one(table, quantities, *input);
        if !is_sum && !self.by_approach() {
            let tabulated = self.shift.values::<SLOPES, L>(input);
            let (shift, slope) = tabulated.unwrap_or_else(|| outside(shift, [Quantity::Shift, Quantity::Load]));
            return [*input, shift, [1.0; L], slope];
        }
        let tabulated = self.of_input.values::<SLOPES, L>(input);
        let (load, slope) = tabulated.unwrap_or_else(|| outside(of_input, [Quantity::Load, Quantity::Approach]));
        if is_sum {
            // A second table would make a harmonic force 20 % slower.
            let shift = from_fn(|k| per_approach * input[k] + per_load * load[k]);
            return [load, shift, slope, slope.map(|slope| per_approach + per_load * slope)];
        }
        let tabulated = self.shift.values::<SLOPES, L>(input);
        let (shift, shift_slope) = tabulated.unwrap_or_else(|| outside(shift, [Quantity::Shift, Quantity::Approach]));
        [load, shift, slope, shift_slope]
    }

    /// N and, if requested, 1/K_t at shifts S >= 0.
    #[inline(always)]
    pub(crate) fn loads_at<const SLOPES: bool, const L: usize>(&self, shift: &[f64; L]) -> ([f64; L], [f64; L]) {
        let (table, quantities) = (&self.load_of_shift, [Quantity::Load, Quantity::Shift]);
        table.values::<SLOPES, L>(shift).unwrap_or_else(|| self.one_by_one(Some(table), quantities, *shift))
    }

    /// N'' at four monotone shifts S > 0. The quarter of the table from an earlier call is kept.
    #[inline(always)]
    pub(crate) fn four_curvatures(&self, shift: &[f64; 4], quarter: &mut Curvature) -> [f64; 4] {
        let outside = |shift: f64| {
            // N and S are proportional to each other below the smallest size.
            let size = self.shape.leg_at(Quantity::Shift, shift);
            if shift <= self.smallest(Quantity::Shift) { 0.0 } else { self.shape.load_curvature(size) }
        };
        self.load_of_shift.four_curvatures(shift, quarter).unwrap_or_else(|| shift.map(outside))
    }

    /// M, the integral of N, at a shift S >= 0.
    #[inline(always)]
    pub(crate) fn potential_at_shift(&self, shift: f64) -> f64 {
        match self.load_of_shift.integral_from_middle(shift) {
            Some((quarter, integral)) => self.potential.0.or_zero(quarter) + integral,
            None if shift <= self.smallest(Quantity::Shift) => 0.5 * self.load_under(shift) * shift,
            None => self.shape.potential(self.shape.leg_at(Quantity::Shift, shift)),
        }
    }
}

/// The size under a normal force and the largest one for which the laws hold.
///
/// Errors: those of [`LayerCompliance::check_share`]; `LengthTooShort` if the first one is not smaller.
fn sizes(shape: &Shape, normal_force: f64) -> Result<[f64; 2], Error> {
    let (size, mut largest) = (shape.at_load(normal_force), shape.largest);
    let layer = &shape.layer;
    if !layer.is_none() {
        let compliances = [Quantity::Approach, Quantity::Shift].map(|quantity| shape.compliance(quantity, size));
        layer.check_share(normal_force, compliances)?;
        // The contact stiffens with the load, so that a layer has energies of the order of N² where those of a contact are smaller.
        let most = (normal_force * MOST_LOAD_WITH_LAYER).min(LARGEST / layer.normal.max(layer.tangential).max(1.0));
        if shape.load(largest) > most {
            largest = shape.at_load(most);
        }
    }
    if size >= largest { Err(Error::LengthTooShort) } else { Ok([size, largest]) }
}

/// A number from 1 to 2 that depends on the bits of all values.
fn key_of(values: &[f64]) -> f64 {
    let mix = |hash: u64, value: &f64| (hash ^ value.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    f64::from_bits((values.iter().fold(1, mix) >> 12) | (1023 << 52))
}

const _: () = assert!(size_of::<Element>() <= 15_000);
