//! A friction contact element: the laws of a shape in tables that are independent of the load, so that one element serves all
//! contact points of a geometry.

use crate::constant_load::contact::check_moduli;
use crate::error::Error;
use crate::numerics::fp_class::in_0_to;
use crate::parameters::{EllipticParameters, Pair, Parameters};
use crate::range::in_range;
use crate::shape::{HertzEllipse, Relation, RoundedFlat, Shape};
use crate::tag::LAYOUT;
use crate::varying_load::table::{PIECES, Table};

/// What the normal component of a displacement is: the approach w \[m\], or the normal force N \[N\].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NormalInput {
    /// The normal approach; not positive if the contact is open.
    Approach,
    /// The normal force.
    Force,
}

/// An initialised element: plain data of fixed size that may be copied, stored and sent.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Element {
    /// E* of Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Coulomb's friction coefficient.
    pub friction_coefficient: f64,
    /// The largest normal force that the tables cover \[N\].
    pub normal_force: f64,
    /// Half-width at that force \[m\], and so are the following; elliptical: the semi-axis x.
    pub half_width: f64,
    /// Normal approach \[m\].
    pub approach: f64,
    /// dN/d(approach) \[N/m\].
    pub normal_stiffness: f64,
    /// dT/d(displacement) of a fully stuck contact, x direction \[N/m\].
    pub tangential_stiffness: f64,
    tag: u64,
    /// S = `shift_per_approach` U + `shift_per_load` N, exactly.
    shift_per_approach: f64,
    shift_per_load: f64,
    flat: RoundedFlat,
    ellipse: HertzEllipse,
    /// N(U) or S(N): the quantity that the input does not give.
    of_input: Table,
    /// N(S).
    load_of_shift: Table,
    /// M at the middle of each quarter of `load_of_shift`.
    potential: [f64; PIECES],
}

const TAG: u64 = (0x6d73_6c69_7065 << 16) | (LAYOUT << 8);
const ELLIPTIC: u64 = 1;
const FORCE_INPUT: u64 = 2;

/// The normal state of a contact that is closed: load, tangential shift, and their derivatives with respect to the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Normal {
    pub load: f64,
    pub shift: f64,
    pub load_slope: f64,
    pub shift_slope: f64,
}

impl Normal {
    pub const OPEN: Normal = Normal { load: 0.0, shift: 0.0, load_slope: 0.0, shift_slope: 0.0 };

    /// 1/K_t of the whole contact \[N/m\].
    pub fn tangential_stiffness(&self) -> f64 {
        self.load_slope / self.shift_slope
    }
}

impl Element {
    /// The element of a flat with rounded edges, or of a cylinder.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `BadNormalForce` also for 0; otherwise as for a contact.
    pub fn rounded_flat(parameters: &Parameters, input: NormalInput) -> Result<Element, Error> {
        parameters.check()?;
        let flat_half_width = parameters.flat_half_width.abs();
        let parameters = &Parameters { flat_half_width, ..*parameters };
        check_moduli(&parameters.material)?;
        let Parameters { length, normal_force, friction_coefficient, .. } = *parameters;
        if normal_force == 0.0 {
            return Err(Error::BadNormalForce);
        }
        let flat = RoundedFlat::new(parameters)?;
        in_range(&[normal_force], &[length, flat.half_width()])?;
        let composite_modulus = Pair::new(&parameters.material).composite_modulus;
        let element = Element {
            composite_modulus,
            shift_per_approach: 1.0,
            shift_per_load: flat.shift_less_approach(),
            flat,
            ..EMPTY
        };
        element.with_tables(&flat, normal_force, friction_coefficient, input, 0)
    }

    /// The element of an elliptical Hertz contact; a sphere if both semi-axes are equal.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `BadNormalForce` also for 0; otherwise as for a contact.
    pub fn elliptic(parameters: &EllipticParameters, input: NormalInput) -> Result<Element, Error> {
        parameters.check()?;
        check_moduli(&parameters.material)?;
        let EllipticParameters { normal_force, friction_coefficient, .. } = *parameters;
        if normal_force == 0.0 {
            return Err(Error::BadNormalForce);
        }
        let ellipse = HertzEllipse::new(parameters)?;
        let composite_modulus = Pair::new(&parameters.material).composite_modulus;
        let element = Element {
            composite_modulus,
            shift_per_approach: ellipse.tangential_ratio(),
            shift_per_load: 0.0,
            ellipse,
            ..EMPTY
        };
        element.with_tables(&ellipse, normal_force, friction_coefficient, input, ELLIPTIC)
    }

    fn with_tables(
        self,
        shape: &impl Shape,
        normal_force: f64,
        friction_coefficient: f64,
        input: NormalInput,
        kind: u64,
    ) -> Result<Element, Error> {
        if friction_coefficient > 0.0 {
            in_range(&[friction_coefficient], &[])?;
        }
        let w = shape.at_load(normal_force);
        let (approach, shift) = (shape.approach(w), shape.shift(w));
        for value in [approach, shift, normal_force] {
            in_range(&[value], &[])?;
        }
        let load_of_shift = Table::new(shift, |x| shape.series(shape.at_shift(x), Relation::LoadOfShift));
        let of_input = match input {
            NormalInput::Approach => {
                Table::new(approach, |x| shape.series(shape.at_approach(x), Relation::LoadOfApproach))
            }
            NormalInput::Force => Table::new(normal_force, |x| shape.series(shape.at_load(x), Relation::ShiftOfLoad)),
        };
        let mut potential = [0.0; PIECES];
        for (value, middle) in potential.iter_mut().zip(load_of_shift.middles()) {
            *value = shape.potential(shape.at_shift(middle));
        }
        Ok(Element {
            friction_coefficient,
            normal_force,
            half_width: shape.half_width(w),
            approach,
            normal_stiffness: 1.0 / shape.normal_compliance(w),
            tangential_stiffness: 1.0 / shape.tangential_compliance(w),
            tag: TAG | kind | if input == NormalInput::Force { FORCE_INPUT } else { 0 },
            of_input,
            load_of_shift,
            potential,
            ..self
        })
    }

    /// The tangential shift S \[m\] under a normal force \[N\].
    #[must_use]
    pub fn shift_under(&self, load: f64) -> f64 {
        let shape = self.shape();
        shape.shift(shape.at_load(load))
    }

    /// The normal force \[N\] at a tangential shift \[m\].
    #[must_use]
    pub fn load_under(&self, shift: f64) -> f64 {
        self.load_at_shift(shift).0
    }

    /// Whether the normal component of a displacement is the approach.
    pub(crate) fn by_approach(&self) -> bool {
        self.tag & FORCE_INPUT == 0
    }

    /// The family of sizes.
    pub(crate) fn shape(&self) -> &dyn Shape {
        if self.tag & ELLIPTIC == 0 { &self.flat } else { &self.ellipse }
    }

    /// Checks a normal component.
    ///
    /// # Errors
    /// `BadNormalForce` for a force that is negative or not finite; `BadDisplacement` for an approach that is not finite.
    pub(crate) fn check_input(&self, input: f64) -> Result<(), Error> {
        if self.by_approach() {
            crate::constant_load::contact::check_displacement(input)
        } else if in_0_to(1e150, input) {
            Ok(())
        } else {
            Err(Error::BadNormalForce)
        }
    }

    /// The normal state at an input > 0.
    #[inline(always)]
    pub(crate) fn normal(&self, input: f64) -> Normal {
        let (value, slope) = match self.of_input.position(input) {
            Some(at) => self.of_input.value_and_slope(input, at),
            None => self.outside(input),
        };
        if self.by_approach() {
            Normal {
                load: value,
                shift: self.shift_per_approach * input + self.shift_per_load * value,
                load_slope: slope,
                shift_slope: self.shift_per_approach + self.shift_per_load * slope,
            }
        } else {
            Normal { load: input, shift: value, load_slope: 1.0, shift_slope: slope }
        }
    }

    /// N(U) or S(N) and its slope, from the shape.
    #[inline(never)]
    fn outside(&self, input: f64) -> (f64, f64) {
        let shape = self.shape();
        if self.by_approach() {
            let w = shape.at_approach(input);
            (shape.load(w), 1.0 / shape.normal_compliance(w))
        } else {
            let w = shape.at_load(input);
            (shape.shift(w), shape.tangential_compliance(w))
        }
    }

    /// N and 1/K_t at a shift S >= 0.
    #[inline(always)]
    pub(crate) fn load_at_shift(&self, shift: f64) -> (f64, f64) {
        match self.load_of_shift.position(shift) {
            Some(at) => self.load_of_shift.value_and_slope(shift, at),
            None => self.load_at_shift_outside(shift),
        }
    }

    #[inline(never)]
    fn load_at_shift_outside(&self, shift: f64) -> (f64, f64) {
        let shape = self.shape();
        let w = shape.at_shift(shift);
        if w > 0.0 { (shape.load(w), 1.0 / shape.tangential_compliance(w)) } else { (0.0, self.touching_stiffness()) }
    }

    /// 1/K_t at first touch: 0 unless the contact has a flat.
    fn touching_stiffness(&self) -> f64 {
        let shape = self.shape();
        if shape.half_width(0.0) > 0.0 { 1.0 / shape.tangential_compliance(0.0) } else { 0.0 }
    }

    /// N, N', N'' and M at a shift S >= 0.
    pub(crate) fn potential_at_shift(&self, shift: f64) -> [f64; 4] {
        match self.load_of_shift.position(shift) {
            Some(at) => {
                let (load, slope) = self.load_of_shift.value_and_slope(shift, at);
                let (_, curvature) = self.load_of_shift.slope_and_curvature(at);
                let middle = self.potential.get(at.index()).copied().unwrap_or(0.0);
                let potential = middle + self.load_of_shift.integral_from_middle(shift, at);
                [load, slope, curvature / shift, potential]
            }
            None => self.potential_outside(shift),
        }
    }

    #[inline(never)]
    fn potential_outside(&self, shift: f64) -> [f64; 4] {
        let shape = self.shape();
        let w = shape.at_shift(shift);
        if w <= 0.0 {
            return [0.0, self.touching_stiffness(), 0.0, 0.0];
        }
        let [load, slope, curvature, ..] = shape.series(w, Relation::LoadOfShift);
        [load, slope / shift, 2.0 * curvature / (shift * shift), shape.potential(w)]
    }
}

/// An element without tables.
const EMPTY: Element = Element {
    composite_modulus: 0.0,
    friction_coefficient: 0.0,
    normal_force: 0.0,
    half_width: 0.0,
    approach: 0.0,
    normal_stiffness: 0.0,
    tangential_stiffness: 0.0,
    tag: 0,
    shift_per_approach: 0.0,
    shift_per_load: 0.0,
    flat: RoundedFlat::EMPTY,
    ellipse: HertzEllipse::EMPTY,
    of_input: Table::EMPTY,
    load_of_shift: Table::EMPTY,
    potential: [0.0; PIECES],
};

const _: () = assert!(size_of::<Element>() <= 20_000);
