//! A contact under a constant normal force: initialised once, then read-only. It contains the stick zones of its shape, and the scales
//! that convert their nondimensional quantities into forces and displacements.

use crate::constant_load::interpolant::{ForceInterpolant, INNER_FRACTION, KNEE_FRACTION};
use crate::error::Error;
use crate::limits::check_displacement;
use crate::limits::{exponent_of, in_range};
use crate::parameters::{self, Common, EllipticParameters, PARAMETERS, Parameters, Sensitivity};
use crate::shape::rounded_flat::reference_slope;
use crate::shape::stick_zone::rounded_flat::RoundedFlatZones;
use crate::shape::stick_zone::{Complement, StickZones};
use crate::shape::{HertzEllipse, Layer, LayeredZones, RoundedFlat};
use crate::tag::LAYOUT;
use core::f64::consts::PI;

/// Nodes of the rule of K' in gross slip.
pub(crate) const NODES_IN_SLIP: usize = 56;

/// An initialised contact: plain data of fixed size that may be copied, stored and sent.
///
/// An open contact (no normal force) has zero width, force and stiffness; one without friction has zero force and stiffness.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
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
    /// Its inverse; 0 without friction.
    pub(crate) per_displacement_scale: f64,
    /// Stiffness for a compliance of 1 \[N/m\].
    pub(crate) stiffness_scale: f64,
    /// Pressure for one of 1 \[Pa\].
    pub(crate) pressure_scale: f64,
    pub(crate) friction_coefficient: f64,
    /// a \[m\].
    pub(crate) flat_half_width: f64,
    /// The rounding error of `slip_force`: mu N less its rounded value.
    pub(crate) slip_force_rounding: f64,
    /// Argument of the first polynomial of the interpolant over the displacement, and of the others over the remaining displacement
    /// before gross slip \[1/m\].
    pub(crate) inner_scale: f64,
    pub(crate) outer_scale: f64,
    /// The inverse of `slip_displacement`; 0 without friction.
    pub(crate) per_slip_displacement: f64,
    interpolant: ForceInterpolant,
    /// Weights of K' in gross slip; 0 if there are none.
    pub(crate) weights_in_slip: [f64; NODES_IN_SLIP],
    zones: LayeredZones,
    /// mu N over each parameter; over b instead of a.
    pub(crate) sensitivity_scales: Sensitivity,
    /// dκ/d(ln b): 0 unless the displacement reference depends on b/L.
    pub(crate) reference_slope: f64,
    /// Makes the sum of all words 0, in a contact that was written by the C interface.
    pub(crate) checksum: u64,
}

/// Tag of an initialised contact: a magic number and the version of the layout.
const TAG: u64 = (0x6d73_6c69_7001 << 16) | (LAYOUT << 8);

const _: () = assert!(size_of::<Contact>() == 3032);

impl Contact {
    /// Initialises a flat with rounded edges, or a cylinder.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `LengthTooShort` if 2L <= b or the initial stiffness would not be
    /// positive; `OutOfRange` if results are not representable.
    pub fn rounded_flat(parameters: &Parameters) -> Result<Contact, Error> {
        parameters.check()?;
        let Parameters { flat_half_width, edge_radius, length, normal_force, .. } = *parameters;
        let mut contact = Contact::open(&parameters.common())?;
        if normal_force == 0.0 {
            return Ok(contact);
        }
        let shape = RoundedFlat::new(parameters)?;
        let (half_width, composite_modulus) = (shape.half_width(), contact.composite_modulus);
        (contact.half_width, contact.flat_half_width) = (half_width, flat_half_width.abs());
        contact.pressure_scale = normal_force / length / half_width;
        contact.stiffness_scale = 0.5 * PI * composite_modulus * length;
        contact.zones = LayeredZones::of_flat(RoundedFlatZones::new(shape.punch(), shape.reference_compliance()));
        contact.reference_slope = reference_slope(parameters, half_width);
        contact.set_layer(&parameters.layer, normal_force)?;
        contact.set_friction(normal_force, [half_width, edge_radius, length, composite_modulus])?;
        Ok(contact)
    }

    /// Initialises an elliptical Hertz contact; a sphere if both semi-axes are equal.
    ///
    /// # Errors
    /// The error of the first parameter that is not allowed; `OutOfRange` if results are not representable.
    pub fn elliptic(parameters: &EllipticParameters) -> Result<Contact, Error> {
        parameters.check()?;
        let EllipticParameters { semi_axis_x, semi_axis_y, normal_force, .. } = *parameters;
        let mut contact = Contact::open(&parameters.common())?;
        if normal_force == 0.0 {
            return Ok(contact);
        }
        let composite_modulus = contact.composite_modulus;
        contact.half_width = semi_axis_x;
        contact.zones = LayeredZones::of_ellipse();
        contact.stiffness_scale = 1.0 / HertzEllipse::new(parameters)?.initial_compliance();
        contact.pressure_scale = normal_force / semi_axis_x / semi_axis_y;
        contact.set_layer(&parameters.layer, normal_force)?;
        // The radius of the sphere with this semi-axis. Nothing depends on the other two lengths.
        in_range(&[semi_axis_x, semi_axis_x, semi_axis_x, composite_modulus], &[normal_force])?;
        let radius = 4.0 / 3.0 * (semi_axis_x * (semi_axis_x * (semi_axis_x * composite_modulus / normal_force)));
        contact.set_friction(normal_force, [semi_axis_x, radius, semi_axis_x, composite_modulus])?;
        Ok(contact)
    }

    /// A contact without tangential forces, of parameters that were checked.
    fn open(parameters: &Common) -> Result<Contact, Error> {
        let Common { normal_force, friction_coefficient, .. } = *parameters;
        let composite_modulus = parameters.composite_modulus()?;
        // The derivatives of mu N.
        let sensitivity_scales = [friction_coefficient, normal_force, 0.0, 0.0, 0.0, 0.0, 0.0];
        Ok(Contact { composite_modulus, friction_coefficient, sensitivity_scales, tag: TAG, ..EMPTY })
    }

    /// The layer of parameters that were checked in series.
    fn set_layer(&mut self, layer: &parameters::Layer, normal_force: f64) -> Result<(), Error> {
        let (layer, under_load) = Layer::new(layer, normal_force)?;
        let of_contact = self.stick_zones().small_load().compliance;
        self.zones.set_layer(&layer.relative(normal_force, self.stiffness_scale, of_contact)?);
        // For a friction force of 1, by the compliance under the reference load.
        self.sensitivity_scales[PARAMETERS - 1] = under_load * self.stiffness_scale;
        Ok(())
    }

    /// The tangential law, from geometry and stiffness; `parameters` are b, R, L and E*.
    fn set_friction(&mut self, normal_force: f64, parameters: [f64; 4]) -> Result<(), Error> {
        if self.friction_coefficient == 0.0 {
            return Ok(());
        }
        in_range(&[self.friction_coefficient], &[])?;
        in_range(&[self.friction_coefficient, normal_force], &[])?;
        in_range(&[self.friction_coefficient, self.pressure_scale], &[])?;
        let slip_force = self.friction_coefficient * normal_force;
        in_range(&[slip_force], &[self.stiffness_scale])?;
        // Derivatives with respect to the parameters remain representable.
        if parameters.iter().any(|&parameter| exponent_of(&[slip_force], &[parameter]).abs() > 900) {
            return Err(Error::OutOfRange);
        }
        let [by_size, by_radius, by_length, by_modulus] = parameters.map(|parameter| slip_force / parameter);
        let displacement_scale = slip_force / self.stiffness_scale;
        let zones = self.stick_zones();
        let energy = zones.dissipation_beyond_half(&zones.at_load_remaining(0.0));
        let slip_energy = slip_force * displacement_scale * energy;
        if !slip_energy.is_normal() {
            return Err(Error::OutOfRange);
        }
        // Calls accept no larger displacement, so that gross slip would never be reached.
        let slip_displacement = displacement_scale * zones.slip_shift();
        check_displacement(slip_displacement).map_err(|_| Error::OutOfRange)?;
        let initial_stiffness = self.stiffness_scale / zones.small_load().compliance;
        self.slip_force = slip_force;
        self.slip_force_rounding = self.friction_coefficient.mul_add(normal_force, -slip_force);
        (self.displacement_scale, self.per_displacement_scale) = (displacement_scale, 1.0 / displacement_scale);
        (self.slip_displacement, self.per_slip_displacement) = (slip_displacement, 1.0 / slip_displacement);
        (self.initial_stiffness, self.slip_energy) = (initial_stiffness, slip_energy);
        let by_compliance = slip_force * self.sensitivity_scales[PARAMETERS - 1];
        self.sensitivity_scales =
            [self.friction_coefficient, normal_force, by_size, by_radius, by_length, by_modulus, by_compliance];
        let inner;
        (self.interpolant, inner) = self.interpolant_of_curve();
        self.inner_scale = 1.0 / (inner * slip_displacement);
        self.outer_scale = 1.0 / ((1.0 - inner) * slip_displacement);
        self.weights_in_slip = self.weights_of_curve();
        Ok(())
    }

    /// The interpolant and the fraction of its first polynomial.
    fn interpolant_of_curve(&self) -> (ForceInterpolant, f64) {
        let of = |zones: &dyn StickZones| (zones.slip_shift(), zones.small_load().compliance);
        if self.is_layered() {
            let (slip_shift, compliance) = of(&self.zones);
            let fractions = [INNER_FRACTION, KNEE_FRACTION];
            for fraction in fractions.into_iter().take(if self.has_knee() { 2 } else { 1 }) {
                let both = ForceInterpolant::of(true, fraction, slip_shift, compliance, &mut self.zones.sequence());
                if both.is_converged() {
                    return (both, fraction);
                }
            }
        }
        let (slip_shift, compliance) = of(self.zones.contact());
        let mut points = self.zones.sequence_of_contact();
        let alone = ForceInterpolant::of(false, INNER_FRACTION, slip_shift, compliance, &mut points);
        (if self.is_layered() { alone.without_layer() } else { alone }, INNER_FRACTION)
    }

    /// Whether this memory was initialised by a library of this version.
    #[inline(always)]
    pub(crate) fn is_initialised(&self) -> bool {
        self.tag == TAG
    }

    pub(crate) fn is_ellipse(&self) -> bool {
        self.zones.is_elliptic()
    }

    /// Whether there is a layer that is compliant in the tangential direction.
    #[inline(always)]
    pub(crate) fn is_layered(&self) -> bool {
        self.zones.has_layer()
    }

    #[inline(always)]
    pub(crate) fn interpolant(&self) -> &ForceInterpolant {
        &self.interpolant
    }

    /// Whether a layer bends the curve strongly near gross slip.
    #[inline(always)]
    pub(crate) fn has_knee(&self) -> bool {
        self.is_layered() && self.zones.has_knee()
    }

    /// Those of the contact and the layer.
    pub(crate) fn layered_zones(&self) -> &LayeredZones {
        &self.zones
    }

    pub(crate) fn stick_zones(&self) -> &dyn StickZones {
        self.zones.both()
    }

    /// No tangential force is possible: an open contact, or one without friction.
    #[inline(always)]
    pub(crate) fn is_frictionless(&self) -> bool {
        self.slip_force <= 0.0
    }

    /// A displacement up to that of gross slip, and the remaining one.
    pub(crate) fn before_slip(&self, displacement: f64) -> Complement {
        Complement { consumed: displacement, remaining: self.slip_displacement - displacement }
    }

    /// Energy for a dissipation of 1 \[J\].
    pub(crate) fn energy_scale(&self) -> f64 {
        self.slip_force * self.displacement_scale
    }
}

/// An open contact without a tag.
const EMPTY: Contact = Contact {
    composite_modulus: 0.0,
    half_width: 0.0,
    slip_force: 0.0,
    slip_displacement: 0.0,
    initial_stiffness: 0.0,
    slip_energy: 0.0,
    tag: 0,
    displacement_scale: 0.0,
    per_displacement_scale: 0.0,
    stiffness_scale: 0.0,
    pressure_scale: 0.0,
    friction_coefficient: 0.0,
    flat_half_width: 0.0,
    slip_force_rounding: 0.0,
    inner_scale: 0.0,
    outer_scale: 0.0,
    per_slip_displacement: 0.0,
    interpolant: ForceInterpolant::NONE,
    weights_in_slip: [0.0; _],
    zones: LayeredZones::EMPTY,
    sensitivity_scales: [0.0; _],
    reference_slope: 0.0,
    checksum: 0,
};

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::parameters::{CENTRE_POINT, Layer, Material, Pair, RIGID_STRIP};

    pub(crate) const TITANIUM: Material = Material { young_modulus: 114e9, poisson_ratio: 0.32 };

    /// A small underplatform contact; half-widths of about 0.1 mm.
    pub(crate) fn parameters(flat_half_width: f64) -> Parameters {
        Parameters {
            flat_half_width,
            edge_radius: 5e-3,
            length: 10e-3,
            normal_force: 150.0,
            friction_coefficient: 0.4,
            material: [TITANIUM; 2],
            displacement_reference: crate::parameters::CENTRE_POINT,
            ..Parameters::default()
        }
    }

    /// Cylinder, slightly flattened, flat, and nearly all flat.
    pub(crate) const FLATS: [f64; 4] = [0.0, 1e-6, 50e-6, 5e-3];

    pub(crate) fn contact(flat_half_width: f64) -> Contact {
        Contact::rounded_flat(&parameters(flat_half_width)).unwrap()
    }

    /// Contacts of all shapes with a layer of a compliance in units of that of the contact, and of N_c in units of the normal force.
    pub(crate) fn layered(share: f64, ratio: f64) -> std::vec::Vec<Contact> {
        let layer = |alone: &Contact| Layer {
            normal_compliance: 0.0,
            tangential_compliance: share / alone.initial_stiffness,
            stiffening_load: 150.0 * ratio,
            reference_load: 0.0,
        };
        let flat = |a| Contact::rounded_flat(&Parameters { layer: layer(&contact(a)), ..parameters(a) }).unwrap();
        let ellipse = EllipticParameters {
            semi_axis_x: 1e-4,
            semi_axis_y: 2e-4,
            normal_force: 150.0,
            friction_coefficient: 0.4,
            material: [TITANIUM; 2],
            layer: layer(&ellipse(1e-4, 2e-4)),
        };
        std::vec![flat(0.0), flat(50e-6), flat(5e-3), Contact::elliptic(&ellipse).unwrap()]
    }

    /// A cylinder with a ratio 2L/b of `slenderness`.
    pub(crate) fn cylinder(slenderness: f64, poisson_ratio: f64, reference: i32) -> Result<Contact, Error> {
        let body = Material { young_modulus: 2e11, poisson_ratio };
        let half_width = 2.0 * 0.01 / slenderness;
        let modulus = Pair::new(&[body; 2]).composite_modulus;
        Contact::rounded_flat(&Parameters {
            normal_force: PI * modulus * 0.01 * half_width * half_width / (4.0 * 5e-3),
            material: [body; 2],
            displacement_reference: reference,
            ..parameters(0.0)
        })
    }

    pub(crate) fn ellipse(semi_axis_x: f64, semi_axis_y: f64) -> Contact {
        Contact::elliptic(&EllipticParameters {
            semi_axis_x,
            semi_axis_y,
            normal_force: 150.0,
            friction_coefficient: 0.4,
            material: [TITANIUM; 2],
            ..EllipticParameters::default()
        })
        .unwrap()
    }

    /// Λ, from the initial stiffness.
    fn compliance(contact: &Contact) -> f64 {
        contact.stiffness_scale / contact.initial_stiffness
    }

    #[test]
    fn length_below_half_the_half_width_is_rejected() {
        for nu in [0.0, 0.3, 0.5] {
            for reference in [CENTRE_POINT, RIGID_STRIP] {
                // 2L = b to 1e-9, far above the rounding errors of both.
                let rejected = cylinder(1.0 - 1e-9, nu, reference).map(|_| ());
                assert_eq!(rejected, Err(Error::LengthTooShort), "{nu}");
                let shortest = cylinder(1.0 + 1e-9, nu, reference).unwrap();
                assert!(shortest.initial_stiffness > 0.0 && compliance(&shortest) > 0.0, "{nu}");
            }
        }
        // A flat wider than its length allows, whatever the load.
        let wide = Contact::rounded_flat(&parameters(20.1e-3)).map(|_| ());
        assert_eq!(wide, Err(Error::LengthTooShort));
    }

    /// For parameters of any magnitude: either rejected, or all results finite and positive.
    #[test]
    fn accepted_contacts_are_representable() {
        let sizes = [1e-300, 1e-120, 1e-30, 1e-3, 1e5, 1e40, 1e150, 1e300];
        let (mut accepted, mut rejected) = (0, 0);
        let mut check = |contact: Result<Contact, Error>| match contact {
            Ok(contact) => {
                accepted += 1;
                let Contact { half_width, slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
                for value in [half_width, slip_force, slip_displacement, initial_stiffness] {
                    assert!(value > 0.0 && value.is_finite(), "{contact:?}");
                }
                let work = slip_force * slip_displacement;
                assert!(slip_energy.is_normal() && slip_energy < 2.0 * work, "{contact:?}");
            }
            Err(error) => {
                rejected += 1;
                assert!(matches!(error, Error::OutOfRange | Error::LengthTooShort), "{error:?}");
            }
        };
        for one in sizes {
            for two in sizes {
                for three in sizes {
                    for young_modulus in [1e-160, 1e11, 1e160] {
                        let material = [Material { young_modulus, poisson_ratio: 0.3 }; 2];
                        for flat in [0.0, 1e-200, 1e-4, 1e200] {
                            check(Contact::rounded_flat(&Parameters {
                                edge_radius: one,
                                length: two,
                                normal_force: three,
                                material,
                                ..parameters(flat)
                            }));
                        }
                        check(Contact::elliptic(&EllipticParameters {
                            semi_axis_x: one,
                            semi_axis_y: two,
                            normal_force: three,
                            friction_coefficient: 0.3,
                            material,
                            ..EllipticParameters::default()
                        }));
                    }
                }
            }
        }
        assert!(accepted > 100 && rejected > 1000, "{accepted} {rejected}");
    }

    #[test]
    fn open_and_frictionless_contacts_carry_no_force() {
        for flat in [0.0, 50e-6] {
            let open = Contact::rounded_flat(&Parameters { normal_force: 0.0, ..parameters(flat) }).unwrap();
            let frictionless =
                Contact::rounded_flat(&Parameters { friction_coefficient: 0.0, ..parameters(flat) }).unwrap();
            assert_eq!((open.half_width, open.pressure(0.0)), (0.0, 0.0));
            assert_eq!((frictionless.half_width, frictionless.pressure(0.0)), {
                let frictional = contact(flat);
                (frictional.half_width, frictional.pressure(0.0))
            });
            for contact in [open, frictionless] {
                assert!(contact.is_initialised() && contact.composite_modulus > 0.0);
                let Contact { slip_force, slip_displacement, initial_stiffness, slip_energy, .. } = contact;
                assert_eq!([slip_force, slip_displacement, initial_stiffness, slip_energy], [0.0; 4]);
                let point = contact.curve_at_displacement(1.0).unwrap();
                assert_eq!((point.force(), point.stiffness(), point.shear(0.0)), (0.0, 0.0, 0.0));
                let complex = contact.complex_stiffness(1.0).unwrap();
                assert_eq!((complex.real(), complex.imaginary()), (0.0, 0.0));
                assert_eq!((complex.d_real(), complex.d_imag()), (0.0, 0.0));
            }
        }
    }

    #[test]
    fn negative_zero_is_zero() {
        let minus = Contact::rounded_flat(&Parameters { flat_half_width: -0.0, ..parameters(0.0) }).unwrap();
        assert_eq!(std::format!("{minus:?}"), std::format!("{:?}", contact(0.0)));
    }

    #[test]
    fn uninitialised_memory_is_recognised() {
        for contact in [contact(0.0), ellipse(1e-4, 2e-4)] {
            assert!(contact.is_initialised());
            for bit in 0..64 {
                assert!(!Contact { tag: contact.tag ^ (1 << bit), ..contact }.is_initialised());
            }
        }
    }

    /// Products in range whose factors are not: no intermediate overflow, and no contact of NaNs.
    #[test]
    fn factors_out_of_range_are_rejected() {
        let body = Material { young_modulus: 5.5e85, poisson_ratio: 0.486 };
        let extreme = Parameters {
            flat_half_width: 0.0,
            edge_radius: 2.78e236,
            length: 4.8e-95,
            normal_force: 1.03e-171,
            friction_coefficient: 5.3e116,
            material: [body; 2],
            displacement_reference: 1,
            layer: Layer::none(),
            reserved: 0,
        };
        assert_eq!(Contact::rounded_flat(&extreme).map(|_| ()), Err(Error::OutOfRange));
    }

    #[test]
    fn displacement_of_gross_slip_beyond_the_limit_is_rejected() {
        let (mut accepted, mut rejected) = (0, 0);
        let soft = Material { young_modulus: 7.4e-57, ..TITANIUM };
        for exponent in 285..305 {
            let parameters = EllipticParameters {
                semi_axis_x: 1e-4,
                semi_axis_y: 2e-4,
                normal_force: 100.0,
                friction_coefficient: 2f64.powi(exponent),
                material: [soft, TITANIUM],
                ..EllipticParameters::default()
            };
            match Contact::elliptic(&parameters) {
                Ok(contact) => {
                    accepted += 1;
                    assert!(contact.curve_at_displacement(contact.slip_displacement).is_ok());
                }
                Err(error) => {
                    rejected += 1;
                    assert_eq!(error, Error::OutOfRange);
                }
            }
        }
        assert!(accepted > 0 && rejected > 0);
    }
}
