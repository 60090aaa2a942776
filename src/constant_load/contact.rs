//! A contact under a constant normal force: initialised once, then read-only. It contains the stick zones of its shape, and the
//! scales that convert their nondimensional quantities into forces and displacements.

use crate::constant_load::interpolant::{ForceInterpolant, INNER_FRACTION, KNEE_FRACTION};
use crate::error::{Error, ensure};
use crate::limits::check_displacement;
use crate::limits::{exponent_of, in_range, quotient_in_range};
use crate::parameters::{Common, EllipticParameters, PARAMETERS, Parameters, Sensitivity};
use crate::shape::rounded_flat::reference_slope;
use crate::shape::stick_zone::StickZones;
use crate::shape::{Complement, Geometry, LayerCompliance};
use crate::tag::LAYOUT;

/// Number of blocks of four nodes in the quadrature rule of K' in gross slip.
pub(crate) const BLOCKS_IN_SLIP: usize = 14;

/// An initialised contact: plain data of fixed size that may be copied, stored and sent.
///
/// An open contact (no normal force) has zero width, force and stiffness; a contact without friction has zero force and stiffness.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Contact {
    /// E* of Eq. 2 \[Pa\].
    pub composite_modulus: f64,
    /// Half-width b of the contact under its normal force \[m\]; elliptical: the semi-axis along the tangential force.
    pub half_width: f64,
    /// mu N \[N\].
    pub slip_force: f64,
    /// Displacement at the onset of gross slip on the monotonic curve \[m\].
    pub slip_displacement: f64,
    /// Slope of the monotonic curve at 0 \[N/m\].
    pub initial_stiffness: f64,
    /// Dissipated per cycle at incipient gross slip \[J\].
    pub slip_energy: f64,
    tag: u64,
    /// Displacement for a shift of 1 \[m\].
    pub(crate) displacement_scale: f64,
    /// 1/`displacement_scale`; 0 without friction.
    pub(crate) per_displacement_scale: f64,
    /// Stiffness for a compliance of 1 \[N/m\].
    pub(crate) stiffness_scale: f64,
    /// Pressure for a nondimensional pressure of 1 \[Pa\].
    pub(crate) pressure_scale: f64,
    pub(crate) friction_coefficient: f64,
    /// a \[m\].
    pub(crate) flat_half_width: f64,
    /// The rounding error of `slip_force`: the exact mu N less the rounded value.
    pub(crate) slip_force_rounding: f64,
    /// Argument of the first polynomial of the interpolant over the displacement, and of the others over the remaining displacement
    /// before gross slip \[1/m\].
    pub(crate) inner_scale: f64,
    pub(crate) outer_scale: f64,
    /// The inverse of `slip_displacement`; 0 without friction.
    pub(crate) per_slip_displacement: f64,
    pub(crate) interpolant: ForceInterpolant,
    /// Weights of K' in gross slip; 0 if there are none.
    pub(crate) weights_in_slip: [[f64; 4]; BLOCKS_IN_SLIP],
    pub(crate) zones: StickZones,
    /// Scales of the derivatives with respect to the parameters: mu N over each parameter, but over b instead of a.
    pub(crate) sensitivity_scales: Sensitivity,
    /// dχ/d(ln b): 0 unless the displacement reference depends on b/L.
    pub(crate) reference_slope: f64,
    /// The C interface sets this word such that the sum of all words of a contact is 0.
    pub(crate) checksum: u64,
}

/// Tag of an initialised contact: a magic number and the version of the layout.
const TAG: u64 = (0x6d73_6c69_7001 << 16) | (LAYOUT << 8);

const _: () = assert!(size_of::<Contact>() == 3032);

impl Contact {
    /// Initialises a flat with rounded edges, or a cylinder.
    /// Errors: the error of the first parameter that is not allowed; `LengthTooShort` if 2L <= b or the initial stiffness would not
    /// be positive; `OutOfRange` if results are not representable.
    pub fn rounded_flat(parameters: &Parameters) -> Result<Contact, Error> {
        let Parameters { edge_radius, length, .. } = *parameters;
        let contact = Contact::new(parameters, length, |_| Ok(edge_radius))?;
        Ok(Contact { reference_slope: reference_slope(parameters, contact.half_width), ..contact })
    }

    /// Initialises an elliptical Hertz contact; a sphere if both semi-axes are equal.
    /// Errors: the error of the first parameter that is not allowed; `OutOfRange` if results are not representable.
    pub fn elliptic(parameters: &EllipticParameters) -> Result<Contact, Error> {
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, .. } = *parameters;
        // The radius of the sphere with this semi-axis.
        let radius = |modulus: f64| {
            quotient_in_range(&[semi_axis_x, semi_axis_x, semi_axis_x, modulus], &[normal_force])?;
            Ok(4.0 / 3.0 * (semi_axis_x * (semi_axis_x * (semi_axis_x * modulus / normal_force))))
        };
        let mut contact = Contact::new(parameters, semi_axis_y, radius)?;
        // Nothing depends on the other two lengths.
        (contact.sensitivity_scales[2], contact.sensitivity_scales[4]) = (0.0, 0.0);
        Ok(contact)
    }

    /// Initialises a contact, given its length across the tangential force and its edge radius as a function of E*.
    fn new(
        parameters: &impl Geometry,
        length: f64,
        edge_radius: impl FnOnce(f64) -> Result<f64, Error>,
    ) -> Result<Contact, Error> {
        let common = parameters.checked()?;
        let composite_modulus = common.composite_modulus()?;
        let Common { normal_force, friction_coefficient, layer, .. } = common;
        // The derivatives of mu N.
        let sensitivity_scales = [friction_coefficient, normal_force, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut contact =
            Contact { composite_modulus, friction_coefficient, sensitivity_scales, tag: TAG, ..Contact::default() };
        if normal_force == 0.0 {
            return Ok(contact);
        }
        let shape = parameters.shape()?;
        let (half_width, compliance, scale) = (shape.reference_half_width, shape.full_stick(), shape.stiffness_scale());
        (contact.half_width, contact.flat_half_width) = (half_width, shape.flat);
        (contact.stiffness_scale, contact.pressure_scale) = (scale, normal_force / half_width / length);
        let (layer, under_load) = LayerCompliance::relative(&layer, normal_force, scale, compliance)?;
        contact.zones = StickZones::new(shape.reference_size, compliance, layer);
        let edge_radius = edge_radius(composite_modulus)?;
        contact.set_friction(normal_force, under_load, [half_width, edge_radius, length, composite_modulus])?;
        Ok(contact)
    }

    /// Adds the tangential law to a contact that has its geometry and stiffness. `under_load` is the compliance of the layer under
    /// N over its compliance under the reference load; `parameters` are b, R, L and E*.
    fn set_friction(&mut self, normal_force: f64, under_load: f64, parameters: [f64; 4]) -> Result<(), Error> {
        // The derivative with respect to the compliance under the reference load, for a friction force of 1.
        let by_compliance = under_load * self.stiffness_scale;
        self.sensitivity_scales[PARAMETERS - 1] = by_compliance;
        if self.friction_coefficient == 0.0 {
            return Ok(());
        }
        for factor in [1.0, normal_force, self.pressure_scale] {
            in_range(&[self.friction_coefficient, factor])?;
        }
        let slip_force = self.friction_coefficient * normal_force;
        quotient_in_range(&[slip_force], &[self.stiffness_scale])?;
        // Derivatives with respect to the parameters remain representable.
        if parameters.iter().any(|&parameter| exponent_of(&[slip_force], &[parameter]).abs() > 900) {
            return Err(Error::OutOfRange);
        }
        let [by_size, by_radius, by_length, by_modulus] = parameters.map(|parameter| slip_force / parameter);
        let displacement_scale = slip_force / self.stiffness_scale;
        let zones = &self.zones;
        let gross_slip = zones.at_load(Complement::of_remaining(0.0));
        let (energy, _) = zones.dissipation(gross_slip.load, gross_slip.compliance_increase);
        let slip_energy = slip_force * displacement_scale * energy;
        ensure(slip_energy.is_normal(), Error::OutOfRange)?;
        // Calls accept no larger displacement, so that gross slip would never be reached.
        let slip_displacement = displacement_scale * zones.slip_shift;
        check_displacement(slip_displacement).map_err(|_| Error::OutOfRange)?;
        let initial_stiffness = self.stiffness_scale / zones.small_load.compliance;
        self.slip_force = slip_force;
        self.slip_force_rounding = self.friction_coefficient.mul_add(normal_force, -slip_force);
        (self.displacement_scale, self.per_displacement_scale) = (displacement_scale, 1.0 / displacement_scale);
        (self.slip_displacement, self.per_slip_displacement) = (slip_displacement, 1.0 / slip_displacement);
        (self.initial_stiffness, self.slip_energy) = (initial_stiffness, slip_energy);
        let by_compliance = slip_force * by_compliance;
        self.sensitivity_scales =
            [self.friction_coefficient, normal_force, by_size, by_radius, by_length, by_modulus, by_compliance];
        let mut inner = INNER_FRACTION;
        self.interpolant = ForceInterpolant::new(inner, &self.zones);
        if !self.interpolant.is_converged() && self.has_knee() {
            inner = KNEE_FRACTION;
            self.interpolant = ForceInterpolant::new(inner, &self.zones);
        }
        self.inner_scale = 1.0 / (inner * slip_displacement);
        self.outer_scale = 1.0 / ((1.0 - inner) * slip_displacement);
        self.weights_in_slip = self.weights_of_curve();
        Ok(())
    }

    /// Errors: `BadContact` unless this memory was initialised by a library of this version.
    pub(crate) fn check(&self) -> Result<(), Error> {
        ensure(self.tag == TAG, Error::BadContact)
    }

    /// Whether a layer bends the curve strongly near gross slip.
    pub(crate) fn has_knee(&self) -> bool {
        self.zones.layer.has_knee()
    }

    /// Whether no tangential force is possible: the contact is open or has no friction.
    pub(crate) fn is_frictionless(&self) -> bool {
        self.slip_force <= 0.0
    }

    /// A displacement up to the onset of gross slip, with its distance to the onset.
    pub(crate) fn before_slip(&self, displacement: f64) -> Complement {
        Complement { consumed: displacement, remaining: self.slip_displacement - displacement }
    }

    /// Energy for a dissipation of 1 \[J\].
    pub(crate) fn energy_scale(&self) -> f64 {
        self.slip_force * self.displacement_scale
    }
}

#[cfg(test)]
pub(crate) mod tests;
