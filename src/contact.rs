//! A contact, prepared once and then only read: the family it belongs to, and the units that turn its numbers into forces
//! and displacements.

use crate::elliptic::Elliptic;
use crate::error::Error;
use crate::family::ContactFamily;
use crate::indentation::Indentation;
use crate::parameters::{CENTRE_POINT, EllipticParameters, Pair, Parameters};
use crate::rounded_flat::RoundedFlat;
use core::f64::consts::{LN_2, PI};

/// A prepared contact: plain data of fixed size that may be copied, stored and sent.
///
/// An open contact (no normal force) has zero width, force and stiffness; one without friction has zero force and
/// stiffness.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// E* of Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: the semi-axis along the tangential force.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at which gross slip starts on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// Slope of the monotonic curve at 0 \[N/m\].
    pub initial_stiffness: f64,
    /// Dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    mark: u64,
    law: u64,
    /// Displacement for an approach of 1 \[m\].
    displacement_unit: f64,
    /// Stiffness for a compliance of 1 \[N/m\].
    stiffness_unit: f64,
    /// Pressure for one of 1 \[Pa\].
    pressure_unit: f64,
    friction_coefficient: f64,
    /// a \[m\].
    flat_half_width: f64,
    /// mu N less `slip_force`: what rounding took.
    slip_force_rounding: f64,
    rounded_flat: RoundedFlat,
    spare: [f64; 56],
    end_mark: u64,
}

/// Tells a prepared contact from other memory.
const MARK: u64 = 0x6d73_6c69_7001_c0a7;

const LAW_ROUNDED_FLAT: u64 = 1;
const LAW_ELLIPTIC: u64 = 2;

const _: () = assert!(size_of::<Contact>() == 1024);

/// Exponent of 2 beyond which no intermediate product may come: squares stay representable.
const LARGEST_EXPONENT: i32 = 500;

/// The exponent of 2 of a product of quotients, from the numbers' exponents alone, so that nothing overflows.
fn exponent_of(numerators: &[f64], denominators: &[f64]) -> i32 {
    let exponent = |value: &f64| ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    numerators.iter().map(exponent).sum::<i32>() - denominators.iter().map(exponent).sum::<i32>()
}

fn in_range(numerators: &[f64], denominators: &[f64]) -> Result<(), Error> {
    if exponent_of(numerators, denominators).abs() <= LARGEST_EXPONENT { Ok(()) } else { Err(Error::OutOfRange) }
}

impl Contact {
    /// Prepares a flat with rounded edges, or a cylinder.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `LengthTooShort` where 2L <= b or the initial stiffness would
    /// not be positive; `OutOfRange` where results are not representable.
    pub fn rounded_flat(parameters: &Parameters) -> Result<Contact, Error> {
        parameters.check()?;
        let Parameters { flat_half_width: a, edge_radius, length, normal_force, friction_coefficient, .. } =
            *parameters;
        for body in &parameters.material {
            in_range(&[body.young_modulus], &[])?;
        }
        let pair = Pair::new(&parameters.material);
        let modulus = pair.composite_modulus;
        let open = Contact { composite_modulus: modulus, law: LAW_ROUNDED_FLAT, friction_coefficient, ..EMPTY };
        if normal_force == 0.0 {
            return Ok(open);
        }
        in_range(&[edge_radius, normal_force], &[length, modulus])?;
        in_range(&[length], &[])?;
        in_range(&[length, modulus], &[])?;
        if a > 0.0 {
            // A wide flat must not be so wide that the rounded edge carries nothing.
            if exponent_of(&[a], &[]) > LARGEST_EXPONENT
                || exponent_of(&[edge_radius, normal_force], &[length, modulus, a, a]) < -900
            {
                return Err(Error::OutOfRange);
            }
        }

        // Eq. 1 in units that keep both the flat and the load at most 1.
        let load = 4.0 * ((edge_radius / length) * (normal_force / modulus));
        let unit = a.max((load / PI).sqrt());
        let indentation = Indentation::of_load(a / unit, load / unit / unit);
        let half_width = unit * indentation.half_width;
        let size = indentation.half_width;
        let contact =
            Indentation { flat: indentation.flat / size, w: indentation.w / size, half_width: 1.0, ..indentation };

        if length <= 0.5 * half_width {
            return Err(Error::LengthTooShort);
        }
        let mut compliance = (2.0 * (length / half_width)).ln() + pair.mean(|nu| nu / (1.0 - nu));
        if parameters.displacement_reference != CENTRE_POINT {
            compliance -= strip_correction(&pair, half_width / length);
        }
        if compliance <= 0.0 {
            return Err(Error::LengthTooShort);
        }
        let shape = RoundedFlat::new(&contact, compliance);
        let stiffness_unit = 0.5 * PI * modulus * length;
        let geometry = Contact {
            half_width,
            flat_half_width: a,
            pressure_unit: normal_force / length / half_width,
            stiffness_unit,
            rounded_flat: shape,
            ..open
        };
        geometry.with_friction(normal_force)
    }

    /// Prepares an elliptical Hertz contact; a sphere when both semi-axes are equal.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `OutOfRange` where results are not representable.
    pub fn elliptic(parameters: &EllipticParameters) -> Result<Contact, Error> {
        parameters.check()?;
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, friction_coefficient, ref material } =
            *parameters;
        for body in material {
            in_range(&[body.young_modulus], &[])?;
        }
        let modulus = Pair::new(material).composite_modulus;
        let open = Contact { composite_modulus: modulus, law: LAW_ELLIPTIC, friction_coefficient, ..EMPTY };
        if normal_force == 0.0 {
            return Ok(open);
        }
        for axis in [semi_axis_x, semi_axis_y] {
            in_range(&[axis], &[])?;
            in_range(&[axis, modulus], &[])?;
        }
        in_range(&[semi_axis_x], &[semi_axis_y])?;
        in_range(&[normal_force], &[semi_axis_x, semi_axis_y])?;
        let compliance = Elliptic::initial_compliance(semi_axis_x, semi_axis_y, material);
        let geometry = Contact {
            half_width: semi_axis_x,
            pressure_unit: normal_force / semi_axis_x / semi_axis_y,
            stiffness_unit: 1.0 / compliance,
            ..open
        };
        geometry.with_friction(normal_force)
    }

    /// The tangential side, once geometry and stiffness are known.
    fn with_friction(self, normal_force: f64) -> Result<Contact, Error> {
        if self.friction_coefficient == 0.0 {
            return Ok(self);
        }
        in_range(&[self.friction_coefficient, normal_force], &[])?;
        let slip_force = self.friction_coefficient * normal_force;
        in_range(&[slip_force], &[self.stiffness_unit])?;
        let displacement_unit = slip_force / self.stiffness_unit;
        let family = self.family();
        let at_slip = family.at_load_rest(0.0);
        let energy = family.dissipation_beyond_half(&at_slip);
        Ok(Contact {
            slip_force,
            slip_force_rounding: self.friction_coefficient.mul_add(normal_force, -slip_force),
            displacement_unit,
            slip_displacement: displacement_unit * family.slip_approach(),
            initial_stiffness: self.stiffness_unit / family.origin().compliance,
            slip_energy: slip_force * displacement_unit * energy,
            ..self
        })
    }

    /// Whether this memory was prepared by this library.
    pub(crate) fn is_prepared(&self) -> bool {
        self.mark == MARK && self.end_mark == MARK && (self.law == LAW_ROUNDED_FLAT || self.law == LAW_ELLIPTIC)
    }

    pub(crate) fn is_elliptic(&self) -> bool {
        self.law == LAW_ELLIPTIC
    }

    pub(crate) fn family(&self) -> &dyn ContactFamily {
        if self.is_elliptic() { &Elliptic } else { &self.rounded_flat }
    }

    /// mu \[-\].
    pub(crate) fn friction_coefficient(&self) -> f64 {
        self.friction_coefficient
    }

    /// a \[m\].
    pub(crate) fn flat_half_width(&self) -> f64 {
        self.flat_half_width
    }

    /// mu N less `slip_force` \[N\].
    pub(crate) fn slip_force_rounding(&self) -> f64 {
        self.slip_force_rounding
    }

    /// No tangential force is possible: an open contact, or one without friction.
    pub(crate) fn is_frictionless(&self) -> bool {
        self.slip_force <= 0.0
    }

    /// Displacement for an approach of 1 \[m\].
    pub(crate) fn displacement_unit(&self) -> f64 {
        self.displacement_unit
    }

    /// Stiffness for a compliance of 1 \[N/m\].
    pub(crate) fn stiffness_unit(&self) -> f64 {
        self.stiffness_unit
    }

    /// Energy for a dissipation of 1 \[J\].
    pub(crate) fn energy_unit(&self) -> f64 {
        self.slip_force * self.displacement_unit
    }

    /// Pressure for one of 1 \[Pa\].
    pub(crate) fn pressure_unit(&self) -> f64 {
        self.pressure_unit
    }
}

/// An open contact of no law.
const EMPTY: Contact = Contact {
    composite_modulus: 0.0,
    half_width: 0.0,
    slip_force: 0.0,
    slip_displacement: 0.0,
    initial_stiffness: 0.0,
    slip_energy: 0.0,
    mark: MARK,
    law: 0,
    displacement_unit: 0.0,
    stiffness_unit: 0.0,
    pressure_unit: 0.0,
    friction_coefficient: 0.0,
    flat_half_width: 0.0,
    slip_force_rounding: 0.0,
    rounded_flat: RoundedFlat::EMPTY,
    spare: [0.0; 56],
    end_mark: MARK,
};

/// What three-dimensional contact mechanics takes off Λ: the mean instead of the centre of the displacement along and
/// across the strip (1 - ln 2, and the term in b/L), and the redistribution of traction along it (0.093, fitted to
/// boundary-element results for 16 strips, which scatter from 0.081 to 0.102).
fn strip_correction(pair: &Pair, slenderness: f64) -> f64 {
    const REDISTRIBUTION: f64 = 0.093;
    let across = 8.0 / (PI * PI) * pair.mean(|nu| (1.0 - 2.0 * nu) / (1.0 - nu)) * slenderness;
    (1.0 - LN_2) + REDISTRIBUTION - across
}
